#include "mhb/ring/lasting.h"

#include <limits.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/problem/wave.h"
#include "mhb/ring/side_waves.h"

enum {
  COARSE     = 64,  /* steps a period of the excitation where starts are told apart */
  STEPS      = 256, /* where a motion is measured: 1e-3 of the mean */
  MOST_STEPS = 4096,
  FULL_LANES = 48 /* copies of few blades are stepped side by side up to so many */
};

/* Blocks after which motions that are measured are read. At least so many count for each, of all
 * starts that measure it. */
static const int targets[] = {5, 8, 12, 18, 27, MHB_START_BLOCKS}, LEAST_COUNTED = 6;

static const double DIFFERENT = 2;   /* mhb_motion_distance */
static const double STABLE    = 0.8; /* largest mhb_ring_model_stiffness */
static const double SAME_WAVE = 5e-3, MILD_MEAN = 0.05, MILD_WORST = 1.05, FEW_LINES = 0.65;

/* ---- decision ---- */

static double larger(double a, double b) {
  return a > b ? a : b;
}

/* By the blade that swings furthest. */
static bool is_larger(const mhb_motion *a, const mhb_motion *b) {
  return mhb_motion_worst(a, a->wave) > mhb_motion_worst(b, b->wave);
}

int mhb_lasting_kind_of(int n, const mhb_motion *leader, double share) {
  const double mean = mhb_motion_mean(leader, leader->wave);
  if (n > 1 || (leader->wave && fabs(mean - 1) > SAME_WAVE)) return MHB_LASTING_SEVERAL;
  if (leader->wave) return MHB_LASTING_WAVE;
  if (fabs(mean - 1) < MILD_MEAN && leader->worst < MILD_WORST) return MHB_LASTING_MILD;
  return share < FEW_LINES ? MHB_LASTING_IRREGULAR : MHB_LASTING_MODULATED;
}

/* ---- settling ---- */

/* Copies of the ring that are stepped side by side. */
static int copies_of(int blades) {
  const int copies = FULL_LANES / blades;
  return copies < 1 ? 1 : copies > MHB_LANES ? MHB_LANES : copies;
}

int mhb_ring_steps(mhb_ring_model *model, double omega, int least) {
  for (int steps = least * model->order; steps <= MOST_STEPS * model->order; steps *= 2) {
    mhb_ring_model_set(model, omega, steps);
    if (mhb_ring_model_stiffness(model) < STABLE) return steps;
  }
  return 0;
}

/* All starts beside one wave. */
typedef struct {
  const mhb_wave        *wave;
  const mhb_lasting_run *how;
  mhb_ring_model        *model;
  mhb_starts             starts;
  mhb_motion_group      *group;          /* [MHB_LASTING_MOTIONS] */
  double                 scale, highest; /* m, the wave's peak; of a blade over the mean of all */
  double                *peaks;          /* space: of a start in each copy */
  double                 share;          /* of five lines beside the wave, of the largest motion */
  bool                   stopped;
  mhb_lasting           *result;
} settling;

/* All copies on the wave, in the steps that are set. scale <- mean over the blades of its peak. */
static void start_on_wave(settling *w, mhb_ring_state *wave) {
  mhb_starts *s    = &w->starts;
  const int   used = mhb_ring_model_used(w->model);
  double      sum  = 0;
  mhb_ring_start(&s->ring, w->wave->n_harmonics, w->wave->force);
  if (wave) mhb_ring_save(&s->ring, 0, s->output.space, wave);
  mhb_ring_period(&s->ring);
  mhb_ring_peaks(&s->ring, &s->output);
  for (int l = 0; l < used; l++) sum += s->output.peak[l];
  s->scale = sum / used;
}

/* Of a mistuned ring: the motion of the balance in place of the wave, for the spread. Returns the
 * highest amplitude of a blade over the mean of all; 1 of a wave. */
static double set_pattern(mhb_starts *s, const mhb_wave *wave) {
  const mhb_ring_model *m    = s->ring.model;
  double                most = 0, sum = 0, square = 0;
  double complex        first[3 * m->blades];
  if (!m->ring) return 1;
  mhb_ring_model_first(m, wave->n_harmonics, wave->force, first);
  for (int b = 0; b < m->blades; b++) {
    double own = 0;
    for (int i = 0; i < 3; i++) own += pow(cabs(first[i * m->blades + b]), 2);
    most = fmax(most, sqrt(own));
    sum += sqrt(own) / m->blades;
    square += own / m->blades;
  }
  for (int i = 0; i < 3 * m->blades && square > 0; i++)
    s->pattern[i] = conj(first[i]) / sqrt(square);
  return sum > 0 ? most / sum : 1;
}

/* Samples [period][sample][3][blades] of a mistuned ring: what repeats every period is replaced by
 * a wave of its size. Different amplitudes of the blades are no side waves. */
static void leave_wave(const mhb_ring_model *m, double *y) {
  const int n      = MHB_SIDE_SAMPLES * 3 * m->blades;
  double    square = 0, mean[n];
  for (int i = 0; i < n; i++) {
    mean[i] = 0;
    for (int t = 0; t < MHB_START_LINES; t++) mean[i] += y[t * n + i] / MHB_START_LINES;
    square += mean[i] * mean[i];
  }
  const double size = sqrt(2 * square * 3 / n);
  for (int i = 0; i < n * MHB_START_LINES; i++) {
    const int    b = i % m->blades, axis = i / m->blades % 3, at = i % n / (3 * m->blades);
    const double phase =
        SHB_TWO_PI * (at + 1) / MHB_SIDE_SAMPLES -
        SHB_TWO_PI * mhb_driven_wave_order(mhb_settings_wave(&m->settings)) * b / m->blades;
    y[i] += (axis ? 0 : size * cos(phase)) - mean[i % n];
  }
}

/* Strongest side wave of a start, and the share of five lines in the power beside the wave. */
static void find_side_wave(const mhb_ring_model *m, const mhb_start *s, mhb_lasting *result,
                           double *share) {
  mhb_side_waves found;
  int            periods = MHB_START_LINES, now = s->periods % MHB_START_LINES;
  size_t part = (size_t)MHB_SIDE_SAMPLES * 3 * (size_t)m->blades, size = part * MHB_START_LINES;
  const double *x     = s->sample;
  shb_arena     arena = {0};
  double       *y     = shb_arena_take(&arena, size, sizeof *y); /* oldest first */
  memcpy(y, x + (size_t)now * part, sizeof *y * (size - (size_t)now * part));
  memcpy(y + size - (size_t)now * part, x, sizeof *y * (size_t)now * part);
  if (m->ring) leave_wave(m, y);
  mhb_side_waves_find(
      y, periods, m->blades,
      m->settings.to_ground ? 0 : mhb_driven_wave_order(mhb_settings_wave(&m->settings)), &found);
  shb_arena_free(&arena);
  result->diameter = found.wave[0].diameter;
  result->offset   = found.wave[0].offset;
  *share           = found.share;
}

/* ---- where starts lead ---- */

static void explore(settling *w, mhb_exploration *x) {
  x->starts  = &w->starts;
  x->go_on   = w->how->go_on;
  x->context = w->how->context;
  x->peaks   = w->peaks;
  x->group   = w->group;
  x->last    = -1;
  mhb_explore(x);
  w->stopped = x->stopped;
  w->result->periods += x->periods;
  w->result->error = larger(w->result->error, x->error);
}

/* From disturbed starts, in the steps that are set. patient: none is told apart early. Returns the
 * number of groups. */
static int explore_beside_wave(settling *w, bool patient) {
  mhb_noise       noise = {.state = 20};
  mhb_ring_state  wave  = {.omega = 0};
  mhb_exploration x     = {
          .from = &wave, .noise = &noise, .patient = patient, .most_periods = w->how->most_periods};
  start_on_wave(w, &wave);
  if (w->starts.scale > 0) explore(w, &x);
  w->result->starts = x.told;
  shb_arena_free(&wave.arena);
  return x.n_groups;
}

/* ---- the motions, measured ---- */

/* A motion of the result, whose start is in a copy. It may be one that is known. */
static void take_motion(settling *w, const mhb_motion *m, int copy) {
  mhb_lasting *r    = w->result;
  mhb_starts  *s    = &w->starts;
  bool         lead = true;
  for (int i = 0; i < r->n_motions; i++) {
    lead = lead && is_larger(m, &r->motion[i]);
    if (mhb_motion_distance(&r->motion[i], m) >= 1) continue;
    r->motion[i].starts += m->starts;
    return;
  }
  if (r->n_motions == MHB_LASTING_MOTIONS) return;
  r->motion[r->n_motions++] = *m;
  if (!lead) return;
  find_side_wave(w->model, &s->start[copy], r, &w->share);
  if (w->how->state) mhb_ring_save(&s->ring, copy, s->output.space, w->how->state);
}

/* Groups that are measured side by side: copy c measures group c % n. */
typedef struct {
  const mhb_motion_group *group;
  int                     n;
  int                     copies[MHB_LANES];          /* [n] of each group */
  int                     copy[MHB_LANES][MHB_LANES]; /* [n][copies] */
  mhb_motion              motion[MHB_LANES];          /* [n] */
} measured;

/* From the ends of starts that reached each of n groups. */
static void begin_measuring(settling *w, const mhb_motion_group *group, int n, measured *all) {
  mhb_starts *s = &w->starts;
  *all          = (measured){.group = group, .n = n};
  for (int c = 0; c < w->model->copies; c++) {
    const int               i = c % n, k = c / n;
    const mhb_motion_group *g = &group[i];
    mhb_ring_load(&s->ring, c, &g->state[k % g->n_states], s->output.space);
    mhb_start_begin(s, c);
    s->runs[c] = k < g->n_states;
    if (s->runs[c]) all->copy[i][all->copies[i]++] = c;
  }
}

/* The motion that n copies show together. */
static mhb_motion motion_of(const settling *w, int n, const int *copy) {
  double                   mean[MHB_START_BLOCKS], spread[MHB_START_BLOCKS];
  const int                periods = w->starts.start[copy[0]].periods;
  const mhb_lasting_series series  = mhb_starts_series(&w->starts, n, copy, mean, spread, w->peaks);
  return mhb_motion_of(&series, periods == MHB_START_BLOCKS * MHB_START_BLOCK);
}

static bool is_told(const mhb_motion *m) {
  return m->wave || m->settled;
}

/* Read the motions after some blocks. Returns whether all are told. */
static bool read_motions(const settling *w, int blocks, measured *all) {
  bool told = true;
  for (int i = 0; i < all->n; i++) {
    const int   n = all->copies[i];
    mhb_motion *m = &all->motion[i];
    *m            = motion_of(w, n, all->copy[i]);
    m->starts     = all->group[i].motion.starts;
    told          = told && is_told(m) && n * (blocks - blocks / 2) >= LEAST_COUNTED;
  }
  return told || blocks == MHB_START_BLOCKS;
}

/* Take the motion of a group; each copy's own where one differs. *far: they differ, or it is not
 * the motion that the starts showed. */
static void take_measured(settling *w, const measured *all, int i, bool *far) {
  const mhb_motion *m = &all->motion[i], *shown = &all->group[i].motion;
  const int         n = all->copies[i];
  mhb_motion        own[MHB_LANES];
  bool              differ = false;
  for (int k = 0; k < n && n > 1; k++) {
    own[k]        = motion_of(w, 1, &all->copy[i][k]);
    own[k].starts = k > 0 ? 1 : m->starts - (n - 1);
    differ        = differ || (is_told(&own[k]) && mhb_motion_distance(&own[k], m) > DIFFERENT);
  }
  *far =
      *far || differ || (is_told(m) && is_told(shown) && mhb_motion_distance(m, shown) > DIFFERENT);
  for (int k = 0; k < (differ ? n : 1); k++) take_motion(w, differ ? &own[k] : m, all->copy[i][k]);
}

/* Measure n groups, as many as there are copies at most. *far: one is another motion than its
 * starts showed. */
static void measure(settling *w, const mhb_motion_group *group, int n, bool *far) {
  measured all;
  begin_measuring(w, group, n, &all);
  for (int t = 0, blocks = 0; t == 0 || !read_motions(w, blocks, &all); t++)
    for (; blocks < targets[t]; blocks++) {
      w->stopped = !mhb_starts_block(&w->starts, w->how->go_on, w->how->context);
      if (w->stopped) return;
      for (int i = 0; i < n; i++) w->result->periods += all.copies[i] * MHB_START_BLOCK;
    }
  for (int i = 0; i < n; i++) take_measured(w, &all, i, far);
}

static bool measure_all(settling *w, int n) {
  const int copies     = w->model->copies;
  bool      far        = false;
  w->result->n_motions = 0;
  start_on_wave(w, NULL);
  w->scale = w->starts.scale;
  for (int i = 0; i < n && !w->stopped; i += copies)
    measure(w, w->group + i, n - i < copies ? n - i : copies, &far);
  return far;
}

/* The numbers of the result from the motions that were reached. */
static void report(settling *w) {
  mhb_lasting      *r    = w->result;
  const mhb_motion *most = &r->motion[0], *least = most;
  for (int i = 1; i < r->n_motions; i++) {
    if (is_larger(&r->motion[i], most)) most = &r->motion[i];
    if (is_larger(least, &r->motion[i])) least = &r->motion[i];
  }
  r->mean    = mhb_motion_mean(most, most->wave);
  r->worst   = mhb_motion_worst(most, most->wave) / (most->wave ? 1 : w->highest);
  r->error   = larger(r->error, mhb_motion_error(most, most->wave));
  r->reached = most->starts;
  r->size    = mhb_motion_worst(most, most->wave) * w->scale * (most->wave ? w->highest : 1);
  r->kind    = mhb_lasting_kind_of(r->n_motions, most, w->share);
  if (r->n_motions == 1) return;
  r->least       = mhb_motion_mean(least, least->wave);
  r->least_worst = mhb_motion_worst(least, least->wave) / (least->wave ? 1 : w->highest);
}

/* Starts are told apart in coarse steps. A motion that is another one when it is measured was told
 * too early, or the steps are too coarse: all is done again then. */
static void settle(settling *w, const int steps[2]) {
  bool far = true;
  for (int i = 0; i < 2 && far && !w->stopped; i++) {
    mhb_motion_groups_free(w->group, MHB_LASTING_MOTIONS);
    memset(w->group, 0, MHB_LASTING_MOTIONS * sizeof *w->group);
    w->result->error = 0;
    mhb_ring_model_set(w->model, w->wave->omega, steps[i]);
    const int n = explore_beside_wave(w, i > 0);
    if (w->stopped || n == 0) return;
    mhb_ring_model_set(w->model, w->wave->omega, steps[1]);
    far = measure_all(w, n);
  }
  if (!w->stopped) report(w);
}

/* One start from the state of a neighbour. It is no start of chance, so it does not count. */
static void carry(settling *w) {
  mhb_lasting      *r      = w->result;
  const mhb_lasting before = *r;
  mhb_exploration   x      = {.from = w->how->from, .n_groups = r->n_motions};
  for (int i = 0; i < r->n_motions; i++) w->group[i].motion = r->motion[i];
  start_on_wave(w, NULL);
  w->scale = w->starts.scale;
  explore(w, &x);
  if (w->stopped || x.n_groups == before.n_motions) {
    *r = before;
    return;
  }
  mhb_motion m = w->group[before.n_motions].motion;
  m.starts     = 0;
  take_motion(w, &m, x.last);
  report(w);
}

static void run(settling *w, const int steps[2]) {
  const size_t most  = (size_t)(MHB_START_BLOCKS * MHB_START_BLOCK) * (size_t)w->model->blades;
  shb_arena    arena = {0};
  w->peaks   = shb_arena_take(&arena, most / 2 * (size_t)w->model->copies, sizeof *w->peaks);
  w->group   = shb_arena_take(&arena, MHB_LASTING_MOTIONS, sizeof *w->group);
  w->highest = set_pattern(&w->starts, w->wave);
  if (w->how->from)
    carry(w);
  else
    settle(w, steps);
  mhb_motion_groups_free(w->group, MHB_LASTING_MOTIONS);
  shb_arena_free(&arena);
}

double mhb_lasting_bytes(int blades, int pairs, int modes, bool mistuned) {
  enum { OF_A_PAIR = 9 + 5, OF_OUTPUT = 1 + 6 + 3 + 6, FREE = 12 }; /* numbers a blade */
  const int    copies  = copies_of(blades);
  const double most    = modes + 6. * pairs; /* with merged ones */
  const double samples = MHB_START_LINES * MHB_SIDE_SAMPLES * 3;
  const double peaks   = MHB_START_BLOCKS * MHB_START_BLOCK;
  const double state   = 4 * most + OF_A_PAIR * pairs + OF_OUTPUT + 3 * MHB_RING_SAMPLES;
  const double kept    = MHB_LASTING_MOTIONS * (2 * most + 8 * pairs); /* ends of starts */
  const double lines = samples + 2 * samples + 2 * MHB_START_LINES; /* in order, spectrum, power */
  const double model = mistuned ? most * (1 + MHB_RING_LANE_SIZE + MHB_RING_MAP) : 0;
  return sizeof(double) * (mhb_whole_lanes(blades * copies) *
                               (state + model + FREE * (pairs + 1) + peaks + samples + peaks / 2) +
                           blades * (lines + kept));
}

shb_status mhb_lasting_settle(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, const mhb_lasting_run *how,
                              mhb_lasting *result) {
  static const mhb_lasting_run plain  = {.go_on = NULL};
  settling                     w      = {.wave = wave, .how = how ? how : &plain, .result = result};
  const double                 lowest = wave->lowest > 0 ? wave->lowest : wave->omega;
  const int copies = w.how->from ? 1 : copies_of(settings->to_ground ? 1 : settings->blades);
  if (!w.how->from) *result = (mhb_lasting){.diameter = -1};
  SHB_TRY(mhb_ring_model_create_copies(modal, settings, wave->n0, lowest, copies, &w.model));
  const int coarse = mhb_ring_steps(w.model, wave->omega, COARSE);
  const int steps  = mhb_ring_steps(w.model, wave->omega, STEPS);
  if (steps > 0) {
    mhb_starts_create(w.model, &w.starts);
    run(&w, (int[2]){coarse, steps});
  }
  if (w.stopped && !w.how->from) *result = (mhb_lasting){.diameter = -1};
  mhb_starts_destroy(&w.starts);
  mhb_ring_model_destroy(w.model);
  return SHB_OK;
}
