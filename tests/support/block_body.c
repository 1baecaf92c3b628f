#include "tests/support/block_body.h"

#include "tests/support/check.h"

enum { ENTRIES = 3 }; /* of a load, at most */

/* Masses between the nodes that share a cell, both halves. They are positive definite: those of a
 * node to its at most 26 neighbours are below 0.03 of its own. */
static void set_masses(block_body *b) {
  const fem_blocks *p    = &b->grid.blocks;
  const size_t      most = 2 * (size_t)p->start[p->n];
  int              *next = calloc((size_t)p->n + 1, sizeof *next);
  uint64_t          seed = 17;
  b->start               = calloc((size_t)p->n + 1, sizeof *b->start);
  b->column              = malloc((most + 1) * sizeof *b->column);
  b->mass                = malloc((most + 1) * sizeof *b->mass);
  assert_true(next && b->start && b->column && b->mass);
  for (int r = 0; r < p->n; r++)
    for (int k = p->start[r]; k < p->start[r + 1]; k++) {
      b->start[r + 1]++;
      if (p->column[k] != r) b->start[p->column[k] + 1]++;
    }
  for (int r = 0; r < p->n; r++) b->start[r + 1] += b->start[r];
  for (int r = 0; r < p->n; r++) next[r] = b->start[r];
  for (int r = 0; r < p->n; r++)
    for (int k = p->start[r]; k < p->start[r + 1]; k++) {
      const int    c = p->column[k];
      const double m = c == r ? 1 + 0.4 * block_random(&seed) : 0.01 * (1 + block_random(&seed));
      b->column[next[r]] = c;
      b->mass[next[r]++] = m;
      if (c == r) continue;
      b->column[next[c]] = r;
      b->mass[next[c]++] = m;
    }
  free(next);
}

static void spread_masses(block_body *b) {
  const size_t n = (size_t)b->f.n;
  b->M           = calloc(n * n + 1, sizeof *b->M);
  assert_non_null(b->M);
  for (int r = 0; r < b->grid.blocks.n; r++)
    for (int k = b->start[r]; k < b->start[r + 1]; k++)
      for (int d = 0; d < 3; d++)
        b->M[(size_t)b->f.row[3 * b->column[k] + d] * n + (size_t)b->f.row[3 * r + d]] = b->mass[k];
}

static void set_loads(int n_loads, block_body *b) {
  const size_t n = (size_t)b->f.n, most = (size_t)n_loads;
  uint64_t     seed = 43;
  b->n_loads        = n_loads;
  b->load_start     = calloc(most + 1, sizeof *b->load_start);
  b->dof            = malloc((ENTRIES * most + 1) * sizeof *b->dof);
  b->weight         = malloc((ENTRIES * most + 1) * sizeof *b->weight);
  b->b              = calloc(most * n + 1, sizeof *b->b);
  assert_true(b->load_start && b->dof && b->weight && b->b);
  for (int c = 0; c < n_loads; c++) {
    int e = b->load_start[c];
    for (; e < b->load_start[c] + 1 + c % ENTRIES; e++) {
      b->dof[e]    = (int)(0.5 * (1 + block_random(&seed)) * (b->f.n - 1));
      b->weight[e] = block_random(&seed);
      b->b[(size_t)c * n + (size_t)b->f.row[b->dof[e]]] += b->weight[e];
    }
    b->load_start[c + 1] = e;
  }
}

void block_body_make(block_grid grid, int n_loads, block_body *body) {
  *body = (block_body){.grid = grid};
  block_factor_make(&body->grid, &body->f);
  double *block = block_grid_values(&body->grid, 45, 7);
  assert_true(
      fem_supernodal_factorise(&body->f.panels, &body->f.lower, block, NULL, body->f.value));
  body->K = block_factor_dense(&body->f, block);
  free(block);
  set_masses(body);
  spread_masses(body);
  set_loads(n_loads, body);
}

void block_body_free(block_body *body) {
  block_factor_free(&body->f);
  block_grid_free(&body->grid);
  free(body->K);
  free(body->M);
  free(body->start);
  free(body->column);
  free(body->mass);
  free(body->load_start);
  free(body->dof);
  free(body->weight);
  free(body->b);
  *body = (block_body){0};
}
