/* Cost of a curve of a mistuned ring by the number of its blades.
 *
 *   bench_mistuning FILE [N]  a modal file: contact and excitation of cases/z_notch_blade
 *   bench_mistuning           a blade of 20 random modes
 *   bench_mistuning --quick   the same, small rings, one preload
 *
 * Every row is five curves of a ring of N blades with 7 harmonics, at preloads of 0.8 to 1.2.
 * Deviations are 1 %. Engine order N/8 keeps the inter-blade phase. The columns:
 *   points, ms of processor time a point, those of the cheapest and the dearest curve
 *   the same a blade, and over that of the first row; points a minute and core
 *   factors a point and ms a factor: of the ring, and of that with twice the harmonics
 *   tangents a point and ms of each, with its factor
 *   the wave's time; the residual; three errors; MiB of a curve; curves not traced to the end
 * The first error is the distance of the curve of the ring without deviations from points of the
 * travelling wave, relative. The second is the residual of the ring there. Where slip begins a
 * contact magnifies rounding: the third is what rounding of the motion alone moves the wave's own
 * residual by. One thread computes, since waiting threads count as processor time.
 * Baseline: the wave. Goals: 20 ms a point at 40 blades; a cost linear in N; 500 points a minute
 * and core; first error below 1e-10. The exit code depends on that error, and on curves that do not
 * end. */
#include <cblas.h>
#include <malloc.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "mesh/base/constants.h"
#include "mhb/balance/ring_system.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/corrector.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/numerics/random.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"
#include "tests/support/z_notch_settings.h"

static const double GOAL = 1e-10;
enum { HARMONICS = 7 };

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
  mhb_settings s = random_settings(HARMONICS);
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
  s.max_points       = 20000;
  s.frequency[0]     = 180;
  s.frequency[1]     = 260;
  s.harmonics        = HARMONICS;
  s.tolerance        = 1e-8;
  s.motion_tolerance = 0;
  s.stability        = MHB_STABILITY_NEVER;
  return s;
}

/* The motion own[] of one blade, spread to all blades: x[ring->n]. */
static void spread(const mhb_settings *s, const double *own, const mhb_balance *ring, int blades,
                   double *x) {
  const int rows = 3 * ring->n_pairs / blades, nb = ring->nb;
  for (int blade = 0; blade < blades; blade++)
    for (int row = 0; row < rows; row++, x += nb) {
      const double *u = own + row * nb;
      x[0]            = u[0];
      for (int k = 1; k <= ring->m; k++) {
        const double         phase = SHB_TWO_PI * s->engine_order / blades * blade * k;
        const double complex lag   = CMPLX(u[2 * k - 1], u[2 * k]) * cexp(-I * phase);
        x[2 * k - 1]               = creal(lag);
        x[2 * k]                   = cimag(lag);
      }
    }
}

/* own[] <- the wave at its point p, by Newton's method to round-off where that stays near. Returns
 * its residual, relative. */
static double polished(mhb_newton *newton, mhb_balance *wave, const mhb_branch *branch, int p,
                       double *own) {
  static const double NEAR = 1e-7, ROUND_OFF = 1e-13;
  const double        omega = SHB_TWO_PI * branch->frequency[p];
  double              better[wave->n], away = 0;
  int                 iterations;
  mhb_recorded_motion(branch, p, wave, own);
  memcpy(better, own, sizeof better);
  mhb_newton_solve(newton, wave, omega, ROUND_OFF, better, &iterations);
  mhb_balance_linearise(wave, better, omega, newton->r, NULL);
  const double residual = mhb_norm(newton->r, wave->n) / mhb_norm(better, wave->n);
  for (int i = 0; i < wave->n; i++) away = fmax(away, fabs(better[i] - own[i]));
  if (!(away < NEAR * mhb_norm(own, wave->n)) || !(residual < branch->error_newton[p]))
    return branch->error_newton[p];
  memcpy(own, better, sizeof better);
  return residual;
}

/* How far the ring without deviations is from the wave, relative. At a point of the wave: the
 * ring's residual, and the distance of its curve. */
typedef struct {
  double residual, curve;
} distance;

/* Newton's step in the plane across the chord from x to next, in y = [x/|x|, omega/omega]. work:
 * [3 n + 3]. INFINITY: singular. */
static double distance_of_curve(mhb_ring_system *system, const double *x, const double *next,
                                const double omega[2], const double *r, const double *slope,
                                double *work) {
  const int    n    = system->balance->n;
  const double size = mhb_norm(x, n), change = omega[1] / omega[0] - 1;
  double      *column = work, *row = column + n + 1, *step = row + n + 1, length = change * change;
  for (int i = 0; i < n; i++) length += pow((next[i] - x[i]) / size, 2);
  length = sqrt(length);
  for (int i = 0; i < n; i++) {
    row[i]    = (next[i] - x[i]) / size / length;
    column[i] = slope[i] * omega[0] / size;
    step[i]   = -r[i] / size;
  }
  row[n] = column[n] = change / length;
  step[n]            = 0;
  if (!mhb_ring_system_factor(system, column, row) || !mhb_ring_system_solve(system, step))
    return INFINITY;
  return mhb_norm(step, n + 1);
}

/* At most, at every fifth point of the wave, spread to all blades. What the wave itself leaves of
 * its residual is taken off. */
static distance distance_from_wave(const modal_model *blade, const mhb_response *response,
                                   const mhb_settings *s, const mhb_mistuned_ring *ring) {
  const mhb_branch *branch = &response->branch[0];
  mhb_settings      tuned  = *s;
  mhb_balance      *b = NULL, *wave = NULL;
  mhb_ring_system  *system = NULL;
  mhb_newton       *newton = NULL;
  distance          worst  = {0, 0};
  tuned.ring               = NULL;
  if (mhb_balance_create(&ring->whole, s, &b) == SHB_OK &&
      mhb_balance_create(blade, &tuned, &wave) == SHB_OK) {
    system = mhb_ring_system_create(b);
    newton = mhb_newton_create(wave->n);
    mhb_balance_set_preload(b, s->n0[0]);
    mhb_balance_set_preload(wave, s->n0[0]);
    double *x = calloc(7 * (size_t)b->n + 3, sizeof *x), *next = x + b->n, *r = next + b->n,
           *slope = r + b->n, *work = slope + b->n, own[wave->n];
    for (int p = 0; p + 1 < branch->n_points; p += 5) {
      const double omega[] = {SHB_TWO_PI * branch->frequency[p],
                              SHB_TWO_PI * branch->frequency[p + 1]};
      mhb_recorded_motion(branch, p + 1, wave, own);
      spread(s, own, b, ring->blades, next);
      const double left = polished(newton, wave, branch, p, own);
      spread(s, own, b, ring->blades, x);
      mhb_balance_linearise(b, x, omega[0], r, slope); /* as points are */
      const double away = mhb_norm(r, b->n) / mhb_norm(x, b->n);
      worst.residual    = fmax(worst.residual, away - left);
      worst.curve = fmax(worst.curve, distance_of_curve(system, x, next, omega, r, slope, work));
    }
    free(x);
  } else {
    worst = (distance){INFINITY, INFINITY};
  }
  mhb_newton_destroy(newton);
  mhb_ring_system_destroy(system);
  mhb_balance_destroy(wave);
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
  if (mhb_truncation_create(b, &t) == SHB_OK) {
    curve = mhb_balance_curve_create(b, s->frequency[0], s->frequency[1]);
    taken = allocated() - before;
    mhb_arclength_destroy(curve);
  }
  mhb_truncation_destroy(t);
  mhb_balance_destroy(b);
  return taken;
}

/* ---- what a ring's time goes into ---- */

/* Calls and processor time of a function. The linker leads its calls to __wrap_NAME, which counts
 * and goes on to __real_NAME (tests.cmake). */
typedef struct {
  int    calls;
  double ms;
} counter;

/* Factors of the balance and of that with twice the harmonics; tangents, each with its factor. */
static struct { counter factor, doubled, tangent; } of_curves;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int count(counter *c, double started, int result) {
  c->calls++;
  c->ms += now() - started;
  return result;
}

int __real_mhb_ring_system_factor(mhb_ring_system *s, const double *column, const double *row);
int __wrap_mhb_ring_system_factor(mhb_ring_system *s, const double *column, const double *row);
int __real_mhb_arclength_set_tangent(mhb_arclength *c, const double *along, mhb_curve_point *p);
int __wrap_mhb_arclength_set_tangent(mhb_arclength *c, const double *along, mhb_curve_point *p);

int __wrap_mhb_ring_system_factor(mhb_ring_system *s, const double *column, const double *row) {
  const double started = now();
  counter     *c       = s->balance->m > HARMONICS ? &of_curves.doubled : &of_curves.factor;
  return count(c, started, __real_mhb_ring_system_factor(s, column, row));
}

int __wrap_mhb_arclength_set_tangent(mhb_arclength *c, const double *along, mhb_curve_point *p) {
  const double started = now();
  const int    done    = __real_mhb_arclength_set_tangent(c, along, p);
  return c->system->costly ? count(&of_curves.tangent, started, done) : done; /* of a ring */
}

/* ---- rows ---- */

/* Preloads of a row, relative to that of the settings. Steps at the onset of slip change by
 * rounding, so one curve tells a time to a third only. */
static const double PRELOAD[] = {0.8, 0.9, 1, 1.1, 1.2};
enum { PRELOADS = sizeof PRELOAD / sizeof *PRELOAD };

/* Sums over the preloads of a row; the errors are the largest. */
typedef struct {
  int    points, of_wave;
  double ms, ms_of_wave; /* of processor time */
  double least, most;    /* ms a point of a preload */
  double residual, away, apart, rounding, memory;
  int    unfinished; /* curves */
} sums;

/* One preload of a ring and its wave. */
static shb_status add_curves(const modal_model *blade, mhb_settings s, sums *all) {
  double             deviation[s.blades], zero[s.blades], seconds, of_wave;
  mhb_mistuned_ring *ring;
  mhb_response      *curve, *wave;
  memset(zero, 0, sizeof zero);
  SHB_TRY(mhb_deviations_random(0.01, 7, 0, s.blades, deviation));
  SHB_TRY(main_curve(blade, &s, s.harmonics, &of_wave, &wave));
  SHB_TRY(mhb_mistuned_ring_create(blade, &s, deviation, 1, &ring));
  s.ring = ring;
  SHB_TRY(main_curve(&ring->whole, &s, s.harmonics, &seconds, &curve));
  const mhb_branch *branch = &curve->branch[0];
  const double      ms     = 1e3 * seconds / branch->n_points;
  all->least               = all->points ? fmin(all->least, ms) : ms;
  all->most                = fmax(all->most, ms);
  all->points += branch->n_points;
  all->ms += 1e3 * seconds;
  all->of_wave += wave->branch[0].n_points;
  all->ms_of_wave += 1e3 * of_wave;
  all->unfinished += branch->reason && strcmp(branch->reason, "end of range") != 0;
  for (int p = 0; p < branch->n_points; p++)
    all->residual = fmax(all->residual, branch->error_newton[p]);
  mhb_mistuned_ring_destroy(ring);
  s.ring = NULL;
  SHB_TRY(mhb_mistuned_ring_create(blade, &s, zero, 1, &ring));
  s.ring             = ring;
  const distance off = distance_from_wave(blade, wave, &s, ring);
  all->away          = fmax(all->away, off.residual);
  all->apart         = fmax(all->apart, off.curve);
  all->rounding      = fmax(all->rounding, wave_by_rounding(blade, wave, &s));
  all->memory        = memory_of(ring, &s);
  mhb_mistuned_ring_destroy(ring);
  mhb_response_destroy(curve);
  mhb_response_destroy(wave);
  return SHB_OK;
}

static void print_row(int N, const sums *a, double *first) {
  const double  ms = a->ms / a->points;
  const counter f = of_curves.factor, d = of_curves.doubled, t = of_curves.tangent;
  if (*first <= 0) *first = ms / N;
  printf("%5d %7d %9.2f %5.1f-%-5.1f %7.3f %8.2f %8.0f %7.2f %6.2f %7.2f %6.2f %7.2f %6.2f %8.3f",
         N, a->points, ms, a->least, a->most, ms / N, ms / N / *first, 6e4 / ms,
         (double)f.calls / a->points, f.ms / f.calls, (double)d.calls / a->points,
         d.calls ? d.ms / d.calls : 0, (double)t.calls / a->points, t.ms / t.calls,
         a->ms_of_wave / a->of_wave);
  printf(" %9.1e %9.1e %9.1e %11.1e %6.1f  %d\n", a->residual, a->apart, a->away, a->rounding,
         a->memory, a->unfinished);
}

static shb_status row(const modal_model *blade, const mhb_settings *asked, int N, bool quick,
                      double *first, bool *good) {
  mhb_settings s   = *asked;
  sums         all = {0};
  s.blades         = N;
  s.engine_order   = N / 8 > 0 ? N / 8 : 1;
  memset(&of_curves, 0, sizeof of_curves);
  for (int i = 0; i < PRELOADS; i++) {
    s.n0[0] = asked->n0[0] * PRELOAD[i];
    if (quick && PRELOAD[i] != 1) continue;
    SHB_TRY(add_curves(blade, s, &all));
  }
  print_row(N, &all, first);
  *good = *good && all.apart < GOAL && all.unfinished == 0;
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
      "    N  points  ms/point  least-most /blade to first a minute factors     ms doubled     ms "
      "tangent     ms  wave ms  residual from wave  at point by rounding    MiB  unfinished");
  for (int i = 0; i < n; i++)
    if (row(&blade, &s, blades[i], quick, &first, &good) != SHB_OK) {
      fprintf(stderr, "%s\n", shb_message());
      good = false;
    }
  modal_model_free(&blade);
  return !good;
}
