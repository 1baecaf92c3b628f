/* Symmetric and Hermitian matrices of 3x3 blocks on a grid of nodes, their factor by panels, and
 * the same matrices dense. Free of PETSc. */
#ifndef TESTS_SUPPORT_BLOCK_GRID_H
#define TESTS_SUPPORT_BLOCK_GRID_H

#include <complex.h>
#include <stdint.h>

#include "fem/supernodal/hermitian_factor.h"
#include "fem/supernodal/supernodal_factor.h"

/* Upper triangle of a graph: nodes that share a cell are coupled. */
typedef struct {
  fem_blocks blocks;
  int       *start, *column;
} block_grid;

/* One body, or several that do not touch, of cells[0] x cells[1] x cells[2] cells. A cell has
 * (step + 1)^3 nodes: 27-node hexahedra for step 2, eight-node ones for step 1. No body: empty. */
block_grid block_grid_make(const int cells[3], int step, int bodies);
/* A line of nodes, each coupled to the band next ones; closed: around a ring. */
block_grid block_grid_line(int nodes, int band, bool closed);
void       block_grid_free(block_grid *grid);

/* A number between -1 and 1. */
double block_random(uint64_t *state);

/* Blocks [block][9] by columns with random numbers; diagonal: what is added to the diagonal. It is
 * positive definite from about 30 on. To be freed. */
double *block_grid_values(const block_grid *grid, double diagonal, uint64_t seed);

/* L_ij != 0 of the nodes in an order, by elimination of the dense graph; [n][n], column j at
 * [j * n]. To be freed.
 *   place  in  [n] index of a node in the order; NULL: as they are */
bool *block_grid_fill(const block_grid *grid, const int *place);

/* The analysis and the factor of a matrix. */
typedef struct {
  const block_grid *grid;
  int               n;     /* rows: 3 a node */
  int              *place; /* [n / 3] index of a node in the factor */
  int              *row;   /* [n] of a dof in the factor */
  int              *owner; /* [n] panel of a row */
  fem_lower_pattern lower;
  fem_supernodes    panels;
  double           *value; /* [n_values], not yet filled */
} block_factor;

/* Analyse a pattern; the grid is borrowed. Fails the test without memory. */
void block_factor_make(const block_grid *grid, block_factor *f);
void block_factor_free(block_factor *f);

/* [n][n] by columns, both triangles, in the order of the factor. To be freed. */
double         *block_factor_dense(const block_factor *f, const double *block);
double complex *block_factor_dense_complex(const block_factor *f, const double complex (*block)[9]);

/* Row of the factor at a panel's i-th row. */
int block_factor_row(const block_factor *f, int panel, int i);

#endif
