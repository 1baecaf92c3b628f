#include "mhb/ring/lasting.h"

#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/ring/ring_output.h"
#include "mhb/ring/ring_statistics.h"
#include "mhb/ring/side_waves.h"

enum {
  STARTS         = 2,
  BLOCK          = 25, /* periods */
  MOST_BLOCKS    = 40,
  SEVERAL_BLOCKS = 27,  /* settled starts that still differ are different motions */
  STEPS          = 256, /* a period of the excitation: 1e-3 of the mean */
  MOST_STEPS     = 4096,
  LINE_PERIODS   = 64 /* a line is known to 1e-3 of the frequency */
};

static const int    targets[]     = {12, 18, 27, MOST_BLOCKS};
static const double START[STARTS] = {0.03, 0.1}; /* relative disturbances */
static const double STABLE        = 0.8;         /* largest mhb_ring_model_stiffness */
static const double ON_WAVE = 2e-3, ON_MOTION = 1e-2, NEAR_WAVE = 0.02, FALLS = 0.92,
                    SAME_WAVE = 5e-3;
static const double MILD_MEAN = 0.05, MILD_WORST = 1.05, FEW_LINES = 0.65;
static const double SAME_MEAN = 0.01, SAME_WORST = 0.03, WORST_SHARE = 0.999;

/* ---- decision ---- */

/* Blocks that count: the second half. */
static mhb_block_mean second_half(const mhb_lasting_series *s) {
  int n = s->blocks - s->blocks / 2;
  return mhb_block_mean_of(s->mean + s->blocks - n, n);
}

/* Whether a start is on a wave, or comes back to one. */
static bool is_wave(const mhb_lasting_series *s) {
  int    n = s->blocks, half = n / 2;
  double last = s->spread[n - 1], middle = s->spread[half];
  return last < (s->mistuned ? ON_MOTION : ON_WAVE) ||
         (n >= 16 && last < NEAR_WAVE && last < middle * pow(FALLS, n - 1 - half));
}

mhb_lasting_verdict mhb_lasting_judge(mhb_lasting_series s[STARTS], bool last) {
  mhb_lasting_verdict v = {.wave = is_wave(&s[0]) && is_wave(&s[1])};
  mhb_block_mean      a = second_half(&s[0]), b = second_half(&s[1]);
  if (v.wave) {
    a = (mhb_block_mean){.mean = s[0].mean[s[0].blocks - 1]};
    b = (mhb_block_mean){.mean = s[1].mean[s[1].blocks - 1]};
  }
  double worst[STARTS];
  for (int i = 0; i < STARTS; i++)
    worst[i] =
        v.wave ? s[i].mean[s[i].blocks - 1] : mhb_percentile(s[i].peak, s[i].n_peaks, WORST_SHARE);
  bool settled = mhb_block_mean_is_settled(&a) && mhb_block_mean_is_settled(&b);
  bool same    = fabs(a.mean - b.mean) < fmax(SAME_MEAN * a.mean, 3 * hypot(a.error, b.error)) &&
              fabs(worst[0] - worst[1]) < SAME_WORST * worst[0];
  v.leader  = b.mean > a.mean;
  v.error   = fmax(a.error, b.error);
  v.mean    = 0.5 * (a.mean + b.mean);
  v.worst   = 0.5 * (worst[0] + worst[1]);
  v.several = settled && !same && (last || s[0].blocks >= SEVERAL_BLOCKS);
  v.decided = (settled && same) || v.several || last;
  if (v.several) {
    v.mean  = v.leader ? b.mean : a.mean;
    v.worst = worst[v.leader];
  }
  return v;
}

int mhb_lasting_kind_of(const mhb_lasting_verdict *v, double share) {
  if (v->several || (v->wave && fabs(v->mean - 1) > SAME_WAVE)) return MHB_LASTING_SEVERAL;
  if (v->wave) return MHB_LASTING_WAVE;
  if (fabs(v->mean - 1) < MILD_MEAN && v->worst < MILD_WORST) return MHB_LASTING_MILD;
  return share < FEW_LINES ? MHB_LASTING_IRREGULAR : MHB_LASTING_MODULATED;
}

/* ---- one start ---- */

typedef struct {
  mhb_ring        ring;
  mhb_ring_output output;
  int             periods;
  double          mean[MOST_BLOCKS], spread[MOST_BLOCKS];
  double         *peak; /* [period][blades] over the wave's */
  double *sample;       /* [LINE_PERIODS][MHB_SIDE_SAMPLES][3][blades], the last periods in turn */
  double complex *pattern; /* [3][blades] undoes the lag of the wave, or the balance's motion */
  double complex  sum[3];  /* of the block: first harmonics, [0] alone if mistuned; their squares */
  double          square, peaks;
  shb_arena       arena;
} start;

static shb_status create(mhb_ring_model *model, start *s) {
  size_t blades = (size_t)model->blades;
  *s            = (start){0};
  s->peak       = shb_arena_take(&s->arena, MOST_BLOCKS * BLOCK * blades, sizeof(double));
  s->sample     = shb_arena_take(&s->arena, (size_t)LINE_PERIODS * MHB_SIDE_SAMPLES * 3 * blades,
                                 sizeof(double));
  s->pattern    = shb_arena_take(&s->arena, 3 * blades, sizeof *s->pattern);
  SHB_CHECK(!s->arena.failed, SHB_ERR_IO, "out of memory");
  for (int i = 0; i < 3 * model->blades; i++)
    s->pattern[i] = cexp(I * mhb_ring_model_lag(model, model->order, i % model->blades));
  SHB_TRY(mhb_ring_create(model, &s->ring));
  return mhb_ring_output_create(&s->ring, &s->output);
}

static void destroy(start *s) {
  mhb_ring_output_destroy(&s->output);
  mhb_ring_destroy(&s->ring);
  shb_arena_free(&s->arena);
}

/* Keep samples of the last period of the fundamental, for the lines. */
static void keep_samples(start *s) {
  const mhb_ring_model *m     = s->ring.model;
  int                   every = s->ring.n_samples / MHB_SIDE_SAMPLES;
  double               *to =
      s->sample + (size_t)(s->periods % LINE_PERIODS) * MHB_SIDE_SAMPLES * 3 * (size_t)m->blades;
  for (int i = 0; i < MHB_SIDE_SAMPLES; i++)
    for (int axis = 0; axis < 3; axis++, to += m->blades)
      memcpy(to, s->ring.output + (size_t)(((i + 1) * every - 1) * 3 + axis) * (size_t)m->lanes,
             sizeof(double) * (size_t)m->blades);
}

static void end_block(start *s) {
  int    blades = s->ring.model->blades, n = blades * BLOCK, at = s->periods / BLOCK - 1;
  double mean = 0;
  for (int axis = 0; axis < 3; axis++) mean += pow(cabs(s->sum[axis] / n), 2);
  s->mean[at]   = s->peaks / n;
  s->spread[at] = mean > 0 ? sqrt(fmax(s->square / n - mean, 0) / mean) : 0;
  memset(s->sum, 0, sizeof s->sum);
  s->square = s->peaks = 0;
}

static void one_period(start *s, double scale) {
  int     blades = s->ring.model->blades;
  double *peak   = s->peak + (size_t)s->periods * (size_t)blades;
  mhb_ring_period(&s->ring);
  mhb_ring_peaks(&s->ring, &s->output);
  mhb_ring_first_harmonics(&s->ring, &s->output);
  keep_samples(s);
  for (int b = 0; b < blades; b++) {
    peak[b] = s->output.peak[b] / scale;
    s->peaks += peak[b];
    for (int axis = 0; axis < 3; axis++) {
      double complex first = s->output.first[axis * blades + b];
      s->sum[s->ring.model->ring ? 0 : axis] += first * s->pattern[axis * blades + b];
      s->square += creal(first * conj(first));
    }
  }
  s->periods++;
  if (s->periods % BLOCK == 0) end_block(s);
}

/* Integrate to a number of blocks. false: stopped. */
static bool advance(start *s, int blocks, double scale, mhb_go_on go_on, void *context) {
  while (s->periods < blocks * BLOCK) {
    one_period(s, scale);
    if (go_on && !go_on(context)) return false;
  }
  return true;
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

/* Mean over the blades of the wave's own peak, in the same steps. */
static double wave_peak(start *s, const mhb_wave *wave) {
  double sum = 0;
  mhb_ring_start(&s->ring, wave->n_harmonics, wave->force);
  mhb_ring_period(&s->ring);
  mhb_ring_peaks(&s->ring, &s->output);
  for (int b = 0; b < s->ring.model->blades; b++) sum += s->output.peak[b];
  return sum / s->ring.model->blades;
}

/* Of a mistuned ring: the motion of the balance in place of the wave, for the spread. Returns the
 * highest amplitude of a blade over the mean of all; 1 of a wave. */
static double set_pattern(start s[STARTS], const mhb_wave *wave) {
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
    s[0].pattern[i] = s[1].pattern[i] = conj(first[i]) / sqrt(square);
  return sum > 0 ? most / sum : 1;
}

static mhb_lasting_series series_of(start *s, double *peaks) {
  int blocks = s->periods / BLOCK, first = blocks / 2 * BLOCK, blades = s->ring.model->blades;
  int n = (s->periods - first) * blades;
  memcpy(peaks, s->peak + (size_t)first * (size_t)blades, sizeof *peaks * (size_t)n);
  return (mhb_lasting_series){blocks, n, s->mean, s->spread, peaks, s->ring.model->ring != NULL};
}

/* Samples [period][sample][3][blades] of a mistuned ring: what repeats every period is replaced by
 * a wave of its size. Different amplitudes of the blades are no side waves. */
static void leave_wave(const mhb_ring_model *m, double *y) {
  const int n      = MHB_SIDE_SAMPLES * 3 * m->blades;
  double    square = 0, mean[n];
  for (int i = 0; i < n; i++) {
    mean[i] = 0;
    for (int t = 0; t < LINE_PERIODS; t++) mean[i] += y[t * n + i] / LINE_PERIODS;
    square += mean[i] * mean[i];
  }
  const double size = sqrt(2 * square * 3 / n);
  for (int i = 0; i < n * LINE_PERIODS; i++) {
    const int    b = i % m->blades, axis = i / m->blades % 3, at = i % n / (3 * m->blades);
    const double phase = SHB_TWO_PI * (at + 1) / MHB_SIDE_SAMPLES -
                         SHB_TWO_PI * m->settings.engine_order * b / m->blades;
    y[i] += (axis ? 0 : size * cos(phase)) - mean[i % n];
  }
}

/* Strongest side wave of the leading start, and the kind. */
static shb_status describe(const mhb_lasting_verdict *v, start *s, int engine_order,
                           mhb_lasting *result) {
  const mhb_ring_model *m = s->ring.model;
  mhb_side_waves        found;
  int                   periods = LINE_PERIODS, now = s->periods % LINE_PERIODS;
  size_t        part = (size_t)MHB_SIDE_SAMPLES * 3 * (size_t)m->blades, size = part * LINE_PERIODS;
  const double *x     = s->sample;
  shb_arena     arena = {0};
  double       *y     = shb_arena_take(&arena, size, sizeof *y); /* oldest first */
  SHB_CHECK(y, SHB_ERR_IO, "out of memory for side waves");
  memcpy(y, x + (size_t)now * part, sizeof *y * (size - (size_t)now * part));
  memcpy(y + size - (size_t)now * part, x, sizeof *y * (size_t)now * part);
  if (m->ring) leave_wave(m, y);
  shb_status status = mhb_side_waves_find(y, periods, m->blades, engine_order, &found);
  shb_arena_free(&arena);
  SHB_TRY(status);
  result->diameter = found.wave[0].diameter;
  result->offset   = found.wave[0].offset;
  result->kind     = mhb_lasting_kind_of(v, found.share);
  return SHB_OK;
}

static shb_status run(start s[STARTS], const mhb_wave *wave, mhb_go_on go_on, void *context,
                      mhb_lasting *result) {
  const mhb_ring_model *m     = s[0].ring.model;
  mhb_noise             noise = {.state = 20};
  double                scale = wave_peak(&s[0], wave), worst = set_pattern(s, wave);
  shb_arena             arena = {0};
  size_t                most  = (size_t)(MOST_BLOCKS * BLOCK) * (size_t)m->blades;
  double               *peaks = shb_arena_take(&arena, 2 * most, sizeof *peaks);
  SHB_CHECK(peaks, SHB_ERR_IO, "out of memory");
  bool                go = scale > 0;
  mhb_lasting_verdict v  = {0};
  for (int i = 0; i < STARTS; i++) {
    mhb_ring_start(&s[i].ring, wave->n_harmonics, wave->force);
    mhb_ring_disturb(&s[i].ring, &s[i].output, START[i], &noise);
  }
  for (int t = 0; go && !v.decided; t++) {
    for (int i = 0; i < STARTS && go; i++) go = advance(&s[i], targets[t], scale, go_on, context);
    if (!go) break;
    mhb_lasting_series both[STARTS] = {series_of(&s[0], peaks), series_of(&s[1], peaks + most)};
    v                               = mhb_lasting_judge(both, targets[t] == MOST_BLOCKS);
  }
  shb_arena_free(&arena);
  if (!v.decided) return SHB_OK;
  if (!v.wave) v.worst /= worst;
  result->mean    = v.mean;
  result->worst   = v.worst;
  result->error   = v.error;
  result->periods = s[0].periods + s[1].periods;
  return describe(&v, &s[v.leader], m->settings.to_ground ? 0 : m->settings.engine_order, result);
}

double mhb_lasting_bytes(int blades, int pairs, int modes, bool mistuned) {
  enum { OF_A_PAIR = 9 + 5, OF_OUTPUT = 1 + 6 + 3 + 6, FREE = 12 }; /* numbers a blade */
  const double most    = modes + 6. * pairs;                        /* with merged ones */
  const double samples = LINE_PERIODS * MHB_SIDE_SAMPLES * 3, peaks = MOST_BLOCKS * BLOCK;
  const double state = 4 * most + OF_A_PAIR * pairs + OF_OUTPUT + 3 * MHB_RING_SAMPLES;
  const double lines = samples + 2 * samples + 2 * LINE_PERIODS; /* in order, spectrum, power */
  const double model = mistuned ? most * (1 + MHB_RING_LANE_SIZE + MHB_RING_MAP) : 0;
  return sizeof(double) * mhb_whole_lanes(blades) *
         (STARTS * (peaks + samples + state) + fmax(2 * peaks, lines) + model + FREE * (pairs + 1));
}

shb_status mhb_lasting_settle(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, mhb_go_on go_on, void *context,
                              mhb_lasting *result) {
  mhb_ring_model *model;
  start           s[STARTS] = {{.periods = 0}};
  int             steps;
  *result = (mhb_lasting){.diameter = -1};
  SHB_TRY(mhb_ring_model_create(modal, settings, wave->n0, wave->omega, &model));
  shb_status status = mhb_ring_steps(model, wave->omega, STEPS, &steps);
  if (status == SHB_OK && steps > 0) {
    status = create(model, &s[0]);
    if (status == SHB_OK) status = create(model, &s[1]);
    if (status == SHB_OK) status = run(s, wave, go_on, context, result);
  }
  destroy(&s[0]);
  destroy(&s[1]);
  mhb_ring_model_destroy(model);
  return status;
}
