/* A branch as a chain of segments. They are traced in any order and direction, never edited, and
 * joined into a branch at the end. */
#ifndef MHB_BRANCHES_CHAIN_H
#define MHB_BRANCHES_CHAIN_H

#include "mhb/response/response.h"

typedef struct {
  int  segment;  /* branch of the store */
  bool reversed; /* its points are passed from the last to the first */
  bool joins;    /* its first point follows the last one of the link before along the curve */
  int  drop;     /* points left out where it joins: they are in the other link already */
} mhb_link;

/* Empty: zeroed. */
typedef struct {
  int       n, room;
  mhb_link *link; /* [n] */
} mhb_chain;

void mhb_chain_free(mhb_chain *chain);

/* Insert a link before the one at a place, 0 to n. */
void mhb_chain_insert(mhb_chain *chain, int at, mhb_link link);
/* The links from `from` on in the opposite order and direction. */
void mhb_chain_reverse(mhb_chain *chain, int from);

int mhb_chain_points(const mhb_chain *chain, const mhb_response *store);

/* The store's branch and point of the first (end < 0) or last (end > 0) point. */
void mhb_chain_end(const mhb_chain *chain, const mhb_response *store, int end, int *segment,
                   int *point);

/* Replace the points of a branch by the chain's.
 *   begins  out  [n_begins] points at which the curve begins, and begins anew after a gap; room for
 *                chain->n */
void mhb_chain_join(const mhb_chain *chain, const mhb_response *store, mhb_response *response,
                    int branch, int *begins, int *n_begins);

#endif
