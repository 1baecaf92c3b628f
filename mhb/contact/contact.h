/* Stick, slip and separation in three dimensions: force harmonics of a periodic motion and their
 * exact derivative.
 *
 *   n = max(n0 + kv v, 0);  stick f = Ku (s - s0) + f0 while |f| < mu n;
 *   slip |f| = mu n, eq. 9;  open f = 0.
 *
 * Where the contact opens, the state after each closing is known and one lap suffices. Where it
 * stays closed and slips, the periodic slider is found by Newton's method on the 2x2 lap map. Where
 * it never slips, see static_friction.h.
 *
 * Signals are in real form (fourier.h): motion[3][2m+1] for (v, u, w), force[3][2H+1] for (n, fu,
 * fw), H >= m. Source: Chen, Yang, Menq 1999, eqs. 4-15. Differs: event times from the harmonics
 * with bounds, slip by Gauss collocation, force by quadrature of each smooth piece (no sampling, no
 * aliasing). Derivation: docs/theory/contact.md. */
#ifndef MHB_CONTACT_CONTACT_H
#define MHB_CONTACT_CONTACT_H

#include "mesh/base/status.h"
#include "mhb/contact/law.h"

enum { MHB_MAX_TRANSITIONS = 512 };

/* Results of one evaluation besides the force. */
typedef struct {
  double         share[3];     /* of the period stuck, slipping, open */
  double         dissipation;  /* J a cycle, from the harmonics: loop integral of f.ds */
  double         slip_work;    /* J a cycle, summed over the slip pieces */
  double         error;        /* estimate, relative to the largest force harmonic */
  int            undetermined; /* the mean friction is a convention (stuck throughout) */
  int            laps;         /* until the slider was periodic */
  int            lost;         /* 1: no periodic slider or panel to tolerance; error says how far */
  double         slider[2];    /* N, Ku s0 at phase 0 of a contact that stays closed and slips; else
                                * not a number */
  int            n_transitions;
  mhb_transition transition[MHB_MAX_TRANSITIONS];
} mhb_contact_info;

/* Workspace of the law: FFTW plans and all arrays. One a thread. */
typedef struct mhb_contact_evaluator mhb_contact_evaluator;

/* For motions of up to m harmonics and forces of up to H >= m; tolerance relative (1e-8: panels
 * that resolve harmonic H). SHB_ERR_IO: no memory. */
shb_status mhb_contact_evaluator_create(int m, int H, double tolerance,
                                        mhb_contact_evaluator **contact);
void       mhb_contact_evaluator_destroy(mhb_contact_evaluator *contact);

/* Evaluations from now on have this tolerance. */
void mhb_contact_evaluator_set_tolerance(mhb_contact_evaluator *contact, double tolerance);

/* Force harmonics (n - mean_offset, fu, fw).
 *   motion    in   [3][2m+1], m
 *   force     out  [3][2H+1], N
 *   jacobian  out  d force / d motion, [3 (2H+1)][3 (2m+1)] row-major, N/m, or NULL
 * Never fails: a slider that is not periodic shows in info->lost and info->error. A motion that is
 * not finite gives NaN. Where slip just begins the derivative of the periodic slider is unbounded:
 * det(I - DP) is held above 1e-7. */
void mhb_contact_force(mhb_contact_evaluator *contact, const mhb_law *law, const double *motion,
                       double *force, double *jacobian, mhb_contact_info *info);

/* The same from the slider of a motion nearby: its info->slider, or NULL. It saves laps. The force
 * is the same to the tolerance. */
void mhb_contact_force_near(mhb_contact_evaluator *contact, const mhb_law *law,
                            const double *slider, const double *motion, double *force,
                            double *jacobian, mhb_contact_info *info);

/* After an evaluation that found the contact stuck throughout: gradient[2] -> [3 (2m+1)] <- d/d
 * motion of the mean friction, N/m. The stiffnesses give all other derivatives. */
void mhb_contact_mean_gradient(const mhb_contact_evaluator *contact, double *const gradient[2]);

#endif
