#include "fem/panels.h"

#include <petscsys.h>
#include <stdlib.h>
#include <string.h>

#include <petscblaslapack.h> /* after what it needs */

/* A supernode: its columns, dense from the diagonal down. */
typedef struct {
  PetscBLASInt columns, rows;
  int          first; /* column */
  const int   *row;   /* [rows]; the first ones are the columns themselves */
  double      *value; /* [columns][rows] */
} panel;

/* Panels wait in the list of the next one that has rows of theirs among its columns. */
typedef struct {
  const cholmod_factor *L;
  int                  *owner;       /* [n] panel of a column */
  int                  *place;       /* [n] of a row in the panel at hand */
  int                  *head, *next; /* [panel] lists; -1: the end */
  int                  *done;        /* [panel] rows that it has been taken for */
  double               *C;           /* [maxcsize] */
} workspace;

static const double one = 1, zero = 0;

static panel get(const cholmod_factor *L, int s) {
  const int *super = L->super, *pi = L->pi, *px = L->px;
  return (panel){super[s + 1] - super[s], pi[s + 1] - pi[s], super[s], (const int *)L->s + pi[s],
                 (double *)L->x + px[s]};
}

static bool create(const cholmod_factor *L, workspace *w) {
  const size_t n = L->n, panels = L->nsuper;
  *w = (workspace){.L     = L,
                   .owner = malloc((n + 1) * sizeof(int)),
                   .place = malloc((n + 1) * sizeof(int)),
                   .head  = malloc((panels + 1) * sizeof(int)),
                   .next  = malloc((panels + 1) * sizeof(int)),
                   .done  = malloc((panels + 1) * sizeof(int)),
                   .C     = malloc((L->maxcsize + 1) * sizeof(double))};
  if (!w->owner || !w->place || !w->head || !w->next || !w->done || !w->C) return false;
  for (int s = 0; s < (int)panels; s++) {
    const panel p = get(L, s);
    w->head[s]    = -1;
    for (int c = 0; c < p.columns; c++) w->owner[p.first + c] = s;
  }
  return true;
}

static void destroy(workspace *w) {
  free(w->owner);
  free(w->place);
  free(w->head);
  free(w->next);
  free(w->done);
  free(w->C);
}

/* Hand panel s on to the one that owns its next row. */
static void hand_on(workspace *w, int s) {
  const panel p = get(w->L, s);
  if (w->done[s] == p.rows) return;
  const int to = w->owner[p.row[w->done[s]]];
  w->next[s]   = w->head[to];
  w->head[to]  = s;
}

/* The columns of A. */
static void put(const workspace *w, const cholmod_sparse *A, const panel *p) {
  const int    *start = A->p, *row = A->i;
  const double *value = A->x;
  for (int i = 0; i < p->rows; i++) w->place[p->row[i]] = i;
  memset(p->value, 0, (size_t)p->rows * (size_t)p->columns * sizeof(double));
  for (int c = 0; c < p->columns; c++) {
    double *column = p->value + (size_t)c * (size_t)p->rows;
    for (int k = start[p->first + c]; k < start[p->first + c + 1]; k++)
      column[w->place[row[k]]] = value[k];
  }
}

/* Less what an earlier panel d has there: its rows from done on, those among p's columns times all of them. */
static void take(workspace *w, const panel *p, int d) {
  const panel   from  = get(w->L, d);
  const int     begin = w->done[d], last = p->first + p->columns;
  PetscBLASInt  here = 0, rows = from.rows - begin;
  const int    *row   = from.row + begin;
  const double *value = from.value + begin;
  while (here < rows && row[here] < last) here++;
  PetscBLASInt below = rows - here;
  BLASsyrk_("L", "N", &here, &from.columns, &one, value, &from.rows, &zero, w->C, &rows);
  if (below > 0)
    BLASgemm_("N", "T", &below, &here, &from.columns, &one, value + here, &from.rows, value,
              &from.rows, &zero, w->C + here, &rows);
  for (int j = 0; j < here; j++) {
    double       *column = p->value + (size_t)(row[j] - p->first) * (size_t)p->rows;
    const double *c      = w->C + (size_t)j * (size_t)rows;
    for (int i = j; i < rows; i++) column[w->place[row[i]]] -= c[i];
  }
  w->done[d] = begin + here;
}

/* Its own columns: L L^T = diagonal block, and the rows below times L^-T. */
static bool finish(const panel *p) {
  PetscBLASInt info, below = p->rows - p->columns;
  LAPACKpotrf_("L", &p->columns, p->value, &p->rows, &info);
  if (info != 0) return false;
  if (below > 0)
    BLAStrsm_("R", "L", "T", "N", &below, &p->columns, &one, p->value, &p->rows,
              p->value + p->columns, &p->rows);
  return true;
}

bool fem_panels_fill(cholmod_factor *L, const cholmod_sparse *A, bool *definite,
                     cholmod_common *common) {
  workspace w;
  *definite = true;
  if (!L->x && !cholmod_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, L, common)) return false;
  if (!create(L, &w)) {
    destroy(&w);
    return false;
  }
  for (int s = 0; s < (int)L->nsuper && *definite; s++) {
    const panel p = get(L, s);
    put(&w, A, &p);
    for (int d = w.head[s], next; d >= 0; d = next) {
      next = w.next[d];
      take(&w, &p, d);
      hand_on(&w, d);
    }
    *definite = finish(&p);
    w.done[s] = p.columns;
    hand_on(&w, s);
  }
  destroy(&w);
  return true;
}
