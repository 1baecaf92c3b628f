/* shroudhb-pool rung: one rung of a convergence study, for `shroudhb converge`. */
#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/commands/load_model.h"
#include "cases/commands/up_to_date.h"
#include "cases/converge/compare.h"
#include "cases/converge/converge.h"
#include "cases/converge/matched_point.h"
#include "cases/converge/rung.h"
#include "cases/schema/case.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/process/report.h"
#include "mhb/branches/forced_response.h"
#include "postproc/analysis/curves.h"

enum { MAX_RUNS = 5 };
static const double ENOUGH = .3; /* s; after this total no further run is made */

typedef struct {
  case_file    file;
  rung_setting setting;
  const char  *modal, *stem, *reference, *points;
  case_model   source;
  post_output  output;
} job;

/* ---------------------------------------------------------------- the curve and what it cost */

/* Largest resident memory of this program, bytes. getrusage includes the parent's memory before
 * exec. */
static double memory_used(void) {
  char   line[256];
  double kilobytes = 0;
  FILE  *in        = fopen("/proc/self/status", "r");
  while (in && fgets(line, sizeof line, in))
    if (sscanf(line, "VmHWM: %lf", &kilobytes) == 1) break;
  if (in) fclose(in);
  struct rusage rusage;
  if (kilobytes == 0 && getrusage(RUSAGE_SELF, &rusage) == 0) kilobytes = (double)rusage.ru_maxrss;
  return 1024 * kilobytes;
}

/* CPU seconds of this program's one thread, independent of other load. */
static double cpu_seconds(void) {
  struct timespec t = {0};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Repeats the sweep until the total time can be measured; returns the last response. */
static shb_status run_sweeps(job *j, rung_cost *cost, mhb_response **response) {
  double     all    = 0;
  shb_status status = SHB_OK;
  cost->setup       = cpu_seconds();
  for (cost->runs = 0; cost->runs < MAX_RUNS && all < ENOUGH;) {
    mhb_response_destroy(*response);
    double began = cpu_seconds();
    status = mhb_forced_response(&j->source.model, &j->source.settings, NULL, NULL, NULL, response);
    if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
    double seconds = cpu_seconds() - began;
    cost->seconds  = cost->runs++ == 0 ? seconds : fmin(cost->seconds, seconds);
    all += seconds;
  }
  cost->memory   = memory_used();
  cost->complete = status == SHB_OK;
  return SHB_OK;
}

/* ---------------------------------------------------------------- peaks */

/* Amplitude at fraction t of the two segments from point i - 1 to i + 1; -1 if there is no
 * solution. */
static double on_segments(point_matcher *matcher, const mhb_branch *branch, int i, double t,
                          double found[2]) {
  int         from  = t < 1 ? i - 1 : i;
  curve_place place = {branch, from, from + 1, i - 1, i + 1, t < 1 ? t : t - 1};
  return point_matcher_solve(matcher, &place, false, found) ? found[1] : -1;
}

/* Refines the peak at point i by golden section on solutions of the balance. */
static void refine(point_matcher *matcher, const mhb_branch *branch, int i, rung_peak *peak) {
  const double golden = .6180339887498949;
  double       lo = 0, hi = 2, found[2], best[2] = {0, -1};
  double       t[2] = {hi - golden * (hi - lo), lo + golden * (hi - lo)}, a[2];
  for (int k = 0; k < 2; k++) a[k] = on_segments(matcher, branch, i, t[k], found);
  for (int n = 0; n < 34 && a[0] >= 0 && a[1] >= 0; n++) {
    int right = a[1] > a[0]; /* the peak lies in the right part */
    if (right) lo = t[0];
    if (!right) hi = t[1];
    t[!right] = t[right];
    a[!right] = a[right];
    t[right]  = right ? lo + golden * (hi - lo) : hi - golden * (hi - lo);
    a[right]  = on_segments(matcher, branch, i, t[right], found);
    if (a[right] > best[1]) memcpy(best, found, sizeof best);
  }
  double near = fabs(best[0] / peak->frequency - 1), gain = best[1] / peak->amplitude;
  /* another peak than that of the points */
  if (!(near < .01 && gain > .999 && gain < 1.05)) return;
  peak->frequency = best[0];
  peak->amplitude = best[1];
}

static shb_status find_peak(job *j, const mhb_response *response, const mhb_branch *branch,
                            rung_peak *peak) {
  double    *amplitude = NULL;
  post_peak *peaks     = NULL;
  int        n         = 0;
  SHB_TRY(post_series(response, branch, j->output, POST_QUANTITY_FIRST_HARMONIC, &amplitude));
  shb_status status = post_find_peaks(branch->n_points, branch->frequency, amplitude, &peaks, &n);
  free(amplitude);
  SHB_TRY(status);
  int top = post_highest_peak(n, peaks);
  *peak   = (rung_peak){branch->n_points > 0 ? branch->n0[0] : NAN, NAN, NAN};
  if (top >= 0) {
    peak->frequency = peaks[top].at;
    peak->amplitude = peaks[top].amplitude;
  }
  if (top >= 0 && !peaks[top].edge) {
    int            i       = peaks[top].point;
    point_matcher *matcher = NULL;
    status = point_matcher_create(&j->source.model, &j->source.settings, branch->harmonics[i],
                                  j->output, &matcher);
    if (status == SHB_OK) refine(matcher, branch, i, peak);
    point_matcher_destroy(matcher);
  }
  free(peaks);
  return status;
}

static shb_status describe(job *j, const mhb_response *response, rung_cost *cost) {
  for (int b = 0; b < response->n_branches; b++) {
    const mhb_branch *branch = &response->branch[b];
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    cost->points += branch->n_points;
    for (int p = 0; p < branch->n_points; p++)
      if (branch->harmonics[p] > cost->harmonics) cost->harmonics = branch->harmonics[p];
    SHB_TRY(find_peak(j, response, branch, &cost->peak[cost->n_peaks++]));
  }
  cost->unknowns = 3 * response->n_pairs * (2 * cost->harmonics + 1);
  return SHB_OK;
}

/* ---------------------------------------------------------------- the job */

/* Everything that the curve and its cost depend on. */
static shb_status settings_of(const job *j, char **text) {
  char *keys = NULL;
  SHB_TRY(up_to_date_settings(&j->file, CASE_MHB, j->modal, &keys));
  size_t size = strlen(keys) + 256;
  *text       = malloc(size);
  if (*text)
    snprintf(*text, size,
             "%smodes = %d\nresiduals = %d\npatches = %d\noutput = %d %d\nrevision = %s\n", keys,
             j->setting.modes, j->setting.residuals, j->setting.patches, j->output.place,
             j->output.index, shb_revision());
  free(keys);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

static shb_status compute(job *j, char *settings, const char *path) {
  rung_cost      cost       = {0};
  mhb_response  *response   = NULL;
  shb_provenance provenance = command_provenance(&j->file, settings, "shroudhb-rung");
  unlink(path); /* an old curve must not remain beside a new cost */
  shb_status status = run_sweeps(j, &cost, &response);
  if (status == SHB_OK) status = describe(j, response, &cost);
  if (status == SHB_OK) status = rung_cost_write(&cost, j->stem);
  if (status == SHB_OK) status = mhb_response_write(response, path, &provenance);
  mhb_response_destroy(response);
  return status;
}

static shb_status against_rung(job *j) {
  rung_error error;
  char      *path = rung_response(j->reference);
  SHB_CHECK(path, SHB_ERR_IO, "out of memory");
  const char *name   = rung_leaf(j->reference);
  shb_status  status = SHB_OK;
  if (rung_error_read(j->stem, name, path, &error) != SHB_OK) {
    status = compare_rungs(&j->source, j->output, j->stem, j->reference, &error);
    if (status == SHB_OK) status = rung_error_write(&error, j->stem, name, path);
  }
  free(path);
  return status;
}

static shb_status against_integration(job *j) {
  rung_error error;
  if (rung_error_read(j->stem, "integration", j->points, &error) == SHB_OK) return SHB_OK;
  SHB_TRY(compare_integration(&j->source.model, &j->source.settings, j->output, j->stem, j->points,
                              &error));
  return rung_error_write(&error, j->stem, "integration", j->points);
}

static shb_status work(job *j) {
  rung_cost cost;
  char     *settings = NULL, *path = rung_response(j->stem);
  SHB_CHECK(path, SHB_ERR_IO, "out of memory");
  shb_status status = settings_of(j, &settings);
  if (status == SHB_OK &&
      !(up_to_date_with(path, settings) && rung_cost_read(j->stem, &cost) == SHB_OK))
    status = compute(j, settings, path);
  free(settings);
  free(path);
  if (status == SHB_OK && j->reference) status = against_rung(j);
  if (status == SHB_OK && j->points) status = against_integration(j);
  return status;
}

static shb_status prepare(job *j) {
  SHB_TRY(rung_apply(&j->setting, &j->file));
  SHB_TRY(case_model_read(&j->file, j->modal, j->setting.modes, j->setting.residuals, &j->source));
  const int patches = j->setting.patches; /* a coarser mesh may have fewer pairs */
  if (patches > 0 && patches < j->source.model.n_pairs)
    SHB_TRY(case_model_join(&j->source, patches));
  return rung_output(&j->file, j->source.model.n_probes, j->source.model.probe_name, &j->output);
}

int rung_command(const command_options *options) {
  enum { MODAL = 1, STEM, SETTING, REFERENCE = SETTING + RUNG_SETTING_WORDS, POINTS };
  const char *const *file = options->file;
  job                j    = {.modal = file[MODAL], .stem = file[STEM]};
  if (!rung_from_words(file + SETTING, &j.setting)) {
    shb_error("rung is started by shroudhb converge; see --help");
    return SHB_ERR_INPUT;
  }
  const char *reference = file[REFERENCE], *points = file[POINTS];
  if (reference && strcmp(reference, "-") != 0) j.reference = reference;
  if (points && strcmp(points, "-") != 0) j.points = points;
  shb_status status = command_read(options, CASE_MHB | CASE_CONVERGE, &j.file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  openblas_set_num_threads(1);
  omp_set_num_threads(1); /* seconds are those of one core */
  status = prepare(&j);
  if (status == SHB_OK) status = work(&j);
  case_model_free(&j.source);
  case_free(&j.file);
  return command_finish(status);
}
