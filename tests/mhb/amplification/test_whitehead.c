/* Whitehead's bound (1 + sqrt N)/2 of the amplification factor, attained in closed form.
 *
 * N blades of one degree of freedom, m = k = 1, are joined by stuck contacts of stiffness kc. The
 * engine order is 0, and three blades differ, with q = sqrt N:
 *   dk_0 = -2 kc q/(1 + q), dk_+-1 = kc q.
 * The ring then has a mode at the tuned frequency, whose shape is 1 + q on blade 0 and 1 on the
 * others. Its modal mass is 2 q (1 + q), its force q (1 + q). With equal dashpots blade 0 swings (1
 * + q)/2 times the tuned amplitude. The part of the other modes falls with the damping. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/balance.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"

enum { MOST = 25 };

static const double KC = 0.05;

/* A mass whose only motion is tangential; both faces move with it. */
static modal_model one_degree(double *frequency, double *damping, double *shape,
                              double complex *force, double *probe, char **name) {
  *frequency = 1 / SHB_TWO_PI;
  shape[0]   = 1;
  force[1]   = 1;
  probe[0]   = 1;
  return (modal_model){.n_modes       = 1,
                       .n_pairs       = 1,
                       .n_probes      = 1,
                       .n_load        = 1,
                       .has_left      = true,
                       .frequency     = frequency,
                       .damping_ratio = damping,
                       .right         = shape,
                       .left          = shape,
                       .modal_force   = force,
                       .probe_name    = name,
                       .probe         = probe};
}

/* Highest amplitude of blade 0 near the tuned frequency over that of the tuned ring. */
static double factor(int N, double zeta) {
  double         frequency, damping = zeta, shape[3] = {0}, probe[3] = {0}, delta[MOST] = {0};
  double complex force[2] = {0};
  char          *name[]   = {"mass"};
  modal_model    blade    = one_degree(&frequency, &damping, shape, force, probe, name);
  mhb_settings   s        = {.blades       = N,
                             .engine_order = 0,
                             .has_psi      = true,
                             .has_phi      = true,
                             .mu           = 10,
                             .kv           = KC,
                             .ku           = {KC, 0, KC},
                             .n_preloads   = 1,
                             .n0           = {1e6},
                             .frequency    = {0.1, 0.2},
                             .harmonics    = 1,
                             .subharmonics = 1,
                             .scale        = 1,
                             .tolerance    = 1e-8};
  const double   q        = sqrt(N);
  delta[0]                = sqrt(1 - 2 * KC * q / (1 + q)) - 1;
  delta[1] = delta[N - 1] = sqrt(1 + KC * q) - 1;
  mhb_mistuned_ring *ring;
  mhb_balance       *b;
  assert_ok(mhb_mistuned_ring_create(&blade, &s, delta, 1, &ring));
  for (int i = 0; i < N; i++) /* equal dashpots: 2 zeta_b (1 + delta_b) = 2 zeta */
    ring->blade[i].damping_ratio[0] = zeta / (1 + delta[i]);
  s.ring = ring;
  assert_ok(mhb_balance_create(&ring->whole, &s, &b));
  mhb_balance_set_preload(b, s.n0[0]);
  double *x = calloc((size_t)b->n, sizeof *x), most = 0;
  for (int i = -20; i <= 20; i++) { /* the peak is flat at the top */
    double complex p[3 * MOST], motion[3 * MOST];
    const double   omega = 1 + 0.01 * i * zeta;
    assert_ok(mhb_balance_linear_limit(b, omega, 1, x));
    mhb_balance_contact_force(b, 1, p);
    mhb_receptance_update(b->receptance, 1);
    mhb_receptance_probe(b->receptance, 1, p, motion);
    most = fmax(most, cabs(motion[0]));
  }
  free(x);
  mhb_balance_destroy(b);
  mhb_mistuned_ring_destroy(ring);
  return most / (1 / (2 * zeta * sqrt(1 - zeta * zeta)));
}

static void bound_is_attained(void **state) {
  const int blades[] = {4, 9, 16, 25};
  (void)state;
  for (int i = 0; i < 4; i++) {
    const double bound = (1 + sqrt(blades[i])) / 2;
    assert_within(factor(blades[i], 1e-8), bound, 1e-6);
  }
}

/* What the other modes add falls with the damping. */
static void error_falls_with_damping(void **state) {
  const double bound = (1 + sqrt(9.)) / 2;
  (void)state;
  double error = fabs(factor(9, 1e-3) / bound - 1);
  for (double zeta = 1e-4; zeta > 1e-7; zeta *= 0.1) {
    const double next = fabs(factor(9, zeta) / bound - 1);
    assert_below(next, 0.2 * error);
    error = next;
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bound_is_attained),
                                     cmocka_unit_test(error_falls_with_damping)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
