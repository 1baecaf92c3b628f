/* Hill's method beside the integrated multipliers: equal without friction, on the same side of 1
 * with it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/check.h"
#include "tests/support/hill.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { MOST = 64 };

/* All nodal diameters, one after the other. */
static int multipliers_by_hill(periodic *p, double complex *mu) {
  mhb_balance        *b = p->residual;
  mhb_modal_structure structure;
  int                 n = 0;
  double *r = calloc((size_t)b->n, sizeof *r), *J = calloc((size_t)b->n * (size_t)b->n, sizeof *J);
  mhb_balance_evaluate(b, p->x, p->omega, r, J, NULL); /* for dp */
  assert_int_equal(mhb_modal_structure_create(b->receptance, &p->settings, b->receptance->n_modes,
                                              MHB_STRUCTURE_WHOLE, &structure),
                   SHB_OK);
  for (int d = 0; d < structure.blades; d++, n += 2 * structure.modes)
    assert_int_equal(hill_multipliers(&structure, d, p->omega / p->settings.subharmonics, b->m,
                                      b->eval->dp, mu + n),
                     SHB_OK);
  mhb_modal_structure_destroy(&structure);
  free(r);
  free(J);
  return n;
}

static double compare(periodic *p, const char *name, int substeps) {
  double complex  mine[MOST], hill[MOST];
  mhb_multipliers out = periodic_multipliers(p, substeps, mine);
  int             n   = multipliers_by_hill(p, hill);
  double          off = distance_to(mine, out.n, hill, n), top = 0;
  for (int i = 0; i < n; i++) top = fmax(top, cabs(hill[i]));
  print_message("%-28s largest %.6f, Hill %.6f, all within %.1e\n", name, out.largest, top, off);
  assert_int_equal(top > 1, out.largest > 1);
  return off;
}

/* With m the error falls: kinks of the force, 1/k^2. */
static void without_friction(void **state) {
  (void)state;
  modal_model model;
  double      off[2];
  for (int i = 0; i < 2; i++) {
    periodic     p;
    mhb_settings s = ground_settings(0, 9, 1, -.5, i ? 31 : 11);
    one_degree_model(.02, 0, .5, &model);
    periodic_create(&model, &s, 2.7, NULL, &p);
    off[i] = compare(&p, "one degree, flip", 2048);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
  assert_near(off[1], 0, 2e-3);
  assert_true(off[1] < .3 * off[0]);
  three_degree_model(&model);
  mhb_settings s = ground_settings(0, .8, .5, 0, 15);
  periodic     p;
  periodic_create(&model, &s, .96, NULL, &p);
  assert_near(compare(&p, "three degrees", 1024), 0, 2e-3);
  periodic_destroy(&p);
  modal_model_free(&model);
}

static void rings_without_friction(void **state) {
  (void)state;
  static const int parts[] = {0, WITH_RESIDUAL};
  for (int i = 0; i < 2; i++) {
    modal_model  model;
    mhb_settings s = random_settings(7);
    periodic     p;
    random_model(1, WITH_LEFT | parts[i], 11, &model);
    free(model.residual_inertia);
    model.residual_inertia = NULL;
    s.blades               = 3;
    s.mu                   = 0;
    s.n0[0]                = .05;
    periodic_create(&model, &s, 1.1, NULL, &p);
    assert_near(compare(&p, i ? "ring of 3 with residual" : "ring of 3", 512), 0, 1e-2);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

static void same_side_with_friction(void **state) {
  (void)state;
  static const double rows[][2] = {{.3, 1.42}, {0, 1.05}, {.1, 1.25}};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 3; i++) {
    mhb_settings s = ground_settings(.4, .8, .5, rows[i][0], 11);
    periodic     p;
    periodic_create(&model, &s, rows[i][1], NULL, &p);
    compare(&p, "three degrees with friction", 512);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_friction),
      cmocka_unit_test(rings_without_friction),
      cmocka_unit_test(same_side_with_friction),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
