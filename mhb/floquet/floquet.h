/* Floquet multipliers of a periodic solution, with the states of the sliders: is the response that was found one that lasts?
 *
 * The variational problem is integrated over one period of the fundamental (monodromy.h); the multipliers are the eigenvalues
 * of the result. Contacts that stick throughout are linear springs: their two multipliers 1 are a family of static
 * frictions, not an instability, and are left out, as are the exact zeros of friction that slip or opening forgets. Where
 * nothing slips, opens or closes the exponents are those of a linear structure and kept from call to call (linear_exponents.h).
 *
 * A wave around the ring: any disturbance of any blade is followed (it need not keep the wave's form), over g/N of a period,
 * after which the blades change names (transition_schedule.h). States grow with the blades, 2 modes + 2 contacts each: where they are
 * more than max_states, the lowest modes are kept and the others answer statically.
 * Derivation: docs/theory/stability.md. */
#ifndef MHB_FLOQUET_FLOQUET_H
#define MHB_FLOQUET_FLOQUET_H

#include <complex.h>

#include "mhb/floquet/monodromy.h"

typedef enum { MHB_STABLE, MHB_MARGINAL, MHB_UNSTABLE, MHB_UNDECIDED } mhb_verdict;

/* Where the largest multiplier would leave, or has left, the unit circle. */
typedef enum { MHB_THROUGH_PLUS_ONE, MHB_THROUGH_MINUS_ONE, MHB_THROUGH_PAIR } mhb_crossing;

typedef struct {
  mhb_verdict  verdict;
  mhb_crossing crossing; /* of the largest: fold, flip or Neimark-Sacker if it is beyond 1 */
  int          n;        /* multipliers computed */
  const double complex
             *multiplier; /* [n] by falling modulus, pairs together; valid until the next call */
  int         n_stuck;    /* multipliers 1 left out */
  int         n_zero;     /* exact zeros left out */
  int         n_unstable; /* beyond the margin */
  int         modes;   /* with their dynamics; fewer than the model has: max_states was reached */
  double      largest; /* modulus of the first */
  double      change;  /* of largest by the last halving of the sub-steps; -1: there are none */
  const char *reason;  /* of MHB_UNDECIDED, else NULL */
} mhb_multipliers;

typedef struct mhb_floquet mhb_floquet; /* workspace; one a thread */

/* For the harmonics of settings and N = substeps to a period of the fundamental, to begin with; max_states 0: 600.
 * The receptance must outlive it. Errors: SHB_ERR_INPUT substeps < 1; SHB_ERR_IO no memory. */
shb_status mhb_floquet_create(const mhb_receptance *receptance, const mhb_settings *settings,
                              int substeps, int max_states, mhb_floquet **stability);
void       mhb_floquet_destroy(mhb_floquet *stability);

/* A receptance in a run-up has moved: the structure is that at its speed from now on. */
void mhb_floquet_move(mhb_floquet *stability, const mhb_receptance *receptance);

/* Equal cells of the ring, gcd(E, N); the work goes with 1/cells^2. 1: a blade on the ground. */
int mhb_floquet_cells(const mhb_floquet *stability);

/* Multipliers of a solution. Unstable: largest > 1 + max(1e-3, change); marginal: above 1 but not beyond that; undecided: the
 * contact law was lost at the solution, 16 N sub-steps do not settle it, or max_states is too small for one mode a blade. No allocation. */
void mhb_floquet_evaluate(mhb_floquet *stability, const mhb_solution *solution,
                          mhb_multipliers *multipliers);

#endif
