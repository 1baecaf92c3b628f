#include "tests/hard/power.h"

#include <complex.h>
#include <math.h>

#include "mesh/base/constants.h"

/* Modal coordinates are q_k = L_k (F_k - B_k^H p_k). Work per cycle:
 *   of F on q         pi k Im(F conj q)
 *   of c = 2 zeta w   pi c k^2 w_1 |q|^2 */
power power_of(const mhb_balance *b, double omega) {
  const mhb_receptance *r = b->receptance;
  int                   m = r->n_modes, n3 = r->n;
  double                w1  = omega / r->nu;
  power                 out = {0, 0, 0};
  for (int k = 1; k <= b->m; k++) {
    double complex p[n3];
    mhb_balance_contact_force(b, k, p);
    for (int i = 0; i < m; i++) {
      const double complex *B = r->B + (size_t)k * (size_t)(n3 * m);
      double complex        F = r->F[k * m + i], q = F;
      for (int row = 0; row < n3; row++) q -= conj(B[row * m + i]) * p[row];
      q *= r->lambda[k * m + i];
      double w = SHB_TWO_PI * r->model->frequency[i];
      out.input += SHB_PI * k * cimag(F * conj(q));
      out.damping += SHB_PI * 2 * r->model->damping_ratio[i] * w * k * k * w1 * pow(cabs(q), 2);
    }
  }
  for (int a = 0; a < b->n_pairs; a++) out.friction += b->eval->info[a].slip_work;
  return out;
}
