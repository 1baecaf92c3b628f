#include "tests/support/micrometres.h"

static void times(double *x, int n, double factor) {
  for (int i = 0; x && i < n; i++) x[i] *= factor;
}

void model_in_micrometres(modal_model *model, mhb_settings *s) {
  int n = 3 * model->n_pairs, nc = (model->has_left ? 2 : 1) * n, m = model->n_modes,
      q = 3 * model->n_probes, loads = model->n_load + 1;
  times(model->right, n * m, 1e6);
  times(model->left, n * m, 1e6);
  times(model->probe, q * m, 1e6);
  times(model->residual_flexibility, nc * nc, 1e12);
  times(model->residual_inertia, nc * nc, 1e12);
  times(model->residual_fourth, nc * nc, 1e12);
  times(model->probe_contact_residual, q * nc, 1e12);
  times(model->probe_contact_inertia, q * nc, 1e12);
  times((double *)model->load_residual, 2 * loads * nc, 1e6);
  times((double *)model->load_inertia, 2 * loads * nc, 1e6);
  times((double *)model->probe_load_residual, 2 * loads * q, 1e6);
  times((double *)model->probe_load_inertia, 2 * loads * q, 1e6);
  s->kv *= 1e-12;
  times(s->ku, 3, 1e-12);
  times(s->n0, s->n_preloads, 1e-6);
}
