/* The harmonic balance: seconds against error, and growth of the cost with harmonics and contact
 * pairs.
 *
 *   bench_response                the tables
 *   bench_response --quick        errors only, in a second or so
 *   bench_response --pairs N      the row of N pairs alone
 *   bench_response --harmonics H  the beam's rows of H harmonics alone, against themselves
 *   bench_response --precision    error against seconds alone (precision.h)
 *   bench_response --faces FILE...   contact faces of modal files (contact_faces.h)
 *   bench_response --stiff FILE...   whole curves of these faces with stiff contact (stiff_faces.h)
 *   bench_response --blade FILE N0 FROM TO   the same of a modal file: contact to the neighbour,
 *                                 preload N, range Hz
 *
 * Beam: the tip-contact beam (tests/support/three_degree.h), a row for each force and number of
 * harmonics. A row gives the whole sweep 215-320 Hz, the median of a point, and the error of the
 * located peak against H = 31. The three accuracies of the contact law follow, then the growth with
 * pairs (shroud_face.h). Each row has a process of its own, so its memory can be measured. Goals
 * have verdicts. The exit code depends on errors only, because times depend on the machine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "contact_faces.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/first_solution.h"
#include "precision.h"
#include "stiff_faces.h"
#include "tests/support/main_curve.h"
#include "tests/support/shroud_face.h"
#include "tests/support/three_degree.h"

enum { REPEATS = 3, MAX_POINTS = 4000 };

/* One sweep of the beam. */
typedef struct {
  double seconds, ms,
      evaluations; /* whole branch; median point with its error estimates; Newton steps + 1, mean */
  double solver;   /* ms a step of the path alone, median */
  double linear;   /* the same of steps in the stuck or open range */
  double peak, at; /* m, Hz: highest first harmonic of u */
  int    points, peaks, folds, complete;
} sweep_row;

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(const double *t, int n) {
  static double sorted[MAX_POINTS];
  memcpy(sorted, t, sizeof(double) * (size_t)n);
  qsort(sorted, (size_t)n, sizeof *sorted, ascending);
  return n ? sorted[n / 2] : NAN;
}

static sweep_row read_branch(const mhb_branch *b, int K) {
  sweep_row row = {
      .points = b->n_points, .complete = b->complete, .ms = 1e3 * median(b->seconds, b->n_points)};
  for (int i = 0; i < b->n_points; i++) {
    row.evaluations += (b->iterations[i] + 1.) / b->n_points;
    row.peaks += b->special[i] == MHB_PEAK;
    row.folds += b->special[i] == MHB_FOLD;
    double a = cabs(b->motion[((size_t)i * 3 + 1) * (size_t)K + 1]);
    if (a <= row.peak) continue;
    row.peak = a;
    row.at   = b->frequency[i];
  }
  return row;
}

static mhb_settings beam_settings(int harmonics, double tolerance) {
  mhb_settings s = shroud_face_settings(harmonics);
  s.n0[0]        = 100;
  s.tolerance    = tolerance;
  return s;
}

static shb_status sweep_once(const modal_model *model, const mhb_settings *s, sweep_row *row) {
  mhb_response *response;
  double        seconds = 0;
  shb_status    status  = main_curve(model, s, s->harmonics, &seconds, &response);
  if (status == SHB_OK) *row = read_branch(&response->branch[0], s->harmonics + 1);
  row->seconds = seconds;
  mhb_response_destroy(response);
  return status;
}

static int moves(const mhb_balance *b) {
  int n = 0;
  for (int a = 0; a < b->n_pairs; a++)
    n += b->eval->info[a].share[MHB_STICK] < 1 && b->eval->info[a].share[MHB_SEPARATE] < 1;
  return n;
}

/* The same path without records, events and estimates. */
static shb_status time_steps(const modal_model *model, const mhb_settings *s, sweep_row *row) {
  static double  moving[MAX_POINTS], linear[MAX_POINTS];
  mhb_balance   *b;
  mhb_arclength *path;
  int            iterations, n[2] = {0, 0};
  double         low = SHB_TWO_PI * s->frequency[0];
  SHB_TRY(mhb_balance_create(model, s, &b));
  mhb_balance_set_preload(b, s->n0[0]);
  path                          = mhb_balance_curve_create(b, low, SHB_TWO_PI * s->frequency[1]);
  double               *x       = calloc((size_t)b->n, sizeof(double));
  mhb_arclength_outcome outcome = MHB_ARCLENGTH_STALLED;
  if (mhb_first_solution(mhb_balance_curve_of(path)->newton, b, low, path->tolerance, x,
                         &iterations) == MHB_CONVERGED &&
      mhb_arclength_start(path, x, low, 1) == MHB_CONVERGED)
    outcome = MHB_ARCLENGTH_ON;
  while (outcome == MHB_ARCLENGTH_ON && n[0] + n[1] < MAX_POINTS) {
    double started = shb_seconds();
    outcome        = mhb_arclength_step(path);
    double ms      = 1e3 * (shb_seconds() - started);
    if (moves(b))
      moving[n[0]++] = ms;
    else
      linear[n[1]++] = ms;
    mhb_arclength_advance(path);
  }
  row->solver = median(moving, n[0]);
  row->linear = median(linear, n[1]);
  free(x);
  mhb_arclength_destroy(path);
  mhb_balance_destroy(b);
  SHB_CHECK(outcome == MHB_ARCLENGTH_AT_END, SHB_NOT_CONVERGED, "the path of the beam was lost");
  return SHB_OK;
}

/* Median over repeats, by the seconds of the sweep. */
static shb_status sweep_beam(double force, int harmonics, double tolerance, int repeats,
                             sweep_row *row) {
  sweep_row    all[REPEATS];
  modal_model  model;
  mhb_settings s = beam_settings(harmonics, tolerance);
  tip_contact_beam_model(force, &model);
  shb_status status = SHB_OK;
  for (int i = 0; i < repeats && status == SHB_OK; i++) status = sweep_once(&model, &s, &all[i]);
  if (status == SHB_OK) status = time_steps(&model, &s, &all[0]);
  modal_model_free(&model);
  SHB_TRY(status);
  *row = all[0];
  double seconds[REPEATS], ms[REPEATS];
  for (int i = 0; i < repeats; i++) {
    seconds[i] = all[i].seconds;
    ms[i]      = all[i].ms;
  }
  row->seconds = median(seconds, repeats);
  row->ms      = median(ms, repeats);
  return SHB_OK;
}

/* ---------------------------------------------------------------- goals */

static int verdict(const char *what, double value, double bound) {
  int holds = value <= bound;
  printf("%-52s %10.3g <= %-7g %s\n", what, value, bound, holds ? "PASS" : "FAIL");
  return !holds;
}

/* Least-squares slope of log y against log x. */
static double exponent(int n, const double *x, const double *y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int i = 0; i < n; i++) {
    double u = log(x[i]), v = log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/* ---------------------------------------------------------------- harmonics */

enum { LADDER = 5 };
static const int ladder[LADDER] = {1, 3, 7, 15, 31};

static void print_sweep(double force, int harmonics, const char *accuracy, const sweep_row *row,
                        double error) {
  printf("%4g %3d %-9s %7d %5d %5d %6.1f ", force, harmonics, accuracy, row->points, row->peaks,
         row->folds, row->evaluations);
  printf("%9.4f %9.4f %9.4f %9.4f %12.6e %10.4f %9.1e\n", row->solver, row->linear, row->ms,
         row->seconds, row->peak, row->at, error);
  fflush(stdout);
}

static void print_heads(void) {
  printf("\n%4s %3s %-9s %7s %5s %5s %6s %9s %9s %9s %9s %12s %10s %9s\n", "F", "H", "accuracy",
         "points", "peaks", "folds", "evals", "solver ms", "linear ms", "ms/point", "s/sweep",
         "peak m", "at Hz", "error");
}

/* *failed counts errors that are too large, never times. */
static shb_status bench_harmonics(double force, int *failed) {
  sweep_row row[LADDER];
  double    H[LADDER], ms[LADDER], all[LADDER];
  for (int i = LADDER - 1; i >= 0; i--) {
    SHB_TRY(sweep_beam(force, ladder[i], 1e-8, REPEATS, &row[i]));
    H[i]   = ladder[i];
    all[i] = row[i].ms;
    ms[i]  = row[i].solver;
  }
  print_heads();
  for (int i = 0; i < LADDER; i++)
    print_sweep(force, ladder[i], "exact", &row[i], fabs(row[i].peak / row[LADDER - 1].peak - 1));
  printf("\n");
  *failed +=
      verdict("H = 7: error of the peak", fabs(row[2].peak / row[LADDER - 1].peak - 1), 2e-4);
  verdict("H = 3: ms a point", ms[1], .2);
  verdict("H = 7: ms a point", ms[2], .5);
  verdict("H = 15: ms a point", ms[3], 2);
  verdict("H = 7: s a sweep", row[2].seconds, .3);
  verdict("linear points, H = 7: ms", row[2].linear, .02);
  verdict("cost a point ~ H^e: e over 1..31", exponent(LADDER, H, ms), 1.5);
  verdict("                    e over 7..31", exponent(LADDER - 2, H + 2, ms + 2), 1.5);
  verdict("with error estimates: e over 1..31", exponent(LADDER, H, all), 1.5);
  return SHB_OK;
}

static shb_status bench_accuracies(double force, int repeats, int *failed) {
  static const struct {
    const char *name;
    double      tolerance;
  } accuracy[] = {{"exact", 1e-8}, {"balanced", 1e-5}, {"fast", 1e-3}};
  sweep_row row[3];
  print_heads();
  for (int i = 0; i < 3; i++) {
    SHB_TRY(sweep_beam(force, 7, accuracy[i].tolerance, repeats, &row[i]));
    double error = fabs(row[i].peak / row[0].peak - 1);
    print_sweep(force, 7, accuracy[i].name, &row[i], error);
    *failed += !row[i].complete || row[i].folds != row[0].folds || error > accuracy[i].tolerance;
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- pairs */

enum { STEPS = 8 };

typedef struct {
  double ms, first;         /* median step; seconds to the first solution */
  double residual;          /* worst of the points */
  int pairs, moving, steps; /* pairs that slip or open for a part of the period at the last point */
} pairs_row;

/* Some short steps from 255 Hz on, up the flank of the resonance. */
static shb_status walk(mhb_arclength *path, mhb_balance *b, double *x, pairs_row *row) {
  int    iterations;
  double started = shb_seconds(), omega = SHB_TWO_PI * 255, ms[STEPS];
  SHB_CHECK(mhb_first_solution(mhb_balance_curve_of(path)->newton, b, omega, path->tolerance, x,
                               &iterations) == MHB_CONVERGED,
            SHB_NOT_CONVERGED, "no first solution of %d pairs", b->n_pairs);
  SHB_CHECK(mhb_arclength_start(path, x, omega, 1) == MHB_CONVERGED, SHB_NOT_CONVERGED,
            "no start for %d pairs", b->n_pairs);
  row->first    = shb_seconds() - started;
  path->longest = .01;
  for (row->steps = 0; row->steps < STEPS; row->steps++) {
    started = shb_seconds();
    SHB_CHECK(mhb_arclength_step(path) == MHB_ARCLENGTH_ON, SHB_NOT_CONVERGED,
              "step %d of %d pairs failed", row->steps, b->n_pairs);
    ms[row->steps] = 1e3 * (shb_seconds() - started);
    row->residual  = fmax(row->residual, path->next.residual);
    mhb_arclength_advance(path);
  }
  row->ms     = median(ms, STEPS);
  row->moving = moves(b);
  return SHB_OK;
}

static shb_status run_pairs(int pairs, int harmonics, pairs_row *row) {
  modal_model    model;
  mhb_settings   s = shroud_face_settings(harmonics);
  mhb_balance   *b;
  mhb_arclength *path;
  shroud_face_model(pairs, 150, &model);
  SHB_TRY(mhb_balance_create(&model, &s, &b));
  mhb_balance_set_preload(b, s.n0[0]);
  path              = mhb_balance_curve_create(b, SHB_TWO_PI * 215, SHB_TWO_PI * 320);
  *row              = (pairs_row){.pairs = pairs};
  double    *x      = calloc((size_t)b->n, sizeof(double));
  shb_status status = walk(path, b, x, row);
  free(x);
  mhb_arclength_destroy(path);
  mhb_balance_destroy(b);
  modal_model_free(&model);
  return status;
}

static shb_status run_row(const void *pairs, void *row) {
  return run_pairs(*(const int *)pairs, 7, row);
}

static shb_status bench_pairs(const int *pairs, int n, int *failed) {
  double count[8], ms[8], megabytes[8];
  char   name[32];
  printf("\n%6s %7s %9s %10s %9s %9s %9s\n", "pairs", "moving", "unknowns", "s/point", "first s",
         "MB", "residual");
  for (int i = 0; i < n; i++) {
    pairs_row row = {0};
    snprintf(name, sizeof name, "%d pairs", pairs[i]);
    SHB_TRY(bench_in_child(name, run_row, &pairs[i], &row, sizeof row, &megabytes[i]));
    count[i] = pairs[i];
    ms[i]    = row.ms;
    printf("%6d %7d %9d %10.5f %9.3f %9.1f %9.1e\n", pairs[i], row.moving, 45 * pairs[i],
           1e-3 * row.ms, row.first, megabytes[i], row.residual);
    fflush(stdout);
    *failed += !(row.residual <= 1e-8);
  }
  if (n > 1)
    printf("seconds a point ~ pairs^e, e = %.2f; memory %.2f\n", exponent(n, count, ms),
           exponent(n, count, megabytes));
  return SHB_OK;
}

/* ---------------------------------------------------------------- */

static shb_status quick(int *failed) {
  static const int pairs[] = {1, 4};
  return bench_accuracies(8, 1, failed) == SHB_OK ? bench_pairs(pairs, 2, failed)
                                                  : SHB_NOT_CONVERGED;
}

/* For a profiler. */
static shb_status one_rung(int harmonics) {
  static const double force[] = {8, 20};
  print_heads();
  for (int i = 0; i < 2; i++) {
    sweep_row row;
    SHB_TRY(sweep_beam(force[i], harmonics, 1e-8, REPEATS, &row));
    print_sweep(force[i], harmonics, "exact", &row, 0);
  }
  return SHB_OK;
}

/* The scenes whose numbers are in the documentation. */
static shb_status precision(int *failed) {
  static const double n0[] = {-.2, 0, .3, .5, 1};
  modal_model         model;
  char                name[40];
  shb_status          status = SHB_OK;
  for (int i = 0; i < 2 && status == SHB_OK; i++) {
    mhb_settings s = beam_settings(7, 1e-8);
    snprintf(name, sizeof name, "tip-contact beam, F = %d", i ? 20 : 8);
    tip_contact_beam_model(i ? 20 : 8, &model);
    status = bench_precision(name, &model, &s, failed);
    modal_model_free(&model);
  }
  three_degree_model(&model);
  for (int i = 0; i < 5 && status == SHB_OK; i++) {
    mhb_settings s = beam_settings(7, 1e-8);
    s.mu           = .4;
    s.kv           = .8;
    s.ku[0] = s.ku[2] = .5;
    s.n0[0]           = n0[i];
    s.frequency[0]    = .8 / SHB_TWO_PI;
    s.frequency[1]    = 1.7 / SHB_TWO_PI;
    snprintf(name, sizeof name, "three degrees, n0 = %g", n0[i]);
    status = bench_precision(name, &model, &s, failed);
  }
  modal_model_free(&model);
  return status;
}

/* Contact and excitation of cases/z_notch_blade. */
static shb_status blade(char **argument, int *failed) {
  modal_model  model;
  mhb_settings s = beam_settings(7, 1e-8);
  SHB_TRY(modal_model_read(argument[0], &model));
  s.to_ground    = false;
  s.engine_order = 5;
  s.blades       = 40;
  s.mu           = .3;
  s.kv           = .8e6;
  s.ku[0] = s.ku[2] = .5e6;
  s.n0[0]           = atof(argument[1]);
  s.frequency[0]    = atof(argument[2]);
  s.frequency[1]    = atof(argument[3]);
  shb_status status = bench_precision(argument[0], &model, &s, failed);
  modal_model_free(&model);
  return status;
}

static shb_status everything(int *failed) {
  static const int pairs[] = {1, 10, 50, 200};
  SHB_TRY(bench_harmonics(8, failed));
  SHB_TRY(bench_harmonics(20, failed));
  SHB_TRY(bench_accuracies(8, REPEATS, failed));
  SHB_TRY(bench_accuracies(20, REPEATS, failed));
  SHB_TRY(precision(failed));
  return bench_pairs(pairs, 4, failed);
}

int main(int argc, char **argv) {
  int        failed = 0, pairs = argc == 3 && !strcmp(argv[1], "--pairs") ? atoi(argv[2]) : 0;
  int        harmonics = argc == 3 && !strcmp(argv[1], "--harmonics") ? atoi(argv[2]) : 0;
  shb_status status;
  if (argc == 1) {
    status = everything(&failed);
  } else if (argc == 2 && !strcmp(argv[1], "--quick")) {
    status = quick(&failed);
  } else if (argc == 2 && !strcmp(argv[1], "--precision")) {
    status = precision(&failed);
  } else if (argc > 2 && !strcmp(argv[1], "--faces")) {
    status = bench_contact_faces(argv + 2, argc - 2, &failed);
  } else if (argc > 2 && !strcmp(argv[1], "--stiff")) {
    status = bench_stiff_faces(argv + 2, argc - 2, &failed);
  } else if (argc == 6 && !strcmp(argv[1], "--blade")) {
    status = blade(argv + 2, &failed);
  } else if (pairs > 0) {
    status = bench_pairs(&pairs, 1, &failed);
  } else if (harmonics > 0) {
    status = one_rung(harmonics);
  } else {
    fprintf(stderr,
            "bench_response: usage: bench_response [--quick | --pairs N | --harmonics H | "
            "--precision | "
            "--faces FILE... | --stiff FILE... | --blade FILE N0 FROM TO]\n");
    return SHB_ERR_INPUT;
  }
  if (status != SHB_OK) {
    fprintf(stderr, "bench_response: %s\n", shb_message());
    return status;
  }
  printf("\n%d verdicts on errors failed\n", failed);
  return failed != 0;
}
