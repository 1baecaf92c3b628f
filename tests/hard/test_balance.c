/* Hard cases 12 and 13: results do not depend on units; power in equals power out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "tests/hard/floquet.h"
#include "tests/hard/power.h"
#include "tests/hard/verdict.h"
#include "tests/support/micrometres.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

static void compare(modal_model *model, mhb_settings *s, double from, double to, const char *name) {
  mhb_response *r[2];
  floquet      *f[2];
  double        worst[3] = {0, 0, 0}, size = 0;
  for (int i = 0; i < 2; i++) {
    if (i) model_in_micrometres(model, s);
    r[i] = covered_sweep(model, s, from, to);
    f[i] = calloc((size_t)r[i]->branch[2].n_points, sizeof *f[i]);
    floquet_branch(model, s, r[i], &r[i]->branch[2], 128, f[i]);
  }
  const mhb_branch *a = &r[0]->branch[2], *b = &r[1]->branch[2];
  verdict_count(b->n_points, a->n_points, "12 %s: points", name);
  int n = a->n_points < b->n_points ? a->n_points : b->n_points;
  int K = 3 * r[0]->n_pairs * (r[0]->n_harmonics + 1);
  for (int i = 0; i < n; i++) {
    worst[0] = fmax(worst[0], fabs(a->frequency[i] / b->frequency[i] - 1));
    if (a->special[i] == MHB_ORDINARY) /* a located one may be a kink */
      worst[1] = fmax(worst[1], fabs(f[0][i].largest - f[1][i].largest));
  }
  for (int i = 0; i < n * K; i++) {
    size = fmax(size, cabs(a->motion[i]));
    if (a->special[i / K] != MHB_ORDINARY) continue; /* located to 1e-9 of the frequency */
    worst[2] = fmax(worst[2], cabs(a->motion[i] - 1e-6 * b->motion[i]));
  }
  verdict(worst[0], 1e-9, "12 %s: frequency", name);
  verdict(worst[2] / size, 1e-9, "12 %s: motion", name);
  /* of two that meet: to the square root of rounding */
  verdict(worst[1], 1e-7, "12 %s: largest multiplier", name);
  for (int i = 0; i < 2; i++) {
    mhb_response_destroy(r[i]);
    free(f[i]);
  }
}

static void units(void **state) {
  (void)state;
  static const double n0[] = {.3, 0, -.2};
  for (int i = 0; i < 3; i++) {
    modal_model model;
    char        name[32];
    three_degree_model(&model);
    mhb_settings s = ground_settings(.4, .8, .5, n0[i], 7);
    snprintf(name, sizeof name, "three degrees, n0 %.1f", n0[i]);
    compare(&model, &s, .8, 1.7, name);
    modal_model_free(&model);
  }
  modal_model model;
  random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 55, &model);
  mhb_settings s = random_settings(4);
  s.engine_order = 2;
  s.n0[0]        = .1;
  compare(&model, &s, .9, 1.2, "ring of 6");
  modal_model_free(&model);
  verdict_all();
}

/* The power balance at every point of the branch. Friction is the loop integral of f.ds, and the
 * sum over the slip phases. */
static void balance(const modal_model *model, mhb_settings *s, double from, double to,
                    const char *name) {
  mhb_response *r = covered_sweep(model, s, from, to);
  mhb_balance  *b;
  double        worst[2] = {0, 0}, share = 0;
  assert_int_equal(mhb_balance_create(model, s, &b), SHB_OK);
  double            x[b->n], unused[b->n];
  const mhb_branch *branch = &r->branch[2];
  for (int i = 0; i < branch->n_points; i++) {
    double omega = SHB_TWO_PI * branch->frequency[i], loop = 0;
    mhb_balance_set_preload(b, branch->n0[i]);
    point_of(r, branch, i, 0, x);
    mhb_balance_evaluate(b, x, omega, unused, NULL, NULL);
    power p = power_of(b, omega);
    for (int a = 0; a < b->n_pairs; a++) loop += b->eval->info[a].dissipation;
    worst[0] = fmax(worst[0], fabs(p.input - p.damping - loop) / p.input);
    worst[1] = fmax(worst[1], fabs(p.input - p.damping - p.friction) / p.input);
    share    = fmax(share, p.friction / p.input);
  }
  verdict(worst[0], 1e-8, "13 %s: %d points, friction up to %.2f", name, branch->n_points, share);
  /* next to slip onset the slider is known to the square root of the law's tolerance only */
  if (s->tolerance < 1e-11) verdict(worst[1], 1e-8, "13 %s: by the pieces in slip", name);
  mhb_balance_destroy(b);
  mhb_response_destroy(r);
}

static void power_in_and_out(void **state) {
  (void)state;
  static const double n0[] = {.3, .1, 0, -.2};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 8; i++) {
    mhb_settings s = ground_settings(.4, .8, .5, n0[i / 2], 7);
    char         name[48];
    if (i % 2) s.tolerance = 1e-12;
    snprintf(name, sizeof name, "three degrees, n0 %.1f, accuracy %.0e", n0[i / 2], s.tolerance);
    balance(&model, &s, .8, 1.7, name);
  }
  modal_model_free(&model);
  tip_contact_beam_model(20, &model);
  mhb_settings s = ground_settings(.3, 2e5, 2e5, 100, 7);
  balance(&model, &s, SHB_TWO_PI * 215, SHB_TWO_PI * 320, "beam, F 20");
  modal_model_free(&model);
  random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 55, &model);
  free(model.load_residual);
  free(model.load_inertia);
  free(model.probe_load_residual);
  free(model.probe_load_inertia);
  model.load_residual = model.probe_load_residual = NULL;
  model.load_inertia = model.probe_load_inertia = NULL;
  s                                             = random_settings(4);
  s.tolerance                                   = 1e-8;
  s.engine_order                                = 2;
  s.n0[0]                                       = .1;
  balance(&model, &s, .9, 1.6, "ring of 6");
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(units),
      cmocka_unit_test(power_in_and_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
