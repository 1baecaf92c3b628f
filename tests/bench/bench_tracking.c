/* Peaks followed along the preload against frequency sweeps: error and processor seconds.
 *
 *   bench_tracking FILE [LOW HIGH [HARMONICS [FROM TO]]]
 *                              a modal file, contact of cases/z_notch_blade; LOW to HIGH N,
 *                              frequencies FROM to TO Hz, harmonics 0: automatic
 *   bench_tracking             a model of three degrees of freedom
 *   bench_tracking --quick     the same, fewer sweeps
 *
 * The first rows compare recorded peaks at preloads spread over the range with frequency sweeps.
 * Each sweep has the same preload and as many harmonics. The last row is the cost of the
 * whole run, seeds and verification included, against that of three sweeps. The exit code depends
 * on errors only. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"
#include "mhb/tracking/tracked_response.h"
#include "modal/model/model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"
#include "tests/support/z_notch_settings.h"

/* Goal of the errors of amplitude and frequency, relative. */
static const double GOAL = 1e-6;

/* A sweep has a peak that no branch has if it is higher than all by this, relative. Branches are
 * linear between their points. */
static const double LACKING = 5e-3;

enum { PRELOADS = 10, SWEEPS = 3, BY_TRACK = 30 };

static shb_status sweep(const modal_model *model, const mhb_settings *tracking, double n0, int m,
                        double *seconds, mhb_response **r) {
  mhb_settings s = *tracking;
  s.track        = MHB_TRACK_NOTHING;
  s.parameter    = MHB_IN_FREQUENCY;
  s.stability    = MHB_STABILITY_NEVER;
  s.n_preloads   = 1;
  s.n0[0]        = n0;
  if (m > 0) {
    s.harmonics        = m;
    s.motion_tolerance = 0;
  }
  double     started = shb_processor_seconds();
  shb_status status  = mhb_forced_response(model, &s, NULL, NULL, NULL, r);
  *seconds += shb_processor_seconds() - started;
  return status == SHB_NOT_CONVERGED && *r ? SHB_OK : status;
}

/* The marked peak nearest to a frequency. */
static bool nearest_peak(const mhb_response *r, double frequency, double *at, double *amplitude) {
  double near = INFINITY;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) {
      double away = fabs(r->branch[b].frequency[i] - frequency);
      if (r->branch[b].kind != MHB_BRANCH_NONLINEAR || r->branch[b].special[i] != MHB_PEAK ||
          away >= near)
        continue;
      near       = away;
      *at        = r->branch[b].frequency[i];
      *amplitude = mhb_response_output(r, &r->branch[b], i);
    }
  return isfinite(near);
}

/* The recorded point of a branch nearest to a preload on a logarithmic scale; -1: the preload is
 * beyond its ends. */
static int point_near(const mhb_branch *b, double n0) {
  int    best = -1;
  double near = INFINITY;
  if (b->n_points == 0 || n0 < b->n0[0] || n0 > b->n0[b->n_points - 1]) return -1;
  for (int i = 0; i < b->n_points; i++)
    if (fabs(log(b->n0[i] / n0)) < near) {
      near = fabs(log(b->n0[i] / n0));
      best = i;
    }
  return best;
}

/* Amplitude of a branch at a preload, linear between its points; 0 beyond its ends. */
static double at_preload(const mhb_response *t, const mhb_branch *b, double n0) {
  for (int i = 0; i + 1 < b->n_points; i++) {
    double from = b->n0[i], to = b->n0[i + 1], low = mhb_response_output(t, b, i);
    if (n0 < from || n0 > to || !(to > from)) continue;
    return low + (n0 - from) / (to - from) * (mhb_response_output(t, b, i + 1) - low);
  }
  return 0;
}

/* The highest of all branches at a preload. */
static double highest_branch(const mhb_response *t, double n0) {
  double most = 0;
  for (int k = 0; k < t->n_branches; k++) most = fmax(most, at_preload(t, &t->branch[k], n0));
  return most;
}

/* The highest point of a sweep. */
static double highest_point(const mhb_response *r) {
  double most = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points && r->branch[b].kind == MHB_BRANCH_NONLINEAR; i++)
      most = fmax(most, mhb_response_output(r, &r->branch[b], i));
  return most;
}

static shb_status compare(const modal_model *model, const mhb_settings *s, const mhb_response *t,
                          int preloads, int *fault) {
  double ratio = s->range[1] / s->range[0], seconds = 0;
  printf("%3s %12s %12s %12s %10s %10s %10s\n", "m", "n0, N", "Hz", "amplitude", "error", "of Hz",
         "sweep, s");
  for (int p = 0; p < preloads; p++) {
    double n0 = s->range[0] * pow(ratio, (p + 0.5) / preloads);
    for (int b = 0; b < t->n_branches; b++) {
      const mhb_branch *branch = &t->branch[b];
      mhb_response     *r      = NULL;
      int               i      = point_near(branch, n0);
      double            f = 0, a = 0, here = i < 0 ? 0 : mhb_response_output(t, branch, i);
      if (i < 0) continue;
      double spent = seconds;
      SHB_TRY(sweep(model, s, branch->n0[i], branch->n_harmonics, &seconds, &r));
      bool   found = nearest_peak(r, branch->frequency[i], &f, &a);
      double of_a = found ? fabs(here / a - 1) : NAN, of_f = fabs(f / branch->frequency[i] - 1);
      bool   good  = of_a <= GOAL && of_f <= GOAL;
      bool   lacks = highest_point(r) > highest_branch(t, branch->n0[i]) * (1 + LACKING);
      printf("%3d %12.6f %12.6f %12.5e %10.1e %10.1e %10.3f%s%s\n", branch->n_harmonics,
             branch->n0[i], branch->frequency[i], here, of_a, of_f, seconds - spent,
             good ? "" : "  BAD", lacks ? "  the sweep has a higher peak: BAD" : "");
      fflush(stdout);
      *fault += !good + lacks;
      mhb_response_destroy(r);
    }
  }
  return SHB_OK;
}

static int iterations_of(const mhb_response *r) {
  int sum = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) sum += r->branch[b].iterations[i];
  return sum;
}

static int points_of(const mhb_response *r) {
  int sum = 0;
  for (int b = 0; b < r->n_branches; b++) sum += r->branch[b].n_points;
  return sum;
}

/* Cost of three sweeps spread over the range. */
static shb_status three_sweeps(const modal_model *model, const mhb_settings *s, double *seconds) {
  double ratio = s->range[1] / s->range[0];
  *seconds     = 0;
  for (int i = 0; i < SWEEPS; i++) {
    mhb_response *r      = NULL;
    double        before = *seconds, n0 = s->range[0] * pow(ratio, (i + 0.5) / SWEEPS);
    SHB_TRY(sweep(model, s, n0, 0, seconds, &r));
    printf("sweep at %.6g N: %d points, %d iterations, %.3f s\n", n0, points_of(r),
           iterations_of(r), *seconds - before);
    mhb_response_destroy(r);
  }
  return SHB_OK;
}

/* The least and the largest share that a branch has of the highest peak at its points. */
static void shares(const mhb_response *t, const mhb_branch *b, double share[2]) {
  share[0] = INFINITY;
  share[1] = 0;
  for (int i = 0; i < b->n_points; i++) {
    double here = mhb_response_output(t, b, i) / highest_branch(t, b->n0[i]);
    share[0]    = fmin(share[0], here);
    share[1]    = fmax(share[1], here);
  }
}

static void list(const mhb_response *t) {
  double seconds = 0;
  for (int b = 0; b < t->n_branches; b++) {
    const mhb_branch *k    = &t->branch[b];
    double            here = 0;
    for (int i = 0; i < k->n_points; i++) here += k->seconds[i];
    double share[2];
    shares(t, k, share);
    seconds += here;
    printf("branch %d: m %d, %d points, %.6g to %.6g N, %.2f to %.2f of the highest, %.3f s (%s)\n",
           b, k->n_harmonics, k->n_points, k->n0[0], k->n0[k->n_points - 1], share[0], share[1],
           here, k->reason);
  }
  printf("following: %d points, %d iterations, %.3f s\n", points_of(t), iterations_of(t), seconds);
}

static shb_status run(const modal_model *model, const mhb_settings *s, int preloads, int *fault) {
  mhb_response *t        = NULL;
  shb_progress  quiet    = shb_progress_start("bench", true, false);
  double        started  = shb_processor_seconds(), sweeps;
  shb_status    status   = mhb_tracked_response(model, s, NULL, NULL, &quiet, &t);
  double        tracking = shb_processor_seconds() - started;
  if (status == SHB_NOT_CONVERGED && t) printf("%s\n", shb_message());
  if (status != SHB_OK && !t) return status;
  list(t);
  printf("optimum: kind %d, n0 %.9g N (error %.1e), %.7e m at %.6f Hz, verified %d\n",
         (int)t->optimum.kind, t->optimum.value, t->optimum.error, t->optimum.amplitude,
         t->optimum.frequency[0], t->optimum.verified);
  status = compare(model, s, t, preloads, fault);
  if (status == SHB_OK) status = three_sweeps(model, s, &sweeps);
  if (status == SHB_OK) {
    const mhb_tracking_cost *c = &t->cost;
    printf("\ncost in sweeps: seeds %.2f, further outlines %.2f (%d outlines), curves %.2f\n",
           c->seeds / sweeps * SWEEPS, c->further / sweeps * SWEEPS, c->sweeps,
           (tracking - c->seeds - c->further) / sweeps * SWEEPS);
    printf("tracking %.3f s, three sweeps %.3f s: ratio %.2f\n", tracking, sweeps,
           tracking / sweeps);
  }
  mhb_response_destroy(t);
  return status;
}

static mhb_settings three_degrees(modal_model *model) {
  mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.2, 5);
  three_degree_model(model);
  s.frequency[0] = 0.9 / SHB_TWO_PI;
  s.frequency[1] = 1.8 / SHB_TWO_PI;
  s.tolerance    = 1e-8;
  s.range[0]     = 0.05;
  s.range[1]     = 1.2;
  return s;
}

int main(int argc, char **argv) {
  int          quick = argc > 1 && !strcmp(argv[1], "--quick"), file = argc > 1 && !quick;
  int          fault = 0;
  modal_model  model;
  mhb_settings s      = file ? z_notch_settings() : three_degrees(&model);
  shb_status   status = file ? modal_model_read(argv[1], &model) : SHB_OK;
  omp_set_num_threads(1);
  if (file) {
    s.range[0] = argc > 3 ? atof(argv[2]) : 10;
    s.range[1] = argc > 3 ? atof(argv[3]) : 500;
  }
  if (argc > 4) s.harmonics = atoi(argv[4]);
  if (argc > 4 && s.harmonics > 0) s.motion_tolerance = 0;
  if (argc > 6) {
    s.frequency[0] = atof(argv[5]);
    s.frequency[1] = atof(argv[6]);
  }
  s.parameter  = MHB_IN_N0;
  s.track      = MHB_TRACK_PEAKS;
  s.stability  = MHB_STABILITY_NEVER;
  s.n_preloads = 1;
  s.n0[0]      = s.range[0];
  if (status == SHB_OK) status = run(&model, &s, quick ? 2 : PRELOADS, &fault);
  if (status != SHB_OK) {
    fprintf(stderr, "bench_tracking: %s\n", shb_message());
    return 1;
  }
  modal_model_free(&model);
  return fault > 0;
}
