#include "mhb/tracking/multiplier_condition.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/numerics/vector.h"

/* Step of the differences, relative to |z|. Near grazing g changes by 0.03 over 1e-4 of |z|: a step
 * of 1e-6 then costs an iteration more. The noise of loose laws is below 1e-7. */
static const double STEP = 1e-7;

/* Within this of the place of the last differences, relative to |z|, they serve again. */
static const double SAME = 1e-5;

/* Nearer to the real axis a pair is expected by its half sum and discriminant. */
static const double NEAR_REAL = 0.05;

/* Where the multiplier is expected: with s = w (z - z0), t = q - q0
 *   lambda exp(along s + by_value t), or, of a pair near the real axis,
 *   h + sqrt(d), h and d linear in s and t */
typedef struct {
  double              *z, *weight; /* [n + 1] z0; w = c/(c T) */
  double               value;      /* q0 */
  double complex       along, by_value;
  double               h_along, h_by_value, d_along, d_by_value;
  mhb_multiplier_place at;
} expectation;

struct mhb_multiplier_condition {
  mhb_balance            *balance;
  mhb_parameter           parameter;
  bool                    flip;
  double                  rate;
  int                     n;
  mhb_floquet            *floquet;
  mhb_followed_multiplier followed;
  expectation             accepted, last;  /* last: where the differences were taken */
  double                  along, by_value; /* g_T, g_Y there */
  int                     refinement;      /* of the differences; 0: there are none */
  int                     judged;          /* refinement of the last verdict */
  mhb_evaluation         *displaced;
  double                 *moved, *r; /* [n + 1] */
  shb_arena               arena;
};

shb_status mhb_multiplier_condition_create(mhb_balance *b, mhb_parameter parameter, bool flip,
                                           double rate, mhb_multiplier_condition **out) {
  mhb_multiplier_condition *c   = shb_alloc_zeroed(1, sizeof *c);
  size_t                    one = (size_t)b->n + 1;
  c->balance                    = b;
  c->parameter                  = parameter;
  c->flip                       = flip;
  c->rate                       = rate;
  c->n                          = b->n;
  double **vectors[]            = {&c->accepted.z,  &c->accepted.weight, &c->last.z,
                                   &c->last.weight, &c->moved,           &c->r};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    *vectors[i] = shb_arena_take(&c->arena, one, sizeof(double));
  c->displaced      = mhb_evaluation_create(b);
  shb_status status = mhb_branch_floquet_create(b, &c->floquet);
  if (status != SHB_OK) {
    mhb_multiplier_condition_destroy(c);
    return status;
  }
  *out = c;
  return SHB_OK;
}

void mhb_multiplier_condition_destroy(mhb_multiplier_condition *c) {
  if (!c) return;
  if (c->displaced) mhb_balance_discard(c->balance, c->displaced);
  mhb_floquet_destroy(c->floquet);
  shb_arena_free(&c->arena);
  free(c);
}

/* The solution that an evaluation is of. */
static mhb_solution solution_of(mhb_multiplier_condition *c, mhb_evaluation *e, const double *x) {
  mhb_balance_use(c->balance, e);
  return (mhb_solution){e->at.omega, c->balance->law, e->info, x, e->p, c->balance->m};
}

/* The contacts at a solution z, q; its residual is of no interest. */
static mhb_solution evaluate(mhb_multiplier_condition *c, const double *z, double value) {
  mhb_balance *b = c->balance;
  mhb_balance_use(b, c->displaced);
  mhb_balance_go_to(b, c->parameter, value);
  mhb_balance_evaluate(b, z, z[c->n] * c->rate, c->r, NULL, NULL);
  return solution_of(c, c->displaced, z);
}

const char *mhb_multiplier_condition_choose(mhb_multiplier_condition *c, const double *x,
                                            double omega, double value) {
  mhb_multiplier_place place;
  memcpy(c->moved, x, sizeof *x * (size_t)c->n);
  c->moved[c->n]        = omega / c->rate;
  mhb_solution solution = evaluate(c, c->moved, value);
  const char  *why =
      mhb_followed_multiplier_choose(c->floquet, &solution, c->flip, &c->followed, &place);
  if (why) return why;
  memcpy(c->accepted.z, c->moved, sizeof *x * ((size_t)c->n + 1));
  memset(c->accepted.weight, 0, sizeof *x * ((size_t)c->n + 1));
  c->accepted =
      (expectation){.z = c->accepted.z, .weight = c->accepted.weight, .value = value, .at = place};
  c->refinement = 0;
  return NULL;
}

static double complex expected(const mhb_multiplier_condition *c, const double *z, double value) {
  const expectation *e     = &c->accepted;
  double             along = 0;
  for (int i = 0; i <= c->n; i++) along += e->weight[i] * (z[i] - e->z[i]);
  double on = value - e->value;
  if (fabs(e->at.discriminant) > NEAR_REAL * NEAR_REAL)
    return e->at.lambda * cexp(e->along * along + e->by_value * on);
  double h = e->at.half_sum + e->h_along * along + e->h_by_value * on;
  double d = e->at.discriminant + e->d_along * along + e->d_by_value * on;
  return h + csqrt(d);
}

/* g at a place beside the base. */
static const char *beside(mhb_multiplier_condition *c, double value, double complex near,
                          mhb_multiplier_place *place) {
  mhb_solution solution = evaluate(c, c->moved, value);
  c->followed.keep      = true;
  return mhb_followed_multiplier_find(c->floquet, &solution, &c->followed, near, place);
}

/* moved <- z + step direction */
static void displace(mhb_multiplier_condition *c, const double *z, double step,
                     const double *direction) {
  for (int i = 0; i <= c->n; i++) c->moved[i] = z[i] + step * direction[i];
}

/* Whether the last differences serve at the base. */
static bool is_same_place(const mhb_multiplier_condition *c, const mhb_multiplier_base *base) {
  const double most   = SAME * mhb_norm(base->z, c->n + 1);
  double       square = 0;
  if (c->refinement != c->followed.refinement) return false;
  for (int i = 0; i <= c->n; i++) square += pow(base->z[i] - c->last.z[i], 2);
  return sqrt(square) <= most &&
         fabs(base->value - c->last.value) * mhb_norm(base->to_value, c->n + 1) <= most;
}

/* Where the multiplier is expected near the base. */
static void set_expectation(mhb_multiplier_condition *c, const mhb_multiplier_base *base,
                            const mhb_multiplier_place at[3], double step, double of_value) {
  expectation *e   = &c->last;
  double       dot = 0;
  for (int i = 0; i <= c->n; i++) dot += base->border[i] * base->along[i];
  for (int i = 0; i <= c->n; i++) e->weight[i] = base->border[i] / dot;
  memcpy(e->z, base->z, sizeof *e->z * ((size_t)c->n + 1));
  e->value      = base->value;
  e->at         = at[0];
  e->along      = (at[1].lambda / at[0].lambda - 1) / step;
  e->by_value   = (at[2].lambda / at[0].lambda - 1) / of_value;
  e->h_along    = (at[1].half_sum - at[0].half_sum) / step;
  e->d_along    = (at[1].discriminant - at[0].discriminant) / step;
  e->h_by_value = (at[2].half_sum - at[0].half_sum) / of_value;
  e->d_by_value = (at[2].discriminant - at[0].discriminant) / of_value;
}

/* g_T and g_Y by differences, and with them the expectation. g0: the place at the base. */
static const char *take_differences(mhb_multiplier_condition *c, const mhb_multiplier_base *base,
                                    const mhb_multiplier_place *g0) {
  mhb_multiplier_place at[3] = {*g0};
  double step = STEP * mhb_norm(base->z, c->n + 1), size = mhb_norm(base->to_value, c->n + 1);
  double of_value = size > 0 ? step / size : INFINITY;
  if (base->value != 0) of_value = fmin(of_value, STEP * fabs(base->value));
  if (!isfinite(of_value)) of_value = STEP;
  c->refinement = 0;
  displace(c, base->z, step, base->along);
  const char *why = beside(c, base->value, g0->lambda, &at[1]);
  if (why) return why;
  displace(c, base->z, of_value, base->to_value);
  why = beside(c, base->value + of_value, g0->lambda, &at[2]);
  if (why) return why;
  set_expectation(c, base, at, step, of_value);
  c->along      = (at[1].g - at[0].g) / step;
  c->by_value   = (at[2].g - at[0].g) / of_value;
  c->refinement = c->followed.refinement;
  return NULL;
}

/* The share of T of the differences in a direction. */
static double weighted(const mhb_multiplier_condition *c, const double *direction) {
  double sum = 0;
  for (int i = 0; i <= c->n; i++) sum += c->last.weight[i] * direction[i];
  return sum;
}

const char *mhb_multiplier_condition_linearise(mhb_multiplier_condition  *c,
                                               const mhb_multiplier_base *base,
                                               mhb_multiplier_slope      *out) {
  const double complex near = expected(c, base->z, base->value);
  mhb_multiplier_place place;
  mhb_solution         solution = base->evaluation ? solution_of(c, base->evaluation, base->z)
                                                   : evaluate(c, base->z, base->value);
  c->followed.keep              = false;
  const char *why = mhb_followed_multiplier_find(c->floquet, &solution, &c->followed, near, &place);
  if (!why && !is_same_place(c, base)) why = take_differences(c, base, &place);
  if (why) return why;
  /* T and Y of the base in those of the differences: their border was another one */
  const double along = weighted(c, base->along), to_value = weighted(c, base->to_value);
  *out = (mhb_multiplier_slope){place, along * c->along, c->by_value + to_value * c->along};
  return NULL;
}

void mhb_multiplier_condition_accept(mhb_multiplier_condition *c) {
  double *z = c->accepted.z, *weight = c->accepted.weight;
  memcpy(z, c->last.z, sizeof *z * ((size_t)c->n + 1));
  memcpy(weight, c->last.weight, sizeof *z * ((size_t)c->n + 1));
  c->accepted        = c->last;
  c->accepted.z      = z;
  c->accepted.weight = weight;
}

void mhb_multiplier_condition_judge(mhb_multiplier_condition *c, mhb_evaluation *evaluation,
                                    const double *z, mhb_multipliers *multipliers, bool *finer) {
  mhb_solution solution = solution_of(c, evaluation, z);
  mhb_floquet_evaluate(c->floquet, &solution, multipliers);
  c->judged = mhb_floquet_refinement(c->floquet);
  *finer    = c->judged > 0 && c->judged != c->followed.refinement;
}

void mhb_multiplier_condition_adapt(mhb_multiplier_condition *c) {
  c->followed.refinement = c->judged;
}
