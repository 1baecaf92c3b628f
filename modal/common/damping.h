/* Modal damping, as a case gives it: a ratio for all modes or one a mode, a loss factor, or Rayleigh's. */
#ifndef MODAL_COMMON_DAMPING_H
#define MODAL_COMMON_DAMPING_H

#include "mesh/base/status.h"

enum { MODAL_DAMPING_RATIOS = 64 };

typedef enum {
  MODAL_DAMPING_ALL,  /* ratio */
  MODAL_DAMPING_EACH, /* each[i] of mode i; modes beyond take the last */
  MODAL_DAMPING_LOSS, /* zeta = loss/2: as much energy a cycle at resonance as structural damping K (1 + j loss) */
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

/* Damping ratio of mode i (from 0), omega its natural frequency, rad/s.
 * SHB_ERR_INPUT: 1 or more, as Rayleigh's can become (the mode is named). */
shb_status modal_damping_ratio(const modal_damping *damping, int i, double omega, double *ratio);

#endif
