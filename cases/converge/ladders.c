#include "cases/converge/ladders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/stage.h"
#include "mhb/branches/harmonic_selection.h"

enum { MAX_TOGETHER = 6 };

static const double ALIKE = .15; /* relative difference of times that is within their scatter */

static const double DEFAULT_TOLERANCE =
    1e-4; /* tolerance of the motion with auto, if the case has none */

/* ---------------------------------------------------------------- one rung */

static char *stem_of(const convergence_study *s, const rung_setting *setting, int v) {
  char        name[RUNG_WORD];
  const char *folder = s->variant[v].folder ? s->variant[v].folder : s->folder;
  rung_name(setting, name);
  size_t size = strlen(folder) + strlen(name) + 2;
  char  *stem = malloc(size);
  if (stem) snprintf(stem, size, "%s/%s", folder, name);
  return stem;
}

static shb_status add(convergence_study *s, post_ladder ladder, const rung_setting *setting, int v,
                      const char *name) {
  post_rung *row = post_convergence_add(&s->result);
  if (row && s->result.n > s->capacity) {
    int        room  = s->capacity ? 2 * s->capacity : 32;
    study_row *grown = realloc(s->row, (size_t)room * sizeof *grown);
    if (grown) {
      s->row      = grown;
      s->capacity = room;
    } else {
      row = NULL;
    }
  }
  SHB_CHECK(row, SHB_ERR_IO, "out of memory");
  study_row *p = &s->row[s->result.n - 1];
  *p           = (study_row){.setting = *setting, .variant = v, .stem = stem_of(s, setting, v)};
  SHB_CHECK(p->stem, SHB_ERR_IO, "out of memory");
  row->ladder = ladder;
  snprintf(row->name, sizeof row->name, "%s", name);
  return SHB_OK;
}

static void take_cost(convergence_study *s, int i) {
  study_row          *p    = &s->row[i];
  post_rung          *row  = &s->result.rung[i];
  const mesh_variant *v    = &s->variant[p->variant];
  bool                mesh = row->ladder == POST_LADDER_MESH;
  row->state               = p->cost.complete ? POST_RUNG_DONE : POST_RUNG_INCOMPLETE;
  row->unknowns            = mesh ? v->unknowns : p->cost.unknowns;
  row->seconds             = p->cost.seconds + (mesh ? v->seconds : 0);
  row->total               = row->seconds + p->cost.setup;
  row->memory              = mesh ? fmax(p->cost.memory, v->memory) : p->cost.memory;
}

/* Points by time integration are the reference of ladders that reach the finest harmonics. */
static const char *points_for(const convergence_study *s, const post_rung *row) {
  bool whole = row->ladder == POST_LADDER_HARMONICS || row->ladder == POST_LADDER_AUTO ||
               row->ladder == POST_LADDER_TOGETHER;
  return whole ? s->points : NULL;
}

/* Runs a rung as a child. Its last files are the stem of the reference or "-", and the points of
 * time integration. */
static shb_status start_rung(convergence_study *s, const study_row *p, const char *reference,
                             const char *points, shb_child_end *end) {
  char               setting[RUNG_SETTING_WORDS][RUNG_WORD];
  const char        *words[COMMAND_WORDS];
  const command_row *row  = command_row_of(COMMAND_RUNG);
  command_options    said = {.path = s->file->path, .into = s->options->into};
  said.text               = s->options->text;
  said.n_set              = s->options->n_set;
  memcpy(said.set, s->options->set, sizeof said.set);
  int n      = options_words(row, &said, words, stage_program(COMMAND_RUNG, words));
  words[n++] = s->variant[p->variant].modal;
  words[n++] = p->stem;
  rung_words(&p->setting, setting);
  for (int i = 0; i < RUNG_SETTING_WORDS; i++) words[n++] = setting[i];
  words[n++]        = reference ? reference : "-";
  words[n++]        = points ? points : "-";
  words[n]          = NULL;
  shb_child child   = shb_child_of((char *const *)words);
  child.name        = "shroudhb-rung";
  shb_status status = shb_child_run(&child, end);
  free((void *)words[0]);
  return status;
}

/* Reads the errors that the program of the rung has written. */
static void take_errors(convergence_study *s, int i, int reference) {
  study_row  *p   = &s->row[i];
  post_rung  *row = &s->result.rung[i];
  rung_error  error;
  const char *points = points_for(s, row);
  if (points && rung_error_read(p->stem, "integration", points, &error) == SHB_OK) {
    row->integration   = error.n > 0 ? error.curve : NAN;
    s->result.n_points = error.n;
  }
  if (reference < 0) return;
  const char *other = s->row[reference].stem;
  char       *path  = rung_response(other);
  if (path && rung_error_read(p->stem, rung_leaf(other), path, &error) == SHB_OK) {
    rung_peak_errors(&p->cost, &s->row[reference].cost, &row->peak, &row->frequency);
    row->curve = error.curve;
  }
  free(path);
}

/* Runs row i and compares it with row reference (-1: none). A rung that does not converge, or that
 * is killed, affects only its row. What is refused or cannot be written would fail in every row. */
static shb_status run(convergence_study *s, int i, int reference) {
  study_row    *p   = &s->row[i];
  post_rung    *row = &s->result.rung[i];
  shb_child_end result;
  shb_progress_show(&s->progress, -1, "%s %s", post_ladder_name(row->ladder), row->name);
  const char *other  = reference >= 0 ? s->row[reference].stem : NULL;
  shb_status  status = start_rung(s, p, other, points_for(s, row), &result);
  if ((status == SHB_OK && result.code == SHB_INTERRUPTED) || shb_interrupted())
    SHB_FAIL(SHB_INTERRUPTED, "interrupted; the rungs so far are kept and used again");
  shb_progress_clear(&s->progress);
  if (status != SHB_OK) fprintf(stderr, "shroudhb: warning: %s\n", shb_message());
  if (status == SHB_OK && (result.code == SHB_ERR_INPUT || result.code == SHB_ERR_IO))
    return shb_fail(result.code, __FILE__, __LINE__, "%s", ""); /* the child has said why */
  if (status != SHB_OK || result.code != 0 || rung_cost_read(p->stem, &p->cost) != SHB_OK) {
    row->state = POST_RUNG_FAILED;
    return SHB_OK;
  }
  take_cost(s, i);
  take_errors(s, i, reference);
  shb_progress_note(&s->progress, "%s %s: %.3g s, %d points", post_ladder_name(row->ladder),
                    row->name, p->cost.seconds, p->cost.points);
  return SHB_OK;
}

/* Runs the rows from first on; the last one is their reference. */
static shb_status run_ladder(convergence_study *s, int first) {
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

/* Predicted seconds of the next rung: the cost of the solver grows at most like H^1.8. */
static double predict(double seconds, int from, int to) {
  return seconds * pow((double)to / from, 1.8);
}

static shb_status harmonics_ladder(convergence_study *s) {
  mhb_settings wide = s->file->mhb;
  int          m[MHB_MAX_LEVELS + 1], first = s->result.n, own = s->file->mhb.harmonics;
  wide.motion_tolerance = 1;
  int  n                = mhb_harmonic_levels_ladder(&s->model, &wide, m);
  bool there            = own == 0;
  while (m[n - 1] > mhb_harmonic_levels_usual(n, m)) n--;
  for (int i = 0; i < n; i++) there = there || m[i] == own;
  if (!there) m[n++] = own;
  qsort(m, (size_t)n, sizeof *m, by_size);
  for (int i = 0; i < n; i++) {
    char         name[16];
    rung_setting setting = s->base;
    setting.harmonics    = m[i];
    setting.tolerance    = 0;
    double next = i == 0 ? 0 : predict(s->row[s->result.n - 1].cost.seconds, m[i - 1], m[i]);
    /* one rung, its reference, and the setting of the case */
    bool enough = i >= 2 && m[i - 1] >= own;
    if (enough && next > s->file->converge_seconds) {
      post_put(&s->note,
               "The ladder of harmonics ends at %d: %d would take about %.2g s "
               "(converge.seconds is %g).\n",
               m[i - 1], m[i], next, s->file->converge_seconds);
      break;
    }
    snprintf(name, sizeof name, "%d", m[i]);
    SHB_TRY(add(s, POST_LADDER_HARMONICS, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = m[i] == own;
    SHB_TRY(
        /* upwards, because the time of a rung decides whether the next is affordable */
        run(s, s->result.n - 1, -1));
  }
  return run_ladder(s, first);
}

static shb_status auto_ladder(convergence_study *s) {
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
    snprintf(name, sizeof name, "tolerance %g", tolerance[i]);
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

static shb_status accuracy_ladder(convergence_study *s) {
  double value[4] = {1e-3, 1e-5, 1e-8}, own = s->file->mhb.tolerance;
  int    n = 3, first = s->result.n, at = 0;
  while (at < n && value[at] > own) at++;
  if (at == n || value[at] != own) { /* the setting of the case among them, descending */
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

static shb_status modes_ladder(convergence_study *s, bool residuals) {
  static const int wanted[] = {1, 2, 3, 5, 8, 12, 20, 30, 50, 80, 120, 200, 300, 500, 1000};
  int              all = s->model.n_modes, first = s->result.n;
  bool             has = s->model.residual_flexibility || s->model.load_residual;
  if (residuals && all == 1) return SHB_OK;
  for (size_t i = 0; i <= sizeof wanted / sizeof *wanted; i++) {
    int          modes = i < sizeof wanted / sizeof *wanted && wanted[i] < all ? wanted[i] : all;
    char         name[16];
    rung_setting setting = s->base;
    if (!residuals && !has && modes == all) break; /* this is the reference */
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

/* Runs the meshes from the coarsest on. */
static shb_status mesh_ladder(convergence_study *s) {
  const mesh_blade *blade = &s->file->blade;
  int               first = s->result.n, order[STUDY_VARIANTS];
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

/* The pairs of the modal file joined to 1, 2, 4, ... patches; the reference has them all. */
static shb_status points_ladder(convergence_study *s) {
  const int all = s->n_pairs, first = s->result.n,
            own        = s->base.patches > 0 ? s->base.patches : all;
  const int interfaces = s->model.n_interfaces > 1 ? s->model.n_interfaces : 1;
  if (modal_joinable(&s->model) < 1 || all <= interfaces) return SHB_OK;
  for (int patches = interfaces; first == s->result.n || patches < 2 * all; patches *= 2) {
    char         name[16];
    rung_setting setting = s->base;
    const int    points  = patches < all ? patches : all;
    setting.patches      = points < all ? points : 0;
    snprintf(name, sizeof name, "%d", points);
    SHB_TRY(add(s, POST_LADDER_POINTS, &setting, 0, name));
    s->result.rung[s->result.n - 1].of_case = points == own;
  }
  return run_ladder(s, first);
}

/* ---------------------------------------------------------------- settings combined */

static double error_at(const convergence_study *s, int i) {
  double error = i < 0 ? NAN : post_rung_error(&s->result.rung[i]);
  return isnan(error) ? 0 : error;
}

/* Of the best rungs of two ladders the cheaper one. If their times are alike, the one with the
 * smaller error. If neither has a best rung, the reference of the first. */
static int pick(const convergence_study *s, post_ladder one, post_ladder other) {
  int a = post_cheapest(&s->result, one), b = post_cheapest(&s->result, other);
  if (a < 0 && b < 0) return post_reference(&s->result, one);
  if (a < 0 || b < 0) return a < 0 ? b : a;
  const post_rung *ra = &s->result.rung[a], *rb = &s->result.rung[b];
  if (fabs(ra->seconds / rb->seconds - 1) < ALIKE)
    return post_rung_error(ra) <= post_rung_error(rb) ? a : b;
  return ra->seconds < rb->seconds ? a : b;
}

/* The rung of the same ladder with the next smaller error; the finest if there is none. */
static int finer(const convergence_study *s, int i) {
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

/* Combines the parts of three rungs to one setting with a name. */
static rung_setting combine(const convergence_study *s, const int part[3],
                            char name[POST_RUNG_NAME]) {
  const rung_setting *h   = &s->row[part[0]].setting;
  rung_setting        out = *h;
  char                harmonics[24];
  out.accuracy  = part[1] < 0 ? s->base.accuracy : s->row[part[1]].setting.accuracy;
  out.modes     = part[2] < 0 ? s->base.modes : s->row[part[2]].setting.modes;
  out.residuals = part[2] < 0 ? true : s->row[part[2]].setting.residuals;
  snprintf(harmonics, sizeof harmonics, "%d harmonic%s", h->harmonics,
           h->harmonics == 1 ? "" : "s");
  if (h->harmonics == 0) snprintf(harmonics, sizeof harmonics, "auto at %g", h->tolerance);
  snprintf(name, POST_RUNG_NAME, "%s, %.12s, %d mode%s%s", harmonics,
           part[1] < 0 ? "exact" : s->result.rung[part[1]].name, out.modes,
           out.modes == 1 ? "" : "s", out.residuals ? "" : ", no residual");
  return out;
}

/* Combines the cheapest rung of each ladder. While the sum of the errors is too large, the part
 * with the largest error is taken one rung finer. */
static shb_status together(convergence_study *s) {
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

/* ---------------------------------------------------------------- all */

/* The base setting of the other ladders: everything at its finest, with the harmonics of the case
 * or those that the first ladder has found. */
static void settle_base(convergence_study *s) {
  int best = post_cheapest(&s->result, POST_LADDER_HARMONICS);
  if (best < 0) best = post_reference(&s->result, POST_LADDER_HARMONICS);
  if (s->file->mhb.harmonics == 0) s->base.harmonics = s->row[best].setting.harmonics;
}

shb_status ladders_run(convergence_study *s) {
  SHB_TRY(harmonics_ladder(s));
  SHB_TRY(auto_ladder(s));
  settle_base(s);
  SHB_TRY(accuracy_ladder(s));
  SHB_TRY(modes_ladder(s, true));
  SHB_TRY(modes_ladder(s, false));
  if (s->n_variants > 1) SHB_TRY(mesh_ladder(s));
  SHB_TRY(points_ladder(s));
  return together(s);
}
