#include "fem/solver/block_order.h"

#include <omp.h>
#include <string.h>

void fem_cholmod_start(cholmod_common *common) {
  cholmod_start(common);
  common->print                      = 0;
  common->quick_return_if_not_posdef = 1;
  common->nmethods                   = 1;
  common->zrelax[0] = .3, common->zrelax[1] = .05, common->zrelax[2] = .02;
}

bool fem_block_order(const fem_blocks *b, cholmod_common *common, int *place) {
  const size_t    n = (size_t)b->n, count = (size_t)b->start[n];
  cholmod_sparse *graph = cholmod_allocate_sparse(n, n, count, 1, 1, -1, CHOLMOD_PATTERN, common);
  if (!graph) return false;
  memcpy(graph->p, b->start, (n + 1) * sizeof(int));
  memcpy(graph->i, b->column, count * sizeof(int));
  common->method[0].ordering = CHOLMOD_NESDIS;
  common->supernodal         = CHOLMOD_SIMPLICIAL;
  common->postorder          = 1;
  cholmod_factor *order      = cholmod_analyze(graph, common);
  if (order)
    for (size_t i = 0; i < n; i++) place[((const int *)order->Perm)[i]] = (int)i;
  bool good = order != NULL;
  cholmod_free_factor(&order, common);
  cholmod_free_sparse(&graph, common);
  return good;
}

void fem_block_starts(const fem_blocks *b, const int *place, int *next, int *start) {
  int total = 0;
  for (int r = 0; r < b->n; r++)
    for (int q = b->start[r]; q < b->start[r + 1]; q++) {
      int here = place[r], there = place[b->column[q]];
      if (here != there) next[here < there ? here : there]++;
    }
  for (int c = 0; c < b->n; c++) {
    for (int d = 0; d < 3; d++) {
      start[3 * c + d] = total;
      total += 3 - d + 3 * next[c];
    }
    next[c] = 0;
  }
  start[3 * (size_t)b->n] = total;
}

cholmod_factor *fem_cholmod_analyse(cholmod_sparse *A, cholmod_common *common) {
  common->method[0].ordering = CHOLMOD_NATURAL;
  common->supernodal         = CHOLMOD_SUPERNODAL;
  common->postorder          = 0;
  return cholmod_analyze(A, common);
}

void fem_cholmod_factorise(cholmod_sparse *A, cholmod_factor *L, cholmod_common *common) {
  const int levels = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
  cholmod_factorize(A, L, common);
  omp_set_max_active_levels(levels);
}
