#include "mhb/continuation/balance_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/resonance_detection.h"
#include "mhb/search/ring_symmetry.h"

/* A law with a larger tolerance has jumps that mislead chord steps. */
static const double SMOOTH = 1e-5;

/* Residual of a curve in outline, relative to the motion. On 120 random contacts of
 * cases/z_notch_blade its points cost two thirds of those with 1e-10, and no peak is missed. */
static const double OUTLINE = 1e-4;

/* Units of the preload: the preload itself, or the normal force of the motion, times this. */
static const double PRELOAD_UNIT = 4;
enum { MAX_MEAN_STEPS = 6 };

static mhb_balance_curve *of(const mhb_curve_system *system) {
  return (mhb_balance_curve *)system;
}

static void destroy(mhb_curve_system *system) {
  mhb_balance_curve *s = of(system);
  mhb_balance_use(s->balance, NULL);
  mhb_newton_destroy(s->newton);
  mhb_linear_corrector_destroy(s->linear);
  mhb_resonances_destroy(&s->resonances);
  free(s);
}

static mhb_evaluation *evaluation_create(mhb_curve_system *system) {
  return mhb_evaluation_create(of(system)->balance);
}

static void evaluation_destroy(mhb_curve_system *system, mhb_evaluation *evaluation) {
  mhb_balance_discard(of(system)->balance, evaluation);
}

static void linearise(mhb_curve_system *system, mhb_curve_point *point) {
  mhb_balance *b = of(system)->balance;
  mhb_balance_use(b, point->evaluation);
  b->eval->near = point->near;
  mhb_balance_linearise(b, point->x, point->value, point->r, point->slope);
  b->eval->near = false;
}

static void evaluate(mhb_curve_system *system, mhb_curve_point *point) {
  mhb_balance *b = of(system)->balance;
  mhb_balance_use(b, point->evaluation);
  b->eval->near = point->near;
  mhb_balance_evaluate(b, point->x, point->value, point->r, NULL, NULL);
  b->eval->near = false;
}

static int factor(mhb_curve_system *system, const mhb_curve_point *point, const double *column,
                  const double *row) {
  mhb_balance_use(of(system)->balance, point->evaluation);
  return mhb_condensation_factor(of(system)->newton->system, column, row);
}

static int solve(mhb_curve_system *system, double *rhs) {
  return mhb_condensation_solve(of(system)->newton->system, rhs);
}

static int sign(const mhb_curve_system *system) {
  return mhb_condensation_sign(of(system)->newton->system);
}

static mhb_reason solve_at_value(mhb_curve_system *system, double tolerance,
                                 mhb_curve_point *point) {
  mhb_balance_curve *s = of(system);
  mhb_balance_use(s->balance, point->evaluation);
  return mhb_newton_solve(s->newton, s->balance, point->value, tolerance, point->x,
                          &point->iterations);
}

/* The same motion, j periods of the excitation later. */
static void copy(const mhb_curve_system *system, const double *x, int j, double *to) {
  mhb_motion_copy(of(system)->balance, x, j, to);
}

/* The open limit (0) and the stuck limit (1). */
static bool start_of_newton(mhb_curve_system *system, double value, int which, double *x) {
  mhb_balance *b = of(system)->balance;
  mhb_balance_use(b, NULL);
  return which < 2 && mhb_balance_linear_limit(b, value, which, x) == SHB_OK;
}

static bool is_linear(const mhb_curve_system *system, const mhb_curve_point *point) {
  const mhb_balance *b = of(system)->balance;
  for (int a = 0; a < b->n_pairs; a++)
    if (point->evaluation->kind[a] == MHB_PAIR_NONLINEAR) return false;
  return true;
}

/* Harmonics k > 0 without the law, then the means by Newton's method. The means leave the plane by
 * a negligible amount. */
static int correct_linear(mhb_arclength *curve, const mhb_curve_point *regime, const double *normal,
                          mhb_curve_point *point) {
  mhb_balance_curve *s    = mhb_balance_curve_of(curve);
  mhb_balance       *b    = s->balance;
  double             unit = mhb_arclength_unit(curve), scale = curve->parameter_scale;
  double             before = INFINITY;
  int                slides;
  mhb_linear_set_states(s->linear, regime->evaluation, b->n_pairs);
  mhb_balance_use(b, point->evaluation);
  if (!mhb_linear_correct(s->linear, b, normal, 1 / (unit * unit), 1 / (scale * scale), point->x,
                          &point->value, &slides))
    return 0;
  for (int i = 0; i <= MAX_MEAN_STEPS; i++) {
    mhb_arclength_measure(curve, point);
    if (!mhb_linear_states_hold(s->linear, point->evaluation, b->n_pairs)) return 0;
    bool rounded = point->residual < curve->roundoff_level && point->residual > 0.5 * before;
    if (point->residual <= curve->tolerance || rounded) {
      point->iterations = i > slides - 1 ? i : slides - 1;
      return 1;
    }
    if (!(point->residual < 0.5 * before)) return 0;
    if (!mhb_linear_correct_means(s->linear, b, point->r, i > 0, point->x)) return 0;
    before = point->residual;
  }
  return 0;
}

/* A preload is measured by itself or by the normal force of the motion, whichever is larger. In a
 * wide range a step would else pass the opening and slip of the contact. */
static double unit_of_preload(const mhb_curve_system *system, const mhb_curve_point *point) {
  const mhb_balance *b      = of(system)->balance;
  double             normal = point->evaluation->at.kv * mhb_norm(point->x, b->n);
  double             unit   = PRELOAD_UNIT * fmax(fabs(point->value), normal);
  return unit > 0 ? unit : INFINITY;
}

static double resonance_step_limit(const mhb_curve_system *system, double value, int direction) {
  return mhb_resonances_step_limit(&of(system)->resonances, value, direction);
}

static bool resonance_skipped(mhb_arclength *curve) {
  return mhb_resonance_skipped(curve, mhb_curve_balance(curve),
                               &mhb_balance_curve_of(curve)->resonances);
}

mhb_arclength *mhb_balance_curve_create(mhb_balance *b, double low, double high) {
  mhb_balance_curve *s         = shb_alloc_zeroed(1, sizeof *s);
  bool               frequency = b->parameter == MHB_IN_FREQUENCY;
  s->balance                   = b;

  s->base = (mhb_curve_system){.n                  = b->n,
                               .least              = mhb_parameter_least(b->parameter),
                               .relative           = frequency,
                               .smooth             = b->settings->tolerance <= SMOOTH,
                               .costly             = b->receptance->ring != NULL,
                               .bends              = b->receptance->ring || b->product,
                               .brief_events       = b->receptance->ring != NULL,
                               .row_length         = b->nb,
                               .copies             = mhb_motion_copies(b),
                               .copy               = copy,
                               .destroy            = destroy,
                               .evaluation_create  = evaluation_create,
                               .evaluation_destroy = evaluation_destroy,
                               .linearise          = linearise,
                               .evaluate           = evaluate,
                               .factor             = factor,
                               .solve              = solve,
                               .sign               = sign,
                               .solve_at_value     = solve_at_value,
                               .start_of_newton    = start_of_newton,
                               .is_linear          = is_linear};
  if (frequency && !b->receptance->ring) {
    s->base.correct_linear       = correct_linear;
    s->base.resonance_step_limit = resonance_step_limit;
    s->base.resonance_skipped    = resonance_skipped;
  }
  if (b->parameter == MHB_IN_N0) s->base.unit_of_value = unit_of_preload;
  s->newton = mhb_newton_create(b->n);
  mhb_newton_bind(s->newton, b);
  if (!b->receptance->ring) {
    s->linear = mhb_linear_corrector_create(b);
    mhb_resonances_create(b, low, high, &s->resonances);
  }
  mhb_arclength *curve  = mhb_arclength_create(&s->base, low, high);
  curve->roundoff_level = fmax(curve->roundoff_level, 0.1 * b->settings->tolerance);
  if (b->settings->outline) curve->tolerance = OUTLINE;
  return curve;
}
