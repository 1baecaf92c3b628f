/* Where the structure, the contact open or stuck everywhere, has its resonances, as values of the excitation frequency omega.
 *
 * Harmonic k of omega/nu meets a mode w_i at omega = nu w_i/k, half a half-power width zeta_i w_i nu/k wide. Free modes: those of
 * the blade. Stuck ones, of the harmonics that are driven:
 *   (diag(w_i^2) + B^H K B) q = w^2 q,   K = (S^-1 + R)^-1,   S = diag(kv, Ku),   zeta w = sum_i |q_i|^2 zeta_i w_i
 * R the residual flexibility in the middle of the range. A contact that slips or opens is between the two; so is the resonance
 * (K rises from 0), which where they are near each other is as narrow, and anywhere between them.
 * In a run-up the w_i are those at omega: places are where the curves omega and nu w_i(omega)/k meet, wider by the angle. */
#ifndef MHB_CONTINUATION_LINEAR_RESONANCES_H
#define MHB_CONTINUATION_LINEAR_RESONANCES_H

#include <stdbool.h>

#include "mhb/balance/balance.h"

typedef struct {
  double value, half_width; /* rad/s of omega: the place, half the half-power width */
  int    k, mode;           /* harmonic; free mode that it is, or is near to, -1: none */
  bool   significant;       /* the response changes within its width: by who looks */
} mhb_resonance;

typedef struct {
  mhb_resonance *at; /* [n] by rising value */
  int            n, capacity;
} mhb_resonances;

/* Those of harmonics 1..m between low and high; none unless the residual follows the frequency. SHB_ERR_IO: no memory. */
shb_status mhb_resonances_create(const mhb_balance *balance, double low, double high,
                                 mhb_resonances *resonances);
void       mhb_resonances_destroy(mhb_resonances *resonances);

/* The longest way from a value on, sense +1 or -1, that resolves those that are significant: from four half widths on a few points each.
 * INFINITY: any. */
double mhb_resonances_step_limit(const mhb_resonances *resonances, double value, int sense);

#endif
