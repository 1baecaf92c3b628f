#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/structure/equal_shapes.h"
#include "mhb/structure/receptance.h"
#include "mhb/structure/ring_receptance.h"

/* ---- life cycle ---- */

static shb_status fill(mhb_ring_receptance *g, const mhb_settings *settings, int n_harmonics) {
  mhb_settings own = *settings;
  size_t       n = (size_t)g->n, N = (size_t)g->blades, K = (size_t)n_harmonics + 1;
  own.ring      = NULL;
  own.to_ground = true; /* each blade alone: its two faces are its pairs */
  g->blade      = shb_arena_take(&g->arena, N, sizeof(mhb_receptance *));
  g->R          = shb_arena_take(&g->arena, K * N * MHB_RING_BLOCKS * n * n, sizeof *g->R);
  g->p          = shb_arena_take(&g->arena, 2 * n, sizeof *g->p);
  g->dp         = shb_arena_take(&g->arena, 2 * n, sizeof *g->dp);
  g->part       = shb_arena_take(&g->arena, 2 * n, sizeof *g->part);
  for (int b = 0; b < g->blades; b++)
    SHB_TRY(mhb_receptance_create(&g->ring->blade[b], &own, n_harmonics, &g->blade[b]));
  g->shapes = mhb_equal_shapes_create(g->blade[0]);
  return SHB_OK;
}

shb_status mhb_ring_receptance_create(const mhb_settings *settings, int n_harmonics,
                                      mhb_ring_receptance **out) {
  mhb_ring_receptance *g = shb_alloc_zeroed(1, sizeof *g);
  g->ring                = settings->ring;
  g->blades              = g->ring->blades;
  g->n                   = 3 * g->ring->n_pairs;
  g->q                   = 3 * g->ring->n_probes;
  shb_status status      = fill(g, settings, n_harmonics);
  if (status != SHB_OK) {
    mhb_ring_receptance_destroy(g);
    return status;
  }
  *out = g;
  return SHB_OK;
}

void mhb_ring_receptance_destroy(mhb_ring_receptance *g) {
  if (!g) return;
  mhb_equal_shapes_destroy(g->shapes);
  for (int b = 0; g->blade && b < g->blades; b++) mhb_receptance_destroy(g->blade[b]);
  shb_arena_free(&g->arena);
  free(g);
}

void mhb_ring_receptance_set_frequency(mhb_ring_receptance *g, double omega) {
  for (int b = 0; b < g->blades; b++) mhb_receptance_set_frequency(g->blade[b], omega);
}

void mhb_ring_receptance_scale(mhb_ring_receptance *g, double scale) {
  for (int b = 0; b < g->blades; b++) mhb_receptance_scale(g->blade[b], scale);
}

/* ---- from contacts to a blade and back ---- */

static int before(const mhb_ring_receptance *g, int b) {
  return b > 0 ? b - 1 : g->blades - 1;
}

static size_t size_of(const mhb_ring_receptance *g) {
  return (size_t)g->n * sizeof(double complex);
}

const double complex *mhb_ring_forces_of_blade(const mhb_ring_receptance *g, int b,
                                               const double complex *p, double complex *own) {
  if (!p) return NULL;
  memcpy(own, p + (size_t)b * (size_t)g->n, size_of(g));
  memcpy(own + g->n, p + (size_t)before(g, b) * (size_t)g->n, size_of(g));
  return own;
}

void mhb_ring_add_blade(const mhb_ring_receptance *g, int b, const double complex *own,
                        double complex *all) {
  double complex *right = all + (size_t)b * (size_t)g->n;
  double complex *left  = all + (size_t)before(g, b) * (size_t)g->n;
  for (int i = 0; i < g->n; i++) right[i] += own[i];
  for (int i = 0; i < g->n; i++) left[i] += own[g->n + i];
}

/* ---- one harmonic ---- */

static double complex *block(const mhb_ring_receptance *g, int k, int b, mhb_ring_block which) {
  return (double complex *)mhb_ring_receptance_block(g, k, b, which);
}

/* to[n][n] += the part of H[2n][2n] from (row, column). */
static void add_part(const mhb_equal_shapes *H, int n, int row, int column, double complex *to) {
  const double *re = H->matrix[0] + row * 2 * n + column, *im = H->matrix[1] + row * 2 * n + column;
  for (int i = 0; i < n; i++, re += 2 * n, im += 2 * n)
    for (int j = 0; j < n; j++)
      to[i * n + j] = CMPLX(creal(to[i * n + j]) + re[j], cimag(to[i * n + j]) + im[j]);
}

static void set_blocks(mhb_ring_receptance *g, int k) {
  const int n = g->n;
  memset(block(g, k, 0, MHB_RING_BEFORE), 0,
         (size_t)g->blades * MHB_RING_BLOCKS * (size_t)n * size_of(g));
  for (int b = 0; b < g->blades; b++) {
    const int l = before(g, b);
    mhb_equal_shapes_receptance(g->shapes, g->blade[b], k);
    add_part(g->shapes, n, 0, 0, block(g, k, b, MHB_RING_OWN));
    add_part(g->shapes, n, 0, n, block(g, k, b, MHB_RING_BEFORE));
    add_part(g->shapes, n, n, 0, block(g, k, l, MHB_RING_AFTER));
    add_part(g->shapes, n, n, n, block(g, k, l, MHB_RING_OWN));
  }
}

static void set_load(const mhb_ring_receptance *g, int k, double complex *free,
                     double complex *unit) {
  memset(free, 0, (size_t)g->blades * size_of(g));
  memset(unit, 0, (size_t)g->blades * size_of(g));
  for (int b = 0; b < g->blades; b++) {
    mhb_ring_add_blade(g, b, g->blade[b]->free + (size_t)k * 2 * (size_t)g->n, free);
    mhb_ring_add_blade(g, b, g->blade[b]->free_response_unit + (size_t)k * 2 * (size_t)g->n, unit);
  }
}

void mhb_ring_receptance_update(mhb_ring_receptance *g, int k, double complex *free,
                                double complex *unit) {
  mhb_ring_receptance_update_load(g, k, free, unit);
  set_blocks(g, k);
}

void mhb_ring_receptance_update_load(mhb_ring_receptance *g, int k, double complex *free,
                                     double complex *unit) {
  for (int b = 0; b < g->blades; b++) mhb_receptance_update_load(g->blade[b], k);
  set_load(g, k, free, unit);
}

void mhb_ring_receptance_row(const mhb_ring_receptance *g, int k, int row, int pair,
                             double complex out[3]) {
  const int n = g->n, b = row / n, c = 3 * pair / n, column = 3 * pair % n;
  const int neighbour[] = {before(g, b), b, (b + 1) % g->blades};
  out[0] = out[1] = out[2] = 0;
  for (int which = 0; which < MHB_RING_BLOCKS; which++) {
    if (neighbour[which] != c) continue; /* of two blades both neighbours are one */
    const double complex *R = block(g, k, b, (mhb_ring_block)which) + row % n * n + column;
    for (int i = 0; i < 3; i++) out[i] += R[i];
  }
}

/* y[n] += A p */
static void add_product(int n, const double complex *A, const double complex *p,
                        double complex *y) {
  for (int i = 0; i < n; i++, A += n) {
    double re = 0, im = 0;
    for (int j = 0; j < n; j++) {
      re += creal(A[j]) * creal(p[j]) - cimag(A[j]) * cimag(p[j]);
      im += creal(A[j]) * cimag(p[j]) + cimag(A[j]) * creal(p[j]);
    }
    y[i] += CMPLX(re, im);
  }
}

void mhb_ring_receptance_product(const mhb_ring_receptance *g, int k, const double complex *p,
                                 double complex *motion) {
  const int n = g->n, N = g->blades;
  for (int b = 0; b < N; b++, motion += n) {
    add_product(n, block(g, k, b, MHB_RING_BEFORE), p + (size_t)before(g, b) * (size_t)n, motion);
    add_product(n, block(g, k, b, MHB_RING_OWN), p + (size_t)b * (size_t)n, motion);
    add_product(n, block(g, k, b, MHB_RING_AFTER), p + (size_t)((b + 1) % N) * (size_t)n, motion);
  }
}

/* ---- blade by blade ---- */

void mhb_ring_receptance_motion(const mhb_ring_receptance *g, int k, const double complex *p,
                                double complex *motion) {
  memset(motion, 0, (size_t)g->blades * size_of(g));
  for (int b = 0; b < g->blades; b++) {
    mhb_receptance_motion(g->blade[b], k, mhb_ring_forces_of_blade(g, b, p, g->p), g->part);
    mhb_ring_add_blade(g, b, g->part, motion);
  }
}

void mhb_ring_receptance_slope(const mhb_ring_receptance *g, int k, const double complex *p,
                               double complex *slope) {
  memset(slope, 0, (size_t)g->blades * size_of(g));
  for (int b = 0; b < g->blades; b++) {
    mhb_equal_shapes_slope(g->shapes, g->blade[b], k, mhb_ring_forces_of_blade(g, b, p, g->p),
                           g->part);
    mhb_ring_add_blade(g, b, g->part, slope);
  }
}

void mhb_ring_receptance_amplitudes(const mhb_ring_receptance *g, int k, const double complex *p,
                                    double complex *amplitude) {
  for (int b = 0; b < g->blades; b++, amplitude += g->ring->n_modes)
    mhb_receptance_amplitudes(g->blade[b], k, mhb_ring_forces_of_blade(g, b, p, g->p), amplitude);
}

void mhb_ring_receptance_probe_change(const mhb_ring_receptance *g, int k, const double complex *p,
                                      const double complex *dp, double d_omega, double d_scale,
                                      double complex *change) {
  for (int b = 0; b < g->blades; b++, change += g->q)
    mhb_receptance_probe_change(g->blade[b], k, mhb_ring_forces_of_blade(g, b, p, g->p),
                                mhb_ring_forces_of_blade(g, b, dp, g->dp), d_omega, d_scale,
                                change);
}

void mhb_ring_receptance_by_damping(const mhb_ring_receptance *g, int k, const double complex *p,
                                    double complex *motion, double complex *probe) {
  memset(motion, 0, (size_t)g->blades * size_of(g));
  for (int b = 0; b < g->blades; b++, probe += g->q) {
    mhb_receptance_by_damping(g->blade[b], k, mhb_ring_forces_of_blade(g, b, p, g->p), g->part,
                              probe);
    mhb_ring_add_blade(g, b, g->part, motion);
  }
}
