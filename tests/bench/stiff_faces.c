#include "stiff_faces.h"

#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "contact_faces.h"
#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/first_solution.h"
#include "mhb/response/response.h"
#include "tests/support/main_curve.h"

enum { STIFFNESSES = 2, MOST_POINTS = 20000 };
static const double STIFFNESS[STIFFNESSES] = {100, 300};

typedef struct {
  const char *file;
  double      stiffness;
} stiff_case;

typedef struct {
  int    pairs, points, moving, kinks, folds, complete;
  double seconds, first; /* processor s: the curve; the solution it begins with */
  double error;          /* worst of Newton's residual, relative to the motion */
  double peak, at;       /* m, Hz: of the output */
} stiff_row;

static mhb_settings stiff_settings(double stiffness) {
  mhb_settings s = contact_faces_settings();
  s.kv *= stiffness;
  for (int i = 0; i < 3; i++) s.ku[i] *= stiffness;
  s.n0[0]        = 10;
  s.frequency[0] = 600;
  s.frequency[1] = 1200;
  s.max_points   = MOST_POINTS;
  return s;
}

/* States that a pair passes in a period: a bit each. */
static int states_of(const mhb_branch *b, int n_pairs, int point, int pair) {
  const double *share = b->state + ((size_t)point * (size_t)n_pairs + (size_t)pair) * 3;
  return (share[0] > 0) + 2 * (share[1] > 0) + 4 * (share[2] > 0);
}

static void read_curve(const mhb_response *r, stiff_row *row) {
  const mhb_branch *b = &r->branch[0];
  row->points         = b->n_points;
  row->complete       = b->complete;
  for (int i = 0; i < b->n_points; i++) {
    int moving = 0;
    for (int a = 0; a < r->n_pairs; a++) {
      const int states = states_of(b, r->n_pairs, i, a);
      moving |= states != 1 && states != 4;
      row->kinks += i > 0 && states != states_of(b, r->n_pairs, i - 1, a);
    }
    row->moving += moving;
    row->folds += b->special[i] == MHB_FOLD;
    row->error          = fmax(row->error, b->error_newton[i]);
    const double motion = mhb_response_output(r, b, i);
    if (motion <= row->peak) continue;
    row->peak = motion;
    row->at   = b->frequency[i];
  }
}

/* Processor seconds of the solution at the low end of the range. */
static shb_status time_first(const modal_model *model, const mhb_settings *s, double *seconds) {
  mhb_balance   *b;
  mhb_arclength *path;
  const double   low = SHB_TWO_PI * s->frequency[0], started = shb_processor_seconds();
  int            iterations;
  SHB_TRY(mhb_balance_create(model, s, &b));
  mhb_balance_set_preload(b, s->n0[0]);
  path                    = mhb_balance_curve_create(b, low, SHB_TWO_PI * s->frequency[1]);
  double          *x      = calloc((size_t)b->n, sizeof(double));
  const mhb_reason reason = x ? mhb_first_solution(mhb_balance_curve_of(path)->newton, b, low,
                                                   path->tolerance, x, &iterations)
                              : MHB_SINGULAR;
  free(x);
  mhb_arclength_destroy(path);
  mhb_balance_destroy(b);
  *seconds = shb_processor_seconds() - started;
  SHB_CHECK(reason == MHB_CONVERGED, SHB_NOT_CONVERGED, "no first solution");
  return SHB_OK;
}

static shb_status run(const void *input, void *output) {
  const stiff_case *of       = input;
  stiff_row        *row      = output;
  mhb_settings      s        = stiff_settings(of->stiffness);
  mhb_response     *response = NULL;
  modal_model       model;
  omp_set_num_threads(1); /* processor time of one thread */
  openblas_set_num_threads(1);
  SHB_TRY(modal_model_read(of->file, &model));
  row->pairs        = model.n_pairs;
  shb_status status = time_first(&model, &s, &row->first);
  if (status == SHB_OK) status = main_curve(&model, &s, s.harmonics, &row->seconds, &response);
  if (status == SHB_OK) read_curve(response, row);
  mhb_response_destroy(response);
  modal_model_free(&model);
  return status;
}

shb_status bench_stiff_faces(char **files, int n, int *failed) {
  printf("\n%5s %9s %6s %6s %6s %5s %8s %8s %8s %9s %10s %9s %8s\n", "pairs", "stiffness", "points",
         "moving", "kinks", "folds", "first s", "curve s", "ms/point", "residual", "peak um",
         "at Hz", "complete");
  for (int i = 0; i < n * STIFFNESSES; i++) {
    const stiff_case of  = {files[i / STIFFNESSES], STIFFNESS[i % STIFFNESSES]};
    stiff_row        row = {0};
    double           megabytes;
    SHB_TRY(bench_in_child(of.file, run, &of, &row, sizeof row, &megabytes));
    printf("%5d %9g %6d %6d %6d %5d %8.2f %8.2f %8.2f %9.1e %10.6f %9.3f %8s\n", row.pairs,
           of.stiffness, row.points, row.moving, row.kinks, row.folds, row.first, row.seconds,
           1e3 * (row.seconds - row.first) / (row.points > 0 ? row.points : 1), row.error,
           1e6 * row.peak, row.at, row.complete ? "yes" : "NO");
    fflush(stdout);
    *failed += !row.complete || !(row.error <= 1e-8);
  }
  return SHB_OK;
}
