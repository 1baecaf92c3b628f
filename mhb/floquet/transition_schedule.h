/* Transitions of all contacts, in the order of time, over the interval that is integrated.
 *
 * Phases are t/T, T the period of the motion. In a travelling wave blade b at phase s is where
 * blade 0 is at s - b E/N. Let g = gcd(E, N) and k E = g (mod N). Then blade b at s + g/N is where
 * blade b - k was at s. So one segment, g/N of a period, is integrated. After it blade b becomes
 * blade b - k. A blade on the ground: E = 0, N = 1.
 *
 * In a mistuned ring no blade is like another. Every contact has its own transitions, in the time
 * of its own blade, and one segment is the whole period. */
#ifndef MHB_FLOQUET_TRANSITION_SCHEDULE_H
#define MHB_FLOQUET_TRANSITION_SCHEDULE_H

#include "mesh/base/arena.h"
#include "mhb/contact/contact.h"

typedef struct {
  double at;      /* phase after the start, in (0, span] */
  int    contact; /* j = blade * pairs + pair */
  int    state;   /* mhb_state that begins */
  int    order;   /* among simultaneous events */
} mhb_event;

typedef struct {
  int        blades, pairs, wave;     /* N, pairs, E of the fundamental */
  int        orbits;                  /* contacts with transitions of their own: pairs; all */
  int        n_segments, blade_shift; /* N/g of a period; k */
  int        cell;                    /* blades of a cell of equal disturbances: N/g; N */
  double     start, span;             /* phase; 1/n_segments */
  int        n_events, capacity;
  mhb_event *event;          /* by time */
  int       *state;          /* [contact] mhb_state right after start */
  int       *constant_state; /* [contact] 1: the state lasts the whole period */
  shb_arena  arena;
} mhb_transition_schedule;

/* mistuned: every blade moves in its own way. */
void mhb_transition_schedule_create(int blades, int pairs, int wave, bool mistuned,
                                    mhb_transition_schedule *schedule);
void mhb_transition_schedule_destroy(mhb_transition_schedule *schedule);

/* Whether the contact law's result can be used: its error is below 1e-5 of the force scale and all
 * transitions are recorded. */
int mhb_transition_schedule_usable(const mhb_contact_info *info);

/* Set from the transitions of the contacts, info[orbit]. The start is right after the event that
 * leaves the fewest friction states. Returns 0 if there are too many events or one is unusable. */
int mhb_transition_schedule_set(mhb_transition_schedule *schedule, const mhb_contact_info *info);

/* Whose transitions and laws contact j has. */
static inline int mhb_transition_schedule_orbit(const mhb_transition_schedule *schedule,
                                                int                            contact) {
  return contact % schedule->orbits;
}

/* Phase of contact j's own blade at a phase after the start, in [0, 1). */
double mhb_transition_schedule_phase(const mhb_transition_schedule *schedule, int contact,
                                     double at);

/* Number of friction states of a contact: stick 2, slip 1, open or constantly stuck 0. */
static inline int mhb_friction_states(int state, int constant_state, double mu) {
  if (mu == 0 || state == MHB_SEPARATE) return 0;
  return state == MHB_SLIDE ? 1 : constant_state ? 0 : 2;
}

#endif
