/* Euclidean norm and product of real vectors. */
#ifndef MHB_NUMERICS_VECTOR_H
#define MHB_NUMERICS_VECTOR_H

/* |x| of x[n], scaled by the largest element: no overflow, no underflow. NAN if all elements are
 * NAN or zero and one of them is NAN. */
double mhb_norm(const double *x, int n);

/* The sum of a[i] b[i], in order. */
double mhb_dot(int n, const double *a, const double *b);

#endif
