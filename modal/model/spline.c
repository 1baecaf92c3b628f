#include "modal/model/spline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Equation i of the second derivatives: row [n] of the matrix, right [n] multiplies the values. */
static void equation(const double *x, int n, int i, double *row, double *right) {
  memset(row, 0, (size_t)n * sizeof *row);
  memset(right, 0, (size_t)n * sizeof *right);
  if (i == 0 ||
      i == n - 1) { /* not-a-knot: the third derivative is continuous at the second point */
    int    k = i == 0 ? 0 : n - 3;
    double a = x[k + 1] - x[k], b = x[k + 2] - x[k + 1];
    row[k]     = b;
    row[k + 1] = -a - b;
    row[k + 2] = a;
    return;
  }
  double a = x[i] - x[i - 1], b = x[i + 1] - x[i];
  row[i - 1]   = a;
  row[i]       = 2 * (a + b);
  row[i + 1]   = b;
  right[i - 1] = 6 / a;
  right[i]     = -6 / a - 6 / b;
  right[i + 1] = 6 / b;
}

/* Solve A X = B in place, [n][n] each, by Gauss-Jordan elimination with partial pivoting. */
static void solve(int n, double *A, double *B) {
  for (int c = 0; c < n; c++) {
    int best = c;
    for (int i = c + 1; i < n; i++)
      if (fabs(A[i * n + c]) > fabs(A[best * n + c])) best = i;
    for (int j = 0; j < n; j++) {
      double a = A[c * n + j], b = B[c * n + j];
      A[c * n + j] = A[best * n + j], A[best * n + j] = a;
      B[c * n + j] = B[best * n + j], B[best * n + j] = b;
    }
    for (int i = 0; i < n; i++) {
      double factor = i == c ? 0 : A[i * n + c] / A[c * n + c];
      if (factor == 0) continue;
      for (int j = c; j < n; j++) A[i * n + j] -= factor * A[c * n + j];
      for (int j = 0; j < n; j++) B[i * n + j] -= factor * B[c * n + j];
    }
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) B[i * n + j] /= A[i * n + i];
}

/* The parabola: its second derivative is twice the divided difference. */
static void parabola(const double *x, double *second) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int a = (j + 1) % 3, b = (j + 2) % 3;
      second[3 * i + j] = 2 / ((x[j] - x[a]) * (x[j] - x[b]));
    }
}

void modal_spline_create(int n, const double *x, modal_spline *s) {
  const size_t square = (size_t)n * (size_t)n;
  double      *A      = shb_alloc(square, sizeof *A);
  *s                  = (modal_spline){n, shb_alloc((size_t)n, sizeof(double)),
                                       shb_alloc_zeroed(square, sizeof(double))};
  memcpy(s->x, x, (size_t)n * sizeof *x);
  if (n == 3) parabola(x, s->second);
  if (n > 3) {
    for (int i = 0; i < n; i++) equation(x, n, i, A + i * n, s->second + i * n);
    solve(n, A, s->second);
  }
  free(A);
}

void modal_spline_weights(const modal_spline *s, double x, double *weight, double *slope) {
  const int n = s->n;
  int       i = 0;
  memset(weight, 0, (size_t)n * sizeof *weight);
  if (slope) memset(slope, 0, (size_t)n * sizeof *slope);
  weight[0] = 1;
  if (n == 1) return;
  while (i < n - 2 && x > s->x[i + 1]) i++;
  const double  h = s->x[i + 1] - s->x[i], b = (x - s->x[i]) / h, a = 1 - b;
  const double *lower = s->second + i * n, *upper = lower + n;
  const double  lift[2] = {(a * a * a - a) * h * h / 6, (b * b * b - b) * h * h / 6};
  const double  tilt[2] = {-(3 * a * a - 1) * h / 6, (3 * b * b - 1) * h / 6};
  for (int j = 0; j < n; j++) weight[j] = lift[0] * lower[j] + lift[1] * upper[j];
  weight[i] += a;
  weight[i + 1] += b;
  if (!slope) return;
  for (int j = 0; j < n; j++) slope[j] = tilt[0] * lower[j] + tilt[1] * upper[j];
  slope[i] -= 1 / h;
  slope[i + 1] += 1 / h;
}

void modal_spline_free(modal_spline *s) {
  free(s->x);
  free(s->second);
  *s = (modal_spline){0};
}
