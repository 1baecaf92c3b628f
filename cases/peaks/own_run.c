#include "cases/peaks/own_run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/stage.h"
#include "mhb/response/response.h"
#include "postproc/analysis/outputs.h"
#include "postproc/study/study_file.h"

/* Starts at the frequency of the study's peak: "a good first look" (mhb.search.starts). */
enum { STARTS = 40, MORE = 14, WORD = 96 };

/* Points of a curve between which a peak lies are lower than it by less than this. */
static const double BETWEEN = 1e-3;

/* The highest first harmonic of the first output. */
typedef struct {
  double amplitude, at, error; /* m, Hz, m; amplitude NAN: not known */
} summit;

/* "NAME_17.SUFFIX" in the folder of the study; malloc'ed. */
static char *path_of(const study_spec *spec, int design, const char *suffix) {
  size_t size       = strlen(spec->folder) + strlen(spec->name) + strlen(suffix) + 32;
  char  *path       = malloc(size);
  char   number[16] = "";
  if (design > 0) snprintf(number, sizeof number, "_%d", design);
  if (path) snprintf(path, size, "%s/%s%s%s", spec->folder, spec->name, number, suffix);
  return path;
}

/* The study's own file. study->n stays 0 where there is none. */
static void read_study(const study_spec *spec, design_study *study) {
  char *path = path_of(spec, 0, ".study.h5");
  *study     = (design_study){0};
  if (path && access(path, R_OK) == 0 && study_file_read(path, study) != SHB_OK)
    *study = (design_study){0};
  free(path);
}

/* The peak that the study has of a design; none if its row is of another case or other values. */
static summit peak_of_study(const study_spec *spec, const design_study *study, int design,
                            const double *value) {
  const summit none = {NAN, NAN, NAN};
  const int    peak = design_study_output(study, "peak");
  const int    at   = design_study_output(study, "frequency");
  char         digest[DIGEST_TEXT], why[WORD];
  if (design > study->n || peak < 0 || at < 0) return none;
  const study_design *d = &study->design[design - 1];
  if (!study_spec_digest(spec, value, digest, why, sizeof why) || strcmp(digest, d->digest) != 0)
    return none;
  return (summit){d->value[peak], d->value[at], d->error[peak]};
}

static summit peak_of_run(const study_spec *spec, int design) {
  mhb_response *r    = NULL;
  summit        top  = {NAN, NAN, NAN};
  char         *path = path_of(spec, design, ".response.h5");
  if (path && mhb_response_read(path, &r) == SHB_OK) {
    const post_output first = post_output_primary(r);
    for (int k = 0; k < r->n_branches; k++) {
      const mhb_branch *b = &r->branch[k];
      for (int i = 0; i < b->n_points && b->kind == MHB_BRANCH_NONLINEAR; i++) {
        const double a = post_amplitude(r, b, i, first, post_first_harmonic(b));
        if (!(a <= top.amplitude)) top = (summit){a, b->frequency[i], NAN};
      }
    }
    mhb_response_destroy(r);
  }
  free(path);
  return top;
}

/* Whether the curves reach a peak, within its error and the tolerance of their harmonics. */
static bool reaches(const study_spec *spec, const summit *own, const summit *known) {
  const double told = isfinite(known->error) ? 3 * known->error : 0;
  const double room = fmax(BETWEEN, spec->base.mhb.motion_tolerance) * known->amplitude;
  return !(own->amplitude < known->amplitude - told - room);
}

/* `shroudhb run` of a design, with a search at a frequency; NAN: as the case says. */
static shb_status run(const study_spec *spec, const double *value, int design, bool quiet,
                      double search_at, shb_child_end *result) {
  char *words[2 * STUDY_MAX_KEYS + MORE] = {NULL};
  char  name[STUDY_NAME + WORD], starts[WORD], places[WORD], orders[] = "mhb.search.orders=[1]";
  char  set[] = "--set", into[] = "--into", silent[] = "--quiet";
  int   n = stage_program(COMMAND_RUN, (const char **)words);
  snprintf(name, sizeof name, "name=%s_%d", spec->name, design);
  snprintf(starts, sizeof starts, "mhb.search.starts=%d", STARTS);
  snprintf(places, sizeof places, "mhb.search.at=[%.12g Hz]", search_at);
  if (quiet) words[n++] = silent;
  char *const own[] = {name, starts, places, orders};
  for (int i = 0; i < (isnan(search_at) ? 1 : 4); i++) {
    words[n++] = set;
    words[n++] = own[i];
  }
  words[n++]     = into;
  words[n++]     = spec->folder;
  const int sets = study_spec_words(spec, value, words + n);
  SHB_CHECK(sets >= 0 && words[0], SHB_ERR_IO, "out of memory");
  words[n + sets]   = spec->case_path;
  shb_child  child  = shb_child_of(words);
  shb_status status = shb_child_run(&child, result);
  for (int i = 0; i < sets; i++) free(words[n + i]);
  free(words[0]);
  return status;
}

/* Compare with the study, and search where the curves are lower. */
static shb_status compare(const study_spec *spec, const double *value, int design, bool quiet,
                          const summit *known, shb_child_end *result) {
  summit own = peak_of_run(spec, design);
  if (!isfinite(known->amplitude) || isnan(own.amplitude)) return SHB_OK;
  if (!reaches(spec, &own, known)) {
    if (!quiet)
      printf("the curves do not reach the study's peak: searching at %.6g Hz\n", known->at);
    fflush(stdout);
    SHB_TRY(run(spec, value, design, quiet, known->at, result));
    own = peak_of_run(spec, design);
  }
  if (!quiet)
    printf("highest   %.6g m at %.6g Hz; in the study %.6g m at %.6g Hz\n", own.amplitude, own.at,
           known->amplitude, known->at);
  SHB_CHECK(reaches(spec, &own, known), SHB_NOT_CONVERGED,
            "the study's peak of %.6g m at %.6g Hz is on none of the curves of this run",
            known->amplitude, known->at);
  return SHB_OK;
}

shb_status own_run(const study_spec *spec, int design, bool quiet) {
  design_study  study;
  shb_child_end result = {0};
  read_study(spec, &study);
  const bool wanted = spec->optimise.wanted; /* its designs are in its file only */
  const int  n      = wanted ? study.n : spec->n_designs;
  const bool fits   = study.n_keys == spec->keys.n;
  shb_status status = SHB_OK;
  if (design < 1 || design > n || (wanted && !fits))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "--design=%d: the study has the designs 1 to %d%s", design, n,
                      wanted ? ", in its file; run the study again if its keys changed" : "");
  if (status == SHB_OK) {
    const double *value = wanted ? study.design[design - 1].key
                                 : spec->design + (size_t)(design - 1) * (size_t)spec->keys.n;
    const summit  known = peak_of_study(spec, &study, design, value);
    status              = run(spec, value, design, quiet, NAN, &result);
    if (status == SHB_OK && (result.code == SHB_OK || result.code == SHB_NOT_CONVERGED))
      status = compare(spec, value, design, quiet, &known, &result);
  }
  design_study_free(&study);
  return status == SHB_OK ? (shb_status)result.code : status;
}
