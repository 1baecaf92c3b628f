/* Solutions of one order seen from another: the same motion as one of more periods, or later by a period of the excitation.
 *
 * A motion of order d repeats after d periods of the excitation. Among those of order nu, d dividing nu, it has the harmonics
 * k nu/d alone. One that repeats after nu periods and no fewer comes nu times, later by j periods each: A_k exp(2 pi i k j/nu). */
#ifndef MHB_BALANCE_SUBHARMONICS_H
#define MHB_BALANCE_SUBHARMONICS_H

#include "mhb/balance/balance.h"

/* Harmonic k of a solution x[rows][2m+1] becomes harmonic k factor of to[rows][2 wide + 1]; what has no room is cut. */
void mhb_subharmonic_embed(int rows, const double *x, int m, int factor, double *to, int wide);

/* The way back: harmonic k factor becomes harmonic k of to[rows][2 narrow + 1]. */
void mhb_subharmonic_restrict(int rows, const double *x, int m, int factor, double *to, int narrow);

/* x[n] of the residual's order, later by j periods of the excitation. */
void mhb_subharmonic_shift(const mhb_balance *residual, const double *x, int j, double *to);

/* The part of x[n] that repeats after nu periods but not after d, d dividing nu: the others set to 0. */
void mhb_subharmonic_component(const mhb_balance *residual, const double *x, int d, double *part);

/* After how many periods of the excitation x[n] repeats, to 1e-6 of its size: nu or less. */
int mhb_subharmonic_period(const mhb_balance *residual, const double *x);

#endif
