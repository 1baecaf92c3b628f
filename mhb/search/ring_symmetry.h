/* Rotations of a ring that change nothing but the place and the time of a motion.
 *
 * Where blade b is like blade b - s for all b, a motion x solves the balance together with the same
 * motion s blades further on. There it lags as the load does: harmonic k of contact b becomes
 * x_{b-s,k} exp(-j k s phi/nu). In a tuned ring s is any number of blades. The travelling wave is
 * its own copy. Rotations by N blades are shifts of time (subharmonics.h). */
#ifndef MHB_SEARCH_RING_SYMMETRY_H
#define MHB_SEARCH_RING_SYMMETRY_H

#include "mhb/balance/balance.h"

/* Least s >= 1 by which the ring may be turned; it divides N. N: only by a whole turn. */
int mhb_ring_repeat(const mhb_mistuned_ring *ring);

/* Rotations that change nothing, that by 0 included: N/s. 1: no ring, or all blades differ. */
int mhb_ring_rotations(const mhb_balance *balance);

/* to[n] <- x[n], rotation j of those. to is not x. */
void mhb_ring_rotate(const mhb_balance *balance, const double *x, int j, double *to);

/* Whether the waves of this order close around the ring, so that a mean over rotations is one. */
bool mhb_ring_has_waves(const mhb_balance *balance);

/* part[n] <- x[n] less its mean over the rotations: 0 for the travelling wave. */
void mhb_ring_beside_wave(const mhb_balance *balance, const double *x, double *part);

/* Copies of a motion by rotation and by time, itself included: mhb_ring_rotations times nu. */
int mhb_motion_copies(const mhb_balance *balance);

/* to[n] <- copy j of x[n]; 0 is x itself. to is not x. */
void mhb_motion_copy(const mhb_balance *balance, const double *x, int j, double *to);

#endif
