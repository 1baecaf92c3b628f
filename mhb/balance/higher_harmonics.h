/* Harmonics above those of a balance, k = 2m+1 .. 4m of an estimate made with 2m: one of them may
 * be at a resonance.
 *
 * The forces p_k of the nonlinear pairs excite them. The contact answers with the stiffness D of
 * each pair at the balance's last harmonic. Harmonic by harmonic:
 *   u_k = (I + R_k D)^-1 c_k,   c_k = free_k - R_k p_k.
 * With more contact motions than modes the unknowns are those of the modes. G is the residual
 * flexibility of each pair to itself alone, W = (I + G D)^-1:
 *   u_k = W (c_k - B y),   (I + L B^H D W B) y = L B^H D W c_k. */
#ifndef MHB_BALANCE_HIGHER_HARMONICS_H
#define MHB_BALANCE_HIGHER_HARMONICS_H

#include "mesh/base/arena.h"
#include "mhb/balance/balance.h"

typedef struct {
  int                     first, last; /* harmonics */
  int                     n, n_modes;  /* n = 3 pairs */
  int                     by_modes;    /* 1: solved for y */
  mhb_receptance         *receptance;  /* harmonics 0..last at least */
  mhb_contact_evaluator  *contact;     /* harmonics 0..last */
  double                 *x, *p;       /* [3][2 last + 1] motion and force of one pair, real form */
  double complex         *force, *u;   /* [k - first][n] p_k N, u_k m */
  double complex         *D, *W;       /* [pair][3][3] */
  double complex         *A, *c;     /* matrix [n][n] or [modes][modes] and c [n] of one harmonic */
  double complex         *y;         /* [modes] */
  double complex         *V, *f;     /* [n][modes] D W B; [n] D W c */
  double complex         *C;         /* [modes][modes] B^H V */
  int                    *pivot;     /* [n or modes] */
  mhb_receptance_product *product;   /* of many pairs: harmonics first..last */
  double                 *change;    /* [columns of the product or of the balance] in real form */
  double                 *motion;    /* [columns of the product] R p_k */
  double complex         *stiffness; /* [modes][modes] L^-1 with Coriolis terms, else NULL */
  shb_arena               arena;
} mhb_higher_harmonics;

/* For the harmonics of the receptance above those of the balance.
 * SHB_ERR_IO: no memory for a contact evaluator. */
shb_status mhb_higher_harmonics_create(const mhb_balance *balance, mhb_receptance *receptance,
                                       mhb_higher_harmonics **higher);
void       mhb_higher_harmonics_destroy(mhb_higher_harmonics *higher);

/* p_k of all pairs at x[n], the point of the balance's last linearisation. */
void mhb_higher_harmonics_evaluate(mhb_higher_harmonics *higher, const mhb_balance *balance,
                                   const double *x);

/* p_k of a pair from its force p[3][2 last + 1] in real form, N; NULL: none. */
void mhb_higher_harmonics_set_force(mhb_higher_harmonics *higher, int pair, const double *p);

/* Estimate u_k of all harmonics from their p_k. Returns |u|, m. A harmonic whose system is singular
 * is set to 0.
 *   stiffness   in  a balance that was linearised there, of these harmonics or of fewer
 *   negligible  in  error of R_k p_k, as in mhb_balance */
double mhb_higher_harmonics_estimate(mhb_higher_harmonics *higher, const mhb_balance *stiffness,
                                     double negligible);

/* change[n] <- change of the balance's residual at x by the estimated harmonics, m. The balance's
 * evaluation in use has the forces at x. */
void mhb_higher_harmonics_feedback(mhb_higher_harmonics *higher, const mhb_balance *balance,
                                   const mhb_balance *stiffness, const double *x, double *change);

/* D <- stiffness of a pair at the balance's last harmonic, by its last linearisation, without the
 * part that couples k with -k; N/m. */
void mhb_last_stiffness(const mhb_balance *balance, int pair, double complex D[3][3]);

/* A[n][n] column-major <- I + R D: R[n][n] the receptance of n/3 pairs at one harmonic, m/N, and
 * D[pair][3][3] their stiffness, N/m. */
void mhb_harmonic_matrix(int n, const double complex *R, const double complex (*D)[9],
                         double complex *A);

/* |u_k|^2 of the last estimate, m^2; 0 for other harmonics. */
double mhb_higher_harmonics_power(const mhb_higher_harmonics *higher, int k);

#endif
