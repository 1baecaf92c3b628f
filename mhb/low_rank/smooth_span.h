/* A small space in which several symmetric or skew matrices lie together, U C_i U^T.
 *
 * It is found by a random sketch (Halko, Martinsson, Tropp 2011) in the norm of the contact
 * stiffness D: singular vectors of D^1/2 [A_0 A_1 ...] D^1/2 with their weights. */
#ifndef MHB_LOW_RANK_SMOOTH_SPAN_H
#define MHB_LOW_RANK_SMOOTH_SPAN_H

#include "mesh/base/arena.h"

typedef struct {
  const double *A;      /* [n][n]; NULL: zero */
  double        weight; /* > 0, what it is multiplied by at most */
  int           sign;   /* 0: the source is A; 1 or -1: A + sign A^T */
} mhb_smooth_source;

typedef struct {
  int      rank;
  double  *U;    /* [n][rank]; NULL: no small space was found */
  double  *size; /* [rank] of U's columns in the sources, falling, where I is 1 */
  double **C;    /* [source] [rank][rank], NULL where A is */
} mhb_smooth_span;

/* Columns of A U are left out where they are below 1e-12 in the norm.
 *   root   in  [n] D^1/2, N/m
 *   arena  in  owns the arrays of the result
 * Without memory, without a source, or where the space is large, U is NULL. */
void mhb_smooth_span_find(int n, const double *root, int n_sources,
                          const mhb_smooth_source *sources, shb_arena *arena,
                          mhb_smooth_span *span);

#endif
