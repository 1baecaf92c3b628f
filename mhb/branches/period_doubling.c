#include "mhb/branches/period_doubling.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static shb_status decompose(mhb_balance *b, workspace *w, int size, const double *x, double value,
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
  return SHB_OK;
}

shb_status mhb_period_doubling_direction(mhb_balance *b, const double *x, double value,
                                         double *along, double *least) {
  int    size = 0;
  size_t n = (size_t)b->n, room = (size_t)(b->n / b->nb) * 2 * (size_t)((b->m + 1) / 2);

  workspace w = {.at       = calloc(room + 1, sizeof(int)),
                 .jacobian = calloc(n * n, sizeof(double)),
                 .odd      = calloc(room * room + 1, sizeof(double)),
                 .u        = calloc(room * room + 1, sizeof(double)),
                 .vt       = calloc(room * room + 1, sizeof(double)),
                 .s        = calloc(room + 1, sizeof(double)),
                 .r        = calloc(n, sizeof(double))};
  for (int i = 0; w.at && i < b->n; i++)
    if ((i % b->nb + 1) / 2 % 2 == 1) w.at[size++] = i;
  shb_status status = w.at && w.jacobian && w.odd && w.u && w.vt && w.s && w.r
                          ? decompose(b, &w, size, x, value, along, least)
                          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__,
                                     "out of memory for the %d unknowns of a flip", b->n);
  release(&w);
  return status;
}
