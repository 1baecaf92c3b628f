#include "mhb/low_rank/gmres.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

mhb_gmres *mhb_gmres_create(int n, int most) {
  mhb_gmres *g    = shb_alloc_zeroed(1, sizeof *g);
  size_t     rows = (size_t)n, many = (size_t)most;
  g->n       = n;
  g->most    = most;
  g->V       = shb_alloc((many + 1) * rows, sizeof(double));
  g->Z       = shb_alloc(many * rows, sizeof(double));
  g->H       = shb_arena_take(&g->arena, many * (many + 1), sizeof(double));
  g->R       = shb_arena_take(&g->arena, many * (many + 1), sizeof(double));
  g->g       = shb_arena_take(&g->arena, many + 1, sizeof(double));
  g->c       = shb_arena_take(&g->arena, many, sizeof(double));
  g->s       = shb_arena_take(&g->arena, many, sizeof(double));
  g->y       = shb_arena_take(&g->arena, many, sizeof(double));
  g->project = shb_arena_take(&g->arena, many + 1, sizeof(double));
  g->wr      = shb_arena_take(&g->arena, many, sizeof(double));
  g->wi      = shb_arena_take(&g->arena, many, sizeof(double));
  return g;
}

void mhb_gmres_destroy(mhb_gmres *g) {
  if (!g) return;
  free(g->V);
  free(g->Z);
  shb_arena_free(&g->arena);
  free(g);
}

/* Column of H for vector w: w is left orthogonal to the first j + 1 vectors. */
static double orthogonalise(mhb_gmres *g, int size, int j, double *w, double *h) {
  memset(h, 0, sizeof(double) * ((size_t)j + 2));
  for (int round = 0; round < 2; round++) {
    cblas_dgemv(CblasRowMajor, CblasNoTrans, j + 1, size, 1, g->V, size, w, 1, 0, g->project, 1);
    cblas_dgemv(CblasRowMajor, CblasTrans, j + 1, size, -1, g->V, size, g->project, 1, 1, w, 1);
    for (int i = 0; i <= j; i++) h[i] += g->project[i];
  }
  return h[j + 1] = cblas_dnrm2(size, w, 1);
}

/* What two projections leave of a vector of unit length that lies in the space. It is the rounding
 * of four sums of so many products. The products are of either sign. */
static double rounding(int size) {
  return 4 * DBL_EPSILON * sqrt(size);
}

/* Column j of R by the rotations so far and a new one. Of a column that depends on those before
 * only rounding is left: nothing is gained by it, and its number on the diagonal is 0.
 *   least  in  what is rounding
 * Returns whether it gains something. */
static bool rotate(mhb_gmres *g, int j, double least) {
  double *r = g->R + (size_t)j * ((size_t)g->most + 1);
  memcpy(r, g->H + (size_t)j * ((size_t)g->most + 1), sizeof(double) * ((size_t)j + 2));
  for (int i = 0; i < j; i++) {
    double a = r[i], b = r[i + 1];
    r[i]     = g->c[i] * a + g->s[i] * b;
    r[i + 1] = g->c[i] * b - g->s[i] * a;
  }
  double length = hypot(r[j], r[j + 1]);
  bool   gains  = length > least;
  g->c[j]       = gains ? r[j] / length : 0;
  g->s[j]       = gains ? r[j + 1] / length : 1;
  r[j]          = gains ? length : 0;
  g->g[j + 1]   = -g->s[j] * g->g[j];
  g->g[j] *= g->c[j];
  return gains;
}

/* x <- Z y, R y = g. */
static void combine(mhb_gmres *g, int size, double *x) {
  size_t ld = (size_t)g->most + 1;
  for (int i = g->iterations - 1; i >= 0; i--) {
    double sum = g->g[i];
    for (int j = i + 1; j < g->iterations; j++) sum -= g->R[(size_t)j * ld + (size_t)i] * g->y[j];
    const double pivot = g->R[(size_t)i * ld + (size_t)i];
    g->y[i]            = pivot > 0 ? sum / pivot : 0;
  }
  cblas_dgemv(CblasRowMajor, CblasTrans, g->iterations, size, 1, g->Z, size, g->y, 1, 0, x, 1);
}

int mhb_gmres_solve(mhb_gmres *g, int size, mhb_gmres_apply apply, void *context, const double *b,
                    double tolerance, double *x) {
  size_t rows   = (size_t)size;
  double length = cblas_dnrm2(size, b, 1);
  g->iterations = 0;
  g->residual   = 0;
  memset(x, 0, sizeof(double) * rows);
  if (!isfinite(length)) return 0;
  if (length == 0) return 1;
  for (size_t i = 0; i < rows; i++) g->V[i] = b[i] / length;
  g->g[0] = length;
  for (int j = 0; j < g->most; j++) {
    double *w = g->V + ((size_t)j + 1) * rows, *h = g->H + (size_t)j * ((size_t)g->most + 1);
    if (!apply(context, g->V + (size_t)j * rows, g->Z + (size_t)j * rows, w)) return 0;
    const double least = rounding(size) * cblas_dnrm2(size, w, 1);
    double       next  = orthogonalise(g, size, j, w, h);
    if (!isfinite(next)) return 0;
    const bool gains = rotate(g, j, least);
    g->iterations    = j + 1;
    g->residual      = fabs(g->g[j + 1]) / length;
    if (g->residual <= tolerance || next == 0 || !gains) break;
    cblas_dscal(size, 1 / next, w, 1);
  }
  combine(g, size, x);
  return g->residual <= tolerance;
}

int mhb_gmres_negative(mhb_gmres *g) {
  int    n = g->iterations, count = 0;
  size_t ld = (size_t)g->most + 1;
  if (n == 0) return 0;
  memcpy(g->R, g->H, sizeof(double) * (size_t)g->most * ld);
  if (LAPACKE_dhseqr_work(LAPACK_COL_MAJOR, 'E', 'N', n, 1, n, g->R, (int)ld, g->wr, g->wi, NULL, 1,
                          g->project, (int)ld) != 0)
    return 0;
  for (int i = 0; i < n; i++) count += g->wi[i] == 0 && g->wr[i] < 0;
  return count;
}
