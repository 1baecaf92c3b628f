/* Root of a function of one variable in a bracket: interpolate, truncate, project (ITP).
 *
 * The caller owns the loop and evaluates the function, which may jump or fail at single points:
 *
 *   shb_root r;
 *   if (shb_root_start(&r, a, fa, b, fb, tolerance))
 *     while (!shb_root_done(&r)) {
 *       double x = shb_root_next(&r);
 *       if (evaluate(x, &f)) shb_root_found(&r, x, f);
 *       else if (!shb_root_failed(&r)) break;
 *     }
 *
 * The root is then between r.x[0] and r.x[1]. Convergence is superlinear where the function has a
 * slope at the root. Any other function needs at most two steps more than bisection.
 *
 * Source: Oliveira, Takahashi 2021, ACM Trans. Math. Softw. 47(1), art. 5. */
#ifndef MESH_BASE_ROOT_H
#define MESH_BASE_ROOT_H

#include <stdbool.h>

typedef struct {
  double x[2], f[2]; /* ends of the bracket, x[0] <= x[1], and the function there */
  double tolerance;  /* of the bracket's length */
  double first;      /* length of the first bracket */
  double budget;     /* length of bracket that keeps to the number of steps promised */
  int    n_failed;   /* points tried in vain in this bracket */
} shb_root;

/* Begins with the function's values at a and b, in either order. False if their signs are equal.
 * If one of them is 0 the search is done: both ends are that point. */
bool shb_root_start(shb_root *root, double a, double fa, double b, double fb, double tolerance);

/* The bracket is no longer than the tolerance, or than rounding permits. */
bool shb_root_done(const shb_root *root);

/* Where to evaluate the function next, inside the bracket. */
double shb_root_next(const shb_root *root);

/* f is the function at x, any point inside the bracket. f = 0 ends the search: both ends are x. */
void shb_root_found(shb_root *root, double x, double f);

/* The function has no value at the point of shb_root_next, which then proposes another one. False
 * once six points failed in this bracket. */
bool shb_root_failed(shb_root *root);

#endif
