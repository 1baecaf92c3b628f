/* A structure of 12 dofs with the stiffness K(Omega^2), condensed as by the modal stage: 6 modes,
 * the others as residual terms. Dofs 0-2 are the right contact, 3-5 the left, 6-8 the probe. All
 * masses are 1. A load of harmonics 0 to 2 acts on all dofs. */
#ifndef TESTS_SUPPORT_SPINNING_H
#define TESTS_SUPPORT_SPINNING_H

#include "mhb/problem/settings.h"
#include "modal/model/speeds.h"

enum { SPINNING_DOFS = 12, SPINNING_MODES = 6 };

typedef enum {
  SPINNING_STEADY, /* the same at every speed */
  /* w_i^2 = a_i + b_i Omega^2, constant shapes and damping ratios; modes 2 and 3 cross at 0.7 */
  SPINNING_STRAIGHT,
  SPINNING_TURNING, /* shapes change smoothly */
  SPINNING_LEAVING, /* as STRAIGHT, but the last mode kept crosses the first one left out at 0.5 */
  SPINNING_VEERING  /* as STRAIGHT, but modes 2 and 3 veer within a tenth of Omega */
} spinning_kind;

/* phi is [6][12] or NULL. To be freed with modal_model_free. */
void spinning_model(spinning_kind kind, double speed, modal_model *model, double *phi);

/* n speeds over low .. high, rad/s, with overlaps or with tracks alone. */
void spinning_speeds(spinning_kind kind, int n, double low, double high, bool overlap,
                     modal_speeds *speeds);

/* Settings: contact to the neighbour, 7 blades, engine order 2, harmonics 3. The frequencies are
 * those of 0.4 to 1.9 rad/s, thus speeds of 0.2 to 0.95 rad/s. */
mhb_settings spinning_settings(void);

#endif
