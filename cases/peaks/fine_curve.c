#include "cases/peaks/fine_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "postproc/analysis/response_analysis.h"

/* Points of the coarse curve below 1 - SLACK - SPREAD error of its highest are not sampled, but at
 * least below LEAST. The error is the largest at its maxima, or UNKNOWN where one has no fine
 * solution. Three harmonics are 8 % off on z_notch_blade at low preloads, 0.1 % at high ones.
 * Between maxima they lack narrow superharmonic resonances of a contact that slips all the time.
 * One such peak of 400 random contacts is 3.5 % above the coarse curve, which is 2.4 % below its
 * highest there. A SLACK of 0.03 is not enough. */
static const double SLACK = 0.05, SPREAD = 3, LEAST = 0.6, UNKNOWN = 0.1;
/* Part of the highest point from which on a maximum of the coarse curve is high. */
static const double HIGH = 0.9;
/* A curve with few harmonics is checked at each STRIDE-th point above this part of its highest, or
 * at each STRIDE_SLIPPING-th where no contact opens. It may lack superharmonic resonances. Of 300
 * random contacts of z_notch_blade four missed a peak that is 1 to 37 % higher. There 2.3 to 36 %
 * of the points had no fine solution. A limit of a tenth misses one by 36 %, at half the cost of
 * low preloads. One that only slips missed one by 15 %, where a third of the points had none.
 * STRIDE_SLIPPING and MOST_LOST_SLIPPING, half of that part, rest on this design alone. */
static const double LOW = 0.15, MOST_LOST = 0.02, MOST_LOST_SLIPPING = 0.15;
enum { STRIDE = 3, STRIDE_SLIPPING = 8, FEW = 9 };
/* Accuracy of the samples: of the contact law, and of the residual. */
static const double LAW = 1e-3, RESIDUAL = 1e-5;
/* Between samples above this part of the highest there is one more. */
static const double HALVED = 0.98;
/* Samples below this part of the highest are no candidates. A step of the coarse curve turns by at
 * most 0.35 rad and changes the motion by at most a tenth. A peak between samples is then less than
 * 5 % higher than they are. */
static const double CANDIDATE = 0.93;
enum { MOST_MAXIMA = 8, MOST_OUTWARDS = 20 };

typedef struct {
  double           place; /* along the branch, in points */
  double           coarse, found[2];
  bool             solved;
  matched_solution solution;
} sample;

/* The samples of one branch, by rising place; those of several runs may follow one another. */
typedef struct {
  const mhb_branch *branch;
  double           *coarse; /* [point] m */
  int               n, capacity;
  sample           *list;
  point_matcher    *matcher;
} fine_branch;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  const mhb_response *response;
  post_output         output;
  int                 harmonics, n; /* branches with samples */
  fine_branch        *branch;
  double              top, best, missed; /* m: of the coarse curve, of the samples */
  double              error;             /* of the coarse curve at its maxima, relative */
  double              unsolved; /* m, the highest of them without a fine solution beside it */
  double              high[2];  /* Hz, as of fine_maxima */
} work;

int fine_harmonics(const mhb_settings *settings, const mhb_branch *branch, int harmonics) {
  if (harmonics > 0) return harmonics * branch->order;
  int own = settings->harmonics / settings->subharmonics * branch->order;
  return own > 0 ? own : branch->order;
}

/* ---------------------------------------------------------------- samples at points */

static sample *append(fine_branch *b) {
  if (b->n == b->capacity) {
    int     more = b->capacity ? 2 * b->capacity : 64;
    sample *list = realloc(b->list, (size_t)more * sizeof *list);
    if (!list) return NULL;
    b->list     = list;
    b->capacity = more;
  }
  b->list[b->n] = (sample){0};
  return &b->list[b->n++];
}

static shb_status keep(work *w, fine_branch *b, sample *s) {
  SHB_TRY(point_matcher_keep(b->matcher, &s->solution));
  s->solved = true;
  w->best   = fmax(w->best, s->found[1]);
  return SHB_OK;
}

static curve_place place_of(const fine_branch *b, int point) {
  int last = b->branch->n_points - 1;
  return (curve_place){
      b->branch, point, point, point > 0 ? point - 1 : 0, point < last ? point + 1 : last, 0};
}

/* Sample the plane across the coarse curve at a point, from the sample before or from the point. */
static shb_status sample_point(work *w, fine_branch *b, int point) {
  curve_place place = place_of(b, point);
  sample     *s     = append(b);
  SHB_CHECK(s, SHB_ERR_IO, "out of memory");
  s->place  = point;
  s->coarse = b->coarse[point];
  bool next = b->n > 1 && b->list[b->n - 2].place == point - 1;
  if ((next && point_matcher_follow(b->matcher, &place, s->found)) ||
      point_matcher_solve(b->matcher, &place, false, s->found))
    return keep(w, b, s);
  return SHB_OK;
}

/* Whether the samples still rise towards their end. */
static bool rises(const fine_branch *b) {
  if (b->n < 2) return false;
  const sample *s = &b->list[b->n - 2];
  return s[0].solved && s[1].solved && s[1].found[1] > s[0].found[1];
}

static bool is_maximum(const fine_branch *b, int i) {
  const double own = b->coarse[i];
  return !(i > 0 && b->coarse[i - 1] > own) &&
         !(i < b->branch->n_points - 1 && b->coarse[i + 1] >= own);
}

/* The error of the coarse curve at its own maxima. */
static void measure_error(work *w, fine_branch *b) {
  for (int i = 0; i < b->branch->n_points; i++) {
    const double own = b->coarse[i];
    double       found[2];
    if (own < (1 - SPREAD * UNKNOWN) * w->top || !is_maximum(b, i)) continue;
    curve_place place = place_of(b, i);
    bool        good  = point_matcher_solve(b->matcher, &place, false, found);
    w->error          = fmax(w->error, good ? fabs(found[1] / own - 1) : UNKNOWN);
    if (!good) w->unsolved = fmax(w->unsolved, own);
  }
}

/* Whether a contact of a branch opens for a part of the period, at a point that is not low. */
static bool opens(const work *w, const fine_branch *b) {
  const int n = w->response->n_pairs;
  for (int i = 0; i < b->branch->n_points; i++)
    for (int a = 0; a < n && b->coarse[i] >= LOW * w->top; a++) {
      double open = b->branch->state[3 * (i * n + a) + 2];
      if (open > 0 && open < 1) return true;
    }
  return false;
}

/* The part of a branch's points without a fine solution. */
static double part_lost(const work *w, const fine_branch *b, int stride) {
  int checked = 0, lost = 0;
  for (int i = 0; i < b->branch->n_points; i += stride) {
    double      found[2];
    curve_place place = place_of(b, i);
    if (b->coarse[i] < LOW * w->top) continue;
    checked++;
    lost += !point_matcher_solve(b->matcher, &place, false, found);
  }
  return checked > 0 ? (double)lost / checked : 0;
}

/* Whether the curve with few harmonics is left without a fine solution at more than a few of its
 * points. It may then lack the highest peak. */
static bool is_doubtful(const work *w) {
  for (int k = 0; k < w->n && w->harmonics <= FEW; k++) {
    const fine_branch *b          = &w->branch[k];
    const bool         by_opening = opens(w, b);
    if (part_lost(w, b, by_opening ? STRIDE : STRIDE_SLIPPING) >
        (by_opening ? MOST_LOST : MOST_LOST_SLIPPING))
      return true;
  }
  return false;
}

/* All points that may be high, each with its neighbours. */
static shb_status sample_points(work *w, fine_branch *b) {
  int    n = b->branch->n_points, outwards = 0;
  double least = w->top * fmax(LEAST, 1 - SLACK - SPREAD * w->error);
  for (int i = 0; i < n; i++) {
    double high = b->coarse[i];
    if (i > 0) high = fmax(high, b->coarse[i - 1]);
    if (i < n - 1) high = fmax(high, b->coarse[i + 1]);
    bool own  = high >= least;
    bool more = !own && b->n > 0 && b->list[b->n - 1].place == i - 1 && rises(b) &&
                outwards++ < MOST_OUTWARDS;
    if (own) outwards = 0;
    if (own || more) SHB_TRY(sample_point(w, b, i));
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- samples between them */

static int by_place(const void *left, const void *right) {
  const sample *a = left, *b = right;
  return (a->place > b->place) - (a->place < b->place);
}

/* A sample half-way between two of one curve; s: where it goes. */
static shb_status halve(work *w, fine_branch *b, const sample *low, const sample *high, sample *s) {
  const matched_solution *const chord[2] = {&low->solution, &high->solution};
  if (!point_matcher_between(b->matcher, chord[0], chord[1], 0.5, chord, s->found)) return SHB_OK;
  return keep(w, b, s);
}

/* A point without a fine solution. */
static void miss(work *w, const fine_branch *b, const sample *s) {
  const double at = b->branch->frequency[(int)s->place];
  w->missed       = fmax(w->missed, s->coarse);
  if (s->coarse < HIGH * (w->best > 0 ? w->best : w->top)) return;
  w->high[0] = fmin(w->high[0], at);
  w->high[1] = fmax(w->high[1], at);
}

/* Points without a solution, from their neighbours. What remains is missed. */
static shb_status fill_gaps(work *w, fine_branch *b) {
  for (int i = 0; i < b->n; i++) {
    sample *s = &b->list[i];
    if (!s->solved && i > 0 && i < b->n - 1 && s[-1].solved && s[1].solved &&
        s[1].place - s[-1].place == 2)
      SHB_TRY(halve(w, b, &s[-1], &s[1], s));
    if (!s->solved) miss(w, b, s);
  }
  return SHB_OK;
}

static shb_status halve_steps(work *w, fine_branch *b) {
  int n = b->n;
  for (int i = 0; i + 1 < n; i++) {
    const sample low = b->list[i], high = b->list[i + 1];
    bool         pair = low.solved && high.solved && high.place - low.place <= 1;
    if (!pair || fmax(low.found[1], high.found[1]) < HALVED * w->best) continue;
    sample *s = append(b);
    SHB_CHECK(s, SHB_ERR_IO, "out of memory");
    s->place = 0.5 * (low.place + high.place);
    SHB_TRY(halve(w, b, &low, &high, s));
  }
  if (b->n > 0) qsort(b->list, (size_t)b->n, sizeof *b->list, by_place);
  return SHB_OK;
}

/* ---------------------------------------------------------------- maxima */

/* The next solved sample from i, in sense -1 or 1, no more than a step away; NULL: none. */
static const sample *beside(const fine_branch *b, int i, int sense) {
  double here = b->list[i].place;
  for (int k = i + sense; k >= 0 && k < b->n; k += sense) {
    if (fabs(b->list[k].place - here) > 2) return NULL;
    if (b->list[k].solved) return &b->list[k];
  }
  return NULL;
}

static shb_status copy(const matched_solution *from, size_t size, matched_solution *to) {
  *to   = *from;
  to->x = malloc(size);
  SHB_CHECK(to->x, SHB_ERR_IO, "out of memory");
  memcpy(to->x, from->x, size);
  return SHB_OK;
}

static shb_status take(const work *w, const fine_branch *b, int i, fine_maxima *out) {
  const sample *s = &b->list[i], *before = beside(b, i, -1), *after = beside(b, i, 1);
  bool          end = s->place == 0 || s->place == b->branch->n_points - 1;
  double        low = before ? before->found[1] : -1, high = after ? after->found[1] : -1;
  if (!s->solved || s->found[1] < low || s->found[1] <= high) return SHB_OK;
  if (s->found[1] < CANDIDATE * w->best || !((before && after) || end)) return SHB_OK;
  int at = out->n;
  while (at > 0 && out->list[at - 1].found[1] < s->found[1]) at--;
  if (at == MOST_MAXIMA) return SHB_OK;
  fine_maximum m    = {.branch = b->branch,
                       .point  = (int)s->place,
                       .edge   = end,
                       .found  = {s->found[0], s->found[1]},
                       .beside = {low, high}};
  size_t       size = (size_t)w->response->n_pairs * 3 * (1 + 2 * (size_t)s->solution.harmonics) *
                sizeof *s->solution.x;
  shb_status status = copy(&s->solution, size, &m.at);
  if (status == SHB_OK && !end) status = copy(&before->solution, size, &m.before);
  if (status == SHB_OK && !end) status = copy(&after->solution, size, &m.after);
  if (out->n == MOST_MAXIMA) {
    fine_maximum *last = &out->list[--out->n];
    matched_solution_free(&last->before);
    matched_solution_free(&last->at);
    matched_solution_free(&last->after);
  }
  for (int k = out->n++; k > at; k--) out->list[k] = out->list[k - 1];
  out->list[at] = m;
  return status;
}

/* ---------------------------------------------------------------- all branches */

static shb_status open_branch(work *w, const mhb_branch *branch) {
  fine_branch *b   = &w->branch[w->n];
  mhb_settings own = *w->settings;
  own.subharmonics = branch->order;
  *b               = (fine_branch){.branch = branch};
  SHB_TRY(post_series(w->response, branch, w->output, POST_QUANTITY_FIRST_HARMONIC, &b->coarse));
  w->n++;
  own.tolerance = fmax(own.tolerance, LAW);
  for (int i = 0; i < branch->n_points; i++) w->top = fmax(w->top, b->coarse[i]);
  SHB_TRY(point_matcher_create(w->model, &own, fine_harmonics(w->settings, branch, w->harmonics),
                               w->output, &b->matcher));
  point_matcher_set_tolerance(b->matcher, RESIDUAL);
  return SHB_OK;
}

static shb_status sample_all(work *w, bool hasty, fine_maxima *out) {
  for (int k = 0; k < w->response->n_branches; k++) {
    const mhb_branch *branch = &w->response->branch[k];
    if (branch->kind == MHB_BRANCH_NONLINEAR && branch->n_points > 0)
      SHB_TRY(open_branch(w, branch));
  }
  for (int k = 0; k < w->n; k++) measure_error(w, &w->branch[k]);
  out->missed = hasty && is_doubtful(w) ? w->top : w->unsolved;
  if (hasty && out->missed > HIGH * w->top) return SHB_OK;
  for (int k = 0; k < w->n; k++) SHB_TRY(sample_points(w, &w->branch[k]));
  for (int k = 0; k < w->n; k++) SHB_TRY(fill_gaps(w, &w->branch[k]));
  for (int k = 0; k < w->n; k++) SHB_TRY(halve_steps(w, &w->branch[k]));
  out->missed  = w->missed;
  out->high[0] = w->high[0];
  out->high[1] = w->high[1];
  for (int k = 0; k < w->n; k++)
    for (int i = 0; i < w->branch[k].n; i++) SHB_TRY(take(w, &w->branch[k], i, out));
  return SHB_OK;
}

shb_status fine_maxima_find(const modal_model *model, const mhb_settings *settings,
                            const mhb_response *coarse, post_output output, int harmonics,
                            bool hasty, fine_maxima *out) {
  work w            = {.model     = model,
                       .settings  = settings,
                       .response  = coarse,
                       .output    = output,
                       .harmonics = harmonics,
                       .high      = {INFINITY, -INFINITY}};
  *out              = (fine_maxima){.high = {INFINITY, -INFINITY}};
  w.branch          = calloc((size_t)coarse->n_branches + 1, sizeof *w.branch);
  out->list         = calloc(MOST_MAXIMA + 1, sizeof *out->list); /* one may be appended */
  shb_status status = w.branch && out->list
                          ? sample_all(&w, hasty, out)
                          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  for (int k = 0; k < w.n; k++) {
    for (int i = 0; i < w.branch[k].n; i++) matched_solution_free(&w.branch[k].list[i].solution);
    free(w.branch[k].list);
    free(w.branch[k].coarse);
    point_matcher_destroy(w.branch[k].matcher);
  }
  free(w.branch);
  return status;
}

shb_status fine_maxima_append(const mhb_response *coarse, const solved_peak *peak,
                              fine_maxima *out) {
  static const double     wide   = 2e-3; /* of the bracket in frequency, relative */
  const matched_solution *s      = &peak->solution;
  const mhb_branch       *branch = NULL;
  size_t size = (size_t)coarse->n_pairs * 3 * (1 + 2 * (size_t)s->harmonics) * sizeof *s->x;
  for (int k = coarse->n_branches - 1; k >= 0; k--)
    if (coarse->branch[k].kind == MHB_BRANCH_NONLINEAR && coarse->branch[k].order == peak->order)
      branch = &coarse->branch[k];
  if (!s->x || !branch) return SHB_OK;
  fine_maximum *m = &out->list[out->n++];
  *m              = (fine_maximum){.branch = branch, .walked = true};
  m->found[0]     = s->omega / SHB_TWO_PI;
  m->found[1]     = peak->amplitude;
  SHB_TRY(copy(s, size, &m->before));
  SHB_TRY(copy(s, size, &m->at));
  SHB_TRY(copy(s, size, &m->after));
  m->before.omega *= 1 - wide;
  m->after.omega *= 1 + wide;
  return SHB_OK;
}

void fine_maxima_free(fine_maxima *m) {
  for (int i = 0; i < m->n; i++) {
    matched_solution_free(&m->list[i].before);
    matched_solution_free(&m->list[i].at);
    matched_solution_free(&m->list[i].after);
  }
  free(m->list);
  *m = (fine_maxima){0};
}
