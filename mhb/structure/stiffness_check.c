#include "mhb/structure/stiffness_check.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* The largest value in the case, N/m, of the leading interface. */
static double largest_stiffness(const mhb_settings *settings, mhb_parameter what, double value) {
  return settings->parameter == what ? fmax(settings->range[0], settings->range[1]) : value;
}

static shb_status check(const char *key, const char *interface, double stiffness,
                        double flexibility) {
  double ratio = stiffness * flexibility;
  SHB_CHECK(!(ratio > MHB_STIFFNESS_LIMIT) || isinf(ratio), SHB_ERR_INPUT,
            "contact.%s%s%s: %.4g N/m is %.2g times as stiff as the blade at its contact (%.3g "
            "N/m); beyond %g times it is rigid for every purpose and takes minutes to follow: give "
            "at most %.2g N/m",
            key, interface ? " of interface " : "", interface ? interface : "", stiffness, ratio,
            1 / flexibility, MHB_STIFFNESS_LIMIT, .99 * MHB_STIFFNESS_LIMIT / flexibility);
  return SHB_OK;
}

/* Largest static flexibility along v, u, w of an interface, m/N: a pair's own times its share. */
static void largest_flexibility(const mhb_receptance *receptance, int interface, double most[3]) {
  const int n = receptance->n;
  memset(most, 0, 3 * sizeof *most);
  for (int i = 0; i < n; i++) {
    if (receptance->interface[i / 3] != interface) continue;
    const double R = creal(mhb_receptance_diagonal(receptance, 1, i));
    most[i % 3]    = fmax(most[i % 3], R * receptance->share[i / 3]);
  }
}

shb_status mhb_stiffness_check(mhb_receptance *receptance, const mhb_settings *settings) {
  const int several = settings->n_interfaces > 1;
  mhb_receptance_set_frequency(receptance, 1e-6 * receptance->model->frequency[0]);
  mhb_receptance_update(receptance, 1);
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
    largest_flexibility(receptance, i, most);
    SHB_TRY(check("kv", name, k[0], most[0]));
    SHB_TRY(check("ku", name, k[1], most[1]));
    SHB_TRY(check("ku", name, k[2], most[2]));
  }
  return SHB_OK;
}
