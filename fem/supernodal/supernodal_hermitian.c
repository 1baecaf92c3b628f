#include "fem/supernodal/supernodal_hermitian.h"

#include "fem/supernodal/hot.h"

enum { GROUP = 4 }; /* columns that are processed together */

/* A panel: numbers [columns][rows], imaginary parts NULL where it is real. */
typedef struct {
  size_t        columns, rows;
  const double *re, *im;
} panel;

void fem_hermitian_set_phase(double complex turn, fem_hermitian_panels *panels) {
  double complex *zero = panels->phase + 2 * FEM_MOST_TURN;
  *zero                = 1;
  for (int g = 1; g <= 2 * FEM_MOST_TURN; g++) {
    zero[g]  = zero[g - 1] * turn;
    zero[-g] = conj(zero[g]);
  }
}

/* ------------------------------------------------------------------ complex panels */

/* w -= (re + j im) v */
FEM_KERNEL void take(double re, double im, const fem_complex_lanes *v, fem_complex_lanes *w) {
  w->re = w->re - re * v->re + im * v->im;
  w->im = w->im - re * v->im - im * v->re;
}

/* w_i -= L_ij w_j for the four columns from j and all rows i below them. */
FEM_KERNEL void take_four(const panel *p, size_t j, fem_complex_lanes *w) {
  const size_t            rows = p->rows;
  const double           *r0 = p->re + j * rows, *r1 = r0 + rows, *r2 = r1 + rows, *r3 = r2 + rows;
  const double           *i0 = p->im + j * rows, *i1 = i0 + rows, *i2 = i1 + rows, *i3 = i2 + rows;
  const fem_complex_lanes v0 = w[j], v1 = w[j + 1], v2 = w[j + 2], v3 = w[j + 3];
  for (size_t i = j + GROUP; i < rows; i++) {
    fem_complex_lanes at = w[i];
    take(r0[i], i0[i], &v0, &at);
    take(r1[i], i1[i], &v1, &at);
    take(r2[i], i2[i], &v2, &at);
    take(r3[i], i3[i], &v3, &at);
    w[i] = at;
  }
}

FEM_KERNEL void divide(fem_complex_lanes *w, double by) {
  w->re /= by;
  w->im /= by;
}

/* Solve L w = w. */
FEM_KERNEL void forward(const panel *p, fem_complex_lanes *w) {
  const size_t rows = p->rows;
  for (size_t j = 0; j < p->columns; j += GROUP) {
    const size_t group = p->columns - j < GROUP ? p->columns - j : GROUP;
    const size_t end   = group == GROUP ? j + group : rows;
    for (size_t a = j; a < j + group; a++) {
      divide(&w[a], p->re[a * rows + a]);
      const fem_complex_lanes v = w[a];
      for (size_t i = a + 1; i < end; i++)
        take(p->re[a * rows + i], p->im[a * rows + i], &v, &w[i]);
    }
    if (group == GROUP) take_four(p, j, w);
  }
}

/* sum += conj(re + j im) w */
FEM_KERNEL void add(double re, double im, const fem_complex_lanes *w, fem_complex_lanes *sum) {
  sum->re = sum->re + re * w->re + im * w->im;
  sum->im = sum->im + re * w->im - im * w->re;
}

/* sum_a = conj(L_ij) w_i over the rows below four columns. */
FEM_KERNEL void sum_four(const panel *p, size_t j, const fem_complex_lanes *w,
                         fem_complex_lanes sum[GROUP]) {
  const size_t      rows = p->rows;
  const double     *r0 = p->re + j * rows, *r1 = r0 + rows, *r2 = r1 + rows, *r3 = r2 + rows;
  const double     *i0 = p->im + j * rows, *i1 = i0 + rows, *i2 = i1 + rows, *i3 = i2 + rows;
  fem_complex_lanes s0 = {{0}, {0}}, s1 = s0, s2 = s0, s3 = s0;
  for (size_t i = j + GROUP; i < rows; i++) {
    const fem_complex_lanes at = w[i];
    add(r0[i], i0[i], &at, &s0);
    add(r1[i], i1[i], &at, &s1);
    add(r2[i], i2[i], &at, &s2);
    add(r3[i], i3[i], &at, &s3);
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
}

/* Solve L^H w = w. */
FEM_KERNEL void backward(const panel *p, fem_complex_lanes *w) {
  const size_t rows = p->rows;
  for (size_t left = p->columns; left > 0;) {
    const size_t      group = left % GROUP ? left % GROUP : GROUP, j = left - group;
    fem_complex_lanes sum[GROUP] = {{{0}, {0}}};
    const size_t      end        = group == GROUP ? j + group : rows;
    if (group == GROUP) sum_four(p, j, w, sum);
    for (size_t a = left; a-- > j;) {
      fem_complex_lanes below = sum[a - j];
      for (size_t i = a + 1; i < end; i++)
        add(p->re[a * rows + i], p->im[a * rows + i], &w[i], &below);
      w[a].re -= below.re;
      w[a].im -= below.im;
      divide(&w[a], p->re[a * rows + a]);
    }
    left = j;
  }
}

/* ------------------------------------------------------------------ real panels */

/* w -= l v */
FEM_KERNEL void take_real(double l, const fem_complex_lanes *v, fem_complex_lanes *w) {
  w->re -= l * v->re;
  w->im -= l * v->im;
}

FEM_KERNEL void take_four_real(const panel *p, size_t j, fem_complex_lanes *w) {
  const size_t            rows = p->rows;
  const double           *l0 = p->re + j * rows, *l1 = l0 + rows, *l2 = l1 + rows, *l3 = l2 + rows;
  const fem_complex_lanes v0 = w[j], v1 = w[j + 1], v2 = w[j + 2], v3 = w[j + 3];
  for (size_t i = j + GROUP; i < rows; i++) {
    w[i].re -= (l0[i] * v0.re + l1[i] * v1.re) + (l2[i] * v2.re + l3[i] * v3.re);
    w[i].im -= (l0[i] * v0.im + l1[i] * v1.im) + (l2[i] * v2.im + l3[i] * v3.im);
  }
}

FEM_KERNEL void forward_real(const panel *p, fem_complex_lanes *w) {
  const size_t rows = p->rows;
  for (size_t j = 0; j < p->columns; j += GROUP) {
    const size_t group = p->columns - j < GROUP ? p->columns - j : GROUP;
    const size_t end   = group == GROUP ? j + group : rows;
    for (size_t a = j; a < j + group; a++) {
      divide(&w[a], p->re[a * rows + a]);
      const fem_complex_lanes v = w[a];
      for (size_t i = a + 1; i < end; i++) take_real(p->re[a * rows + i], &v, &w[i]);
    }
    if (group == GROUP) take_four_real(p, j, w);
  }
}

/* sum_a = L_ij w_i over the rows below four columns. */
FEM_KERNEL void sum_four_real(const panel *p, size_t j, const fem_complex_lanes *w,
                              fem_complex_lanes sum[GROUP]) {
  const size_t      rows = p->rows;
  const double     *l0 = p->re + j * rows, *l1 = l0 + rows, *l2 = l1 + rows, *l3 = l2 + rows;
  fem_complex_lanes s0 = {{0}, {0}}, s1 = s0, s2 = s0, s3 = s0;
  for (size_t i = j + GROUP; i < rows; i++) {
    const fem_complex_lanes v = w[i];
    s0.re += l0[i] * v.re, s1.re += l1[i] * v.re, s2.re += l2[i] * v.re, s3.re += l3[i] * v.re;
    s0.im += l0[i] * v.im, s1.im += l1[i] * v.im, s2.im += l2[i] * v.im, s3.im += l3[i] * v.im;
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
}

FEM_KERNEL void backward_real(const panel *p, fem_complex_lanes *w) {
  const size_t rows = p->rows;
  for (size_t left = p->columns; left > 0;) {
    const size_t      group = left % GROUP ? left % GROUP : GROUP, j = left - group;
    fem_complex_lanes sum[GROUP] = {{{0}, {0}}};
    const size_t      end        = group == GROUP ? j + group : rows;
    if (group == GROUP) sum_four_real(p, j, w, sum);
    for (size_t a = left; a-- > j;) {
      fem_complex_lanes v = w[a];
      v.re -= sum[a - j].re;
      v.im -= sum[a - j].im;
      for (size_t i = a + 1; i < end; i++) take_real(p->re[a * rows + i], &w[i], &v);
      divide(&v, p->re[a * rows + a]);
      w[a] = v;
    }
    left = j;
  }
}

/* ------------------------------------------------------------------ all panels */

FEM_KERNEL panel get(const fem_hermitian_panels *f, int k) {
  const fem_panel *p    = &f->s->panel[k];
  const size_t     size = (size_t)p->columns * (size_t)p->rows;
  const bool       real = f->turns->is_real[k];
  const double    *at   = (real ? f->real : f->other) + p->value;
  return (panel){(size_t)p->columns, (size_t)p->rows, at, real ? NULL : at + size};
}

/* w_i *= e^(-+j theta g_i): into the real form of a panel with phases, and back. */
FEM_KERNEL void turn(const fem_hermitian_panels *f, int k, int sign, int rows,
                     fem_complex_lanes *w) {
  const signed char *g = f->turns->g + f->s->panel[k].row / 3;
  for (int i = 0; i < rows; i++) {
    if (g[i / 3] == 0) continue;
    const double complex    by = fem_hermitian_phase(f, sign * g[i / 3]);
    const fem_complex_lanes v  = w[i];
    w[i].re                    = creal(by) * v.re - cimag(by) * v.im;
    w[i].im                    = creal(by) * v.im + cimag(by) * v.re;
  }
}

FEM_KERNEL void gather(const fem_supernodes *s, const fem_panel *p, const fem_complex_lanes *x,
                       fem_complex_lanes *w) {
  for (int i = 0; i < p->rows; i++) w[i] = x[fem_supernodes_row(s, p->row + (size_t)i)];
}

FEM_HOT void fem_supernodal_solve_hermitian(const fem_hermitian_panels *f, fem_complex_lanes *x,
                                            fem_complex_lanes *w) {
  const fem_supernodes *s = f->s;
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *at = &s->panel[k];
    const panel      p  = get(f, k);
    gather(s, at, x, w);
    if (f->turns->turns[k]) turn(f, k, -1, at->rows, w);
    if (p.im)
      forward(&p, w);
    else
      forward_real(&p, w);
    if (f->turns->turns[k]) turn(f, k, 1, at->rows, w);
    for (int i = 0; i < at->rows; i++) x[fem_supernodes_row(s, at->row + (size_t)i)] = w[i];
  }
  for (int k = s->n_panels; k-- > 0;) {
    const fem_panel *at = &s->panel[k];
    const panel      p  = get(f, k);
    gather(s, at, x, w);
    if (f->turns->turns[k]) turn(f, k, -1, at->rows, w);
    if (p.im)
      backward(&p, w);
    else
      backward_real(&p, w);
    if (f->turns->turns[k]) turn(f, k, 1, at->columns, w);
    for (int i = 0; i < at->columns; i++) x[at->first + i] = w[i];
  }
}
