#include "postproc/report/publish.h"
#include "modal/model/nodal_diameters.h"

#include <stdio.h>
#include <stdlib.h>

#include "mhb/continuation/linear_resonances.h"
#include "postproc/analysis/findings.h"
#include "postproc/analysis/resonances.h"
#include "postproc/report/csv.h"
#include "postproc/report/picture.h"
#include "postproc/report/report.h"
#include "postproc/report/safe_diagram.h"

typedef struct {
  mhb_response    *response;
  post_origin      source;
  post_analysis   *analysis;
  post_convergence convergence;
  modal_speeds     speeds;
  modal_model      model;
  post_blade_field field;
  post_campbell    campbell;
  post_safe        safe;
  post_buffer      html, csv, svg, diagram;
} work;

/* Put the file's name before an error text of the analysis. */
static shb_status make_analysis(const post_job *job, work *w) {
  shb_status status = post_analysis_create(w->response, &w->analysis);
  if (status == SHB_OK) status = post_resonances_add(w->analysis);
  if (status != SHB_ERR_INPUT) return status;
  char why[256];
  snprintf(why, sizeof why, "%s", shb_message());
  SHB_FAIL(status, "%s: %s", job->response, why);
}

/* The points by time integration become branches of the response. */
static shb_status add_integration(const post_job *job, work *w) {
  mhb_response *points;
  if (!job->integration) return SHB_OK;
  SHB_TRY(mhb_response_read(job->integration, &points));
  shb_status status = mhb_response_merge(w->response, points);
  mhb_response_destroy(points);
  if (status != SHB_ERR_INPUT) return status;
  char why[256];
  snprintf(why, sizeof why, "%s", shb_message());
  SHB_FAIL(status, "%s: %s", job->integration, why);
}

/* Areas of the contacts and the mesh, of the model that the response was made from. */
static shb_status add_model(const post_job *job, work *w) {
  w->analysis->settings = job->settings;
  w->analysis->stress   = job->stress;
  if (!job->modal) return SHB_OK;
  SHB_TRY(modal_model_read(job->modal, &w->model));
  if (w->model.n_pairs == w->response->n_pairs) w->analysis->area = w->model.area;
  if (!job->html) return SHB_OK;
  SHB_TRY(post_blade_field_read_motion(job->modal, &w->field));
  if (w->field.n_waves > 0) post_blade_field_free(&w->field); /* the picture has real modes */
  return SHB_OK;
}

/* Frequencies of the ring with stuck contacts over the nodal diameter. */
static shb_status add_safe(const post_job *job, work *w) {
  modal_nodal_diameters disc;
  if (!job->html || !job->modal || !job->settings || post_at_one_frequency(w->analysis))
    return SHB_OK;
  SHB_TRY(modal_nodal_diameters_read(job->modal, &disc));
  mhb_settings settings    = *job->settings;
  settings.nodal_diameters = disc.n > 0 ? &disc : NULL;
  shb_status status =
      post_safe_compute(&w->model, &settings, w->analysis->frequency, job->speed, &w->safe);
  modal_nodal_diameters_free(&disc);
  w->analysis->safe = &w->safe;
  return status;
}

/* Stuck frequencies at each speed, at the nodal diameter of the excitation. */
static shb_status add_stuck(const mhb_settings *settings, work *w) {
  enum { MOST = 12 };
  const modal_speeds *s = &w->speeds;
  const int           n = s->n_modes < MOST ? s->n_modes : MOST;
  if (!settings || s->model[0].n_pairs == 0) return SHB_OK;
  if (!settings->to_ground && !s->model[0].has_left) return SHB_OK;
  w->campbell.stuck = calloc((size_t)n * (size_t)s->n, sizeof *w->campbell.stuck);
  SHB_CHECK(w->campbell.stuck, SHB_ERR_IO, "not enough memory for the Campbell diagram");
  for (int i = 0; i < s->n; i++)
    SHB_TRY(mhb_stuck_frequencies(&s->model[i], settings, settings->engine_order, n,
                                  w->campbell.stuck + i * n));
  w->campbell.n_stuck = n;
  return SHB_OK;
}

static shb_status add_campbell(const post_job *job, work *w) {
  if (!job->modal) return SHB_OK;
  SHB_TRY(modal_speeds_read(job->modal, &w->speeds));
  if (w->speeds.n < 2) return SHB_OK;
  w->campbell = (post_campbell){&w->speeds, w->response->engine_order, 0, NULL};
  SHB_TRY(add_stuck(job->settings, w));
  w->analysis->campbell = &w->campbell;
  post_campbell_picture(&w->campbell, job->case_name, &w->diagram);
  return SHB_OK;
}

static shb_status compose(const post_job *job, shb_progress *progress, work *w) {
  double started = shb_seconds();
  shb_progress_show(progress, 0, "reading %s", job->response);
  SHB_TRY(mhb_response_read(job->response, &w->response));
  SHB_TRY(add_integration(job, w));
  SHB_TRY(post_origin_open(job->response, &w->source));
  SHB_TRY(make_analysis(job, w));
  if (job->convergence) {
    SHB_TRY(post_convergence_read(job->convergence, &w->convergence));
    w->analysis->convergence = &w->convergence;
  }
  SHB_TRY(add_model(job, w));
  SHB_TRY(add_campbell(job, w));
  SHB_TRY(add_safe(job, w));
  shb_progress_note(progress, "read %d points on %d curves in %.2f s", w->analysis->n_points,
                    w->response->n_branches, shb_seconds() - started);
  started = shb_seconds();
  shb_progress_show(progress, 30, "page");
  if (job->html) {
    const post_blade_view view = {&w->field, job->axis};
    SHB_TRY(post_report(w->analysis, &w->source, job->case_name, &view, &w->html));
    shb_progress_note(progress, "page, %.1f MB, in %.2f s", 1e-6 * (double)w->html.length,
                      shb_seconds() - started);
  }
  started = shb_seconds();
  shb_progress_show(progress, 70, "table");
  post_csv(w->response, &w->csv);
  if (job->html) post_picture(w->analysis, job->case_name, &w->svg);
  shb_progress_note(progress, "table, %.1f MB, and picture in %.2f s", 1e-6 * (double)w->csv.length,
                    shb_seconds() - started);
  bool failed = w->html.failed || w->csv.failed || w->svg.failed || w->diagram.failed;
  SHB_CHECK(!failed, SHB_ERR_IO, "%s: not enough memory for its report", job->response);
  return SHB_OK;
}

static shb_status write_all(const post_job *job, const work *w) {
  SHB_TRY(post_buffer_publish(&w->csv, job->csv));
  if (!job->html) return SHB_OK;
  SHB_TRY(post_buffer_publish(&w->svg, job->svg));
  if (job->campbell && w->analysis->campbell)
    SHB_TRY(post_buffer_publish(&w->diagram, job->campbell));
  return post_buffer_publish(&w->html, job->html);
}

shb_status post_publish(const post_job *job, shb_progress *progress, char **summary) {
  work       w      = {0};
  shb_status status = compose(job, progress, &w);
  if (status == SHB_OK) status = write_all(job, &w);
  if (status == SHB_OK && summary) {
    post_buffer text = {0};
    post_summary(w.analysis, &text);
    *summary = text.text; /* NULL if the summary is empty */
  }
  shb_progress_clear(progress);
  post_analysis_destroy(w.analysis);
  post_convergence_free(&w.convergence);
  post_origin_free(&w.source);
  mhb_response_destroy(w.response);
  post_buffer_free(&w.html);
  post_buffer_free(&w.csv);
  post_buffer_free(&w.svg);
  post_buffer_free(&w.diagram);
  free(w.campbell.stuck);
  post_safe_free(&w.safe);
  modal_speeds_free(&w.speeds);
  modal_model_free(&w.model);
  post_blade_field_free(&w.field);
  return status;
}
