#include "mhb/structure/cyclic_flexibility.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
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
  if (f->coupling) {
    block(s, 1, i, 1, j, ll);
    block(s, 1, i, 0, j, lr);
    block(s, 0, j, 1, i, rl);
  }
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) {
      size_t at   = (size_t)(3 * i + c) * (size_t)f->n + (size_t)(3 * j + d);
      f->self[at] = rr[c][d] + ll[c][d];
      if (f->coupling) f->coupling[at] = 0.5 * (lr[c][d] + rl[d][c]);
    }
}

static void set_single(mhb_cyclic_flexibility *f) {
  const size_t square = (size_t)f->n * (size_t)f->n;
  for (size_t i = 0; f->single && i < square; i++) f->single[i] = (float)f->self[i];
}

const float *mhb_cyclic_flexibility_single(mhb_cyclic_flexibility *f) {
  const float *single = NULL;
#pragma omp critical(single_flexibility)
  {
    if (!f->single) {
      f->single = shb_arena_take(&f->arena, (size_t)f->n * (size_t)f->n, sizeof(float));
      set_single(f);
    }
    single = f->single;
  }
  return single;
}

mhb_cyclic_flexibility *mhb_cyclic_flexibility_create(const double *matrix, int nc,
                                                      const double *T0, int n_pairs, int sides) {
  mhb_cyclic_flexibility *f      = shb_alloc_zeroed(1, sizeof *f);
  size_t                  square = 9 * (size_t)n_pairs * (size_t)n_pairs;
  f->n                           = 3 * n_pairs;
  f->self                        = shb_arena_take(&f->arena, square, sizeof(double));
  if (sides == 2) f->coupling = shb_arena_take(&f->arena, square, sizeof(double));
  mhb_cyclic_flexibility_set(f, matrix, nc, T0);
  return f;
}

void mhb_cyclic_flexibility_set(mhb_cyclic_flexibility *f, const double *matrix, int nc,
                                const double *T0) {
  const source s = {.matrix = matrix, .T0 = T0, .nc = nc, .n = f->n};
  for (int i = 0; i < f->n / 3; i++)
    for (int j = 0; j < f->n / 3; j++) set_pairs(&s, i, j, f);
  set_single(f);
}

void mhb_cyclic_flexibility_destroy(mhb_cyclic_flexibility *f) {
  if (!f) return;
  shb_arena_free(&f->arena);
  free(f);
}

/* Rows and columns at once, so that C^T is read by whole lines. */
enum { TILE = 32 };

MHB_HOT void mhb_cyclic_flexibility_add(const mhb_cyclic_flexibility *f, double complex phase,
                                        double factor, double complex *R) {
  const int n  = f->n;
  double    re = factor * creal(phase), im = factor * cimag(phase);
  if (!f->coupling) {
    for (int i = 0; i < n * n; i++) R[i] += factor * f->self[i];
    return;
  }
  for (int from_i = 0; from_i < n; from_i += TILE)
    for (int from_j = 0; from_j < n; from_j += TILE)
      for (int i = from_i; i < n && i < from_i + TILE; i++)
        for (int j = from_j; j < n && j < from_j + TILE; j++) {
          const double c = f->coupling[i * n + j], t = f->coupling[j * n + i];
          R[i * n + j] = CMPLX(creal(R[i * n + j]) + factor * f->self[i * n + j] - re * (c + t),
                               cimag(R[i * n + j]) - im * (c - t));
        }
}

void mhb_cyclic_flexibility_both(const mhb_cyclic_flexibility *f, int sign, double *out) {
  const int n = f->n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      out[i * n + j] = f->coupling[i * n + j] + sign * f->coupling[j * n + i];
}

/* Two numbers a row: products of self and of C with a vector, whose parts are re and im. */
typedef struct {
  double self[2], coupling[2];
} row_product;

static double sum_of(mhb_half_lanes x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

/* Row i of both, and t += (row i of C)^T times element i. */
MHB_INLINE row_product row_times(const mhb_cyclic_flexibility *f, int i, const double *re,
                                 const double *im, double *t_re, double *t_im) {
  const double  *self = f->self + (size_t)i * (size_t)f->n;
  const double  *c    = f->coupling ? f->coupling + (size_t)i * (size_t)f->n : NULL;
  const int      n = f->n, whole = n / MHB_HALF_LANES * MHB_HALF_LANES;
  mhb_half_lanes s_re = {0}, s_im = {0}, c_re = {0}, c_im = {0};
  for (int j = 0; j < whole; j += MHB_HALF_LANES) {
    const mhb_half_lanes a = half_lanes_load(re + j), b = half_lanes_load(im + j);
    const mhb_half_lanes s = half_lanes_load(self + j);
    s_re += s * a;
    s_im += s * b;
    if (!c) continue;
    const mhb_half_lanes q = half_lanes_load(c + j);
    c_re += q * a;
    c_im += q * b;
    half_lanes_store(t_re + j, half_lanes_load(t_re + j) + re[i] * q);
    half_lanes_store(t_im + j, half_lanes_load(t_im + j) + im[i] * q);
  }
  row_product sum = {{sum_of(s_re), sum_of(s_im)}, {sum_of(c_re), sum_of(c_im)}};
  for (int j = whole; j < n; j++) {
    sum.self[0] += self[j] * re[j];
    sum.self[1] += self[j] * im[j];
    if (!c) continue;
    sum.coupling[0] += c[j] * re[j];
    sum.coupling[1] += c[j] * im[j];
    t_re[j] += re[i] * c[j];
    t_im[j] += im[i] * c[j];
  }
  return sum;
}

/* self p - e C p - conj(e) C^T p; the last sum is complete after the last row. */
MHB_HOT void mhb_cyclic_flexibility_add_product(const mhb_cyclic_flexibility *f,
                                                double complex phase, double factor,
                                                const double complex *p, double complex *to) {
  const int n = f->n;
  double    re[n], im[n], t_re[n], t_im[n], x = creal(phase), y = cimag(phase);
  for (int i = 0; i < n; i++) {
    re[i]   = creal(p[i]);
    im[i]   = cimag(p[i]);
    t_re[i] = t_im[i] = 0;
  }
  for (int i = 0; i < n; i++) {
    const row_product of = row_times(f, i, re, im, t_re, t_im);
    const double     *s = of.self, *c = of.coupling;
    const double      real = s[0] - x * c[0] + y * c[1], imaginary = s[1] - x * c[1] - y * c[0];
    to[i] = CMPLX(creal(to[i]) + factor * real, cimag(to[i]) + factor * imaginary);
  }
  for (int i = 0; i < n && f->coupling; i++) {
    const double real = x * t_re[i] + y * t_im[i], imaginary = x * t_im[i] - y * t_re[i];
    to[i] = CMPLX(creal(to[i]) - factor * real, cimag(to[i]) - factor * imaginary);
  }
}

void mhb_cyclic_flexibility_add_block(const mhb_cyclic_flexibility *f, double complex phase,
                                      double factor, int pair, double complex R[3][3]) {
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) {
      const int at = (3 * pair + c) * f->n + 3 * pair + d;
      const int t  = (3 * pair + d) * f->n + 3 * pair + c;
      R[c][d] += factor * f->self[at];
      if (f->coupling)
        R[c][d] -= factor * CMPLX(creal(phase) * (f->coupling[at] + f->coupling[t]),
                                  cimag(phase) * (f->coupling[at] - f->coupling[t]));
    }
}
