#include "mhb/balance/spatial_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

shb_status mhb_spatial_error_create(const mhb_balance *balance, mhb_spatial_error **out) {
  mhb_spatial_error *e        = shb_alloc_zeroed(1, sizeof *e);
  e->balance                  = balance;
  e->pairs                    = balance->settings->other_pairs;
  e->settings                 = *balance->settings;
  e->settings.harmonics       = balance->m;
  e->settings.nodal_diameters = e->pairs->nodal_diameters;
  shb_status status           = mhb_balance_create(e->pairs->model, &e->settings, &e->other);
  if (status == SHB_OK) {
    e->x      = shb_arena_take(&e->arena, (size_t)e->other->n, sizeof *e->x);
    e->step   = shb_arena_take(&e->arena, (size_t)e->other->n, sizeof *e->step);
    e->force  = shb_arena_take(&e->arena, 3 * (size_t)balance->n_pairs, sizeof *e->force);
    e->spread = shb_arena_take(&e->arena, 3 * (size_t)e->other->n_pairs, sizeof *e->spread);
    e->system = mhb_condensation_create(e->other);
  }
  if (status != SHB_OK) {
    mhb_spatial_error_destroy(e);
    return status;
  }
  *out = e;
  return SHB_OK;
}

void mhb_spatial_error_destroy(mhb_spatial_error *e) {
  if (!e) return;
  mhb_condensation_destroy(e->system);
  mhb_balance_destroy(e->other);
  shb_arena_free(&e->arena);
  free(e);
}

/* x <- motion of the finer pairs under the forces of the balance, spread by area. */
static void lift(mhb_spatial_error *e) {
  const modal_joining *j = e->pairs->joining;
  mhb_balance         *b = e->other;
  mhb_receptance_set_frequency(b->receptance, b->eval->at.omega);
  for (int k = 0; k <= b->m; k++) {
    mhb_balance_contact_force(e->balance, k, e->force);
    for (int row = 0; row < 3 * b->n_pairs; row++)
      e->spread[row] = j->weight[row / 3] * e->force[3 * j->patch[row / 3] + row % 3];
    mhb_receptance_update_load(b->receptance, k);
    mhb_receptance_motion(b->receptance, k, e->spread, b->motion_k);
    for (int row = 0; row < 3 * b->n_pairs; row++) {
      double *to = e->x + (size_t)row * (size_t)b->nb;
      if (k) to[2 * k] = cimag(b->motion_k[row]);
      to[k ? 2 * k - 1 : 0] = creal(b->motion_k[row]);
    }
  }
}

/* x <- mean motion of the patches of the coarser model. */
static void take_means(mhb_spatial_error *e, const double *fine) {
  const modal_joining *j  = e->pairs->joining;
  const size_t         nb = (size_t)e->other->nb;
  memset(e->x, 0, sizeof *e->x * (size_t)e->other->n);
  for (int row = 0; row < 3 * j->n_pairs; row++) {
    double *to = e->x + (size_t)(3 * j->patch[row / 3] + row % 3) * nb;
    for (size_t i = 0; i < nb; i++) to[i] += j->weight[row / 3] * fine[(size_t)row * nb + i];
  }
}

/* Sum of squares over the pairs by their shares, from coefficient `first` of each axis on. */
static double size_of(const mhb_balance *b, const double *x, int first) {
  double sum = 0;
  for (int row = 0; row < 3 * b->n_pairs; row++)
    for (int i = first; i < b->nb; i++)
      sum += b->receptance->share[row / 3] * x[row * b->nb + i] * x[row * b->nb + i];
  return sqrt(sum);
}

double mhb_spatial_error_at(mhb_spatial_error *e, const double *x) {
  mhb_balance *b = e->other;
  mhb_balance_set_operating_point(b, &e->balance->eval->at);
  if (e->pairs->finer)
    lift(e);
  else
    take_means(e, x);
  const double size = size_of(b, e->x, 1);
  mhb_balance_linearise(b, e->x, b->eval->at.omega, e->step, NULL);
  if (!mhb_condensation_factor(e->system, NULL, NULL)) return -1;
  if (!mhb_condensation_solve(e->system, e->step)) return -1;
  const double error = size_of(b, e->step, 0) / size;
  return isfinite(error) ? error : -1;
}
