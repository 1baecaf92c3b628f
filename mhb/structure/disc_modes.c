#include "mhb/structure/disc_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/model/nodal_diameters.h"

static void set_fourier(mhb_disc_modes *d) {
  const int N = d->blades;
  for (int n = 0; n < d->diameters; n++) {
    int       count;
    const int at = mhb_disc_modes_first(d, n, &count);
    for (int b = 0; b < N; b++) {
      const double angle     = SHB_TWO_PI * (double)(n * b % N) / N;
      d->fourier[at * N + b] = sqrt((double)count / N) * cos(angle);
      if (count == 2) d->fourier[(at + 1) * N + b] = sqrt(2. / N) * sin(angle);
    }
  }
}

/* Shapes and frequencies; the modes above those kept go into the flexibility. */
static void set_modes(mhb_disc_modes *d, const mhb_modal_part *part, int diameter) {
  const modal_model    *model = part->wave[diameter].model;
  const double complex *B     = part->B + (size_t)diameter * (size_t)(d->n * d->all);
  double complex       *phi   = d->shape + (size_t)diameter * (size_t)(d->modes * d->n);
  for (int i = 0; i < d->modes; i++) {
    d->omega[diameter * d->modes + i] = SHB_TWO_PI * model->frequency[i];
    d->zeta[diameter * d->modes + i]  = model->damping_ratio[i];
    for (int r = 0; r < d->n; r++) phi[i * d->n + r] = B[r * d->all + i];
  }
  if (!d->flexibility) return;
  double complex *R = d->flexibility + (size_t)diameter * (size_t)(d->n * d->n);
  memset(R, 0, (size_t)(d->n * d->n) * sizeof *R);
  mhb_residual_terms_matrix(part->residual_terms, diameter, 0, R);
  for (int i = d->modes; i < d->all; i++) {
    const double w = SHB_TWO_PI * model->frequency[i];
    for (int r = 0; r < d->n; r++)
      for (int c = 0; c < d->n; c++)
        R[r * d->n + c] += B[r * d->all + i] * conj(B[c * d->all + i]) / (w * w);
  }
}

/* ---- Coriolis terms ---- */

/* Amplitudes of one nodal diameter. With real shapes the other of a conjugate pair counts too. */
static void set_amplitudes(mhb_disc_modes *d, int diameter, const mhb_damped_modes *from) {
  const size_t       m = (size_t)d->modes, all = 2 * m, n = (size_t)d->n, k = (size_t)diameter;
  mhb_coupled_modes *to = d->coupled;
  int                count;
  mhb_disc_modes_first(d, diameter, &count);
  memcpy(to->pole + k * all, from->pole, all * sizeof *to->pole);
  memcpy(to->to_amplitude + k * all * all, from->to_amplitude, all * all * sizeof *to->pole);
  for (size_t i = 0; i < all * all; i++)
    to->to_state[k * all * all + i] = (count == 1 ? 2 : 1) * from->to_state[i];
  for (size_t a = 0; a < all; a++)
    for (size_t r = 0; r < n; r++) {
      double complex out = 0, in = 0;
      for (size_t j = 0; j < m; j++) {
        const double complex phi = d->shape[(k * m + j) * n + r];
        out += phi * to->to_state[(k * all + j) * all + a];
        in += to->to_amplitude[(k * all + a) * all + m + j] * conj(phi);
      }
      to->shape[(k * all + a) * n + r] = out;
      to->force[(k * all + a) * n + r] = in;
    }
}

static shb_status couple_one(mhb_disc_modes *d, const mhb_modal_part *part, int diameter) {
  const size_t     m = (size_t)d->modes, stride = (size_t)d->all, k = (size_t)diameter;
  double complex  *G = d->coupled->G + k * m * m;
  double           loss[m];
  mhb_damped_modes modes;
  for (size_t i = 0; i < m; i++) {
    loss[i] = 2 * d->zeta[k * m + i] * d->omega[k * m + i];
    for (size_t j = 0; j < m; j++) G[i * m + j] = part->G[(k * stride + i) * stride + j];
  }
  shb_status status = mhb_damped_modes_solve((int)m, d->omega + k * m, loss, G, &modes);
  if (status == SHB_OK) set_amplitudes(d, diameter, &modes);
  mhb_damped_modes_free(&modes);
  return status;
}

static shb_status couple(mhb_disc_modes *d, const mhb_modal_part *part) {
  const size_t K = (size_t)d->diameters, m = (size_t)d->modes, all = 2 * m, n = (size_t)d->n;
  d->coupled           = shb_arena_take(&d->arena, 1, sizeof *d->coupled);
  mhb_coupled_modes *c = d->coupled;
  c->G                 = shb_arena_take(&d->arena, K * m * m, sizeof *c->G);
  c->pole              = shb_arena_take(&d->arena, K * all, sizeof *c->pole);
  c->shape             = shb_arena_take(&d->arena, K * all * n, sizeof *c->shape);
  c->force             = shb_arena_take(&d->arena, K * all * n, sizeof *c->force);
  c->to_amplitude      = shb_arena_take(&d->arena, K * all * all, sizeof *c->to_amplitude);
  c->to_state          = shb_arena_take(&d->arena, K * all * all, sizeof *c->to_state);
  for (int k = 0; k < d->diameters; k++) SHB_TRY(couple_one(d, part, k));
  return SHB_OK;
}

/* The nodal diameters in the place of harmonics: the one of index n lags by n turns of 1/N. */
static shb_status fill(mhb_disc_modes *d, const mhb_receptance *r, const mhb_settings *s) {
  const modal_nodal_diameters *from = s->nodal_diameters;
  if (r->disc) {
    mhb_disc_speeds_set_all(r->disc);
    from = &r->disc->now;
  }
  for (int n = 0; n < d->diameters; n++) {
    int missing;
    d->phase[n] = cexp(-I * SHB_TWO_PI * n / d->blades);
    d->wave[n]  = modal_wave_real(r->model);
    SHB_CHECK(!from || modal_nodal_diameters_wave(from, n, &d->wave[n], &missing), SHB_ERR_INPUT,
              "the modal file lacks nodal diameter %d", missing);
  }
  const mhb_relative  relative  = {d->n, s->to_ground ? 1 : 2, r->T0};
  const mhb_harmonics harmonics = {.nu              = 1,
                                   .n_harmonics     = d->diameters - 1,
                                   .phase           = d->phase,
                                   .wave            = d->wave,
                                   .nodal_diameters = true};
  SHB_TRY(mhb_modal_part_create(r->model, relative, &harmonics, &d->part));
  for (int n = 0; n < d->diameters; n++) set_modes(d, d->part, n);
  shb_status status = d->part->G ? couple(d, d->part) : SHB_OK;
  if (r->at) return status;
  mhb_modal_part_destroy(d->part);
  d->part = NULL;
  return status;
}

void mhb_disc_modes_set(const mhb_receptance *r, mhb_disc_modes *d) {
  if (!d->part) return;
  if (r->disc) mhb_disc_speeds_set_all(r->disc);
  mhb_modal_part_update(d->part);
  for (int n = 0; n < d->diameters; n++) {
    set_modes(d, d->part, n);
    if (!d->coupled || couple_one(d, d->part, n) == SHB_OK) continue;
    const size_t all = 2 * (size_t)d->modes; /* no multiplier is finite */
    for (size_t a = 0; a < all; a++) d->coupled->pole[(size_t)n * all + a] = NAN;
  }
}

shb_status mhb_disc_modes_create(const mhb_receptance *r, const mhb_settings *s, int blades,
                                 int modes, mhb_disc_modes **out) {
  mhb_disc_modes *d = shb_alloc_zeroed(1, sizeof *d);
  const int       N = blades;
  d->blades         = N;
  d->n              = r->n;
  d->all            = r->n_modes;
  d->modes          = modes < d->all ? modes : d->all;
  d->diameters      = N / 2 + 1;

  const size_t K = (size_t)d->diameters, n = (size_t)d->n, m = (size_t)d->modes;
  d->omega   = shb_arena_take(&d->arena, K * m, sizeof *d->omega);
  d->zeta    = shb_arena_take(&d->arena, K * m, sizeof *d->zeta);
  d->wave    = shb_arena_take(&d->arena, K, sizeof *d->wave);
  d->phase   = shb_arena_take(&d->arena, K, sizeof *d->phase);
  d->shape   = shb_arena_take(&d->arena, K * m * n, sizeof *d->shape);
  d->fourier = shb_arena_take(&d->arena, (size_t)N * (size_t)N, sizeof *d->fourier);
  if (r->model->residual_flexibility || d->modes < d->all)
    d->flexibility = shb_arena_take(&d->arena, K * n * n, sizeof *d->flexibility);
  shb_status status = fill(d, r, s);
  if (status != SHB_OK) {
    mhb_disc_modes_destroy(d);
    return status;
  }
  set_fourier(d);
  *out = d;
  return SHB_OK;
}

void mhb_disc_modes_destroy(mhb_disc_modes *d) {
  if (!d) return;
  mhb_modal_part_destroy(d->part);
  shb_arena_free(&d->arena);
  free(d);
}

int mhb_disc_modes_first(const mhb_disc_modes *d, int diameter, int *count) {
  *count = diameter == 0 || 2 * diameter == d->blades ? 1 : 2;
  return diameter == 0 ? 0 : 2 * diameter - 1;
}

void mhb_disc_modes_add_map(const mhb_disc_modes *d, const double complex *block, double *dense) {
  const int N = d->blades, n = d->n;
  for (int lag = 0; lag < N; lag++) /* of the sector that moves behind the one that is pushed */
    for (int r = 0; r < n; r++)
      for (int c = 0; c < n; c++) {
        double sum = 0;
        for (int k = 0; k < d->diameters; k++) {
          int count;
          mhb_disc_modes_first(d, k, &count);
          sum += count * creal(block[((size_t)k * (size_t)n + (size_t)r) * (size_t)n + (size_t)c] *
                               cexp(-I * SHB_TWO_PI * (double)(k * lag % N) / N));
        }
        for (int b = 0; b < N; b++) {
          const int row = (b + lag) % N * n + r, column = b * n + c;
          dense[(size_t)row * (size_t)N * (size_t)n + (size_t)column] += sum / N;
        }
      }
}

void mhb_disc_modes_add_motion(const mhb_disc_modes *d, int blade, int mode, double *motion) {
  const int N = d->blades, n = d->n;
  for (int k = 0; k < d->diameters; k++) {
    int                   count;
    const double complex *phi = d->shape + (size_t)(k * d->modes + mode) * (size_t)n;
    mhb_disc_modes_first(d, k, &count);
    for (int lag = 0; lag < N; lag++) {
      const double complex turn = cexp(-I * SHB_TWO_PI * (double)(k * lag % N) / N);
      for (int r = 0; r < n; r++)
        motion[(blade + lag) % N * n + r] += count * creal(phi[r] * turn) / N;
    }
  }
}
