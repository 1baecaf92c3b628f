#include "modal/model/residual_series.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

static const double BELOW = 0.9;

enum { POWER = 32 };

static double square(double x) {
  return x * x;
}

static double eigenvalue(const modal_model *model, int i) {
  return square(SHB_TWO_PI * model->residual_frequency[i]);
}

bool modal_series_has_fourth(const modal_model *model) {
  return model->residual_diagonal ||
         (model->residual_flexibility && model->residual_inertia && model->residual_fourth);
}

double modal_series_diagonal(const modal_model *model, int term, int dof) {
  const double *const matrix[] = {model->residual_flexibility, model->residual_inertia,
                                  model->residual_fourth};
  const size_t        n = (size_t)modal_model_contact_dofs(model), i = (size_t)dof;
  return matrix[term] ? matrix[term][i * (n + 1)] : model->residual_diagonal[(size_t)term * n + i];
}

/* Below this share of c the n-th power is lost in rounding: x = s. */
static const double FAR_BELOW = 0.3;

/* x = s/(1 + (s/c)^n)^(1/n), dx/ds = (1 + (s/c)^n)^(-1/n - 1), n = POWER; at first x = s. */
static void limit(double s, double c, modal_series *series) {
  if (s < FAR_BELOW * c) return;
  const double r = s / c, least = fmin(r, 1 / r), q = log1p(pow(least, POWER));
  const double all = r > 1 ? POWER * log(r) + q : q; /* ln(1 + r^n) */
  series->x        = s * exp(-all / POWER);
  series->dx       = exp(-all / POWER - all);
}

static void set_powers(double x, double dx, double weight[MODAL_TERMS], double slope[MODAL_TERMS]) {
  weight[0] = 1;
  weight[1] = x;
  weight[2] = x * x;
  slope[0]  = 0;
  slope[1]  = dx;
  slope[2]  = 2 * x * dx;
}

/* a_1, a_2 and their slopes with c = (2 w_m)^2, w_m the last mode kept. */
static void bounded(double s, double last, modal_series *series) {
  double c = 4 * last * last, x = s / (c + s), dx = c / ((c + s) * (c + s));
  double weight[] = {1, c * (x + x * x), c * c * x * x};
  double slope[]  = {0, c * (1 + 2 * x) * dx, 2 * c * c * x * dx};
  memcpy(series->weight, weight, sizeof weight);
  memcpy(series->slope, slope, sizeof slope);
}

modal_series modal_series_at(const modal_model *model, double omega) {
  double       s = omega * omega, last = SHB_TWO_PI * model->frequency[model->n_modes - 1];
  modal_series series = {.x = s, .dx = 1};
  if (model->n_residual > 0 && s > 0) limit(s, BELOW * eigenvalue(model, 0), &series);
  set_powers(series.x, series.dx, series.load_weight, series.load_slope);
  set_powers(series.x, series.dx, series.weight, series.slope);
  if (!modal_series_has_fourth(model))
    series.weight[2] = series.slope[2] = 0;
  else if (model->n_residual == 0)
    bounded(s, last, &series);
  if (model->n_residual == 0 && model->load_fourth) {
    memcpy(series.load_weight, series.weight, sizeof series.weight);
    memcpy(series.load_slope, series.slope, sizeof series.slope);
  }
  return series;
}

double modal_series_mode(const modal_model *model, int i, const modal_series *series,
                         double *slope) {
  const double theta = eigenvalue(model, i), x = series->x, gap = theta - x;
  const double cube = x / theta * (x / theta) * (x / theta) / gap;
  *slope            = series->dx * (x > 0 ? cube * (3 / x + 1 / gap) : 0);
  return cube;
}

void modal_series_modes(const modal_model *model, const modal_series *series, double *weight,
                        double *slope) {
  const double x = series->x, dx = series->dx, rate = x > 0 ? 3 / x : 0;
  for (int i = 0; i < model->n_residual; i++) {
    const double theta = eigenvalue(model, i), q = x / theta, inverse = 1 / (theta - x);
    weight[i] = q * q * q * inverse;
    slope[i]  = dx * weight[i] * (rate + inverse);
  }
}

/* Moments of one dof that its error estimate needs. */
typedef struct {
  double        term[MODAL_TERMS], tail[2];
  const double *shape; /* [n_residual] */
} moments;

/* H(s) by the unbounded series minus H by the bounded weights that the model uses. */
static double shift(const modal_model *model, double s, const modal_series *taken,
                    const moments *of) {
  modal_series plain = {.x = s, .dx = 1};
  double sum = (s - taken->weight[1]) * of->term[1] + (s * s - taken->weight[2]) * of->term[2];
  for (int i = 0; i < model->n_residual; i++) {
    double unused, psi = of->shape[i];
    sum += psi * psi *
           (modal_series_mode(model, i, &plain, &unused) -
            modal_series_mode(model, i, taken, &unused));
  }
  return sum;
}

/* Tail at s below the first mode left out; INFINITY where it is unknown.
 *
 * Without residual modes the two moments define one equivalent mode: s^r a/(1 - s b/a). With
 * residual modes the tail grows with a power of their own first pole. */
static double tail_at(const modal_model *model, double s, const double tail[2]) {
  const double size = pow(s, model->tail_order) * tail[0];
  if (!(tail[0] > 0)) return 0;
  const double rate = tail[1] / tail[0];
  if (model->tail_order == MODAL_TERMS || model->n_residual == 0)
    return s * rate < 1 ? size / (1 - s * rate) : INFINITY;
  const double theta = eigenvalue(model, 0);
  return s < theta ? size * pow(1 - s / theta, -fmax(1, theta * rate)) : INFINITY;
}

static double error_of(const modal_model *model, double omega, const moments *of) {
  const double       s = omega * omega, most = fabs(of->term[0]);
  const modal_series taken = modal_series_at(model, omega);
  double             error = tail_at(model, s, of->tail);
  if (model->n_residual > 0 && s >= eigenvalue(model, 0)) return most;
  if (taken.weight[1] < s) error += shift(model, s, &taken, of);
  return fmin(fabs(error), most);
}

double modal_series_error(const modal_model *model, double omega, int dof) {
  if (!modal_series_has_fourth(model) || !model->contact_tail) return -1;
  const size_t  p = (size_t)dof, r = (size_t)model->n_residual;
  const moments of = {{modal_series_diagonal(model, 0, dof), modal_series_diagonal(model, 1, dof),
                       modal_series_diagonal(model, 2, dof)},
                      {model->contact_tail[2 * p], model->contact_tail[2 * p + 1]},
                      r ? model->residual_shape + p * r : NULL};
  return error_of(model, omega, &of);
}
