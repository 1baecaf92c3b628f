#include "mhb/branches/lasting_motion.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/parameter.h"
#include "mhb/ring/slow_sweep.h"

/* Share of the wave's peak below which no sweep is made; what a sweep goes on beyond the last
 * modulated point, relative. */
static const double PART_OF_PEAK = 0.4, BEYOND = 1e-3;

/* Points settled inside the modulated part, beside the peaks. */
enum { BETWEEN = 1 };

/* Points of auto nearer than this to a settled one are left out, relative: a quarter of the
 * half-power bandwidth at 0.2 % of damping. */
static const double SAME_PLACE = 1e-3;

/* Operations a period of 256 steps that auto allows: some 10 ms. */
static const double MOST_WORK = 2e8;

/* Operations that auto allows all starts of a point: a thousand such periods. */
static const double MOST_POINT_WORK = 2e11;

/* A neighbour's motion is larger than a point's own: by more than percentiles differ. */
static const double LARGER = 1.03;

/* A point that is settled. */
typedef struct {
  int            point;
  mhb_lasting    found;
  mhb_ring_state state; /* of the largest motion */
  mhb_ring_state next;  /* that of this pass, if its omega is not 0 */
  double         size;  /* m, of the largest motion after the last pass */
  bool           fresh; /* that motion was found then */
} settled;

/* One branch. */
typedef struct {
  mhb_response  *curves;
  mhb_branch    *branch;
  double        *size;      /* [point] m, output of the wave */
  bool          *asked;     /* [point] modulated or not judged, and large enough for the sweep */
  bool          *modulated; /* [point] */
  int            n_asked, n_modulated, n_points; /* n_points: settled */
  settled       *at;                             /* [n_points] by rising frequency */
  mhb_slow_sweep sweep;
  int            most_periods; /* of all starts of a point; 0: any */
  double         lowest;       /* Hz, of the points that are computed */
  const char    *refused;      /* NULL: computed */
  bool           stopped, stiff;
} work;

typedef struct {
  work *of;
  int   which; /* of its settled points */
} task;

typedef struct {
  const modal_model      *model;
  const mhb_settings     *settings;
  const mhb_lasting_host *host;
  int                     n, n_tasks, done, total;
  work                   *work;   /* [n] */
  task                   *tasks;  /* [n_tasks] */
  shb_status              status; /* the first failure */
  char                    text[512];
} lasting;

/* ---- choice ---- */

/* A point that no verdict calls stable may be modulated: the sweep covers it. */
static bool is_unjudged(const mhb_response *r, const mhb_branch *b, int point) {
  return b->stable[point] < 0 && !mhb_response_is_linear(r, b, point);
}

static bool is_modulated(const mhb_response *r, const mhb_branch *b, int point) {
  bool pair = b->loss[point] == MHB_LOSS_FLIP || b->loss[point] == MHB_LOSS_NEIMARK_SACKER;
  return b->stable[point] == 0 && pair && !mhb_response_is_linear(r, b, point);
}

/* Amplitude of the output; of a mistuned ring that of the blade that swings highest, m. */
static double size_of(const mhb_response *r, const mhb_branch *b, int point) {
  const int blades = r->ring > 0 ? r->ring : 1;
  const int each   = (r->n_probes > 0 ? r->n_probes : r->n_pairs) / blades;
  double    most   = 0;
  for (int blade = 0; blade < blades; blade++)
    most = fmax(most, mhb_response_amplitude(r, b, point, blade * each));
  return most;
}

const char *mhb_lasting_refusal(const modal_model *model, const mhb_settings *s) {
  if (s->lasting == MHB_LASTING_NEVER) return "not computed: mhb.lasting is never";
  if (model->coriolis) return "not computed: the fast integration knows no Coriolis terms";
  if (s->nodal_diameters)
    return "not computed: the fast integration knows no blades that a disc couples";
  if (s->run_up) return "not computed: in a run-up each frequency has a structure of its own";
  if (s->parameter != MHB_IN_FREQUENCY)
    return "not computed: the curves are not over the frequency";
  if (s->stability == MHB_STABILITY_NEVER)
    return "not computed: stability was not judged (mhb.stability is never)";
  return NULL;
}

static void choose(const lasting *l, work *w) {
  const mhb_branch *b    = w->branch;
  double            peak = 0;
  w->refused             = mhb_lasting_refusal(l->model, l->settings);
  if (w->refused) return;
  w->size      = shb_alloc_zeroed((size_t)b->n_points, sizeof *w->size);
  w->asked     = shb_alloc_zeroed((size_t)b->n_points, sizeof *w->asked);
  w->modulated = shb_alloc_zeroed((size_t)b->n_points, sizeof *w->modulated);
  for (int i = 0; i < b->n_points; i++) {
    w->size[i] = size_of(w->curves, b, i);
    peak       = fmax(peak, w->size[i]);
  }
  for (int i = 0; i < b->n_points; i++) {
    w->modulated[i] = is_modulated(w->curves, b, i);
    bool covered    = w->modulated[i] || is_unjudged(w->curves, b, i);
    w->asked[i]     = covered && w->size[i] >= PART_OF_PEAK * peak;
    w->n_modulated += w->modulated[i];
    w->n_asked += w->asked[i];
    if ((w->modulated[i] || w->asked[i]) && (w->lowest == 0 || b->frequency[i] < w->lowest))
      w->lowest = b->frequency[i];
  }
  if (w->n_modulated == 0) w->refused = "nothing to compute: no point is modulated";
}

/* Refuse, with auto, rings whose periods take too long. */
static shb_status weigh(const lasting *l, work *w) {
  mhb_ring_model   *model;
  const mhb_branch *b = w->branch;
  if (w->refused || l->settings->lasting == MHB_LASTING_ALWAYS) return SHB_OK;
  SHB_TRY(
      mhb_ring_model_create(l->model, l->settings, b->n0[0], SHB_TWO_PI * b->frequency[0], &model));
  const double period = 256 * model->order * mhb_ring_model_work(model);
  w->most_periods     = (int)fmin(MOST_POINT_WORK / period, INT_MAX);
  if (period > MOST_WORK)
    w->refused = "not computed: the ring is too large; mhb.lasting: always computes it";
  mhb_ring_model_destroy(model);
  return SHB_OK;
}

static mhb_wave wave_at(const work *w, int point) {
  const mhb_branch *b   = w->branch;
  size_t            row = 3 * (size_t)w->curves->n_pairs * ((size_t)b->n_harmonics + 1);
  return (mhb_wave){.omega       = SHB_TWO_PI * b->frequency[point],
                    .n0          = b->n0[point],
                    .lowest      = SHB_TWO_PI * w->lowest,
                    .n_harmonics = b->n_harmonics,
                    .force       = b->force + (size_t)point * row};
}

/* ---- the sweep ---- */

/* Point of the lowest or highest frequency that the sweep covers. */
static int end_of(const work *w, int sign) {
  int best = -1;
  for (int i = 0; i < w->branch->n_points; i++)
    if (w->asked[i] &&
        (best < 0 || sign * (w->branch->frequency[i] - w->branch->frequency[best]) > 0))
      best = i;
  return best;
}

static void mark(work *w, int point, bool *settle) {
  if (point < 0 || settle[point]) return;
  settle[point] = true;
  w->n_points++;
}

/* Modulated point nearest to a frequency; of several the largest. */
static int nearest(const work *w, double hz) {
  int    best = -1;
  double gap  = INFINITY;
  for (int i = 0; i < w->branch->n_points; i++) {
    double apart = fabs(w->branch->frequency[i] - hz);
    if (!w->modulated[i] || apart > gap || (apart == gap && w->size[i] < w->size[best])) continue;
    best = i;
    gap  = apart;
  }
  return best;
}

static int largest(const work *w) {
  int best = -1;
  for (int i = 0; i < w->branch->n_points; i++)
    if (w->modulated[i] && (best < 0 || w->size[i] > w->size[best])) best = i;
  return best;
}

/* Mark a point unless a marked one is near. */
static void mark_apart(work *w, int point, bool *settle) {
  const double *f = w->branch->frequency;
  for (int i = 0; point >= 0 && i < w->branch->n_points; i++)
    if (settle[i] && fabs(f[i] - f[point]) < SAME_PLACE * f[point]) return;
  mark(w, point, settle);
}

static void choose_points(const lasting *l, work *w, double swept, bool *settle) {
  const mhb_branch *b = w->branch;
  mark(w, largest(w), settle);
  if (swept > 0) mark_apart(w, nearest(w, swept), settle);
  if (w->n_asked > 0) {
    double low = b->frequency[end_of(w, -1)], high = b->frequency[end_of(w, 1)];
    for (int i = 1; i <= BETWEEN; i++)
      mark_apart(w, nearest(w, low + (high - low) * i / (BETWEEN + 1)), settle);
  }
  for (int i = 0; i < b->n_points && l->settings->lasting == MHB_LASTING_ALWAYS; i++)
    if (w->modulated[i]) mark(w, i, settle);
}

static void store_sweep(const mhb_slow_sweep *sweep, mhb_branch *branch) {
  mhb_lasting_curve *c    = &branch->lasting_curve;
  size_t             size = sizeof(double) * (size_t)sweep->n;
  mhb_response_lasting_curve(branch, sweep->n);
  if (sweep->n == 0) return;
  memcpy(c->frequency, sweep->frequency, size);
  memcpy(c->mean, sweep->mean, size);
  memcpy(c->worst, sweep->worst, size);
}

/* A failure of this thread, if it is the first. Under the lock. */
static void note(lasting *l, shb_status status) {
  if (status == SHB_OK || l->status != SHB_OK) return;
  l->status = status;
  snprintf(l->text, sizeof l->text, "%s", shb_message());
}

static bool goes_on(const lasting *l) {
  return l->host->go_on(l->host->context);
}

static void lock(const lasting *l, bool locked) {
  l->host->lock(l->host->context, locked);
}

static shb_status stored(lasting *l, const work *w, double hz) {
  l->done++;
  return l->host->stored(l->host->context, (double)l->done / l->total, w->branch->n0[0], hz);
}

/* The sweep of a branch, and the choice of its points. */
static void sweep_branch(lasting *l, work *w, bool *settle) {
  shb_status status = SHB_OK;
  int        low    = end_of(w, -1);
  if (low >= 0) {
    mhb_wave wave = wave_at(w, low);
    double   high = w->branch->frequency[end_of(w, 1)] * (1 + BEYOND);
    status        = mhb_slow_sweep_run(l->model, l->settings, &wave, high, l->host->go_on,
                                       l->host->context, &w->sweep);
  }
  lock(l, true);
  w->stopped = !goes_on(l);
  if (status == SHB_OK && !w->stopped) {
    store_sweep(&w->sweep, w->branch);
    choose_points(l, w, w->sweep.n > 0 ? w->sweep.largest : 0, settle);
    status = stored(l, w, low < 0 ? w->branch->frequency[0] : w->branch->frequency[low]);
  }
  note(l, status);
  lock(l, false);
}

/* ---- points ---- */

/* Under the lock. */
static void store_point(work *w, const settled *s) {
  mhb_branch        *b      = w->branch;
  const mhb_lasting *found  = &s->found;
  const int          i      = s->point;
  w->stiff                  = w->stiff || found->kind == MHB_LASTING_UNKNOWN;
  b->lasting_kind[i]        = found->kind;
  b->lasting_mean[i]        = found->mean;
  b->lasting_worst[i]       = found->worst;
  b->lasting_error[i]       = found->error;
  b->lasting_side[i]        = found->kind == MHB_LASTING_UNKNOWN ? 0 : found->diameter;
  b->lasting_offset[i]      = found->offset;
  b->lasting_periods[i]     = found->periods;
  b->lasting_starts[i]      = found->starts;
  b->lasting_reached[i]     = found->reached;
  b->lasting_least[i]       = found->least;
  b->lasting_least_worst[i] = found->least_worst;
}

/* Start from a state if its motion is larger. */
static shb_status carry(const lasting *l, const work *w, settled *s, const mhb_ring_state *from,
                        double size) {
  const mhb_wave  wave = wave_at(w, s->point);
  mhb_lasting_run how  = {l->host->go_on, l->host->context, 0, from, &s->next};
  if (s->found.kind == MHB_LASTING_UNKNOWN || size <= LARGER * s->found.size) return SHB_OK;
  return mhb_lasting_settle(l->model, l->settings, &wave, &how, &s->found);
}

/* From the window of the sweep that is nearest. */
static shb_status carry_sweep(const lasting *l, const work *w, settled *s) {
  const mhb_slow_sweep *sweep = &w->sweep;
  const double          at    = w->branch->frequency[s->point];
  int                   best  = 0;
  for (int i = 1; i < sweep->n; i++)
    if (fabs(sweep->frequency[i] - at) < fabs(sweep->frequency[best] - at)) best = i;
  if (sweep->n == 0) return SHB_OK;
  return carry(l, w, s, &sweep->state[best], sweep->worst[best]);
}

/* The state of this pass, if there is one, is that of the point. */
static void take_state(settled *s) {
  s->fresh = s->next.omega > 0;
  if (!s->fresh) return;
  shb_arena_free(&s->state.arena);
  s->state = s->next;
  s->next  = (mhb_ring_state){.omega = 0};
}

static void settle_point(lasting *l, const task *t) {
  work           *w      = t->of;
  settled        *s      = &w->at[t->which];
  const mhb_wave  wave   = wave_at(w, s->point);
  mhb_lasting_run how    = {l->host->go_on, l->host->context, w->most_periods, NULL, &s->next};
  shb_status      status = mhb_lasting_settle(l->model, l->settings, &wave, &how, &s->found);
  if (status == SHB_OK) status = carry_sweep(l, w, s);
  lock(l, true);
  if (!goes_on(l)) w->stopped = true;
  if (status == SHB_OK && !w->stopped) {
    store_point(w, s);
    status = stored(l, w, w->branch->frequency[s->point]);
  }
  note(l, status);
  lock(l, false);
}

static void sort_points(work *w) {
  const double *f = w->branch->frequency;
  for (int i = 1; i < w->n_points; i++) {
    const int point = w->at[i].point;
    int       to    = i;
    for (; to > 0 && f[w->at[to - 1].point] > f[point]; to--) w->at[to].point = w->at[to - 1].point;
    w->at[to].point = point;
  }
}

static void list_tasks(lasting *l, bool *const *settle) {
  int n = 0;
  for (int i = 0; i < l->n; i++) n += l->work[i].n_points;
  l->tasks = shb_alloc_zeroed((size_t)n, sizeof *l->tasks);
  for (int i = 0; i < l->n; i++) {
    work *w = &l->work[i];
    int   k = 0;
    if (!settle[i]) continue;
    w->at = shb_alloc_zeroed((size_t)w->n_points, sizeof *w->at);
    for (int p = 0; p < w->branch->n_points; p++)
      if (settle[i][p]) w->at[k++].point = p;
    sort_points(w);
    for (k = 0; k < w->n_points; k++) l->tasks[l->n_tasks++] = (task){w, k};
  }
  l->total += n;
}

/* ---- neighbours ---- */

/* One point: from the neighbours whose larger motion is fresh. */
static void visit_neighbours(lasting *l, const task *t) {
  work      *w      = t->of;
  settled   *s      = &w->at[t->which];
  const int  n      = s->found.n_motions;
  shb_status status = SHB_OK;
  for (int side = -1; side <= 1 && status == SHB_OK; side += 2) {
    const int other = t->which + side;
    if (other < 0 || other >= w->n_points || !w->at[other].fresh) continue;
    status = carry(l, w, s, &w->at[other].state, w->at[other].size);
  }
  lock(l, true);
  if (!goes_on(l)) w->stopped = true;
  if (status == SHB_OK && !w->stopped && s->found.n_motions > n) store_point(w, s);
  note(l, status);
  lock(l, false);
}

/* A pass over all points carries motions from each to the next; it ends when none is new. */
static void carry_on(lasting *l) {
  for (bool more = true; more && goes_on(l) && l->status == SHB_OK;) {
    more = false;
    for (int i = 0; i < l->n_tasks; i++) {
      settled *s = &l->tasks[i].of->at[l->tasks[i].which];
      take_state(s);
      s->size = s->found.size;
      more    = more || s->fresh;
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(l->host->threads)
    for (int i = 0; i < l->n_tasks; i++)
      if (more && goes_on(l)) visit_neighbours(l, &l->tasks[i]);
  }
}

/* What was computed, or why not. A branch that was stopped has no text. */
static void set_text(const work *w) {
  char text[160];
  if (!w->branch || w->stopped) return;
  snprintf(text, sizeof text, "%d point%s of %d modulated%s", w->n_points,
           w->n_points == 1 ? "" : "s", w->n_modulated,
           w->branch->lasting_curve.n > 0 ? ", and a sweep" : "");
  const char *said = w->refused ? w->refused : text;
  if (w->stiff) said = "not computed: the contacts are too stiff for 4096 steps a period";
  w->branch->lasting = shb_text(said);
}

/* ---- all branches ---- */

static shb_status prepare(lasting *l, mhb_response *const *curves, bool **settle) {
  for (int i = 0; i < l->n; i++) {
    work *w = &l->work[i];
    if (!curves[i] || curves[i]->branch[0].lasting || curves[i]->branch[0].n_points == 0) continue;
    w->curves = curves[i];
    w->branch = &curves[i]->branch[0];
    choose(l, w);
    SHB_TRY(weigh(l, w));
    if (w->refused) continue;
    settle[i] = shb_alloc_zeroed((size_t)w->branch->n_points, sizeof **settle);
    l->total++;
  }
  return SHB_OK;
}

static shb_status run(lasting *l, mhb_response *const *curves, bool **settle) {
  SHB_TRY(prepare(l, curves, settle));
#pragma omp parallel for schedule(dynamic, 1) num_threads(l->host->threads)
  for (int i = 0; i < l->n; i++)
    if (settle[i] && goes_on(l)) sweep_branch(l, &l->work[i], settle[i]);
  if (l->status == SHB_OK) list_tasks(l, settle);
#pragma omp parallel for schedule(dynamic, 1) num_threads(l->host->threads)
  for (int i = 0; i < l->n_tasks; i++)
    if (goes_on(l)) settle_point(l, &l->tasks[i]);
  carry_on(l);
  if (l->status != SHB_OK) return shb_fail(l->status, __FILE__, __LINE__, "%s", l->text);
  for (int i = 0; i < l->n; i++) {
    l->work[i].stopped = l->work[i].stopped || !goes_on(l);
    set_text(&l->work[i]);
  }
  return SHB_OK;
}

static void release(work *w) {
  for (int i = 0; w->at && i < w->n_points; i++) {
    shb_arena_free(&w->at[i].state.arena);
    shb_arena_free(&w->at[i].next.arena);
  }
  mhb_slow_sweep_destroy(&w->sweep);
  free(w->at);
  free(w->size);
  free(w->asked);
  free(w->modulated);
}

shb_status mhb_lasting_motion(const modal_model *model, const mhb_settings *settings, int n,
                              mhb_response *const *curves, const mhb_lasting_host *host) {
  lasting l               = {.model = model, .settings = settings, .host = host, .n = n};
  bool  **settle          = shb_alloc_zeroed((size_t)n, sizeof *settle);
  l.work                  = shb_alloc_zeroed((size_t)n, sizeof *l.work);
  const shb_status status = run(&l, curves, settle);
  for (int i = 0; i < n; i++) {
    free(settle[i]);
    release(&l.work[i]);
  }
  free(l.work);
  free(l.tasks);
  free(settle);
  return status;
}
