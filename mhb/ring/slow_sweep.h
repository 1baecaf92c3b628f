/* A slow sweep of the ring over a range of frequencies, started on a wave at its low end.
 *
 * The frequency rises in steps of 5 periods. Positions and velocities are kept at each step, and
 * noise of 1e-3 keeps the ring from staying on an unstable wave. A half-power bandwidth, 2 zeta f,
 * takes 85 to 1275 periods, and the whole range 3000 where that allows it. A faster sweep shows
 * nothing: the envelope follows within 1/(2 pi zeta) periods. */
#ifndef MHB_RING_SLOW_SWEEP_H
#define MHB_RING_SLOW_SWEEP_H

#include "mhb/ring/lasting.h"

/* Running windows over the sweep: [n] Hz, m, m. mean: of a period's peak over blades and periods;
 * worst: its 99.9 percentile. */
typedef struct {
  int     n, periods;
  double *frequency, *mean, *worst;
  double  largest; /* Hz: place of the largest mean over a window of a period's worst blade */
  int     n_states;
  mhb_ring_state *state; /* [n_states] in the middle of each window */
  shb_arena       arena;
} mhb_slow_sweep;

/* Sweep from the wave's frequency to `high` (Hz). n = 0: the contact is too stiff for the steps, or
 * stopped.
 * Errors: as mhb_ring_model_create. The result is empty then, and need not be destroyed. */
shb_status mhb_slow_sweep_run(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, double high, mhb_go_on go_on, void *context,
                              mhb_slow_sweep *sweep);
void       mhb_slow_sweep_destroy(mhb_slow_sweep *sweep);

#endif
