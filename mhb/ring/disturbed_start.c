#include "mhb/ring/disturbed_start.h"

#include <string.h>

#include "mhb/ring/side_waves.h"

static void allocate(const mhb_ring_model *model, mhb_starts *s) {
  const size_t blades  = (size_t)model->blades;
  const size_t samples = (size_t)MHB_START_LINES * MHB_SIDE_SAMPLES * 3 * blades;
  s->pattern           = shb_arena_take(&s->arena, 3 * blades, sizeof *s->pattern);
  for (int c = 0; c < model->copies; c++) {
    s->start[c].peak = shb_arena_take(
        &s->arena, (size_t)(MHB_START_BLOCKS * MHB_START_BLOCK) * blades, sizeof(double));
    s->start[c].sample = shb_arena_take(&s->arena, samples, sizeof(double));
  }
}

void mhb_starts_create(mhb_ring_model *model, mhb_starts *s) {
  *s = (mhb_starts){.scale = 1};
  allocate(model, s);
  for (int i = 0; i < 3 * model->blades; i++)
    s->pattern[i] = cexp(I * mhb_ring_model_lag(model, model->order, i % model->blades));
  mhb_ring_create(model, &s->ring);
  mhb_ring_output_create(&s->ring, &s->output);
}

void mhb_starts_destroy(mhb_starts *s) {
  mhb_ring_output_destroy(&s->output);
  mhb_ring_destroy(&s->ring);
  shb_arena_free(&s->arena);
}

void mhb_start_begin(mhb_starts *starts, int copy) {
  mhb_start *s = &starts->start[copy];
  s->periods   = 0;
  s->square = s->peaks = 0;
  memset(s->sum, 0, sizeof s->sum);
  starts->runs[copy] = true;
}

/* Keep samples of the last period of the fundamental, for the lines. */
static void keep_samples(const mhb_starts *starts, int copy) {
  const mhb_ring_model *m     = starts->ring.model;
  mhb_start const      *s     = &starts->start[copy];
  const int             every = starts->ring.n_samples / MHB_SIDE_SAMPLES;
  double               *to =
      s->sample + (size_t)(s->periods % MHB_START_LINES) * MHB_SIDE_SAMPLES * 3 * (size_t)m->blades;
  for (int i = 0; i < 3 * MHB_SIDE_SAMPLES; i++, to += m->blades) {
    const int     at = ((i / 3 + 1) * every - 1) * 3 + i % 3;
    const double *x  = starts->ring.output + (size_t)at * (size_t)m->lanes + copy;
    for (int b = 0; b < m->blades; b++) to[b] = x[b * m->copies];
  }
}

static void end_block(mhb_start *s, int blades) {
  const int n = blades * MHB_START_BLOCK, at = s->periods / MHB_START_BLOCK - 1;
  double    mean = 0;
  for (int axis = 0; axis < 3; axis++) mean += pow(cabs(s->sum[axis] / n), 2);
  s->mean[at]   = s->peaks / n;
  s->spread[at] = mean > 0 ? sqrt(fmax(s->square / n - mean, 0) / mean) : 0;
  memset(s->sum, 0, sizeof s->sum);
  s->square = s->peaks = 0;
}

static void read_period(mhb_starts *starts, int copy) {
  const mhb_ring_model *m    = starts->ring.model;
  mhb_start            *s    = &starts->start[copy];
  double               *peak = s->peak + (size_t)s->periods * (size_t)m->blades;
  keep_samples(starts, copy);
  for (int b = 0; b < m->blades; b++) {
    const int lane = b * m->copies + copy;
    peak[b]        = starts->output.peak[lane] / starts->scale;
    s->peaks += peak[b];
    for (int axis = 0; axis < 3; axis++) {
      double complex first = starts->output.first[axis * mhb_ring_model_used(m) + lane];
      s->sum[m->ring ? 0 : axis] += first * starts->pattern[axis * m->blades + b];
      s->square += creal(first * conj(first));
    }
  }
  s->periods++;
  if (s->periods % MHB_START_BLOCK == 0) end_block(s, m->blades);
}

bool mhb_starts_block(mhb_starts *s, mhb_go_on go_on, void *context) {
  for (int i = 0; i < MHB_START_BLOCK; i++) {
    mhb_ring_period(&s->ring);
    mhb_ring_peaks(&s->ring, &s->output);
    mhb_ring_first_harmonics(&s->ring, &s->output);
    for (int c = 0; c < s->ring.model->copies; c++)
      if (s->runs[c]) read_period(s, c);
    if (go_on && !go_on(context)) return false;
  }
  return true;
}

mhb_lasting_series mhb_starts_series(const mhb_starts *s, int n, const int *copy, double *mean,
                                     double *spread, double *peaks) {
  const int    periods = s->start[copy[0]].periods, blocks = periods / MHB_START_BLOCK;
  const int    first  = blocks / 2 * MHB_START_BLOCK;
  const size_t blades = (size_t)s->ring.model->blades;
  for (int i = 0; i < blocks; i++) {
    mean[i] = spread[i] = 0;
    for (int k = 0; k < n; k++) {
      mean[i] += s->start[copy[k]].mean[i] / n;
      spread[i] += s->start[copy[k]].spread[i] / n;
    }
  }
  for (int i = first; i < periods; i++)
    for (int k = 0; k < n; k++)
      memcpy(peaks + (size_t)((i - first) * n + k) * blades,
             s->start[copy[k]].peak + (size_t)i * blades, sizeof *peaks * blades);
  return (mhb_lasting_series){blocks, (periods - first) * n * (int)blades, mean, spread,
                              peaks,  s->ring.model->ring != NULL};
}
