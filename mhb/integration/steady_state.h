/* Time integration until the motion repeats itself, and the harmonics of its last period.
 *
 * The state is compared with that of up to MHB_STEADY_STATE_MULTIPLE periods of the fundamental
 * before. A motion that returns after two is periodic of order two. The distance still to go is
 * estimated from the rate at which the distance of the states decreases, d/(1 - rate). */
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
  int    multiple; /* periods after which the motion repeats; 0: it does not */
  int    failed;   /* 1: the forces of a step were not found, nothing else is valid */
  int    periods;  /* number integrated */
  double distance; /* of the return map, relative; after `multiple` periods, or after one */
  double complex *motion, *force, *probe; /* [pair][3][k], [probe][3][k] as in the response file */
  double         *state, *dissipation;    /* [pair][3] stuck, slipping, open; [pair] J */
} mhb_steady_state_result;

typedef struct mhb_steady_state mhb_steady_state; /* workspace */

/* Outputs with the integrator's n_harmonics. The integrator must outlive it. */
mhb_steady_state *mhb_steady_state_create(mhb_integrator *integrator);
void              mhb_steady_state_destroy(mhb_steady_state *steady);

/* Integrate from the integrator's state. go_on: called after every period, returns 0 to stop; or
 * NULL. */
const mhb_steady_state_result *mhb_steady_state_run(mhb_steady_state                *steady,
                                                    const mhb_steady_state_settings *settings,
                                                    int (*go_on)(void *), void *context);

/* Distance of two states [mhb_integrator_size]. The larger one of: modes, relative to b and the
 * motion without contact; friction, relative to the largest force. */
double mhb_steady_state_distance(const mhb_integrator *integrator, const double *a,
                                 const double *b);

#endif
