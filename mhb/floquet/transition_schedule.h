/* When each contact of a blade, or of a ring of blades, sticks, slips and opens over the stretch of time that is integrated.
 *
 * Phases are t/T, T the period of the motion. In a wave blade b does at phase s what blade 0 does at s - b E/N. Then, with
 * g = gcd(E, N) and k E = g (mod N), blade b at s + g/N is where blade b - k was at s: the integration covers
 * g/N of a period only, and the blades then change names. A single blade on the ground: E = 0, N = 1. */
#ifndef MHB_FLOQUET_TRANSITION_SCHEDULE_H
#define MHB_FLOQUET_TRANSITION_SCHEDULE_H

#include "mhb/contact/contact.h"

typedef struct {
  double at;      /* phase after the start, in (0, span] */
  int    contact; /* j = blade * pairs + pair */
  int    state;   /* that begins */
  int    order;   /* among events of one time */
} mhb_event;

typedef struct {
  int        blades, pairs, wave;     /* N, pairs, E of the fundamental */
  int        n_segments, blade_shift; /* N/g stretches to a period, names change by k */
  double     start, span;             /* phase; 1/chunks */
  int        n_events, capacity;
  mhb_event *event;          /* by time */
  int       *state;          /* [contact] right after start */
  int       *constant_state; /* [contact] 1: this state throughout */
} mhb_transition_schedule;

/* SHB_ERR_IO: no memory. */
shb_status mhb_transition_schedule_create(int blades, int pairs, int wave,
                                          mhb_transition_schedule *schedule);
void       mhb_transition_schedule_destroy(mhb_transition_schedule *schedule);

/* Whether the law was evaluated well enough: not lost, or its error below 1e-5 of the force scale; transitions complete. */
int mhb_transition_schedule_usable(const mhb_contact_info *info);

/* From the transitions of the pairs, info[pair]. The start lies right after the event that leaves the fewest friction
 * states. 0: more events than there is room for, or a contact not usable. */
int mhb_transition_schedule_set(mhb_transition_schedule *schedule, const mhb_contact_info *info);

/* Phase of contact j's own blade at a phase after the start, in [0, 1). */
double mhb_transition_schedule_phase(const mhb_transition_schedule *schedule, int contact,
                                     double at);

/* Friction states of a contact in a state: stick 2, slip 1, open or permanently stuck 0. */
static inline int mhb_friction_states(int state, int constant_state, double mu) {
  if (mu == 0 || state == MHB_SEPARATE) return 0;
  return state == MHB_SLIDE ? 1 : constant_state ? 0 : 2;
}

#endif
