#include "mhb/contact/force_integrals.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

double mhb_force_integrals_factor(int i) {
  return i == 0 ? 1 / SHB_TWO_PI : 2 / SHB_TWO_PI;
}

void mhb_force_integrals_clear(mhb_contact_evaluator *c) {
  size_t nf = (size_t)c->nf, sums = (size_t)mhb_real_size(c->H + c->m);
  memset(c->f, 0, sizeof(double) * 2 * nf);
  memset(c->f_slider, 0, sizeof(double) * 2 * nf);
  memset(c->slip_sums, 0, sizeof(mhb_lanes) * 4 * nf);
  memset(c->stick_integrals, 0, sizeof(double) * sums);
  memset(c->first_stick, 0, sizeof(double) * sums);
  memset(c->info->share, 0, sizeof c->info->share);
  c->squared_error = c->info->slip_work = c->info->error = c->info->n_transitions = 0;
  c->dense_output.n                                                               = 0;
  if (c->mode != MHB_ALL_COLUMNS) return;
  memset(c->J, 0, sizeof(double) * 2 * nf * (size_t)c->stride);
  memset(c->load_sums, 0, sizeof(mhb_lanes) * 2 * sums);
}

void mhb_force_integrals_collect(mhb_contact_evaluator *c) {
  for (int i = 0; i < c->nf; i++) {
    const mhb_lanes *sum = c->slip_sums + 4 * i;
    for (int k = 0; k < 2; k++) {
      c->f[k * c->nf + i] += lanes_sum(sum[k]);
      if (c->mode != MHB_NO_COLUMNS) c->f_slider[k * c->nf + i] += lanes_sum(sum[2 + k]);
    }
  }
}

/* The normal load in slip at a fixed direction: J += integrals of mu kv e b_i b_j. */
MHB_HOT static void finish_load(mhb_contact_evaluator *c) {
  int nb = c->nb, nf = c->nf, sums = mhb_real_size(c->H + c->m);
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < sums; i++) c->basis_integrals[i] = lanes_sum(c->load_sums[2 * i + k]);
    mhb_basis_product(c->H, c->m, c->basis_integrals, c->basis_products, nb);
    for (int i = 0; i < nf; i++) {
      double *row = c->J + (size_t)(k * nf + i) * (size_t)c->stride;
      for (int j = 0; j < nb; j++) row[j] += c->basis_products[i * nb + j];
    }
  }
}

MHB_HOT void mhb_force_integrals_finish(mhb_contact_evaluator *c) {
  int nb = c->nb, nf = c->nf, all = c->mode == MHB_ALL_COLUMNS;
  int used = all ? nb : mhb_real_size(c->signals.top);
  if (all) finish_load(c);
  mhb_basis_product(c->H, all ? c->m : c->signals.top, c->stick_integrals, c->basis_products, nb);
  for (int i = 0; i < nf; i++) {
    const double *S = c->basis_products + (size_t)i * (size_t)nb;
    double        q = mhb_force_integrals_factor(i);
    for (int k = 0; k < 2; k++) {
      double *f = &c->f[k * nf + i], *row = c->J + (size_t)(k * nf + i) * (size_t)c->stride;
      for (int j = 0; j < used; j++) *f += S[j] * c->coefficients[(1 + k) * nb + j];
      *f *= q;
      if (!all) continue;
      for (int j = 0; j < nb; j++) {
        row[nb + j] += c->K[k][0] * S[j];
        row[2 * nb + j] += c->K[k][1] * S[j];
      }
      for (int j = 0; j < 3 * nb; j++) row[j] *= q;
    }
  }
}

void mhb_note_transition(mhb_contact_evaluator *c, double t, mhb_state state) {
  mhb_contact_info *info = c->info;
  if (!c->record || info->n_transitions == MHB_MAX_TRANSITIONS) return;
  double phase = t / SHB_TWO_PI + 1e-14; /* phase 1 is phase 0 */
  info->transition[info->n_transitions++] =
      (mhb_transition){.phase = fmax(0, phase - floor(phase) - 1e-14), .state = (int)state};
}
