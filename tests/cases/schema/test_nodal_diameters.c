/* Nodal diameters of a disc that the harmonics of a case need. */
#include "cases/schema/nodal_diameters.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static case_file file; /* large */

/* A case with contact and modal.nodal_diameters: auto. */
static case_file *with(int blades, int engine_order, int harmonics) {
  memset(&file, 0, sizeof file);
  file.blades           = blades;
  file.engine_order     = engine_order;
  file.mhb.harmonics    = harmonics;
  file.mhb.subharmonics = 1;
  file.has_contact      = true;
  return &file;
}

static void expect(const case_file *f, int n, const int *wanted) {
  int list[CASE_MOST_DIAMETERS];
  assert_int_equal(case_nodal_diameters(f, list), n);
  for (int i = 0; i < n; i++) assert_int_equal(list[i], wanted[i]);
}

static void harmonics_meet_the_disc(void **state) {
  (void)state;
  /* the truncation estimate looks at harmonics 0 to 12, or four times as many as the balance has */
  expect(with(64, 5, 1), 13, (const int[]){0, 4, 5, 9, 10, 14, 15, 19, 20, 24, 25, 29, 30});
  expect(with(40, 5, 31), 5, (const int[]){0, 5, 10, 15, 20});
  expect(with(24, 2, 7), 7, (const int[]){0, 2, 4, 6, 8, 10, 12});
  /* waves that run backwards */
  expect(with(40, 39, 1), 13, (const int[]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  expect(with(24, 24, 3), 1, (const int[]){0}); /* all blades in phase */
  expect(with(2, 1, 5), 2, (const int[]){0, 1});
  expect(with(24, 54, 1), 3, (const int[]){0, 6, 12}); /* an engine order above N */
}

/* With mhb.harmonics: auto all multiples of the engine order are there. */
static void all_harmonics(void **state) {
  (void)state;
  expect(with(40, 6, 0), 11, (const int[]){0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20});
}

static void cases_that_need_all(void **state) {
  (void)state;
  int        list[CASE_MOST_DIAMETERS];
  case_file *f = with(24, 0, 7);
  assert_int_equal(case_nodal_diameters(f, list), -1);
  f              = with(24, 5, 7);
  f->has_contact = false;
  assert_int_equal(case_nodal_diameters(f, list), -1);
  f                   = with(24, 5, 7);
  f->mhb.subharmonics = 2;
  assert_int_equal(case_nodal_diameters(f, list), -1);
  f                    = with(24, 5, 7);
  f->mhb.search.starts = 3;
  assert_int_equal(case_nodal_diameters(f, list), -1);
  f                 = with(24, 5, 7);
  f->diameters.what = CASE_DIAMETERS_ALL;
  assert_int_equal(case_nodal_diameters(f, list), -1);
}

static void a_list_is_taken(void **state) {
  (void)state;
  case_file *f = with(24, 5, 7);
  f->diameters = (case_diameters){CASE_DIAMETERS_LISTED, 2, {3, 11}};
  expect(f, 2, (const int[]){3, 11});
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(harmonics_meet_the_disc), cmocka_unit_test(all_harmonics),
      cmocka_unit_test(cases_that_need_all), cmocka_unit_test(a_list_is_taken)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
