#include "mhb/contact/contact.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/contact/force_integrals.h"
#include "mhb/contact/internal.h"
#include "mhb/contact/slider.h"

static void take_arrays(mhb_contact_evaluator *c) {
  size_t     nb = (size_t)c->nb, nf = (size_t)c->nf, stride = (size_t)c->stride;
  size_t     sums = (size_t)mhb_real_size(c->H + c->m), real = sizeof(double);
  shb_arena *a       = &c->arena;
  c->coefficients    = shb_arena_try(a, 3 * nb, real);
  c->slip_sums       = shb_arena_try(a, 4 * nf, sizeof(mhb_lanes));
  c->load_sums       = shb_arena_try(a, 2 * sums, sizeof(mhb_lanes));
  c->f               = shb_arena_try(a, 2 * nf, real);
  c->f_slider        = shb_arena_try(a, 2 * nf, real);
  c->first_stick     = shb_arena_try(a, sums, real);
  c->stick_integrals = shb_arena_try(a, sums, real);
  c->basis_integrals = shb_arena_try(a, sums, real);
  c->basis_products  = shb_arena_try(a, nf * nb, real);
  c->J               = shb_arena_try(a, 2 * nf * stride, real);
  c->Z[0]            = shb_arena_try(a, stride, real);
  c->Z[1]            = shb_arena_try(a, stride, real);
  c->T               = shb_arena_try(a, stride, real);
  c->rhs             = shb_arena_try(a, MHB_NODES * (stride + MHB_LANES), real);
  c->T_nodes         = shb_arena_try(a, MHB_NODES * stride, real);
  c->node_basis      = shb_arena_try(a, sums + 2 * nf + MHB_LANES, sizeof(mhb_lanes));
  c->event_basis     = shb_arena_try(a, 2 * nb, real);
  c->history_force   = shb_arena_try(a, 3 * nf, real);
}

void mhb_contact_evaluator_set_tolerance(mhb_contact_evaluator *c, double tolerance) {
  c->tolerance = tolerance;
}

shb_status mhb_contact_evaluator_create(int m, int H, double tolerance,
                                        mhb_contact_evaluator **out) {
  mhb_contact_evaluator *c = aligned_alloc(64, (sizeof *c + 63) / 64 * 64); /* it holds vectors */
  SHB_CHECK(c, SHB_ERR_IO, "out of memory");
  memset(c, 0, sizeof *c);
  c->m             = m;
  c->H             = H;
  c->nb            = mhb_real_size(m);
  c->nf            = mhb_real_size(H);
  c->slider_column = 3 * c->nb;
  c->stride        = mhb_whole_lanes(c->slider_column + 1);
  c->tolerance     = tolerance;
  take_arrays(c);
  if (c->arena.failed || mhb_collocation_create(&c->rule) != SHB_OK ||
      mhb_signals_create(m, &c->signals) != SHB_OK ||
      mhb_contact_intervals_create(m, &c->intervals) != SHB_OK ||
      mhb_dense_output_create(&c->rule, &c->dense_output) != SHB_OK) {
    mhb_contact_evaluator_destroy(c);
    SHB_FAIL(SHB_ERR_IO, "out of memory for a contact of %d harmonics", m);
  }
  c->dense_output.signals = &c->signals;
  *out                    = c;
  return SHB_OK;
}

void mhb_contact_evaluator_destroy(mhb_contact_evaluator *c) {
  if (!c) return;
  shb_arena_free(&c->arena);
  mhb_dense_output_destroy(&c->dense_output);
  mhb_contact_intervals_destroy(&c->intervals);
  mhb_signals_destroy(&c->signals);
  free(c);
}

/* ---- scaling ---- */

/* Divides by the largest force in sight, so that tolerances are relative. 0: no force at all. */
static int set_signals(mhb_contact_evaluator *c, const mhb_law *law, const double *motion) {
  const double *v = motion, *u = v + c->nb, *w = u + c->nb;
  double        load = fabs(law->n0), friction = 0;
  for (int i = 0; i < c->nb; i++) {
    load += law->kv * fabs(v[i]);
    double x1 = law->ku[0] * u[i] + law->ku[1] * w[i], x2 = law->ku[1] * u[i] + law->ku[2] * w[i];
    friction += sqrt(x1 * x1 + x2 * x2);
  }
  c->scale = load + friction < INFINITY ? fmax(load, friction) : NAN;
  if (!(c->scale > 1e-290)) return 0; /* the inverse of a smaller one overflows */
  double one = 1 / c->scale, *n = c->coefficients, *x1 = n + c->nb, *x2 = x1 + c->nb;
  c->kv      = law->kv * one;
  c->K[0][0] = law->ku[0] * one;
  c->K[0][1] = c->K[1][0] = law->ku[1] * one;
  c->K[1][1]              = law->ku[2] * one;
  for (int i = 0; i < c->nb; i++) {
    n[i]  = c->kv * v[i];
    x1[i] = c->K[0][0] * u[i] + c->K[0][1] * w[i];
    x2[i] = c->K[1][0] * u[i] + c->K[1][1] * w[i];
  }
  n[0] += law->n0 * one;
  mhb_signals_set(&c->signals, (const double *const[3]){n, x1, x2});
  return 1;
}

/* The slip problem of the period, and the levels of force that errors refer to. */
static void set_slip(mhb_contact_evaluator *c, const mhb_law *law, int derivative) {
  const mhb_signals *s = &c->signals;
  c->slip              = (mhb_slip){.signals    = s,
                                    .rule       = &c->rule,
                                    .mean       = .5 * (c->K[0][0] + c->K[1][1]),
                                    .half       = .5 * (c->K[0][0] - c->K[1][1]),
                                    .skew       = c->K[0][1],
                                    .mu         = law->mu,
                                    .linearized = derivative};
  memcpy(c->slip.K, c->K, sizeof c->K);

  /* mean harmonic (sum k^4 |A_k|/sum |A_k|)^(1/4) over mu n and x; swing of x */
  double high = 0, all = 0, swing = 0;
  for (int i = 0; i < 3; i++) {
    double weight = i ? 1 : law->mu, amplitude = s->bound[i][0] - fabs(s->coefficient[i]);
    high += weight * s->bound[i][4];
    all += weight * amplitude;
    if (i) swing += amplitude;
  }
  c->mean_harmonic = all > 0 && high < INFINITY ? sqrt(sqrt(high / all)) : 1;

  /* mean and peak of n on the grid */
  double load = 0, peak = 0, short_load = 0;
  for (int i = 0; i < s->n_grid; i++) {
    double n = s->value[0][i];
    load     = n > 0 ? load + n : load;
    peak     = n > peak ? n : peak;
  }
  /* the grid may miss intervals shorter than four cells: n is about a parabola there */
  for (int i = 0; i < c->intervals.n; i++) {
    double y[3], dy[3], length = c->intervals.opening[i] - c->intervals.closing[i];
    if (length > 4 * SHB_TWO_PI / s->n_grid) continue;
    mhb_signals_at(s, c->intervals.closing[i] + .5 * length, y, dy, NULL);
    short_load += 2. / 3 * fmax(0, y[0]) * length / SHB_TWO_PI;
    peak = fmax(peak, y[0]);
  }
  load              = fmax(load / s->n_grid, short_load);
  double limit      = law->mu * load;
  c->slip.peak_load = peak;
  c->friction_level = fmax(limit < swing ? limit : swing, 1e-300);
  c->force_level    = load > c->friction_level ? load : c->friction_level;
}

/* ---- assembly ---- */

/* row[k] += factor dc_k/d(motion) of the mean friction c of a stuck contact; the mean of s has no
 * influence. */
static void add_mean_gradient(const mhb_contact_evaluator *c, double factor, double *const row[2]) {
  const mhb_static_friction *stuck = &c->static_friction;
  int                        nb    = c->nb;
  double                     weight[2][2][6], b[nb], db[nb];
  if (stuck->n_active == 0) return;
  mhb_static_friction_gradient(&c->signals, c->slip.mu, stuck, weight);
  for (int a = 0; a < stuck->n_active; a++) {
    mhb_basis(c->m, stuck->time[a], b, db);
    for (int k = 0; k < 2; k++) {
      const double *w = weight[k][a];
      for (int j = 0; j < nb; j++) row[k][j] += factor * c->kv * (w[0] * b[j] + w[3] * db[j]);
      for (int i = 0; i < 2; i++) {
        double value = c->K[0][i] * w[1] + c->K[1][i] * w[2],
               slope = c->K[0][i] * w[4] + c->K[1][i] * w[5], *to = row[k] + (1 + i) * nb;
        for (int j = 1; j < nb; j++) to[j] += factor * (value * b[j] + slope * db[j]);
      }
    }
  }
}

void mhb_contact_mean_gradient(const mhb_contact_evaluator *c, double *const gradient[2]) {
  for (int k = 0; k < 2; k++) memset(gradient[k], 0, sizeof(double) * 3 * (size_t)c->nb);
  add_mean_gradient(c, c->scale, gradient);
}

/* Stuck throughout: f = Ku (s - mean s) + c. */
static void finish_stuck(mhb_contact_evaluator *c) {
  const mhb_static_friction *stuck = &c->static_friction;
  int                        nb = c->nb, nf = c->nf, derivative = c->mode == MHB_ALL_COLUMNS;
  c->info->share[MHB_STICK] = 1;
  c->info->undetermined     = 1;
  mhb_dense_output_stick(
      &c->dense_output, 0,
      (double[2]){c->coefficients[nb] - stuck->c[0], c->coefficients[2 * nb] - stuck->c[1]});
  for (int k = 0; k < 2; k++) {
    for (int i = 1; i < nb; i++) {
      c->f[k * nf + i] = c->coefficients[(1 + k) * nb + i];
      if (!derivative) continue;
      double *row     = c->J + (size_t)(k * nf + i) * (size_t)c->stride;
      row[nb + i]     = c->K[k][0];
      row[2 * nb + i] = c->K[k][1];
    }
    c->f[k * nf] = stuck->c[k];
  }
  if (derivative)
    add_mean_gradient(c, 1, (double *const[2]){c->J, c->J + (size_t)nf * (size_t)c->stride});
}

/* Harmonics of n - mean_offset, and their derivative. */
static void normal_load(mhb_contact_evaluator *c, const mhb_law *law, const double *v,
                        double *force, double *jacobian) {
  int    nb = c->nb, nf = c->nf, top = c->H + c->m;
  double offset = -law->mean_offset;
  if (c->intervals.always_closed) { /* linear in v; a huge preload must not enter the rounding */
    for (int i = 0; i < nb; i++) {
      force[i] = law->kv * v[i];
      if (jacobian) jacobian[(size_t)i * 3 * (size_t)nb + (size_t)i] = law->kv;
    }
    offset = law->n0 - law->mean_offset;
  } else if (!c->intervals.always_open) { /* integrals over the closed intervals */
    memset(c->basis_integrals, 0, sizeof(double) * (size_t)mhb_real_size(top));
    for (int i = 0; i < c->intervals.n; i++)
      mhb_basis_integral(top, c->intervals.closing[i], c->intervals.opening[i], c->basis_integrals);
    mhb_basis_product(c->H, c->m, c->basis_integrals, c->basis_products, nb);
    for (int i = 0; i < nf; i++) {
      const double *S = c->basis_products + (size_t)i * (size_t)nb;
      double        q = mhb_force_integrals_factor(i), sum = 0;
      for (int j = 0; j < nb; j++) sum += S[j] * c->coefficients[j];
      force[i] = c->scale * q * sum;
      if (!jacobian) continue;
      double *row = jacobian + (size_t)i * 3 * (size_t)nb;
      for (int j = 0; j < nb; j++) row[j] = c->scale * c->kv * q * S[j];
    }
  }
  force[0] += offset;
}

/* Loop integral of f.s' dt: pi sum_k k (Im F_k Re S_k - Re F_k Im S_k) for x = Re X_k exp(jkt). */
static double loop_work(const mhb_contact_evaluator *c, const double *motion, const double *force) {
  double sum = 0;
  for (int i = 1; i < 3; i++) {
    const double *s = motion + i * c->nb, *f = force + i * c->nf;
    for (int k = 1; k <= c->m; k++) sum += k * (f[2 * k] * s[2 * k - 1] - f[2 * k - 1] * s[2 * k]);
  }
  return .5 * SHB_TWO_PI * sum;
}

/* mu = 0: slip wherever the contact is closed. */
static void without_friction(mhb_contact_evaluator *c) {
  double closed = c->intervals.always_closed;
  if (closed > 0) mhb_dense_output_frictionless(&c->dense_output, 0);
  for (int i = 0; i < c->intervals.n; i++) {
    closed += (c->intervals.opening[i] - c->intervals.closing[i]) / SHB_TWO_PI;
    mhb_note_transition(c, c->intervals.closing[i], MHB_SLIDE);
    mhb_dense_output_frictionless(&c->dense_output, c->intervals.closing[i]);
    mhb_note_transition(c, c->intervals.opening[i], MHB_SEPARATE);
    mhb_dense_output_open(&c->dense_output, c->intervals.opening[i]);
  }
  c->info->share[MHB_SLIDE]    = closed;
  c->info->share[MHB_SEPARATE] = 1 - closed;
}

/* Friction is set to zero if a lap is beyond double precision: Ku s 1e12 times mu n, Ku almost
 * singular. */
static void drop_friction(mhb_contact_evaluator *c) {
  size_t nf  = (size_t)c->nf;
  double sum = 0;
  for (size_t i = 0; i < 2 * nf; i++) sum += fabs(c->f[i]);
  for (size_t i = 0; c->mode == MHB_ALL_COLUMNS && i < 2 * nf * (size_t)c->stride; i++)
    sum += fabs(c->J[i]);
  if (isfinite(sum + c->info->slip_work)) return;
  memset(c->f, 0, sizeof(double) * 2 * nf);
  memset(c->J, 0, sizeof(double) * 2 * nf * (size_t)c->stride);
  c->info->slip_work = c->info->error = c->squared_error = 0;
  c->info->lost                                          = 1;
}

/* With a larger tolerance the slider of a motion nearby is as good as it is asked to be. From afar
 * it is better, because Newton's last step is: curves are smoother. */
static const double SHARP = 1e-5;

/* The periodic slider of a contact that stays closed and slips. slider: of a motion nearby, N; not
 * a number: none. */
static int periodic_slider(mhb_contact_evaluator *c, const double *slider) {
  const mhb_static_friction *stuck = &c->static_friction;
  double                     z[2];
  int                        near = c->tolerance <= SHARP && isfinite(slider[0] + slider[1]);
  for (int k = 0; k < 2; k++)
    z[k] = near ? slider[k] / c->scale : c->coefficients[(1 + k) * c->nb] - stuck->c[k];
  int ok = mhb_slider_periodic(c, near, z);
  for (int k = 0; k < 2; k++) c->info->slider[k] = c->scale * z[k];
  return ok;
}

static void friction_force(mhb_contact_evaluator *c, const double *slider) {
  if (c->intervals.always_open) {
    c->info->share[MHB_SEPARATE] = 1;
    return;
  }
  if (c->slip.mu == 0) {
    without_friction(c);
    return;
  }
  int ok;
  if (c->intervals.always_closed) {
    mhb_static_friction_solve(&c->signals, c->slip.mu, &c->static_friction);
    if (c->static_friction.feasible) {
      finish_stuck(c);
      return;
    }
    ok = periodic_slider(c, slider);
  } else {
    ok = mhb_slider_with_openings(c);
    mhb_force_integrals_collect(c);
  }
  mhb_force_integrals_finish(c);
  c->info->lost = !ok;
  if (!ok)
    c->info->error =
        fmax(c->info->error, c->intervals.always_closed ? 0 : SHB_TWO_PI * c->force_level);
  if (!ok || c->info->laps > 20) drop_friction(c);
}

/* Error of the integrals, as harmonics and relative to the largest of them. Those of the panels
 * have changing signs and add up like squares. The factor 0.5 is calibrated on the motions of
 * tests/mhb/contact/test_accuracy. */
static double relative_error(const mhb_contact_evaluator *c, const mhb_law *law,
                             const double *force) {
  double top = fabs(force[0] + law->mean_offset),
         sum = .5 * sqrt(c->squared_error) + c->info->error;
  for (int i = 1; i < 3 * c->nf; i++) top = fabs(force[i]) > top ? fabs(force[i]) : top;
  if (c->info->lost && sum == 0) return 1;
  return top > 0 ? fmin(1, 2 / SHB_TWO_PI * sum * c->scale / top) : 0;
}

void mhb_contact_force(mhb_contact_evaluator *c, const mhb_law *law, const double *motion,
                       double *force, double *jacobian, mhb_contact_info *info) {
  mhb_contact_force_near(c, law, NULL, motion, force, jacobian, info);
}

void mhb_contact_force_near(mhb_contact_evaluator *c, const mhb_law *law, const double *slider,
                            const double *motion, double *force, double *jacobian,
                            mhb_contact_info *info) {
  int          nb = c->nb, nf = c->nf;
  size_t       size     = (size_t)nf * 3;
  const double start[2] = {slider ? slider[0] : NAN, slider ? slider[1] : NAN}; /* may be info's */
  memset(info, 0, offsetof(mhb_contact_info, transition));
  info->slider[0] = info->slider[1] = NAN;
  memset(force, 0, sizeof(double) * size);
  c->info = info;
  if (!set_signals(c, law, motion)) { /* at rest without preload, or not finite */
    if (jacobian) memset(jacobian, 0, sizeof(double) * size * 3 * (size_t)nb);
    info->share[MHB_SEPARATE] = 1;
    info->lost                = isnan(c->scale);
    for (size_t i = 0; info->lost && i < size; i++) force[i] = NAN;
    return;
  }
  mhb_contact_intervals_find(&c->signals, &c->intervals);
  set_slip(c, law, jacobian != NULL);
  c->mode   = jacobian ? MHB_ALL_COLUMNS : MHB_NO_COLUMNS;
  c->record = 1;
  mhb_force_integrals_clear(c);
  friction_force(c, start);
  for (int i = 0; i < 2 * nf; i++) {
    force[nf + i] = c->scale * c->f[i];
    if (!jacobian) continue;
    const double *from = c->J + (size_t)i * (size_t)c->stride;
    double       *row  = jacobian + (size_t)(nf + i) * 3 * (size_t)nb;
    for (int j = 0; j < 3 * nb; j++) row[j] = c->scale * from[j];
  }
  if (jacobian) memset(jacobian, 0, sizeof(double) * (size_t)nf * 3 * (size_t)nb);
  normal_load(c, law, motion, force, jacobian);
  info->slip_work *= c->scale;
  info->dissipation = loop_work(c, motion, force);
  info->error       = relative_error(c, law, force);
}
