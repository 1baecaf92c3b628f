#include "mhb/ring/slow_sweep.h"

#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/ring/ring_output.h"
#include "mhb/ring/ring_statistics.h"

enum { STEP = 5, PERIODS = 3000, MOST_PERIODS = 8000, STEPS = 128, WINDOW = 100 };

/* Periods a half-power bandwidth; share of a bandwidth that a window has at least. */
static const double FASTEST = 85, SLOWEST = 1275, WINDOW_WIDTH = 0.6;

static const double NOISE = 1e-3, LEAST_WIDTH = 1e-4, WORST_SHARE = 0.999;

typedef struct {
  mhb_ring_model *model;
  mhb_ring        ring;
  mhb_ring_output output;
  double          low, high;       /* Hz */
  int             n_steps, window; /* steps; steps a window */
  int             stride, n;       /* steps between windows; windows */
  double         *peak;            /* [step][STEP][blades] m */
  shb_arena       arena;
} march_state;

/* Number of steps and length of the windows. */
static void plan(const modal_model *modal, march_state *s) {
  double zeta = modal->damping_ratio[0];
  for (int i = 1; i < s->model->kept; i++) zeta = fmin(zeta, modal->damping_ratio[i]);
  double width = fmax(2 * zeta, LEAST_WIDTH) * s->high, range = (s->high - s->low) / width;
  double periods = fmin(fmax(PERIODS, FASTEST * range), fmax(SLOWEST * range, WINDOW));
  periods        = fmin(periods, MOST_PERIODS);
  s->n_steps     = (int)ceil(periods / STEP);
  double wide    = range > 0 ? fmax(WINDOW, WINDOW_WIDTH * periods / range) : periods;
  s->window      = (int)fmin(ceil(wide / STEP), s->n_steps);
  s->stride      = s->window > 1 ? s->window / 2 : 1;
  s->n           = (s->n_steps - s->window) / s->stride + 1;
}

static double frequency_of(const march_state *s, double step) {
  return s->low + (s->high - s->low) * step / s->n_steps;
}

/* The state in the middle of a window, if this step is one. */
static void keep_state(const march_state *s, int step, mhb_slow_sweep *out) {
  const int from = step - s->window / 2;
  if (from < 0 || from % s->stride != 0 || from / s->stride >= s->n) return;
  mhb_ring_save(&s->ring, 0, s->output.space, &out->state[from / s->stride]);
}

/* false: stopped. */
static bool march(march_state *s, mhb_go_on go_on, void *context, mhb_slow_sweep *out) {
  mhb_noise noise  = {.state = 5};
  size_t    blades = (size_t)s->model->blades;
  double   *peak   = s->peak;
  for (int step = 0; step < s->n_steps; step++) {
    mhb_ring_move(&s->ring, SHB_TWO_PI * frequency_of(s, step + 0.5), s->output.space);
    mhb_ring_disturb(&s->ring, &s->output, NOISE, &noise);
    for (int i = 0; i < STEP; i++, peak += blades) {
      mhb_ring_period(&s->ring);
      mhb_ring_peaks(&s->ring, &s->output);
      memcpy(peak, s->output.peak, blades * sizeof *peak);
      if (go_on && !go_on(context)) return false;
    }
    keep_state(s, step, out);
  }
  return true;
}

/* One window that begins at a step. Returns the mean over its periods of the worst blade. */
static double read_window(const march_state *s, int first, double *space, double *mean,
                          double *worst) {
  int           blades = s->model->blades, periods = s->window * STEP, n = periods * blades;
  const double *peak = s->peak + (size_t)first * STEP * (size_t)blades;
  double        sum = 0, largest = 0;
  for (int i = 0; i < periods; i++) {
    double top = 0;
    for (int b = 0; b < blades; b++) {
      top = fmax(top, peak[i * blades + b]);
      sum += peak[i * blades + b];
    }
    largest += top / periods;
  }
  memcpy(space, peak, sizeof *space * (size_t)n);
  *mean  = sum / n;
  *worst = mhb_percentile(space, n, WORST_SHARE);
  return largest;
}

static void read_windows(const march_state *s, double *space, mhb_slow_sweep *out) {
  double top = 0;
  for (int i = 0; i < s->n; i++) {
    out->frequency[i] = frequency_of(s, i * s->stride + 0.5 * s->window);
    double largest    = read_window(s, i * s->stride, space, &out->mean[i], &out->worst[i]);
    if (largest <= top) continue;
    top          = largest;
    out->largest = out->frequency[i];
  }
  out->n = s->n;
}

static void allocate(const march_state *s, mhb_slow_sweep *out) {
  const size_t n = (size_t)s->n;
  out->frequency = shb_arena_take(&out->arena, n, sizeof(double));
  out->mean      = shb_arena_take(&out->arena, n, sizeof(double));
  out->worst     = shb_arena_take(&out->arena, n, sizeof(double));
  out->state     = shb_arena_take(&out->arena, n, sizeof *out->state);
  out->n_states  = s->n;
}

static void run(march_state *s, const modal_model *modal, const mhb_wave *wave, mhb_go_on go_on,
                void *context, mhb_slow_sweep *out) {
  if (mhb_ring_steps(s->model, wave->omega, STEPS) == 0) return;
  mhb_ring_create(s->model, &s->ring);
  mhb_ring_output_create(&s->ring, &s->output);
  plan(modal, s);
  allocate(s, out);
  size_t n = (size_t)s->n_steps * STEP * (size_t)s->model->blades;
  s->peak  = shb_arena_take(&s->arena, 2 * n, sizeof(double));
  mhb_ring_start(&s->ring, wave->n_harmonics, wave->force);
  const bool finished = march(s, go_on, context, out);
  out->periods        = s->n_steps * STEP;
  if (finished) read_windows(s, s->peak + n, out);
}

shb_status mhb_slow_sweep_run(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, double high, mhb_go_on go_on, void *context,
                              mhb_slow_sweep *out) {
  march_state s       = {.low = wave->omega / SHB_TWO_PI, .high = high};
  *out                = (mhb_slow_sweep){0};
  const double lowest = wave->lowest > 0 ? wave->lowest : wave->omega;
  SHB_TRY(mhb_ring_model_create(modal, settings, wave->n0, lowest, &s.model));
  run(&s, modal, wave, go_on, context, out);
  mhb_ring_output_destroy(&s.output);
  mhb_ring_destroy(&s.ring);
  mhb_ring_model_destroy(s.model);
  shb_arena_free(&s.arena);
  return SHB_OK;
}

void mhb_slow_sweep_destroy(mhb_slow_sweep *sweep) {
  for (int i = 0; i < sweep->n_states; i++) shb_arena_free(&sweep->state[i].arena);
  shb_arena_free(&sweep->arena);
  *sweep = (mhb_slow_sweep){0};
}
