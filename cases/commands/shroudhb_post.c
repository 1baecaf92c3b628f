/* shroudhb post, shroudhb inspect: the report of a case, the contents of an HDF5 file. */
#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/fatigue_lines.h"
#include "cases/commands/stages.h"
#include "cases/commands/up_to_date.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/converge_settings.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/process/report.h"
#include "postproc/comparison/comparison_page.h"
#include "postproc/comparison/comparison_text.h"
#include "postproc/field/contact_section.h"
#include "postproc/field/strain_gauge.h"
#include "postproc/field/stress_section.h"
#include "postproc/field/stress_table.h"
#include "postproc/inspect/inspect.h"
#include "postproc/inspect/mac.h"
#include "postproc/inspect/value_table.h"
#include "postproc/report/publish.h"
#include "postproc/study/study_publish.h"
#include "postproc/summary/json.h"
#include "postproc/summary/mode_summary.h"
#include "postproc/summary/summary.h"
#include "postproc/summary/table_json.h"

static shb_status print(const post_buffer *text) {
  bool written = !text->text || fwrite(text->text, 1, text->length, stdout) == text->length;
  SHB_CHECK(fflush(stdout) == 0 && written, SHB_ERR_IO, "standard output cannot be written");
  return SHB_OK;
}

/* A summary of a file, or the values at a path in it. */
static shb_status inspect_json(const command_options *options, post_buffer *text) {
  if (!options->other) return post_summary_of_file(options->path, text);
  post_buffer table  = {0};
  shb_status  status = post_value_table(options->path, options->other, true, &table);
  if (status == SHB_OK) status = post_table_json(table.text, text);
  post_buffer_free(&table);
  return status;
}

static shb_status inspect(const command_options *options) {
  bool        terminal = isatty(STDOUT_FILENO) && !getenv("NO_COLOR");
  post_buffer text     = {0};
  shb_status  status   = SHB_OK;
  bool        another  = options->other && access(options->other, F_OK) == 0;
  if (options->json)
    status = inspect_json(options, &text);
  else if (options->other && !another)
    status = post_value_table(options->path, options->other, options->csv, &text);
  else if (options->other)
    status = post_compare((const char *[]){options->path, options->other}, options->verbose, &text);
  else
    status = post_inspect(
        options->path, (post_tree_style){.colour = terminal, .verbose = options->verbose}, &text);
  shb_status printed = print(&text);
  post_buffer_free(&text);
  return status == SHB_OK ? printed : status;
}

/* NAME.converge.h5 if it belongs to the present case; malloc'ed, else NULL. */
static char *current_convergence(const case_file *file) {
  char *path = case_output(file, ".converge.h5"), *settings = NULL;
  bool  fresh = access(path, R_OK) == 0 && converge_settings(file, &settings) == SHB_OK &&
               up_to_date_with(path, settings);
  free(settings);
  if (fresh) return path;
  free(path);
  return NULL;
}

/* Are there points by time integration that belong to the present case and its response? */
static bool has_points(const case_file *file, const char *path, const char *response) {
  char points[17], curves[17];
  if (access(path, R_OK) != 0) return false;
  const bool foreign = up_to_date_modal_of(path, points) && up_to_date_modal_of(response, curves) &&
                       strcmp(points, curves) != 0;
  if (!foreign && up_to_date_keys(file, (case_stage)(CASE_MHB | CASE_INTEGRATE), path)) return true;
  fprintf(stderr,
          "shroudhb: warning: %s was made from other settings and is left out; run `shroudhb "
          "integrate` again\n",
          path);
  return false;
}

/* The modal file if it belongs to the present case; malloc'ed, else NULL. */
static char *current_modal(const case_file *file) {
  char *path  = case_modal_path(file);
  bool  there = access(path, R_OK) == 0;
  if (there && (file->modal_file || up_to_date_keys(file, CASE_MODAL, path))) return path;
  free(path);
  return NULL;
}

/* A modal file that is there is the one of the response, whatever the case says now. */
static shb_status check_modal(const case_file *file, const char *response) {
  char      *path   = case_modal_path(file);
  shb_status status = access(path, R_OK) == 0 && access(response, R_OK) == 0
                          ? up_to_date_check_modal(response, path)
                          : SHB_OK;
  free(path);
  return status;
}

/* The stress of the whole blade, where the modal file has it. */
typedef struct {
  post_blade_field field;
  case_fatigue     lines;
  mhb_response    *response; /* NULL: there is no stress */
  post_buffer      section;  /* of the report */
} stress_work;

static void stress_free(stress_work *s) {
  case_fatigue_free(&s->lines);
  post_blade_field_free(&s->field);
  mhb_response_destroy(s->response);
  post_buffer_free(&s->section);
}

/* Stress of a large mesh costs time. More numbers of modal stress than this are read only for a
 * report, a fatigue line or a gauge. */
static const double SUMMARY_NUMBERS = 3e7;

/* Both files must be of the present case.
 *   page  in  whether there is a report for the section */
static shb_status stress_read(const case_file *file, const char *modal, const char *response,
                              bool page, stress_work *s) {
  if (!modal || !up_to_date_keys(file, CASE_MHB, response)) return SHB_OK;
  SHB_TRY(post_blade_field_read(modal, &s->field));
  double numbers = (double)s->field.n_nodes * s->field.n_modes * POST_STRESSES;
  bool   wanted  = page || case_has_fatigue(file) || file->n_gauges > 0;
  if (numbers > SUMMARY_NUMBERS && !wanted) post_blade_field_free(&s->field);
  if (s->field.n_nodes == 0) return SHB_OK;
  SHB_TRY(mhb_response_read(response, &s->response));
  SHB_TRY(post_blade_field_match(&s->field, s->response, modal));
  SHB_TRY(case_fatigue_read(file, modal, s->field.n_nodes, &s->lines));
  if (!page) return SHB_OK;
  SHB_TRY(post_stress_section(&s->field, s->response, &s->lines.fatigue, &s->section));
  return post_contact_section(response, s->response, file->axis, &s->section);
}

/* Write NAME.stress.csv. It is made for cases with material.fatigue only: a point takes a few
 * hundredths of a second. */
static shb_status stress_publish(const case_file *file, const stress_work *s,
                                 shb_progress *progress) {
  post_buffer table = {0};
  char       *path  = case_output(file, ".stress.csv");
  shb_progress_show(progress, 90, "stress");
  shb_status status = post_stress_table(&s->field, s->response, &s->lines.fatigue, &table);
  if (status == SHB_OK) status = post_buffer_publish(&table, path);
  post_buffer_free(&table);
  free(path);
  shb_progress_clear(progress);
  return status;
}

static shb_status gauge_rows(const case_file *file, const post_blade_field *field,
                             const mhb_response *response, post_buffer *table) {
  post_gauge gauge[CASE_MAX_PROBES] = {0};
  shb_status status                 = SHB_OK;
  for (int i = 0; i < file->n_gauges && status == SHB_OK; i++) {
    gauge[i].name = file->gauge[i].name;
    memcpy(gauge[i].at, file->gauge[i].at, sizeof gauge[i].at);
    memcpy(gauge[i].direction, file->gauge[i].direction, sizeof gauge[i].direction);
    status = post_gauge_place(field, &gauge[i]);
  }
  if (status == SHB_OK) status = post_gauge_table(field, response, file->n_gauges, gauge, table);
  for (int i = 0; i < file->n_gauges; i++) post_gauge_free(&gauge[i]);
  return status;
}

/* Write NAME.gauge.csv: the strain at the gauges of the case. */
static shb_status gauge_publish(const case_file *file, const char *modal,
                                const mhb_response *response) {
  post_blade_field field  = {0};
  post_buffer      table  = {0};
  char            *path   = case_output(file, ".gauge.csv");
  shb_status       status = post_blade_field_read_motion(modal, &field);
  if (status == SHB_OK) status = post_blade_field_match(&field, response, modal);
  if (status == SHB_OK) status = gauge_rows(file, &field, response, &table);
  if (status == SHB_OK) status = post_buffer_publish(&table, path);
  post_blade_field_free(&field);
  post_buffer_free(&table);
  free(path);
  return status;
}

/* The summary of the case: of its curves with a response, and of its modes if they are current. */
static shb_status summarise(const case_file *file, const char *response, const char *modal,
                            const stress_work *stress, post_buffer *out) {
  const post_summary_job job = {.name      = file->name,
                                .case_path = file->path,
                                .response  = response,
                                .modal     = modal,
                                .field     = &stress->field,
                                .fatigue   = &stress->lines.fatigue};
  return post_summary_compose(&job, out);
}

/* Publish NAME.summary.json, and print it if that is wanted. */
static shb_status publish_summary(const case_file *file, const char *response, const char *modal,
                                  const stress_work *stress, bool shown) {
  post_buffer text   = {0};
  char       *path   = case_output(file, ".summary.json");
  shb_status  status = summarise(file, response, modal, stress, &text);
  if (status == SHB_OK) status = post_buffer_publish(&text, path);
  if (status == SHB_OK && shown) status = print(&text);
  post_buffer_free(&text);
  free(path);
  return status;
}

/* --summary, --modes: print and write nothing. */
static shb_status print_summary(const case_file *file, bool curves) {
  post_buffer text     = {0};
  char       *response = curves && !file->only_modes ? case_output(file, ".response.h5") : NULL;
  char       *modal    = current_modal(file);
  stress_work stress   = {0};
  shb_status  status   = response ? check_modal(file, response) : SHB_OK;
  if (status == SHB_OK && response) status = stress_read(file, modal, response, false, &stress);
  if (status == SHB_OK) status = summarise(file, response, modal, &stress, &text);
  if (status == SHB_OK) status = print(&text);
  stress_free(&stress);
  post_buffer_free(&text);
  free(response);
  free(modal);
  return status;
}

/* --facts: what the modal file of the case tells of its blade, for `shroudhb check`. */
static shb_status print_facts(const case_file *file) {
  static const double rpm    = 9.549296585513721; /* a radian a second */
  post_modes          modes  = {0};
  char               *modal  = current_modal(file);
  shb_status          status = modal ? post_modes_read(modal, &modes) : SHB_OK;
  if (modes.n > 0) {
    printf("  modal     lowest mode %.6g Hz", modes.frequency[0]);
    if (isfinite(modes.mass)) printf(", mass %.4g kg", modes.mass);
    if (isfinite(modes.static_stress))
      printf(", static stress %.4g MPa at %.5g rpm", modes.static_stress / 1e6, modes.speed * rpm);
    printf("\n");
  }
  post_modes_free(&modes);
  free(modal);
  return status;
}

/* --check: what a case in order is called. */
shb_status check_print_json(const case_file *file) {
  post_buffer text = {0};
  post_json   json = {.out = &text};
  post_json_object(&json, NULL);
  post_json_bool(&json, "ok", true);
  post_json_text(&json, "name", file->name);
  post_json_text(&json, "case", file->path);
  post_json_bool(&json, "modes_only", file->only_modes);
  post_json_end(&json);
  shb_status status = print(&text);
  post_buffer_free(&text);
  return status;
}

static shb_status publish(const case_file *file, const command_options *options) {
  shb_progress progress = shb_progress_start("post", options->quiet, options->verbose);
  char        *response = case_output(file, ".response.h5"), *html = case_output(file, ".html");
  char        *csv = case_output(file, ".csv"), *svg = case_output(file, ".svg"), *summary = NULL;
  char        *convergence = current_convergence(file);
  char        *points      = case_output(file, ".integration.h5");
  char        *diagram     = case_output(file, ".campbell.svg");
  char        *modal       = current_modal(file);
  stress_work  stress      = {0};
  up_to_date_warn(file, response);
  shb_status status = check_modal(file, response);
  if (status == SHB_OK) status = stress_read(file, modal, response, !options->no_report, &stress);
  const post_job job = {file->name,
                        response,
                        options->no_report ? NULL : html,
                        csv,
                        svg,
                        convergence,
                        has_points(file, points, response) ? points : NULL,
                        modal,
                        diagram,
                        up_to_date_keys(file, CASE_MHB, response) ? &file->mhb : NULL,
                        stress.section.text,
                        file->axis,
                        file->n_speeds == 1 ? file->speed[0] : 0};
  if (status == SHB_OK) status = post_publish(&job, &progress, &summary);
  if (status == SHB_OK && stress.response && case_has_fatigue(file))
    status = stress_publish(file, &stress, &progress);
  if (status == SHB_OK && stress.response && file->n_gauges > 0)
    status = gauge_publish(file, modal, stress.response);
  if (status == SHB_OK) status = publish_summary(file, response, modal, &stress, options->json);
  if (status == SHB_OK && !options->quiet && !options->json)
    printf("%s%s%s\n", options->no_report ? csv : html, summary ? ": " : "",
           summary ? summary : "");
  stress_free(&stress);
  free(summary);
  free(convergence);
  free(response);
  free(html);
  free(csv);
  free(svg);
  free(points);
  free(diagram);
  free(modal);
  return status;
}

static shb_status publish_study(const command_options *options) {
  char      *summary = NULL;
  shb_status status  = study_publish_file(options->path, &summary);
  if (status == SHB_OK && options->json) {
    post_buffer text = {0};
    status           = post_summary_of_file(options->path, &text);
    if (status == SHB_OK) status = print(&text);
    post_buffer_free(&text);
  } else if (status == SHB_OK && !options->quiet) {
    printf("%s\n", summary ? summary : options->path);
  }
  free(summary);
  return status;
}

/* A run by its case or its response file. */
typedef struct {
  char *response, *name, *page; /* malloc'ed; page: its path without a suffix */
} run_files;

static void run_files_free(run_files *f) {
  free(f->response);
  free(f->name);
  free(f->page);
}

static bool ends_with(const char *text, const char *end) {
  size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

static shb_status find_run(const command_options *options, const char *path, run_files *out) {
  static const char suffix[] = ".response.h5";
  if (ends_with(path, ".h5")) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    size_t      cut = ends_with(path, suffix) ? sizeof suffix - 1 : strlen(".h5");
    out->response   = shb_text(path);
    out->name       = shb_text_start(base, strlen(base) - cut);
    out->page       = shb_text_start(path, strlen(path) - cut);
  } else {
    case_file       file;
    command_options one = *options;
    one.path            = path;
    SHB_TRY(command_read(&one, CASE_POST, &file));
    out->response = case_output(&file, ".response.h5");
    out->name     = shb_text(file.name);
    out->page     = case_output(&file, "");
    up_to_date_warn(&file, out->response);
    case_free(&file);
  }
  return SHB_OK;
}

static shb_status show_comparison(const post_comparison *c, const run_files run[POST_RUNS],
                                  const command_options *options) {
  char       *path = shb_text_of("%s.vs.%s.html", run[0].page, run[1].name);
  post_buffer page = {0}, text = {0};
  post_comparison_page(c, &page);
  if (options->json)
    post_comparison_json(c, &text);
  else if (!options->quiet)
    post_comparison_text(c, &text);
  if (!options->json && !options->quiet) post_put(&text, "%s\n", path);
  shb_status status = post_buffer_publish(&page, path);
  if (status == SHB_OK) status = print(&text);
  post_buffer_free(&page);
  post_buffer_free(&text);
  free(path);
  return status;
}

static shb_status compare_runs(const command_options *options) {
  run_files       run[POST_RUNS] = {{0}};
  post_comparison comparison;
  shb_status      status = find_run(options, options->path, &run[0]);
  if (status == SHB_OK) status = find_run(options, options->other, &run[1]);
  if (status == SHB_OK)
    status = post_comparison_read((const char *[]){run[0].response, run[1].response},
                                  (const char *[]){run[0].name, run[1].name}, &comparison);
  if (status == SHB_OK) {
    status = show_comparison(&comparison, run, options);
    post_comparison_free(&comparison);
  }
  for (int i = 0; i < POST_RUNS; i++) run_files_free(&run[i]);
  return status;
}

/* What is done with a case. */
static shb_status work(const case_file *file, const command_options *options) {
  const char *mode = options->mode ? options->mode : "";
  if (strcmp(mode, "summary") == 0) return print_summary(file, true);
  if (strcmp(mode, "modes") == 0) return print_summary(file, false);
  if (strcmp(mode, "check") == 0) return check_print_json(file);
  if (strcmp(mode, "facts") == 0) return print_facts(file);
  return publish(file, options);
}

int inspect_command(const command_options *options) {
  return command_finish(inspect(options));
}

int post_command(const command_options *options) {
  if (options->other && options->mode) {
    shb_error("--%s takes one case; unexpected '%s'; see --help", options->mode, options->other);
    return SHB_ERR_INPUT;
  }
  if (options->other) return command_finish(compare_runs(options));
  if (study_publish_takes(options->path)) return command_finish(publish_study(options));
  case_file  file;
  shb_status status = command_read(options, CASE_POST, &file);
  if (status != SHB_OK) return command_finish(status);
  openblas_set_num_threads(1); /* small products: threads would only wait for each other */
  /* the stage takes a fraction of a second: it finishes and leaves no temporary file */
  shb_interrupt_catch();
  status = work(&file, options);
  case_free(&file);
  return command_finish(status);
}
