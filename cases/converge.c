#include "cases/converge.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/child.h"
#include "cases/rung.h"
#include "cases/variant.h"
#include "mesh/progress.h"
#include "mhb/harmonics.h"
#include "modal/model.h"
#include "postproc/convergence.h"
#include "postproc/convergence_chart.h"

enum { MAX_VARIANTS = 4, MAX_TOGETHER = 6 };

static const double DEFAULT_TOLERANCE =
    1e-4; /* of the motion, with auto, where the case has none */

/* What a row of the result needs to be run. */
typedef struct {
  rung_setting setting;
  int          variant;
  char        *stem;
  rung_cost    cost;
} place;

typedef struct {
  case_file             *file;
  const command_options *options;
  shb_progress           progress;
  char                  *folder; /* NAME.converge */
  variant                variant[MAX_VARIANTS];
  int                    n_variants;
  modal_model            model; /* of the first */
  rung_setting           base;
  post_convergence       result;
  int                    capacity;
  place                 *place; /* [result.n] */
  post_buffer            note;
  bool short_of_rungs; /* a ladder has no rung but the finest that meets the tolerance */
} study;

/* ---------------------------------------------------------------- one rung */

static char *stem_of(const study *s, const rung_setting *setting, int v) {
  char        name[RUNG_WORD];
  const char *folder = s->variant[v].folder ? s->variant[v].folder : s->folder;
  rung_name(setting, name);
  size_t size = strlen(folder) + strlen(name) + 2;
  char  *stem = malloc(size);
  if (stem) snprintf(stem, size, "%s/%s", folder, name);
  return stem;
}

static shb_status add(study *s, post_ladder ladder, const rung_setting *setting, int v,
                      const char *name) {
  post_rung *row = post_convergence_add(&s->result);
  if (row && s->result.n > s->capacity) {
    int    room  = s->capacity ? 2 * s->capacity : 32;
    place *grown = realloc(s->place, (size_t)room * sizeof *grown);
    if (grown) {
      s->place    = grown;
      s->capacity = room;
    } else {
      row = NULL;
    }
  }
  SHB_CHECK(row, SHB_ERR_IO, "out of memory");
  place *p = &s->place[s->result.n - 1];
  *p       = (place){.setting = *setting, .variant = v, .stem = stem_of(s, setting, v)};
  SHB_CHECK(p->stem, SHB_ERR_IO, "out of memory");
  row->ladder = ladder;
  snprintf(row->name, sizeof row->name, "%s", name);
  return SHB_OK;
}

static void take_cost(study *s, int i) {
  place         *p    = &s->place[i];
  post_rung     *row  = &s->result.rung[i];
  const variant *v    = &s->variant[p->variant];
  bool           mesh = row->ladder == POST_LADDER_MESH;
  row->state          = p->cost.complete ? POST_RUNG_DONE : POST_RUNG_INCOMPLETE;
  row->unknowns       = mesh ? v->unknowns : p->cost.unknowns;
  row->seconds        = p->cost.seconds + (mesh ? v->seconds : 0);
  row->total          = row->seconds + p->cost.setup;
  row->memory         = mesh ? fmax(p->cost.memory, v->memory) : p->cost.memory;
}

/* The child's words; its last one the reference's stem, or none. */
static shb_status start_rung(study *s, const place *p, const char *reference,
                             child_result *result) {
  char  setting[RUNG_SETTING_WORDS][RUNG_WORD];
  char *words[RUNG_SETTING_WORDS + 6] = {child_program("shroudhb-rung"), s->file->path,
                                         s->variant[p->variant].modal, p->stem};
  rung_words(&p->setting, setting);
  for (int i = 0; i < RUNG_SETTING_WORDS; i++) words[4 + i] = setting[i];
  words[4 + RUNG_SETTING_WORDS] = reference ? strdup(reference) : NULL;
  SHB_CHECK(words[0] && (!reference || words[4 + RUNG_SETTING_WORDS]), SHB_ERR_IO, "out of memory");
  shb_status status = child_run(words, result);
  free(words[0]);
  free(words[4 + RUNG_SETTING_WORDS]);
  return status;
}

/* Work row i out, and compare it with row reference (-1: with none). A rung that fails costs its row only. */
static shb_status run(study *s, int i, int reference) {
  place       *p   = &s->place[i];
  post_rung   *row = &s->result.rung[i];
  child_result result;
  rung_error   error;
  shb_progress_show(&s->progress, -1, "%s %s", post_ladder_name(row->ladder), row->name);
  const char *other  = reference >= 0 ? s->place[reference].stem : NULL;
  shb_status  status = start_rung(s, p, other, &result);
  if ((status == SHB_OK && result.code == SHB_INTERRUPTED) || shb_interrupted())
    SHB_FAIL(SHB_INTERRUPTED, "interrupted; the rungs so far are kept and used again");
  shb_progress_clear(&s->progress);
  if (status != SHB_OK) fprintf(stderr, "shroudhb: warning: %s\n", shb_message());
  if (status == SHB_OK && result.code == SHB_ERR_INPUT)
    return shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s", ""); /* the child has told it */
  if (status != SHB_OK || result.code != 0 || rung_cost_read(p->stem, &p->cost) != SHB_OK) {
    row->state = POST_RUNG_FAILED;
    return SHB_OK;
  }
  take_cost(s, i);
  shb_progress_note(&s->progress, "%s %s: %.3g s, %d points", post_ladder_name(row->ladder),
                    row->name, p->cost.seconds, p->cost.points);
  if (reference < 0 || rung_error_read(p->stem, other, &error) != SHB_OK) return SHB_OK;
  rung_peak_errors(&p->cost, &s->place[reference].cost, &row->peak, &row->frequency);
  row->curve = error.curve;
  return SHB_OK;
}

/* Rows from first on: the last is the reference of all of them. */
static shb_status run_ladder(study *s, int first) {
  int last                       = s->result.n - 1;
  s->result.rung[last].reference = true;
  if (s->result.rung[last].state == POST_RUNG_WAITING) SHB_TRY(run(s, last, -1));
  post_rung *finest = &s->result.rung[last];
  for (int i = first; i < last; i++)
    SHB_TRY(run(s, i, finest->state == POST_RUNG_FAILED ? -1 : last));
  finest->peak = finest->frequency = finest->curve = 0;
  bool none                                        = post_cheapest(&s->result, finest->ladder) < 0;
  s->short_of_rungs                                = s->short_of_rungs || (none && last > first);
  return SHB_OK;
}

/* ---------------------------------------------------------------- ladders */

static int by_size(const void *a, const void *b) {
  return *(const int *)a - *(const int *)b;
}

/* Seconds that the next rung may take, from those of the one before: the solver's cost grows no faster than H^1.8. */
static double predict(double seconds, int from, int to) {
  return seconds * pow((double)to / from, 1.8);
}

static shb_status harmonics_ladder(study *s) {
  mhb_settings wide = s->file->mhb;
  int          m[MHB_MAX_RUNGS + 1], first = s->result.n, own = s->file->mhb.harmonics;
  wide.motion_tolerance = 1;
  int  n                = mhb_harmonics_ladder(&s->model, &wide, m);
  bool there            = own == 0;
  for (int i = 0; i < n; i++) there = there || m[i] == own;
  if (!there) m[n++] = own;
  qsort(m, (size_t)n, sizeof *m, by_size);
  for (int i = 0; i < n; i++) {
    char         name[16];
    rung_setting setting = s->base;
    setting.harmonics    = m[i];
    setting.tolerance    = 0;
    double next = i == 0 ? 0 : predict(s->place[s->result.n - 1].cost.seconds, m[i - 1], m[i]);
    if (next > s->file->converge_seconds) {
      post_put(&s->note,
               "The ladder of harmonics ends at %d: %d would take about %.0f s "
               "(converge.seconds is %g).\n",
               m[i - 1], m[i], next, s->file->converge_seconds);
      break;
    }
    snprintf(name, sizeof name, "%d", m[i]);
    SHB_TRY(add(s, POST_LADDER_HARMONICS, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = m[i] == own;
    SHB_TRY(
        run(s, s->result.n - 1, -1)); /* upwards: its seconds tell whether the next is affordable */
  }
  return run_ladder(s, first);
}

static shb_status auto_ladder(study *s) {
  double tolerance[4] = {1e-2, 1e-3, DEFAULT_TOLERANCE}, own = s->file->mhb.motion_tolerance;
  int    n = 3, reference = post_reference(&s->result, POST_LADDER_HARMONICS);
  bool   there = own == 0;
  for (int i = 0; i < n; i++) there = there || fabs(tolerance[i] / own - 1) < 1e-9;
  if (!there) tolerance[n++] = own;
  for (int i = 0; i < n; i++) {
    char         name[32];
    rung_setting setting = s->base;
    setting.harmonics    = 0;
    setting.tolerance    = tolerance[i];
    snprintf(name, sizeof name, "auto, tolerance %g", tolerance[i]);
    SHB_TRY(add(s, POST_LADDER_AUTO, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = tolerance[i] == own;
    SHB_TRY(run(s, s->result.n - 1, reference));
  }
  return SHB_OK;
}

static void accuracy_name(double accuracy, char name[POST_RUNG_NAME]) {
  const char *word = accuracy == 1e-3   ? "fast"
                     : accuracy == 1e-5 ? "balanced"
                     : accuracy == 1e-8 ? "exact"
                                        : NULL;
  snprintf(name, POST_RUNG_NAME, word ? "%s" : "", word);
  if (!word) snprintf(name, POST_RUNG_NAME, "%g", accuracy);
}

static shb_status accuracy_ladder(study *s) {
  double value[4] = {1e-3, 1e-5, 1e-8}, own = s->file->mhb.tolerance;
  int    n = 3, first = s->result.n, at = 0;
  while (at < n && value[at] > own) at++;
  if (at == n || value[at] != own) { /* the case's own between them, descending */
    memmove(value + at + 1, value + at, (size_t)(n - at) * sizeof *value);
    value[at] = own;
    n++;
  }
  for (int i = 0; i < n; i++) {
    char         name[POST_RUNG_NAME];
    rung_setting setting = s->base;
    setting.accuracy     = value[i];
    accuracy_name(value[i], name);
    SHB_TRY(add(s, POST_LADDER_ACCURACY, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = value[i] == own;
  }
  return run_ladder(s, first);
}

static shb_status modes_ladder(study *s, bool residuals) {
  static const int wanted[] = {1, 2, 3, 5, 8, 12, 20, 30, 50, 80, 120, 200, 300, 500, 1000};
  int              all = s->model.n_modes, first = s->result.n;
  bool             has = s->model.residual_flexibility || s->model.load_residual;
  if (residuals && all == 1) return SHB_OK;
  for (size_t i = 0; i <= sizeof wanted / sizeof *wanted; i++) {
    int          modes = i < sizeof wanted / sizeof *wanted && wanted[i] < all ? wanted[i] : all;
    char         name[16];
    rung_setting setting = s->base;
    if (!residuals && !has && modes == all) break; /* the reference itself */
    setting.modes     = modes;
    setting.residuals = residuals;
    snprintf(name, sizeof name, "%d", modes);
    SHB_TRY(add(s, residuals ? POST_LADDER_MODES : POST_LADDER_BARE, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = residuals && modes == all;
    if (modes == all) break;
  }
  if (residuals) return run_ladder(s, first);
  int reference = post_reference(&s->result, POST_LADDER_MODES);
  for (int i = first; i < s->result.n; i++) SHB_TRY(run(s, i, reference));
  return SHB_OK;
}

/* From the coarsest on. */
static shb_status mesh_ladder(study *s) {
  const mesh_blade *blade = &s->file->blade;
  int               first = s->result.n, order[MAX_VARIANTS];
  for (int i = 0; i < s->n_variants; i++) {
    int at = i;
    for (; at > 0 && s->variant[order[at - 1]].factor < s->variant[i].factor; at--)
      order[at] = order[at - 1];
    order[at] = i;
  }
  for (int i = 0; i < s->n_variants; i++) {
    char   name[POST_RUNG_NAME];
    double factor = s->variant[order[i]].factor;
    snprintf(name, sizeof name, "%.3g mm", 1e3 * factor * blade->size);
    if (blade->shroud_size > 0)
      snprintf(name, sizeof name, "%.3g mm, shroud %.3g mm", 1e3 * factor * blade->size,
               1e3 * factor * blade->shroud_size);
    SHB_TRY(add(s, POST_LADDER_MESH, &s->base, order[i], name));
    s->result.rung[s->result.n - 1].of_case = factor == 1;
  }
  return run_ladder(s, first);
}

/* ---------------------------------------------------------------- settings combined */

static double error_at(const study *s, int i) {
  double error = i < 0 ? NAN : post_rung_error(&s->result.rung[i]);
  return isnan(error) ? 0 : error;
}

/* The cheaper of the best of two ladders; the reference of the first if neither has one. */
static int pick(const study *s, post_ladder one, post_ladder other) {
  int a = post_cheapest(&s->result, one), b = post_cheapest(&s->result, other);
  if (a < 0 && b < 0) return post_reference(&s->result, one);
  if (a < 0 || b < 0) return a < 0 ? b : a;
  return s->result.rung[a].seconds <= s->result.rung[b].seconds ? a : b;
}

/* The rung of the same ladder that errs next less; the finest if there is none. */
static int finer(const study *s, int i) {
  int              best = -1;
  const post_rung *from = &s->result.rung[i];
  for (int k = 0; k < s->result.n; k++) {
    const post_rung *r = &s->result.rung[k];
    if (r->ladder != from->ladder || r->state != POST_RUNG_DONE) continue;
    if (!(post_rung_error(r) < post_rung_error(from))) continue;
    if (best < 0 || post_rung_error(r) > post_rung_error(&s->result.rung[best])) best = k;
  }
  return best >= 0 ? best : i;
}

/* The setting that takes its parts from three rungs, and what it is called. */
static rung_setting combine(const study *s, const int part[3], char name[POST_RUNG_NAME]) {
  const rung_setting *h   = &s->place[part[0]].setting;
  rung_setting        out = *h;
  char                harmonics[24];
  out.accuracy  = part[1] < 0 ? s->base.accuracy : s->place[part[1]].setting.accuracy;
  out.modes     = part[2] < 0 ? s->base.modes : s->place[part[2]].setting.modes;
  out.residuals = part[2] < 0 ? true : s->place[part[2]].setting.residuals;
  snprintf(harmonics, sizeof harmonics, h->harmonics > 0 ? "%g" : "auto %g",
           h->harmonics > 0 ? h->harmonics : h->tolerance);
  snprintf(name, POST_RUNG_NAME, "H %s, %.12s, %d mode%s%s", harmonics,
           part[1] < 0 ? "exact" : s->result.rung[part[1]].name, out.modes,
           out.modes == 1 ? "" : "s", out.residuals ? "" : " bare");
  return out;
}

/* The cheapest of each ladder, all at once; where the errors add up to too much, the worst part a rung finer. */
static shb_status together(study *s) {
  int reference = post_reference(&s->result, POST_LADDER_HARMONICS);
  int part[3]   = {pick(s, POST_LADDER_HARMONICS, POST_LADDER_AUTO),
                   pick(s, POST_LADDER_ACCURACY, POST_LADDER_ACCURACY),
                   pick(s, POST_LADDER_MODES, POST_LADDER_BARE)};
  if (reference < 0 || part[0] < 0) return SHB_OK;
  for (int tries = 0; tries < MAX_TOGETHER; tries++) {
    char         name[POST_RUNG_NAME];
    rung_setting setting = combine(s, part, name);
    SHB_TRY(add(s, POST_LADDER_TOGETHER, &setting, 0, name));
    int last = s->result.n - 1, worst = 0;
    SHB_TRY(run(s, last, reference));
    if (post_rung_meets(&s->result, &s->result.rung[last])) return SHB_OK;
    for (int i = 1; i < 3; i++)
      if (error_at(s, part[i]) > error_at(s, part[worst])) worst = i;
    int next = finer(s, part[worst]);
    if (next == part[worst]) return SHB_OK;
    part[worst] = next;
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- the study */

/* The setting in which the other ladders stand: all at its finest, harmonics as in the case, or what the first ladder found. */
static void settle_base(study *s) {
  int best = post_cheapest(&s->result, POST_LADDER_HARMONICS);
  if (best < 0) best = post_reference(&s->result, POST_LADDER_HARMONICS);
  if (s->file->mhb.harmonics == 0) s->base.harmonics = s->place[best].setting.harmonics;
}

static shb_status ladders(study *s) {
  SHB_TRY(harmonics_ladder(s));
  SHB_TRY(auto_ladder(s));
  settle_base(s);
  SHB_TRY(accuracy_ladder(s));
  SHB_TRY(modes_ladder(s, true));
  SHB_TRY(modes_ladder(s, false));
  if (s->n_variants > 1) SHB_TRY(mesh_ladder(s));
  return together(s);
}

static bool has_mode(const study *s, const char *mode) {
  return s->options->mode && strcmp(s->options->mode, mode) == 0;
}

/* The modal files; of a parametric blade also those of coarser meshes, and its own anew, so that its cost is known. */
static shb_status make_variants(study *s) {
  static const double factor[MAX_VARIANTS] = {1, 1.6, 1.26, .8};
  const case_file    *file                 = s->file;
  if (file->modal_file || file->mesh_file || has_mode(s, "no-mesh")) {
    s->n_variants = 1;
    return variant_own(file, s->options, &s->variant[0]);
  }
  for (int i = 0; i < MAX_VARIANTS - !has_mode(s, "finer"); i++) {
    shb_progress_show(&s->progress, -1, "mesh and modes, element size times %g", factor[i]);
    s->n_variants++;
    SHB_TRY(variant_make(file, s->options, s->folder, factor[i], &s->variant[i]));
    if (shb_interrupted()) SHB_FAIL(SHB_INTERRUPTED, "interrupted");
  }
  return SHB_OK;
}

/* --force: forget what earlier runs left beside the meshes, whose stages heed --force themselves. */
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

static shb_status prepare(study *s) {
  case_file   copy = *s->file;
  post_output output;
  SHB_CHECK(copy.mhb.parameter == MHB_IN_FREQUENCY, SHB_ERR_INPUT,
            "%s: mhb.vary: converge compares curves over the frequency; leave it out", copy.path);
  s->base = (rung_setting){.harmonics = s->file->mhb.harmonics,
                           .accuracy  = fmin(1e-8, s->file->mhb.tolerance),
                           .modes     = 1,
                           .residuals = true};
  SHB_TRY(rung_apply(&s->base, &copy)); /* of its preloads only */
  s->folder = case_output(s->file, ".converge");
  SHB_CHECK(s->folder, SHB_ERR_IO, "out of memory");
  SHB_TRY(variant_folder(s->folder));
  SHB_TRY(make_variants(s));
  for (int i = 0; s->options->force && i < s->n_variants; i++)
    forget(s->variant[i].folder ? s->variant[i].folder : s->folder);
  SHB_TRY(modal_model_read(s->variant[0].modal, &s->model));
  s->base.modes = s->model.n_modes;
  SHB_TRY(rung_output(s->file, s->model.n_probes, s->model.probe_name, &output));
  s->result.tolerance  = s->file->converge_tolerance;
  s->result.n_preloads = copy.mhb.n_preloads;
  snprintf(s->result.output, sizeof s->result.output, "%s %smotion",
           output.place == POST_PROBE ? s->model.probe_name[output.index] : "contact",
           output.place == POST_PROBE ? "" : "relative ");
  return SHB_OK;
}

static shb_status publish(study *s) {
  char *h5 = case_output(s->file, ".converge.h5"), *csv = case_output(s->file, ".converge.csv");
  char *svg = case_output(s->file, ".converge.svg"), *settings = NULL;
  post_buffer table = {0}, picture = {0};
  shb_status  status =
      h5 && csv && svg ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = converge_settings(s->file, &settings);
  shb_provenance provenance = command_provenance(s->file, settings, "shroudhb-converge");
  if (status == SHB_OK) status = post_convergence_write(&s->result, h5, &provenance);
  post_convergence_csv(&s->result, &table);
  post_convergence_picture(&s->result, s->file->name, &picture);
  if (status == SHB_OK) status = post_buffer_publish(&table, csv);
  if (status == SHB_OK) status = post_buffer_publish(&picture, svg);
  if (status == SHB_OK && !s->options->quiet) printf("\n%s\n%s\n%s\n", csv, svg, h5);
  post_buffer_free(&table);
  post_buffer_free(&picture);
  free(settings);
  free(h5);
  free(csv);
  free(svg);
  return status;
}

static void print_report(const study *s) {
  post_buffer text = {0};
  post_convergence_table(&s->result, s->file->name, &text);
  post_put(&text, "\n");
  post_convergence_conclusion(&s->result, &text);
  if (s->result.note) post_put(&text, "%s", s->result.note);
  if (text.text && !s->options->quiet) fwrite(text.text, 1, text.length, stdout);
  fflush(stdout);
  post_buffer_free(&text);
}

/* Whether a rung failed, or one that others are compared with has a gap. */
static bool in_doubt(const post_convergence *result) {
  for (int i = 0; i < result->n; i++) {
    const post_rung *r = &result->rung[i];
    if (r->state == POST_RUNG_FAILED || (r->reference && r->state != POST_RUNG_DONE)) return true;
  }
  return false;
}

static shb_status run_study(study *s) {
  shb_status status = prepare(s);
  if (status == SHB_OK) status = ladders(s);
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
  study      s      = {.file     = file,
                       .options  = options,
                       .progress = shb_progress_start("converge", options->quiet, options->verbose)};
  shb_status status = run_study(&s);
  for (int i = 0; i < s.result.n; i++) free(s.place[i].stem);
  for (int i = 0; i < s.n_variants; i++) variant_free(&s.variant[i]);
  post_convergence_free(&s.result);
  post_buffer_free(&s.note);
  modal_model_free(&s.model);
  free(s.place);
  free(s.folder);
  return status;
}
