/* The contacts along the periodic motion: their linearised laws over each sub-step and their jumps
 * at transitions.
 *
 * The interval is passed twice with the same calls. The first pass collects the phases at which
 * slipping contacts are sampled; one time history of the law a pair then gives all samples. The
 * second pass uses the samples in the same order. */
#ifndef MHB_FLOQUET_ORBIT_CONTACTS_H
#define MHB_FLOQUET_ORBIT_CONTACTS_H

#include "mesh/base/arena.h"
#include "mhb/contact/contact.h"
#include "mhb/contact/time_history.h"
#include "mhb/floquet/transition_schedule.h"
#include "mhb/variation/linearised_law.h"
#include "mhb/variation/variational.h"

/* A solution of the harmonic balance with the results of the contact law. Of a mistuned ring the
 * pairs are all contacts; info is in the time of each contact's own blade, x and p are not. */
typedef struct {
  double                  omega; /* rad/s, of the excitation */
  const mhb_law          *law;   /* [pair] */
  const mhb_contact_info *info;  /* [pair] of mhb_contact_force at x */
  const double           *x;     /* [pair][3][2m+1] relative motion, real form (fourier.h), m */
  const double           *p;     /* [pair][3][2m+1] force, N; used with residual flexibility only */
  int                     m;     /* harmonics of both, at most the workspace's */
} mhb_solution;

typedef struct {
  const mhb_modal_structure     *structure;
  const mhb_transition_schedule *schedule;
  mhb_contact_evaluator         *contact;
  int                            m, nb; /* harmonics; 2m+1 */
  const mhb_solution            *solution;
  double                         omega;  /* rad/s, fundamental */
  double                        *own;    /* [orbit][3][nb] x, in the time of its own blade */
  double                        *motion; /* [orbit][3][nb] w = u + R p, likewise */
  mhb_contact_sample            *sample; /* [orbit][capacity]; pages are touched as they are used */
  int                            capacity;   /* samples an orbit */
  int                            first_pass; /* 1: phases are collected; 0: samples are used */
  int                           *n_taken;    /* [orbit] samples collected or used */
  mhb_contact_info               info;       /* of a time history */
  mhb_contact_state             *point;      /* [contact] now */
  mhb_ring_band                  band;       /* I + G R, n = 3 contacts */
  mhb_columns                   *solution_columns; /* [2][n] */
  double                        *force_rate;       /* [n] p' */
  double                        *force_jump;       /* [n] jump of the forces at a transition */
  double                        *elastic_feedback; /* [n] -R p' */
  double                        *basis;            /* [2][nb] */
  shb_arena                      arena;
} mhb_orbit_contacts;

/* For n_samples samples of each contact. */
mhb_orbit_contacts *mhb_orbit_contacts_create(const mhb_modal_structure     *structure,
                                              const mhb_transition_schedule *schedule,
                                              mhb_contact_evaluator *contact, int m, int n_samples);
void                mhb_orbit_contacts_destroy(mhb_orbit_contacts *orbit);

/* Solution of both passes; omega: of the fundamental, rad/s. */
void mhb_orbit_contacts_set_solution(mhb_orbit_contacts *orbit, const mhb_solution *solution,
                                     double omega);

/* Go to the start of the schedule. */
void mhb_orbit_contacts_begin(mhb_orbit_contacts *orbit, int first_pass);

/* Evaluate the samples collected by the first pass. Returns 0 if the contact law failed. */
int mhb_orbit_contacts_evaluate_samples(mhb_orbit_contacts *orbit);

/* Whether a contact is a spring now: it sticks, or is closed without friction. */
bool mhb_orbit_contacts_is_spring(const mhb_orbit_contacts *orbit, int contact);

/* Whether any contact slips now. */
int mhb_orbit_contacts_any_slips(const mhb_orbit_contacts *orbit);

/* Linearised laws over h seconds around the phase middle: of all contacts if first, else of those
 * that slip. Returns 0 if singular. */
int mhb_orbit_contacts_linearise(mhb_orbit_contacts *orbit, double middle, double h, int first,
                                 mhb_linearised_law *linearised);

/* Pass a transition, with its jump of the variational rows. Returns 0 if singular. */
int mhb_orbit_contacts_event(mhb_orbit_contacts *orbit, const mhb_event *event,
                             mhb_variational *variational);

#endif
