#include "modal/model/receptance.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "modal/model/residual_series.h"

static const double *shape_of(const modal_model *model, int dof) {
  const int side = 3 * model->n_pairs;
  return dof < side ? model->right + (size_t)dof * (size_t)model->n_modes
                    : model->left + (size_t)(dof - side) * (size_t)model->n_modes;
}

static double complex modal_sum(const modal_model *model, double omega, const double *p,
                                const double *l) {
  double complex sum = 0;
  for (int i = 0; i < model->n_modes; i++) {
    double w = SHB_TWO_PI * model->frequency[i];
    sum += p[i] * l[i] / (w * w - omega * omega + 2 * I * model->damping_ratio[i] * w * omega);
  }
  return sum;
}

/* sum_i psi_ip psi_il times the weight of residual mode i */
static double residual_sum(const modal_model *model, const modal_series *series, int p, int l) {
  const size_t r   = (size_t)model->n_residual;
  double       sum = 0, unused;
  for (size_t i = 0; i < r; i++)
    sum += model->residual_shape[(size_t)p * r + i] * model->residual_shape[(size_t)l * r + i] *
           modal_series_mode(model, (int)i, series, &unused);
  return sum;
}

void modal_receptance(const modal_model *model, double omega, double complex *receptance) {
  const int          n      = modal_model_contact_dofs(model);
  const modal_series series = modal_series_at(model, omega);
  for (int p = 0; p < n; p++)
    for (int l = 0; l <= p; l++) {
      size_t         at    = (size_t)p * (size_t)n + (size_t)l;
      double complex value = modal_sum(model, omega, shape_of(model, p), shape_of(model, l));
      if (model->residual_flexibility) value += model->residual_flexibility[at];
      if (model->residual_inertia) value += series.weight[1] * model->residual_inertia[at];
      if (series.weight[2] != 0) value += series.weight[2] * model->residual_fourth[at];
      value += residual_sum(model, &series, p, l);
      receptance[at] = receptance[(size_t)l * (size_t)n + (size_t)p] = value;
    }
}

double modal_receptance_error(const modal_model *model, double omega,
                              const double complex *receptance) {
  const int n    = modal_model_contact_dofs(model);
  double    most = 0, error = 0;
  for (int p = 0; p < n; p++) {
    double here = modal_series_error(model, omega, p);
    if (here < 0) return -1;
    error = fmax(error, here);
    most  = fmax(most, cabs(receptance[(size_t)p * (size_t)n + (size_t)p]));
  }
  return most > 0 ? error / most : 0;
}
