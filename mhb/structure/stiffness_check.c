#include "mhb/structure/stiffness_check.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

/* The largest value in the case, N/m, of the leading interface. */
static double largest_stiffness(const mhb_settings *settings, mhb_parameter what, double value) {
  return settings->parameter == what ? fmax(settings->range[0], settings->range[1]) : value;
}

static shb_status check(const char *key, const char *interface, double stiffness,
                        double flexibility) {
  double ratio = stiffness * flexibility;
  SHB_CHECK(!(ratio > MHB_STIFFNESS_LIMIT) || isinf(ratio), SHB_ERR_INPUT,
            "contact.%s%s%s: %.4g N/m is %.2g times as stiff as the blade with its inertia at its "
            "contact (%.3g N/m); beyond %g times it is rigid for every purpose and takes minutes "
            "to follow: give "
            "at most %.2g N/m",
            key, interface ? " of interface " : "", interface ? interface : "", stiffness, ratio,
            1 / flexibility, MHB_STIFFNESS_LIMIT, .99 * MHB_STIFFNESS_LIMIT / flexibility);
  return SHB_OK;
}

/* Flexibility of axis i, m/N: that of the modes left out, and 1/(w_i^2 + w^2) of a mode, its
 * stiffness and its inertia together. A ring has its static one: 0 with a mode at 0 Hz. */
static double flexibility(const mhb_receptance *r, const double complex *residual, double w,
                          int i) {
  if (!residual) return r->model->frequency[0] > 0 ? creal(mhb_receptance_diagonal(r, 1, i)) : 0;
  const modal_model    *model = mhb_receptance_model(r, 1);
  const double complex *B     = r->B + ((size_t)r->n + (size_t)i) * (size_t)r->n_modes;
  double                sum   = creal(residual[(size_t)i * (size_t)(r->n + 1)]);
  for (int j = 0; j < r->n_modes; j++)
    sum += creal(B[j] * conj(B[j])) / (pow(SHB_TWO_PI * model->frequency[j], 2) + w * w);
  return sum;
}

/* The largest along v, u, w of an interface, m/N: a pair's own times its share. */
static void largest_flexibility(const mhb_receptance *r, const double complex *residual, double w,
                                int interface, double most[3]) {
  memset(most, 0, 3 * sizeof *most);
  for (int i = 0; i < r->n; i++)
    if (r->interface[i / 3] == interface)
      most[i % 3] = fmax(most[i % 3], flexibility(r, residual, w, i) * r->share[i / 3]);
}

static shb_status check_interfaces(const mhb_receptance *receptance, const mhb_settings *settings,
                                   const double complex *residual) {
  const int    several = settings->n_interfaces > 1;
  const double w       = SHB_TWO_PI * fmin(settings->frequency[0], settings->frequency[1]);
  for (int i = 0; i < (several ? settings->n_interfaces : 1); i++) {
    const mhb_interface *own  = &settings->interface[i];
    const bool           lead = !several || i == settings->lead;
    const double        *ku = lead ? settings->ku : own->ku, kv = lead ? settings->kv : own->kv;
    const char          *name = several ? own->name : NULL;
    double               most[3], k[3] = {kv, ku[0], ku[2]};
    if (lead) {
      k[0] = largest_stiffness(settings, MHB_IN_KV, kv);
      k[1] = largest_stiffness(settings, MHB_IN_KU, ku[0]);
      k[2] = ku[2] * k[1] / ku[0];
    }
    largest_flexibility(receptance, residual, w, i, most);
    SHB_TRY(check("kv", name, k[0], most[0]));
    SHB_TRY(check("ku", name, k[1], most[1]));
    SHB_TRY(check("ku", name, k[2], most[2]));
  }
  return SHB_OK;
}

shb_status mhb_stiffness_check(mhb_receptance *receptance, const mhb_settings *settings) {
  const size_t    n        = (size_t)receptance->n;
  double complex *residual = receptance->ring ? NULL : shb_alloc_zeroed(n * n, sizeof *residual);
  mhb_receptance_set_frequency(receptance, 1e-6 * receptance->model->frequency[0]);
  if (residual)
    mhb_receptance_residual_terms(receptance, 1, 0, residual);
  else
    mhb_receptance_update(receptance, 1);
  const shb_status status = check_interfaces(receptance, settings, residual);
  free(residual);
  return status;
}
