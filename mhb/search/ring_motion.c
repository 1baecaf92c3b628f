#include "mhb/search/ring_motion.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/problem/wave.h"
#include "mhb/structure/ring_receptance.h"

/* Energy beside the load's wave that is round-off of the balance, as a share. */
static const double NO_ENERGY = 1e-6;

/* Share of the energy that makes a standing wave; half of the blades. */
static const double MOST = 0.9, HALF = 0.5;

/* Nodal diameters of the load's wave at harmonic k, 0..N-1. */
static int load_wave(const mhb_balance *b, int k) {
  const mhb_driven_wave wave = mhb_settings_wave(b->settings);
  const int             N = b->receptance->ring->blades, shift = mhb_driven_wave_shift(wave);
  const long            waves = wave.engine_order + (shift > 0 ? (long)N * shift : 0);
  return (int)mhb_driven_wave_turned(wave, k * waves / b->receptance->nu % N);
}

/* e[N] <- energies of the waves of one harmonic, from the amplitudes q[N][modes]. */
static void wave_energies(int N, int modes, double weight, const double complex *q, double *e) {
  const double complex one = 1. / N, none = 0;
  double complex       turn[N], T[N * N], wave[N * modes];
  for (int i = 0; i < N; i++) turn[i] = cexp(I * SHB_TWO_PI * i / N);
  for (int d = 0; d < N; d++)
    for (int blade = 0; blade < N; blade++) T[d * N + blade] = turn[d * blade % N];
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, N, modes, N, &one, T, N, q, modes, &none,
              wave, modes);
  for (int d = 0; d < N; d++) {
    e[d] = 0;
    for (int i = 0; i < modes; i++)
      e[d] += pow(creal(wave[d * modes + i]), 2) + pow(cimag(wave[d * modes + i]), 2);
    e[d] *= N * weight;
  }
}

void mhb_ring_motion_energies(const mhb_balance *b, double *energy, double *wave,
                              double *standing) {
  const mhb_ring_receptance *g = b->receptance->ring;
  const int                  N = g->blades, modes = g->ring->n_modes;
  double complex             p[3 * b->n_pairs], q[N * modes];
  double                     e[N], total = 0;
  *standing = 0;
  memset(energy, 0, sizeof *energy * (size_t)N);
  memset(wave, 0, sizeof *wave * (size_t)N);
  for (int k = 1; k <= b->m; k++) {
    const double weight = 0.25 * pow(k * b->eval->at.omega / b->receptance->nu, 2);
    mhb_balance_update_probes(b, k);
    mhb_balance_contact_force(b, k, p);
    mhb_receptance_amplitudes(b->receptance, k, p, q);
    for (int i = 0; i < N * modes; i++)
      energy[i / modes] += weight * (pow(creal(q[i]), 2) + pow(cimag(q[i]), 2));
    wave_energies(N, modes, weight, q, e);
    for (int d = 0; d < N; d++) {
      wave[(d - load_wave(b, k) + N) % N] += e[d];
      if (2 * d % N) *standing += fmin(e[d], e[N - d]);
    }
  }
  for (int j = 0; j < N; j++) total += energy[j];
  for (int j = 0; j < N && total > 0; j++) wave[j] /= total;
  if (total > 0) *standing /= total;
}

double mhb_ring_participation(int n, const double *energy) {
  double sum = 0, squares = 0, most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, energy[i]);
  for (int i = 0; i < n && most > 0; i++) {
    sum += energy[i] / most;
    squares += pow(energy[i] / most, 2);
  }
  return most > 0 ? sum * sum / (n * squares) : 0;
}

mhb_ring_kind mhb_ring_kind_of(double participation, double load_wave, double standing) {
  if (participation == 0) return MHB_RING_UNKNOWN;
  if (load_wave >= 1 - NO_ENERGY) return MHB_RING_WAVE;
  if (participation < HALF) return MHB_RING_LOCALISED;
  return standing > MOST ? MHB_RING_STANDING : MHB_RING_WAVES;
}
