/* The contacts of a blade or ring on their way through a period: how they answer a disturbance over each sub-step, and what
 * their transitions do to it.
 *
 * A stretch of time is walked through twice with the same calls: first only the phases are noted at which slipping contacts
 * must be looked at (one trace of the law gives them all), then the looks are used in the same order. */
#ifndef MHB_FLOQUET_ORBIT_CONTACTS_H
#define MHB_FLOQUET_ORBIT_CONTACTS_H

#include "mhb/contact/contact.h"
#include "mhb/contact/time_history.h"
#include "mhb/floquet/linearised_law.h"
#include "mhb/floquet/transition_schedule.h"
#include "mhb/floquet/variational.h"

/* A solution of the balance and what the contact law said of it. */
typedef struct {
  double                  omega; /* rad/s, of the excitation */
  const mhb_law          *law;   /* [pair] */
  const mhb_contact_info *info;  /* [pair] of mhb_contact_force at x */
  const double           *x;     /* [pair][3][2m+1] relative motion, real form (fourier.h), m */
  const double           *p; /* the same shape: force, N; needed with residual flexibility only */
} mhb_solution;

typedef struct {
  const mhb_modal_structure     *structure;
  const mhb_transition_schedule *schedule;
  mhb_contact_evaluator         *contact;
  int                            m, nb; /* harmonics; 2m+1 */
  const mhb_solution            *solution;
  double                         omega;                /* rad/s, fundamental */
  double                        *motion;               /* [pair][3][nb] w = u + R p */
  mhb_contact_sample            *sample;               /* [pair][room] */
  int                            capacity, first_pass; /* looks a pair; noted now, not used */
  int                           *n_taken;              /* [pair] looks noted, or used */
  mhb_contact_info               info;                 /* of a trace */
  mhb_contact_state             *point;                /* [contact] now */
  double                        *matrix;               /* [n][n] I + G R, n = 3 contacts */
  int                           *pivot;                /* [n] */
  double *force_rate, *force_jump, *elastic_feedback;  /* [n] p' before and after, -R p' */
  double *basis;                                       /* [2][nb] */
} mhb_orbit_contacts;

/* Room for a number of looks at each contact of a pair. SHB_ERR_IO: no memory. */
shb_status mhb_orbit_contacts_create(const mhb_modal_structure     *structure,
                                     const mhb_transition_schedule *schedule,
                                     mhb_contact_evaluator *contact, int m, int n_samples,
                                     mhb_orbit_contacts **orbit);
void       mhb_orbit_contacts_destroy(mhb_orbit_contacts *orbit);

/* The solution to walk along; omega: of the fundamental. */
void mhb_orbit_contacts_set_solution(mhb_orbit_contacts *orbit, const mhb_solution *solution,
                                     double omega);

/* Go to the start of the timetable. */
void mhb_orbit_contacts_begin(mhb_orbit_contacts *orbit, int first_pass);

/* The looks that were noted. 0: the contact law was lost. */
int mhb_orbit_contacts_evaluate_samples(mhb_orbit_contacts *orbit);

/* Does any contact slip now? */
int mhb_orbit_contacts_any_slips(const mhb_orbit_contacts *orbit);

/* Relations of the contacts over h seconds around the phase middle; unless first, only of those that slip. 0: singular. */
int mhb_orbit_contacts_linearise(mhb_orbit_contacts *orbit, double middle, double h, int first,
                                 mhb_linearised_law *linearised);

/* Pass a transition, and the variation with it. 0: singular. */
int mhb_orbit_contacts_event(mhb_orbit_contacts *orbit, const mhb_event *event,
                             mhb_variational *variational);

#endif
