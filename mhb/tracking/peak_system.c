#include "mhb/tracking/peak_system.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/vector.h"

/* Step of the directional difference, relative to |z|. */
static const double STEP       = 1e-6;
static const double LEAST_GAIN = 0.99;

/* G of a multiplier, in lengths of the motion: the residual's tolerance of 1e-10 is 1e-8 of the
 * multiplier, and 1e-6 counts as round-off. */
static const double MULTIPLIER_WEIGHT = 0.01;

/* A point is a solution of the balance from this relative distance on. */
static const double ON_SURFACE = 1e-12;

/* Newton's method for a peak at a value is given up if three iterations gain less than this. */
static const double SLOW_GAIN = 0.5;

/* G is a slope, and its round-off beside the motion is that of the curvature. Newton's method may
 * end by it. The peak is known if the residual is within the first factor of the tolerance, and the
 * next step below this part of the motion. */
static const double ROUNDED_RESIDUAL = 1e3, ROUNDED_STEP = 1e-10;
enum { MAX_NEWTON = 25, MAX_HALVINGS = 8, MAX_HALVINGS_OF_PEAK = 3 };

struct mhb_peak_system {
  mhb_curve_system  base; /* first: its functions get it back */
  mhb_balance      *balance;
  mhb_tracked_point kind;
  int               output;
  mhb_parameter     parameter;
  double            rate;       /* d omega/d xi */
  double            length;     /* m */
  double            least_unit; /* of q */
  int               n;          /* unknowns of the balance; the system has one more */

  /* the point that was linearised last */
  double         *z; /* [n + 1]; NAN: none */
  double          value;
  double         *matrix; /* [n + 1][n + 1] column-major: derivative of (r, G) by z */
  mhb_peak_report report;

  /* work space of one linearisation */
  mhb_evaluation           *displaced;
  mhb_multiplier_condition *condition; /* of flips and Neimark-Sacker points, else NULL */
  mhb_amplitude             amplitude;
  double                   *jacobian;          /* [n][n] column-major */
  double                   *by_xi, *by_q;      /* [n] r_xi, r_q */
  double                   *gradient;          /* [n + 1] A_z */
  double                   *bordered;          /* [n + 1][n + 1] B, factored */
  double                   *border;            /* [n + 1] c */
  double                   *tangent, *adjoint; /* [n + 1] T; l, k */
  double                   *moved, *moved_r;   /* [n + 1], [n] */
  lapack_int               *pivot;             /* [n + 2] */
  /* the bordered matrix of the continuation */
  double     *step_matrix; /* [n + 2][n + 2] column-major, factored */
  lapack_int *step_pivot;  /* [n + 2] */
  int         step_sign;
  shb_arena   arena;
};

static mhb_peak_system *of(const mhb_curve_system *system) {
  return (mhb_peak_system *)system;
}

mhb_curve_system *mhb_peak_system_base(mhb_peak_system *system) {
  return &system->base;
}

double mhb_peak_system_omega(const mhb_curve_system *system, const double *z) {
  return z[of(system)->n] * of(system)->rate;
}

double mhb_peak_system_rate(const mhb_curve_system *system) {
  return of(system)->rate;
}

void mhb_peak_system_pack(const mhb_curve_system *system, const double *x, double omega,
                          double *z) {
  const mhb_peak_system *s = of(system);
  memmove(z, x, sizeof(double) * (size_t)s->n);
  z[s->n] = omega / s->rate;
}

/* ---- the Lagrangian A - l^T r and its derivatives by z and q ---- */

/* r, Jacobian, r_xi, r_q of the balance and A_z at (z, q), in the evaluation given.
 * Returns A_q. */
static double derivatives(mhb_peak_system *s, mhb_evaluation *evaluation, const double *z,
                          double value, double *r) {
  mhb_balance *b = s->balance;
  mhb_balance_use(b, evaluation);
  mhb_balance_go_to(b, s->parameter, value);
  mhb_balance_evaluate(b, z, z[s->n] * s->rate, r, s->jacobian, s->by_xi);
  mhb_balance_slope(b, z, s->parameter, s->by_q);
  for (int i = 0; i < s->n; i++) s->by_xi[i] *= s->rate;
  s->amplitude.by_x = s->gradient;
  mhb_output_amplitude(b, z, s->output, &s->amplitude);
  s->gradient[s->n] = s->amplitude.by_omega * s->rate;
  if (s->kind == MHB_TRACK_PEAK)
    return mhb_amplitude_by_parameter(b, &s->amplitude, s->parameter, b->eval->by_parameter);
  memset(s->gradient, 0, sizeof(double) * (size_t)s->n);
  s->gradient[s->n] = 1;
  return 0;
}

/* row[n + 1] <- A_z - l^T [r_x r_xi] */
static void lagrangian_gradient(const mhb_peak_system *s, double *row) {
  for (int i = 0; i < s->n; i++)
    row[i] = s->gradient[i] - mhb_dot(s->n, s->adjoint, s->jacobian + (size_t)i * (size_t)s->n);
  row[s->n] = s->gradient[s->n] - mhb_dot(s->n, s->adjoint, s->by_xi);
}

/* Factor B = [r_x r_xi; border]. */
static bool factor_bordered(mhb_peak_system *s) {
  lapack_int one = s->n + 1;
  for (int j = 0; j <= s->n; j++) {
    double       *to   = s->bordered + (size_t)j * (size_t)one;
    const double *from = j < s->n ? s->jacobian + (size_t)j * (size_t)s->n : s->by_xi;
    memcpy(to, from, sizeof(double) * (size_t)s->n);
    to[s->n] = s->border[j];
  }
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, one, one, s->bordered, one, s->pivot) == 0;
}

static void solve_bordered(const mhb_peak_system *s, char transposed, double *rhs) {
  lapack_int one = s->n + 1;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, transposed, one, 1, s->bordered, one, s->pivot, rhs, one);
}

/* Sign of the determinant of B. */
static int orientation(const mhb_peak_system *s) {
  size_t one  = (size_t)s->n + 1;
  int    sign = 1;
  for (size_t i = 0; i < one; i++) {
    if (s->pivot[i] != (lapack_int)i + 1) sign = -sign;
    if (s->bordered[i * one + i] < 0) sign = -sign;
  }
  return sign;
}

/* Unit tangent T of the response curve and the adjoint. The determinant of [r_z; T] is positive.
 * The sign of G then does not depend on the border, which a distant trial may have left.
 * Returns G. NAN: B is singular. */
static double tangent_and_adjoint(mhb_peak_system *s) {
  if (!factor_bordered(s)) return NAN;
  memset(s->tangent, 0, sizeof(double) * (size_t)s->n);
  s->tangent[s->n] = 1;
  solve_bordered(s, 'N', s->tangent);
  double length = orientation(s) * mhb_norm(s->tangent, s->n + 1);
  for (int i = 0; i <= s->n; i++) s->tangent[i] /= length;
  memcpy(s->adjoint, s->gradient, sizeof(double) * ((size_t)s->n + 1));
  solve_bordered(s, 'T', s->adjoint);
  return mhb_dot(s->n + 1, s->gradient, s->tangent);
}

double mhb_slip_share(const mhb_balance *b) {
  double least = mhb_balance_is_linear(b) ? 0 : 1;
  for (int a = 0; a < b->n_pairs; a++)
    if (b->eval->kind[a] == MHB_PAIR_NONLINEAR)
      least = fmin(least, 1 - b->eval->info[a].share[MHB_STICK]);
  return least;
}

/* The row of a multiplier's G, by z into s->moved and by q into the point's slope. g is that of the
 * solution to which a Newton step of the balance leads. Across the surface of solutions it then has
 * no slope, as in the row. */
static void multiplier_row(mhb_peak_system *s, mhb_curve_point *point) {
  const size_t         one    = (size_t)s->n + 1;
  const double         weight = MULTIPLIER_WEIGHT * s->length;
  double              *across = s->adjoint; /* Y; flips have no use for the adjoint */
  double              *onto   = s->moved_r; /* the surface of solutions */
  mhb_multiplier_slope slope;
  for (int i = 0; i < s->n; i++) across[i] = -s->by_q[i];
  for (int i = 0; i < s->n; i++) onto[i] = -point->r[i];
  across[s->n] = onto[s->n] = 0;
  solve_bordered(s, 'N', across);
  solve_bordered(s, 'N', onto);
  bool there = mhb_norm(onto, s->n + 1) <= ON_SURFACE * mhb_norm(point->x, s->n + 1);
  for (size_t j = 0; j < one; j++) onto[j] += point->x[j];
  const mhb_multiplier_base base = {there ? point->evaluation : NULL,
                                    there ? point->x : onto,
                                    point->value,
                                    s->tangent,
                                    across,
                                    s->border};
  bool found = mhb_multiplier_condition_linearise(s->condition, &base, &slope) == NULL;
  if (!found) slope = (mhb_multiplier_slope){.place.g = NAN};
  s->report.multiplier = slope.place;
  double along         = slope.along / mhb_dot(s->n + 1, s->border, s->tangent);
  for (size_t j = 0; j < one; j++) s->moved[j] = weight * along * s->border[j];
  point->r[s->n]     = weight * slope.place.g;
  point->slope[s->n] = weight * slope.by_value;
}

/* The same of a peak's or a fold's G, and the report's curvature. */
static void peak_row(mhb_peak_system *s, mhb_curve_point *point, double by_q) {
  const size_t one  = (size_t)s->n + 1;
  const double k    = s->adjoint[s->n];
  const double step = STEP * mhb_norm(point->x, s->n + 1);
  for (size_t i = 0; i < one; i++) s->moved[i] = point->x[i] + step * s->tangent[i];
  double by_q_moved = derivatives(s, s->displaced, s->moved, point->value, s->moved_r);
  by_q_moved -= mhb_dot(s->n, s->adjoint, s->by_q);
  lagrangian_gradient(s, s->moved);
  s->report.curvature = 0;
  for (size_t j = 0; j < one; j++) {
    s->moved[j] = (s->moved[j] - k * s->border[j]) / step;
    s->report.curvature += s->moved[j] * s->tangent[j];
  }
  point->slope[s->n] = (by_q_moved - by_q) / step;
}

/* The matrix of (r, G) at the point, its r and slope, and the report. */
static void linearise(mhb_curve_system *system, mhb_curve_point *point) {
  mhb_peak_system *s = of(system);
  size_t           n = (size_t)s->n, one = n + 1;
  double           by_q   = derivatives(s, point->evaluation, point->x, point->value, point->r);
  double          *matrix = s->matrix;
  for (size_t j = 0; j < n; j++) memcpy(matrix + j * one, s->jacobian + j * n, sizeof(double) * n);
  memcpy(matrix + n * one, s->by_xi, sizeof(double) * n);
  memcpy(point->slope, s->by_q, sizeof(double) * n);
  s->report.amplitude  = s->amplitude.amplitude;
  s->report.slip_share = mhb_slip_share(s->balance);
  point->r[n]          = tangent_and_adjoint(s);
  if (s->condition) {
    if (!isnan(point->r[n])) multiplier_row(s, point);
  } else {
    by_q -= mhb_dot(s->n, s->adjoint, s->by_q);
    s->report.by_value = by_q;
    peak_row(s, point, by_q);
  }
  for (size_t j = 0; j < one; j++) matrix[j * one + n] = s->moved[j];
  mhb_balance_use(s->balance, point->evaluation);
  memcpy(s->border, s->tangent, sizeof(double) * one);
  memcpy(s->z, point->x, sizeof(double) * one);
  s->value = point->value;
}

static void ensure(mhb_curve_system *system, const mhb_curve_point *point) {
  mhb_peak_system *s = of(system);
  if (s->value == point->value && memcmp(s->z, point->x, sizeof(double) * ((size_t)s->n + 1)) == 0)
    return;
  mhb_curve_point again = *point; /* its r and slope are written with what they hold already */
  linearise(system, &again);
}

mhb_peak_report mhb_peak_system_report(mhb_curve_system *system, const mhb_curve_point *point) {
  ensure(system, point);
  return of(system)->report;
}

mhb_parameter mhb_peak_parameter(int derivative) {
  static const mhb_parameter of_derivative[] = {MHB_IN_N0, MHB_IN_SCALE, MHB_IN_MU, MHB_IN_KU,
                                                MHB_IN_KV};
  return of_derivative[derivative];
}

void mhb_peak_system_measure(mhb_curve_system *system, mhb_size size) {
  of(system)->amplitude.size = size;
  of(system)->value          = NAN;
}

void mhb_peak_gradient(mhb_balance *b, const double *x, const mhb_amplitude *amplitude,
                       const double *adjoint, double *by_q, double by[MHB_PEAK_PARAMETERS]) {
  for (int i = 0; i < MHB_PEAK_BY_DAMPING; i++) {
    const mhb_parameter q = mhb_peak_parameter(i);
    mhb_balance_slope(b, x, q, by_q);
    by[i] = mhb_amplitude_by_parameter(b, amplitude, q, b->eval->by_parameter) -
            mhb_dot(b->n, adjoint, by_q);
  }
  mhb_slope_by_damping(b, by_q);
  by[MHB_PEAK_BY_DAMPING] = amplitude->by_damping - mhb_dot(b->n, adjoint, by_q);
}

void mhb_peak_system_derivatives(mhb_curve_system *system, const mhb_curve_point *point,
                                 double by[MHB_PEAK_PARAMETERS]) {
  mhb_peak_system *s = of(system);
  ensure(system, point);
  mhb_balance_use(s->balance, point->evaluation);
  s->amplitude.by_x = s->moved;
  mhb_output_amplitude(s->balance, point->x, s->output, &s->amplitude);
  mhb_peak_gradient(s->balance, point->x, &s->amplitude, s->adjoint, s->by_q, by);
}

const char *mhb_peak_system_choose(mhb_curve_system *system, const double *x, double omega,
                                   double value) {
  return mhb_multiplier_condition_choose(of(system)->condition, x, omega, value);
}

void mhb_peak_system_accept(mhb_curve_system *system, const mhb_curve_point *point) {
  ensure(system, point);
  mhb_multiplier_condition_accept(of(system)->condition);
}

void mhb_peak_system_judge(mhb_curve_system *system, const mhb_curve_point *point,
                           mhb_multipliers *multipliers, bool *finer) {
  mhb_peak_system *s = of(system);
  mhb_multiplier_condition_judge(s->condition, point->evaluation, point->x, multipliers, finer);
}

void mhb_peak_system_adapt(mhb_curve_system *system) {
  mhb_multiplier_condition_adapt(of(system)->condition);
  of(system)->value = NAN;
}

static void evaluate(mhb_curve_system *system, mhb_curve_point *point) {
  linearise(system, point);
}

/* ---- the bordered system of the continuation ---- */

static int factor(mhb_curve_system *system, const mhb_curve_point *point, const double *column,
                  const double *row) {
  mhb_peak_system *s   = of(system);
  size_t           one = (size_t)s->n + 1, two = one + 1;
  ensure(system, point);
  for (size_t j = 0; j < one; j++) {
    memcpy(s->step_matrix + j * two, s->matrix + j * one, sizeof(double) * one);
    s->step_matrix[j * two + one] = row[j];
  }
  memcpy(s->step_matrix + one * two, column, sizeof(double) * two);
  lapack_int size = (lapack_int)two;
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, size, size, s->step_matrix, size, s->step_pivot) != 0)
    return 0;
  s->step_sign = 1;
  for (size_t i = 0; i < two; i++) {
    if (s->step_pivot[i] != (lapack_int)i + 1) s->step_sign = -s->step_sign;
    if (s->step_matrix[i * two + i] < 0) s->step_sign = -s->step_sign;
  }
  return 1;
}

static int solve(mhb_curve_system *system, double *rhs) {
  const mhb_peak_system *s    = of(system);
  lapack_int             size = s->n + 2;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', size, 1, s->step_matrix, size, s->step_pivot, rhs,
                      size);
  return isfinite(mhb_norm(rhs, size));
}

static int sign(const mhb_curve_system *system) {
  return of(system)->step_sign;
}

/* A Newton step at fixed q: delta[n + 1] <- -matrix^-1 r, with the border e_q. */
static bool newton_step(mhb_curve_system *system, const mhb_curve_point *point, double *delta) {
  size_t one = (size_t)of(system)->n + 1;
  double row[one + 1];
  memset(row, 0, sizeof row);
  row[one] = 1;
  if (!factor(system, point, row, row)) return false;
  for (size_t i = 0; i < one; i++) delta[i] = -point->r[i];
  delta[one] = 0;
  return solve(system, delta);
}

/* The line search. false: the residual does not fall; the point is linearised where it was. */
static bool descend(mhb_curve_system *system, mhb_curve_point *point, const double *delta,
                    double *residual) {
  const int one = of(system)->n + 1, most = system->costly ? MAX_HALVINGS_OF_PEAK : MAX_HALVINGS;
  double    from[one], before = *residual, part = 1;
  memcpy(from, point->x, sizeof from);
  for (int halvings = 0; halvings <= most; halvings++, part *= 0.5) {
    for (int i = 0; i < one; i++) point->x[i] = from[i] + part * delta[i];
    linearise(system, point);
    *residual = mhb_norm(point->r, one);
    if (*residual < LEAST_GAIN * before) return true;
  }
  memcpy(point->x, from, sizeof from);
  linearise(system, point);
  *residual = before;
  return false;
}

static mhb_reason solve_at_value(mhb_curve_system *system, double tolerance,
                                 mhb_curve_point *point) {
  const int one = of(system)->n + 1;
  double    delta[one + 1], seen[MAX_NEWTON];
  linearise(system, point);
  double residual = mhb_norm(point->r, one);
  for (point->iterations = 0; point->iterations < MAX_NEWTON; point->iterations++) {
    if (residual <= tolerance * mhb_norm(point->x, one)) return MHB_CONVERGED;
    seen[point->iterations] = residual;
    if (!newton_step(system, point, delta)) return MHB_SINGULAR;
    const double size    = mhb_norm(point->x, one);
    const bool   rounded = residual <= ROUNDED_RESIDUAL * tolerance * size &&
                         mhb_norm(delta, one) <= ROUNDED_STEP * size;
    if (system->costly && point->iterations >= 3 &&
        residual > SLOW_GAIN * seen[point->iterations - 3])
      return rounded ? MHB_CONVERGED : MHB_NO_DESCENT;
    if (!descend(system, point, delta, &residual)) return rounded ? MHB_CONVERGED : MHB_NO_DESCENT;
  }
  return MHB_MAX_ITERATIONS;
}

/* ---- creation ---- */

static mhb_evaluation *evaluation_create(mhb_curve_system *system) {
  return mhb_evaluation_create(of(system)->balance);
}

static void evaluation_destroy(mhb_curve_system *system, mhb_evaluation *evaluation) {
  mhb_balance_discard(of(system)->balance, evaluation);
}

static void copy(const mhb_curve_system *system, const double *x, int j, double *to) {
  (void)j;
  memcpy(to, x, sizeof(double) * (size_t)system->n);
}

static void destroy(mhb_curve_system *system) {
  mhb_peak_system *s = of(system);
  if (s->displaced) evaluation_destroy(system, s->displaced);
  mhb_multiplier_condition_destroy(s->condition);
  shb_arena_free(&s->arena);
  free(s);
}

static double unit_of_value(const mhb_curve_system *system, const mhb_curve_point *point) {
  return fmax(fabs(point->value), of(system)->least_unit);
}

void mhb_peak_system_passes_zero(mhb_curve_system *system, double least_unit) {
  of(system)->least_unit = least_unit;
}

static shb_status fill(mhb_peak_system *s) {
  size_t     n = (size_t)s->n, one = n + 1, two = n + 2;
  shb_arena *arena     = &s->arena;
  double   **vectors[] = {&s->z,       &s->by_xi,   &s->by_q,  &s->gradient, &s->border,
                          &s->tangent, &s->adjoint, &s->moved, &s->moved_r};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    *vectors[i] = shb_arena_take(arena, one, sizeof(double));
  s->jacobian    = shb_arena_take(arena, n * n, sizeof(double));
  s->matrix      = shb_arena_take(arena, one * one, sizeof(double));
  s->bordered    = shb_arena_take(arena, one * one, sizeof(double));
  s->step_matrix = shb_arena_take(arena, two * two, sizeof(double));
  s->pivot       = shb_arena_take(arena, one, sizeof *s->pivot);
  s->step_pivot  = shb_arena_take(arena, two, sizeof *s->step_pivot);
  s->amplitude.weight =
      shb_arena_take(arena, mhb_amplitude_weights(s->balance), sizeof *s->amplitude.weight);
  s->value     = NAN;
  s->border[n] = 1;
  if (s->kind == MHB_TRACK_FLIP || s->kind == MHB_TRACK_NEIMARK_SACKER)
    return mhb_multiplier_condition_create(s->balance, s->parameter, s->kind == MHB_TRACK_FLIP,
                                           s->rate, &s->condition);
  s->displaced = mhb_evaluation_create(s->balance);
  return SHB_OK;
}

shb_status mhb_peak_system_create(mhb_balance *balance, mhb_tracked_point kind, int output,
                                  mhb_parameter parameter, double range, double length,
                                  mhb_peak_system **out) {
  mhb_peak_system *s = shb_alloc_zeroed(1, sizeof *s);
  s->balance         = balance;
  s->kind            = kind;
  s->output          = output;
  s->parameter       = parameter;
  s->rate            = range / length;
  s->length          = length;
  s->n               = balance->n;
  s->base            = (mhb_curve_system){.n                  = balance->n + 1,
                                          .least              = mhb_parameter_least(parameter),
                                          .plain              = kind != MHB_TRACK_FOLD,
                                          .costly             = kind == MHB_TRACK_PEAK,
                                          .bends              = kind == MHB_TRACK_PEAK,
                                          .row_length         = balance->n + 1,
                                          .copies             = 1,
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
                                          .unit_of_value      = unit_of_value};
  shb_status status  = fill(s);
  if (status != SHB_OK) destroy(&s->base);
  if (status == SHB_OK) *out = s;
  return status;
}
