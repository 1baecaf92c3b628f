/* The linearised balance of harmonics, (J, column; row, corner) z = rhs, without the pairs that stay stuck or open.
 *
 * Such a pair answers linearly, p_k = S u_k harmonic by harmonic (S = diag(kv, Ku), at k = 0 diag(kv, 0); none if open). With M the
 * moving pairs (D = dp/du from the law), L the stuck and O the open ones, harmonic k of (I + R D) x + c sigma = f reads
 *
 *   L:  A x_L = f_L - R_LM q - c_L sigma,   A = I + R_LL S,   q = D x_M                (complex, factored once an omega)
 *   M:  x_M + (R_MM - R_ML S A^-1 R_LM) q + (c_M - R_ML S A^-1 c_L) sigma = f_M - R_ML S A^-1 f_L
 *   O:  x_O = f_O - R_OM q - R_OL S x_L - c_O sigma
 *
 * so that only the moving pairs couple the harmonics: one dense system of 3 (2m+1) moving unknowns, and one for the border.
 * The solution is that of the whole system. det A > 0 in real form: the sign of the determinant is that of the dense one.
 *
 * A stuck pair whose mean friction g = G u depends on the motion (held) is a stuck one with two more borders: unknowns g,
 * columns R_0 of its axes u and w, rows -G, corner I. Harmonics in which nothing happens cost nothing. */
#ifndef MHB_BALANCE_CONDENSATION_H
#define MHB_BALANCE_CONDENSATION_H

#include "mhb/balance/balance.h"

/* More held pairs than this are dense, as moving ones. */
enum { MHB_MOST_AT_LIMIT = 8, MHB_MOST_BORDERS = 1 + 2 * MHB_MOST_AT_LIMIT };

typedef struct {
  const mhb_balance *b;
  int                m, n_pairs;        /* of b, when this was made */
  int                most;              /* moving unknowns there is room for */
  mhb_pair_kind     *kind;              /* [pairs] as they are treated here: held is stuck */
  int                n_moving, n_stuck; /* pairs */
  int               *moving, *stuck;    /* [pairs] which */
  int                n_held, held[MHB_MOST_AT_LIMIT];
  int                bordered;   /* the caller's border is the first one */
  int                n_borders;  /* bordered + 2 n_held */
  int                size;       /* 3 nb n_moving + n_borders */
  double            *dense;      /* [size][size] row-major, factored */
  double            *y;          /* [size] */
  int               *pivot;      /* [size] */
  double             omega;      /* of the factors of A; NAN: none */
  int                n_laws;     /* of the residual, when A was factored */
  int                n_factored; /* pairs in them */
  int               *factored;   /* [pairs] which */
  char              *have;       /* [k] A is factored */
  double complex    *A;          /* [k][3 stuck][3 stuck], factored */
  int               *A_pivot;    /* [k][3 stuck] */
  double complex    *reach;      /* [k][3 moving][3 stuck] A^-1 R_LM */
  double complex    *mixed;      /* [k][3 moving][3 moving] R_MM - R_ML S reach */
  double complex    *f;          /* [k][3 pairs] right-hand side */
  double complex    *c, *t;      /* [border][k][3 pairs] columns and rows */
  double complex    *q, *s;      /* [k][3 pairs] forces of the moving, of the stuck pairs */
} mhb_condensation;

/* For one residual, which must outlive it. SHB_ERR_IO: no memory. */
shb_status mhb_condensation_create(const mhb_balance *residual, mhb_condensation **condensed);

/* With room for so many moving unknowns; where there are more, factors do not come about. */
shb_status mhb_condensation_create_within(const mhb_balance *residual, int most,
                                          mhb_condensation **condensed);
void       mhb_condensation_destroy(mhb_condensation *condensed);

/* Factor at the point where the residual was evaluated last with derivatives.
 *   column, row  in  [n+1] border, both with the corner last (equal there); or both NULL
 * Returns 0 if singular. */
int mhb_condensation_factor(mhb_condensation *condensed, const double *column, const double *row);

/* rhs[n or n+1] <- solution. 0: not a number. */
int mhb_condensation_solve(mhb_condensation *condensed, double *rhs);

/* Sign of the determinant of what was factored. */
int mhb_condensation_sign(const mhb_condensation *condensed);

#endif
