#include "mhb/structure/cyclic_flexibility.h"

#include <stdlib.h>
#include <string.h>

#include "mhb/numerics/simd.h"

/* A matrix over contact dofs and the axes of the pairs. */
typedef struct {
  const double *matrix, *T0;
  int           nc, n;
} source;

/* out <- block between pair i on side_i and pair j on side_j, in the axes of the pairs. */
static void block(const source *s, int side_i, int i, int side_j, int j, double out[3][3]) {
  const double *Ti = s->T0 + 9 * i, *Tj = s->T0 + 9 * j;
  const double *from =
      s->matrix + (size_t)(side_i * s->n + 3 * i) * (size_t)s->nc + (size_t)(side_j * s->n + 3 * j);
  double half[3][3] = {{0}};
  for (int a = 0; a < 3; a++, from += s->nc)
    for (int b = 0; b < 3; b++)
      for (int d = 0; d < 3; d++) half[a][d] += from[b] * Tj[3 * b + d];
  memset(out, 0, 9 * sizeof(double));
  for (int a = 0; a < 3; a++)
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) out[c][d] += Ti[3 * a + c] * half[a][d];
}

static void set_pairs(const source *s, int i, int j, mhb_cyclic_flexibility *f) {
  double rr[3][3], ll[3][3] = {{0}}, rl[3][3] = {{0}}, lr[3][3] = {{0}};
  block(s, 0, i, 0, j, rr);
  if (f->even_coupling) {
    block(s, 1, i, 1, j, ll);
    block(s, 0, i, 1, j, rl);
    block(s, 1, i, 0, j, lr);
  }
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) {
      size_t at   = (size_t)(3 * i + c) * (size_t)f->n + (size_t)(3 * j + d);
      f->self[at] = rr[c][d] + ll[c][d];
      if (!f->even_coupling) continue;
      f->even_coupling[at] = rl[c][d] + lr[c][d];
      f->odd_coupling[at]  = lr[c][d] - rl[c][d];
    }
}

shb_status mhb_cyclic_flexibility_create(const double *matrix, int nc, const double *T0,
                                         int n_pairs, int sides, mhb_cyclic_flexibility **out) {
  mhb_cyclic_flexibility *f = calloc(1, sizeof *f);
  SHB_CHECK(f, SHB_ERR_IO, "out of memory");
  size_t square = 9 * (size_t)n_pairs * (size_t)n_pairs;
  f->n          = 3 * n_pairs;
  f->self       = shb_arena_take(&f->arena, square, sizeof(double));
  if (sides == 2) f->even_coupling = shb_arena_take(&f->arena, square, sizeof(double));
  if (sides == 2) f->odd_coupling = shb_arena_take(&f->arena, square, sizeof(double));
  if (f->arena.failed) {
    mhb_cyclic_flexibility_destroy(f);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the residual flexibility of %d pairs", n_pairs);
  }
  mhb_cyclic_flexibility_set(f, matrix, nc, T0);
  *out = f;
  return SHB_OK;
}

void mhb_cyclic_flexibility_set(mhb_cyclic_flexibility *f, const double *matrix, int nc,
                                const double *T0) {
  const source s = {.matrix = matrix, .T0 = T0, .nc = nc, .n = f->n};
  for (int i = 0; i < f->n / 3; i++)
    for (int j = 0; j < f->n / 3; j++) set_pairs(&s, i, j, f);
}

void mhb_cyclic_flexibility_destroy(mhb_cyclic_flexibility *f) {
  if (!f) return;
  shb_arena_free(&f->arena);
  free(f);
}

MHB_HOT void mhb_cyclic_flexibility_add(const mhb_cyclic_flexibility *f, double complex phase,
                                        double factor, double complex *R) {
  size_t square = (size_t)f->n * (size_t)f->n;
  double re = factor * creal(phase), im = factor * cimag(phase);
  if (!f->even_coupling) {
    for (size_t i = 0; i < square; i++) R[i] += factor * f->self[i];
    return;
  }
  for (size_t i = 0; i < square; i++)
    R[i] = CMPLX(creal(R[i]) + factor * f->self[i] - re * f->even_coupling[i],
                 cimag(R[i]) - im * f->odd_coupling[i]);
}

/* What flexibility adds to a row's sums from column j on: numbers of self - Re e even and of
 * - Im e odd. */
typedef struct {
  mhb_half_lanes re, im;
} row_part;

MHB_INLINE row_part part_at(const mhb_cyclic_flexibility *f, double complex phase, size_t at) {
  row_part part = {half_lanes_load(f->self + at), {0}};
  if (!f->even_coupling) return part;
  part.re -= creal(phase) * half_lanes_load(f->even_coupling + at);
  part.im = -cimag(phase) * half_lanes_load(f->odd_coupling + at);
  return part;
}

MHB_HOT double complex mhb_cyclic_flexibility_row(const mhb_cyclic_flexibility *f,
                                                  double complex phase, int i,
                                                  const double complex *p) {
  const size_t   at     = (size_t)i * (size_t)f->n;
  const int      whole  = f->n / MHB_HALF_LANES * MHB_HALF_LANES;
  mhb_half_lanes sum_re = {0}, sum_im = {0};
  for (int j = 0; j < whole; j += MHB_HALF_LANES) {
    const row_part part = part_at(f, phase, at + (size_t)j);
    const double  *q    = (const double *)(p + j);
    mhb_half_lanes re = {q[0], q[2], q[4], q[6]}, im = {q[1], q[3], q[5], q[7]};
    sum_re += part.re * re - part.im * im;
    sum_im += part.re * im + part.im * re;
  }
  double re = (sum_re[0] + sum_re[1]) + (sum_re[2] + sum_re[3]);
  double im = (sum_im[0] + sum_im[1]) + (sum_im[2] + sum_im[3]);
  for (int j = whole; j < f->n; j++) {
    double a = f->self[at + (size_t)j], b = 0;
    if (f->even_coupling) {
      a -= creal(phase) * f->even_coupling[at + (size_t)j];
      b = -cimag(phase) * f->odd_coupling[at + (size_t)j];
    }
    re += a * creal(p[j]) - b * cimag(p[j]);
    im += a * cimag(p[j]) + b * creal(p[j]);
  }
  return CMPLX(re, im);
}

void mhb_cyclic_flexibility_add_block(const mhb_cyclic_flexibility *f, double complex phase,
                                      double factor, int pair, double complex R[3][3]) {
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) {
      size_t at = (size_t)(3 * pair + c) * (size_t)f->n + (size_t)(3 * pair + d);
      R[c][d] += factor * f->self[at];
      if (f->even_coupling)
        R[c][d] -=
            factor * CMPLX(creal(phase) * f->even_coupling[at], cimag(phase) * f->odd_coupling[at]);
    }
}
