#include "mhb/branches/period_doubling.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

typedef struct {
  int    *at; /* [size] places of the odd harmonics in x */
  double *jacobian, *odd, *u, *vt, *s;
  double *r;
} workspace;

static void release(workspace *w) {
  free(w->at);
  free(w->jacobian);
  free(w->odd);
  free(w->u);
  free(w->vt);
  free(w->s);
  free(w->r);
}

static void decompose(mhb_balance *b, workspace *w, int size, const double *x, double value,
                      double *along, double *least) {
  size_t n = (size_t)b->n, m = (size_t)size;
  mhb_balance_evaluate(b, x, value, w->r, w->jacobian, NULL);
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++)
      w->odd[j * m + i] = w->jacobian[(size_t)w->at[j] * n + (size_t)w->at[i]];
  lapack_int bad = LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'S', size, size, w->odd, size, w->s, w->u, size,
                                  w->vt, size);
  *least         = bad == 0 ? w->s[size - 1] : INFINITY;
  memset(along, 0, sizeof(double) * n);
  for (size_t j = 0; j < m; j++) along[w->at[j]] = bad == 0 ? w->vt[j * m + m - 1] : 0;
}

void mhb_period_doubling_direction(mhb_balance *b, const double *x, double value, double *along,
                                   double *least) {
  int    size = 0;
  size_t n = (size_t)b->n, room = (size_t)(b->n / b->nb) * 2 * (size_t)((b->m + 1) / 2);

  workspace w = {.at       = shb_alloc_zeroed(room, sizeof(int)),
                 .jacobian = shb_alloc_zeroed(n * n, sizeof(double)),
                 .odd      = shb_alloc_zeroed(room * room, sizeof(double)),
                 .u        = shb_alloc_zeroed(room * room, sizeof(double)),
                 .vt       = shb_alloc_zeroed(room * room, sizeof(double)),
                 .s        = shb_alloc_zeroed(room, sizeof(double)),
                 .r        = shb_alloc_zeroed(n, sizeof(double))};
  for (int i = 0; i < b->n; i++)
    if ((i % b->nb + 1) / 2 % 2 == 1) w.at[size++] = i;
  decompose(b, &w, size, x, value, along, least);
  release(&w);
}
