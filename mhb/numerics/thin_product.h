/* Products of a large square matrix with a few columns. A general product of matrices copies the
 * matrix into another order first, which takes as long as the product itself.
 *
 * Columns lie in groups side by side, filled up with zeros: x[group][n][MHB_THIN_COLUMNS]. In
 * single precision a group is twice as wide. */
#ifndef MHB_NUMERICS_THIN_PRODUCT_H
#define MHB_NUMERICS_THIN_PRODUCT_H

enum { MHB_THIN_COLUMNS = 8, MHB_THIN_COLUMNS_SINGLE = 16 };

/* Groups that hold so many columns. */
static inline int mhb_thin_groups(int columns, int width) {
  return (columns + width - 1) / width;
}

/* out <- A[n][n] x, row-major. Sums run in the order of the columns of A. */
void mhb_thin_product(int n, int groups, const double *A, const double *x, double *out);
void mhb_thin_product_single(int n, int groups, const float *A, const float *x, float *out);

#endif
