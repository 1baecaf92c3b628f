/* Joined pairs: the receptance is the mean over patches, patches are nested and of equal area. */
#include "modal/model/joined_pairs.h"

#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/structure/receptance.h"
#include "tests/support/check.h"
#include "tests/support/random_disc.h"
#include "tests/support/random_model.h"

enum { PAIRS = 16, HARMONICS = 2 };

/* A model whose pairs lie on a face of 2.4 by 1. */
static void placed_model(int parts, modal_model *model) {
  unsigned long long seed = 5;
  random_model(PAIRS, parts, 31, model);
  model->position = calloc(3 * (size_t)PAIRS, sizeof *model->position);
  for (int i = 0; i < PAIRS; i++) {
    model->position[3 * i]     = 1.2 * random_unit(&seed);
    model->position[3 * i + 2] = .5 * random_unit(&seed);
  }
}

static mhb_receptance *receptance_of(const modal_model *model, const mhb_settings *s) {
  mhb_receptance *r;
  if (mhb_receptance_create(model, s, HARMONICS, &r) != SHB_OK) fail_msg("%s", shb_message());
  mhb_receptance_at(r, 1.137, HARMONICS);
  return r;
}

/* Largest difference of the joined R and free motion of harmonic k from the means by hand. */
static double difference(const modal_joining *j, const mhb_receptance *all,
                         const mhb_receptance *few, int k) {
  const int             n = all->n, q = few->n;
  const double complex *R      = all->R + (size_t)k * (size_t)n * (size_t)n;
  double complex       *wanted = calloc((size_t)q * (size_t)(q + 1), sizeof *wanted);
  double                worst = 0, size = 0;
  for (int a = 0; a < n; a++) {
    const int row = 3 * j->patch[a / 3] + a % 3;
    wanted[q * q + row] += j->weight[a / 3] * all->free[k * n + a];
    for (int b = 0; b < n; b++)
      wanted[row * q + 3 * j->patch[b / 3] + b % 3] +=
          j->weight[a / 3] * j->weight[b / 3] * R[a * n + b];
  }
  for (int i = 0; i < q * (q + 1); i++) {
    const double complex got = i < q * q ? few->R[(size_t)k * (size_t)q * (size_t)q + (size_t)i]
                                         : few->free[k * q + i - q * q];
    worst                    = fmax(worst, cabs(got - wanted[i]));
    size                     = fmax(size, cabs(wanted[i]));
  }
  free(wanted);
  return worst / size;
}

/* In the shroud axes of pairs and patches: R = W R W^T, also on curved faces of unequal areas. */
static void receptance_is_the_mean(void **state) {
  (void)state;
  static const int parts[] = {0, WITH_LEFT, WITH_LEFT | WITH_RESIDUAL,
                              WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS,
                              WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES | WITH_NORMALS};
  for (size_t c = 0; c < sizeof parts / sizeof *parts; c++) {
    mhb_settings  s = random_settings(HARMONICS);
    modal_model   all, few;
    modal_joining j;
    s.to_ground = !(parts[c] & WITH_LEFT);
    placed_model(parts[c], &all);
    assert_int_equal(modal_joining_create(&all, 5, &j), SHB_OK);
    modal_join(&all, &j, &few);
    assert_int_equal(few.n_pairs, 5);
    mhb_receptance *a = receptance_of(&all, &s), *b = receptance_of(&few, &s);
    for (int k = 0; k <= HARMONICS; k++) {
      double d = difference(&j, a, b, k);
      print_message("parts %d, k = %d: %.1e\n", parts[c], k, d);
      assert_below(d, 1e-12);
    }
    mhb_receptance_destroy(a);
    mhb_receptance_destroy(b);
    modal_joining_free(&j);
    modal_model_free(&few);
    modal_model_free(&all);
  }
}

/* The same at every nodal diameter of a disc, forwards and backwards. */
static void receptance_of_a_disc_is_the_mean(void **state) {
  (void)state;
  modal_nodal_diameters all, few;
  modal_joining         j;
  unsigned long long    seed = 5;
  const int    parts = WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES | WITH_NORMALS | WITH_AREAS;
  mhb_settings s     = random_settings(HARMONICS);
  random_disc(PAIRS, s.blades, parts, true, 3, &all);
  double *position = malloc(3 * (size_t)PAIRS * sizeof *position);
  for (int i = 0; i < 3 * PAIRS; i++) position[i] = random_unit(&seed);
  for (int n = 0; n < all.n; n++) {
    modal_model *m = &all.model[n];
    memcpy(m->normal, all.model[0].normal, 3 * (size_t)PAIRS * sizeof(double));
    memcpy(m->area, all.model[0].area, (size_t)PAIRS * sizeof(double));
    m->position = malloc(3 * (size_t)PAIRS * sizeof(double));
    memcpy(m->position, position, 3 * (size_t)PAIRS * sizeof(double));
  }
  assert_ok(modal_joining_create(&all.model[0], 5, &j));
  modal_join_diameters(&all, &j, &few);
  for (s.engine_order = 1; s.engine_order <= 5; s.engine_order += 4) {
    s.nodal_diameters = &all;
    mhb_receptance *a = receptance_of(&all.model[0], &s);
    s.nodal_diameters = &few;
    mhb_receptance *b = receptance_of(&few.model[0], &s);
    for (int k = 0; k <= HARMONICS; k++) {
      const double d = difference(&j, a, b, k);
      print_message("disc, engine order %d, k = %d: %.1e\n", s.engine_order, k, d);
      assert_below(d, 1e-12);
    }
    mhb_receptance_destroy(a);
    mhb_receptance_destroy(b);
  }
  modal_joining_free(&j);
  modal_nodal_diameters_free(&few);
  modal_nodal_diameters_free(&all);
  free(position);
}

/* Twice as many patches cut each patch in two. The areas of 4 patches differ by two pairs at
 * most. */
static void patches_are_nested(void **state) {
  (void)state;
  modal_model   model;
  modal_joining j[3];
  double        area[4] = {0}, least = INFINITY, most = 0, largest = 0;
  placed_model(WITH_AREAS, &model);
  for (int i = 0; i < 3; i++) assert_int_equal(modal_joining_create(&model, 2 << i, &j[i]), SHB_OK);
  for (int i = 0; i < PAIRS; i++) {
    assert_int_equal(j[0].patch[i], j[1].patch[i] / 2);
    assert_int_equal(j[1].patch[i], j[2].patch[i] / 2);
    area[j[1].patch[i]] += model.area[i];
    largest = fmax(largest, model.area[i]);
  }
  for (int a = 0; a < 4; a++) {
    least = fmin(least, area[a]);
    most  = fmax(most, area[a]);
  }
  print_message("areas of 4 patches: %.3g to %.3g, the largest pair %.3g\n", least, most, largest);
  assert_true(least > 0 && most - least <= 2 * largest);
  for (int i = 0; i < 3; i++) modal_joining_free(&j[i]);
  modal_model_free(&model);
}

/* As many patches as pairs: the same model up to the order of the pairs. */
static void all_patches_change_nothing(void **state) {
  (void)state;
  modal_model   model, same;
  modal_joining j;
  placed_model(WITH_LEFT | WITH_NORMALS | WITH_AREAS | WITH_RESIDUAL, &model);
  assert_int_equal(modal_joining_create(&model, PAIRS, &j), SHB_OK);
  modal_join(&model, &j, &same);
  const size_t row = 3 * (size_t)model.n_modes;
  for (int i = 0; i < PAIRS; i++)
    for (size_t d = 0; d < row; d++) {
      assert_near(same.right[(size_t)j.patch[i] * row + d], model.right[(size_t)i * row + d],
                  1e-12);
      assert_near(same.left[(size_t)j.patch[i] * row + d], model.left[(size_t)i * row + d], 1e-12);
    }
  modal_joining_free(&j);
  modal_model_free(&same);
  modal_model_free(&model);
}

/* Forces spread over the pairs do the work of the patches' forces: (W^T f) u = f (W u). */
static void spread_forces_do_the_same_work(void **state) {
  (void)state;
  modal_model        model, few;
  modal_joining      j;
  unsigned long long seed = 9;
  double complex     patch[2 * 3 * 3], pair[2 * 3 * PAIRS], work[2] = {0};
  placed_model(WITH_LEFT | WITH_NORMALS | WITH_AREAS, &model);
  assert_int_equal(modal_joining_create(&model, 3, &j), SHB_OK);
  modal_join(&model, &j, &few);
  for (int i = 0; i < 2 * 3 * 3; i++) patch[i] = CMPLX(random_unit(&seed), random_unit(&seed));
  modal_joining_spread(&j, 2, patch, pair);
  for (int i = 0; i < 3 * PAIRS; i++)
    work[0] += pair[i] * model.right[i * model.n_modes + 1] +
               pair[3 * PAIRS + i] * model.left[i * model.n_modes + 1];
  for (int i = 0; i < 9; i++)
    work[1] +=
        patch[i] * few.right[i * few.n_modes + 1] + patch[9 + i] * few.left[i * few.n_modes + 1];
  assert_below(cabs(work[0] - work[1]) / cabs(work[1]), 1e-12);
  modal_joining_free(&j);
  modal_model_free(&few);
  modal_model_free(&model);
}

static void faults_are_told(void **state) {
  (void)state;
  modal_model   model;
  modal_joining j;
  placed_model(0, &model);
  assert_int_equal(modal_joining_create(&model, PAIRS + 1, &j), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "17 patches asked of 16 contact pairs"));
  assert_int_equal(modal_joining_create(&model, 0, &j), SHB_ERR_INPUT);
  free(model.position);
  model.position = NULL;
  assert_int_equal(modal_joinable(&model), 0);
  assert_int_equal(modal_joining_create(&model, 2, &j), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "/contact/coordinates"));
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(receptance_is_the_mean),
      cmocka_unit_test(receptance_of_a_disc_is_the_mean),
      cmocka_unit_test(patches_are_nested),
      cmocka_unit_test(all_patches_change_nothing),
      cmocka_unit_test(spread_forces_do_the_same_work),
      cmocka_unit_test(faults_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
