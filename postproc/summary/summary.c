#include "postproc/summary/summary.h"
#include "postproc/analysis/resonances.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/status.h"
#include "postproc/analysis/convergence.h"
#include "postproc/analysis/file_origin.h"
#include "postproc/study/study_file.h"
#include "postproc/summary/mode_summary.h"
#include "postproc/summary/response_summary.h"

static void begin(post_json *json, const char *format) {
  post_json_object(json, NULL);
  post_json_text(json, "format", format);
  post_json_integer(json, "version", 1);
  post_json_text(json, "revision", shb_revision());
}

/* ---- a case ---- */

static shb_status put_response(const post_summary_job *job, post_json *json) {
  mhb_response            *response = NULL;
  post_analysis           *analysis = NULL;
  const post_stress_source stress   = {job->field, job->fatigue};
  shb_status               status   = mhb_response_read(job->response, &response);
  if (status == SHB_OK) status = post_analysis_create(response, &analysis);
  if (status == SHB_OK) status = post_resonances_add(analysis);
  if (status == SHB_OK) status = post_response_put(analysis, &stress, json);
  post_analysis_destroy(analysis);
  mhb_response_destroy(response);
  return status;
}

shb_status post_summary_compose(const post_summary_job *job, post_buffer *out) {
  post_json  json   = {.out = out};
  post_modes modes  = {0};
  shb_status status = job->modal ? post_modes_read(job->modal, &modes) : SHB_OK;
  begin(&json, "shroudhb summary");
  post_json_text(&json, "name", job->name);
  post_json_text(&json, "case", job->case_path);
  if (status == SHB_OK && job->response) status = put_response(job, &json);
  if (status == SHB_OK && job->modal) post_modes_put(&modes, &json);
  post_json_end(&json);
  post_modes_free(&modes);
  SHB_TRY(status);
  SHB_CHECK(!out->failed, SHB_ERR_IO, "out of memory for the summary");
  return SHB_OK;
}

/* ---- a study ---- */

static void put_named(post_json *json, const char *key, int n, const study_column *column,
                      const double *value) {
  post_json_object(json, key);
  for (int i = 0; i < n; i++) post_json_number(json, column[i].name, value[i]);
  post_json_end(json);
}

static void put_study(const design_study *study, post_json *json) {
  post_json_text(json, "name", study->name);
  post_json_text(json, "plan", study->plan);
  post_json_bool(json, "finished", study->finished);
  post_json_integer(json, "designs_done", design_study_count(study, STUDY_DONE));
  post_json_integer(json, "designs_failed", design_study_count(study, STUDY_FAILED));
  post_json_list(json, "designs");
  for (int i = 0; i < study->n; i++) {
    const study_design *d = &study->design[i];
    post_json_object(json, NULL);
    post_json_integer(json, "design", i + 1);
    post_json_text(json, "status", study_state_name(d->state));
    post_json_text(json, "reason", d->reason);
    put_named(json, "keys", study->n_keys, study->key, d->key);
    put_named(json, "outputs", study->n_outputs, study->output, d->value);
    put_named(json, "errors", study->n_outputs, study->output, d->error);
    post_json_end(json);
  }
  post_json_end(json);
  if (study->optimum.method[0])
    post_json_integer(json, "best", study->optimum.best < 0 ? 0 : study->optimum.best + 1);
  else
    post_json_null(json, "best");
}

static shb_status sum_up_study(const char *path, post_json *json) {
  design_study study;
  SHB_TRY(study_file_read(path, &study));
  begin(json, "shroudhb study summary");
  put_study(&study, json);
  post_json_end(json);
  design_study_free(&study);
  return SHB_OK;
}

/* ---- a convergence study ---- */

static shb_status sum_up_convergence(const char *path, post_json *json) {
  static const char *const states[] = {"not run", "done", "incomplete", "failed"};
  post_convergence         study;
  SHB_TRY(post_convergence_read(path, &study));
  begin(json, "shroudhb convergence summary");
  post_json_text(json, "output", study.output);
  post_json_number(json, "tolerance", study.tolerance);
  post_json_list(json, "rungs");
  for (int i = 0; i < study.n; i++) {
    const post_rung *rung = &study.rung[i];
    post_json_object(json, NULL);
    post_json_text(json, "ladder", post_ladder_name(rung->ladder));
    post_json_text(json, "rung", rung->name);
    post_json_text(json, "status", states[rung->state]);
    post_json_bool(json, "of_case", rung->of_case);
    post_json_bool(json, "reference", rung->reference);
    post_json_bool(json, "meets", post_rung_meets(&study, rung));
    post_json_number(json, "seconds", rung->seconds);
    post_json_number(json, "peak_error", rung->peak);
    post_json_number(json, "frequency_error", rung->frequency);
    post_json_number(json, "curve_error", rung->curve);
    post_json_end(json);
  }
  post_json_end(json);
  post_json_end(json);
  post_convergence_free(&study);
  return SHB_OK;
}

/* ---- any file ---- */

shb_status post_summary_of_file(const char *path, post_buffer *out) {
  post_json   json = {.out = out};
  post_origin origin;
  SHB_TRY(post_origin_open(path, &origin));
  post_summary_job job    = {.case_path = origin.case_path[0] ? origin.case_path : NULL};
  const char      *format = origin.format;
  shb_status       status;
  if (strcmp(format, "shroudhb modal model") == 0) {
    job.modal = path;
    status    = post_summary_compose(&job, out);
  } else if (strcmp(format, "shroudhb response") == 0) {
    job.response = path;
    status       = post_summary_compose(&job, out);
  } else if (strcmp(format, "shroudhb study") == 0) {
    status = sum_up_study(path, &json);
  } else if (strcmp(format, "shroudhb convergence") == 0) {
    status = sum_up_convergence(path, &json);
  } else {
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "%s: no modal, response, study or convergence file: no summary", path);
  }
  post_origin_free(&origin);
  SHB_TRY(status);
  SHB_CHECK(!out->failed, SHB_ERR_IO, "%s: out of memory for the summary", path);
  return SHB_OK;
}
