#include "fem/supernodal/block_order.h"

#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/coarse_order.h"
#include "mesh/base/memory.h"

void fem_cholmod_start(cholmod_common *common) {
  cholmod_start(common);
  common->print                      = 0;
  common->quick_return_if_not_posdef = 1;
  common->nmethods                   = 1;
  common->method[0].ordering         = CHOLMOD_NESDIS;
  common->supernodal                 = CHOLMOD_SUPERNODAL;
  common->postorder                  = 1;
  common->nrelax[0] = 2, common->nrelax[1] = 5, common->nrelax[2] = 16; /* nodes */
  common->zrelax[0] = .3, common->zrelax[1] = .05, common->zrelax[2] = .02;
}

cholmod_factor *fem_block_analyse(const fem_blocks *b, cholmod_common *common, int *place) {
  const size_t    n = (size_t)b->n, count = (size_t)b->start[n];
  cholmod_sparse *graph = cholmod_allocate_sparse(n, n, count, 1, 1, -1, CHOLMOD_PATTERN, common);
  if (!graph) shb_out_of_memory((double)(n + count) * sizeof(int));
  memcpy(graph->p, b->start, (n + 1) * sizeof(int));
  memcpy(graph->i, b->column, count * sizeof(int));
  int       *order           = shb_alloc(n + 1, sizeof *order);
  const bool given           = fem_coarse_order(graph, common, order);
  common->method[0].ordering = given ? CHOLMOD_GIVEN : CHOLMOD_NESDIS;
  cholmod_factor *L          = cholmod_analyze_p(graph, given ? order : NULL, NULL, 0, common);
  free(order);
  if (!L && common->status != CHOLMOD_TOO_LARGE) shb_out_of_memory(0);
  if (L)
    for (size_t i = 0; i < n; i++) place[((const int *)L->Perm)[i]] = (int)i;
  cholmod_free_sparse(&graph, common);
  return L;
}

void fem_lower_pattern_create(const fem_blocks *b, const int *place, fem_lower_pattern *out) {
  const size_t n = (size_t)b->n, count = (size_t)b->start[n];
  int *start = shb_alloc_zeroed(n + 2, sizeof *start), *row = shb_alloc(count + 1, sizeof *row),
      *block = shb_alloc(count + 1, sizeof *block);
  *out       = (fem_lower_pattern){b->n, start, row, block};
  for (int pass = 0; pass < 2; pass++) { /* counts two places on, then start one place on */
    for (int r = 0; r < b->n; r++)
      for (int q = b->start[r]; q < b->start[r + 1]; q++) {
        const int here = place[r], there = place[b->column[q]];
        const int low = here < there ? here : there;
        if (pass == 0) {
          if (low + 2 <= b->n) start[low + 2]++;
          continue;
        }
        const int at = start[low + 1]++;
        row[at]      = here < there ? there : here;
        block[at]    = here < there ? ~q : q;
      }
    for (size_t c = 2; pass == 0 && c <= n; c++) start[c] += start[c - 1];
  }
}

void fem_lower_pattern_free(fem_lower_pattern *lower) {
  free(lower->start);
  free(lower->row);
  free(lower->block);
  *lower = (fem_lower_pattern){0};
}
