/* Worst places over a period: closed forms, dense sampling, every node against the bounded search;
 * Goodman's line; the table. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "modal/hdf5/h5.h"
#include "postproc/field/stress_table.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/scratch_folder.h"

static void invariants_are_right(void **state) {
  (void)state;
  const double pull[6] = {-3, 0, 0, 0, 0, 0}, shear[6] = {0, 0, 0, 2, 0, 0};
  const double all[6] = {5, 5, 5, 0, 0, 0};
  assert_near(post_signed_mises(pull), -3, 1e-14);
  assert_near(fabs(post_signed_mises(shear)), 2 * sqrt(3), 1e-14);
  assert_near(post_greatest_principal(shear), 2, 1e-14);
  assert_near(post_greatest_principal(all), 5, 1e-14);
  /* 7 n n^T + 2 m m^T with normal n, m */
  const double n[3] = {0.6, 0, 0.8}, m[3] = {0, 1, 0};
  double       s[6];
  const int    place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int c = 0; c < 6; c++)
    s[c] = 7 * n[place[c][0]] * n[place[c][1]] + 2 * m[place[c][0]] * m[place[c][1]];
  assert_near(post_greatest_principal(s), 7, 1e-13);
  assert_near(post_signed_mises(s), sqrt(49 + 4 - 14), 1e-13);
}

enum { NODES = 400, M = 5, ROWS = 2 * (M + 1) };

/* Nodes in a cube, random harmonics whose size falls with the order, and a static stress. */
static post_blade_field make_field(double *stress) {
  unsigned long long seed = 7;
  post_blade_field   f    = {.n_nodes = NODES};
  f.nodes                 = malloc(sizeof(double) * 3 * NODES);
  f.static_stress         = malloc(sizeof(double) * 6 * NODES);
  for (int i = 0; i < 3 * NODES; i++) f.nodes[i] = random_unit(&seed);
  for (int i = 0; i < 6 * NODES; i++) f.static_stress[i] = 3e7 * random_unit(&seed);
  for (int row = 0; row < ROWS; row++)
    for (int i = 0; i < 6 * NODES; i++)
      stress[row * 6 * NODES + i] = 1e8 * random_unit(&seed) / (1 + row / 2 * row / 2);
  return f;
}

/* Half range of the signed von Mises stress and greatest principal, from dense samples. */
static void sample(const double *stress, int node, double *amplitude, double *principal) {
  enum { DENSE = 2000 };
  double high = -INFINITY, low = INFINITY;
  *principal = 0;
  for (int i = 0; i < DENSE; i++) {
    double s[6] = {0};
    for (int k = 1; k <= M; k++)
      for (int c = 0; c < 6; c++)
        s[c] += stress[(2 * k * NODES + node) * 6 + c] * cos(SHB_TWO_PI * k * i / DENSE) -
                stress[((2 * k + 1) * NODES + node) * 6 + c] * sin(SHB_TWO_PI * k * i / DENSE);
    high       = fmax(high, post_signed_mises(s));
    low        = fmin(low, post_signed_mises(s));
    *principal = fmax(*principal, post_greatest_principal(s));
  }
  *amplitude = (high - low) / 2;
}

static double mean_at(const post_blade_field *f, const double *stress, int node) {
  double s[6];
  for (int c = 0; c < 6; c++) s[c] = stress[6 * node + c] + f->static_stress[6 * node + c];
  return post_signed_mises(s);
}

static void worst_places_are_found(void **state) {
  (void)state;
  double             *stress = malloc(sizeof(double) * ROWS * 6 * NODES);
  post_blade_field    f      = make_field(stress);
  const post_fatigue  none = {0}, goodman = {.endurance = 3e8, .ultimate = 9e8};
  const post_fatigue *fatigue[] = {&none, &goodman};
  for (int given = 0; given < 2; given++) {
    post_worst_place place[POST_PLACES];
    int              n;
    double           worst = 0, off = 0, off_principal = 0;
    assert_ok(post_peak_stress(&f, M, stress, fatigue[given], place, &n));
    assert_int_equal(n, POST_PLACES);
    for (int node = 0; node < NODES; node++) {
      double a, p;
      sample(stress, node, &a, &p);
      worst = fmax(worst, a + given * goodman.endurance / goodman.ultimate *
                                  fmax(mean_at(&f, stress, node), 0));
    }
    for (int i = 0; i < n; i++) {
      double a, p, mean = mean_at(&f, stress, place[i].node);
      sample(stress, place[i].node, &a, &p);
      off           = fmax(off, fabs(place[i].amplitude / a - 1));
      off_principal = fmax(off_principal, fabs(place[i].principal / p - 1));
      assert_near(place[i].mean / mean, 1, 1e-12);
      double load = place[i].amplitude + given * fmax(mean, 0) / 3;
      if (i == 0) assert_near(load / worst, 1, 2e-3);
      if (given) assert_near(place[i].safety * load / goodman.endurance, 1, 1e-12);
      if (!given) assert_true(isnan(place[i].safety));
      for (int j = 0; j < i; j++) assert_true(place[i].node != place[j].node);
    }
    print_message("amplitude off by %.1e, principal %.1e of 2000 samples\n", off, off_principal);
    assert_true(off < 5e-3 && off_principal < 1e-4);
  }
  free(stress);
  post_blade_field_free(&f);
}

/* One node, one mode, one contact dof, one load pattern: stress = q mode + f column + load. */
static void stress_is_the_sum(void **state) {
  (void)state;
  double         node[3] = {0, 0, 0.4}, mode[6] = {1, 2, 3, 4, 5, 6}, column[12];
  double complex weight[2] = {0.5, CMPLX(2, -1)}, q[2] = {3, CMPLX(1, 4)};
  double complex force[2] = {CMPLX(0, 0), CMPLX(-2, 0.5)};
  double         scale = 1.5, frequency = 100, out[4 * 6];
  int            point = 0;
  mhb_branch     b     = {.order = 1, .n_harmonics = 1, .n_points = 1, .frequency = &frequency};
  for (int c = 0; c < 12; c++) column[c] = c < 6 ? 10 + c : -c;
  b.modal                  = (mhb_modal_motion){1, 1, &point, q, force, &scale};
  const post_blade_field f = {.n_nodes     = 1,
                              .n_modes     = 1,
                              .n_contact   = 1,
                              .n_column    = 2,
                              .n_load      = 1,
                              .nodes       = node,
                              .stress      = mode,
                              .residual    = column,
                              .load_weight = weight};
  assert_int_equal(post_blade_harmonics(&b, 1, 0), 1);
  assert_ok(post_blade_stress(&f, &b, 0, out));
  for (int k = 0; k < 2; k++)
    for (int c = 0; c < 6; c++) {
      double complex wanted =
          q[k] * mode[c] + force[k] * column[c] + scale * weight[k] * column[6 + c];
      assert_near(out[2 * k * 6 + c], creal(wanted), 1e-12);
      assert_near(out[(2 * k + 1) * 6 + c], cimag(wanted), 1e-12);
    }
}

/* Odd nodes are of a weaker material, every tenth of one without a line. The worst place is that of
 * least safety, each by its own line. */
static void each_node_has_its_own_material(void **state) {
  (void)state;
  double            *stress = malloc(sizeof(double) * ROWS * 6 * NODES);
  post_blade_field   f      = make_field(stress);
  const post_goodman line[] = {{3e8, 9e8}, {1.2e8, 4e8}, {0, 0}};
  int                region[NODES], n;
  post_worst_place   place[POST_PLACES];
  double             least = INFINITY;
  for (int i = 0; i < NODES; i++) region[i] = i % 10 == 0 ? 2 : i % 2;
  const post_fatigue fatigue = {.region = region, .n_regions = 3, .of = line};
  assert_true(post_fatigue_given(&fatigue));
  assert_ok(post_peak_stress(&f, M, stress, &fatigue, place, &n));
  for (int node = 0; node < NODES; node++) {
    const post_goodman *own = &line[region[node]];
    double              a, p;
    if (own->endurance == 0) continue;
    sample(stress, node, &a, &p);
    least =
        fmin(least, 1 / (a / own->endurance + fmax(mean_at(&f, stress, node), 0) / own->ultimate));
  }
  assert_near(place[0].safety / least, 1, 2e-3);
  for (int i = 0; i < n; i++) {
    const post_goodman *own = &line[region[place[i].node]];
    assert_true(own->endurance > 0);
    assert_near(place[i].safety *
                    (place[i].amplitude / own->endurance + fmax(place[i].mean, 0) / own->ultimate),
                1, 1e-12);
    if (i > 0) assert_true(place[i].safety >= place[i - 1].safety);
  }
  free(stress);
  post_blade_field_free(&f);
}

/* Two elements of two volumes share the nodes 8 and 9: the stiffer one counts there. */
static shb_status fill_volumes(hid_t file, const void *context) {
  const char *const name[] = {"foot", "airfoil"};
  const int element[]      = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
  const int volume[]       = {0, 1};
  (void)context;
  SHB_TRY(h5_write_strings(file, "mesh/volume", 2, name, "volumes"));
  SHB_TRY(h5_write_int(file, "mesh/connectivity", H5_SHAPE(2, 10), element, "-", "elements"));
  return h5_write_int(file, "mesh/material", H5_SHAPE(2), volume, "-", "volume of each");
}

static void the_stiffer_material_counts_where_two_meet(void **state) {
  (void)state;
  const char *const names[] = {"airfoil", "root part", "foot"}, *const others[] = {"a", "b", "c"};
  const double E[] = {127e9, 1e9, 210e9};
  char         path[300];
  int         *region;
  snprintf(path, sizeof path, "%s/volumes.h5", scratch_folder);
  assert_ok(h5_publish(path, fill_volumes, NULL));
  assert_ok(post_blade_regions(path, 18, 3, names, E, &region));
  assert_non_null(region);
  for (int i = 0; i < 18; i++) assert_int_equal(region[i], i < 10 ? 2 : 0);
  free(region);
  assert_ok(post_blade_regions(path, 18, 3, others, E, &region));
  assert_null(region);
}

static void other_modes_are_refused(void **state) {
  (void)state;
  post_blade_field f        = {.n_nodes = 1, .n_modes = 3};
  mhb_response     response = {.n_modes = 2};
  assert_int_equal(post_blade_field_match(&f, &response, "a.modal.h5"), SHB_ERR_INPUT);
  assert_string_equal(shb_message(),
                      "a.modal.h5: has the stress of 3 modes, but the response 2 modes; run "
                      "shroudhb mhb again");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(invariants_are_right),
                                     cmocka_unit_test(worst_places_are_found),
                                     cmocka_unit_test(stress_is_the_sum),
                                     cmocka_unit_test(each_node_has_its_own_material),
                                     cmocka_unit_test(the_stiffer_material_counts_where_two_meet),
                                     cmocka_unit_test(other_modes_are_refused)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
