/* contact.points: auto takes the fewest patches that keep the tolerance. */
#include "cases/commands/contact_points.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "tests/support/check.h"
#include "tests/support/random_disc.h"
#include "tests/support/shroud_face.h"

enum { PAIRS = 16 };

static mhb_settings settings_of(void) {
  mhb_settings s = shroud_face_settings(3);
  s.frequency[1] = 245;
  return s;
}

/* Number of pairs at a tolerance. */
static int chosen_at(double tolerance, double *estimate) {
  modal_model     model;
  contact_points *points;
  mhb_settings    s = settings_of();
  smooth_face_model(PAIRS, 150, &model);
  assert_int_equal(contact_points_choose(&model, NULL, &s, tolerance, &points), SHB_OK);
  const int n = model.n_pairs;
  *estimate   = points ? points->estimate : 0;
  if (points) {
    assert_int_equal(points->other.n_pairs, PAIRS);
    assert_int_equal(points->joining.n_patches, n);
    assert_true(points->pairs.finer && points->pairs.model == &points->other);
  } else {
    assert_int_equal(n, PAIRS);
  }
  contact_points_free(points);
  modal_model_free(&model);
  return n;
}

static void fewest_that_keep_the_tolerance(void **state) {
  (void)state;
  static const double tolerance[] = {.5, .1, .02, 1e-6};
  int                 n[4];
  for (int i = 0; i < 4; i++) {
    double estimate;
    n[i] = chosen_at(tolerance[i], &estimate);
    print_message("tolerance %g: %d of %d, estimate %.2g\n", tolerance[i], n[i], PAIRS, estimate);
    assert_below(estimate, tolerance[i]);
    if (i > 0) assert_true(n[i] >= n[i - 1]);
  }
  assert_true(n[0] < PAIRS && n[3] == PAIRS && n[0] < n[2]);
}

/* The same of a disc; all its models are joined, and judged by the whole ones. */
static void points_of_a_disc(void **state) {
  (void)state;
  int last = 0;
  for (double tolerance = .5; tolerance > 1e-3; tolerance /= 30) {
    modal_model           face;
    modal_nodal_diameters disc;
    contact_points       *points;
    mhb_settings          s = settings_of();
    smooth_face_model(PAIRS, 150, &face);
    face_disc(&face, 6, 0, &disc);
    modal_model_free(&face);
    s.blades          = 6;
    s.engine_order    = 1;
    s.nodal_diameters = &disc;
    modal_model first = disc.model[0];
    assert_ok(contact_points_choose(&first, &disc, &s, tolerance, &points));
    print_message("disc, tolerance %g: %d of %d, estimate %.2g\n", tolerance, first.n_pairs, PAIRS,
                  points ? points->estimate : 0);
    for (int n = 0; n < disc.n; n++) assert_int_equal(disc.model[n].n_pairs, first.n_pairs);
    assert_true(first.n_pairs > last && first.right == disc.model[0].right);
    last = first.n_pairs;
    if (points) {
      assert_below(points->estimate, tolerance);
      assert_ptr_equal(points->pairs.nodal_diameters, &points->disc);
      assert_int_equal(points->disc.model[1].n_pairs, PAIRS);
    }
    contact_points_free(points);
    modal_nodal_diameters_free(&disc);
  }
}

/* Normals from -15 to 15 deg along the face: a patch is flat to 5 deg, also where any number keeps
 * the tolerance. */
static void patches_of_a_curved_face_are_flat(void **state) {
  (void)state;
  modal_model     model;
  contact_points *points;
  mhb_settings    s = settings_of();
  smooth_face_model(PAIRS, 150, &model);
  double least = INFINITY, most = -INFINITY;
  for (int i = 0; i < PAIRS; i++) {
    least = fmin(least, model.position[3 * i + 1]);
    most  = fmax(most, model.position[3 * i + 1]);
  }
  model.normal = malloc(sizeof(double[3]) * PAIRS);
  for (int i = 0; i < PAIRS; i++) {
    const double part = (model.position[3 * i + 1] - least) / (most - least);
    const double a    = s.psi + (part - .5) * 30 * SHB_PI / 180;
    memcpy(model.normal + 3 * (size_t)i, (double[]){cos(a), sin(a), 0}, sizeof(double[3]));
  }
  assert_ok(contact_points_choose(&model, NULL, &s, 50, &points));
  assert_non_null(points);
  print_message("a face curved by 30 deg: %d of %d, off by up to %.3g deg\n", model.n_pairs, PAIRS,
                points->joining.spread);
  assert_in_range(model.n_pairs, 3, PAIRS - 1);
  assert_true(points->joining.spread > 1 && points->joining.spread <= MODAL_FLAT);
  contact_points_free(points);
  modal_model_free(&model);
}

/* Every point of a response carries the estimate that the choice rests on. */
static void points_carry_the_error(void **state) {
  (void)state;
  modal_model     model;
  contact_points *points;
  mhb_response   *response;
  mhb_settings    s      = settings_of();
  int             judged = 0, beyond = 0, moving = 0;
  s.stability = MHB_STABILITY_NEVER;
  smooth_face_model(PAIRS, 150, &model);
  assert_int_equal(contact_points_choose(&model, NULL, &s, .1, &points), SHB_OK);
  assert_non_null(points);
  s.other_pairs = &points->pairs;
  assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &response), SHB_OK);
  const mhb_branch *b = &response->branch[2];
  for (int i = 0; i < b->n_points; i++) {
    const double *state_of = b->state + 3 * (size_t)(i * response->n_pairs);
    bool          moves    = false;
    for (int a = 0; a < response->n_pairs; a++)
      moves = moves || (state_of[3 * a] < 1 && state_of[3 * a + 2] < 1);
    judged += b->error_spatial[i] >= 0;
    moving += moves;
    beyond += moves && b->error_spatial[i] > .1;
  }
  print_message("%d of %d points judged; %d of %d moving ones beyond the tolerance\n", judged,
                b->n_points, beyond, moving);
  assert_true(moving > 5 && judged > .9 * b->n_points && beyond <= .2 * moving);
  mhb_response_destroy(response);
  contact_points_free(points);
  modal_model_free(&model);
}

static void half_as_many_judge_a_fixed_number(void **state) {
  (void)state;
  modal_model     model;
  contact_points *points;
  smooth_face_model(PAIRS, 150, &model);
  assert_int_equal(contact_points_halve(&model, NULL, &points), SHB_OK);
  assert_int_equal(model.n_pairs, PAIRS);
  assert_int_equal(points->other.n_pairs, PAIRS / 2);
  assert_false(points->pairs.finer);
  contact_points_free(points);
  free(model.position);
  model.position = NULL;
  assert_int_equal(contact_points_halve(&model, NULL, &points), SHB_OK);
  assert_null(points); /* without positions nothing is judged */
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fewest_that_keep_the_tolerance),    cmocka_unit_test(points_of_a_disc),
      cmocka_unit_test(patches_of_a_curved_face_are_flat), cmocka_unit_test(points_carry_the_error),
      cmocka_unit_test(half_as_many_judge_a_fixed_number),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
