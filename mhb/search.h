/* Solutions at one frequency that no known branch leads to: Newton's method from random starts, with the known ones deflated.
 *
 * Deflation: F(x) = M(x) r(x), M = prod_i (1/|x - x_i|^2 + 1) over the solutions x_i found so far (lengths relative to the size
 * of the starts), does not vanish there any more. Its Newton step is that of r, s, times 1/(1 + (grad M . s)/M). */
#ifndef MHB_SEARCH_H
#define MHB_SEARCH_H

#include "mhb/newton.h"

typedef struct {
  int     n, n_found, capacity; /* unknowns; solutions in x */
  double *x;                    /* [found][n] m, those handed in first */
} mhb_found;

void mhb_found_free(mhb_found *found);

/* A solution that is known, or has been found. SHB_ERR_IO: no memory. */
shb_status mhb_found_add(mhb_found *found, int n, const double *x);

/* Add what `starts` random starts of harmonics up to size (m) lead to and is not there yet; at omega rad/s and the residual's
 * preload. The seed decides the starts. SHB_ERR_IO: no memory. */
shb_status mhb_search(mhb_newton *newton, mhb_residual *residual, double omega, double size,
                      int starts, unsigned long long seed, mhb_found *found);

#endif
