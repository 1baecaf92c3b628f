#include "tests/mhb/three_degree.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static void allocate(modal_model *model, int modes) {
  size_t m = (size_t)modes;
  memset(model, 0, sizeof *model);
  model->n_modes       = modes;
  model->n_pairs       = 1;
  model->n_probes      = 1;
  model->n_load        = 1;
  model->frequency     = calloc(m, sizeof(double));
  model->damping_ratio = calloc(m, sizeof(double));
  model->right         = calloc(3 * m, sizeof(double));
  model->probe         = calloc(3 * m, sizeof(double));
  model->modal_force   = calloc(2 * m, sizeof(double complex));
  model->probe_name    = calloc(1, sizeof(char *));
  model->probe_name[0] = strdup("contact");
}

void three_degree_model(modal_model *model) {
  double K[9] = {1, .2, .1, .2, 1.3, .15, .1, .15, 1.6}, F[3] = {.04, .06, .03}, lambda[3];
  allocate(model, 3);
  LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', 3, K, 3, lambda);
  for (int i = 0; i < 3; i++) {
    double w                = sqrt(lambda[i]);
    model->frequency[i]     = w / (2 * PI);
    model->damping_ratio[i] = .01 * w;
    for (int c = 0; c < 3; c++) {
      model->right[c * 3 + i] = model->probe[c * 3 + i] = K[c * 3 + i];
      model->modal_force[3 + i] += K[c * 3 + i] * F[c];
    }
  }
}

void one_degree_model(double zeta, int direction, double force, modal_model *model) {
  allocate(model, 1);
  model->frequency[0]     = 1 / (2 * PI);
  model->damping_ratio[0] = zeta;
  model->right[direction] = model->probe[direction] = 1;
  model->modal_force[1]                             = force;
}
