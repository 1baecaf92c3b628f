#include "mhb/search/ring_symmetry.h"

#include <string.h>

#include "mhb/balance/subharmonics.h"
#include "mhb/problem/wave.h"
#include "mhb/structure/ring_receptance.h"

static bool turns_by(const mhb_mistuned_ring *ring, int s) {
  const int all = ring->blades * ring->n_modes;
  for (int i = 0; i < all; i++)
    if (ring->deviation[i] != ring->deviation[(i + s * ring->n_modes) % all]) return false;
  return true;
}

int mhb_ring_repeat(const mhb_mistuned_ring *ring) {
  int s = 1;
  while (s < ring->blades && (ring->blades % s || !turns_by(ring, s))) s++;
  return s;
}

int mhb_ring_rotations(const mhb_balance *b) {
  const mhb_ring_receptance *g = b->receptance->ring;
  return g ? g->blades / mhb_ring_repeat(g->ring) : 1;
}

/* to[rows][nb] <- x, harmonic k times lag[k]. */
static void later(const mhb_balance *b, const double complex *lag, int rows, const double *x,
                  double *to) {
  for (int row = 0; row < rows; row++, x += b->nb, to += b->nb) {
    to[0] = x[0];
    for (int k = 1; k <= b->m; k++) {
      const double complex u = CMPLX(x[2 * k - 1], x[2 * k]) * lag[k];
      to[2 * k - 1]          = creal(u);
      to[2 * k]              = cimag(u);
    }
  }
}

void mhb_ring_rotate(const mhb_balance *b, const double *x, int j, double *to) {
  const mhb_ring_receptance *g = b->receptance->ring;
  const int                  s = j * mhb_ring_repeat(g->ring), own = g->n * b->nb;
  for (int blade = 0; blade < g->blades; blade++)
    later(b, b->lag + s * (b->m + 1), g->n, x + blade * own, to + (blade + s) % g->blades * own);
}

bool mhb_ring_has_waves(const mhb_balance *b) {
  return mhb_ring_rotations(b) > 1 && mhb_driven_wave_shift(mhb_settings_wave(b->settings)) >= 0;
}

void mhb_ring_beside_wave(const mhb_balance *b, const double *x, double *part) {
  const int rotations = mhb_ring_rotations(b);
  double    turned[b->n];
  memcpy(part, x, sizeof(double) * (size_t)b->n);
  for (int j = 0; j < rotations; j++) {
    if (j > 0) mhb_ring_rotate(b, x, j, turned);
    const double *copy = j > 0 ? turned : x;
    for (int i = 0; i < b->n; i++) part[i] -= copy[i] / rotations;
  }
}

int mhb_motion_copies(const mhb_balance *b) {
  return b->receptance->nu * mhb_ring_rotations(b);
}

void mhb_motion_copy(const mhb_balance *b, const double *x, int j, double *to) {
  const int nu = b->receptance->nu;
  if (j < nu) {
    mhb_subharmonic_shift(b, x, j, to);
    return;
  }
  double turned[b->n];
  mhb_ring_rotate(b, x, j / nu, turned);
  mhb_subharmonic_shift(b, turned, j % nu, to);
}
