#include "mhb/problem/parameter.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

mhb_operating_point mhb_operating_point_of(const mhb_settings *s) {
  mhb_operating_point c = {.omega = SHB_TWO_PI * s->frequency[0],
                           .n0    = s->n0[0],
                           .scale = s->scale,
                           .mu    = s->mu,
                           .kv    = s->kv};
  memcpy(c.ku, s->ku, sizeof c.ku);
  return c;
}

const char *mhb_parameter_name(mhb_parameter parameter) {
  static const char *const names[MHB_N_PARAMETERS] = {"frequency", "n0", "scale", "mu", "ku", "kv"};
  return names[parameter];
}

const char *mhb_parameter_unit(mhb_parameter parameter) {
  static const char *const units[MHB_N_PARAMETERS] = {"Hz", "N", "", "", "N/m", "N/m"};
  return units[parameter];
}

double mhb_parameter_shown(mhb_parameter parameter, double value) {
  return parameter == MHB_IN_FREQUENCY ? value / SHB_TWO_PI : value;
}

double mhb_parameter_value(mhb_parameter parameter, double shown) {
  return parameter == MHB_IN_FREQUENCY ? SHB_TWO_PI * shown : shown;
}

double mhb_parameter_end(const mhb_settings *s, mhb_parameter parameter, int high) {
  return parameter == MHB_IN_FREQUENCY ? SHB_TWO_PI * s->frequency[high] : s->range[high];
}

static double *field(mhb_operating_point *c, mhb_parameter parameter) {
  double *fields[MHB_N_PARAMETERS] = {&c->omega, &c->n0, &c->scale, &c->mu, c->ku, &c->kv};
  return fields[parameter];
}

double mhb_parameter_get(const mhb_operating_point *condition, mhb_parameter parameter) {
  mhb_operating_point c = *condition;
  return *field(&c, parameter);
}

void mhb_parameter_set(mhb_operating_point *condition, mhb_parameter parameter, double value) {
  double old = *field(condition, parameter);
  for (int i = 1; parameter == MHB_IN_KU && i < 3; i++) condition->ku[i] *= value / old;
  *field(condition, parameter) = value;
}

double mhb_parameter_least(mhb_parameter parameter) {
  if (parameter == MHB_IN_N0 || parameter == MHB_IN_SCALE) return -INFINITY;
  return parameter == MHB_IN_MU || parameter == MHB_IN_KV ? 0 : DBL_MIN;
}

mhb_law mhb_operating_point_law(const mhb_operating_point *c, mhb_preload preload, double share) {
  mhb_law law = {.mu = c->mu, .kv = share * c->kv, .n0 = share * c->n0};
  for (int i = 0; i < 3; i++) law.ku[i] = share * c->ku[i];
  if (preload == MHB_EQUILIBRIUM) law.mean_offset = fmax(law.n0, 0);
  return law;
}

/* y <- factor (dp/du) u over the axes from..to */
static void times(const mhb_pair_force *pair, int from, int to, double factor, double *y) {
  int           nb = pair->nb, block = 3 * nb;
  const double *dp = pair->dp, *u = pair->u;
  for (int i = 0; i < block; i++) {
    double sum = 0;
    for (int j = from * nb; j < to * nb; j++) sum += dp[i * block + j] * u[j];
    y[i] = factor * sum;
  }
}

/* Constant normal load (kv = 0): all is homogeneous in (u, n0). */
static void by_constant_load(const mhb_law *law, const mhb_pair_force *pair, double *change) {
  memset(change, 0, sizeof(double) * 3 * (size_t)pair->nb);
  if (law->n0 <= 0) return;
  times(pair, 0, 3, -1 / law->n0, change);
  for (int i = 0; i < 3 * pair->nb; i++) change[i] += pair->p[i] / law->n0;
  change[0] += law->mean_offset / law->n0; /* of n, not of n - mean_offset */
}

void mhb_parameter_force(const mhb_operating_point *c, mhb_parameter parameter, const mhb_law *law,
                         double share, const mhb_pair_force *pair, double *change) {
  int nb = pair->nb, block = 3 * nb;
  memset(change, 0, sizeof(double) * (size_t)block);
  if (parameter == MHB_IN_KV && c->kv > 0) times(pair, 0, 1, 1 / c->kv, change);
  if (parameter == MHB_IN_KU) times(pair, 1, 3, 1 / c->ku[0], change);
  if (parameter == MHB_IN_MU && c->mu > 0) {
    times(pair, 1, 3, -1 / c->mu, change);
    for (int i = 0; i < nb; i++) change[i] = 0;
    for (int i = nb; i < block; i++) change[i] += pair->p[i] / c->mu;
  }
  if (parameter != MHB_IN_N0) return;
  if (law->kv > 0) {
    for (int i = 0; i < block; i++) change[i] = pair->dp[i * block] / law->kv;
  } else {
    by_constant_load(law, pair, change);
  }
  if (law->mean_offset > 0) change[0] -= 1;
  for (int i = 0; i < block; i++) change[i] *= share;
}
