/* A Hermitian factor L L^H by panels, and solves with it for four right-hand sides at once: the
 * complex form of fem/supernodal/supernodal_solve.h.
 *
 * Real panels belong to every theta. A complex panel has its real parts [columns][rows], then its
 * imaginary parts: products are then those of real matrices, which BLAS makes faster. */
#ifndef FEM_SUPERNODAL_SUPERNODAL_HERMITIAN_H
#define FEM_SUPERNODAL_SUPERNODAL_HERMITIAN_H

#include <complex.h>

#include "fem/supernodal/panel_turns.h"
#include "fem/supernodal/supernodal_solve.h"

typedef struct {
  const fem_supernodes  *s; /* fem_panel.value is a place in real or in other */
  const fem_panel_turns *turns;
  const double          *real;                         /* numbers of the real panels */
  double                *other;                        /* of the complex ones */
  double complex         phase[4 * FEM_MOST_TURN + 1]; /* e^(j theta g), g = -2 FEM_MOST_TURN ... */
} fem_hermitian_panels;

/* One complex number of each right-hand side. */
typedef struct {
  fem_lanes re, im;
} fem_complex_lanes;

/* e^(j theta g) from e^(j theta), |g| <= 2 FEM_MOST_TURN. */
void fem_hermitian_set_phase(double complex turn, fem_hermitian_panels *panels);

static inline double complex fem_hermitian_phase(const fem_hermitian_panels *panels, int g) {
  return panels->phase[g + 2 * FEM_MOST_TURN];
}

/* Solve L L^H x = b in place, in the order of the factor.
 *   x     in/out   [n]
 *   work  scratch  [most_rows] */
void fem_supernodal_solve_hermitian(const fem_hermitian_panels *panels, fem_complex_lanes *x,
                                    fem_complex_lanes *work);

#endif
