#include "mhb/structure/modal_part.h"

#include <stdlib.h>

static void set_shapes(mhb_modal_part *b, int k) {
  const modal_model *model = b->model;
  const int          m     = b->n_modes;
  double complex    *B     = b->B + (size_t)k * (size_t)b->n * (size_t)m;
  for (int row = 0; row < b->n; row++)
    for (int i = 0; i < m; i++) {
      double complex sum = 0;
      for (int axis = 0; axis < 3; axis++) {
        size_t at = ((size_t)(row / 3) * 3 + (size_t)axis) * (size_t)m + (size_t)i;
        sum += mhb_relative_weight(&b->relative, row, 0, axis, b->phase[k]) * model->right[at];
        if (b->relative.sides == 2)
          sum += mhb_relative_weight(&b->relative, row, 1, axis, b->phase[k]) * model->left[at];
      }
      B[(size_t)row * (size_t)m + (size_t)i] = sum;
    }
}

static void set_load(mhb_modal_part *b, int k) {
  const modal_model *model = b->model;
  const int          h = k / b->nu, m = b->n_modes;
  b->driven[k] = mhb_residual_terms_driven(b->residual_terms, k);
  if (k % b->nu || h > model->n_load) return;
  for (int i = 0; i < m; i++) {
    b->F[k * m + i] = model->modal_force[h * m + i];
    b->driven[k] |= b->F[k * m + i] != 0;
  }
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
  }
}

void mhb_modal_part_update(mhb_modal_part *b) {
  mhb_residual_terms_update(b->residual_terms);
  set(b);
}

shb_status mhb_modal_part_create(const modal_model *model, mhb_relative relative, int nu,
                                 int n_harmonics, const double complex *phase,
                                 const mhb_residual_terms *like, mhb_modal_part **out) {
  mhb_modal_part *b = calloc(1, sizeof *b);
  SHB_CHECK(b, SHB_ERR_IO, "out of memory");
  *b             = (mhb_modal_part){.model       = model,
                                    .relative    = relative,
                                    .n           = relative.n,
                                    .n_modes     = model->n_modes,
                                    .n_harmonics = n_harmonics,
                                    .nu          = nu,
                                    .phase       = phase};
  const size_t n = (size_t)b->n, m = (size_t)b->n_modes, K = (size_t)n_harmonics + 1;
  b->B              = shb_arena_take(&b->arena, K * n * m, sizeof *b->B);
  b->F              = shb_arena_take(&b->arena, K * m, sizeof *b->F);
  b->split          = shb_arena_take(&b->arena, K * 2 * (n + 1) * m, sizeof *b->split);
  b->driven         = shb_arena_take(&b->arena, K, sizeof *b->driven);
  shb_status status = b->arena.failed ? SHB_ERR_IO
                                      : mhb_residual_terms_create(model, relative, nu, n_harmonics,
                                                                  phase, like, &b->residual_terms);
  if (status != SHB_OK) {
    mhb_modal_part_destroy(b);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the receptance");
  }
  set(b);
  *out = b;
  return SHB_OK;
}

void mhb_modal_part_destroy(mhb_modal_part *b) {
  if (!b) return;
  mhb_residual_terms_destroy(b->residual_terms);
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
