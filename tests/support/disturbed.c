#include "tests/support/disturbed.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/contact/slip.h"
#include "mhb/contact/time_history.h"
#include "mhb/numerics/fourier.h"

void disturbed_create(const modal_model *model, const mhb_settings *settings,
                      const mhb_balance *residual, const double *x, double omega, int steps,
                      disturbed *d) {
  *d          = (disturbed){.model    = model,
                            .settings = settings,
                            .residual = residual,
                            .x        = x,
                            .omega    = omega,
                            .steps    = steps,
                            .blades   = settings->to_ground ? 1 : settings->blades,
                            .sides    = settings->to_ground ? 1 : 2};
  d->contacts = d->blades * model->n_pairs;
  d->n        = 2 * d->blades * model->n_modes + 2 * d->contacts;
  if (!settings->to_ground) {
    d->wave = settings->engine_order;
    while (d->wave % settings->subharmonics) d->wave += settings->blades;
    d->wave /= settings->subharmonics;
  }
  d->p     = calloc(3 * (size_t)d->contacts, sizeof(double));
  d->guess = calloc(3 * (size_t)d->contacts, sizeof(double));
  d->u     = calloc(3 * (size_t)d->contacts, sizeof(double));
}

void disturbed_destroy(disturbed *d) {
  free(d->p);
  free(d->guess);
  free(d->u);
}

static double lag(const disturbed *d, int blade) {
  return d->settings->to_ground ? 0 : (double)d->wave * blade / d->settings->blades;
}

/* Force on the structure's contact dof (side, pair, axis) of a blade, from p of its contacts. */
static double dof_force(const disturbed *d, const double *p, int blade, int side, int dof) {
  int pair = dof / 3, axis = dof % 3;
  int contact = (side ? (blade + d->blades - 1) % d->blades : blade) * d->model->n_pairs + pair;
  const double *T0 = d->residual->receptance->T0 + 9 * pair + 3 * axis;
  double        f  = 0;
  for (int c = 0; c < 3; c++) f += T0[c] * p[3 * contact + c];
  return side ? f : -f;
}

/* Relative motion of all contacts for modal coordinates q[blade][mode] and contact forces p. */
static void relative(const disturbed *d, const double *q, const double *p, double *u) {
  const modal_model *model = d->model;
  int m = model->n_modes, n3 = 3 * model->n_pairs, nc = n3 * (model->has_left ? 2 : 1);
  memset(u, 0, sizeof(double) * 3 * (size_t)d->contacts);
  for (int b = 0; b < d->blades; b++) {
    for (int side = 0; side < d->sides; side++) {
      const double *shape   = side ? model->left : model->right;
      int           contact = (side ? (b + d->blades - 1) % d->blades : b) * model->n_pairs;
      for (int dof = 0; dof < n3; dof++) {
        double x = 0;
        for (int i = 0; i < m; i++) x += shape[dof * m + i] * q[b * m + i];
        for (int k = 0; model->residual_flexibility && k < d->sides * n3; k++)
          x += model->residual_flexibility[(side * n3 + dof) * nc + k] *
               dof_force(d, p, b, k / n3, k % n3);
        const double *T0 = d->residual->receptance->T0 + 9 * (dof / 3) + 3 * (dof % 3);
        for (int c = 0; c < 3; c++) u[3 * contact + dof / 3 * 3 + c] += (side ? -x : x) * T0[c];
      }
    }
  }
}

/* Forces after a step from u0 to u, starting with friction f0. If the contact closes during the
 * step, only the part after that moment counts. Otherwise friction would ignore the moment of
 * closing, and its derivative would be wrong for any step size. */
static void contact_law(const mhb_law *law, const double u[3], const double u0[3],
                        const double f0[2], double p[3]) {
  double gap0 = law->n0 + law->kv * u0[0], gap = law->n0 + law->kv * u[0], n = fmax(0, gap);
  double part  = gap0 < 0 && gap > 0 ? gap / (gap - gap0) : 1;
  double ds[2] = {part * (u[1] - u0[1]), part * (u[2] - u0[2])}, limit = law->mu * n;
  double K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  double f[2]    = {f0[0] + K[0][0] * ds[0] + K[0][1] * ds[1],
                    f0[1] + K[1][0] * ds[0] + K[1][1] * ds[1]};
  if (limit <= 0) {
    f[0] = f[1] = 0;
  } else if (hypot(f[0], f[1]) > limit) {
    double e[2];
    mhb_slip_return((const double(*)[2])K, limit, f, e);
    for (int k = 0; k < 2; k++) f[k] = limit * e[k];
  }
  p[0] = n - law->mean_offset;
  p[1] = f[0];
  p[2] = f[1];
}

static double drive(const disturbed *d, int blade, int mode, double phase) {
  const modal_model *model = d->model;
  double sum = 0, angle = SHB_TWO_PI * (phase - lag(d, blade)) * d->settings->subharmonics;
  for (int k = 0; k <= model->n_load; k++)
    sum += creal(model->modal_force[k * model->n_modes + mode] * cexp(I * k * angle));
  return d->settings->scale * sum;
}

/* Advances q and v by h under a constant force. */
static void oscillate(double w, double zeta, double h, double force, double *q, double *v) {
  double a = zeta * w, wd = w * sqrt(1 - zeta * zeta), rest = force / (w * w), y = *q - rest;
  double c = cos(wd * h), s = sin(wd * h) / wd, decay = exp(-a * h), v0 = *v;
  *q = rest + decay * (y * (c + a * s) + v0 * s);
  *v = decay * (v0 * (c - a * s) - w * w * y * s);
}

/* The force during the step is the mean of its ends, found by iteration. */
void disturbed_step(disturbed *d, double *state, int at) {
  const modal_model *model = d->model;
  int                m = model->n_modes, modal = d->blades * m, n3 = 3 * d->contacts;
  double            *f      = state + 2 * modal, q[modal], v[modal], u0[n3];
  double             period = SHB_TWO_PI / (d->omega / d->settings->subharmonics);
  double             h = 1. / d->steps, phase = at * h;
  memcpy(u0, d->u, sizeof u0);
  memcpy(d->guess, d->p, sizeof(double) * (size_t)n3);
  for (int round = 0; round < 60; round++) {
    double mean[n3], next[n3], change = 0, size = 1e-300;
    for (int i = 0; i < n3; i++) mean[i] = .5 * (d->p[i] + d->guess[i]);
    for (int k = 0; k < modal; k++) {
      int    b = k / m, i = k % m;
      double force = drive(d, b, i, phase + .5 * h);
      for (int side = 0; side < d->sides; side++)
        for (int dof = 0; dof < 3 * model->n_pairs; dof++)
          force +=
              (side ? model->left : model->right)[dof * m + i] * dof_force(d, mean, b, side, dof);
      q[k] = state[k];
      v[k] = state[modal + k];
      oscillate(SHB_TWO_PI * model->frequency[i], model->damping_ratio[i], h * period, force, &q[k],
                &v[k]);
    }
    relative(d, q, d->guess, d->u);
    for (int j = 0; j < d->contacts; j++)
      contact_law(&d->residual->law[j % model->n_pairs], d->u + 3 * j, u0 + 3 * j, f + 2 * j,
                  next + 3 * j);
    for (int i = 0; i < n3; i++) {
      change      = fmax(change, fabs(next[i] - d->guess[i]));
      size        = fmax(size, fabs(next[i]));
      d->guess[i] = next[i];
    }
    if (change < 1e-15 * size) break;
  }
  memcpy(state, q, sizeof q);
  memcpy(state + modal, v, sizeof v);
  for (int j = 0; j < d->contacts; j++)
    for (int k = 0; k < 2; k++) f[2 * j + k] = d->guess[3 * j + 1 + k];
  memcpy(d->p, d->guess, sizeof(double) * (size_t)n3);
}

/* Finds u and p of a state: n by iteration, friction as it is. */
static void settle(disturbed *d, const double *state) {
  const modal_model *model = d->model;
  const double      *f     = state + 2 * d->blades * model->n_modes;
  for (int round = 0; round < 200; round++) {
    relative(d, state, d->p, d->u);
    for (int j = 0; j < d->contacts; j++) {
      const mhb_law *law = &d->residual->law[j % model->n_pairs];
      double         n   = fmax(0, law->n0 + law->kv * d->u[3 * j]);
      d->p[3 * j]        = n - law->mean_offset;
      for (int k = 0; k < 2; k++) d->p[3 * j + 1 + k] = n > 0 ? f[2 * j + k] : 0;
    }
  }
}

void disturbed_period(disturbed *d, double *state) {
  settle(d, state);
  for (int i = 0; i < d->steps; i++) disturbed_step(d, state, i);
}

void disturbed_start(disturbed *d, double *state) {
  const modal_model *model = d->model;
  const mhb_balance *b     = d->residual;
  int                m = model->n_modes, modal = d->blades * m, nb = b->nb, n3 = 3 * model->n_pairs;
  double             base = d->omega / d->settings->subharmonics;
  mhb_contact_evaluator *contact;
  mhb_contact_info       info;
  memset(state, 0, sizeof(double) * (size_t)d->n);
  for (int k = 0; k <= b->m; k++) {
    double complex p[n3];
    mhb_balance_contact_force(b, k, p);
    for (int i = 0; i < m; i++) {
      const double complex *B = b->receptance->B + (size_t)(k * n3 * m);
      double complex        a = b->receptance->F[k * m + i];
      for (int r = 0; r < n3; r++) a -= conj(B[r * m + i]) * p[r];
      a *= b->receptance->lambda[k * m + i];
      for (int blade = 0; blade < d->blades; blade++) {
        double complex shifted = a * cexp(-SHB_TWO_PI * I * k * lag(d, blade));
        state[blade * m + i] += creal(shifted);
        state[modal + blade * m + i] += creal(I * k * base * shifted);
      }
    }
  }
  if (mhb_contact_evaluator_create(b->m, b->m, 1e-10, &contact) != SHB_OK) abort();
  for (int j = 0; j < d->contacts; j++) {
    int                pair   = j % model->n_pairs;
    double             phase  = -lag(d, j / model->n_pairs);
    mhb_contact_sample sample = {.phase = phase - floor(phase)};
    mhb_contact_time_history(contact, &b->law[pair], d->x + (size_t)(3 * pair * nb), 1, &sample,
                             &info);
    for (int k = 0; k < 2; k++) state[2 * modal + 2 * j + k] = sample.f[k];
  }
  mhb_contact_evaluator_destroy(contact);
  memset(d->p, 0, sizeof(double) * 3 * (size_t)d->contacts);
}

static int by_size(const void *a, const void *b) {
  double x = cabs(*(const double complex *)a), y = cabs(*(const double complex *)b);
  return (x < y) - (x > y);
}

void disturbed_multipliers(disturbed *d, double size, double complex *multiplier) {
  int     n      = d->n;
  size_t  square = (size_t)n * (size_t)n;
  double *M = malloc(square * sizeof *M), *y = malloc(3 * (size_t)n * sizeof *y), *up = y + n,
         *down = up + n;
  double *re = malloc(2 * (size_t)n * sizeof *re), *im = re + n;
  disturbed_start(d, y);
  for (int c = 0; c < n; c++) {
    memcpy(up, y, sizeof(double) * (size_t)n);
    memcpy(down, y, sizeof(double) * (size_t)n);
    up[c] += size;
    down[c] -= size;
    disturbed_period(d, up);
    disturbed_period(d, down);
    for (int r = 0; r < n; r++)
      M[(size_t)c * (size_t)n + (size_t)r] = (up[r] - down[r]) / (2 * size);
  }
  if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, M, n, re, im, NULL, 1, NULL, 1) != 0) abort();
  for (int i = 0; i < n; i++) multiplier[i] = CMPLX(re[i], im[i]);
  qsort(multiplier, (size_t)n, sizeof *multiplier, by_size);
  free(M);
  free(y);
  free(re);
}
