/* The harmonics beyond those of a balance, which can meet a resonance: k = 2m+1 .. 4m of an estimate made with 2m.
 *
 * Forced by the pairs that move, p_k, with D the stiffness of each pair at the balance's last harmonic, one by one:
 *   u_k = (I + R_k D)^-1 c_k,   c_k = free_k - R_k p_k.
 * Where there are more motions than modes: with the residual flexibility G of each pair to itself alone, W = (I + G D)^-1,
 *   u_k = W (c_k - B y),   (I + L B^H D W B) y = L B^H D W c_k,
 * a system of as many unknowns as modes. */
#ifndef MHB_BALANCE_HIGHER_HARMONICS_H
#define MHB_BALANCE_HIGHER_HARMONICS_H

#include "mhb/balance/balance.h"

typedef struct {
  int                    first, last; /* harmonics */
  int                    n, n_modes;  /* n = 3 pairs */
  int                    by_modes;
  mhb_receptance        *receptance; /* harmonics 0..last at least */
  mhb_contact_evaluator *contact;    /* harmonics 0..last */
  double                *x, *p;      /* [3][2 last + 1] of one pair */
  double complex        *force, *u;  /* [k - first][n] p_k, and the motion found */
  double complex        *D, *W;      /* [pair][3][3] */
  double complex        *A, *c;      /* [n][n] or [modes][modes], [n] of one harmonic */
  double complex        *y, *V;      /* [modes], [3][modes] */
  int                   *pivot;      /* [n or modes] */
} mhb_higher_harmonics;

/* For a balance on the given receptance, whose harmonics beyond the balance's are looked at.
 * SHB_ERR_IO: no memory. */
shb_status mhb_higher_harmonics_create(const mhb_balance *balance, mhb_receptance *receptance,
                                       mhb_higher_harmonics **beyond);
void       mhb_higher_harmonics_destroy(mhb_higher_harmonics *beyond);

/* The harmonics beyond at the point x[n] where the balance was evaluated last, with derivatives: their size |u|. */
double mhb_higher_harmonics_estimate(mhb_higher_harmonics *beyond, const mhb_balance *balance,
                                     const double *x);

/* change[n] <- what they do to the residual of the balance at x. */
void mhb_higher_harmonics_feedback(mhb_higher_harmonics *beyond, const mhb_balance *balance,
                                   const double *x, double *change);

/* |u_k|^2; 0 for other harmonics. */
double mhb_higher_harmonics_power(const mhb_higher_harmonics *beyond, int k);

#endif
