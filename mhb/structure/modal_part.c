#include "mhb/structure/modal_part.h"

#include <stdlib.h>

#include "mesh/base/memory.h"

typedef struct {
  int row, side, axis, mode;
} place;

/* Share of one axis and side in B. */
static double complex shape_part(const mhb_modal_part *b, const modal_wave *wave, int k, place p) {
  const size_t at =
      ((size_t)(p.row / 3) * 3 + (size_t)p.axis) * (size_t)b->n_modes + (size_t)p.mode;
  const double  *re     = p.side ? wave->model->left : wave->model->right;
  double complex weight = mhb_relative_weight(&b->relative, p.row, p.side, p.axis, b->phase[k]);
  if (!wave->imaginary) return weight * re[at];
  const double *im = p.side ? wave->imaginary->left : wave->imaginary->right;
  return weight * modal_wave_value(wave, re, im, at);
}

static void set_shapes(mhb_modal_part *b, int k) {
  const modal_wave *wave = &b->wave[k];
  const int         m    = b->n_modes;
  double complex   *B    = b->B + (size_t)k * (size_t)b->n * (size_t)m;
  for (int row = 0; row < b->n; row++)
    for (int i = 0; i < m; i++) {
      double complex sum = 0;
      for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < b->relative.sides; side++)
          sum += shape_part(b, wave, k, (place){row, side, axis, i});
      B[(size_t)row * (size_t)m + (size_t)i] = sum;
    }
}

static void set_load(mhb_modal_part *b, int k) {
  const modal_wave *wave = &b->wave[k];
  const int         h = k / b->nu, m = b->n_modes;
  b->driven[k] = mhb_residual_terms_driven(b->residual_terms, k);
  if (k % b->nu || h > wave->model->n_load) return;
  for (int i = 0; i < m; i++) {
    b->F[k * m + i] = wave->loads->modal_force[h * m + i];
    b->driven[k] |= b->F[k * m + i] != 0;
  }
}

/* The first harmonic with the same wave. */
static int first_alike(const mhb_modal_part *b, int k) {
  const modal_wave *of = &b->wave[k];
  int               j  = 0;
  while (b->wave[j].model != of->model || b->wave[j].imaginary != of->imaginary ||
         b->wave[j].sign != of->sign)
    j++;
  return j;
}

static void set_coriolis(mhb_modal_part *b, int k) {
  const int       m = b->n_modes;
  double complex *G = b->G + (size_t)k * (size_t)m * (size_t)m;
  for (int i = 0; i < m * m; i++) G[i] = mhb_gyroscopic_element(&b->wave[k], i / m, i % m);
  mhb_gyroscopic_free(&b->gyroscopic[k]); /* of another speed */
}

const mhb_gyroscopic *mhb_modal_part_gyroscopic(mhb_modal_part *b, int k) {
  const int       first = first_alike(b, k);
  mhb_gyroscopic *of    = &b->gyroscopic[first];
  if (of->n == 0 && mhb_gyroscopic_of_wave(&b->wave[first], of) != SHB_OK) mhb_gyroscopic_free(of);
  return of->n > 0 ? of : NULL;
}

static void set_split(mhb_modal_part *b, int k) {
  size_t                m = (size_t)b->n_modes, nm = (size_t)b->n * m;
  double               *re = b->split + 2 * (size_t)k * (nm + m), *im = re + nm + m;
  const double complex *B = b->B + (size_t)k * nm, *F = b->F + (size_t)k * m;
  for (size_t i = 0; i < nm + m; i++) {
    double complex z = i < nm ? B[i] : F[i - nm];
    re[i]            = creal(z);
    im[i]            = cimag(z);
  }
}

static void set(mhb_modal_part *b) {
  for (int k = 0; k <= b->n_harmonics; k++) {
    set_shapes(b, k);
    set_load(b, k);
    set_split(b, k);
    if (b->G) set_coriolis(b, k);
  }
}

void mhb_modal_part_update(mhb_modal_part *b) {
  mhb_residual_terms_update(b->residual_terms);
  set(b);
}

static shb_status make(mhb_modal_part *b, const mhb_harmonics *harmonics) {
  const size_t n = (size_t)b->n, m = (size_t)b->n_modes, K = (size_t)b->n_harmonics + 1;
  b->wave   = shb_arena_take(&b->arena, K, sizeof *b->wave);
  b->B      = shb_arena_take(&b->arena, K * n * m, sizeof *b->B);
  b->F      = shb_arena_take(&b->arena, K * m, sizeof *b->F);
  b->split  = shb_arena_take(&b->arena, K * 2 * (n + 1) * m, sizeof *b->split);
  b->driven = shb_arena_take(&b->arena, K, sizeof *b->driven);
  if (b->model->coriolis) {
    b->G          = shb_arena_take(&b->arena, K * m * m, sizeof *b->G);
    b->gyroscopic = shb_arena_take(&b->arena, K, sizeof *b->gyroscopic);
  }
  for (size_t k = 0; k < K; k++)
    b->wave[k] = harmonics->wave ? harmonics->wave[k] : modal_wave_real(b->model);
  mhb_harmonics own = *harmonics;
  own.wave          = b->wave;
  return mhb_residual_terms_create(b->model, b->relative, &own, &b->residual_terms);
}

shb_status mhb_modal_part_create(const modal_model *model, mhb_relative relative,
                                 const mhb_harmonics *harmonics, mhb_modal_part **out) {
  mhb_modal_part *b       = shb_alloc_zeroed(1, sizeof *b);
  *b                      = (mhb_modal_part){.model       = model,
                                             .relative    = relative,
                                             .n           = relative.n,
                                             .n_modes     = model->n_modes,
                                             .n_harmonics = harmonics->n_harmonics,
                                             .nu          = harmonics->nu,
                                             .phase       = harmonics->phase};
  const shb_status status = make(b, harmonics);
  if (status != SHB_OK) {
    mhb_modal_part_destroy(b);
    return status;
  }
  set(b);
  *out = b;
  return SHB_OK;
}

void mhb_modal_part_destroy(mhb_modal_part *b) {
  if (!b) return;
  mhb_residual_terms_destroy(b->residual_terms);
  for (int k = 0; b->gyroscopic && k <= b->n_harmonics; k++) mhb_gyroscopic_free(&b->gyroscopic[k]);
  shb_arena_free(&b->arena);
  free(b);
}

double complex mhb_modal_part_force(const mhb_modal_part *b, int k, const double complex *p, int i,
                                    double load) {
  const double complex *B = b->B + (size_t)k * (size_t)b->n * (size_t)b->n_modes;
  double complex        a = load * b->F[k * b->n_modes + i];
  for (int row = 0; row < b->n; row++) a -= conj(B[row * b->n_modes + i]) * p[row];
  return a;
}
