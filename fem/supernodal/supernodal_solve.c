#include "fem/supernodal/supernodal_solve.h"

#include <cblas.h>
#include <omp.h>
#include <string.h>

#include "fem/supernodal/hot.h"

enum { GROUP = 8 }; /* columns that are processed together */

/* w_i -= L_ij w_j for the eight columns from j and all rows i below them. */
FEM_KERNEL void take_eight(const double *l, size_t rows, size_t j, fem_lanes *w) {
  const double   *l0 = l, *l1 = l0 + rows, *l2 = l1 + rows, *l3 = l2 + rows;
  const double   *l4 = l3 + rows, *l5 = l4 + rows, *l6 = l5 + rows, *l7 = l6 + rows;
  const fem_lanes v0 = w[j], v1 = w[j + 1], v2 = w[j + 2], v3 = w[j + 3];
  const fem_lanes v4 = w[j + 4], v5 = w[j + 5], v6 = w[j + 6], v7 = w[j + 7];
  for (size_t i = j + GROUP; i < rows; i++) {
    __builtin_prefetch(l + GROUP * (rows + i), 0, 2);
    w[i] -= ((l0[i] * v0 + l1[i] * v1) + (l2[i] * v2 + l3[i] * v3)) +
            ((l4[i] * v4 + l5[i] * v5) + (l6[i] * v6 + l7[i] * v7));
  }
}

/* Solve L w = w. */
FEM_KERNEL void forward(const fem_panel *s, const double *value, fem_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t j = 0; j < columns; j += GROUP) {
    const double *l     = value + j * rows;
    const size_t  group = columns - j < GROUP ? columns - j : GROUP;
    const size_t  end   = group == GROUP ? j + group : rows;
    for (size_t a = 0; a < group; a++) {
      w[j + a] /= l[a * rows + j + a];
      for (size_t i = j + a + 1; i < end; i++) w[i] -= l[a * rows + i] * w[j + a];
    }
    if (group == GROUP) take_eight(l, rows, j, w);
  }
}

/* sum_a = L_ij w_i over the rows below eight columns. */
FEM_KERNEL void sum_eight(const double *l, size_t rows, size_t j, const fem_lanes *w,
                          fem_lanes sum[GROUP]) {
  const double *l0 = l, *l1 = l0 + rows, *l2 = l1 + rows, *l3 = l2 + rows;
  const double *l4 = l3 + rows, *l5 = l4 + rows, *l6 = l5 + rows, *l7 = l6 + rows;
  fem_lanes     s0 = {0}, s1 = {0}, s2 = {0}, s3 = {0}, s4 = {0}, s5 = {0}, s6 = {0}, s7 = {0};
  for (size_t i = j + GROUP; i < rows; i++) {
    const fem_lanes v = w[i];
    __builtin_prefetch(l - GROUP * (rows - i), 0, 2);
    s0 += l0[i] * v, s1 += l1[i] * v, s2 += l2[i] * v, s3 += l3[i] * v;
    s4 += l4[i] * v, s5 += l5[i] * v, s6 += l6[i] * v, s7 += l7[i] * v;
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
  sum[4] = s4, sum[5] = s5, sum[6] = s6, sum[7] = s7;
}

/* Solve L^T w = w. */
FEM_KERNEL void backward(const fem_panel *s, const double *value, fem_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t left = columns; left > 0;) {
    const size_t  group = left % GROUP ? left % GROUP : GROUP, j = left - group;
    const double *l          = value + j * rows;
    fem_lanes     sum[GROUP] = {{0}};
    const size_t  end        = group == GROUP ? j + group : rows;
    if (group == GROUP) sum_eight(l, rows, j, w, sum);
    for (size_t a = group; a-- > 0;) {
      fem_lanes v = w[j + a] - sum[a];
      for (size_t i = j + a + 1; i < end; i++) v -= l[a * rows + i] * w[i];
      w[j + a] = v / l[a * rows + j + a];
    }
    left = j;
  }
}

FEM_HOT static void forward_panels(const fem_supernodes *s, const double *value, int first,
                                   int last, fem_lanes *x, fem_lanes *work) {
  for (int k = first; k < last; k++) {
    const fem_panel *p   = &s->panel[k];
    const int       *row = s->row + p->row;
    for (int i = 0; i < p->rows; i++) work[i] = x[row[i]];
    forward(p, value + p->value, work);
    for (int i = 0; i < p->rows; i++) x[row[i]] = work[i];
  }
}

FEM_HOT static void backward_panels(const fem_supernodes *s, const double *value, int first,
                                    int last, fem_lanes *x, fem_lanes *work) {
  for (int k = last; k-- > first;) {
    const fem_panel *p   = &s->panel[k];
    const int       *row = s->row + p->row;
    for (int i = 0; i < p->rows; i++) work[i] = x[row[i]];
    backward(p, value + p->value, work);
    memcpy(x + p->first, work, (size_t)p->columns * sizeof *x);
  }
}

static void forward_subtree(const fem_supernodes *s, const double *value, int i, fem_lanes *x,
                            fem_lanes *work) {
  const fem_subtree *t = &s->subtree[i];
  memset(x + t->copy, 0, (size_t)t->n_copies * sizeof *x);
  forward_panels(s, value, t->first, t->last, x, work);
}

static void backward_subtree(const fem_supernodes *s, const double *value, int i, fem_lanes *x,
                             fem_lanes *work) {
  const fem_subtree *t        = &s->subtree[i];
  const int         *original = s->original + (t->copy - s->n);
  for (int c = 0; c < t->n_copies; c++) x[t->copy + c] = x[original[c]];
  backward_panels(s, value, t->first, t->last, x, work);
}

static void solve_top(const fem_supernodes *s, const double *value, fem_lanes *x, fem_lanes *work) {
  for (int c = s->n; c < s->n_extended; c++) x[s->original[c - s->n]] += x[c];
  for (int k = 0; k < s->n_panels; k++)
    if (s->is_top[k]) forward_panels(s, value, k, k + 1, x, work);
  for (int k = s->n_panels; k-- > 0;)
    if (s->is_top[k]) backward_panels(s, value, k, k + 1, x, work);
}

void fem_supernodal_solve(const fem_supernodes *s, const double *value, int threads, fem_lanes *x,
                          fem_lanes *work) {
#pragma omp parallel num_threads(threads)
  {
    fem_lanes *own = work + (size_t)omp_get_thread_num() * (size_t)s->most_rows;
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < s->n_subtrees; i++) forward_subtree(s, value, i, x, own);
#pragma omp single
    solve_top(s, value, x, own);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < s->n_subtrees; i++) backward_subtree(s, value, i, x, own);
  }
}

/* ------------------------------------------------------------------ many columns */

static bool is_zero(const double *x, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (x[i] != 0) return false;
  return true;
}

/* Right-hand sides of a few dofs touch only the panels above them in the elimination tree. */
void fem_panel_forward(const fem_panel *p, const double *L, const int *at, int count, double *own,
                       double *x, double *work) {
  const size_t n     = (size_t)count;
  const int    below = p->rows - p->columns;
  if (is_zero(own, (size_t)p->columns * n)) return;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, count, p->columns, 1,
              L, p->rows, own, count);
  if (below == 0) return;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, count, below, p->columns, 1, own, count,
              L + p->columns, p->rows, 0, work, count);
  for (int i = 0; i < below; i++) {
    double *to = x + (size_t)at[i] * n;
    for (size_t c = 0; c < n; c++) to[c] -= work[(size_t)i * n + c];
  }
}

void fem_panel_backward(const fem_panel *p, const double *L, const int *at, int count, double *own,
                        const double *x, double *work) {
  const size_t n     = (size_t)count;
  const int    below = p->rows - p->columns;
  for (int i = 0; i < below; i++)
    memcpy(work + (size_t)i * n, x + (size_t)at[i] * n, n * sizeof *work);
  if (below > 0)
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, count, p->columns, below, -1, work,
                count, L + p->columns, p->rows, 1, own, count);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, count, p->columns,
              1, L, p->rows, own, count);
}

static void place_rows(const fem_supernodes *s, const fem_panel *p, int *at) {
  for (int i = p->columns; i < p->rows; i++)
    at[i - p->columns] = fem_supernodes_row(s, p->row + (size_t)i);
}

void fem_supernodal_solve_block(const fem_supernodes *s, const double *value, const bool *needed,
                                int count, double *x, double *work, int *at) {
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *p = &s->panel[k];
    place_rows(s, p, at);
    fem_panel_forward(p, value + p->value, at, count, x + (size_t)p->first * (size_t)count, x,
                      work);
  }
  for (int k = s->n_panels; k-- > 0;) {
    const fem_panel *p = &s->panel[k];
    if (needed && !needed[k]) continue;
    place_rows(s, p, at);
    fem_panel_backward(p, value + p->value, at, count, x + (size_t)p->first * (size_t)count, x,
                       work);
  }
}
