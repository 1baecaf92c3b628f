#include "postproc/analysis/abscissa.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mhb/problem/parameter.h"

static const double DECADES = 30; /* ratio of the range from which the axis is logarithmic */

static const struct {
  const char *name, *symbol;
} words[MHB_N_PARAMETERS] = {{"frequency", "frequency"},          {"preload n₀", "n₀"},
                             {"excitation level", "level"},       {"friction coefficient μ", "μ"},
                             {"tangential stiffness kuu", "kuu"}, {"normal stiffness kv", "kv"}};

static post_unit unit_of(mhb_parameter parameter, double largest) {
  switch (parameter) {
    case MHB_IN_N0:
      return post_unit_force(largest);
    case MHB_IN_KU:
    case MHB_IN_KV:
      return post_unit_stiffness(largest);
    default:
      return (post_unit){mhb_parameter_unit(parameter), 1};
  }
}

const double *post_abscissa_values(const mhb_response *response, const mhb_branch *branch) {
  return response->parameter == MHB_IN_FREQUENCY ? branch->frequency : branch->value;
}

post_abscissa post_abscissa_of(const mhb_response *response) {
  mhb_parameter p  = response->parameter;
  double        lo = INFINITY, hi = -INFINITY;
  for (int b = 0; b < response->n_branches; b++) {
    const double *x = post_abscissa_values(response, &response->branch[b]);
    for (int i = 0; i < response->branch[b].n_points; i++) {
      lo = fmin(lo, x[i]);
      hi = fmax(hi, x[i]);
    }
  }
  return (post_abscissa){.parameter = p,
                         .name      = words[p].name,
                         .symbol    = words[p].symbol,
                         .unit      = unit_of(p, fmax(fabs(lo), fabs(hi))),
                         .range     = {lo, hi},
                         .log       = p != MHB_IN_FREQUENCY && lo > 0 && hi >= DECADES * lo};
}

char *post_abscissa_number(const post_abscissa *a, double value, int digits,
                           char out[POST_NUMBER]) {
  if (a->parameter == MHB_IN_FREQUENCY) return post_number(out, value, digits);
  return post_plain(out, value / a->unit.scale, digits);
}

char *post_abscissa_value(const post_abscissa *a, double value, int digits, char out[POST_NUMBER]) {
  post_abscissa_number(a, value, digits, out);
  size_t used = strlen(out);
  if (isfinite(value) && *a->unit.name)
    snprintf(out + used, POST_NUMBER - used, "\u00a0%s", a->unit.name);
  return out;
}

char *post_abscissa_place(const post_abscissa *a, double value, int digits, char out[POST_PLACE]) {
  char        text[POST_NUMBER];
  const char *joint = a->parameter == MHB_IN_SCALE ? "\u00a0" : " = ";
  post_abscissa_value(a, value, digits, text);
  if (a->parameter == MHB_IN_FREQUENCY)
    strcpy(out, text);
  else
    snprintf(out, POST_PLACE, "%s%s%s", a->symbol, joint, text);
  return out;
}

char *post_abscissa_label(const post_abscissa *a, const char *before, char out[POST_LABEL]) {
  snprintf(out, POST_LABEL, "%s%s%s%s", before, a->name, *a->unit.name ? ", " : "", a->unit.name);
  return out;
}

plot_axis post_abscissa_axis(const post_abscissa *a, const char *label) {
  double lo = a->range[0], hi = a->range[1], unit = a->unit.scale;
  return hi > lo ? (plot_axis){lo, hi, a->log, 0, unit, label}
                 : plot_axis_around(lo, hi, false, unit, label);
}
