/* The table of modes: rows, effective masses as shares, the check for missing modes. */
#include "postproc/inspect/mode_table.h"

#include "modal/hdf5/h5.h"
#include "tests/support/check.h"

enum { MODES = 30 };

static double frequency[MODES], damping[MODES];
static char   path[64];

static modal_model make(int n_modes) {
  for (int i = 0; i < MODES; i++) {
    frequency[i] = 100 * (i + 1);
    damping[i]   = 0.002;
  }
  return (modal_model){.n_modes = n_modes, .frequency = frequency, .damping_ratio = damping};
}

/* A file with effective masses of 1/4, 1/8, ... of 2 kg, or without; the check by inertia, or
 * none. */
static void write(int n_modes, bool masses, bool check) {
  double mass[3 * MODES], inertia[MODES];
  hid_t  file;
  strcpy(path, "/tmp/shroudhb-modes-XXXXXX");
  assert_true(mkstemp(path) >= 0);
  for (int i = 0; i < n_modes; i++) {
    for (int d = 0; d < 3; d++) mass[3 * i + d] = 2 * ldexp(1, -i - 2 - d);
    inertia[i] = 0.5 * ldexp(1, -i - 1);
  }
  const hsize_t m = (hsize_t)n_modes;
  assert_ok(h5_create(path, &file));
  assert_ok(h5_write_double(file, "modes/frequency", H5_SHAPE(m), frequency, "Hz", "frequency"));
  if (masses) {
    assert_ok(h5_write_double(file, "modes/effective_mass", H5_SHAPE(m, 3), mass, "kg", "mass"));
    assert_ok(h5_write_double(file, "modes/effective_inertia", H5_SHAPE(m), inertia, "kg m^2",
                              "inertia"));
    assert_ok(h5_write_attribute_double(file, "/", "mass", 2));
    assert_ok(h5_write_attribute_double(file, "/", "inertia", 0.5));
  }
  if (check) {
    assert_ok(h5_write_attribute_text(file, "/modes", "checked", "inertia"));
    assert_ok(h5_write_attribute_int(file, "/modes", "checked_count", 2));
    assert_ok(h5_write_attribute_double(file, "/modes", "checked_below", 299.5));
    assert_ok(h5_write_attribute_double(file, "/modes", "missed_chance", 0));
  }
  assert_ok(h5_close(file));
}

static char *table(int n_modes, bool all) {
  const modal_model model = make(n_modes);
  post_buffer       out   = {0};
  hid_t             file;
  assert_ok(h5_open(path, &file));
  assert_ok(post_mode_table(file, &model, all, &out));
  assert_ok(h5_close(file));
  return out.text;
}

static void shares_are_of_the_mass(void **state) {
  (void)state;
  make(3);
  write(3, true, true);
  char *text = table(3, false);
  assert_has(text, "      1          100     0.002   25.00   12.50    6.25   50.00\n");
  assert_has(text, "      3          300     0.002    6.25    3.12    1.56   12.50\n");
  assert_has(text, "all 3 modes of the file          43.75   21.88   10.94   87.50\n");
  assert_has(text, "of the blade's mass, 2 kg");
  assert_has(text, "no mode is missing: 2 below 299.5 Hz, counted by inertia\n");
  free(text);
  remove(path);
}

static void other_files_have_fewer_columns(void **state) {
  (void)state;
  make(MODES);
  write(MODES, false, false);
  char *text = table(MODES, false);
  assert_has_not(text, "effective mass");
  assert_has_not(text, "missing");
  assert_has(text, "  … 6 more (--verbose shows them)\n");
  assert_has_not(text, "2500");
  free(text);
  text = table(MODES, true);
  assert_has(text, "     30         3000     0.002\n");
  free(text);
  remove(path);
}

/* Effective masses of another number of modes are refused. */
static void wrong_shapes_are_refused(void **state) {
  (void)state;
  const modal_model model = make(4);
  post_buffer       out   = {0};
  hid_t             file;
  write(3, true, false);
  assert_ok(h5_open(path, &file));
  assert_int_equal(post_mode_table(file, &model, false, &out), SHB_ERR_INPUT);
  assert_has(shb_message(), "/modes/effective_mass has shape [3, 3] where [4, 3] is wanted");
  assert_ok(h5_close(file));
  post_buffer_free(&out);
  remove(path);
}

/* Numbers with a power of ten: blanks between columns, and the same width in characters. */
static void columns_stay_apart_above_a_megahertz(void **state) {
  (void)state;
  write(3, false, false);
  modal_model model = make(3);
  post_buffer out   = {0};
  hid_t       file;
  frequency[1] = 1.65542e6;
  damping[1]   = 1.2e-7;
  assert_ok(h5_open(path, &file));
  assert_ok(post_mode_table(file, &model, true, &out));
  assert_ok(h5_close(file));
  assert_has(out.text, "\n      1          100     0.002\n");
  assert_has(out.text, "\n      2  1.65542×10⁶  1.2×10⁻⁷\n");
  post_buffer_free(&out);
  remove(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(columns_stay_apart_above_a_megahertz),
                                     cmocka_unit_test(shares_are_of_the_mass),
                                     cmocka_unit_test(other_files_have_fewer_columns),
                                     cmocka_unit_test(wrong_shapes_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
