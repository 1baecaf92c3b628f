/* The linearised balance condensed to the pairs that slip or open:
 *
 *   (I + R D) x + column sigma = rhs,   row . x + corner sigma = rhs_border
 *
 * A stuck pair (L) answers linearly, harmonic by harmonic: p_k = S u_k, S = diag(kv, Ku), at k = 0
 * diag(kv, 0). An open pair (O) has no force. Only the nonlinear pairs (N), whose D = dp/du is
 * full, couple the harmonics. Harmonic k, with q = D x_N and A = I + R_LL S:
 *
 *   L:  A x_L = rhs_L - R_LN q - c_L sigma
 *   N:  x_N + C q + (c_N - R_NL S A^-1 c_L) sigma = rhs_N - R_NL S A^-1 rhs_L,
 *       C = R_NN - R_NL S A^-1 R_LN
 *   O:  x_O = rhs_O - R_ON q - R_OL S x_L - c_O sigma
 *
 * The rows N of all harmonics and the border are one dense system of 3 (2m+1) unknowns a nonlinear
 * pair. A is complex and factored once a frequency. The solution is that of the whole system; so is
 * the sign of the determinant, because det A > 0 in real form.
 *
 * A pair stuck at the friction limit has a mean friction g = G u that depends on its motion. It is
 * a stuck pair with two borders more. Their unknowns are g. Their columns are R_0 of axes u and w,
 * their rows -G, their corner I. Harmonics whose right-hand side is zero cost nothing.
 *
 * A ring of different blades is not condensed, but factored by blocks (ring_system.h).
 *
 * Many pairs that move, or many that stick, are left to GMRES on the whole system (low_rank): the
 * condensation is made only where that fails. */
#ifndef MHB_BALANCE_CONDENSATION_H
#define MHB_BALANCE_CONDENSATION_H

#include "mhb/balance/balance.h"
#include "mhb/balance/ring_system.h"
#include "mhb/low_rank/woodbury.h"

/* Pairs at the friction limit that become borders; further ones are treated as nonlinear. */
enum { MHB_MOST_AT_LIMIT = 8, MHB_MOST_BORDERS = 1 + 2 * MHB_MOST_AT_LIMIT };

/* More moving unknowns than this of many pairs are never condensed. */
enum { MHB_MOST_DENSE = 4000 };

typedef struct {
  const mhb_balance *balance;
  int                m, n_pairs; /* of the balance, when this was created */
  int                capacity;   /* nonlinear unknowns there is room for */

  mhb_ring_system *ring; /* different blades: all that follows is not there; else NULL */

  /* many pairs */
  mhb_woodbury *low_rank;    /* NULL: few */
  mhb_block    *form;        /* [pairs] */
  int           by_low_rank; /* 1: the point was factored by it */
  double        accuracy;    /* of its solutions, relative to the right-hand side */

  /* the pairs at the point that was factored */
  mhb_pair_kind *kind; /* [pairs] nonlinear, stuck (also at the limit) or open */
  int            n_nonlinear, n_stuck;
  int           *nonlinear, *stuck; /* [pairs] their numbers */
  int            n_at_limit, at_limit[MHB_MOST_AT_LIMIT];

  /* A of each harmonic */
  double          omega;       /* rad/s, of the factors; NAN: none */
  int             n_laws;      /* of the balance, when A was factored */
  int             n_factored;  /* stuck pairs of the factors */
  int            *factored;    /* [pairs] their numbers */
  char           *is_factored; /* [k] */
  double complex *A;           /* [k][3 stuck][3 stuck] column-major LU */
  int            *A_pivot;     /* [k][3 stuck] */

  /* between the pairs, with harmonics at the strides of all pairs nonlinear or half of them
   * stuck */
  double complex *schur;              /* [k][3 nonlinear][3 nonlinear] C, row-major */
  double complex *stuck_to_nonlinear; /* [k][3 nonlinear][3 stuck] columns of A^-1 R_LN */
  double complex *nonlinear_to_stuck; /* [k][3 nonlinear][3 stuck] rows of R_NL S */

  /* borders, the caller's first */
  int             bordered;  /* 1: the caller's is there */
  int             n_borders; /* bordered + 2 n_at_limit */
  double complex *columns;   /* [border][k][3 pairs] column, A^-1 column_L of the stuck pairs */
  double complex *rows;      /* [border][k][3 pairs] row, less S R_OL^H row_O of the stuck pairs */

  /* dense system */
  int     n_live, *live; /* axes of nonlinear pairs that have a receptance, of 3 n_nonlinear */
  int     size;          /* nb n_live + n_borders */
  double *dense;         /* [size][size] row-major; factored */
  double
      *unknown; /* [size] right-hand side, then live x_N in real form and the borders' unknowns */
  double *full; /* [3 nonlinear][nb] the same of all axes */
  double *full_row; /* [border][3 nonlinear][nb] rows of the borders */
  int    *pivot;    /* [size] */

  /* one solution */
  double complex *rhs;             /* [k][3 pairs] right-hand side, then x */
  double complex *nonlinear_force; /* [k][3 pairs] q */
  double complex *stuck_force;     /* [k][3 pairs] S x_L */
  double complex *open_reaction;   /* [3 pairs] R_O^H row_O of one harmonic */
} mhb_condensation;

/* For one balance, which must outlive it. */
mhb_condensation *mhb_condensation_create(const mhb_balance *balance);

/* With room for so many nonlinear unknowns; a point with more of them is not factored. */
mhb_condensation *mhb_condensation_create_within(const mhb_balance *balance, int capacity);
void              mhb_condensation_destroy(mhb_condensation *condensation);

/* Factor at the balance's evaluation in use, which must be a linearisation.
 *   column, row  in  [n+1] border, both with the same corner last; or both NULL
 * Returns 0 if singular or beyond the capacity. No allocation. */
int mhb_condensation_factor(mhb_condensation *condensation, const double *column,
                            const double *row);

/* rhs[n or n+1] <- solution. Returns 0 if it is not finite. No allocation but for a new basis of
 * many pairs. Many pairs: to `accuracy`, which the caller may change; 1e-4 at first. */
int mhb_condensation_solve(mhb_condensation *condensation, double *rhs);

/* Form of a pair's stiffness at the balance's evaluation in use, for low_rank. */
mhb_block mhb_pair_block(const mhb_balance *balance, int pair);

/* Sign of the determinant of the system that was factored: 1 or -1. */
int mhb_condensation_sign(const mhb_condensation *condensation);

#endif
