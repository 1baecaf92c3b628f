/* SAFE diagram: nodal diameters of orders, families of the ring, the section. */
#include "postproc/report/safe_diagram.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/linear_resonances.h"
#include "modal/model/nodal_diameters.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

static void diameters_of_orders(void **state) {
  (void)state;
  static const int order[] = {0, 1, 5, 20, 21, 35, 40, 45}, wanted[] = {0, 1, 5, 20, 19, 5, 0, 5};
  for (int i = 0; i < 8; i++) assert_int_equal(modal_nodal_diameter(order[i], 40), wanted[i]);
  assert_int_equal(modal_nodal_diameter(4, 7), 3);
  assert_int_equal(modal_nodal_diameter(3, 7), 3);
}

static void families_are_those_of_the_ring(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s        = random_settings(3);
  const double range[2] = {0.1, 0.3};
  post_safe    safe;
  post_buffer  html = {0}, data = {0};
  double       f[6];
  random_model(1, WITH_LEFT, 3, &model);
  assert_ok(post_safe_compute(&model, &s, range, 0.2, &safe));
  assert_true(safe.n_families >= 3 && safe.n_families <= 6);
  assert_int_equal(safe.n_driven, 2); /* harmonics 1 and 2 of the load */
  for (int d = 0; d <= s.blades / 2; d++) {
    assert_ok(mhb_stuck_frequencies(&model, &s, d, safe.n_families, f));
    for (int i = 0; i < safe.n_families; i++) {
      assert_near(safe.stuck[d * safe.n_families + i], f[i], 1e-12);
      assert_near(safe.open[d * safe.n_families + i], model.frequency[i], 0);
      assert_true(f[i] > model.frequency[i] * (1 - 1e-12)); /* springs only stiffen */
    }
  }
  post_safe_table(&safe, &html);
  post_safe_data(&safe, &data);
  assert_non_null(strstr(html.text, "<td>stuck</td>"));
  assert_non_null(strstr(data.text, "\"driven\":[1,2],\"open\":[["));
  post_buffer_free(&data);
  post_buffer_free(&html);
  post_safe_free(&safe);
  s.to_ground = true;
  assert_ok(post_safe_compute(&model, &s, range, 0, &safe));
  post_safe_table(&safe, &html);
  post_safe_data(&safe, &data);
  assert_true(safe.n_families == 0 && html.length == 0 && data.length == 0);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(diameters_of_orders),
                                     cmocka_unit_test(families_are_those_of_the_ring)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
