#include "fem/solver/supernodal_solve.h"

#include "fem/solver/supernodal_solve_internal.h"

enum { GROUP = 8 }; /* columns that are processed together */

/* A supernode: columns first .. first + columns - 1, dense from the diagonal down. */
typedef struct {
  int           columns, rows;
  const int    *row;   /* [rows]; the first ones are the columns themselves */
  const double *value; /* [columns][rows] */
} supernode;

FEM_KERNEL supernode get(const cholmod_factor *L, size_t s) {
  const int *super = L->super, *pi = L->pi, *px = L->px;
  return (supernode){super[s + 1] - super[s], pi[s + 1] - pi[s], (const int *)L->s + pi[s],
                     (const double *)L->x + px[s]};
}

size_t fem_supernodal_rows(const cholmod_factor *L) {
  size_t most = 1;
  for (size_t s = 0; s < L->nsuper; s++) {
    size_t rows = (size_t)get(L, s).rows;
    if (rows > most) most = rows;
  }
  return most;
}

/* w_i -= L_ij w_j for the eight columns from j and all rows i below them. */
FEM_KERNEL void take_eight(const double *l, size_t rows, size_t j, fem_lanes *w) {
  const double   *l0 = l, *l1 = l0 + rows, *l2 = l1 + rows, *l3 = l2 + rows;
  const double   *l4 = l3 + rows, *l5 = l4 + rows, *l6 = l5 + rows, *l7 = l6 + rows;
  const fem_lanes v0 = w[j], v1 = w[j + 1], v2 = w[j + 2], v3 = w[j + 3];
  const fem_lanes v4 = w[j + 4], v5 = w[j + 5], v6 = w[j + 6], v7 = w[j + 7];
  for (size_t i = j + GROUP; i < rows; i++)
    w[i] -= ((l0[i] * v0 + l1[i] * v1) + (l2[i] * v2 + l3[i] * v3)) +
            ((l4[i] * v4 + l5[i] * v5) + (l6[i] * v6 + l7[i] * v7));
}

/* Solve L w = w. */
FEM_KERNEL void forward(const supernode *s, fem_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t j = 0; j < columns; j += GROUP) {
    const double *l     = s->value + j * rows;
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
    s0 += l0[i] * v, s1 += l1[i] * v, s2 += l2[i] * v, s3 += l3[i] * v;
    s4 += l4[i] * v, s5 += l5[i] * v, s6 += l6[i] * v, s7 += l7[i] * v;
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
  sum[4] = s4, sum[5] = s5, sum[6] = s6, sum[7] = s7;
}

/* Solve L^T w = w. */
FEM_KERNEL void backward(const supernode *s, fem_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t left = columns; left > 0;) {
    const size_t  group = left % GROUP ? left % GROUP : GROUP, j = left - group;
    const double *l          = s->value + j * rows;
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

FEM_HOT void fem_supernodal_solve(const cholmod_factor *L, fem_lanes *x, fem_lanes *work) {
  for (size_t k = 0; k < L->nsuper; k++) {
    const supernode s = get(L, k);
    for (int i = 0; i < s.rows; i++) work[i] = x[s.row[i]];
    forward(&s, work);
    for (int i = 0; i < s.rows; i++) x[s.row[i]] = work[i];
  }
  for (size_t k = L->nsuper; k-- > 0;) {
    const supernode s = get(L, k);
    for (int i = 0; i < s.rows; i++) work[i] = x[s.row[i]];
    backward(&s, work);
    for (int i = 0; i < s.columns; i++) x[s.row[i]] = work[i];
  }
}
