/* The harmonic balance of all contact pairs (eq. 33): residual, exact Jacobian, slope by the
 * continuation parameter.
 *
 *   r(x, value) = u - [free - R p(u)],   x = (u) in real form [pair][3 (v, u, w)][2m+1], m
 *
 * free: motion without contact forces. R: receptance. p: the force on the pair, N; (n - max(n0, 0),
 * fu, fw) for a preload stated at equilibrium, (n, fu, fw) for an interference. */
#ifndef MHB_BALANCE_BALANCE_H
#define MHB_BALANCE_BALANCE_H

#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mhb/balance/stick_stiffness.h"
#include "mhb/contact/contact.h"
#include "mhb/low_rank/receptance_product.h"
#include "mhb/problem/interfaces.h"
#include "mhb/problem/settings.h"
#include "mhb/structure/receptance.h"

/* mhb_balance_linear_limit: pairs with a positive preload stick, the others are open. */
enum { MHB_BY_PRELOAD = 2 };

/* From this many pairs on the receptance is not formed, but multiplied (low_rank). Not in a run-up,
 * where the model changes with the frequency, nor in a ring, whose blocks are formed. */
enum { MHB_MANY_PAIRS = 8 };

/* Results of one evaluation. A point of a curve that owns its evaluation can be linearised
 * later. */
typedef struct {
  mhb_operating_point at;                      /* where; `value` below sets its parameter */
  mhb_operating_point own[MHB_MAX_INTERFACES]; /* of each interface, for the laws */
  double             *p;                       /* [n] force in real form, as x, N */
  double             *dp;        /* [pair][3 nb][3 nb] dp/dx, of the last linearisation, N/m */
  int                *linear_dp; /* [pair] mhb_pair_kind of the linear derivative that dp holds; -1:
                                    dp is not one of them */
  mhb_pair_kind      *kind;      /* [pair] of the last linearisation */
  mhb_contact_info   *info;      /* [pair] */
  double             *by_parameter; /* [n] dp/dparameter, of the last evaluation with slope */
  bool                near; /* in: x is near that of the last evaluation. Many pairs, and those of
                             * a ring, start their sliders from there, which moves forces within the
                             * law's tolerance; false: nothing from before enters */
  shb_arena           arena;
} mhb_evaluation;

typedef struct {
  const mhb_settings     *settings;
  mhb_receptance         *receptance; /* harmonics 0..m at least */
  int                     owns_receptance;
  mhb_receptance_product *product; /* of many pairs; NULL: R is formed */
  double negligible; /* in: error of that product in a residual, where I is 1; 0 at first */
  struct mhb_stuck_solver *stuck;    /* linear limits of many pairs; NULL: not used yet */
  mhb_contact_evaluator   *contact;  /* forces to harmonic m: that of thread 0 */
  mhb_contact_evaluator  **contacts; /* [thread] */
  int                      n_threads;
  mhb_law                 *law;               /* [pair] shares of the interface, at eval->at */
  int                      m, n_pairs, nb, n; /* nb = 2m+1, n = 3 pairs nb unknowns */
  mhb_parameter            parameter;         /* continuation parameter: meaning of `value` below */
  int                      n_interfaces;
  int                      n_laws;             /* counts changes of law */
  long                     n_linearised;       /* counts evaluations with derivative */
  double complex          *force_k, *motion_k; /* [3 pairs] one harmonic */
  double complex      *lag; /* [blades][m + 1] of a ring; else NULL: exp(-j k b phi/nu), by which
                                * the tuned wave lags at blade b */
  const mhb_pair_kind *assumed; /* [pair] kinds that stuck and open pairs are taken to have by
                                 * evaluations without derivative, without their law; or NULL */
  const bool     *touching; /* [pair] true: stuck with the mean friction of two phases that touch
                                  * (slip_onset.h), whether or not the motion is beyond that; or
                                  * NULL. Not in a mistuned ring */
  mhb_evaluation *eval;     /* in use: evaluations write it */
  mhb_evaluation *default_evaluation; /* in use after creation; owned */
  shb_arena       arena;
} mhb_balance;

shb_status mhb_balance_create(const modal_model *model, const mhb_settings *settings,
                              mhb_balance **balance);

/* On a receptance of the same settings with as many harmonics or more. The receptance must outlive
 * the balance and may serve others. */
shb_status mhb_balance_create_on(mhb_receptance *receptance, const mhb_settings *settings,
                                 mhb_balance **balance);
void       mhb_balance_destroy(mhb_balance *balance);

/* Products with harmonics first..m of a receptance. Their accuracy is measured by the balance's
 * laws. */
mhb_receptance_product *mhb_balance_product(const mhb_balance *balance, mhb_receptance *receptance,
                                            int first, int m);

/* An evaluation for this balance, at its operating point; the results are not made yet. */
mhb_evaluation *mhb_evaluation_create(const mhb_balance *balance);
void            mhb_evaluation_destroy(mhb_evaluation *evaluation);

/* Use this evaluation from here on; NULL: the balance's own. Its operating point becomes the
 * balance's: laws and receptance follow. Trap: an operating point, preload or tie that was set
 * while another evaluation was in use is not known to this one. */
void mhb_balance_use(mhb_balance *balance, mhb_evaluation *evaluation);

/* The contact law of evaluations from now on has a tolerance of this share of the settings'. */
void mhb_balance_sharpen_law(mhb_balance *balance, double share);

/* Destroy an evaluation; if it is in use, the balance's own takes its place. */
void mhb_balance_discard(mhb_balance *balance, mhb_evaluation *evaluation);

/* Set the operating point of the evaluation in use. */
void mhb_balance_set_operating_point(mhb_balance *balance, const mhb_operating_point *at);

/* Preload of the leading interface, N; the pairs have their shares of it. */
void mhb_balance_set_preload(mhb_balance *balance, double n0);

/* Continuation parameter from here on; the frequency after creation. Values of the frequency are in
 * rad/s, all others as in the case file. */
void mhb_balance_set_parameter(mhb_balance *balance, mhb_parameter parameter);

/* Set the operating point at a value of the parameter. */
void mhb_balance_set_value(mhb_balance *balance, double value);

/* The same at a value of any parameter. The frequency is the continuation parameter then. */
void mhb_balance_go_to(mhb_balance *balance, mhb_parameter parameter, double value);

/* From here on the preloads of all interfaces change by the same amount, or no longer. */
void mhb_balance_tie_preloads(mhb_balance *balance, int anchored);

/* Evaluate at (x, value).
 *   r        out  [n] m
 *   jacobian out  [n][n] column-major dr/dx, or NULL
 *   slope    out  [n] dr/dvalue, or NULL */
void mhb_balance_evaluate(mhb_balance *balance, const double *x, double value, double *r,
                          double *jacobian, double *slope);

/* As mhb_balance_evaluate, with dp and the kinds of the pairs in place of the Jacobian: the factors
 * of mhb_condensation. */
void mhb_balance_linearise(mhb_balance *balance, const double *x, double value, double *r,
                           double *slope);

/* r[n] <- x[n] - free + R p of many pairs, p the forces of the evaluation in use. */
void mhb_balance_residual_of_many(mhb_balance *balance, const double *x, double *r);

/* slope[n] <- dr/dparameter at x[n], which the evaluation in use was linearised at; no new
 * evaluation of the law. by_parameter of the evaluation becomes that of this parameter; for the
 * frequency it stays. */
void mhb_balance_slope(mhb_balance *balance, const double *x, mhb_parameter parameter,
                       double *slope);

/* u[3 pairs] <- (I + R_k S)^-1 u of many pairs, each stuck or open by kind[pair], without R_k
 * (stuck_solver.h). The load of harmonic k must be up to date. false: few pairs, a ring or a disc,
 * or it did not converge; u is then as before. */
bool mhb_balance_solve_many_stuck(mhb_balance *balance, int k, const mhb_pair_kind *kind,
                                  double complex *u);

/* Slider that the law of a pair may start from: that of the last evaluation with many pairs or in a
 * ring, else NULL. */
static inline const double *mhb_balance_slider(const mhb_balance *balance, int pair) {
  return balance->product || balance->receptance->ring ? balance->eval->info[pair].slider : NULL;
}

/* Rows of dp that are the mean friction of a pair, [3 nb]; axis 1 u, 2 w. */
static inline double *mhb_balance_mean_friction_row(const mhb_balance *balance, int pair,
                                                    int axis) {
  size_t nb = (size_t)balance->nb;
  return balance->eval->dp + ((size_t)(3 * pair + axis) * nb) * 3 * nb;
}

/* Harmonic k of a complex row R[3] over the axes of a pair times its dp, as two real rows.
 *   re, im  inout  [3 nb] += Re, Im of sum_c R[c] dp[c, k]; im is untouched for k = 0 */
void mhb_balance_row_times_dp(const mhb_balance *balance, const double complex R[3], int pair,
                              int k, double *re, double *im);

/* Motion x[n] at a value in a linear limit: all pairs open (stuck = 0), all stuck (1), or each by
 * its preload (MHB_BY_PRELOAD). The evaluation in use gets its forces p only. Errors: SHB_ERR_INPUT
 * the stuck system is singular. */
shb_status mhb_balance_linear_limit(mhb_balance *balance, double value, int stuck, double *x);

/* Complex harmonic k of x[n]: out[3 pairs]; and back from in[3 pairs]. */
void mhb_balance_get_harmonic(const mhb_balance *balance, const double *x, int k,
                              double complex *out);
void mhb_balance_put_harmonic(const mhb_balance *balance, double *x, int k,
                              const double complex *in);

/* Forces of the evaluation in use: complex harmonic k of all pairs, p[3 pairs] N. */
void mhb_balance_contact_force(const mhb_balance *balance, int k, double complex *p);

/* What the motions of the probes at harmonic k need of the receptance. With many pairs that is not
 * R. */
void mhb_balance_update_probes(const mhb_balance *balance, int k);

/* Whether every pair of the evaluation in use is stuck or open over the whole period. The forces
 * then have the harmonics of the motion and no others. */
bool mhb_balance_is_linear(const mhb_balance *balance);

/* Size of the vibration, by which errors are measured: |x| of harmonics 1..m, or |x| if these are
 * 0. */
double mhb_balance_vibration(const mhb_balance *balance, const double *x);

#endif
