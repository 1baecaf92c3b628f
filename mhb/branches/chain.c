#include "mhb/branches/chain.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

void mhb_chain_free(mhb_chain *chain) {
  free(chain->link);
  *chain = (mhb_chain){0};
}

void mhb_chain_insert(mhb_chain *chain, int at, mhb_link link) {
  if (chain->n == chain->room) {
    chain->room = 2 * chain->room + 8;
    chain->link = shb_realloc(chain->link, (size_t)chain->room, sizeof *chain->link);
  }
  memmove(chain->link + at + 1, chain->link + at, sizeof link * (size_t)(chain->n - at));
  chain->link[at] = link;
  chain->n++;
}

/* After reversal a link joins its predecessor if its former successor joined it. */
void mhb_chain_reverse(mhb_chain *chain, int from) {
  int      n = chain->n;
  mhb_link old[n + 1];
  memcpy(old, chain->link, sizeof old[0] * (size_t)n);
  for (int i = from; i < n; i++) {
    mhb_link *link = &chain->link[i];
    int       was  = from + n - 1 - i;
    *link          = old[was];
    link->reversed = !link->reversed;
    link->joins    = was + 1 < n && old[was + 1].joins;
    link->drop     = was + 1 < n ? old[was + 1].drop : 0;
  }
}

static int points_of(const mhb_link *link, const mhb_response *store) {
  int n = store->branch[link->segment].n_points;
  return n > link->drop ? n - link->drop : 0;
}

int mhb_chain_points(const mhb_chain *chain, const mhb_response *store) {
  int n = 0;
  for (int i = 0; i < chain->n; i++) n += points_of(&chain->link[i], store);
  return n;
}

void mhb_chain_end(const mhb_chain *chain, const mhb_response *store, int end, int *segment,
                   int *point) {
  const mhb_link *link = NULL;
  for (int i = 0; i < chain->n && !link; i++) {
    const mhb_link *l = &chain->link[end < 0 ? i : chain->n - 1 - i];
    if (points_of(l, store) > 0) link = l;
  }
  *segment  = link ? link->segment : -1;
  bool last = link && (end > 0) != link->reversed;
  *point    = last ? store->branch[link->segment].n_points - 1 : 0;
}

void mhb_chain_join(const mhb_chain *chain, const mhb_response *store, mhb_response *response,
                    int branch, int *begins, int *n_begins) {
  mhb_branch *b = &response->branch[branch];
  b->n_points   = 0;
  *n_begins     = 0;
  for (int i = 0; i < chain->n; i++) {
    const mhb_link *link = &chain->link[i];
    int             n = store->branch[link->segment].n_points, drop = link->drop;
    if (points_of(link, store) == 0) continue;
    if (!link->joins || b->n_points == 0) begins[(*n_begins)++] = b->n_points;
    if (link->reversed)
      mhb_response_copy_points(response, branch, store, link->segment, n - 1 - drop, 0);
    else
      mhb_response_copy_points(response, branch, store, link->segment, drop, n - 1);
  }
}
