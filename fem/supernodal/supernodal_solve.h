/* Solves L L^T x = b by panels, on all threads.
 *
 * A few right-hand sides: as costly as reading the factor, so four take as long as one. Subtrees
 * of the elimination tree are solved at the same time. Many: blocks of columns by BLAS, a block a
 * thread. The numbers do not depend on the number of threads. Free of PETSc. */
#ifndef FEM_SUPERNODAL_SUPERNODAL_SOLVE_H
#define FEM_SUPERNODAL_SUPERNODAL_SOLVE_H

#include "fem/supernodal/supernodes.h"

enum { FEM_LANES = 4 };

/* One number of each right-hand side. */
typedef double fem_lanes __attribute__((vector_size(8 * FEM_LANES)));

/* Solve in place, in the order of the factor.
 *   value  in       [n_values]
 *   x      in/out   [n_extended]; only the first n numbers matter
 *   work   scratch  [threads][most_rows] */
void fem_supernodal_solve(const fem_supernodes *s, const double *value, int threads, fem_lanes *x,
                          fem_lanes *work);

/* The same for count columns by BLAS, on the calling thread.
 *   needed  in       [n_panels] panels whose rows are wanted (fem_supernodes_needed), or NULL: all;
 *                    the other rows of x mean nothing afterwards
 *   x       in/out   [n][count]
 *   work    scratch  [most_rows][count]
 *   at      scratch  [most_rows] */
void fem_supernodal_solve_block(const fem_supernodes *s, const double *value, const bool *needed,
                                int count, double *x, double *work, int *at);

/* One panel of that: solve its part of L x = x, and take it off the rows below; or its part of
 * L^T x = x.
 *   L     in       [columns][rows] numbers of the panel
 *   at    in       [rows - columns] places in x of the rows below its columns
 *   own   in/out   [columns][count] rows of x of its columns
 *   x     in/out   [][count]
 *   work  scratch  [rows - columns][count] */
void fem_panel_forward(const fem_panel *p, const double *L, const int *at, int count, double *own,
                       double *x, double *work);
void fem_panel_backward(const fem_panel *p, const double *L, const int *at, int count, double *own,
                        const double *x, double *work);

#endif
