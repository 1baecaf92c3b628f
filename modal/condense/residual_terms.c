#include "modal/condense/residual_terms.h"

#include <math.h>

static int n_contact(const modal_model *model) {
  return (model->has_left ? 6 : 3) * model->n_pairs;
}

/* Columns first .. first + count - 1 of to [rows][columns] from the samples [rows][batch]. */
static void put_columns(const double *sample, int batch, int rows, int first, int count,
                        int columns, double *to) {
  for (size_t r = 0; r < (size_t)rows; r++)
    for (int c = 0; c < count; c++)
      to[r * (size_t)columns + (size_t)(first + c)] = sample[r * (size_t)batch + (size_t)c];
}

void modal_residual_terms_put(const modal_residual_chain *chain, int term, int first, int count,
                              modal_model *model) {
  const int     nc        = n_contact(model);
  double *const contact[] = {model->residual_flexibility, model->residual_inertia,
                             model->residual_fourth};
  double *const probe[]   = {model->probe_contact_residual, model->probe_contact_inertia,
                             model->probe_contact_fourth};
  put_columns(chain->sample[term], chain->batch, nc, first, count, nc, contact[term]);
  put_columns(chain->probe_sample[term], chain->batch, 3 * model->n_probes, first, count, nc,
              probe[term]);
}

/* Add a column of the samples [rows][batch], times the weight of its pattern in each harmonic. */
static void add_pattern(const modal_load *load, int pattern, const double *sample, int batch,
                        int rows, double complex *to) {
  for (int k = 0; k <= load->n_harmonics; k++)
    for (int r = 0; r < rows; r++)
      to[(size_t)k * (size_t)rows + (size_t)r] +=
          load->weight[k * load->dofs.n + pattern] * sample[(size_t)r * (size_t)batch];
}

void modal_residual_terms_add_load(const modal_residual_chain *chain, int column,
                                   const modal_load *load, int first, int count,
                                   modal_model *model) {
  double complex *const contact[] = {model->load_residual, model->load_inertia, model->load_fourth};
  double complex *const probe[]   = {model->probe_load_residual, model->probe_load_inertia,
                                     model->probe_load_fourth};
  for (int t = 0; t < MODAL_RESIDUAL_BLOCKS; t++)
    for (int i = 0; i < count; i++) {
      add_pattern(load, first + i, chain->sample[t] + column + i, chain->batch, n_contact(model),
                  contact[t]);
      add_pattern(load, first + i, chain->probe_sample[t] + column + i, chain->batch,
                  3 * model->n_probes, probe[t]);
    }
}

static void symmetrise(double *a, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) a[i * n + j] = a[j * n + i] = (a[i * n + j] + a[j * n + i]) / 2;
}

void modal_residual_terms_symmetrise(modal_model *model) {
  const size_t n = (size_t)n_contact(model);
  symmetrise(model->residual_flexibility, n);
  symmetrise(model->residual_inertia, n);
  symmetrise(model->residual_fourth, n);
}

void modal_store_tails(int order, int n_contact, double *const tail[2], const modal_load *load,
                       modal_model *model) {
  const double *first = tail[0] + n_contact, *second = tail[1] + n_contact; /* of the patterns */
  double        ratio = 0;
  model->tail_order   = order;
  for (int c = 0; c < n_contact; c++)
    for (int i = 0; i < 2; i++) model->contact_tail[2 * c + i] = tail[i][c];
  for (int c = 0; c < load->dofs.n; c++)
    if (first[c] > 0) ratio = fmax(ratio, second[c] / first[c]);
  for (int k = 0; k <= load->n_harmonics; k++) {
    double root = 0;
    for (int c = 0; c < load->dofs.n; c++)
      root += cabs(load->weight[k * load->dofs.n + c]) * sqrt(first[c]);
    model->load_tail[2 * k]     = root * root;
    model->load_tail[2 * k + 1] = root * root * ratio;
  }
}
