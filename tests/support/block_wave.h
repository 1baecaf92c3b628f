/* Hermitian matrices of 3x3 blocks some of which carry phases, as those of a sector in a ring. */
#ifndef TESTS_SUPPORT_BLOCK_WAVE_H
#define TESTS_SUPPORT_BLOCK_WAVE_H

#include "tests/support/block_grid.h"

typedef struct {
  block_factor         f;          /* fem_panel.value is a place in real_value or in panels.other */
  signed char         *exponent;   /* [block] as fem_panel_turns_create has it */
  int                 *coupled_at; /* [block] index in coupled, or -1 */
  double              *real;       /* [block][9] without phases */
  double               complex (*coupled)[9]; /* of blocks with a phase, or any */
  double               complex (*all)[9];     /* [block] the matrix */
  fem_panel_turns      turns;
  double              *real_value; /* numbers of the real panels */
  fem_hermitian_panels panels;
} block_wave;

/* Make the matrix at an angle, its analysis, and the numbers of its real panels. Blocks of
 * FEM_ANY_BLOCK get random complex numbers.
 *   exponent  in  [block], taken over
 * Returns whether the real panels are positive definite. */
bool block_wave_make(const block_grid *grid, signed char *exponent, double theta, double diagonal,
                     block_wave *w);

/* The complex panels. */
bool block_wave_factorise(block_wave *w);
void block_wave_free(block_wave *w);

/* Exponents [block] of a grid: h[row] - h[column]; h NULL: 0. To be freed, or taken over. */
signed char *block_wave_exponents(const block_grid *grid, const int *h);

#endif
