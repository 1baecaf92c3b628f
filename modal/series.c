#include "modal/series.h"

#include <math.h>

static const double TWO_PI = 6.28318530717958647692;

bool modal_series_has_fourth(const modal_model *model) {
  return model->residual_flexibility && model->residual_inertia && model->residual_fourth;
}

/* alpha, beta and their slopes with c = (2 last)^2. */
static modal_series bounded(double s, double last) {
  double c = 4 * last * last, x = s / (c + s), dx = c / ((c + s) * (c + s));
  return (modal_series){{1, c * (x + x * x), c * c * x * x},
                        {0, c * (1 + 2 * x) * dx, 2 * c * c * x * dx}};
}

modal_series modal_series_at(const modal_model *model, double omega) {
  double s = omega * omega;
  if (!modal_series_has_fourth(model)) return (modal_series){{1, s, 0}, {0, 1, 0}};
  return bounded(s, TWO_PI * model->frequency[model->n_modes - 1]);
}

void modal_series_moments(const modal_model *model, int dof, double moment[MODAL_MOMENTS]) {
  const size_t n  = 3 * (size_t)model->n_pairs * (model->has_left ? 2 : 1);
  const size_t at = (size_t)dof * (n + 1);
  moment[0]       = fabs(model->residual_flexibility[at]);
  moment[1]       = model->residual_inertia[at];
  moment[2]       = model->residual_fourth[at];
  moment[3]       = model->moment_fourth[dof];
  moment[4]       = model->moment_fifth[dof];
}

double modal_series_left(const double moment[MODAL_MOMENTS], double omega, double last) {
  double       s      = omega * omega;
  modal_series series = bounded(s, last);
  if (moment[3] == 0) return 0;
  double left = 1 - s * moment[4] / moment[3];
  if (left <= 0) return moment[0];
  double error = s * s * s * moment[3] / left + (s - series.weight[1]) * moment[1] +
                 (s * s - series.weight[2]) * moment[2];
  return fmin(fabs(error), moment[0]);
}

double modal_series_error(const modal_model *model, double omega, int dof) {
  double moment[MODAL_MOMENTS];
  if (!modal_series_has_fourth(model) || !model->moment_fourth || !model->moment_fifth) return -1;
  modal_series_moments(model, dof, moment);
  return modal_series_left(moment, omega, TWO_PI * model->frequency[model->n_modes - 1]);
}
