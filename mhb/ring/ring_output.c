#include "mhb/ring/ring_output.h"

#include <string.h>

#include "mesh/base/constants.h"

shb_status mhb_ring_output_create(const mhb_ring *ring, mhb_ring_output *o) {
  size_t lanes = (size_t)ring->model->lanes, modes = (size_t)ring->model->modes;
  *o       = (mhb_ring_output){0};
  o->peak  = shb_arena_take(&o->arena, lanes, sizeof(double));
  o->first = shb_arena_take(&o->arena, 3 * lanes, sizeof *o->first);
  o->mean  = shb_arena_take(&o->arena, 3 * lanes, sizeof(double));
  o->space = shb_arena_take(&o->arena, 2 * modes * lanes, sizeof(double));
  if (!o->arena.failed) return SHB_OK;
  mhb_ring_output_destroy(o);
  SHB_FAIL(SHB_ERR_IO, "out of memory");
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

void mhb_ring_first_harmonics(const mhb_ring *ring, mhb_ring_output *o) {
  int n = ring->n_samples, lanes = ring->model->lanes, blades = ring->model->blades;
  memset(o->first, 0, sizeof *o->first * 3 * (size_t)blades);
  for (int i = 0; i < n; i++) {
    double         angle = SHB_TWO_PI * ring->model->order * (i + 1) / n;
    double complex turn  = 2. / n * CMPLX(cos(angle), -sin(angle));
    const double  *x     = ring->output + (size_t)i * 3 * (size_t)lanes;
    for (int axis = 0; axis < 3; axis++)
      for (int b = 0; b < blades; b++) o->first[axis * blades + b] += turn * x[axis * lanes + b];
  }
}

void mhb_ring_disturb(mhb_ring *ring, mhb_ring_output *o, double size, mhb_noise *noise) {
  const mhb_ring_model *m    = ring->model;
  size_t                half = (size_t)m->modes * (size_t)m->lanes;
  mhb_ring_get(ring, o->space, o->space + half);
  for (int b = 0; b < m->blades; b++) {
    double position = 1 + size * mhb_noise_normal(noise);
    double velocity = 1 + size * mhb_noise_normal(noise);
    for (int k = 0; k < m->modes; k++) {
      o->space[(size_t)(k * m->lanes + b)] *= position;
      o->space[half + (size_t)(k * m->lanes + b)] *= velocity;
    }
  }
  mhb_ring_put(ring, o->space, o->space + half);
}
