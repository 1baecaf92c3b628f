#include "mhb/ring/lasting.h"

#include <limits.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/ring/side_waves.h"

enum {
  SLOTS          = 3,   /* the first two starts, and one after the other */
  SEVERAL_BLOCKS = 27,  /* settled starts that still differ are different motions */
  STEPS          = 256, /* a period of the excitation: 1e-3 of the mean */
  MOST_STEPS     = 4096
};

/* Blocks after which starts are compared. */
static const int targets[] = {12, 18, SEVERAL_BLOCKS, MHB_START_BLOCKS};

/* A further start is only compared with motions that are known: 8 blocks leave four that count. */
static const int further[] = {8, 12, 18, SEVERAL_BLOCKS, MHB_START_BLOCKS};

static const double LEAST_START = 0.03, MOST_START = 0.1; /* relative disturbances */
static const double DIFFERENT = 2;                        /* mhb_motion_distance */
static const double STABLE    = 0.8;                      /* largest mhb_ring_model_stiffness */
static const double SAME_WAVE = 5e-3, MILD_MEAN = 0.05, MILD_WORST = 1.05, FEW_LINES = 0.65;

/* ---- decision ---- */

static double larger(double a, double b) {
  return a > b ? a : b;
}

/* By the blade that swings furthest. */
static bool is_larger(const mhb_motion *a, const mhb_motion *b) {
  return mhb_motion_worst(a, a->wave) > mhb_motion_worst(b, b->wave);
}

/* Both starts as one motion. */
static mhb_motion joined(const mhb_motion *a, const mhb_motion *b) {
  return (mhb_motion){.wave        = a->wave && b->wave,
                      .settled     = a->settled && b->settled,
                      .starts      = a->starts + b->starts,
                      .half        = {.mean  = 0.5 * (a->half.mean + b->half.mean),
                                      .error = larger(a->half.error, b->half.error)},
                      .last        = 0.5 * (a->last + b->last),
                      .worst       = 0.5 * (a->worst + b->worst),
                      .worst_error = larger(a->worst_error, b->worst_error)};
}

int mhb_lasting_judge(const mhb_lasting_series series[2], bool last, mhb_motion motion[2],
                      int *lead) {
  for (int i = 0; i < 2; i++) motion[i] = mhb_motion_of(&series[i], last);
  const mhb_motion *a = &motion[0], *b = &motion[1];
  const bool        told = (a->wave && b->wave) || (a->settled && b->settled);
  const double      away = mhb_motion_distance(a, b);
  *lead                  = is_larger(b, a);
  if (told && away > DIFFERENT && (last || series[0].blocks >= SEVERAL_BLOCKS)) return 2;
  if (!(told && away < 1) && !last) return 0;
  motion[0] = joined(a, b);
  return 1;
}

int mhb_lasting_kind_of(int n, const mhb_motion *leader, double share) {
  const double mean = mhb_motion_mean(leader, leader->wave);
  if (n > 1 || (leader->wave && fabs(mean - 1) > SAME_WAVE)) return MHB_LASTING_SEVERAL;
  if (leader->wave) return MHB_LASTING_WAVE;
  if (fabs(mean - 1) < MILD_MEAN && leader->worst < MILD_WORST) return MHB_LASTING_MILD;
  return share < FEW_LINES ? MHB_LASTING_IRREGULAR : MHB_LASTING_MODULATED;
}

/* ---- settling ---- */

shb_status mhb_ring_steps(mhb_ring_model *model, double omega, int least, int *steps) {
  for (*steps = least * model->order; *steps <= MOST_STEPS * model->order; *steps *= 2) {
    SHB_TRY(mhb_ring_model_set(model, omega, *steps));
    if (mhb_ring_model_stiffness(model) < STABLE) return SHB_OK;
  }
  *steps = 0;
  return SHB_OK;
}

/* All starts beside one wave. */
typedef struct {
  const mhb_wave        *wave;
  const mhb_lasting_run *how;
  mhb_ring_model        *model;
  mhb_start              slot[SLOTS];
  int                    lead, next;     /* slots of the largest motion, and of the next start */
  double                 scale, highest; /* m, the wave's peak; of a blade over the mean of all */
  double                *peaks;          /* space: of two starts */
  bool                   stopped;
  mhb_lasting           *result;
} settling;

/* Mean over the blades of the wave's own peak, in the same steps. */
static double wave_peak(mhb_start *s, const mhb_wave *wave) {
  double sum = 0;
  mhb_ring_start(&s->ring, wave->n_harmonics, wave->force);
  mhb_ring_period(&s->ring);
  mhb_ring_peaks(&s->ring, &s->output);
  for (int b = 0; b < s->ring.model->blades; b++) sum += s->output.peak[b];
  return sum / s->ring.model->blades;
}

/* Of a mistuned ring: the motion of the balance in place of the wave, for the spread. Returns the
 * highest amplitude of a blade over the mean of all; 1 of a wave. */
static double set_pattern(mhb_start s[SLOTS], const mhb_wave *wave) {
  const mhb_ring_model *m    = s[0].ring.model;
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
    for (int k = 0; k < SLOTS; k++) s[k].pattern[i] = conj(first[i]) / sqrt(square);
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
    const double phase = SHB_TWO_PI * (at + 1) / MHB_SIDE_SAMPLES -
                         SHB_TWO_PI * m->settings.engine_order * b / m->blades;
    y[i] += (axis ? 0 : size * cos(phase)) - mean[i % n];
  }
}

/* Strongest side wave of a start, and the share of five lines in the power beside the wave. */
static shb_status find_side_wave(const mhb_start *s, mhb_lasting *result, double *share) {
  const mhb_ring_model *m = s->ring.model;
  mhb_side_waves        found;
  int                   periods = MHB_START_LINES, now = s->periods % MHB_START_LINES;
  size_t part = (size_t)MHB_SIDE_SAMPLES * 3 * (size_t)m->blades, size = part * MHB_START_LINES;
  const double *x     = s->sample;
  shb_arena     arena = {0};
  double       *y     = shb_arena_take(&arena, size, sizeof *y); /* oldest first */
  SHB_CHECK(y, SHB_ERR_IO, "out of memory for side waves");
  memcpy(y, x + (size_t)now * part, sizeof *y * (size - (size_t)now * part));
  memcpy(y + size - (size_t)now * part, x, sizeof *y * (size_t)now * part);
  if (m->ring) leave_wave(m, y);
  shb_status status = mhb_side_waves_find(
      y, periods, m->blades, m->settings.to_ground ? 0 : m->settings.engine_order, &found);
  shb_arena_free(&arena);
  SHB_TRY(status);
  result->diameter = found.wave[0].diameter;
  result->offset   = found.wave[0].offset;
  *share           = found.share;
  return SHB_OK;
}

/* false: stopped. */
static bool advance(settling *w, int slot, int blocks) {
  const mhb_lasting_run *how = w->how;
  const int              old = w->slot[slot].periods;
  const bool go = mhb_start_advance(&w->slot[slot], blocks, w->scale, how->go_on, how->context);
  w->result->periods += w->slot[slot].periods - old;
  w->stopped = w->stopped || !go;
  return go;
}

static void disturb(settling *w, int slot, double size, mhb_noise *noise) {
  mhb_start *s = &w->slot[slot];
  mhb_start_begin(s);
  mhb_ring_start(&s->ring, w->wave->n_harmonics, w->wave->force);
  mhb_ring_disturb(&s->ring, &s->output, size, noise);
}

/* The first two starts, side by side, say what is to be expected. */
static void first_two(settling *w, mhb_noise *noise) {
  mhb_lasting *r    = w->result;
  const size_t most = MHB_START_BLOCKS * MHB_START_BLOCK * (size_t)w->model->blades;
  disturb(w, 0, LEAST_START, noise);
  disturb(w, 1, MOST_START, noise);
  for (int t = 0; r->n_motions == 0; t++) {
    mhb_lasting_series both[2];
    for (size_t i = 0; i < 2; i++) {
      if (!advance(w, (int)i, targets[t])) return;
      both[i] = mhb_start_series(&w->slot[i], w->peaks + i * most);
    }
    r->n_motions = mhb_lasting_judge(both, targets[t] == MHB_START_BLOCKS, r->motion, &w->lead);
  }
  r->starts = 2;
}

/* Take a motion that no start has reached before; the slot may become that of the largest. */
static void take_motion(settling *w, const mhb_motion *m) {
  mhb_lasting *r    = w->result;
  bool         lead = true;
  if (r->n_motions == MHB_LASTING_MOTIONS) return;
  for (int i = 0; i < r->n_motions; i++) lead = lead && is_larger(m, &r->motion[i]);
  r->motion[r->n_motions++] = *m;
  if (!lead) return;
  const int overtaken = w->lead;
  w->lead             = w->next;
  w->next             = overtaken;
}

/* The motion that is nearest, and its distance. */
static int nearest(const mhb_lasting *r, const mhb_motion *m, double *away) {
  int best = 0;
  *away    = INFINITY;
  for (int i = 0; i < r->n_motions; i++) {
    const double d = mhb_motion_distance(&r->motion[i], m);
    if (d < *away) best = i;
    *away = fmin(d, *away);
  }
  return best;
}

/* A further start, in its slot, until it is told apart: it has reached a motion that is known, or
 * another one. What does not settle is no start that counts, but leaves its error. */
static void further_start(settling *w) {
  mhb_lasting *r = w->result;
  mhb_motion   m = {.starts = 1};
  for (size_t t = 0; t < sizeof further / sizeof *further; t++) {
    const bool last = further[t] == MHB_START_BLOCKS;
    if (!advance(w, w->next, further[t])) return;
    const mhb_lasting_series series = mhb_start_series(&w->slot[w->next], w->peaks);
    m                               = mhb_motion_of(&series, last);
    double     away;
    const int  known = nearest(r, &m, &away);
    const bool told  = m.wave || m.settled;
    if (told && away > DIFFERENT && further[t] >= SEVERAL_BLOCKS) {
      take_motion(w, &m);
    } else if ((told && away < 1) || (last && away <= DIFFERENT)) {
      r->motion[known].starts++;
    } else {
      continue;
    }
    r->starts++;
    return;
  }
  r->error = larger(r->error, m.half.error);
}

static void further_starts(settling *w, mhb_noise *noise) {
  const int most = w->how->most_periods > 0 ? w->how->most_periods : INT_MAX;
  for (int i = 1; i < MHB_LASTING_STARTS - 1 && !w->stopped && w->result->periods < most; i++) {
    disturb(w, w->next, LEAST_START + (MOST_START - LEAST_START) * i / (MHB_LASTING_STARTS - 1),
            noise);
    further_start(w);
  }
}

/* The numbers of the result from the motions that were reached. */
static const mhb_motion *report(const settling *w) {
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
  if (r->n_motions == 1) return most;
  r->kind        = MHB_LASTING_SEVERAL;
  r->least       = mhb_motion_mean(least, least->wave);
  r->least_worst = mhb_motion_worst(least, least->wave) / (least->wave ? 1 : w->highest);
  return most;
}

/* The result with side wave and state of the largest motion. */
static shb_status finish(settling *w) {
  const mhb_motion *most  = report(w);
  const mhb_start  *s     = &w->slot[w->lead];
  double            share = 0;
  SHB_TRY(find_side_wave(s, w->result, &share));
  w->result->kind = mhb_lasting_kind_of(w->result->n_motions, most, share);
  return w->how->state ? mhb_ring_save(&s->ring, w->how->state) : SHB_OK;
}

static shb_status settle(settling *w) {
  mhb_noise noise = {.state = 20};
  first_two(w, &noise);
  if (!w->stopped) further_starts(w, &noise);
  return w->stopped ? SHB_OK : finish(w);
}

/* One start from the state of a neighbour. It is no start of chance, so it does not count. */
static shb_status carry(settling *w) {
  mhb_lasting      *r      = w->result;
  const mhb_lasting before = *r;
  const int         slot   = w->next;
  mhb_start        *s      = &w->slot[slot];
  mhb_start_begin(s);
  mhb_ring_load(&s->ring, w->how->from, s->output.space);
  further_start(w);
  if (r->n_motions == before.n_motions) {
    *r = before;
    return SHB_OK;
  }
  r->starts                          = before.starts;
  r->motion[before.n_motions].starts = 0;
  if (w->lead == slot) return finish(w);
  report(w);
  return SHB_OK;
}

static shb_status run(settling *w) {
  const size_t most  = (size_t)(MHB_START_BLOCKS * MHB_START_BLOCK) * (size_t)w->model->blades;
  shb_arena    arena = {0};
  w->peaks           = shb_arena_take(&arena, 2 * most, sizeof *w->peaks);
  SHB_CHECK(w->peaks, SHB_ERR_IO, "out of memory");
  w->scale          = wave_peak(&w->slot[0], w->wave);
  w->highest        = set_pattern(w->slot, w->wave);
  shb_status status = SHB_OK;
  if (w->scale > 0) status = w->how->from ? carry(w) : settle(w);
  shb_arena_free(&arena);
  return status;
}

double mhb_lasting_bytes(int blades, int pairs, int modes, bool mistuned) {
  enum { OF_A_PAIR = 9 + 5, OF_OUTPUT = 1 + 6 + 3 + 6, FREE = 12 }; /* numbers a blade */
  const double most    = modes + 6. * pairs;                        /* with merged ones */
  const double samples = MHB_START_LINES * MHB_SIDE_SAMPLES * 3;
  const double peaks   = MHB_START_BLOCKS * MHB_START_BLOCK;
  const double state   = 4 * most + OF_A_PAIR * pairs + OF_OUTPUT + 3 * MHB_RING_SAMPLES;
  const double lines = samples + 2 * samples + 2 * MHB_START_LINES; /* in order, spectrum, power */
  const double model = mistuned ? most * (1 + MHB_RING_LANE_SIZE + MHB_RING_MAP) : 0;
  return sizeof(double) * mhb_whole_lanes(blades) *
         (SLOTS * (peaks + samples + state) + fmax(2 * peaks, lines) + model + FREE * (pairs + 1));
}

shb_status mhb_lasting_settle(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, const mhb_lasting_run *how,
                              mhb_lasting *result) {
  static const mhb_lasting_run plain = {.go_on = NULL};
  settling w = {.wave = wave, .how = how ? how : &plain, .next = 2, .result = result};
  int      steps;
  if (!w.how->from) *result = (mhb_lasting){.diameter = -1};
  const double lowest = wave->lowest > 0 ? wave->lowest : wave->omega;
  SHB_TRY(mhb_ring_model_create(modal, settings, wave->n0, lowest, &w.model));
  shb_status status = mhb_ring_steps(w.model, wave->omega, STEPS, &steps);
  for (int i = 0; i < SLOTS && status == SHB_OK && steps > 0; i++)
    status = mhb_start_create(w.model, &w.slot[i]);
  if (status == SHB_OK && steps > 0) status = run(&w);
  if (w.stopped && !w.how->from) *result = (mhb_lasting){.diameter = -1};
  for (int i = 0; i < SLOTS; i++) mhb_start_destroy(&w.slot[i]);
  mhb_ring_model_destroy(w.model);
  return status;
}
