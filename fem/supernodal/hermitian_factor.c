#include "fem/supernodal/hermitian_factor.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

typedef struct {
  const fem_hermitian_blocks *A;
  fem_hermitian_panels       *f;
  int                        *place;    /* [n] index of a row in the panel in work */
  int                        *relative; /* [most_rows] the same of an update's rows */
  double                     *update;   /* [2][FEM_PANEL_COLUMNS][most_rows] real, imaginary */
} workspace;

/* A panel in work, or rows of an earlier one: columns of ld numbers. */
typedef struct {
  int     rows, columns, ld;
  double *re, *im;
} part;

/* ------------------------------------------------------------------ entries of A */

static void put_entry(const fem_hermitian_blocks *A, int k, int i, bool turned, size_t at,
                      const part *L) {
  const int q = A->lower->block[k] < 0 ? ~A->lower->block[k] : A->lower->block[k];
  if (A->coupled_at[q] < 0) {
    L->re[at] = A->real[9 * (size_t)q + (size_t)i];
    return;
  }
  const double complex value = A->coupled[A->coupled_at[q]][i];
  L->re[at]                  = creal(value);
  L->im[at]                  = turned ? -cimag(value) : cimag(value);
}

/* The stored half of a block on the diagonal, and that of ~ its index, is transposed. */
static void fill(const workspace *w, const fem_panel *p, const part *L) {
  const fem_lower_pattern *lower = w->A->lower;
  memset(L->re, 0, 2 * (size_t)p->columns * (size_t)p->rows * sizeof *L->re);
  for (int j = 0; j < p->columns; j++) {
    const int c = (p->first + j) / 3, d = (p->first + j) % 3;
    for (int k = lower->start[c]; k < lower->start[c + 1]; k++) {
      const int  r      = lower->row[k];
      const bool turned = lower->block[k] < 0 || r == c;
      for (int e = r == c ? d : 0; e < 3; e++)
        put_entry(w->A, k, turned ? d + 3 * e : e + 3 * d, turned,
                  (size_t)j * (size_t)p->rows + (size_t)w->place[3 * r + e], L);
    }
  }
}

/* ------------------------------------------------------------------ updates */

/* to = old to + factor X Y^T, of m and n rows and k columns each, ld numbers apart. */
typedef struct {
  int m, n, k, ld;
} sizes;

static void multiply(sizes s, double factor, const double *x, const double *y, double old,
                     double *to, int ld) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, s.m, s.n, s.k, factor, x, s.ld, y, s.ld, old,
              to, ld);
}

/* to = old to + factor X X_n^H, X the rows of from and X_n the first n of them. In real parts,
 * Re = [X_r X_i] [X_r X_i]_n^T, as one follows the other, and Im = X_i X_rn^T - X_r X_in^T. */
static void product(const part *from, int n, double factor, double old, const part *to) {
  const sizes one = {from->rows, n, from->columns, from->ld};
  const sizes two = {from->rows, n, 2 * from->columns, from->ld};
  multiply(from->im ? two : one, factor, from->re, from->re, old, to->re, to->ld);
  if (!from->im) return;
  multiply(one, factor, from->im, from->re, old, to->im, to->ld);
  multiply(one, -factor, from->re, from->im, 1, to->im, to->ld);
}

/* L -= an update of n columns at the places relative. */
static void scatter(const workspace *w, const part *update, int n, const part *L) {
  const int *at = w->relative;
  for (int c = 0; c < n; c++) {
    const size_t  own = (size_t)c * (size_t)update->ld, to = (size_t)at[c] * (size_t)L->ld;
    const double *re = update->re + own, *im = update->im ? update->im + own : NULL;
    for (int i = c; i < update->rows; i++) L->re[to + (size_t)at[i]] -= re[i];
    for (int i = c; im && i < update->rows; i++) L->im[to + (size_t)at[i]] -= im[i];
  }
}

/* The same of a real update whose rows have phases. */
static void scatter_turned(const workspace *w, const part *update, int n, const signed char *g,
                           const part *L) {
  const int *at = w->relative;
  for (int c = 0; c < n; c++) {
    const double *value = update->re + (size_t)c * (size_t)update->ld;
    const size_t  to    = (size_t)at[c] * (size_t)L->ld;
    for (int i = c; i < update->rows; i++) {
      const double complex by = fem_hermitian_phase(w->f, g[i / 3] - g[c / 3]);
      L->re[to + (size_t)at[i]] -= creal(by) * value[i];
      L->im[to + (size_t)at[i]] -= cimag(by) * value[i];
    }
  }
}

/* Do all rows have the same phase? */
static bool same_turn(const signed char *g, int rows) {
  for (int i = 1; i < rows / 3; i++)
    if (g[i] != g[0]) return false;
  return true;
}

static void subtract(const workspace *w, const fem_update *up, const part *L) {
  const fem_hermitian_panels *f    = w->f;
  const fem_panel            *d    = &f->s->panel[up->from];
  const bool                  real = f->turns->is_real[up->from];
  const signed char          *g    = f->turns->g + (d->row + (size_t)up->begin) / 3;
  const int                  *at   = w->relative;
  const int                   m = d->rows - up->begin, n = up->end - up->begin;
  const size_t                size   = (size_t)d->columns * (size_t)d->rows;
  double                     *begin  = (real ? (double *)f->real : f->other) + d->value + up->begin;
  const part                  from   = {m, d->columns, d->rows, begin, real ? NULL : begin + size};
  const bool                  turned = real && f->turns->turns[up->from] && !same_turn(g, m);
  for (int i = 0; i < m; i++)
    w->relative[i] = w->place[fem_supernodes_row(f->s, d->row + (size_t)(up->begin + i))];
  if (!turned && at[m - 1] - at[0] == m - 1) {
    const size_t to = (size_t)at[0] * (size_t)L->ld + (size_t)at[0];
    product(&from, n, -1, 1, &(part){m, n, L->ld, L->re + to, L->im + to});
    return;
  }
  const part update = {m, n, m, w->update, real ? NULL : w->update + (size_t)m * (size_t)n};
  product(&from, n, 1, 0, &update);
  if (turned)
    scatter_turned(w, &update, n, g, L);
  else
    scatter(w, &update, n, L);
}

/* ------------------------------------------------------------------ panels */

static void join_parts(const part *L, double complex *z) {
  for (int c = 0; c < L->columns; c++)
    for (int i = 0; i < L->rows; i++) {
      const size_t at = (size_t)c * (size_t)L->ld + (size_t)i;
      *z++            = CMPLX(L->re[at], L->im[at]);
    }
}

static void split_parts(const double complex *z, const part *L) {
  for (int c = 0; c < L->columns; c++)
    for (int i = 0; i < L->rows; i++, z++) {
      const size_t at = (size_t)c * (size_t)L->ld + (size_t)i;
      L->re[at]       = creal(*z);
      L->im[at]       = cimag(*z);
    }
}

/* Of the panel's own columns; the rows below follow. The room of updates holds it as complex
 * numbers. */
static bool factorise_diagonal(const workspace *w, const part *L) {
  const double complex one = 1;
  double complex      *z   = (double complex *)w->update;
  const int            m = L->rows, n = L->columns;
  join_parts(L, z);
  if (LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'L', n, z, m) != 0) return false;
  if (m > n)
    cblas_ztrsm(CblasColMajor, CblasRight, CblasLower, CblasConjTrans, CblasNonUnit, m - n, n, &one,
                z, m, z + n, m);
  split_parts(z, L);
  return true;
}

static bool do_panel(const workspace *w, int k) {
  const fem_supernodes *s = w->f->s;
  const fem_panel      *p = &s->panel[k];
  double               *L = w->f->other + p->value;
  const part panel = {p->rows, p->columns, p->rows, L, L + (size_t)p->columns * (size_t)p->rows};
  for (int i = 0; i < p->rows; i++) w->place[fem_supernodes_row(s, p->row + (size_t)i)] = i;
  fill(w, p, &panel);
  for (int u = s->update_start[k]; u < s->update_start[k + 1]; u++)
    subtract(w, &s->update[u], &panel);
  return factorise_diagonal(w, &panel);
}

double fem_hermitian_workspace(const fem_supernodes *s) {
  return 4. * s->n + (16. * FEM_PANEL_COLUMNS + 4) * s->most_rows;
}

bool fem_hermitian_factorise(const fem_hermitian_blocks *A, fem_hermitian_panels *f) {
  const size_t rows = (size_t)f->s->most_rows + 1;
  workspace    w    = {A, f, shb_alloc((size_t)f->s->n + 1, sizeof *w.place),
                       shb_alloc(rows, sizeof *w.relative),
                       shb_alloc(2 * FEM_PANEL_COLUMNS * rows, sizeof *w.update)};
  bool         good = true;
  for (int k = 0; good && k < f->s->n_panels; k++)
    if (!f->turns->is_real[k]) good = do_panel(&w, k);
  free(w.place);
  free(w.relative);
  free(w.update);
  return good;
}
