#include "mhb/floquet/transition_schedule.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Events closer than this, in periods, are simultaneous. */
static const double CLOSE = 1e-12;

/* Largest error of the contact law, relative to the force scale, at which its transitions can still
 * be used. */
static const double USABLE_ERROR = 1e-5;

/* Events of a contact of a mistuned ring that there is room for, on average. */
enum { EVENTS_MISTUNED = 24 };

static int common_divisor(int a, int b) {
  while (b) {
    int rest = a % b;
    a        = b;
    b        = rest;
  }
  return a;
}

void mhb_transition_schedule_create(int blades, int pairs, int wave, bool mistuned,
                                    mhb_transition_schedule *t) {
  int E = ((wave % blades) + blades) % blades, g = common_divisor(blades, E);
  *t      = (mhb_transition_schedule){.blades     = blades,
                                      .pairs      = pairs,
                                      .wave       = E,
                                      .orbits     = mistuned ? blades * pairs : pairs,
                                      .n_segments = mistuned ? 1 : blades / g,
                                      .cell       = mistuned ? blades : blades / g};
  t->span = 1. / t->n_segments;
  while (!mistuned && ((long)t->blade_shift * E - g) % blades) t->blade_shift++;
  t->capacity       = 64 + (mistuned ? EVENTS_MISTUNED * blades : 64 * g) * pairs;
  size_t n          = (size_t)blades * (size_t)pairs;
  t->event          = shb_arena_take(&t->arena, (size_t)t->capacity, sizeof *t->event);
  t->state          = shb_arena_take(&t->arena, n, sizeof *t->state);
  t->constant_state = shb_arena_take(&t->arena, n, sizeof *t->constant_state);
}

void mhb_transition_schedule_destroy(mhb_transition_schedule *t) {
  shb_arena_free(&t->arena);
  *t = (mhb_transition_schedule){0};
}

static double fraction(double x) {
  x -= floor(x);
  return x < 1 ? x : 0;
}

/* Phase by which a contact's blade lags. */
static double lag(const mhb_transition_schedule *t, int contact) {
  return (double)((long)(contact / t->pairs) * t->wave % t->blades) / t->blades;
}

double mhb_transition_schedule_phase(const mhb_transition_schedule *t, int contact, double at) {
  return fraction(t->start + at - lag(t, contact));
}

/* State right after a phase. */
static int state_at(const mhb_contact_info *info, double phase) {
  if (info->n_transitions == 0) {
    int most = 0;
    for (int k = 1; k < 3; k++)
      if (info->share[k] > info->share[most]) most = k;
    return most;
  }
  int    state   = 0;
  double nearest = 2;
  for (int i = 0; i < info->n_transitions; i++) {
    double since = fraction(phase + CLOSE - info->transition[i].phase);
    if (since > nearest) continue;
    nearest = since;
    state   = info->transition[i].state;
  }
  return state;
}

static int is_constant(const mhb_contact_info *info) {
  return info->n_transitions == 0;
}

/* Number of friction states of all contacts at a phase. */
static int friction_states_at(const mhb_transition_schedule *t, const mhb_contact_info *info,
                              double phase) {
  int sum = 0;
  for (int j = 0; j < t->blades * t->pairs; j++) {
    const mhb_contact_info *of = &info[mhb_transition_schedule_orbit(t, j)];
    sum += mhb_friction_states(state_at(of, phase - lag(t, j)), is_constant(of), 1);
  }
  return sum;
}

static void choose_start(mhb_transition_schedule *t, const mhb_contact_info *info) {
  int least = -1;
  t->start  = 0;
  for (int a = 0; a < t->orbits; a++) {
    for (int i = 0; i < info[a].n_transitions; i++) {
      double at     = fraction(info[a].transition[i].phase + lag(t, a));
      int    states = friction_states_at(t, info, at);
      if (least >= 0 && states >= least) continue;
      least    = states;
      t->start = at;
    }
  }
}

static int later(const mhb_event *a, const mhb_event *b) {
  return a->at != b->at ? a->at > b->at : a->order > b->order;
}

/* Insertion sort: there are few events, and nothing is allocated. */
static void sort_events(mhb_transition_schedule *t) {
  for (int i = 1; i < t->n_events; i++) {
    mhb_event event = t->event[i];
    int       j     = i;
    for (; j > 0 && later(&t->event[j - 1], &event); j--) t->event[j] = t->event[j - 1];
    t->event[j] = event;
  }
}

/* Events of the interval. One at the start belongs to its end. */
static int list_events(mhb_transition_schedule *t, const mhb_contact_info *info) {
  t->n_events = 0;
  for (int j = 0; j < t->blades * t->pairs; j++) {
    const mhb_contact_info *of = &info[mhb_transition_schedule_orbit(t, j)];
    for (int i = 0; i < of->n_transitions; i++) {
      double at = fraction(of->transition[i].phase + lag(t, j) - t->start);
      if (at <= CLOSE) at += 1;
      if (at > t->span + CLOSE) continue;
      if (t->n_events == t->capacity) return 0;
      t->event[t->n_events] = (mhb_event){at, j, of->transition[i].state, t->n_events};
      t->n_events++;
    }
  }
  sort_events(t);
  return 1;
}

int mhb_transition_schedule_usable(const mhb_contact_info *info) {
  return (!info->lost || info->error <= USABLE_ERROR) && info->n_transitions < MHB_MAX_TRANSITIONS;
}

int mhb_transition_schedule_set(mhb_transition_schedule *t, const mhb_contact_info *info) {
  for (int a = 0; a < t->orbits; a++)
    if (!mhb_transition_schedule_usable(&info[a])) return 0;
  choose_start(t, info);
  for (int j = 0; j < t->blades * t->pairs; j++) {
    const mhb_contact_info *of = &info[mhb_transition_schedule_orbit(t, j)];
    t->state[j]                = state_at(of, t->start - lag(t, j));
    t->constant_state[j]       = is_constant(of);
  }
  return list_events(t, info);
}
