#include "cases/converge/converge.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/load_model.h"
#include "cases/commands/up_to_date.h"
#include "cases/converge/ladders.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/converge_settings.h"
#include "mesh/base/publish.h"
#include "postproc/report/convergence_chart.h"
#include "postproc/summary/summary.h"

static bool has_mode(const convergence_study *s, const char *mode) {
  return s->options->mode && strcmp(s->options->mode, mode) == 0;
}

/* Makes the modal files. For a parametric blade these include coarser meshes, and the case's own
 * mesh again, so that its cost is measured. */
static shb_status make_variants(convergence_study *s) {
  static const double factor[STUDY_VARIANTS] = {1, 1.6, 1.26, .8};
  const case_file    *file                   = s->file;
  if (file->modal_file || file->mesh_file || has_mode(s, "no-mesh")) {
    s->n_variants = 1;
    return mesh_variant_own(file, s->options, &s->variant[0]);
  }
  for (int i = 0; i < STUDY_VARIANTS - !has_mode(s, "finer"); i++) {
    shb_progress_show(&s->progress, -1, "mesh and modes, element size times %g", factor[i]);
    s->n_variants++;
    SHB_TRY(mesh_variant_make(file, s->options, s->folder, factor[i], &s->variant[i]));
    if (shb_interrupted()) SHB_FAIL(SHB_INTERRUPTED, "interrupted");
  }
  return SHB_OK;
}

/* --force: removes what earlier runs left beside the meshes. The stages treat --force
 * themselves. */
static void forget(const char *folder) {
  static const char *const endings[] = {".response.h5", ".cost", ".error"};
  DIR                     *all       = opendir(folder);
  for (struct dirent *entry; all && (entry = readdir(all)) != NULL;)
    for (int i = 0; i < 3; i++) {
      size_t n = strlen(entry->d_name), e = strlen(endings[i]);
      if (n > e && entry->d_name[0] == 'h' && strcmp(entry->d_name + n - e, endings[i]) == 0)
        unlinkat(dirfd(all), entry->d_name, 0);
    }
  if (all) closedir(all);
}

/* Points by time integration that belong to the present case; malloc'ed, NULL if there are none. */
static char *current_points(const case_file *file) {
  char *path = case_output(file, ".integration.h5");
  if (access(path, R_OK) == 0) {
    if (up_to_date_keys(file, (case_stage)(CASE_MHB | CASE_INTEGRATE), path)) return path;
    fprintf(stderr,
            "shroudhb: warning: %s was made from other settings and is left out; run `shroudhb "
            "integrate` again\n",
            path);
  }
  free(path);
  return NULL;
}

/* The model stays with all its pairs: nothing but their number is asked of it. */
static shb_status choose_points_of_disc(convergence_study *s, const mhb_settings *settings) {
  modal_nodal_diameters disc;
  contact_points       *joined = NULL;
  SHB_TRY(modal_nodal_diameters_read(s->variant[0].modal, &disc));
  modal_model first = disc.model[0];
  shb_status  status =
      contact_points_choose(&first, &disc, settings, s->file->points_tolerance, &joined);
  if (status == SHB_OK && joined) s->base.patches = first.n_pairs;
  contact_points_free(joined);
  modal_nodal_diameters_free(&disc);
  return status;
}

/* With contact.points: auto all ladders but that of the points have as many as the case needs. */
static shb_status choose_points(convergence_study *s, const case_file *own) {
  s->n_pairs = s->model.n_pairs;
  if (!case_points_are_auto(s->file) || s->file->modal_file) return SHB_OK;
  mhb_settings settings = s->file->mhb;
  settings.n_preloads   = own->mhb.n_preloads;
  for (int i = 0; i < own->mhb.n_preloads; i++) settings.n0[i] = own->mhb.n0[i];
  shb_progress_show(&s->progress, -1, "contact.points: auto");
  if (s->disc) return choose_points_of_disc(s, &settings);
  SHB_TRY(contact_points_choose(&s->model, NULL, &settings, s->file->points_tolerance, &s->joined));
  if (s->joined) s->base.patches = s->model.n_pairs;
  return SHB_OK;
}

/* A disc needs the nodal diameters of every number of harmonics. Errors: those of case_model_read,
 * mhb_receptance_check. */
static shb_status check_disc(convergence_study *s) {
  modal_nodal_diameters d;
  case_model            m;
  case_file             whole = *s->file;
  whole.interfaces[0].points  = 0; /* whatever is chosen */
  SHB_TRY(modal_nodal_diameters_read(s->variant[0].modal, &d));
  s->disc = d.n > 0;
  modal_nodal_diameters_free(&d);
  if (!s->disc) return SHB_OK;
  shb_status status = case_model_read(&whole, s->variant[0].modal, 0, true, &m);
  if (status == SHB_OK) status = mhb_receptance_check(&m.settings, m.disc->blades);
  case_model_free(&m);
  return status;
}

static shb_status prepare(convergence_study *s) {
  case_file   copy = *s->file;
  post_output output;
  SHB_CHECK(copy.mhb.parameter == MHB_IN_FREQUENCY, SHB_ERR_INPUT,
            "%s: mhb.vary: converge compares curves over the frequency; leave it out", copy.path);
  s->base = (rung_setting){.harmonics = s->file->mhb.harmonics,
                           .accuracy  = fmin(1e-8, s->file->mhb.tolerance),
                           .modes     = 1,
                           .residuals = true};
  SHB_TRY(rung_apply(&s->base, &copy)); /* limits the preloads */
  s->folder = case_output(s->file, ".converge");
  SHB_TRY(mesh_variant_folder(s->folder));
  SHB_TRY(make_variants(s));
  for (int i = 0; s->options->force && i < s->n_variants; i++)
    forget(s->variant[i].folder ? s->variant[i].folder : s->folder);
  SHB_TRY(modal_model_read(s->variant[0].modal, &s->model));
  SHB_TRY(check_disc(s));
  SHB_TRY(choose_points(s, &copy));
  s->base.modes = s->model.n_modes;
  SHB_TRY(rung_output(s->file, s->model.n_probes, s->model.probe_name, &output));
  s->points            = current_points(s->file);
  s->result.tolerance  = s->file->converge_tolerance;
  s->result.n_preloads = copy.mhb.n_preloads;
  snprintf(s->result.output, sizeof s->result.output, "%s %smotion",
           output.place == POST_PLACE_PROBE ? s->model.probe_name[output.index] : "contact",
           output.place == POST_PLACE_PROBE ? "" : "relative ");
  return SHB_OK;
}

static shb_status print_json(const char *path) {
  post_buffer text   = {0};
  shb_status  status = post_summary_of_file(path, &text);
  if (status == SHB_OK) fwrite(text.text, 1, text.length, stdout);
  post_buffer_free(&text);
  return status;
}

static shb_status publish(convergence_study *s) {
  char *h5 = case_output(s->file, ".converge.h5"), *csv = case_output(s->file, ".converge.csv");
  char *svg = case_output(s->file, ".converge.svg"), *settings = NULL;
  post_buffer    table = {0}, picture = {0};
  shb_status     status     = converge_settings(s->file, &settings);
  shb_provenance provenance = command_provenance(s->file, settings, "shroudhb-converge");
  if (status == SHB_OK) status = post_convergence_write(&s->result, h5, &provenance);
  post_convergence_csv(&s->result, &table);
  post_convergence_picture(&s->result, s->file->name, &picture);
  if (status == SHB_OK) status = post_buffer_publish(&table, csv);
  if (status == SHB_OK) status = post_buffer_publish(&picture, svg);
  if (status == SHB_OK && s->options->json)
    status = print_json(h5);
  else if (status == SHB_OK && !s->options->quiet)
    printf("\n%s\n%s\n%s\n", csv, svg, h5);
  post_buffer_free(&table);
  post_buffer_free(&picture);
  free(settings);
  free(h5);
  free(csv);
  free(svg);
  return status;
}

static void print_report(const convergence_study *s) {
  post_buffer text = {0};
  post_convergence_table(&s->result, s->file->name, &text);
  post_put(&text, "\n");
  post_convergence_conclusion(&s->result, &text);
  if (s->result.note) post_put(&text, "%s", s->result.note);
  if (text.text && !s->options->quiet && !s->options->json)
    fwrite(text.text, 1, text.length, stdout);
  fflush(stdout);
  post_buffer_free(&text);
}

/* Did a rung fail, or does a reference curve have a gap? */
static bool in_doubt(const post_convergence *result) {
  for (int i = 0; i < result->n; i++) {
    const post_rung *r = &result->rung[i];
    if (r->state == POST_RUNG_FAILED || (r->reference && r->state != POST_RUNG_DONE)) return true;
  }
  return false;
}

static shb_status run_study(convergence_study *s) {
  static const char *const suffix[] = {".converge.h5", ".converge.csv", ".converge.svg"};
  shb_status               status   = case_output_check(s->file, 3, suffix);
  if (status == SHB_OK) status = prepare(s);
  if (status == SHB_OK) status = ladders_run(s);
  shb_progress_clear(&s->progress);
  if (status != SHB_OK && status != SHB_INTERRUPTED) return status;
  char why[256];
  snprintf(why, sizeof why, "%s", shb_message());
  s->result.note = s->note.text;
  s->note        = (post_buffer){0};
  print_report(s);
  if (status == SHB_INTERRUPTED) return shb_fail(status, __FILE__, __LINE__, "%s", why);
  SHB_TRY(publish(s));
  SHB_CHECK(!in_doubt(&s->result), SHB_NOT_CONVERGED,
            "a rung failed, or a finest curve has a gap; see the verdicts");
  SHB_CHECK(!s->short_of_rungs, SHB_NOT_CONVERGED,
            "a ladder has no rung below its finest that meets the tolerance");
  return SHB_OK;
}

shb_status converge_case(case_file *file, const command_options *options) {
  convergence_study s = {
      .file     = file,
      .options  = options,
      .progress = shb_progress_start("converge", options->quiet, options->verbose)};
  shb_status status = run_study(&s);
  free(s.points);
  for (int i = 0; i < s.result.n; i++) free(s.row[i].stem);
  for (int i = 0; i < s.n_variants; i++) mesh_variant_free(&s.variant[i]);
  post_convergence_free(&s.result);
  post_buffer_free(&s.note);
  modal_model_free(&s.model);
  contact_points_free(s.joined);
  free(s.row);
  if (s.folder) rmdir(s.folder); /* remains unless it is empty */
  free(s.folder);
  return status;
}
