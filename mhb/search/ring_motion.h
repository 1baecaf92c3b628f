/* How a motion is spread over the blades of a ring, and which waves it consists of.
 *
 * Blade b has the mean kinetic energy e_b = 1/4 sum_k (k w/nu)^2 sum_i |q_{b,i,k}|^2. q are the
 * modal amplitudes (unit modal mass). Of N blades
 *   participation = (sum_b e_b)^2 / (N sum_b e_b^2)
 * is the share that takes part: 1 where all have the same energy, 1/N where one has all of it.
 *
 * The amplitudes of harmonic k are a sum of waves with d = 0..N-1 nodal diameters. The load drives
 * d = k (E + N l)/nu alone, rounded down where no wave of that order closes. A wave of d + j is j
 * beside it. By Parseval the energies of the waves sum to that of the blades. The energies of two
 * waves beat: e_b = A + B cos(..), |B| <= A. The participation is then 2/3 or more. It is 1/2 or
 * more where they are N/2 diameters apart. Below 1/2 three waves or more are at work. The motion
 * is then localised. */
#ifndef MHB_SEARCH_RING_MOTION_H
#define MHB_SEARCH_RING_MOTION_H

#include "mhb/balance/balance.h"
#include "mhb/response/response_types.h"

/* Of a motion of the balance's ring, whose forces the evaluation in use holds.
 *   energy    out  [blades] J
 *   wave      out  [blades] share of the energy in the waves j = 0..blades-1 beside the load's
 *   standing  out  share of the energy in waves d that meet an equal one of N - d
 * All are 0 at rest. */
void mhb_ring_motion_energies(const mhb_balance *balance, double *energy, double *wave,
                              double *standing);

/* From 1/n to 1; 0 at rest. */
double mhb_ring_participation(int n, const double *energy);

/* load_wave: its share of the energy. */
mhb_ring_kind mhb_ring_kind_of(double participation, double load_wave, double standing);

#endif
