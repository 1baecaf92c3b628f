#include "mhb/run_up/speed_model.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/run_up/unitary.h"

/* Relative distance of eigenvalues that count as equal; least eigenvalue of a model, relative to
 * the greatest. */
static const double SAME = 1e-12, LEAST = 1e-12;

/* Shapes of a complex model: its real and imaginary parts. */
static void take_shapes(mhb_speed_model *a, modal_model *of) {
  const modal_model *common = a->table->common;
  const size_t       m = (size_t)a->table->n_modes, side = 3 * (size_t)common->n_pairs * m;
  of->right = shb_arena_take(&a->arena, side, sizeof(double));
  of->left  = common->has_left ? shb_arena_take(&a->arena, side, sizeof(double)) : NULL;
  of->probe = shb_arena_take(&a->arena, 3 * (size_t)common->n_probes * m, sizeof(double));
}

/* The models' arrays <- those of an entry and its rotated shapes. */
static void point(mhb_speed_model *a, double *coefficients, double *rotated,
                  const mhb_speed_parts *parts) {
  const mhb_speed_table *r     = a->table;
  modal_model           *model = parts->model;
  const int              side = 3 * model->n_pairs, m = r->n_modes;
  mhb_speed_table_place(r, coefficients, parts);
  if (r->width == 2) {
    take_shapes(a, model);
    take_shapes(a, parts->imaginary);
    return;
  }
  model->right = rotated;
  model->left  = model->has_left ? rotated + side * m : NULL;
  model->probe = rotated + (model->has_left ? 2 : 1) * side * m;
}

static void make_models(mhb_speed_model *a, double *coefficients, double *rotated,
                        const mhb_speed_parts *parts) {
  const modal_model *common = a->table->common;
  const size_t       m = (size_t)a->table->n_modes, K = (size_t)common->n_load + 1;
  modal_model       *model = parts->model;
  *model                   = (modal_model){.n_modes        = a->table->n_modes,
                                           .n_pairs        = common->n_pairs,
                                           .n_probes       = common->n_probes,
                                           .n_load         = common->n_load,
                                           .n_interfaces   = common->n_interfaces,
                                           .interface_name = common->interface_name,
                                           .interface      = common->interface,
                                           .has_left       = common->has_left,
                                           .tail_order     = common->tail_order,
                                           .probe_name     = common->probe_name,
                                           .normal         = common->normal,
                                           .area           = common->area};
  model->frequency         = shb_arena_take(&a->arena, m, sizeof(double));
  model->damping_ratio     = shb_arena_take(&a->arena, m, sizeof(double));
  model->modal_force       = shb_arena_take(&a->arena, K * m, sizeof(double complex));
  if (a->table->width == 2)
    parts->backward->modal_force = shb_arena_take(&a->arena, K * m, sizeof(double complex));
  point(a, coefficients, rotated, parts);
}

/* The models at the speed, or their derivatives; of a real model the others are not used. */
static mhb_speed_parts models(mhb_speed_model *a) {
  if (a->table->width == 1) return (mhb_speed_parts){&a->model, NULL, NULL};
  return (mhb_speed_parts){&a->model, &a->imaginary, &a->backward};
}

static mhb_speed_parts slopes(mhb_speed_model *a) {
  if (a->table->width == 1) return (mhb_speed_parts){&a->slope, NULL, NULL};
  return (mhb_speed_parts){&a->slope, &a->slope_imaginary, &a->slope_backward};
}

mhb_speed_model *mhb_speed_model_create(const mhb_speed_table *table) {
  mhb_speed_model *a = shb_alloc_zeroed(1, sizeof *a);
  const size_t     m = (size_t)table->n_modes, width = (size_t)table->width, real = sizeof(double);
  const size_t     shapes = width * (size_t)table->rows * m, square = width * m * m;
  a->table = table;
  a->omega = a->slope_omega = NAN;
  a->stiffness              = shb_arena_take(&a->arena, square, real);
  a->damping                = shb_arena_take(&a->arena, square, real);
  a->coefficients           = shb_arena_take(&a->arena, table->size, real);
  a->d_coefficients         = shb_arena_take(&a->arena, table->size, real);
  a->rotated_shapes         = shb_arena_take(&a->arena, shapes, real);
  a->d_rotated_shapes       = shb_arena_take(&a->arena, shapes, real);
  a->U                      = shb_arena_take(&a->arena, square, real);
  a->weight                 = shb_arena_take(&a->arena, (size_t)table->n, real);
  a->d_weight               = shb_arena_take(&a->arena, (size_t)table->n, real);
  a->work = shb_arena_take(&a->arena, m + mhb_unitary_modes_work(table->width, (int)m), real);
  const mhb_speed_parts at = models(a), by = slopes(a);
  make_models(a, a->coefficients, a->rotated_shapes, &at);
  make_models(a, a->d_coefficients, a->d_rotated_shapes, &by);
  if (table->squares == 3) {
    a->coriolis       = shb_arena_take(&a->arena, square, real);
    a->model.coriolis = shb_arena_take(&a->arena, m * m, real);
    if (width == 2) a->imaginary.coriolis = shb_arena_take(&a->arena, m * m, real);
  }
  return a;
}

void mhb_speed_model_destroy(mhb_speed_model *a) {
  if (!a) return;
  shb_arena_free(&a->arena);
  free(a);
}

/* out += sum_i weight_i table_i */
static void combine(const mhb_speed_table *r, const double *weight, double *out) {
  for (int i = 1; i < r->n; i++) /* the differences of the first entry are 0 */
    cblas_daxpy((int)r->size, weight[i], r->entries + (size_t)i * r->size, 1, out, 1);
}

/* Real and imaginary parts of shapes [n], from pairs. Returns the end of the pairs. */
static const double *split(const double *pairs, size_t n, double *re, double *im) {
  for (size_t i = 0; i < n; i++) {
    re[i] = pairs[2 * i];
    im[i] = pairs[2 * i + 1];
  }
  return pairs + 2 * n;
}

/* The models of a wave <- rotated rows. */
static void set_wave(const mhb_speed_model *a, const double *rotated,
                     const mhb_speed_parts *parts) {
  modal_model *re = parts->model, *im = parts->imaginary;
  const size_t m = (size_t)a->table->n_modes, side = 3 * (size_t)re->n_pairs * m;
  const size_t loads = ((size_t)re->n_load + 1) * m;
  rotated            = split(rotated, side, re->right, im->right);
  if (re->has_left) rotated = split(rotated, side, re->left, im->left);
  rotated = split(rotated, 3 * (size_t)re->n_probes * m, re->probe, im->probe);
  for (size_t i = 0; i < loads; i++) {
    const double *forward = rotated + 2 * i, *back = forward + 2 * loads;
    re->modal_force[i]              = CMPLX(forward[0], -forward[1]); /* conj(F) is a row */
    parts->backward->modal_force[i] = CMPLX(back[0], back[1]);
  }
}

/* rotated <- rows of an entry times U, and the models from them. */
static void rotate(const mhb_speed_model *a, const double *coefficients, double *rotated,
                   const mhb_speed_parts *parts) {
  const int width = a->table->width, m = a->table->n_modes, rows = a->table->rows;
  const int K = parts->model->n_load + 1;
  mhb_unitary_rows(width, m, rows, a->U, coefficients + a->table->squares * width * m * m, rotated);
  if (width == 2) {
    set_wave(a, rotated, parts);
    return;
  }
  const double *re = rotated + (rows - 2 * K) * m, *im = re + K * m;
  for (int i = 0; i < K * m; i++) parts->model->modal_force[i] = CMPLX(re[i], im[i]);
}

/* The models' Coriolis matrix, G = Omega U^H C U. */
static void set_coriolis(mhb_speed_model *a, double speed) {
  const int width = a->table->width, m = a->table->n_modes;
  mhb_unitary_congruent(width, m, a->U, a->coefficients + 2 * width * m * m, a->work, a->coriolis);
  for (int k = 0; k < m * m; k++) {
    const double complex G = speed * mhb_speed_model_coriolis(a, k / m, k % m);
    a->model.coriolis[k]   = creal(G);
    if (width == 2) a->imaginary.coriolis[k] = cimag(G);
  }
  a->slope_omega = NAN; /* coriolis is not the derivative */
}

void mhb_speed_model_set(mhb_speed_model *a, double omega) {
  const mhb_speed_table *r     = a->table;
  const int              width = r->width, m = r->n_modes;
  if (a->omega == omega) return;
  const double speed  = mhb_speed_table_speed(r, omega);
  double      *square = a->work, *rest = a->work + m, *Z = rest + width * m * m;
  modal_spline_weights(&r->spline, speed * speed, a->weight, a->d_weight);
  memcpy(a->coefficients, r->first_entry, r->size * sizeof *a->coefficients);
  combine(r, a->weight, a->coefficients);
  mhb_unitary_modes(width, m, a->coefficients, rest, square, a->U);
  a->least_eigenvalue = square[0];
  for (int i = 0; i < m; i++)
    a->model.frequency[i] = sqrt(fmax(square[i], LEAST * square[m - 1])) / SHB_TWO_PI;
  mhb_unitary_congruent(width, m, a->U, a->coefficients + width * m * m, rest, Z);
  for (int i = 0; i < m; i++)
    a->model.damping_ratio[i] = fmax(0, creal(mhb_unitary_at(width, Z, i * (m + 1))));
  const mhb_speed_parts parts = models(a);
  rotate(a, a->coefficients, a->rotated_shapes, &parts);
  if (a->coriolis) set_coriolis(a, speed);
  a->omega = omega;
}

double complex mhb_speed_model_stiffness(const mhb_speed_model *a, int i, int j) {
  return mhb_unitary_at(a->table->width, a->stiffness, j * a->table->n_modes + i);
}

double complex mhb_speed_model_damping(const mhb_speed_model *a, int i, int j) {
  return mhb_unitary_at(a->table->width, a->damping, i * a->table->n_modes + j);
}

double complex mhb_speed_model_coriolis(const mhb_speed_model *a, int i, int j) {
  return mhb_unitary_at(a->table->width, a->coriolis, j * a->table->n_modes + i);
}

/* coriolis <- dG. rate: of the speed by omega. */
static void differentiate_coriolis(mhb_speed_model *a, double rate) {
  const mhb_speed_table *r     = a->table;
  const int              count = r->width * r->n_modes * r->n_modes;
  const double           speed = mhb_speed_table_speed(r, a->omega);
  double                *C = a->work + count, *both = C + count;
  for (int i = 0; i < count; i++)
    both[i] = rate * a->coefficients[2 * count + i] + speed * a->d_coefficients[2 * count + i];
  mhb_unitary_congruent(r->width, r->n_modes, a->U, both, a->work, a->coriolis);
}

/* damping <- dN, from dK, Z in the modes, and U^H Z' U. */
static void differentiate_damping(mhb_speed_model *a, const double *Z, const double *dZ) {
  const int     width = a->table->width, m = a->table->n_modes;
  const double *zeta = a->model.damping_ratio;
  for (int i = 0; i < m; i++) {
    const double w = SHB_TWO_PI * a->model.frequency[i];
    double       d = creal(mhb_unitary_at(width, dZ, i * (m + 1)));
    for (int j = 0; j < m; j++) {
      const double         v = SHB_TWO_PI * a->model.frequency[j], apart = w * w - v * v;
      const bool           same  = i == j || fabs(apart) <= SAME * w * w;
      const double         steep = same ? 0 : 2 * (zeta[i] - zeta[j]) * w / apart;
      const double         part  = steep + 2 * zeta[j] / (w + v);
      const double complex dK    = mhb_speed_model_stiffness(a, i, j);
      double              *to    = a->damping + width * (i * m + j);
      to[0]                      = creal(dK) * part;
      if (width == 2) to[1] = cimag(dK) * part;
      if (!same) d += 2 * creal(mhb_unitary_at(width, Z, j * m + i) * conj(dK)) / apart;
    }
    a->damping[width * i * (m + 1)] += 2 * w * d;
  }
}

void mhb_speed_model_differentiate(mhb_speed_model *a) {
  const mhb_speed_table *r = a->table;
  const int              m = r->n_modes, count = r->width * m * m;
  if (a->slope_omega == a->omega) return;
  const double own = a->omega / r->engine_order, square = (double)r->engine_order * r->engine_order;
  const bool   inside = own >= r->low * (1 - SAME) && own <= r->high * (1 + SAME);
  double      *work = a->work, *Z = work + count, *dZ = Z + count;
  for (int i = 0; i < r->n; i++) a->d_weight[i] *= inside ? 2 * a->omega / square : 0;
  memset(a->d_coefficients, 0, r->size * sizeof *a->d_coefficients);
  combine(r, a->d_weight, a->d_coefficients);
  mhb_unitary_congruent(r->width, m, a->U, a->d_coefficients, work, a->stiffness);
  mhb_unitary_congruent(r->width, m, a->U, a->coefficients + count, work, Z);
  mhb_unitary_congruent(r->width, m, a->U, a->d_coefficients + count, work, dZ);
  differentiate_damping(a, Z, dZ);
  if (a->coriolis) differentiate_coriolis(a, inside ? 1. / r->engine_order : 0);
  const mhb_speed_parts parts = slopes(a);
  rotate(a, a->d_coefficients, a->d_rotated_shapes, &parts);
  a->slope_omega = a->omega;
}

shb_status mhb_speed_model_check(const mhb_speed_table *table, const char *path) {
  enum { SAMPLES = 33 };
  mhb_speed_model *here  = mhb_speed_model_create(table);
  double           least = INFINITY, speed = 0;
  for (int i = 0; i < SAMPLES; i++) {
    double omega = table->band[0] + (table->band[1] - table->band[0]) * i / (SAMPLES - 1);
    mhb_speed_model_set(here, omega);
    if (here->least_eigenvalue >= least) continue;
    least = here->least_eigenvalue;
    speed = mhb_speed_table_speed(table, omega);
  }
  mhb_speed_model_destroy(here);
  SHB_CHECK(least > 0, SHB_ERR_INPUT,
            "mhb.run_up: %s: the speeds are too far apart: interpolated to %.6g rpm the blade is "
            "not stable; give more speeds",
            path, speed * 60 / SHB_TWO_PI);
  return SHB_OK;
}
