/* Y = M X for several columns at once, on all threads. */
#ifndef FEM_BODY_MASS_PRODUCT_H
#define FEM_BODY_MASS_PRODUCT_H

#include <petscmat.h>
#include <stdbool.h>

/* Y = M X. Collective. The numbers do not depend on the number of threads.
 *   M     in   of fem_system, or any matrix
 *   X, Y  in   dense, as many columns */
PetscErrorCode fem_mass_multiply(Mat M, Mat X, Mat Y);

/* Mass between nodes by rows: m_rc times the 3x3 identity. */
typedef struct {
  PetscInt        n;
  const PetscInt *start, *column;
  const double   *value;
} fem_mass_rows;

/* Access M in place, until it is given back.
 *   by_nodes  out  false: M is on several ranks, or that of a sector, and nothing is accessed */
PetscErrorCode fem_mass_borrow(Mat M, bool *by_nodes, fem_mass_rows *rows);
PetscErrorCode fem_mass_give_back(Mat M, fem_mass_rows *rows);

#endif
