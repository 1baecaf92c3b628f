#include "mhb/tracking/kink.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/root.h"
#include "mhb/numerics/vector.h"

/* The first step along the response curve, the way in all, and the bracket of the kink, in units of
 * |z|. */
static const double FIRST = 1e-7, REACH = 0.03, EXACT = 1e-12;

/* Newton's method for a point of the curve ends at a step of SOLVED |z|. Where steps grow again by
 * round-off ALMOST will do. */
static const double SOLVED = 1e-12, ALMOST = 1e-9, LEAST_PART = 1.0 / 64;

/* On either side of a kink |G| is larger than this. Beside a smooth maximum it is about EXACT times
 * the curvature of the curve. */
static const double SLOPE = 1e-6;

/* A recorded point has a smaller residual, relative to the vibration. */
static const double BALANCED = 1e-8;

/* A kink found again has its frequency to within this, relative. */
static const double SAME = 1e-6;

static const double GROWTH = 2; /* of the steps */

enum { MOST_NEWTON = 30, MOST_STEPS = 40 };

/* One point of the response curve, with derivatives by s at fixed q and by q at fixed s. */
typedef struct {
  double  s, amplitude, slope, by_value, slip; /* slip: share (peak_system.h) */
  double *z, *along, *by_q;                    /* [n + 1]; dz/ds, dz/dq */
} side;

/* A kink that was found, to predict others from. */
typedef struct {
  double  value;
  double *z, *rate, *border; /* [n + 1]; dz/dq; the unit tangent */
} found_kink;

struct mhb_kink {
  mhb_peak_family base; /* first: its functions get it back */
  int             n;
  double          unit; /* m s/rad: xi = unit omega */
  found_kink      first, last;
  double         *border; /* [n + 1] c */
  double         *origin; /* [n + 1] z_0 */
  side            left, right, next;
  double         *jacobian, *matrix;   /* [n][n], [n + 1][n + 1] column-major, factored */
  double         *r, *by_omega, *by_x; /* [n] */
  double complex *weight;
  int            *pivot; /* [n + 1] */
  shb_arena       arena;
};

/* ---- a point of the response curve ---- */

static void solve_linear(const mhb_kink *k, char transposed, double *v) {
  const lapack_int one = k->n + 1;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, transposed, one, 1, k->matrix, one, k->pivot, v, one);
}

/* r, and the factors of [r_z; c] at z. false: singular. */
static bool factor(mhb_kink *k, const double *z) {
  const size_t n = (size_t)k->n, one = n + 1;
  mhb_balance_evaluate(k->base.balance, z, z[n] / k->unit, k->r, k->jacobian, k->by_omega);
  for (size_t j = 0; j < n; j++)
    memcpy(k->matrix + j * one, k->jacobian + j * n, sizeof(double) * n);
  for (size_t i = 0; i < n; i++) k->matrix[n * one + i] = k->by_omega[i] / k->unit;
  for (size_t j = 0; j < one; j++) k->matrix[j * one + n] = k->border[j];
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, (int)one, (int)one, k->matrix, (int)one, k->pivot) ==
         0;
}

/* The derivatives at a point whose factors were made last. */
static void differentiate(mhb_kink *k, side *at) {
  mhb_balance        *b        = k->base.balance;
  const mhb_tracking *tracking = k->base.tracking;
  const int           n        = k->n;
  mhb_amplitude       a        = {.by_x = k->by_x, .weight = k->weight, .size = tracking->size};
  mhb_output_amplitude(b, at->z, tracking->output, &a);
  memset(at->along, 0, sizeof(double) * (size_t)n);
  at->along[n] = 1;
  solve_linear(k, 'N', at->along);
  mhb_balance_slope(b, at->z, tracking->parameter, at->by_q);
  const double by_q = mhb_amplitude_by_parameter(b, &a, tracking->parameter, b->eval->by_parameter);
  for (int i = 0; i < n; i++) at->by_q[i] = -at->by_q[i];
  at->by_q[n] = 0;
  solve_linear(k, 'N', at->by_q);
  const double by_xi = a.by_omega / k->unit;
  at->amplitude      = a.amplitude;
  at->slip           = mhb_slip_share(b);
  at->slope          = mhb_dot(n, k->by_x, at->along) + by_xi * at->along[n];
  at->by_value       = by_q + mhb_dot(n, k->by_x, at->by_q) + by_xi * at->by_q[n];
}

/* The point at s, from a motion near by in at->z. A step that does not lower the residual is cut:
 * where slip begins Newton's method would go to and fro. */
static bool settle(mhb_kink *k, double s, side *at) {
  const int n    = k->n;
  double    size = INFINITY, before = INFINITY, part = 1, step[n + 1], from[n + 1];
  at->s = s;
  for (int i = 0; i < MOST_NEWTON; i++) {
    if (!(at->z[n] > 0) || !factor(k, at->z)) return false;
    double aside = s;
    for (int j = 0; j <= n; j++) aside -= k->border[j] * (at->z[j] - k->origin[j]);
    const double residual = hypot(mhb_norm(k->r, n), aside);
    if (residual > before && size > ALMOST && part > LEAST_PART) {
      part *= 0.5;
      for (int j = 0; j <= n; j++) at->z[j] = from[j] + part * step[j];
      continue;
    }
    before = residual;
    part   = 1;
    memcpy(from, at->z, sizeof from);
    for (int j = 0; j < n; j++) step[j] = -k->r[j];
    step[n] = aside;
    solve_linear(k, 'N', step);
    const double last = size;
    size              = mhb_norm(step, n + 1) / mhb_norm(at->z, n + 1);
    if (!isfinite(size)) return false;
    for (int j = 0; j <= n; j++) at->z[j] += step[j];
    if (size <= SOLVED || (size <= ALMOST && size > 0.5 * last)) {
      if (!factor(k, at->z)) return false;
      differentiate(k, at);
      return isfinite(at->slope) && isfinite(at->by_value);
    }
  }
  return false;
}

/* ---- the kink at a value ---- */

/* to->z <- the point at s, along the tangent of another. */
static void predict(const mhb_kink *k, const side *from, double s, side *to) {
  for (int j = 0; j <= k->n; j++) to->z[j] = from->z[j] + (s - from->s) * from->along[j];
}

static void swap(side *a, side *b) {
  const side kept = *a;
  *a              = *b;
  *b              = kept;
}

/* Measure s from the left point, along its tangent. The point is to be settled anew. */
static void measure_from_left(mhb_kink *k) {
  const double length = mhb_norm(k->left.along, k->n + 1);
  for (int j = 0; j <= k->n; j++) k->border[j] = k->left.along[j] / length;
  memcpy(k->origin, k->left.z, sizeof(double) * ((size_t)k->n + 1));
}

/* The right point, about this far from the left one, at most the given way; step becomes its
 * distance. Newton's method may miss a point where slip just begins: one behind or before it is
 * taken. */
static bool step_right(mhb_kink *k, double most, double *step) {
  static const double part[] = {1, 4, 16, 0.25, 0.06, 0.015};
  const double        wanted = *step;
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
    *step = part[i] * wanted;
    if (fabs(*step) > most) continue;
    predict(k, &k->left, k->left.s + *step, &k->right);
    if (settle(k, k->left.s + *step, &k->right)) return true;
  }
  return false;
}

/* left and right <- two points with the next maximum of the amplitude between them, from left. The
 * curve may bend much where slip begins: s is measured anew from point to point. */
static bool bracket(mhb_kink *k) {
  const double unit = mhb_norm(k->origin, k->n + 1), way = k->left.slope > 0 ? 1 : -1;
  double       step = way * FIRST * unit, left = REACH * unit;
  for (int i = 0; i < MOST_STEPS && fabs(step) <= left; i++, step *= GROWTH) {
    if (!step_right(k, left, &step)) return false;
    if (k->right.slope * k->left.slope <= 0) {
      if (way < 0) swap(&k->left, &k->right);
      return true;
    }
    left -= fabs(step);
    swap(&k->left, &k->right);
    measure_from_left(k);
    if (!settle(k, 0, &k->left)) return false;
  }
  return false;
}

/* Shrink the bracket to the maximum. */
static bool shrink(mhb_kink *k) {
  const double unit = mhb_norm(k->origin, k->n + 1);
  shb_root     root;
  if (!shb_root_start(&root, k->left.s, k->left.slope, k->right.s, k->right.slope, EXACT * unit))
    return false;
  while (!shb_root_done(&root)) {
    const double s = shb_root_next(&root);
    predict(k, s - k->left.s < k->right.s - s ? &k->left : &k->right, s, &k->next);
    if (settle(k, s, &k->next)) {
      shb_root_found(&root, s, k->next.slope);
      swap(&k->next, k->next.slope > 0 ? &k->left : &k->right);
    } else if (!shb_root_failed(&root)) {
      return false;
    }
  }
  return true;
}

/* The kink near k->origin at a value; fills the place and becomes the last one. */
static bool find(mhb_kink *k, mhb_peak_place *at, mhb_end *why) {
  mhb_balance *b = k->base.balance;
  const int    n = k->n;
  *why           = MHB_END_TURNED;
  at->margin     = NAN;
  mhb_balance_go_to(b, k->base.tracking->parameter, at->value);
  memcpy(k->left.z, k->origin, sizeof(double) * ((size_t)n + 1));
  if (!settle(k, 0, &k->left) || !bracket(k) || !shrink(k)) return false;
  const side  *l = &k->left, *r = &k->right;
  const double jump = l->slope - r->slope, by_s = (r->by_value - l->by_value) / jump;
  at->amplitude = l->amplitude;
  at->omega = at->peak = l->z[n] / k->unit;
  *why                 = MHB_END_SMOOTH;
  if (!(l->slope > SLOPE && r->slope < -SLOPE)) return false;
  at->margin          = fmin(l->slope, -r->slope);
  at->slope           = (l->slope * r->by_value - r->slope * l->by_value) / jump;
  at->rate            = (l->by_q[n] + by_s * l->along[n]) / k->unit;
  const double *range = k->base.tracking->frequency;
  *why                = MHB_END_FREQUENCY;
  if (at->omega < range[0] || at->omega > range[1]) return false;
  const double length = mhb_norm(l->along, n + 1);
  for (int j = 0; j <= n; j++) {
    k->last.z[j]      = l->z[j];
    k->last.rate[j]   = l->by_q[j] + by_s * l->along[j];
    k->last.border[j] = l->along[j] / length;
  }
  k->last.value = at->value;
  return true;
}

/* From the first kink or from the last one, whichever is nearer. */
static bool is_peak(mhb_peak_family *family, mhb_peak_place *at, mhb_end *why) {
  mhb_kink         *k = (mhb_kink *)family;
  const found_kink *from =
      fabs(at->value - k->first.value) < fabs(at->value - k->last.value) ? &k->first : &k->last;
  for (int j = 0; j <= k->n; j++) {
    k->origin[j] = from->z[j] + (at->value - from->value) * from->rate[j];
    k->border[j] = from->border[j];
  }
  return find(k, at, why);
}

static bool balance_at(mhb_peak_family *family, const mhb_peak_place *at, mhb_curve_point *point) {
  mhb_kink      *k    = (mhb_kink *)family;
  mhb_balance   *b    = family->balance;
  mhb_peak_place here = *at;
  mhb_end        unused;
  if (k->last.value != at->value && !is_peak(family, &here, &unused)) return false;
  if (fabs(here.omega / at->omega - 1) > SAME) return false;
  mhb_balance_go_to(b, family->tracking->parameter, at->value);
  memcpy(point->x, k->last.z, sizeof(double) * (size_t)k->n);
  point->value      = at->value;
  point->iterations = 0;
  mhb_balance_linearise(b, point->x, here.peak, point->r, NULL);
  point->residual = mhb_norm(point->r, k->n) / mhb_balance_vibration(b, point->x);
  return point->residual <= BALANCED;
}

bool mhb_kink_start(mhb_kink *k, const double *x, mhb_peak_place *at, mhb_end *why) {
  const int n = k->n;
  *why        = MHB_END_NO_START;
  memcpy(k->origin, x, sizeof(double) * (size_t)n);
  const double *range = k->base.tracking->frequency;
  k->unit             = mhb_norm(x, n) / (range[1] > range[0] ? range[1] - range[0] : at->omega);
  k->origin[n]        = k->unit * at->omega;
  memset(k->border, 0, sizeof(double) * (size_t)n);
  k->border[n] = 1;
  mhb_balance_go_to(k->base.balance, k->base.tracking->parameter, at->value);
  memcpy(k->left.z, k->origin, sizeof(double) * ((size_t)n + 1));
  if (!settle(k, 0, &k->left)) return false;
  measure_from_left(k);
  if (!find(k, at, why)) return false;
  k->first.value = k->last.value;
  memcpy(k->first.z, k->last.z, sizeof(double) * ((size_t)n + 1));
  memcpy(k->first.rate, k->last.rate, sizeof(double) * ((size_t)n + 1));
  memcpy(k->first.border, k->last.border, sizeof(double) * ((size_t)n + 1));
  return true;
}

/* ---- the maximum found last ---- */

/* dA/dq at fixed s, on one side. */
static void side_gradient(mhb_kink *k, const side *at, double by[MHB_PEAK_PARAMETERS]) {
  mhb_balance  *b = k->base.balance;
  mhb_amplitude a = {.by_x = k->by_x, .weight = k->weight, .size = k->base.tracking->size};
  double        adjoint[k->n + 1];
  factor(k, at->z);
  mhb_output_amplitude(b, at->z, k->base.tracking->output, &a);
  memcpy(adjoint, k->by_x, sizeof(double) * (size_t)k->n);
  adjoint[k->n] = a.by_omega / k->unit;
  solve_linear(k, 'T', adjoint);
  mhb_peak_gradient(b, at->z, &a, adjoint, k->r, by);
}

double mhb_kink_slip_share(const mhb_kink *k) {
  return fmin(k->left.slip, k->right.slip);
}

void mhb_kink_maximum(mhb_kink *k, double *x, double by[MHB_PEAK_PARAMETERS]) {
  const side  *l = &k->left, *r = &k->right;
  const double jump = l->slope - r->slope, share = jump > 0 ? l->slope / jump : 0.5;
  double       before[MHB_PEAK_PARAMETERS];
  memcpy(x, l->z, sizeof(double) * (size_t)k->n);
  if (!by) return;
  side_gradient(k, l, before);
  side_gradient(k, r, by);
  for (int i = 0; i < MHB_PEAK_PARAMETERS; i++) by[i] = share * by[i] + (1 - share) * before[i];
}

/* ---- creation ---- */

mhb_kink *mhb_kink_create(mhb_balance *balance, const mhb_tracking *tracking) {
  mhb_kink    *k = shb_alloc_zeroed(1, sizeof *k);
  const size_t n = (size_t)balance->n, one = n + 1;
  k->base            = (mhb_peak_family){balance, tracking, is_peak, balance_at};
  k->n               = balance->n;
  double **vectors[] = {&k->first.z,     &k->first.rate,  &k->first.border, &k->last.z,
                        &k->last.rate,   &k->last.border, &k->border,       &k->origin,
                        &k->left.z,      &k->left.along,  &k->left.by_q,    &k->right.z,
                        &k->right.along, &k->right.by_q,  &k->next.z,       &k->next.along,
                        &k->next.by_q,   &k->r,           &k->by_omega,     &k->by_x};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    *vectors[i] = shb_arena_take(&k->arena, one, sizeof(double));
  k->jacobian = shb_arena_take(&k->arena, n * n, sizeof(double));
  k->matrix   = shb_arena_take(&k->arena, one * one, sizeof(double));
  k->pivot    = shb_arena_take(&k->arena, one, sizeof *k->pivot);
  k->weight   = shb_arena_take(&k->arena, mhb_amplitude_weights(balance), sizeof *k->weight);
  return k;
}

void mhb_kink_destroy(mhb_kink *k) {
  if (!k) return;
  shb_arena_free(&k->arena);
  free(k);
}

shb_status mhb_trace_kink(mhb_balance *balance, const mhb_tracking *tracking,
                          const mhb_tracking_seed *seed, mhb_response *response, int branch,
                          bool *found, mhb_tracking_end *end) {
  mhb_peak_place at = {.value = seed->value, .omega = seed->omega};
  mhb_kink      *k;
  mhb_end        unused;
  *found = false;
  *end   = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  if (tracking->kind != MHB_TRACK_PEAK) return SHB_OK;
  k                 = mhb_kink_create(balance, tracking);
  shb_status status = SHB_OK;
  if (mhb_kink_start(k, seed->x, &at, &unused) && mhb_is_seeded(seed, at.omega, at.amplitude))
    status = mhb_trace_peak_places(&k->base, &at, response, branch, found, end);
  mhb_kink_destroy(k);
  return status;
}
