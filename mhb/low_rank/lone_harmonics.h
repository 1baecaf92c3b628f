/* Harmonics of many contact pairs that do not couple with each other:
 *
 *   (I + R_k D) x_k = rhs_k,   D: a stiffness [3][3] a pair, the same for all of them.
 *
 * R_k is replaced by X K X^H of the basis, as in woodbury.h. What the basis leaves out is a few per
 * cent of the correction, so this is a first matrix for a method that improves it. */
#ifndef MHB_LOW_RANK_LONE_HARMONICS_H
#define MHB_LOW_RANK_LONE_HARMONICS_H

#include "mhb/low_rank/woodbury.h"

/* Factor harmonics first..m, first > 0, at the product's frequency. They take the place of the
 * factors that woodbury had.
 *   D  in  [pair][9] N/m, row-major
 * 0: singular, or there is no small basis. */
int mhb_lone_harmonics_factor(mhb_woodbury *woodbury, const mhb_law *law, int first,
                              const double complex (*D)[9]);

/* Harmonics first..m of x[n] <- their solutions, in place of the right-hand side. */
void mhb_lone_harmonics_solve(const mhb_woodbury *woodbury, int first, const double complex (*D)[9],
                              double *x);

#endif
