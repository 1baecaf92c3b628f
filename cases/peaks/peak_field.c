#include "cases/peaks/peak_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/fatigue_lines.h"
#include "cases/schema/stage_settings.h"
#include "mhb/response/modal_motion.h"
#include "postproc/field/strain_gauge.h"

struct peak_field {
  char               *path;
  int                 n;
  const study_output *output; /* [n] */
  post_blade_field    field;
  char               *settings; /* of the case that lines and gauges are of */
  case_fatigue        lines;
  int                 n_gauges;
  case_gauge          wanted[CASE_MAX_PROBES];
  post_gauge          gauge[CASE_MAX_PROBES];
};

static bool has(int n, const study_output *output, study_quantity quantity) {
  for (int i = 0; i < n; i++)
    if (output[i].quantity == quantity) return true;
  return false;
}

bool peak_field_gives(const study_output *output) {
  return output->quantity == STUDY_STRESS || output->quantity == STUDY_SAFETY ||
         output->quantity == STUDY_GAUGE;
}

bool peak_field_wanted(int n, const study_output *output) {
  for (int i = 0; i < n; i++)
    if (peak_field_gives(&output[i])) return true;
  return false;
}

shb_status peak_field_create(const char *modal, int n, const study_output *output,
                             peak_field **out) {
  peak_field *f = calloc(1, sizeof *f);
  SHB_CHECK(f, SHB_ERR_IO, "out of memory");
  f->path           = strdup(modal);
  f->n              = n;
  f->output         = output;
  shb_status status = has(n, output, STUDY_GAUGE) ? post_blade_field_read_motion(modal, &f->field)
                                                  : post_blade_field_read(modal, &f->field);
  if (status == SHB_OK && f->field.n_nodes == 0)
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s: has no stresses", modal);
  if (status == SHB_OK && !f->path)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) *out = f;
  if (status != SHB_OK) peak_field_destroy(f);
  return status;
}

/* Forget lines and gauges. */
static void clear(peak_field *f) {
  case_fatigue_free(&f->lines);
  for (int i = 0; i < f->n_gauges; i++) post_gauge_free(&f->gauge[i]);
  free(f->settings);
  f->n_gauges = 0;
  f->settings = NULL;
}

void peak_field_destroy(peak_field *f) {
  if (!f) return;
  clear(f);
  post_blade_field_free(&f->field);
  free(f->path);
  free(f);
}

static shb_status place_gauges(peak_field *f, const case_file *file) {
  for (int i = 0; i < file->n_gauges; i++) {
    f->wanted[i] = file->gauge[i];
    f->gauge[i]  = (post_gauge){.name = f->wanted[i].name};
    f->n_gauges  = i + 1;
    memcpy(f->gauge[i].at, f->wanted[i].at, sizeof f->gauge[i].at);
    memcpy(f->gauge[i].direction, f->wanted[i].direction, sizeof f->gauge[i].direction);
    SHB_TRY(post_gauge_place(&f->field, &f->gauge[i]));
  }
  return SHB_OK;
}

shb_status peak_field_use(peak_field *f, const case_file *file) {
  char *settings = case_settings(file, CASE_POST);
  if (settings && f->settings && strcmp(settings, f->settings) == 0) {
    free(settings);
    return SHB_OK;
  }
  clear(f);
  shb_status status = case_fatigue_read(file, f->path, f->field.n_nodes, &f->lines);
  if (status == SHB_OK && has(f->n, f->output, STUDY_GAUGE)) status = place_gauges(f, file);
  if (status == SHB_OK)
    f->settings = settings;
  else
    free(settings);
  return status;
}

/* ---------------------------------------------------------------- outputs */

/* The worst place by amplitude, or by safety. */
static shb_status put_worst(const peak_field *f, const mhb_branch *b, int kept,
                            study_quantity quantity, double *value) {
  const post_fatigue none = {0};
  post_worst_place   place[POST_PLACES];
  int                n      = 0;
  bool               safety = quantity == STUDY_SAFETY;
  if (!has(f->n, f->output, quantity)) return SHB_OK;
  SHB_TRY(post_worst_places(&f->field, b, kept, safety ? &f->lines.fatigue : &none, place, &n));
  for (int i = 0; i < f->n && n > 0; i++)
    if (f->output[i].quantity == quantity) value[i] = safety ? place[0].safety : place[0].amplitude;
  return SHB_OK;
}

static shb_status put_gauges(const peak_field *f, const mhb_branch *b, int kept, double *value) {
  double complex *strain = malloc(((size_t)b->n_harmonics + 1) * sizeof *strain);
  shb_status      status = SHB_OK;
  SHB_CHECK(strain, SHB_ERR_IO, "out of memory");
  for (int i = 0; i < f->n && status == SHB_OK; i++) {
    const study_output *o = &f->output[i];
    if (o->quantity != STUDY_GAUGE || o->index >= f->n_gauges) continue;
    status   = post_gauge_strain(&f->field, &f->gauge[o->index], b, kept, strain);
    value[i] = b->order <= b->n_harmonics ? cabs(strain[b->order]) : NAN;
  }
  free(strain);
  return status;
}

/* Index of a point among those kept; -1: it is not. */
static int kept_of(const mhb_modal_motion *modal, int point) {
  for (int i = 0; i < modal->n; i++)
    if (modal->point[i] == point) return i;
  return -1;
}

shb_status peak_field_evaluate(peak_field *f, const modal_model *model,
                               const mhb_settings *settings, mhb_response *response, int branch,
                               int point, double *value) {
  mhb_settings own  = *settings;
  own.save.what     = MHB_SAVE_ALL;
  mhb_branch *b     = &response->branch[branch];
  response->n_modes = model->n_modes;
  if (b->modal.n < b->n_points) SHB_TRY(mhb_modal_motion_keep(model, &own, response));
  int kept = kept_of(&b->modal, point);
  if (kept < 0) return SHB_OK;
  SHB_TRY(post_blade_field_match(&f->field, response, f->path));
  SHB_TRY(put_worst(f, b, kept, STUDY_STRESS, value));
  SHB_TRY(put_worst(f, b, kept, STUDY_SAFETY, value));
  return put_gauges(f, b, kept, value);
}
