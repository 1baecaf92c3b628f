/* The table of frequencies over the nodal diameter: blocks of columns, the check of the modes. */
#include "postproc/inspect/diameter_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"
#include "tests/support/check.h"

enum { MODES = 30, DIAMETERS = 10, BLADES = 24 };

static double                frequency[DIAMETERS][MODES];
static modal_model           model[DIAMETERS];
static int                   diameter[DIAMETERS];
static modal_nodal_diameters all;
static char                  path[64];

/* Diameters 0, 1, ..., of which the first n; mode m of diameter d at 100 (m + 1) + d + 0.5 Hz. */
static void make(int n, int modes) {
  for (int d = 0; d < DIAMETERS; d++) {
    diameter[d] = d;
    for (int m = 0; m < MODES; m++) frequency[d][m] = 100 * (m + 1) + d + 0.5;
    model[d] = (modal_model){.n_modes = modes, .frequency = frequency[d]};
  }
  all = (modal_nodal_diameters){.blades = BLADES, .n = n, .diameter = diameter, .model = model};
}

/* A file with the check of each nodal diameter; that of diameters unchecked is "no". */
static void write(unsigned unchecked) {
  hid_t file;
  strcpy(path, "/tmp/shroudhb-diameters-XXXXXX");
  assert_true(mkstemp(path) >= 0);
  assert_ok(h5_create(path, &file));
  for (int d = 0; d < all.n; d++) {
    char name[64];
    snprintf(name, sizeof name, "nodal_diameter_%d/modes/frequency", d);
    assert_ok(h5_write_double(file, name, H5_SHAPE((hsize_t)model[d].n_modes), frequency[d], "Hz",
                              "frequency"));
    snprintf(name, sizeof name, "/nodal_diameter_%d/modes", d);
    assert_ok(
        h5_write_attribute_text(file, name, "checked", unchecked >> d & 1 ? "no" : "restart"));
  }
  assert_ok(h5_close(file));
}

static char *table(bool whole) {
  post_buffer out = {0};
  hid_t       file;
  assert_ok(h5_open(path, &file));
  assert_ok(post_diameter_table(file, &all, whole, &out));
  assert_ok(h5_close(file));
  remove(path);
  return out.text;
}

static void says(const char *text, const char *part) {
  if (!strstr(text, part)) fail_msg("'%s' is not in\n%s", part, text);
}

static void a_column_for_each_diameter(void **state) {
  (void)state;
  make(3, 2);
  write(0);
  char *text = table(false);
  says(text, "24 blades, 0 to 12 are possible\n");
  says(text, "   mode           0           1           2\n");
  says(text, "      2       200.5       201.5       202.5\n");
  says(text, "  no mode is missing at any of these nodal diameters\n");
  free(text);
}

static void eight_columns_make_a_block(void **state) {
  (void)state;
  make(DIAMETERS, MODES);
  write(0);
  char *text = table(false);
  says(text, "   mode           8           9\n");
  says(text, "     24      2408.5      2409.5\n");
  assert_null(strstr(text, "2508.5"));
  says(text, "6 more (--verbose shows them)");
  free(text);
  write(0);
  text = table(true);
  says(text, "     30      3008.5      3009.5\n");
  assert_null(strstr(text, "more"));
  free(text);
}

static void unchecked_diameters_are_told(void **state) {
  (void)state;
  make(4, 2);
  write(2 + 8);
  char *text = table(false);
  says(text, "  not checked whether a mode is missing at nodal diameter 1, 3\n");
  assert_null(strstr(text, "no mode is missing"));
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_column_for_each_diameter),
                                     cmocka_unit_test(eight_columns_make_a_block),
                                     cmocka_unit_test(unchecked_diameters_are_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
