#include "modal/series.h"

#include <math.h>

static const double TWO_PI = 6.28318530717958647692;

bool modal_series_has_fourth(const modal_model *model) {
  return model->residual_flexibility && model->residual_inertia && model->residual_fourth;
}

modal_series modal_series_at(const modal_model *model, double omega) {
  double s = omega * omega, top = 2 * TWO_PI * model->frequency[model->n_modes - 1], c = top * top;
  double x = s / (c + s), dx = c / ((c + s) * (c + s));
  if (!modal_series_has_fourth(model)) return (modal_series){{1, s, 0}, {0, 1, 0}};
  return (modal_series){{1, c * (x + x * x), c * c * x * x},
                        {0, c * (1 + 2 * x) * dx, 2 * c * c * x * dx}};
}

double modal_series_error(const modal_model *model, double omega, int dof) {
  const size_t n  = 3 * (size_t)model->n_pairs * (model->has_left ? 2 : 1);
  const size_t at = (size_t)dof * n + (size_t)dof;
  if (!modal_series_has_fourth(model) || !model->moment_fourth || !model->moment_fifth) return -1;
  double       s = omega * omega, fourth = model->moment_fourth[dof], most;
  modal_series series = modal_series_at(model, omega);
  most                = fabs(model->residual_flexibility[at]);
  if (fourth == 0) return 0;
  double left = 1 - s * model->moment_fifth[dof] / fourth;
  if (left <= 0) return most;
  double error = s * s * s * fourth / left + (s - series.weight[1]) * model->residual_inertia[at] +
                 (s * s - series.weight[2]) * model->residual_fourth[at];
  return fmin(fabs(error), most);
}
