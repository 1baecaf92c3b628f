#include "cases/plan/distribution.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const struct {
  const char *name;
  int         n_parameters;
} TABLE[PLAN_N_DISTRIBUTIONS] = {
    [PLAN_UNIFORM] = {"uniform", 2},       [PLAN_LOG_UNIFORM] = {"log_uniform", 2},
    [PLAN_NORMAL] = {"normal", 2},         [PLAN_LOGNORMAL] = {"lognormal", 2},
    [PLAN_TRIANGULAR] = {"triangular", 3}, [PLAN_TRUNCATED_NORMAL] = {"truncated_normal", 4},
};

const char *plan_distribution_name(plan_kind kind) {
  return TABLE[kind].name;
}

int plan_distribution_parameters(plan_kind kind) {
  return TABLE[kind].n_parameters;
}

/* What is wrong with finite parameters, or NULL. */
static const char *fault(plan_kind kind, const double *p) {
  switch (kind) {
    case PLAN_UNIFORM:
      return p[0] < p[1] ? NULL : "the lower end must be below the upper end";
    case PLAN_LOG_UNIFORM:
      return p[0] > 0 && p[0] < p[1] ? NULL : "0 < lower end < upper end";
    case PLAN_NORMAL:
      return p[1] > 0 ? NULL : "the deviation must be above 0";
    case PLAN_LOGNORMAL:
      return p[0] > 0 && p[1] > 0 ? NULL : "mean and deviation of the value must be above 0";
    case PLAN_TRIANGULAR:
      return p[0] <= p[1] && p[1] <= p[2] && p[0] < p[2] ? NULL : "lower end <= mode <= upper end";
    default:
      if (!(p[1] > 0)) return "the deviation must be above 0";
      return p[2] < p[3] ? NULL : "the lower end must be below the upper end";
  }
}

/* Reflects an interval above the mean to below it, where probabilities keep their digits. */
static double truncated_normal(const double *p, double u) {
  double a = (p[2] - p[0]) / p[1], b = (p[3] - p[0]) / p[1];
  bool   above = a > 0;
  double low = above ? -b : a, high = above ? -a : b;
  double P_low = gsl_cdf_ugaussian_P(low), P_high = gsl_cdf_ugaussian_P(high);
  double z = gsl_cdf_ugaussian_Pinv(P_low + (above ? 1 - u : u) * (P_high - P_low));
  z        = fmin(fmax(z, low), high);
  return p[0] + p[1] * (above ? -z : z);
}

shb_status plan_distribution_check(const plan_distribution *distribution, const char *key) {
  const double *p    = distribution->parameter;
  const char   *name = plan_distribution_name(distribution->kind);
  for (int i = 0; i < plan_distribution_parameters(distribution->kind); i++)
    SHB_CHECK(isfinite(p[i]), SHB_ERR_INPUT, "%s: parameter %d of %s is not a finite number", key,
              i + 1, name);
  const char *why = fault(distribution->kind, p);
  SHB_CHECK(!why, SHB_ERR_INPUT, "%s: %s: %s", key, name, why);
  if (distribution->kind == PLAN_TRUNCATED_NORMAL) {
    double middle = plan_quantile(distribution, 0.5); /* an end where the tail has no digits */
    SHB_CHECK(middle > p[2] && middle < p[3], SHB_ERR_INPUT,
              "%s: %s: the interval is too far from the mean for its probability to be computed",
              key, name);
  }
  return SHB_OK;
}

double plan_quantile(const plan_distribution *distribution, double u) {
  const double *p = distribution->parameter;
  switch (distribution->kind) {
    case PLAN_UNIFORM:
      return p[0] + u * (p[1] - p[0]);
    case PLAN_LOG_UNIFORM:
      return p[0] * pow(p[1] / p[0], u);
    case PLAN_NORMAL:
      return p[0] + p[1] * gsl_cdf_ugaussian_Pinv(u);
    case PLAN_LOGNORMAL: {
      double variance = log1p(pow(p[1] / p[0], 2)); /* of the logarithm */
      return p[0] * exp(-variance / 2 + sqrt(variance) * gsl_cdf_ugaussian_Pinv(u));
    }
    case PLAN_TRIANGULAR: {
      double left = p[1] - p[0], right = p[2] - p[1], whole = p[2] - p[0];
      return u * whole < left ? p[0] + sqrt(u * whole * left)
                              : p[2] - sqrt((1 - u) * whole * right);
    }
    default:
      return truncated_normal(p, u);
  }
}
