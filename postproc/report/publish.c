#include "postproc/report/publish.h"

#include <stdio.h>
#include <stdlib.h>

#include "mhb/continuation/linear_resonances.h"
#include "modal/model/sector_speeds.h"
#include "postproc/analysis/findings.h"
#include "postproc/analysis/resonances.h"
#include "postproc/report/csv.h"
#include "postproc/report/picture.h"
#include "postproc/report/report.h"
#include "postproc/report/safe_diagram.h"

typedef struct {
  mhb_response       *response;
  post_origin         source;
  post_analysis      *analysis;
  post_convergence    convergence;
  modal_speeds        speeds;
  modal_sector_speeds sector;
  modal_model         model;
  post_blade_field    field;
  post_campbell      *campbell;
  int                 n_campbells;
  post_safe           safe;
  double             *area; /* [n_pairs] m2, of each contact, or NULL */
  post_buffer         html, csv, svg, diagram;
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

/* Areas of the contacts; those of one blade are those of every blade of a ring. */
static shb_status add_areas(work *w) {
  const int pairs = w->response->n_pairs, own = w->model.n_pairs;
  const int blades = w->response->ring > 0 ? w->response->ring : 1;
  if (!w->model.area || own < 1 || pairs != blades * own) return SHB_OK;
  w->area = malloc((size_t)pairs * sizeof *w->area);
  SHB_CHECK(w->area, SHB_ERR_IO, "not enough memory for the report");
  for (int a = 0; a < pairs; a++) w->area[a] = w->model.area[a % own];
  w->analysis->area = w->area;
  return SHB_OK;
}

/* Areas of the contacts and the mesh, of the model that the response was made from. */
static shb_status add_model(const post_job *job, work *w) {
  w->analysis->settings = job->settings;
  w->analysis->stress   = job->stress;
  if (!job->modal) return SHB_OK;
  SHB_TRY(modal_model_read(job->modal, &w->model));
  SHB_TRY(add_areas(w));
  if (!job->html) return SHB_OK;
  SHB_TRY(post_blade_field_read_motion(job->modal, &w->field));
  if (w->field.n_waves == 0) return SHB_OK;
  /* a disc of another response is not shown */
  if (post_blade_field_match(&w->field, w->response, job->modal) != SHB_OK)
    post_blade_field_free(&w->field);
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

/* The models of a disc at one speed; only the lists are its own. */
static void at_speed(const modal_sector_speeds *all, int speed, modal_nodal_diameters *out) {
  modal_nodal_diameters_create(all->blades, all->n, out);
  for (int i = 0; i < all->n; i++) {
    const modal_speeds *at = &all->at[i];
    out->diameter[i]       = all->diameter[i];
    out->model[i]          = at->model[speed];
    if (!at->imaginary) continue;
    out->imaginary[i] = at->imaginary[speed];
    out->backward[i]  = at->backward[speed];
  }
}

static void release(modal_nodal_diameters *d) {
  for (int i = 0; d->model && i < d->n; i++)
    d->model[i] = d->imaginary[i] = d->backward[i] = (modal_model){0};
  modal_nodal_diameters_free(d);
}

/* Stuck frequencies at one speed, at the nodal diameter of the diagram. */
static shb_status find_stuck(const mhb_settings *settings, const work *w, int speed,
                             const post_campbell *c) {
  mhb_settings          here   = *settings;
  modal_nodal_diameters models = {0};
  const bool            disc   = c->blades > 0;
  const modal_model    *model  = disc ? &w->sector.at[0].model[speed] : &c->speeds->model[speed];
  if (disc) at_speed(&w->sector, speed, &models);
  here.nodal_diameters = disc ? &models : NULL;
  const shb_status status =
      mhb_stuck_frequencies(model, &here, disc ? c->diameter : settings->engine_order, c->n_stuck,
                            c->stuck + speed * c->n_stuck);
  release(&models);
  return status;
}

/* Stuck frequencies at each speed. */
static shb_status add_stuck(const mhb_settings *settings, const work *w, post_campbell *c) {
  enum { MOST = 12 };
  const modal_speeds *s = c->speeds;
  if (!settings || s->model[0].n_pairs == 0) return SHB_OK;
  if (!settings->to_ground && !s->model[0].has_left) return SHB_OK;
  c->n_stuck = s->n_modes < MOST ? s->n_modes : MOST;
  c->stuck   = calloc((size_t)c->n_stuck * (size_t)s->n, sizeof *c->stuck);
  SHB_CHECK(c->stuck, SHB_ERR_IO, "not enough memory for the Campbell diagram");
  for (int i = 0; i < s->n; i++) SHB_TRY(find_stuck(settings, w, i, c));
  return SHB_OK;
}

/* The nodal diameters that the load meets, that of the engine order first. */
static void list_diagrams(work *w) {
  const modal_sector_speeds *all   = &w->sector;
  const modal_model         *model = &all->at[0].model[0];
  const int                  E     = w->response->engine_order;
  for (int h = 1; h <= model->n_load; h++) {
    const int n    = modal_nodal_diameter((long)h * E, all->blades);
    bool      have = !modal_model_is_driven(model, h);
    for (int i = 0; i < w->n_campbells; i++) have = have || w->campbell[i].diameter == n;
    for (int i = 0; i < all->n && !have; i++)
      if (all->diameter[i] == n)
        w->campbell[w->n_campbells++] = (post_campbell){
            .speeds = &all->at[i], .engine_order = E, .blades = all->blades, .diameter = n};
  }
}

static shb_status add_campbell(const post_job *job, work *w) {
  if (!job->modal) return SHB_OK;
  SHB_TRY(modal_speeds_read(job->modal, &w->speeds));
  if (w->speeds.n == 0) SHB_TRY(modal_sector_speeds_read(job->modal, &w->sector));
  if (w->speeds.n < 2 && w->sector.n == 0) return SHB_OK;
  w->campbell = calloc((size_t)w->sector.n + 1, sizeof *w->campbell);
  SHB_CHECK(w->campbell, SHB_ERR_IO, "not enough memory for the Campbell diagram");
  if (w->sector.n > 0)
    list_diagrams(w);
  else
    w->campbell[w->n_campbells++] =
        (post_campbell){.speeds = &w->speeds, .engine_order = w->response->engine_order};
  for (int i = 0; i < w->n_campbells; i++) SHB_TRY(add_stuck(job->settings, w, &w->campbell[i]));
  if (w->n_campbells == 0) return SHB_OK;
  w->analysis->campbell    = w->campbell;
  w->analysis->n_campbells = w->n_campbells;
  post_campbell_picture(w->campbell, job->case_name, &w->diagram);
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
  for (int i = 0; i < w.n_campbells; i++) free(w.campbell[i].stuck);
  free(w.campbell);
  post_safe_free(&w.safe);
  free(w.area);
  modal_speeds_free(&w.speeds);
  modal_sector_speeds_free(&w.sector);
  modal_model_free(&w.model);
  post_blade_field_free(&w.field);
  return status;
}
