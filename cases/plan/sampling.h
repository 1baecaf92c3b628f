/* Points that fill the unit cube: a randomised Sobol' sequence and Latin hypercubes.
 *
 * Every coordinate is inside (0, 1), so that every quantile of it is finite. A seed fixes the
 * points on every machine. Seed 0 is a seed as any other. */
#ifndef CASES_PLAN_SAMPLING_H
#define CASES_PLAN_SAMPLING_H

#include "mesh/base/status.h"

enum { PLAN_SOBOL_DIMENSIONS = 40 }; /* GSL's table of direction numbers */

/* The first n points of the Sobol' sequence from the origin on, with a random digital shift.
 *
 *   u  out  [n][d]
 *
 * Each point is uniform in the cube. The first 2^k points stay a net, so the mean of a smooth
 * function has an error near 1/n. A longer sequence begins with the points of a shorter one.
 * Source: Bratley, Fox 1988, ACM Trans. Math. Softw. 14(1), alg. 659; digital shift: L'Ecuyer,
 * Lemieux 2002, Recent advances in randomized quasi-Monte Carlo methods.
 * Errors: SHB_ERR_INPUT more than 40 dimensions; SHB_ERR_IO no memory. */
shb_status plan_sobol(int n, int d, unsigned long seed, double *u);

/* A Latin hypercube: each of n slices of a coordinate holds one point, at random inside it.
 *
 *   u  out  [n][d]
 *
 * Source: McKay, Beckman, Conover 1979, Technometrics 21(2).
 * Errors: SHB_ERR_IO no memory. */
shb_status plan_latin_hypercube(int n, int d, unsigned long seed, double *u);

#endif
