/* The balance of a disc with Coriolis terms against a time integration of all its sectors.
 *
 * The integration knows no mode, no nodal diameter and none of the program's contact code. Central
 * differences move the masses of eight sectors from rest. The friction is a return mapping: with
 * the slider's force f and e = f/|f|, f = f_trial - lambda Ku e on the limit. Its error is of first
 * order in the step. */
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/lu.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/periodic.h"

enum { N = DISC_SECTORS, D = DISC_DOFS, ALL = DISC_ALL, ORDER = 3, HARMONICS = 31, PERIODS = 60 };

static const double omega = 0.93;

typedef struct {
  lumped_disc  disc;
  mhb_settings settings;
  double       T0[3][3];    /* columns v, u, w */
  double       K[ALL][ALL]; /* N/m */
  double       A[ALL * ALL], h;
  int          pivot[ALL];
  double       x[ALL], before[ALL], slider[N][2], u[N][3];
} ring;

static void assemble(ring *r, double h) {
  const lumped_disc *d = &r->disc;
  memset(r->K, 0, sizeof r->K);
  for (int b = 0; b < N; b++)
    for (int i = 0; i < D; i++)
      for (int j = 0; j < D; j++) {
        const int here = b * D, next = (b + 1) % N * D;
        r->K[here + i][here + j] += d->own[i][j];
        r->K[here + i][next + j] += d->next[i][j];
        r->K[next + j][here + i] += d->next[i][j];
      }
  r->h = h;
  for (int i = 0; i < ALL; i++)
    for (int j = 0; j < ALL; j++) {
      double value = 0.5 * h * d->damping * r->K[i][j] + (i == j ? d->mass[i % D] : 0);
      if (i / D == j / D) value += 0.5 * h * lumped_disc_coriolis(d, i % D, j % D);
      r->A[i * ALL + j] = value;
    }
  assert_true(mhb_factor_real(ALL, r->A, r->pivot));
}

/* f <- (1 + g Ku)^-1 f */
static void relax(const double ku[3], double g, const double f[2], double out[2]) {
  const double a = 1 + g * ku[0], b = g * ku[1], c = 1 + g * ku[2], det = a * c - b * b;
  out[0] = (c * f[0] - b * f[1]) / det;
  out[1] = (a * f[1] - b * f[0]) / det;
}

/* Force of a contact at the motion u; its slider follows. */
static void contact_force(const mhb_settings *s, const double u[3], double slider[2], double p[3]) {
  const double n = fmax(s->n0[0] + s->kv * u[0], 0), limit = s->mu * n;
  const double stick[2] = {s->ku[0] * u[1] + s->ku[1] * u[2], s->ku[1] * u[1] + s->ku[2] * u[2]};
  const double trial[2] = {stick[0] - slider[0], stick[1] - slider[1]};
  double       f[2]     = {trial[0], trial[1]};
  if (limit <= 0) {
    f[0] = f[1] = 0;
  } else if (hypot(f[0], f[1]) > limit) {
    double low = 0, high = 1;
    for (relax(s->ku, high, trial, f); hypot(f[0], f[1]) > limit; relax(s->ku, high, trial, f))
      high *= 2;
    for (int i = 0; i < 50; i++) {
      const double middle = 0.5 * (low + high);
      relax(s->ku, middle, trial, f);
      *(hypot(f[0], f[1]) > limit ? &low : &high) = middle;
    }
  }
  for (int i = 0; i < 2; i++) slider[i] = stick[i] - f[i];
  p[0] = n - fmax(s->n0[0], 0);
  p[1] = f[0];
  p[2] = f[1];
}

/* Forces of load and contacts at time t. */
static void set_forces(ring *r, double t, double f[ALL]) {
  for (int b = 0; b < N; b++)
    for (int i = 0; i < D; i++) {
      f[b * D + i] = 0;
      for (int k = 0; k < DISC_LOADS; k++)
        f[b * D + i] +=
            r->settings.scale *
            creal(r->disc.load[k][i] * cexp(I * k * (omega * t - SHB_TWO_PI * ORDER * b / N)));
    }
  for (int b = 0; b < N; b++) {
    const int right = b * D + DISC_RIGHT, left = (b + 1) % N * D + DISC_LEFT;
    double    p[3];
    for (int c = 0; c < 3; c++) {
      r->u[b][c] = 0;
      for (int a = 0; a < 3; a++) r->u[b][c] += r->T0[a][c] * (r->x[right + a] - r->x[left + a]);
    }
    contact_force(&r->settings, r->u[b], r->slider[b], p);
    for (int a = 0; a < 3; a++)
      for (int c = 0; c < 3; c++) {
        f[right + a] -= r->T0[a][c] * p[c];
        f[left + a] += r->T0[a][c] * p[c];
      }
  }
}

/* x(t + h) by central differences. */
static void step(ring *r, double t) {
  const lumped_disc *d = &r->disc;
  double             next[ALL];
  set_forces(r, t, next);
  for (int i = 0; i < ALL; i++) {
    double elastic = 0, loss = 0;
    for (int j = 0; j < ALL; j++) {
      elastic += r->K[i][j] * r->x[j];
      loss += d->damping * r->K[i][j] * r->before[j];
    }
    for (int j = i - i % D; j < i - i % D + D; j++)
      loss += lumped_disc_coriolis(d, i % D, j % D) * r->before[j];
    next[i] = r->h * r->h * (next[i] - elastic) + 0.5 * r->h * loss +
              d->mass[i % D] * (2 * r->x[i] - r->before[i]);
  }
  mhb_solve_real(ALL, r->A, r->pivot, next);
  memcpy(r->before, r->x, sizeof r->x);
  memcpy(r->x, next, sizeof r->x);
}

/* Motion of contact b of the balance at time t, without its mean. */
static void balance_motion(const double *x, int b, double t, double u[3]) {
  const int nb = 2 * HARMONICS + 1;
  for (int c = 0; c < 3; c++) {
    u[c] = 0;
    for (int k = 1; k <= HARMONICS; k++)
      u[c] += creal(CMPLX(x[c * nb + 2 * k - 1], x[c * nb + 2 * k]) *
                    cexp(I * k * (omega * t - SHB_TWO_PI * ORDER * b / N)));
  }
}

/* Distance of the last period from the balance, relative to its vibration. */
static double distance(ring *r, const double *x, int steps) {
  const double period     = SHB_TWO_PI / omega;
  double       mean[N][3] = {{0}}, away = 0, size = 0;
  double(*u)[N][3] = calloc((size_t)steps, sizeof *u);
  assert_non_null(u);
  memset(r->x, 0, sizeof r->x);
  memset(r->before, 0, sizeof r->before);
  memset(r->slider, 0, sizeof r->slider);
  assemble(r, period / steps);
  for (int i = 0; i < PERIODS * steps; i++) {
    step(r, i * r->h); /* r->u is the motion at i h */
    if (i >= (PERIODS - 1) * steps) memcpy(u[i % steps], r->u, sizeof *u);
  }
  for (int i = 0; i < steps; i++)
    for (int b = 0; b < N; b++)
      for (int c = 0; c < 3; c++) mean[b][c] += u[i][b][c] / steps;
  for (int i = 0; i < steps; i++)
    for (int b = 0; b < N; b++) {
      double wanted[3];
      balance_motion(x, b, i * r->h, wanted);
      for (int c = 0; c < 3; c++) {
        away += pow(u[i][b][c] - mean[b][c] - wanted[c], 2);
        size += wanted[c] * wanted[c];
      }
    }
  free(u);
  return sqrt(away / size);
}

/* The balance at a spin; x[3][2 HARMONICS + 1] <- its motion. share: stuck, slipping, open. */
static void solve_balance(ring *r, double spin, double *x, double share[3]) {
  modal_nodal_diameters waves;
  periodic              p;
  r->disc         = lumped_disc_of(0.8, 1.7);
  r->disc.damping = 0.1;
  r->disc.spin    = spin;
  lumped_disc_waves(&r->disc, D, &waves);
  r->settings                 = lumped_disc_settings(ORDER, HARMONICS);
  r->settings.n_preloads      = 1;
  r->settings.n0[0]           = 0.4;
  r->settings.scale           = 12;
  r->settings.nodal_diameters = &waves;
  periodic_create(&waves.model[0], &r->settings, omega, NULL, &p);
  memcpy(x, p.x, sizeof *x * 3 * (2 * HARMONICS + 1));
  memcpy(share, p.residual->eval->info[0].share, 3 * sizeof *share);
  memcpy(r->T0, p.residual->receptance->T0, sizeof r->T0);
  periodic_destroy(&p);
  modal_nodal_diameters_free(&waves);
}

static void the_ring_from_rest_ends_on_the_balance(void **state) {
  static ring r;
  double      with[3 * (2 * HARMONICS + 1)], without[3 * (2 * HARMONICS + 1)], share[3], off[2];
  (void)state;
  solve_balance(&r, 0, without, share);
  solve_balance(&r, 0.1, with, share);
  for (int i = 0; i < 2; i++) off[i] = distance(&r, with, 400 << i);
  const double other = distance(&r, without, 400);
  print_message(
      "slipping %.2f, open %.2f of the period; off by %.1e with 400 steps, %.1e with 800; "
      "balance without Coriolis terms %.1e\n",
      share[1], share[2], off[0], off[1], other);
  assert_true(share[1] > 0.2);
  assert_below(off[1], 5e-4);
  assert_true(off[0] / off[1] > 1.8);
  assert_true(other > 50 * off[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_ring_from_rest_ends_on_the_balance)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
