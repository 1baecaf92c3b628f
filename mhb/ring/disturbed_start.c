#include "mhb/ring/disturbed_start.h"

#include <string.h>

#include "mhb/ring/side_waves.h"

shb_status mhb_start_create(mhb_ring_model *model, mhb_start *s) {
  size_t blades = (size_t)model->blades;
  *s            = (mhb_start){0};
  s->peak = shb_arena_take(&s->arena, MHB_START_BLOCKS * MHB_START_BLOCK * blades, sizeof(double));
  s->sample  = shb_arena_take(&s->arena, (size_t)MHB_START_LINES * MHB_SIDE_SAMPLES * 3 * blades,
                              sizeof(double));
  s->pattern = shb_arena_take(&s->arena, 3 * blades, sizeof *s->pattern);
  SHB_CHECK(!s->arena.failed, SHB_ERR_IO, "out of memory");
  for (int i = 0; i < 3 * model->blades; i++)
    s->pattern[i] = cexp(I * mhb_ring_model_lag(model, model->order, i % model->blades));
  SHB_TRY(mhb_ring_create(model, &s->ring));
  return mhb_ring_output_create(&s->ring, &s->output);
}

void mhb_start_begin(mhb_start *s) {
  s->periods = 0;
  s->square = s->peaks = 0;
  memset(s->sum, 0, sizeof s->sum);
}

void mhb_start_destroy(mhb_start *s) {
  mhb_ring_output_destroy(&s->output);
  mhb_ring_destroy(&s->ring);
  shb_arena_free(&s->arena);
}

/* Keep samples of the last period of the fundamental, for the lines. */
static void keep_samples(mhb_start *s) {
  const mhb_ring_model *m     = s->ring.model;
  int                   every = s->ring.n_samples / MHB_SIDE_SAMPLES;
  double               *to =
      s->sample + (size_t)(s->periods % MHB_START_LINES) * MHB_SIDE_SAMPLES * 3 * (size_t)m->blades;
  for (int i = 0; i < MHB_SIDE_SAMPLES; i++)
    for (int axis = 0; axis < 3; axis++, to += m->blades)
      memcpy(to, s->ring.output + (size_t)(((i + 1) * every - 1) * 3 + axis) * (size_t)m->lanes,
             sizeof(double) * (size_t)m->blades);
}

static void end_block(mhb_start *s) {
  int blades = s->ring.model->blades, n = blades * MHB_START_BLOCK,
      at      = s->periods / MHB_START_BLOCK - 1;
  double mean = 0;
  for (int axis = 0; axis < 3; axis++) mean += pow(cabs(s->sum[axis] / n), 2);
  s->mean[at]   = s->peaks / n;
  s->spread[at] = mean > 0 ? sqrt(fmax(s->square / n - mean, 0) / mean) : 0;
  memset(s->sum, 0, sizeof s->sum);
  s->square = s->peaks = 0;
}

static void one_period(mhb_start *s, double scale) {
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
  if (s->periods % MHB_START_BLOCK == 0) end_block(s);
}

bool mhb_start_advance(mhb_start *s, int blocks, double scale, mhb_go_on go_on, void *context) {
  while (s->periods < blocks * MHB_START_BLOCK) {
    one_period(s, scale);
    if (go_on && !go_on(context)) return false;
  }
  return true;
}

mhb_lasting_series mhb_start_series(const mhb_start *s, double *peaks) {
  int blocks = s->periods / MHB_START_BLOCK, first = blocks / 2 * MHB_START_BLOCK;
  int blades = s->ring.model->blades, n = (s->periods - first) * blades;
  memcpy(peaks, s->peak + (size_t)first * (size_t)blades, sizeof *peaks * (size_t)n);
  return (mhb_lasting_series){blocks, n, s->mean, s->spread, peaks, s->ring.model->ring != NULL};
}
