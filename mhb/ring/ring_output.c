#include "mhb/ring/ring_output.h"

#include <string.h>

#include "mesh/base/constants.h"

void mhb_ring_output_create(const mhb_ring *ring, mhb_ring_output *o) {
  size_t lanes = (size_t)ring->model->lanes, modes = (size_t)ring->model->modes;
  *o       = (mhb_ring_output){0};
  o->peak  = shb_arena_take(&o->arena, lanes, sizeof(double));
  o->first = shb_arena_take(&o->arena, 3 * lanes, sizeof *o->first);
  o->mean  = shb_arena_take(&o->arena, 3 * lanes, sizeof(double));
  o->space = shb_arena_take(&o->arena, 2 * modes * lanes, sizeof(double));
  o->parts = shb_arena_take(&o->arena, 6 * lanes, sizeof(double));
  o->turn  = shb_arena_take(&o->arena, 2 * (size_t)ring->n_samples, sizeof(double));
  for (int i = 0; i < ring->n_samples; i++) {
    double angle       = SHB_TWO_PI * ring->model->order * (i + 1) / ring->n_samples;
    o->turn[2 * i]     = 2 * cos(angle) / ring->n_samples;
    o->turn[2 * i + 1] = -2 * sin(angle) / ring->n_samples;
  }
}

void mhb_ring_output_destroy(mhb_ring_output *o) {
  shb_arena_free(&o->arena);
  *o = (mhb_ring_output){0};
}

MHB_HOT static void find_peaks(int n, size_t lanes, const double *x, double *mean, double *peak) {
  memset(mean, 0, 3 * lanes * sizeof *mean);
  memset(peak, 0, lanes * sizeof *peak);
  for (int i = 0; i < n; i++)
    for (size_t l = 0; l < 3 * lanes; l++) mean[l] += x[(size_t)i * 3 * lanes + l] / n;
  for (int i = 0; i < n; i++, x += 3 * lanes)
    for (size_t l = 0; l < lanes; l++) {
      double a = x[l] - mean[l], b = x[lanes + l] - mean[lanes + l],
             c = x[2 * lanes + l] - mean[2 * lanes + l], square = a * a + b * b + c * c;
      peak[l] = mhb_pick(square > peak[l], square, peak[l]);
    }
  for (size_t l = 0; l < lanes; l++) peak[l] = sqrt(peak[l]);
}

void mhb_ring_peaks(const mhb_ring *ring, mhb_ring_output *o) {
  find_peaks(ring->n_samples, (size_t)ring->model->lanes, ring->output, o->mean, o->peak);
}

MHB_HOT static void find_harmonics(int n, size_t width, const double *x, const double *turn,
                                   double *re, double *im) {
  memset(re, 0, width * sizeof *re);
  memset(im, 0, width * sizeof *im);
  for (int i = 0; i < n; i++, x += width, turn += 2)
    for (size_t l = 0; l < width; l++) {
      re[l] += turn[0] * x[l];
      im[l] += turn[1] * x[l];
    }
}

void mhb_ring_first_harmonics(const mhb_ring *ring, mhb_ring_output *o) {
  const int    used = mhb_ring_model_used(ring->model), lanes = ring->model->lanes;
  const size_t width = 3 * (size_t)lanes;
  find_harmonics(ring->n_samples, width, ring->output, o->turn, o->parts, o->parts + width);
  for (int axis = 0; axis < 3; axis++)
    for (int l = 0; l < used; l++) {
      const double *at          = o->parts + axis * lanes + l;
      o->first[axis * used + l] = CMPLX(at[0], at[width]);
    }
}

void mhb_ring_disturb_copy(mhb_ring *ring, int copy, mhb_ring_output *o, double size,
                           mhb_noise *noise) {
  const mhb_ring_model *m    = ring->model;
  size_t                half = (size_t)m->modes * (size_t)m->lanes;
  mhb_ring_get_copy(ring, copy, o->space, o->space + half);
  for (int l = copy; l < mhb_ring_model_used(m); l += m->copies) {
    double position = 1 + size * mhb_noise_normal(noise);
    double velocity = 1 + size * mhb_noise_normal(noise);
    for (int k = 0; k < m->modes; k++) {
      o->space[(size_t)(k * m->lanes + l)] *= position;
      o->space[half + (size_t)(k * m->lanes + l)] *= velocity;
    }
  }
  mhb_ring_put_copy(ring, copy, o->space, o->space + half);
}

void mhb_ring_disturb(mhb_ring *ring, mhb_ring_output *o, double size, mhb_noise *noise) {
  mhb_ring_disturb_copy(ring, 0, o, size, noise);
}
