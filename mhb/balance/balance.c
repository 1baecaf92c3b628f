#include "mhb/balance/balance.h"

#include <lapacke.h>
#include <math.h>
#include <omp.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/balance/ring_condensation.h"
#include "mhb/balance/stuck_solver.h"
#include "mhb/contact/slip_onset.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/simd.h"
#include "mhb/problem/wave.h"
#include "mhb/structure/ring_receptance.h"

/* Margin of a bound that decides the state of a pair. */
static const double SURE = 1e-9;

/* Fewer pairs than this are not worth a team of threads. */
enum { WORTH_THREADS = 24 };

/* One evaluator a thread. Inside a parallel region, where a thread traces a branch, just one. */
static shb_status create_contacts(mhb_balance *b) {
  int threads  = omp_in_parallel() || b->n_pairs < WORTH_THREADS ? 1 : omp_get_max_threads();
  b->contacts  = shb_arena_take(&b->arena, (size_t)threads, sizeof(mhb_contact_evaluator *));
  b->n_threads = threads;
  for (int i = 0; i < threads; i++)
    SHB_TRY(mhb_contact_evaluator_create(b->m, b->m, b->settings->tolerance, &b->contacts[i]));
  b->contact = b->contacts[0];
  return SHB_OK;
}

/* Each contact of a ring is evaluated in the time of its own blade. So the tuned wave has the same
 * numbers in all of them, whatever the tolerance of the law. */
static void set_lags(mhb_balance *b) {
  const mhb_driven_wave wave = mhb_settings_wave(b->settings);
  const int             N = b->receptance->ring->blades, shift = mhb_driven_wave_shift(wave);
  const double          step = mhb_driven_wave_lag_of(wave, shift > 0 ? shift : 0);
  for (int i = 0; i < N; i++)
    for (int k = 0; k <= b->m; k++)
      b->lag[i * (b->m + 1) + k] = cexp(-I * fmod(fmod(i * step, SHB_TWO_PI) * k, SHB_TWO_PI));
}

/* The laws of the pairs at the interfaces' operating points. */
static void set_laws(mhb_balance *b) {
  b->n_laws++;
  for (int a = 0; a < b->n_pairs; a++)
    b->law[a] = mhb_operating_point_law(&b->eval->own[b->receptance->interface[a]],
                                        b->settings->preload, b->receptance->share[a]);
}

/* The operating point has changed: the interfaces' own, the laws and linear derivatives follow. */
static void operating_point_changed(mhb_balance *b) {
  for (int i = 0; i < b->n_interfaces; i++)
    b->eval->own[i] = mhb_interface_operating_point(&b->eval->at, b->settings, i);
  for (int a = 0; a < b->n_pairs; a++) b->eval->linear_dp[a] = -1;
  set_laws(b);
}

mhb_receptance_product *mhb_balance_product(const mhb_balance *b, mhb_receptance *receptance,
                                            int first, int m) {
  const double from = fmax(b->settings->frequency[0], b->settings->frequency[1]);
  double       stiffness[3 * b->n_pairs], top = 0;
  for (int a = 0; a < b->n_pairs; a++)
    top = fmax(top, fmax(b->law[a].kv, fmax(b->law[a].ku[0], b->law[a].ku[2])));
  for (int i = 0; i < 3 * b->n_pairs; i++) {
    const mhb_law *law = &b->law[i / 3];
    stiffness[i]       = fmax(i % 3 ? law->ku[i % 3 == 2 ? 2 : 0] : law->kv, 1e-3 * top);
    if (!(stiffness[i] > 0)) stiffness[i] = 1;
  }
  return mhb_receptance_product_create(receptance, first, m, stiffness,
                                       SHB_TWO_PI * fmax(from, receptance->model->frequency[0]));
}

shb_status mhb_balance_create(const modal_model *model, const mhb_settings *settings,
                              mhb_balance **out) {
  mhb_receptance *receptance;
  SHB_TRY(mhb_receptance_create(model, settings, settings->harmonics, &receptance));
  shb_status status = mhb_balance_create_on(receptance, settings, out);
  if (status == SHB_OK)
    (*out)->owns_receptance = 1;
  else
    mhb_receptance_destroy(receptance);
  return status;
}

shb_status mhb_balance_create_on(mhb_receptance *receptance, const mhb_settings *settings,
                                 mhb_balance **out) {
  mhb_balance *b  = shb_alloc_zeroed(1, sizeof *b);
  int          m  = settings->harmonics;
  b->settings     = settings;
  b->receptance   = receptance;
  b->m            = m;
  b->n_pairs      = receptance->model->n_pairs;
  b->n_interfaces = mhb_interfaces(settings);
  b->nb           = mhb_real_size(m);
  b->n            = 3 * b->n_pairs * b->nb;
  size_t pairs    = (size_t)b->n_pairs;
  b->law          = shb_arena_take(&b->arena, pairs, sizeof *b->law);
  b->force_k      = shb_arena_take(&b->arena, 3 * pairs, sizeof(double complex));
  b->motion_k     = shb_arena_take(&b->arena, 3 * pairs, sizeof(double complex));
  if (receptance->ring) {
    b->lag = shb_arena_take(&b->arena, pairs * ((size_t)m + 1), sizeof(double complex));
    set_lags(b);
  }
  b->default_evaluation   = mhb_evaluation_create(b);
  const shb_status status = create_contacts(b);
  if (status != SHB_OK) {
    mhb_balance_destroy(b);
    return status;
  }
  b->eval     = b->default_evaluation;
  b->eval->at = mhb_operating_point_of(settings);
  operating_point_changed(b);
  if (b->n_pairs >= MHB_MANY_PAIRS && !receptance->at && !receptance->ring)
    b->product = mhb_balance_product(b, receptance, 0, m);
  *out = b;
  return SHB_OK;
}

void mhb_balance_destroy(mhb_balance *b) {
  if (!b) return;
  mhb_receptance_product_destroy(b->product);
  mhb_stuck_solver_destroy(b->stuck);
  if (b->owns_receptance) mhb_receptance_destroy(b->receptance);
  for (int i = 0; b->contacts && i < b->n_threads; i++)
    mhb_contact_evaluator_destroy(b->contacts[i]);
  mhb_evaluation_destroy(b->default_evaluation);
  shb_arena_free(&b->arena);
  free(b);
}

mhb_evaluation *mhb_evaluation_create(const mhb_balance *b) {
  mhb_evaluation *e     = shb_alloc_zeroed(1, sizeof *e);
  size_t          pairs = (size_t)b->n_pairs, block = 3 * (size_t)b->nb;
  e->p            = shb_arena_take(&e->arena, (size_t)b->n, sizeof(double));
  e->dp           = shb_arena_take(&e->arena, pairs * block * block, sizeof(double));
  e->linear_dp    = shb_arena_take(&e->arena, pairs, sizeof *e->linear_dp);
  e->kind         = shb_arena_take(&e->arena, pairs, sizeof *e->kind);
  e->info         = shb_arena_take(&e->arena, pairs, sizeof *e->info);
  e->by_parameter = shb_arena_take(&e->arena, (size_t)b->n, sizeof(double));
  for (size_t a = 0; a < pairs; a++) e->linear_dp[a] = -1;
  if (b->eval) {
    e->at = b->eval->at;
    memcpy(e->own, b->eval->own, sizeof e->own);
  }
  return e;
}

void mhb_evaluation_destroy(mhb_evaluation *e) {
  if (!e) return;
  shb_arena_free(&e->arena);
  free(e);
}

static bool same_law(const mhb_operating_point *p, const mhb_operating_point *q) {
  return p->n0 == q->n0 && p->mu == q->mu && p->kv == q->kv && p->ku[0] == q->ku[0] &&
         p->ku[1] == q->ku[1] && p->ku[2] == q->ku[2];
}

/* The laws depend on the interfaces' operating points, but for frequency and scale. */
static bool same_laws(const mhb_balance *b, const mhb_evaluation *x, const mhb_evaluation *y) {
  for (int i = 0; i < b->n_interfaces; i++)
    if (!same_law(&x->own[i], &y->own[i])) return false;
  return true;
}

void mhb_balance_sharpen_law(mhb_balance *b, double share) {
  for (int i = 0; i < b->n_threads; i++)
    mhb_contact_evaluator_set_tolerance(b->contacts[i], share * b->settings->tolerance);
}

void mhb_balance_use(mhb_balance *b, mhb_evaluation *evaluation) {
  const mhb_evaluation *last = b->eval;
  b->eval                    = evaluation ? evaluation : b->default_evaluation;
  if (b->eval == last) return;
  if (!same_laws(b, last, b->eval)) set_laws(b);
  if (last->at.scale != b->eval->at.scale) mhb_receptance_scale(b->receptance, b->eval->at.scale);
  mhb_receptance_set_frequency(b->receptance, b->eval->at.omega);
}

void mhb_balance_discard(mhb_balance *b, mhb_evaluation *evaluation) {
  if (b->eval == evaluation) mhb_balance_use(b, NULL);
  mhb_evaluation_destroy(evaluation);
}

void mhb_balance_set_operating_point(mhb_balance *b, const mhb_operating_point *at) {
  b->eval->at = *at;
  operating_point_changed(b);
  mhb_receptance_scale(b->receptance, b->eval->at.scale);
}

void mhb_balance_set_preload(mhb_balance *b, double n0) {
  b->eval->at.n0 = n0;
  operating_point_changed(b);
}

void mhb_balance_tie_preloads(mhb_balance *b, int anchored) {
  b->eval->at.preloads_tied = anchored;
  b->eval->at.tied_n0       = b->eval->at.n0;
}

void mhb_balance_set_parameter(mhb_balance *b, mhb_parameter parameter) {
  b->parameter = parameter;
}

void mhb_balance_set_value(mhb_balance *b, double value) {
  if (value == mhb_parameter_get(&b->eval->at, b->parameter)) return;
  mhb_parameter_set(&b->eval->at, b->parameter, value);
  if (b->parameter == MHB_IN_FREQUENCY) return;
  if (b->parameter == MHB_IN_SCALE) {
    mhb_receptance_scale(b->receptance, value);
  } else {
    operating_point_changed(b);
  }
}

void mhb_balance_go_to(mhb_balance *b, mhb_parameter parameter, double value) {
  mhb_balance_set_parameter(b, parameter);
  mhb_balance_set_value(b, value);
  mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
}

void mhb_balance_get_harmonic(const mhb_balance *b, const double *x, int k, double complex *out) {
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *a = x + (size_t)row * (size_t)b->nb;
    out[row]        = k == 0 ? a[0] : CMPLX(a[2 * k - 1], a[2 * k]);
  }
}

void mhb_balance_put_harmonic(const mhb_balance *b, double *x, int k, const double complex *in) {
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    double *a = x + (size_t)row * (size_t)b->nb;
    if (k == 0) {
      a[0] = creal(in[row]);
    } else {
      a[2 * k - 1] = creal(in[row]);
      a[2 * k]     = cimag(in[row]);
    }
  }
}

/* re, im += the complex row R times the rows d (cosine) and e (sine) of three axes. */
MHB_HOT static void add_complex_row(int block, const double *d, size_t stride,
                                    const double complex R[3], double *restrict re,
                                    double *restrict im) {
  const double *d0 = d, *d1 = d + stride, *d2 = d1 + stride;
  const double *e0 = d0 + block, *e1 = d1 + block, *e2 = d2 + block;
  double        x0 = creal(R[0]), x1 = creal(R[1]), x2 = creal(R[2]);
  double        y0 = cimag(R[0]), y1 = cimag(R[1]), y2 = cimag(R[2]);
  for (int j = 0; j < block; j++) {
    re[j] += x0 * d0[j] - y0 * e0[j] + x1 * d1[j] - y1 * e1[j] + x2 * d2[j] - y2 * e2[j];
    im[j] += y0 * d0[j] + x0 * e0[j] + y1 * d1[j] + x1 * e1[j] + y2 * d2[j] + x2 * e2[j];
  }
}

void mhb_balance_row_times_dp(const mhb_balance *b, const double complex R[3], int pair, int k,
                              double *re, double *im) {
  int           block  = 3 * b->nb;
  size_t        stride = (size_t)b->nb * (size_t)block;
  const double *d      = b->eval->dp + (size_t)pair * 3 * stride + (k ? 2 * k - 1 : 0) * block;
  if (k) {
    add_complex_row(block, d, stride, R, re, im);
    return;
  }
  for (int j = 0; j < block; j++)
    re[j] += creal(R[0]) * d[j] + creal(R[1]) * d[stride + (size_t)j] +
             creal(R[2]) * d[2 * stride + (size_t)j];
}

/* out[3] <- row of R_k, columns of a pair. */
static void receptance_row(const mhb_balance *b, int k, int row, int pair, double complex out[3]) {
  const mhb_receptance *r  = b->receptance;
  const size_t          n3 = (size_t)r->n;
  if (r->ring)
    mhb_ring_receptance_row(r->ring, k, row, pair, out);
  else
    memcpy(out, r->R + ((size_t)k * n3 + (size_t)row) * n3 + 3 * pair, 3 * sizeof *out);
}

/* Columns of one pair in the Jacobian I + R dp. */
static void assemble_columns(const mhb_balance *b, int pair, double *jacobian) {
  int    block = 3 * b->nb, n3 = 3 * b->n_pairs;
  size_t n = (size_t)b->n, first = (size_t)pair * (size_t)block;
  double re[block], im[block];
  for (int row = 0; row < n3; row++)
    for (int k = 0; k <= b->m; k++) {
      double complex R[3];
      mhb_receptance_update(b->receptance, k);
      receptance_row(b, k, row, pair, R);
      double *J = jacobian + first * n + row * b->nb + (k ? 2 * k - 1 : 0);
      memset(re, 0, sizeof re);
      memset(im, 0, sizeof im);
      mhb_balance_row_times_dp(b, R, pair, k, re, im);
      for (size_t j = 0; j < (size_t)block; j++) {
        J[j * n] = re[j];
        if (k) J[j * n + 1] = im[j];
      }
    }
  for (size_t i = first; i < first + (size_t)block; i++) jacobian[i * n + i] += 1;
}

static mhb_pair_kind kind_of(const mhb_balance *b, int a) {
  const mhb_contact_info *info = &b->eval->info[a];
  const double           *p    = b->eval->p + 3 * (size_t)a * (size_t)b->nb;
  if (info->share[MHB_SEPARATE] == 1 && !info->lost) return MHB_PAIR_OPEN;
  if (info->share[MHB_STICK] < 1 || !info->undetermined) return MHB_PAIR_NONLINEAR;
  return p[b->nb] == 0 && p[2 * b->nb] == 0 ? MHB_PAIR_STUCK : MHB_PAIR_AT_LIMIT;
}

/* Derivative of a stuck or open pair, from the law itself: the same to the last bit in every
 * evaluation. Written only if dp holds another one; the mean friction is written elsewhere. */
static void set_linear_derivative(const mhb_balance *b, int a) {
  const mhb_law *law = &b->law[a];
  size_t         nb = (size_t)b->nb, block = 3 * nb;
  double        *d = b->eval->dp + (size_t)a * block * block;
  if (b->eval->linear_dp[a] == (int)b->eval->kind[a]) return;
  b->eval->linear_dp[a] = (int)b->eval->kind[a];
  memset(d, 0, sizeof(double) * block * block);
  if (b->eval->kind[a] == MHB_PAIR_OPEN) return;
  for (size_t i = 0; i < nb; i++) d[i * block + i] = law->kv;
  for (size_t i = 1; i < nb; i++) {
    double *u = d + (nb + i) * block, *w = d + (2 * nb + i) * block;
    u[nb + i]     = law->ku[0];
    u[2 * nb + i] = law->ku[1];
    w[nb + i]     = law->ku[1];
    w[2 * nb + i] = law->ku[2];
  }
}

/* n rows in real form times lag or its conjugate, harmonic by harmonic. stride: between the numbers
 * of a row; next: between rows. */
static void turn(const mhb_balance *b, const double complex *lag, double sign, int n, size_t stride,
                 size_t next, double *x) {
  for (int i = 0; i < n; i++, x += next)
    for (int k = 1; k <= b->m; k++) {
      double      *re = x + (size_t)(2 * k - 1) * stride, *im = re + stride;
      const double c = creal(lag[k]), s = sign * cimag(lag[k]), old = *re;
      *re = c * old - s * *im;
      *im = s * old + c * *im;
    }
}

/* Of a pair of blade 0, and of a blade alone: 1. */
static const double complex *lag_of(const mhb_balance *b, int a) {
  const int blade = b->lag ? 3 * a / b->receptance->ring->n : 0;
  return blade > 0 ? b->lag + blade * (b->m + 1) : NULL;
}

/* mhb_contact_force in the time of the pair's blade. dp turns on both sides. */
static void force_of_pair(mhb_balance *b, mhb_contact_evaluator *contact, const double *x, int a,
                          double *dp) {
  const size_t          nb = (size_t)b->nb, block = 3 * nb;
  const double complex *lag = lag_of(b, a);
  double               *p   = b->eval->p + (size_t)a * block, own[block];
  memcpy(own, x + (size_t)a * block, sizeof own);
  if (lag) turn(b, lag, -1, 3, 1, nb, own);
  mhb_contact_force_near(contact, &b->law[a], b->eval->near ? mhb_balance_slider(b, a) : NULL, own,
                         p, dp, &b->eval->info[a]);
  if (!lag) return;
  turn(b, lag, 1, 3, 1, nb, p);
  if (!dp) return;
  turn(b, lag, 1, 3 * (int)block, 1, nb, dp); /* columns: every row has three axes */
  for (size_t axis = 0; axis < 3; axis++)
    turn(b, lag, 1, (int)block, block, 1, dp + axis * nb * block);
}

/* Rows of dp that are the mean friction of a pair at its limit. */
static void set_mean_gradient(mhb_balance *b, mhb_contact_evaluator *contact, int a) {
  const double complex *lag    = lag_of(b, a);
  double *const         row[2] = {mhb_balance_mean_friction_row(b, a, 1),
                                  mhb_balance_mean_friction_row(b, a, 2)};
  mhb_contact_mean_gradient(contact, row);
  for (int i = 0; lag && i < 2; i++) turn(b, lag, 1, 3, 1, (size_t)b->nb, row[i]);
}

/* Force of a pair that sticks without mean friction, or is open. */
static void linear_force(const mhb_balance *b, const double *x, int a, mhb_pair_kind kind) {
  const mhb_law *law = &b->law[a];
  const int      nb  = b->nb;
  const double  *v = x + (size_t)(3 * a) * (size_t)nb, *u = v + nb, *w = u + nb;
  double        *p = b->eval->p + (size_t)(3 * a) * (size_t)nb;
  memset(p, 0, sizeof *p * 3 * (size_t)nb);
  p[0] = -law->mean_offset;
  if (kind == MHB_PAIR_OPEN) return;
  p[0] += law->n0;
  for (int i = 0; i < nb; i++) p[i] += law->kv * v[i];
  for (int i = 1; i < nb; i++) {
    p[nb + i]     = law->ku[0] * u[i] + law->ku[1] * w[i];
    p[2 * nb + i] = law->ku[1] * u[i] + law->ku[2] * w[i];
  }
}

/* Sums of the amplitudes of all harmonics bound the normal load and the friction of a pair. Where
 * they show that it sticks without mean friction, or is open, the law is not asked. Else
 * nonlinear: not known. */
static mhb_pair_kind sure_kind(const mhb_balance *b, const double *x, int a) {
  const mhb_law *law = &b->law[a];
  const double  *v = x + (size_t)(3 * a) * (size_t)b->nb, *u = v + b->nb, *w = u + b->nb;
  double         load = 0, friction = 0;
  for (int i = 1; i < b->nb; i += 2) {
    double square = 0;
    for (int j = i; j < i + 2; j++) {
      const double f = law->ku[0] * u[j] + law->ku[1] * w[j];
      const double g = law->ku[1] * u[j] + law->ku[2] * w[j];
      square += f * f + g * g;
    }
    friction += sqrt(square);
    load += law->kv * sqrt(v[i] * v[i] + v[i + 1] * v[i + 1]);
  }
  const double mean = law->n0 + law->kv * v[0];
  if (mean + load < -SURE * load) return MHB_PAIR_OPEN;
  return friction < law->mu * (mean - load) * (1 - SURE) ? MHB_PAIR_STUCK : MHB_PAIR_NONLINEAR;
}

static void set_stuck(mhb_contact_info *info, bool stuck) {
  memset(info, 0, offsetof(mhb_contact_info, transition));
  info->share[stuck ? MHB_STICK : MHB_SEPARATE] = 1;
  info->undetermined                            = stuck;
  info->slider[0] = info->slider[1] = NAN;
}

static bool is_sure(mhb_balance *b, const double *x, int a, mhb_pair_kind *kind) {
  *kind = sure_kind(b, x, a);
  if (*kind == MHB_PAIR_NONLINEAR) return false;
  linear_force(b, x, a, *kind);
  set_stuck(&b->eval->info[a], *kind == MHB_PAIR_STUCK);
  return true;
}

static bool is_assumed(const mhb_balance *b, int a) {
  return b->assumed && (b->assumed[a] == MHB_PAIR_STUCK || b->assumed[a] == MHB_PAIR_OPEN);
}

/* A pair at the onset of slip, or extrapolated from there by its stuck law. */
static void evaluate_touching(mhb_balance *b, const double *x, int a, int derivative) {
  const mhb_law *law = &b->law[a];
  const size_t   nb = (size_t)b->nb, block = 3 * nb, at = (size_t)a * block;
  mhb_slip_onset onset;
  mhb_slip_onset_find(law, b->m, x + at, &onset);
  linear_force(b, x, a, MHB_PAIR_STUCK);
  set_stuck(&b->eval->info[a], true);
  for (size_t i = 0; i < 2; i++) b->eval->p[at + (i + 1) * nb] = onset.c[i];
  if (!derivative) return;
  b->eval->kind[a] = MHB_PAIR_AT_LIMIT;
  set_linear_derivative(b, a);
  double        by_h[block];
  double *const row[2] = {mhb_balance_mean_friction_row(b, a, 1),
                          mhb_balance_mean_friction_row(b, a, 2)};
  mhb_slip_onset_gradient(law, b->m, x + at, &onset, by_h, row);
}

/* A pair that was stuck or open is evaluated without derivative first: it mostly still is. */
static void evaluate_pair(mhb_balance *b, mhb_contact_evaluator *contact, const double *x, int a,
                          int derivative) {
  size_t  block = 3 * (size_t)b->nb, at = (size_t)a * block;
  double *dp = b->eval->dp + at * block;
  if (b->touching && b->touching[a]) {
    evaluate_touching(b, x, a, derivative);
    return;
  }
  if (!derivative && is_assumed(b, a)) {
    linear_force(b, x, a, b->assumed[a]);
    return;
  }
  mhb_pair_kind sure;
  if (is_sure(b, x, a, &sure)) {
    if (!derivative) return;
    b->eval->kind[a] = sure;
    set_linear_derivative(b, a);
    return;
  }
  if (!derivative || b->eval->kind[a] != MHB_PAIR_NONLINEAR) {
    force_of_pair(b, contact, x, a, NULL);
    if (!derivative) return;
    b->eval->kind[a] = kind_of(b, a);
  }
  if (b->eval->kind[a] == MHB_PAIR_NONLINEAR) {
    force_of_pair(b, contact, x, a, dp);
    b->eval->linear_dp[a] = -1;
    b->eval->kind[a]      = kind_of(b, a);
  }
  if (b->eval->kind[a] != MHB_PAIR_NONLINEAR) set_linear_derivative(b, a);
  if (b->eval->kind[a] == MHB_PAIR_AT_LIMIT) set_mean_gradient(b, contact, a);
}

static void evaluate_pairs(mhb_balance *b, const double *x, int derivative) {
  for (int a = 0; a < b->n_pairs && b->n_threads == 1; a++)
    evaluate_pair(b, b->contact, x, a, derivative);
  if (b->n_threads == 1) return;
#pragma omp parallel for schedule(dynamic, 1) num_threads(b->n_threads)
  for (int a = 0; a < b->n_pairs; a++)
    evaluate_pair(b, b->contacts[omp_get_thread_num()], x, a, derivative);
}

/* Harmonic k has neither load nor contact force: its receptance is not needed. */
static int is_unloaded(const mhb_balance *b, int k) {
  for (int i = 0; i < 3 * b->n_pairs; i++)
    if (creal(b->force_k[i]) != 0 || cimag(b->force_k[i]) != 0) return 0;
  return !b->receptance->driven[k];
}

/* motion_k <- motion_k - free + R_k force_k, harmonic k of r. */
static void subtract_response(const mhb_balance *b, int k) {
  int                   n3   = 3 * b->n_pairs;
  const double complex *R    = b->receptance->R + (size_t)k * (size_t)n3 * (size_t)n3;
  const double complex *free = b->receptance->free + k * n3;
  for (int i = 0; i < n3; i++, R += n3) {
    double complex u  = b->motion_k[i] - free[i];
    double         re = creal(u), im = cimag(u);
    for (int j = 0; j < n3; j++) {
      re += creal(R[j]) * creal(b->force_k[j]) - cimag(R[j]) * cimag(b->force_k[j]);
      im += creal(R[j]) * cimag(b->force_k[j]) + cimag(R[j]) * creal(b->force_k[j]);
    }
    b->motion_k[i] = CMPLX(re, im);
  }
}

/* The same of a ring. */
static void subtract_ring_response(const mhb_balance *b, int k) {
  const int             n    = 3 * b->n_pairs;
  const double complex *free = b->receptance->free + k * n;
  for (int i = 0; i < n; i++) b->motion_k[i] -= free[i];
  mhb_receptance_product_of(b->receptance, k, b->force_k, b->motion_k);
}

/* Harmonic k of r does not depend on the parameter. force_k: its change by the parameter. */
static int is_independent(const mhb_balance *b, int k, int unloaded) {
  if (b->parameter == MHB_IN_FREQUENCY) return unloaded;
  for (int i = 0; i < 3 * b->n_pairs; i++)
    if (creal(b->force_k[i]) != 0 || cimag(b->force_k[i]) != 0) return 0;
  return b->parameter != MHB_IN_SCALE || !b->receptance->driven[k];
}

/* motion_k <- dr_k/dvalue, force_k the forces at x. */
static void set_slope(mhb_balance *b, int k, int unloaded) {
  int n3 = 3 * b->n_pairs;
  if (b->parameter != MHB_IN_FREQUENCY)
    mhb_balance_get_harmonic(b, b->eval->by_parameter, k, b->force_k);
  for (int i = 0; i < n3; i++) b->motion_k[i] = 0;
  if (is_independent(b, k, unloaded)) return;
  mhb_receptance_update(b->receptance, k);
  if (b->parameter == MHB_IN_FREQUENCY) {
    mhb_receptance_slope(b->receptance, k, b->force_k, b->motion_k);
    for (int i = 0; i < n3; i++) b->motion_k[i] = -b->motion_k[i];
    return;
  }
  const double complex *unit = b->receptance->free_response_unit + k * n3;
  for (int i = 0; i < n3 && b->parameter == MHB_IN_SCALE; i++) b->motion_k[i] = -unit[i];
  mhb_receptance_product_of(b->receptance, k, b->force_k, b->motion_k);
}

/* dp/dparameter of all pairs; the rate is that of the interface's own parameter. */
static void set_force_by_parameter(mhb_balance *b, const double *x) {
  size_t block = 3 * (size_t)b->nb;
  for (int a = 0; a < b->n_pairs; a++) {
    size_t         at   = (size_t)a * block;
    int            i    = b->receptance->interface[a];
    double         rate = mhb_interface_rate(&b->eval->at, b->settings, i, b->parameter);
    mhb_pair_force pair = {b->nb, x + at, b->eval->p + at, b->eval->dp + at * block};
    mhb_parameter_force(&b->eval->own[i], b->parameter, &b->law[a], b->receptance->share[a], &pair,
                        b->eval->by_parameter + at);
    for (size_t j = at; j < at + block && rate != 1; j++) b->eval->by_parameter[j] *= rate;
  }
}

void mhb_balance_residual_of_many(mhb_balance *b, const double *x, double *r) {
  mhb_receptance_product_update(b->product);
  mhb_receptance_product_apply(b->product, MHB_PRODUCT_VALUE, b->negligible, b->eval->p, r);
  for (int k = 0; k <= b->m; k++) {
    const double complex *free = b->receptance->free + k * 3 * b->n_pairs;
    for (int i = 0; i < 3 * b->n_pairs; i++) {
      size_t at = (size_t)i * (size_t)b->nb + (size_t)(k ? 2 * k - 1 : 0);
      r[at] += x[at] - creal(free[i]);
      if (k) r[at + 1] += x[at + 1] - cimag(free[i]);
    }
  }
}

/* slope <- dr/dvalue of many pairs. */
static void slope_by_product(mhb_balance *b, double *slope) {
  const int by_frequency = b->parameter == MHB_IN_FREQUENCY, n3 = 3 * b->n_pairs;
  mhb_receptance_product_update(b->product);
  mhb_receptance_product_apply(b->product, by_frequency ? MHB_PRODUCT_SLOPE : MHB_PRODUCT_VALUE, 0,
                               by_frequency ? b->eval->p : b->eval->by_parameter, slope);
  for (int k = 0; k <= b->m; k++) {
    if (!b->receptance->driven[k] || (!by_frequency && b->parameter != MHB_IN_SCALE)) continue;
    if (by_frequency) mhb_receptance_slope(b->receptance, k, NULL, b->motion_k);
    for (int i = 0; i < n3; i++) {
      size_t         at = (size_t)i * (size_t)b->nb + (size_t)(k ? 2 * k - 1 : 0);
      double complex load =
          by_frequency ? b->motion_k[i] : b->receptance->free_response_unit[k * n3 + i];
      slope[at] -= creal(load);
      if (k) slope[at + 1] -= cimag(load);
    }
  }
}

static void evaluate(mhb_balance *b, const double *x, double value, int derivative, double *r,
                     double *slope) {
  int by_law = slope && b->parameter != MHB_IN_FREQUENCY; /* the slope needs dp */
  b->n_linearised += derivative;
  mhb_balance_set_value(b, value);
  mhb_receptance_set_frequency(b->receptance, b->eval->at.omega);
  evaluate_pairs(b, x, derivative || by_law);
  if (by_law) set_force_by_parameter(b, x);
  if (b->product) {
    mhb_balance_residual_of_many(b, x, r);
    if (slope) slope_by_product(b, slope);
  }
  for (int k = 0; k <= b->m && !b->product; k++) {
    mhb_balance_get_harmonic(b, b->eval->p, k, b->force_k);
    mhb_balance_get_harmonic(b, x, k, b->motion_k);
    int unloaded = is_unloaded(b, k);
    if (!unloaded) {
      mhb_receptance_update(b->receptance, k);
      (b->receptance->ring ? subtract_ring_response : subtract_response)(b, k);
    }
    mhb_balance_put_harmonic(b, r, k, b->motion_k);
    if (!slope) continue;
    set_slope(b, k, unloaded);
    mhb_balance_put_harmonic(b, slope, k, b->motion_k);
  }
}

void mhb_balance_slope(mhb_balance *b, const double *x, mhb_parameter parameter, double *slope) {
  mhb_parameter own = b->parameter;
  b->parameter      = parameter;
  if (parameter != MHB_IN_FREQUENCY) set_force_by_parameter(b, x);
  if (b->product) slope_by_product(b, slope);
  for (int k = 0; k <= b->m && !b->product; k++) {
    mhb_balance_get_harmonic(b, b->eval->p, k, b->force_k);
    set_slope(b, k, is_unloaded(b, k));
    mhb_balance_put_harmonic(b, slope, k, b->motion_k);
  }
  b->parameter = own;
}

void mhb_balance_linearise(mhb_balance *b, const double *x, double value, double *r,
                           double *slope) {
  evaluate(b, x, value, 1, r, slope);
}

void mhb_balance_evaluate(mhb_balance *b, const double *x, double value, double *r,
                          double *jacobian, double *slope) {
  evaluate(b, x, value, jacobian != NULL, r, slope);
  for (int pair = 0; jacobian && pair < b->n_pairs; pair++) assemble_columns(b, pair, jacobian);
}

static int is_stuck(const mhb_balance *b, int pair, int stuck) {
  return stuck == MHB_BY_PRELOAD ? b->law[pair].n0 > 0 : stuck;
}

/* The preload s0 of a stuck pair that the equilibrium does not contain. */
static double own_preload(const mhb_law *law) {
  return fmax(law->n0, 0) - law->mean_offset;
}

/* u <- free_0 - R_0 s0 of the stuck pairs. */
static void subtract_preload(const mhb_balance *b, int stuck, double complex *u) {
  memset(b->force_k, 0, sizeof *b->force_k * 3 * (size_t)b->n_pairs);
  for (int a = 0; a < b->n_pairs; a++)
    if (is_stuck(b, a, stuck)) b->force_k[3 * a] = own_preload(&b->law[a]) * (b->product ? 1 : -1);
  if (b->product)
    mhb_receptance_motion(b->receptance, 0, b->force_k, u); /* without R_0 */
  else
    mhb_receptance_product_of(b->receptance, 0, b->force_k, u);
}

bool mhb_balance_solve_many_stuck(mhb_balance *b, int k, const mhb_pair_kind *kind,
                                  double complex *u) {
  const double *range = b->settings->frequency;
  if (!b->product) return false;
  if (!b->stuck) b->stuck = mhb_stuck_solver_create(b->product, b->m);
  return mhb_stuck_solver_solve(b->stuck, k, 0.5 * SHB_TWO_PI * (range[0] + range[1]), b->law, kind,
                                u);
}

static void set_kinds(const mhb_balance *b, int stuck, mhb_pair_kind *kind) {
  for (int a = 0; a < b->n_pairs; a++)
    kind[a] = is_stuck(b, a, stuck) ? MHB_PAIR_STUCK : MHB_PAIR_OPEN;
}

/* u <- (I + R_k S)^-1 u */
static shb_status solve_stuck(mhb_balance *b, int k, int stuck, double complex *u) {
  mhb_pair_kind kind[b->n_pairs];
  set_kinds(b, stuck, kind);
  if (mhb_balance_solve_many_stuck(b, k, kind, u)) return SHB_OK;
  mhb_receptance_update(b->receptance, k);
  enum { FEW = 3 * MHB_MANY_PAIRS };
  const int              n = 3 * b->n_pairs;
  lapack_complex_double  few[n < FEW ? n * n : 1];
  lapack_int             ipiv[n];
  lapack_complex_double *A = n < FEW ? few : shb_alloc_zeroed((size_t)n * (size_t)n, sizeof *A);
  mhb_stick_matrix(b->n_pairs, b->law, kind, k,
                   b->receptance->R + (size_t)k * (size_t)n * (size_t)n, A);
  const lapack_int bad = LAPACKE_zgesv_work(LAPACK_COL_MAJOR, n, 1, A, n, ipiv, u, n);
  if (A != few) free(A);
  SHB_CHECK(bad == 0, SHB_ERR_INPUT, "the stuck system is singular at harmonic %d", k);
  return SHB_OK;
}

/* The same of a ring. */
static shb_status solve_stuck_ring(const mhb_balance *b, int k, int stuck, double complex *u) {
  mhb_pair_kind kind[b->n_pairs];
  bool          moves = false;
  set_kinds(b, stuck, kind);
  for (int i = 0; i < 3 * b->n_pairs; i++) moves = moves || creal(u[i]) != 0 || cimag(u[i]) != 0;
  return moves ? mhb_ring_linear_limit(b->receptance->ring, b->law, k, kind, u) : SHB_OK;
}

/* Without load a harmonic rests in a linear limit. Its receptance is not needed. */
static bool rests(const mhb_balance *b, int k) {
  return k > 0 && !b->receptance->driven[k];
}

/* Stuck: (I + R_k S) u_k = free_k - R_k s0, with s0 at k = 0 only. The mean friction is zero, the
 * smallest admissible one (contact/static_friction.h). */
static shb_status linear_harmonic(mhb_balance *b, int k, int stuck, double complex *u) {
  const int n = 3 * b->n_pairs;
  memset(u, 0, sizeof *u * (size_t)n);
  if (rests(b, k)) return SHB_OK;
  memcpy(u, b->receptance->free + k * n, sizeof *u * (size_t)n);
  if (!stuck) return SHB_OK;
  if (k == 0) subtract_preload(b, stuck, u);
  return b->receptance->ring ? solve_stuck_ring(b, k, stuck, u) : solve_stuck(b, k, stuck, u);
}

shb_status mhb_balance_linear_limit(mhb_balance *b, double value, int stuck, double *x) {
  mhb_balance_set_value(b, value);
  mhb_receptance_set_frequency(b->receptance, b->eval->at.omega);
  for (int k = 0; k <= b->m; k++) {
    if (!rests(b, k)) mhb_balance_update_probes(b, k);
    SHB_TRY(linear_harmonic(b, k, stuck, b->motion_k));
    mhb_balance_put_harmonic(b, x, k, b->motion_k);
    for (int i = 0; i < 3 * b->n_pairs; i++) b->force_k[i] = 0;
    for (int a = 0; stuck && a < b->n_pairs; a++) {
      if (!is_stuck(b, a, stuck)) continue;
      const mhb_law        *law = &b->law[a];
      const double complex *u   = b->motion_k + 3 * a;
      mhb_stick_force(law, k, u, b->force_k + 3 * a);
      if (k == 0) b->force_k[3 * a] += own_preload(law);
    }
    mhb_balance_put_harmonic(b, b->eval->p, k, b->force_k);
  }
  return SHB_OK;
}

void mhb_balance_contact_force(const mhb_balance *b, int k, double complex *p) {
  mhb_balance_get_harmonic(b, b->eval->p, k, p);
}

void mhb_balance_update_probes(const mhb_balance *b, int k) {
  if (b->product)
    mhb_receptance_update_load(b->receptance, k);
  else
    mhb_receptance_update(b->receptance, k);
}

bool mhb_balance_is_linear(const mhb_balance *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->eval->info[a].share[MHB_STICK] < 1 && b->eval->info[a].share[MHB_SEPARATE] < 1)
      return false;
  return true;
}

double mhb_balance_vibration(const mhb_balance *b, const double *x) {
  double vibration = 0, mean = 0;
  for (int i = 0; i < b->n; i++) *(i % b->nb ? &vibration : &mean) += x[i] * x[i];
  return sqrt(vibration > 0 ? vibration : mean);
}
