/* SAFE diagram: nodal diameters of orders, families of the ring, the section. */
#include "postproc/report/safe_diagram.h"

#include <math.h>
#include <string.h>

#include "modal/model/nodal_diameters.h"
#include "tests/support/check.h"

static void diameters_of_orders(void **state) {
  (void)state;
  static const int order[] = {0, 1, 5, 20, 21, 35, 40, 45}, wanted[] = {0, 1, 5, 20, 19, 5, 0, 5};
  for (int i = 0; i < 8; i++) assert_int_equal(modal_nodal_diameter(order[i], 40), wanted[i]);
  assert_int_equal(modal_nodal_diameter(4, 7), 3);
  assert_int_equal(modal_nodal_diameter(3, 7), 3);
}

/* A ring of seven blades, whose file lacks nodal diameter 2: the range chooses the families. */
static void families_in_the_range_are_shown(void **state) {
  (void)state;
  int                diameter[] = {0, 1, 3};
  double             open[3][4], stuck[3][4], frequency[] = {100, 200, 300, 900};
  const modal_model  model    = {.n_modes = 4, .frequency = frequency};
  const mhb_response response = {.blades = 7, .engine_order = 2};
  const mhb_diagrams d        = {.known       = true,
                                 .n_families  = 4,
                                 .n_diameters = 3,
                                 .diameter    = diameter,
                                 .open        = *open,
                                 .stuck       = *stuck,
                                 .n_driven    = 2,
                                 .driven      = {1, 2}};
  post_safe          safe;
  post_buffer        html = {0}, data = {0};
  for (int i = 0; i < 12; i++) {
    open[i / 4][i % 4]  = frequency[i % 4];
    stuck[i / 4][i % 4] = frequency[i % 4] + 1 + i / 4;
  }
  post_safe_create(&d, &model, &response, (const double[]){90, 120}, 0.2, &safe);
  assert_int_equal(safe.n_families, 3);
  assert_near(safe.stuck[3 * 3 + 1], 203, 0);
  assert_true(isnan(safe.open[2 * 3]) && isnan(safe.stuck[2 * 3 + 2]));
  post_safe_table(&safe, &html);
  post_safe_data(&safe, &data);
  assert_has(html.text, "<th scope=\"row\">4</th><td>3</td><td>stuck</td><td>103.00</td>");
  assert_has(data.text, "\"driven\":[1,2],\"open\":[[100,200,300],[100,200,300],[null,null,null],");
  post_buffer_free(&html);
  post_buffer_free(&data);
  post_safe_free(&safe);
  post_safe_create(&d, &model, &response, (const double[]){90, 700}, 0.2, &safe);
  assert_int_equal(safe.n_families, 4);
  post_safe_free(&safe);
}

/* Of a file without families nothing is shown, and one of an older version says so. */
static void nothing_is_shown_without_families(void **state) {
  (void)state;
  const modal_model  model    = {0};
  const mhb_response response = {.blades = 7};
  const mhb_diagrams old      = {0};
  post_safe          safe;
  post_buffer        html = {0};
  post_safe_create(&old, &model, &response, (const double[]){90, 120}, 0, &safe);
  post_safe_table(&safe, &html);
  post_safe_data(&safe, &html);
  assert_true(html.length == 0 && !safe.known);
  post_safe_free(&safe);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(diameters_of_orders),
                                     cmocka_unit_test(families_in_the_range_are_shown),
                                     cmocka_unit_test(nothing_is_shown_without_families)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
