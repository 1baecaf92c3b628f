/* Cost of a curve of a mistuned ring by the number of its blades.
 *
 *   bench_mistuning FILE      a modal file: contact and excitation of cases/z_notch_blade
 *   bench_mistuning           a blade of 20 random modes
 *   bench_mistuning --quick   the same, small rings
 *
 * Every row is one curve of a ring of N blades with 7 harmonics at one preload. Deviations are 1 %.
 * Engine order N/8 keeps the inter-blade phase. The columns: points; ms of processor time a point;
 * the same a blade, and over that of the first row. Then points a minute and core; the wave's time.
 * Then come the residual, two errors and the memory of a curve, MiB. The first error is the
 * distance of the ring without deviations from the travelling wave, relative. The second is what
 * rounding of the motion alone moves the wave's own residual by. One thread computes, since waiting
 * threads count as processor time.
 * Baseline: the wave. Goals: 20 ms a point at 40 blades; a cost linear in N; 500 points a minute
 * and core; error below 1e-10. The exit code depends on the error alone. */
#include <cblas.h>
#include <malloc.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/numerics/random.h"
#include "tests/bench/z_notch_settings.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"

static const double GOAL = 1e-10;

/* 20 modes in place of the random model's six. */
static void random_blade(modal_model *model) {
  enum { MODES = 20 };
  unsigned long long seed = 8;
  random_model(1, WITH_LEFT, 5, model);
  const size_t sizes[] = {3 * MODES, 3 * MODES, 3 * MODES * (size_t)model->n_probes};
  double     **part[]  = {&model->right, &model->left, &model->probe};
  for (int i = 0; i < 3; i++) {
    *part[i] = realloc(*part[i], sizes[i] * sizeof(double));
    for (size_t j = 0; j < sizes[i]; j++) (*part[i])[j] = 0.6 * random_unit(&seed);
  }
  model->frequency     = realloc(model->frequency, MODES * sizeof(double));
  model->damping_ratio = realloc(model->damping_ratio, MODES * sizeof(double));
  model->modal_force =
      realloc(model->modal_force, (size_t)(model->n_load + 1) * MODES * sizeof(double complex));
  for (int i = 0; i < MODES; i++) {
    model->frequency[i]     = (0.8 + 0.9 * i) / SHB_TWO_PI;
    model->damping_ratio[i] = 0.005;
    for (int k = 0; k <= model->n_load; k++)
      model->modal_force[k * MODES + i] = k == 1 ? random_unit(&seed) : 0;
  }
  model->n_modes = MODES;
}

static mhb_settings of_random_blade(void) {
  mhb_settings s = random_settings(7);
  s.frequency[0] = 0.6 / SHB_TWO_PI;
  s.frequency[1] = 1.4 / SHB_TWO_PI;
  s.mu           = 0.3;
  s.n0[0]        = 1;
  s.tolerance    = 1e-6;
  s.max_points   = 5000;
  s.stability    = MHB_STABILITY_NEVER;
  return s;
}

static mhb_settings of_file(void) {
  mhb_settings s     = z_notch_settings();
  s.n0[0]            = 100;
  s.n_preloads       = 1;
  s.frequency[0]     = 180;
  s.frequency[1]     = 260;
  s.harmonics        = 7;
  s.tolerance        = 1e-8;
  s.motion_tolerance = 0;
  s.stability        = MHB_STABILITY_NEVER;
  return s;
}

/* Largest residual of the ring without deviations at the points of the wave, spread to all
 * blades. */
static double distance_from_wave(const mhb_response *wave, const mhb_settings *s,
                                 const mhb_mistuned_ring *ring) {
  mhb_balance *b;
  double       worst = 0;
  if (mhb_balance_create(&ring->whole, s, &b) != SHB_OK) return INFINITY;
  mhb_balance_set_preload(b, s->n0[0]);
  const mhb_branch *branch = &wave->branch[0];
  double           *x = calloc(2 * (size_t)b->n, sizeof *x), *r = x + b->n;
  const int         K = branch->n_harmonics + 1, n = 3 * wave->n_pairs;
  for (int p = 0; p < branch->n_points; p += 5) {
    double away = 0, size = 0;
    for (int row = 0; row < ring->blades * n; row++)
      for (int k = 0; k < K; k++) {
        const int            blade = row / n;
        const double         phase = SHB_TWO_PI * s->engine_order / ring->blades * blade * k;
        const double complex u =
            branch->motion[((size_t)p * (size_t)n + (size_t)(row % n)) * (size_t)K + (size_t)k] *
            cexp(-I * phase);
        x[row * b->nb + (k ? 2 * k - 1 : 0)] = creal(u);
        if (k) x[row * b->nb + 2 * k] = cimag(u);
      }
    mhb_balance_linearise(b, x, SHB_TWO_PI * branch->frequency[p], r, NULL); /* as points are */
    for (int i = 0; i < b->n; i++) {
      away += r[i] * r[i];
      size += x[i] * x[i];
    }
    worst = fmax(worst, sqrt(away / size) - branch->error_newton[p]);
  }
  free(x);
  mhb_balance_destroy(b);
  return worst;
}

/* What rounding alone moves the wave's own residual by at its points, relative, at most. The motion
 * is moved by up to two parts in 1e16, at random. That is how well the law determines the state. */
static double wave_by_rounding(const modal_model *blade, const mhb_response *wave,
                               const mhb_settings *settings) {
  enum { TRIALS = 40 };
  mhb_settings s = *settings;
  mhb_balance *b;
  double       worst = 0;
  s.ring             = NULL;
  if (mhb_balance_create(blade, &s, &b) != SHB_OK) return INFINITY;
  mhb_balance_set_preload(b, s.n0[0]);
  const mhb_branch  *branch = &wave->branch[0];
  double            *x = calloc(4 * (size_t)b->n, sizeof *x), *r = x + b->n, *moved = r + b->n;
  unsigned long long seed = 1;
  for (int p = 0; p < branch->n_points; p += 5) {
    const double omega = SHB_TWO_PI * branch->frequency[p];
    mhb_recorded_motion(branch, p, b, x);
    mhb_balance_linearise(b, x, omega, r, NULL);
    for (int t = 0; t < TRIALS; t++) {
      double *after = moved + b->n, away = 0;
      for (int i = 0; i < b->n; i++) moved[i] = x[i] * (1 + 1e-16 * mhb_random(&seed) * 2);
      mhb_balance_linearise(b, moved, omega, after, NULL);
      for (int i = 0; i < b->n; i++) away += pow(after[i] - r[i], 2);
      worst = fmax(worst, sqrt(away) / mhb_norm(x, b->n));
    }
  }
  free(x);
  mhb_balance_destroy(b);
  return worst;
}

static double allocated(void) {
  const struct mallinfo2 m = mallinfo2();
  return (double)(m.uordblks + m.hblkhd) / 1048576;
}

/* MiB of what a curve of the ring needs: its receptance, balance, system, points and estimate. */
static double memory_of(const mhb_mistuned_ring *ring, const mhb_settings *s) {
  const double    before = allocated();
  double          taken  = INFINITY;
  mhb_balance    *b;
  mhb_truncation *t     = NULL;
  mhb_arclength  *curve = NULL;
  if (mhb_balance_create(&ring->whole, s, &b) != SHB_OK) return taken;
  if (mhb_truncation_create(b, &t) == SHB_OK &&
      mhb_balance_curve_create(b, s->frequency[0], s->frequency[1], &curve) == SHB_OK) {
    taken = allocated() - before;
    mhb_arclength_destroy(curve);
  }
  mhb_truncation_destroy(t);
  mhb_balance_destroy(b);
  return taken;
}

static shb_status row(const modal_model *blade, const mhb_settings *asked, int N, double *first,
                      bool *good) {
  mhb_settings       s = *asked;
  double             deviation[N], zero[N], seconds, of_wave, residual = 0;
  mhb_mistuned_ring *ring;
  mhb_response      *curve, *wave;
  s.blades       = N;
  s.engine_order = N / 8 > 0 ? N / 8 : 1;
  memset(zero, 0, sizeof zero);
  SHB_TRY(mhb_deviations_random(0.01, 7, 0, N, deviation));
  SHB_TRY(main_curve(blade, &s, s.harmonics, &of_wave, &wave));
  SHB_TRY(mhb_mistuned_ring_create(blade, &s, deviation, 1, &ring));
  s.ring = ring;
  SHB_TRY(main_curve(&ring->whole, &s, s.harmonics, &seconds, &curve));
  const mhb_branch *branch = &curve->branch[0];
  const int         points = branch->n_points;
  for (int p = 0; p < points; p++) residual = fmax(residual, branch->error_newton[p]);
  mhb_mistuned_ring_destroy(ring);
  s.ring = NULL;
  SHB_TRY(mhb_mistuned_ring_create(blade, &s, zero, 1, &ring));
  s.ring            = ring;
  const double away = distance_from_wave(wave, &s, ring), memory = memory_of(ring, &s);
  const double ms = 1e3 * seconds / points;
  if (*first <= 0) *first = ms / N;
  printf("%5d %7d %9.2f %12.3f %9.2f %9.0f %12.3f %10.1e %10.1e %11.1e %7.1f  %s\n", N, points, ms,
         ms / N, ms / N / *first, 6e4 / ms, 1e3 * of_wave / wave->branch[0].n_points, residual,
         away, wave_by_rounding(blade, wave, &s), memory, branch->reason ? branch->reason : "");
  *good = *good && away < GOAL;
  mhb_mistuned_ring_destroy(ring);
  mhb_response_destroy(curve);
  mhb_response_destroy(wave);
  return SHB_OK;
}

int main(int argc, char **argv) {
  const bool  quick = argc > 1 && strcmp(argv[1], "--quick") == 0, file = argc > 1 && !quick;
  const int   blades[] = {argc > 2 ? atoi(argv[2]) : 10, 20, 40, 80}, n = quick || argc > 2 ? 1 : 4;
  modal_model blade  = {0};
  mhb_settings s     = file ? of_file() : of_random_blade();
  double       first = 0;
  bool         good  = true;
  openblas_set_num_threads(1);
  omp_set_num_threads(1);
  if (file && modal_model_read(argv[1], &blade) != SHB_OK) {
    fprintf(stderr, "%s\n", shb_message());
    return 1;
  }
  if (!file) random_blade(&blade);
  setvbuf(stdout, NULL, _IOLBF, 0);
  puts(
      "    N  points  ms/point  ms/point/N  to first  a minute  wave ms/point  residual  from "
      "wave  by rounding     MiB");
  for (int i = 0; i < n; i++)
    if (row(&blade, &s, blades[i], &first, &good) != SHB_OK) {
      fprintf(stderr, "%s\n", shb_message());
      good = false;
    }
  modal_model_free(&blade);
  return !good;
}
