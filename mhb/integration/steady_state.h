/* Time integration until the motion repeats itself, and what the last period was.
 *
 * The return map is compared with up to MHB_STEADY_STATE_MULTIPLE periods of the fundamental before: a motion that comes back after
 * two is periodic of order two. What is still to come is estimated from how fast the distance falls, d/(1 - rate). */
#ifndef MHB_INTEGRATION_STEADY_STATE_H
#define MHB_INTEGRATION_STEADY_STATE_H

#include "mhb/integration/integrator.h"

enum { MHB_STEADY_STATE_MULTIPLE = 6 };

typedef struct {
  double tolerance;   /* of the distance still to go, relative to the motion */
  int    max_periods; /* of the fundamental */
} mhb_steady_state_settings;

/* The last period of the fundamental; contacts and probes of blade 0. */
typedef struct {
  int    n_harmonics, n_pairs, n_probes;
  int    multiple; /* the motion repeats after so many periods; 0: it does not */
  int    failed;   /* the forces of a step were not found: nothing else is valid */
  int    periods;  /* that were integrated */
  double distance; /* of the return map, relative; after `multiple` periods, or after one */
  double complex *motion, *force, *probe; /* [pair][3][k], [probe][3][k] as in the response file */
  double         *state, *dissipation;    /* [pair][3] stuck, slipping, open; [pair] J */
} mhb_steady_state_result;

typedef struct mhb_steady_state mhb_steady_state; /* workspace */

/* Outputs with the integrator's n_harmonics. SHB_ERR_IO: no memory. The integrator must outlive it. */
shb_status mhb_steady_state_create(mhb_integrator *integrator, mhb_steady_state **steady);
void       mhb_steady_state_destroy(mhb_steady_state *steady);

/* Integrate from the integrator's state. go_on: asked after every period, NULL: never stops. */
const mhb_steady_state_result *mhb_steady_state_run(mhb_steady_state                *steady,
                                                    const mhb_steady_state_settings *settings,
                                                    int (*go_on)(void *), void *context);

/* Distance of two states [mhb_integrator_size]: of the modes relative to the second and the motion without contact, or of the
 * friction relative to the largest force, whichever is larger. */
double mhb_steady_state_distance(const mhb_integrator *integrator, const double *a,
                                 const double *b);

#endif
