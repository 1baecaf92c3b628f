/* Sobol' indices: how much of an output's variance each input explains.
 *
 * The first index of an input is the share of the variance that it explains alone. The total index
 * adds its interactions. Inputs are independent. */
#ifndef CASES_PLAN_SOBOL_INDICES_H
#define CASES_PLAN_SOBOL_INDICES_H

#include "cases/plan/statistics.h"
#include "mesh/base/status.h"

enum { PLAN_INDEX_INPUTS = 20 }; /* the plan takes two dimensions of a Sobol' sequence an input */

typedef struct {
  int           n_blocks, n_failed; /* n_failed: blocks left out, since a design of them failed */
  plan_estimate first[PLAN_INDEX_INPUTS], total[PLAN_INDEX_INPUTS];
} plan_indices;

/* Saltelli's plan: n blocks of d + 2 points.
 *
 *   u  out  [n][d + 2][d] in (0, 1): point A, point B, then A with its coordinate i from B, i < d
 *
 * Source: Saltelli et al. 2010, Comput. Phys. Commun. 181, sec. 3.
 * Errors: SHB_ERR_INPUT more than 20 inputs; SHB_ERR_IO no memory. */
shb_status plan_saltelli(int n, int d, unsigned long seed, double *u);

/* First and total indices from the outputs of Saltelli's plan.
 *
 *   y           in   [n][d + 2]; not finite: failed
 *   confidence  in   of the bounds, e.g. 0.95; they come from 1000 resampled sets of blocks
 *
 * The bounds treat blocks as independent, so they are on the safe side of a Sobol' plan.
 * Source: first index: Saltelli et al. 2010, table 2 (b); total: Jansen 1999, ibid. (f).
 * Errors: SHB_ERR_INPUT fewer than 2 whole blocks, more than 20 inputs, or an output without
 * variance; SHB_ERR_IO no memory. */
shb_status plan_indices_of(int n, int d, const double *y, double confidence, unsigned long seed,
                           plan_indices *indices);

#endif
