/* Y = M X for several columns at once, on all threads. */
#ifndef FEM_BODY_MASS_PRODUCT_H
#define FEM_BODY_MASS_PRODUCT_H

#include <petscmat.h>

/* Y = M X. Collective. The numbers do not depend on the number of threads.
 *   M     in   of fem_system, or any matrix
 *   X, Y  in   dense, as many columns */
PetscErrorCode fem_mass_multiply(Mat M, Mat X, Mat Y);

#endif
