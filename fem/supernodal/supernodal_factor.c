#include "fem/supernodal/supernodal_factor.h"

#include <cblas.h>
#include <lapacke.h>
#include <omp.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { SPINS = 2000 }; /* looks at a panel in work before the processor is given to others */

typedef struct {
  const fem_supernodes    *s;
  const fem_lower_pattern *lower;
  const double            *block; /* [block][9] */
  const bool              *only;
  double                  *value;
  atomic_bool             *done; /* [n_panels] */
  atomic_int               next; /* piece of work: subtrees, then panels */
  atomic_bool              failed;
} factorisation;

/* Of one thread. */
typedef struct {
  int    *place;    /* [n] index of a row in the panel in work */
  int    *relative; /* [most_rows] the same of an update's rows */
  double *update;   /* [FEM_PANEL_COLUMNS][most_rows] */
} workspace;

/* ------------------------------------------------------------------ one panel */

/* Put the entries of A into the panel. */
static void fill(const factorisation *f, const fem_panel *p, const int *place, double *L) {
  const fem_lower_pattern *A = f->lower;
  memset(L, 0, (size_t)p->columns * (size_t)p->rows * sizeof *L);
  for (int j = 0; j < p->columns; j++) {
    const int c = (p->first + j) / 3, d = (p->first + j) % 3;
    double   *column = L + (size_t)j * (size_t)p->rows;
    for (int k = A->start[c]; k < A->start[c + 1]; k++) {
      const int     q = A->block[k], r = A->row[k];
      const double *B = f->block + 9 * (size_t)(q < 0 ? ~q : q);
      for (int e = r == c ? d : 0; e < 3; e++)
        column[place[3 * r + e]] = q < 0 || r == c ? B[d + 3 * e] : B[e + 3 * d];
    }
  }
}

/* L -= the product of m rows of an earlier panel with the first n of them, at the places relative.
 * Numbers above the diagonal are changed too; nobody reads them.
 *   from  in  [k][ld] first of these rows */
static void subtract(const double *from, int ld, int m, int n, int k, const workspace *w, double *L,
                     int rows) {
  const int *at       = w->relative;
  const bool together = at[m - 1] - at[0] == m - 1;
  double    *to       = together ? L + (size_t)at[0] * (size_t)rows + at[0] : w->update;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, m, n, k, together ? -1 : 1, from, ld, from,
              ld, together, to, together ? rows : m);
  for (int c = 0; c < n && !together; c++) {
    const double *sum    = w->update + (size_t)c * (size_t)m;
    double       *column = L + (size_t)at[c] * (size_t)rows;
    for (int i = c; i < m; i++) column[at[i]] -= sum[i];
  }
}

static void wait_for(const atomic_bool *done, const atomic_bool *failed) {
  for (int spins = 0; !atomic_load_explicit(done, memory_order_acquire); spins++)
    if (atomic_load_explicit(failed, memory_order_relaxed))
      return;
    else if (spins > SPINS)
      sched_yield();
}

static bool factorise_diagonal(const fem_panel *p, double *L) {
  const int below = p->rows - p->columns;
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', p->columns, L, p->rows) != 0) return false;
  if (below > 0)
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, below, p->columns,
                1, L, p->rows, L + p->columns, p->rows);
  return true;
}

static void do_panel(factorisation *f, int k, const workspace *w) {
  const fem_supernodes *s = f->s;
  const fem_panel      *p = &s->panel[k];
  double               *L = f->value + p->value;
  for (int i = 0; i < p->rows; i++) w->place[fem_supernodes_row(s, p->row + (size_t)i)] = i;
  fill(f, p, w->place, L);
  for (int u = s->update_start[k]; u < s->update_start[k + 1]; u++) {
    const fem_update *up = &s->update[u];
    const fem_panel  *d  = &s->panel[up->from];
    wait_for(&f->done[up->from], &f->failed);
    if (atomic_load_explicit(&f->failed, memory_order_relaxed)) return;
    for (int i = up->begin; i < d->rows; i++)
      w->relative[i - up->begin] = w->place[fem_supernodes_row(s, d->row + (size_t)i)];
    subtract(f->value + d->value + up->begin, d->rows, d->rows - up->begin, up->end - up->begin,
             d->columns, w, L, p->rows);
  }
  if (!factorise_diagonal(p, L)) atomic_store(&f->failed, true);
  atomic_store_explicit(&f->done[k], true, memory_order_release);
}

/* ------------------------------------------------------------------ all panels */

static void create_workspace(const fem_supernodes *s, workspace *w) {
  w->place    = shb_alloc((size_t)s->n + 1, sizeof *w->place);
  w->relative = shb_alloc((size_t)s->most_rows + 1, sizeof *w->relative);
  w->update   = shb_alloc(FEM_PANEL_COLUMNS * ((size_t)s->most_rows + 1), sizeof *w->update);
}

static void free_workspace(workspace *w) {
  free(w->place);
  free(w->relative);
  free(w->update);
}

double fem_supernodal_workspace(const fem_supernodes *s, int threads) {
  return threads * (4. * s->n + (8. * FEM_PANEL_COLUMNS + 4) * s->most_rows);
}

/* Take pieces of work until there are none. A piece waits for earlier ones only. */
static void work(factorisation *f, const int *top, int n_top, const workspace *w) {
  const fem_supernodes *s = f->s;
  for (;;) {
    const int piece = atomic_fetch_add(&f->next, 1);
    if (piece >= s->n_subtrees + n_top) return;
    const int first = piece < s->n_subtrees ? s->subtree[piece].first : top[piece - s->n_subtrees];
    const int last  = piece < s->n_subtrees ? s->subtree[piece].last : first + 1;
    for (int k = first; k < last && !atomic_load(&f->failed); k++)
      if (!f->only || f->only[k]) do_panel(f, k, w);
  }
}

bool fem_supernodal_factorise(const fem_supernodes *s, const fem_lower_pattern *lower,
                              const double *block, const bool *only, double *value) {
  const int     most  = omp_get_max_threads();
  factorisation f     = {.s = s, .lower = lower, .block = block, .only = only, .value = value};
  workspace    *w     = shb_alloc_zeroed((size_t)most, sizeof *w);
  int          *top   = shb_alloc((size_t)s->n_panels + 1, sizeof *top);
  int           n_top = 0;
  f.done              = shb_alloc_zeroed((size_t)s->n_panels + 1, sizeof *f.done);
  for (int i = 0; i < most; i++) create_workspace(s, &w[i]);
  for (int k = 0; k < s->n_panels; k++)
    if (s->is_top[k]) top[n_top++] = k;
#pragma omp parallel num_threads(most)
  work(&f, top, n_top, &w[omp_get_thread_num()]);
  for (int i = 0; i < most; i++) free_workspace(&w[i]);
  free(w);
  free(top);
  free(f.done);
  return !f.failed;
}
