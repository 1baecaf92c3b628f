/* The main branch: what is published while it is traced and judged. */
#include "mhb/branches/main_branch.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

/* Every point is published twice: when it is recorded and when it is judged. A killed run then
 * loses little. A branch that is not judged to its end is not complete. */
static void points_are_published_twice(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s    = ground_settings(0.4, 0.8, 0.5, 0.1, 5);
  s.frequency[0]    = 0.8 / SHB_TWO_PI;
  s.frequency[1]    = 1.7 / SHB_TWO_PI;
  quiet_monitor due = due_monitor_create();
  mhb_response *r;
  assert_ok(watched_main_curve(&model, &s, 5, &due.base, &r));
  const mhb_branch *main       = &r->branch[0];
  int               n_ordinary = 0;
  for (int i = 0; i < main->n_points; i++) n_ordinary += main->special[i] == MHB_ORDINARY;
  print_message("%d points, %d publications\n", main->n_points, due.n_published);
  assert_true(n_ordinary > 20);
  assert_true(due.n_published >= 2 * n_ordinary);
  assert_true(main->complete);
  assert_false(due.early);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_are_published_twice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
