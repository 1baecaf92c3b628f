/* A body of blocks on a grid with masses and loads: what condensed masses and unit loads are made
 * from, sparse and dense. */
#ifndef TESTS_SUPPORT_BLOCK_BODY_H
#define TESTS_SUPPORT_BLOCK_BODY_H

#include "tests/support/block_grid.h"

typedef struct {
  block_grid   grid;
  block_factor f;              /* of K, factorised */
  double      *K, *M;          /* [n][n] dense, in the order of the factor */
  int         *start, *column; /* mass between nodes by rows: m_rc times the 3x3 identity */
  double      *mass;
  int          n_loads;          /* with one to three entries each */
  int         *load_start, *dof; /* b_c: entries e, load_start[c] <= e < load_start[c + 1] */
  double      *weight;           /* at dof[e] */
  double      *b;                /* [n_loads][n] dense, in the order of the factor */
} block_body;

/* Make K, M and the loads of a grid, which is taken over. Loads are at random dofs. */
void block_body_make(block_grid grid, int n_loads, block_body *body);
void block_body_free(block_body *body);

#endif
