/* Frequencies of the ring with stuck contacts: families over the nodal diameter, and the file. */
#include "mhb/amplification/ring_frequencies.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/linear_resonances.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/scratch_folder.h"

static void families_are_those_of_the_ring(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(3);
  mhb_diagrams d = {0};
  double       f[6];
  random_model(1, WITH_LEFT, 3, &model);
  assert_ok(mhb_families_over_diameters(&model, &s, &d));
  assert_int_equal(d.n_families, model.n_modes < 6 ? model.n_modes : d.n_families);
  assert_int_equal(d.n_diameters, s.blades / 2 + 1);
  assert_int_equal(d.n_driven, 2); /* harmonics 1 and 2 of the load */
  const int n = d.n_families < 6 ? d.n_families : 6;
  for (int i = 0; i < d.n_diameters; i++) {
    assert_int_equal(d.diameter[i], i);
    assert_ok(mhb_stuck_frequencies(&model, &s, i, n, f));
    for (int k = 0; k < n; k++) {
      assert_near(d.stuck[i * d.n_families + k], f[k], 1e-12);
      assert_near(d.open[i * d.n_families + k], model.frequency[k], 0);
      assert_true(f[k] > model.frequency[k] * (1 - 1e-12)); /* springs only stiffen */
    }
  }
  mhb_diagrams_free(&d);
  s.to_ground = true;
  assert_ok(mhb_families_over_diameters(&model, &s, &d));
  assert_int_equal(d.n_families, 0);
  modal_model_free(&model);
}

static shb_status put(hid_t file, const void *context) {
  return mhb_diagrams_write(file, context);
}

/* What is read is what was written; a file without any tells that it has none. */
static void the_file_holds_them(void **state) {
  (void)state;
  int                diameter[] = {0, 3}, wave[] = {3};
  double             open[] = {100, 250, 101, 251}, stuck[] = {110, 260, 112, 263};
  double             speed[] = {0, 200, 500}, over[] = {112, 263, 113, 264, 119, 270.5};
  const mhb_diagrams all  = {.known       = true,
                             .n_families  = 2,
                             .n_diameters = 2,
                             .diameter    = diameter,
                             .open        = open,
                             .stuck       = stuck,
                             .n_driven    = 2,
                             .driven      = {1, 3},
                             .disc        = true,
                             .n_waves     = 1,
                             .n_speeds    = 3,
                             .n_stuck     = 2,
                             .wave        = wave,
                             .speed       = speed,
                             .over        = over};
  const mhb_diagrams none = {.known = true};
  const char        *path = scratch("diagrams.h5");
  mhb_diagrams       d;
  assert_ok(h5_publish(path, put, &all));
  assert_ok(mhb_diagrams_read(path, &d));
  assert_true(d.known && d.disc && d.n_families == 2 && d.n_diameters == 2 && d.n_driven == 2);
  assert_true(d.driven[1] == 3 && d.n_waves == 1 && d.n_speeds == 3 && d.n_stuck == 2);
  assert_memory_equal(d.diameter, diameter, sizeof diameter);
  assert_memory_equal(d.open, open, sizeof open);
  assert_memory_equal(d.stuck, stuck, sizeof stuck);
  assert_memory_equal(d.wave, wave, sizeof wave);
  assert_memory_equal(d.speed, speed, sizeof speed);
  assert_memory_equal(d.over, over, sizeof over);
  mhb_diagrams_free(&d);
  assert_ok(h5_publish(path, put, &none));
  assert_ok(mhb_diagrams_read(path, &d));
  assert_true(d.known && d.n_families == 0 && d.n_waves == 0);
  mhb_diagrams_free(&d);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(families_are_those_of_the_ring),
                                     cmocka_unit_test(the_file_holds_them)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
