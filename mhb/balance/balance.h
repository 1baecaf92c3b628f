/* The balance of harmonics (eq. 33) for all contact pairs: residual, exact Jacobian, slope by the parameter that is followed.
 *
 *   r(x, value) = u - [free - R p(u)],   x = (u) in real form [pair][3 (v, u, w)][2m+1], m
 * p is the force that acts back: (n - max(n0, 0), fu, fw) for a preload stated at equilibrium, (n, fu, fw) for an interference. */
#ifndef MHB_BALANCE_BALANCE_H
#define MHB_BALANCE_BALANCE_H

#include "mhb/contact/contact.h"
#include "mhb/problem/interfaces.h"
#include "mhb/problem/settings.h"
#include "mhb/structure/receptance.h"

/* What a pair did over the period, as far as its derivative is concerned. */
typedef enum {
  MHB_PAIR_NONLINEAR, /* slips or opens for a part of it */
  MHB_PAIR_STUCK,     /* dp_k/du_k = diag(kv, Ku), for k = 0 diag(kv, 0) */
  MHB_PAIR_AT_LIMIT,  /* the same, but that the mean friction depends on all of u */
  MHB_PAIR_OPEN       /* dp/du = 0 */
} mhb_pair_kind;

enum { MHB_BY_PRELOAD = 2 };

/* Everything that an evaluation leaves. A point of a curve that owns one can be linearised again. */
typedef struct {
  mhb_operating_point at;                      /* where; `value` below sets its parameter */
  mhb_operating_point own[MHB_MAX_INTERFACES]; /* of each interface, for the laws */
  double             *p;                       /* [n] force in real form, as x */
  double             *dp;           /* [pair][3 nb][3 nb] dp/dx, of the last linearisation */
  int                *linear_dp;    /* [pair] kind whose derivative dp holds, -1: another one */
  mhb_pair_kind      *kind;         /* [pair] of the last linearisation */
  mhb_contact_info   *info;         /* [pair] */
  double             *by_parameter; /* [n] dp/dparameter, of the last evaluation with slope */
} mhb_evaluation;

typedef struct {
  const mhb_settings     *settings;
  mhb_receptance         *receptance; /* harmonics 0..m at least */
  int                     owns_receptance;
  mhb_contact_evaluator  *contact;  /* forces to harmonic m: that of thread 0 */
  mhb_contact_evaluator **contacts; /* [thread] */
  int                     n_threads;
  mhb_law                *law;               /* [pair] shares of the interface, at eval->at */
  int                     m, n_pairs, nb, n; /* nb = 2m+1, n = 3 pairs nb unknowns */
  mhb_parameter           parameter; /* what the argument `value` of the functions below is */
  int                     n_interfaces;
  int                     n_laws;  /* counts changes of law */
  double complex         *pk, *uk; /* [3 pairs] one harmonic */
  mhb_evaluation         *eval;    /* the one in use: evaluations write it, condensation reads it */
  mhb_evaluation         *first;   /* in use after creation, owned */
} mhb_balance;

shb_status mhb_balance_create(const modal_model *model, const mhb_settings *settings,
                              mhb_balance **residual);

/* On a receptance of the same settings, for as many harmonics or more, which must outlive it and may serve others. */
shb_status mhb_balance_create_on(mhb_receptance *receptance, const mhb_settings *settings,
                                 mhb_balance **residual);
void       mhb_balance_destroy(mhb_balance *residual);

/* An evaluation for this balance, at its operating point and not made yet. SHB_ERR_IO: no memory. */
shb_status mhb_evaluation_create(const mhb_balance *balance, mhb_evaluation **evaluation);
void       mhb_evaluation_destroy(mhb_evaluation *evaluation);

/* Use this evaluation from here on; NULL: the balance's own. The operating point becomes the one
 * it was made at: laws and receptance follow. An operating point, a preload or a tie that was set
 * while another evaluation was in use is not known to it. */
void mhb_balance_use(mhb_balance *balance, mhb_evaluation *evaluation);

/* Everything that evaluations do not set by `value`. */
void mhb_balance_set_operating_point(mhb_balance *residual, const mhb_operating_point *condition);

/* Preload of the (leading) interface, N: shared out to the pairs. */
void mhb_balance_set_preload(mhb_balance *residual, double n0);

/* From here on `value` is that of the parameter: rad/s for the frequency (as after creation), else as in the case. */
void mhb_balance_set_parameter(mhb_balance *residual, mhb_parameter parameter);

/* The condition at a value of the parameter. */
void mhb_balance_set_value(mhb_balance *residual, double value);

/* As below, and always the derivatives dp and the kinds; the Jacobian is left to mhb/condensed. */
void mhb_balance_linearise(mhb_balance *residual, const double *x, double value, double *r,
                           double *slope);

/* The rows of dp that are the mean friction of a pair, [3 nb]: axis 1 u, 2 w. */
static inline double *mhb_balance_mean_friction_row(const mhb_balance *residual, int pair,
                                                    int axis) {
  size_t nb = (size_t)residual->nb;
  return residual->eval->dp + ((size_t)(3 * pair + axis) * nb) * 3 * nb;
}

/* Two real rows, dp of harmonic k of a pair times the complex row R[3] over its axes:
 *   re, im  inout  [3 nb] += Re, Im of sum_c R[c] dp[c, k]; im is untouched for k = 0 */
void mhb_balance_row_times_dp(const mhb_balance *residual, const double complex R[3], int pair,
                              int k, double *re, double *im);

/* Evaluate at (x, value).
 *   r        out  [n] m
 *   jacobian out  [n][n] column-major dr/dx, or NULL
 *   slope    out  [n] dr/dvalue, or NULL */
void mhb_balance_evaluate(mhb_balance *residual, const double *x, double value, double *r,
                          double *jacobian, double *slope);

/* From here on the preloads of all interfaces move with it alike, or no longer. */
void mhb_balance_tie_preloads(mhb_balance *residual, int anchored);

/* Linear limits at a value: harmonics of the relative motion with the contact open everywhere, or stuck everywhere; or each pair
 * as its preload says (stuck: MHB_BY_PRELOAD). */
shb_status mhb_balance_linear_limit(mhb_balance *residual, double value, int stuck, double *x);

/* Forces of the last evaluation as complex harmonic k of all pairs. */
void mhb_balance_contact_force(const mhb_balance *residual, int k, double complex *p);

/* |x| of harmonics 1..m, which errors are measured by: a static part says nothing of the vibration. |x| if there is no other. */
double mhb_balance_vibration(const mhb_balance *residual, const double *x);

#endif
