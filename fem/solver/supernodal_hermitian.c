#include "fem/solver/supernodal_hermitian.h"

#include "fem/solver/hot.h"

enum { GROUP = 4 }; /* columns that are processed together */

/* A supernode: columns first .. first + columns - 1, dense from the diagonal down. Numbers are
 * pairs (Re, Im). The diagonal is real. */
typedef struct {
  int           columns, rows;
  const int    *row;   /* [rows]; the first ones are the columns themselves */
  const double *value; /* [columns][rows][2] */
} supernode;

FEM_KERNEL supernode get(const cholmod_factor *L, size_t s) {
  const int *super = L->super, *pi = L->pi, *px = L->px;
  return (supernode){super[s + 1] - super[s], pi[s + 1] - pi[s], (const int *)L->s + pi[s],
                     (const double *)L->x + 2 * (size_t)px[s]};
}

size_t fem_supernodal_hermitian_rows(const cholmod_factor *L) {
  size_t most = 1;
  for (size_t s = 0; s < L->nsuper; s++) {
    size_t rows = (size_t)get(L, s).rows;
    if (rows > most) most = rows;
  }
  return most;
}

/* w -= l v */
FEM_KERNEL void take(const double *l, const fem_complex_lanes *v, fem_complex_lanes *w) {
  w->re = w->re - l[0] * v->re + l[1] * v->im;
  w->im = w->im - l[0] * v->im - l[1] * v->re;
}

/* w_i -= L_ij w_j for the four columns from j and all rows i below them. */
FEM_KERNEL void take_four(const double *l, size_t rows, size_t j, fem_complex_lanes *w) {
  const double           *l0 = l, *l1 = l0 + 2 * rows, *l2 = l1 + 2 * rows, *l3 = l2 + 2 * rows;
  const fem_complex_lanes v0 = w[j], v1 = w[j + 1], v2 = w[j + 2], v3 = w[j + 3];
  for (size_t i = j + GROUP; i < rows; i++) {
    fem_complex_lanes at = w[i];
    take(l0 + 2 * i, &v0, &at);
    take(l1 + 2 * i, &v1, &at);
    take(l2 + 2 * i, &v2, &at);
    take(l3 + 2 * i, &v3, &at);
    w[i] = at;
  }
}

/* Solve L w = w. */
FEM_KERNEL void forward(const supernode *s, fem_complex_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t j = 0; j < columns; j += GROUP) {
    const double *l     = s->value + 2 * j * rows;
    const size_t  group = columns - j < GROUP ? columns - j : GROUP;
    const size_t  end   = group == GROUP ? j + group : rows;
    for (size_t a = 0; a < group; a++) {
      const double *column = l + 2 * a * rows;
      w[j + a].re /= column[2 * (j + a)];
      w[j + a].im /= column[2 * (j + a)];
      const fem_complex_lanes v = w[j + a];
      for (size_t i = j + a + 1; i < end; i++) take(column + 2 * i, &v, &w[i]);
    }
    if (group == GROUP) take_four(l, rows, j, w);
  }
}

/* sum += conj(l) w */
FEM_KERNEL void add(const double *l, const fem_complex_lanes *w, fem_complex_lanes *sum) {
  sum->re = sum->re + l[0] * w->re + l[1] * w->im;
  sum->im = sum->im + l[0] * w->im - l[1] * w->re;
}

/* sum_a = conj(L_ij) w_i over the rows below four columns. */
FEM_KERNEL void sum_four(const double *l, size_t rows, size_t j, const fem_complex_lanes *w,
                         fem_complex_lanes sum[GROUP]) {
  const double     *l0 = l, *l1 = l0 + 2 * rows, *l2 = l1 + 2 * rows, *l3 = l2 + 2 * rows;
  fem_complex_lanes s0 = {{0}, {0}}, s1 = s0, s2 = s0, s3 = s0;
  for (size_t i = j + GROUP; i < rows; i++) {
    const fem_complex_lanes at = w[i];
    add(l0 + 2 * i, &at, &s0);
    add(l1 + 2 * i, &at, &s1);
    add(l2 + 2 * i, &at, &s2);
    add(l3 + 2 * i, &at, &s3);
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
}

/* Solve L^H w = w. */
FEM_KERNEL void backward(const supernode *s, fem_complex_lanes *w) {
  const size_t rows = (size_t)s->rows, columns = (size_t)s->columns;
  for (size_t left = columns; left > 0;) {
    const size_t      group = left % GROUP ? left % GROUP : GROUP, j = left - group;
    const double     *l          = s->value + 2 * j * rows;
    fem_complex_lanes sum[GROUP] = {{{0}, {0}}};
    const size_t      end        = group == GROUP ? j + group : rows;
    if (group == GROUP) sum_four(l, rows, j, w, sum);
    for (size_t a = group; a-- > 0;) {
      const double     *column = l + 2 * a * rows;
      fem_complex_lanes below  = sum[a];
      for (size_t i = j + a + 1; i < end; i++) add(column + 2 * i, &w[i], &below);
      w[j + a].re = (w[j + a].re - below.re) / column[2 * (j + a)];
      w[j + a].im = (w[j + a].im - below.im) / column[2 * (j + a)];
    }
    left = j;
  }
}

FEM_HOT void fem_supernodal_solve_hermitian(const cholmod_factor *L, fem_complex_lanes *x,
                                            fem_complex_lanes *work) {
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
