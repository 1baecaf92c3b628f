#include "mhb/ring/motions.h"

#include <math.h>

enum { FEW_BLOCKS = 16, PARTS = 4 }; /* fewer blocks show no decay */

static const double ON_WAVE = 2e-3, ON_MOTION = 1e-2, NEAR_WAVE = 0.02, FALLS = 0.92;
static const double RESOLVES = 0.03, STEADY = 0.05, SAME_MEAN = 0.01, SAME_WORST = 0.03,
                    WORST_SHARE = 0.999;

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
         (n >= FEW_BLOCKS && last < NEAR_WAVE && last < middle * pow(FALLS, n - 1 - half));
}

/* Standard error of the percentile of n peaks, by rising time: that of the mean of its parts. */
static double percentile_error(double *peak, int n) {
  double each[PARTS], mean = 0, square = 0;
  for (int i = 0; i < PARTS; i++) {
    each[i] = mhb_percentile(peak + i * (n / PARTS), n / PARTS, WORST_SHARE);
    mean += each[i] / PARTS;
  }
  for (int i = 0; i < PARTS; i++) square += (each[i] - mean) * (each[i] - mean);
  return sqrt(square / (PARTS - 1) / PARTS);
}

/* Whether the spread of the blocks that count changes by less than its scatter allows. Their
 * correlation is left out of the error: it is what a trend shows. */
static bool is_steady(const mhb_lasting_series *s) {
  const int            n      = s->blocks - s->blocks / 2;
  const double        *x      = s->spread + s->blocks - n;
  const mhb_block_mean m      = mhb_block_mean_of(x, n);
  double               square = 0;
  for (int i = 0; i < n; i++) square += (x[i] - m.mean) * (x[i] - m.mean);
  return fabs(m.drift) < fmax(STEADY * m.mean, 3 * sqrt(square / (n - 1) / n));
}

mhb_motion mhb_motion_of(const mhb_lasting_series *s, bool last) {
  mhb_motion m = {
      .wave = is_wave(s), .starts = 1, .half = second_half(s), .last = s->mean[s->blocks - 1]};
  m.settled = mhb_block_mean_is_settled(&m.half) && (last || is_steady(s));
  m.calm =
      mhb_block_mean_is_level(&m.half) && is_steady(s) && m.half.error < RESOLVES * m.half.mean;
  m.worst_error = percentile_error(s->peak, s->n_peaks);
  m.worst       = mhb_percentile(s->peak, s->n_peaks, WORST_SHARE);
  return m;
}

double mhb_motion_mean(const mhb_motion *m, bool wave) {
  return wave ? m->last : m->half.mean;
}

double mhb_motion_error(const mhb_motion *m, bool wave) {
  return wave ? 0 : m->half.error;
}

double mhb_motion_worst(const mhb_motion *m, bool wave) {
  return wave ? m->last : m->worst;
}

double mhb_motion_distance(const mhb_motion *a, const mhb_motion *b) {
  const bool   wave = a->wave && b->wave;
  const double mean = mhb_motion_mean(a, wave), other = mhb_motion_mean(b, wave);
  const double worst       = mhb_motion_worst(a, wave);
  const double error       = hypot(mhb_motion_error(a, wave), mhb_motion_error(b, wave));
  const double worst_error = wave ? 0 : hypot(a->worst_error, b->worst_error);
  return fmax(fabs(mean - other) / fmax(SAME_MEAN * mean, 3 * error),
              fabs(worst - mhb_motion_worst(b, wave)) / fmax(SAME_WORST * worst, 3 * worst_error));
}
