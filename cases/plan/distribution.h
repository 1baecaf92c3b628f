/* Distributions of uncertain inputs, sampled by the inverse of their distribution function. */
#ifndef CASES_PLAN_DISTRIBUTION_H
#define CASES_PLAN_DISTRIBUTION_H

#include "mesh/base/status.h"

typedef enum {
  PLAN_UNIFORM,          /* low, high */
  PLAN_LOG_UNIFORM,      /* low, high; the logarithm is uniform; low > 0 */
  PLAN_NORMAL,           /* mean, deviation */
  PLAN_LOGNORMAL,        /* mean, deviation of the value itself, not of its logarithm; mean > 0 */
  PLAN_TRIANGULAR,       /* low, mode, high */
  PLAN_TRUNCATED_NORMAL, /* mean, deviation before truncation, low, high */
  PLAN_N_DISTRIBUTIONS
} plan_kind;

/* Parameters are in the unit of the value, in the order of plan_kind. Unused ones are ignored. */
typedef struct {
  plan_kind kind;
  double    parameter[4];
} plan_distribution;

/* Name as in a study file, e.g. "truncated_normal", and number of its parameters. */
const char *plan_distribution_name(plan_kind kind);
int         plan_distribution_parameters(plan_kind kind);

/* Parameters are finite and in order.
 *
 *   key  in  named in the message
 *
 * SHB_ERR_INPUT: they are not. */
shb_status plan_distribution_check(const plan_distribution *distribution, const char *key);

/* The value below which the probability is u, 0 < u < 1. The distribution passes the check. */
double plan_quantile(const plan_distribution *distribution, double u);

#endif
