/* Solutions of different subharmonic order: embedding, restriction and time shift.
 *
 * A motion of order d repeats after d periods of the excitation. As a motion of order nu, d
 * dividing nu, it has the harmonics k nu/d only. A motion of order nu has nu phases: later by j
 * periods of the excitation its harmonics are A_k exp(2 pi i k j/nu). */
#ifndef MHB_BALANCE_SUBHARMONICS_H
#define MHB_BALANCE_SUBHARMONICS_H

#include "mhb/balance/balance.h"

/* Harmonic k of x[rows][2m+1] becomes harmonic k factor of to[rows][2 wide + 1]; harmonics above
 * wide are cut. */
void mhb_subharmonic_embed(int rows, const double *x, int m, int factor, double *to, int wide);

/* Harmonic k factor of x[rows][2m+1] becomes harmonic k of to[rows][2 narrow + 1]. */
void mhb_subharmonic_restrict(int rows, const double *x, int m, int factor, double *to, int narrow);

/* to[n] <- x[n], of the balance's order, later by j periods of the excitation. */
void mhb_subharmonic_shift(const mhb_balance *balance, const double *x, int j, double *to);

/* part[n] <- the part of x[n] that repeats after nu periods but not after d, d dividing nu. */
void mhb_subharmonic_component(const mhb_balance *balance, const double *x, int d, double *part);

/* Order of x[n]: periods of the excitation after which it repeats to 1e-6 of its size; at most
 * nu. */
int mhb_subharmonic_period(const mhb_balance *balance, const double *x);

#endif
