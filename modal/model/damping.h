/* Modal damping of a case: one ratio, one a mode, a loss factor, or Rayleigh's two constants. */
#ifndef MODAL_MODEL_DAMPING_H
#define MODAL_MODEL_DAMPING_H

#include "mesh/base/status.h"

enum { MODAL_DAMPING_RATIOS = 64 };

typedef enum {
  MODAL_DAMPING_ALL,      /* ratio */
  MODAL_DAMPING_EACH,     /* each[i] of mode i; further modes take the last */
  MODAL_DAMPING_LOSS,     /* zeta = loss/2: energy per cycle at resonance as of K (1 + j loss) */
  MODAL_DAMPING_RAYLEIGH, /* C = alpha M + beta K: zeta = alpha/(2 omega) + beta omega/2 */
} modal_damping_kind;

typedef struct {
  modal_damping_kind kind;
  double             ratio;
  int                n;
  double             each[MODAL_DAMPING_RATIOS];
  double             loss;
  double             alpha, beta; /* 1/s, s */
} modal_damping;

/* Damping ratio of mode i (from 0). omega: natural frequency, rad/s. Errors: SHB_ERR_INPUT if it is
 * 1 or more, which Rayleigh's constants can cause; the text names the mode. */
shb_status modal_damping_ratio(const modal_damping *damping, int i, double omega, double *ratio);

#endif
