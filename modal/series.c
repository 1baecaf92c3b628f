#include "modal/series.h"

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
