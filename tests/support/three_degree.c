#include "tests/support/three_degree.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

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
    model->frequency[i]     = w / SHB_TWO_PI;
    model->damping_ratio[i] = .01 * w;
    for (int c = 0; c < 3; c++) {
      model->right[c * 3 + i] = model->probe[c * 3 + i] = K[c * 3 + i];
      model->modal_force[3 + i] += K[c * 3 + i] * F[c];
    }
  }
}

void one_degree_model(double zeta, int direction, double force, modal_model *model) {
  allocate(model, 1);
  model->frequency[0]     = 1 / SHB_TWO_PI;
  model->damping_ratio[0] = zeta;
  model->right[direction] = model->probe[direction] = 1;
  model->modal_force[1]                             = force;
}

void two_mode_model(double omega, double zeta, double contact, double probe, double force,
                    modal_model *model) {
  allocate(model, 2);
  model->frequency[0]     = 1 / SHB_TWO_PI;
  model->frequency[1]     = omega / SHB_TWO_PI;
  model->damping_ratio[0] = .01;
  model->damping_ratio[1] = zeta;
  model->right[2] = model->probe[2] = 1;
  model->right[3]                   = contact;
  model->probe[3]                   = probe;
  model->modal_force[2]             = .05;
  model->modal_force[3]             = force;
}

/* Roots of cos x cosh x = -1. */
static double cantilever_root(int r) {
  double x = (r - .5) * SHB_PI;
  for (int i = 0; i < 50; i++) {
    double f = cos(x) + 1 / cosh(x), slope = -sin(x) - tanh(x) / cosh(x);
    x -= f / slope;
  }
  return x;
}

void tip_contact_beam_model(double force, modal_model *model) {
  const double L = .2, b = .04, h = .01, E = 210e9, rho = 7800, angle = 40 * SHB_PI / 180;
  int          flap = 1, edge = 1;
  allocate(model, 20);
  for (int i = 0; i < 20; i++) { /* in order of frequency */
    double x = cantilever_root(flap), y = cantilever_root(edge);
    double wf      = x * x * sqrt(E * h * h / (12 * rho)) / (L * L);
    double we      = y * y * sqrt(E * b * b / (12 * rho)) / (L * L);
    int    is_flap = edge > 10 || (flap <= 10 && wf <= we), r = is_flap ? flap++ : edge++;
    double tip                 = 2 * (r % 2 ? 1 : -1) / sqrt(rho * b * h * L);
    model->frequency[i]        = (is_flap ? wf : we) / SHB_TWO_PI;
    model->damping_ratio[i]    = .002;
    model->right[i]            = tip * (is_flap ? sin(angle) : cos(angle));  /* v */
    model->right[20 + i]       = tip * (is_flap ? cos(angle) : -sin(angle)); /* u */
    model->modal_force[20 + i] = is_flap ? tip * force : 0;
    for (int c = 0; c < 3; c++) model->probe[20 * c + i] = model->right[20 * c + i];
  }
}
