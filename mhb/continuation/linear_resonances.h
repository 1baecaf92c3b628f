/* Resonances of the structure with the contact open or stuck everywhere, as values of omega.
 *
 * Harmonic k of omega/nu meets a mode w_i at omega = nu w_i/k, with a half-power half width of
 * zeta_i w_i nu/k. Free modes are those of the blade. Stuck modes are those of the harmonics that
 * are driven:
 *   (diag(w_i^2) + B^H K B) q = w^2 q,   K = (S^-1 + R)^-1,   S = diag(kv, Ku),
 *   zeta w = sum_i |q_i|^2 zeta_i w_i,   R the residual flexibility in the middle of the range.
 * A contact that slips or opens has its resonance between the two, as K rises from 0. Where they
 * are near each other it is as narrow, and anywhere between them.
 *
 * In a run-up the w_i are those at omega. Places are where the curves omega and nu w_i(omega)/k
 * meet. They are wider by the angle between the curves. */
#ifndef MHB_CONTINUATION_LINEAR_RESONANCES_H
#define MHB_CONTINUATION_LINEAR_RESONANCES_H

#include <stdbool.h>

#include "mhb/balance/balance.h"

typedef struct {
  double value, half_width; /* rad/s of omega: the place, and half of the half-power width */
  int    k, mode;           /* harmonic; the free mode that it is or is near to, -1: none */
  bool   significant;       /* the response changes within its width (resonance_detection.h) */
} mhb_resonance;

typedef struct {
  mhb_resonance *at; /* [n] by rising value */
  int            n, capacity;
} mhb_resonances;

/* Those of harmonics 1..m between low and high, rad/s; none unless the frequency is followed. */
void mhb_resonances_create(const mhb_balance *balance, double low, double high,
                           mhb_resonances *resonances);
/* Those of one linear limit at the harmonics of the load: free modes, or stuck ones with R near
 * each frequency. In a run-up all places of mhb_resonances_create. */
void mhb_resonances_of_limit(const mhb_balance *balance, bool stuck, double low, double high,
                             mhb_resonances *resonances);
void mhb_resonances_destroy(mhb_resonances *resonances);

/* Lowest natural frequencies of a wave of one nodal diameter with every contact stuck, Hz, rising.
 *
 * With residual flexibility R depends on the frequency: each mode has that of its own frequency, by
 * fixed-point iteration to 1e-9.
 *   settings   in   of contact and ring; frequency range and harmonics are not used
 *   diameter   in   0 to blades/2; of no effect with contact to the ground
 *   frequency  out  [n], n at most the modes of the model
 * Errors: as mhb_balance_create. */
shb_status mhb_stuck_frequencies(const modal_model *model, const mhb_settings *settings,
                                 int diameter, int n, double *frequency);

/* The longest change of a value, in sense +1 or -1, that resolves the significant resonances. It
 * leaves a few points from four half widths before each. INFINITY: any. */
double mhb_resonances_step_limit(const mhb_resonances *resonances, double value, int sense);

#endif
