/* A structure of 12 dofs whose stiffness changes with the speed, K(Omega^2), condensed as the modal
 * stage would: 6 modes, what is left out in residual terms. Dofs 0-2 are the right contact, 3-5 the
 * left, 6-8 the probe; mass 1 each; harmonics 0 to 2 of a load on all. */
#ifndef TESTS_SUPPORT_SPINNING_H
#define TESTS_SUPPORT_SPINNING_H

#include "mhb/problem/settings.h"
#include "modal/model/speeds.h"

enum { SPINNING_DOFS = 12, SPINNING_MODES = 6 };

typedef enum {
  SPINNING_STEADY,   /* the same at every speed */
  SPINNING_STRAIGHT, /* w_i^2 = a_i + b_i Omega^2 of those kept, shapes and damping ratio constant; the second mode crosses the third at .7 */
  SPINNING_TURNING,  /* shapes change, smoothly */
  SPINNING_LEAVING,  /* as STRAIGHT, but the last mode kept crosses the first left out at .5 */
  SPINNING_VEERING   /* as STRAIGHT, but the second and the third mode veer, in a tenth of Omega */
} spinning_kind;

/* phi[6][12], or NULL. To be freed with modal_model_free. */
void spinning_model(spinning_kind kind, double speed, modal_model *model, double *phi);

/* n speeds over low .. high, rad/s; with overlaps, or with tracks alone. */
void spinning_speeds(spinning_kind kind, int n, double low, double high, bool overlap,
                     modal_speeds *speeds);

/* Neighbour, 7 blades, engine order 2, Hz of .4 to 1.9 rad/s: speeds of .2 to .95; harmonics 3. */
mhb_settings spinning_settings(void);

#endif
