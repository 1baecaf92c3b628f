#include <unistd.h>

#include "modal/model/model.h"
#include "postproc/inspect/inspect.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"
#include "tests/support/scratch_folder.h"

static const post_tree_style PLAIN = {false, false}, FULL = {false, true}, COLOUR = {true, false};

static const shb_provenance PROVENANCE = {"cases/x/case.yaml", fixture_hostile, "a = 1\nb = 2\n",
                                          "shroudhb-mhb"};

static char *inspect(const char *name, post_tree_style style, shb_status wanted) {
  post_buffer text = {0};
  assert_int_equal(post_inspect(scratch(name), style, &text), wanted);
  for (const char *c = text.text; c && *c && !style.colour; c++)
    assert_true((unsigned char)*c >= 0x20 || *c == '\n' ||
                *c == '\t'); /* no escape sequences from the file */
  return text.text;
}

static void response(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  assert_ok(mhb_response_write(r, scratch("x.response.h5"), &PROVENANCE));
  char                    *text    = inspect("x.response.h5", PLAIN, SHB_OK);
  static const char *const parts[] = {
      "shroudhb response, version 1",
      "7 nonlinear curves, n0 10 … 1000 N; 2 linear limits; 2040 points, ",
      "10 folds; 1 not complete",
      "3 harmonics; 1 pair; probes tip, shroud <edge>",
      "open peak 1.24",
      "lowest (n0 = 100\u00a0N)",
      "6 lines (--verbose shows them)",
      "2 lines (--verbose",
      "kind: nonlinear",
      "reason: no convergence",
      "[point 240, pair 1, contact_state 3]",
      "[mode 8]",
      "103.6 … 2548",
      "v, u, w",
      "share of the period stuck, slipping, open",
  };
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) assert_has(text, parts[i]);
  assert_has(text, "branch_8/");
  char *full = inspect("x.response.h5", FULL, SHB_OK);
  assert_true(strlen(full) > 3 * strlen(text));
  assert_has(full, "    a = 1\n    b = 2\n");
  assert_has(full, "# ??[31m"); /* the escape sequence of the case is removed */
  free(full);
  char *colour = inspect("x.response.h5", COLOUR, SHB_OK);
  assert_has(colour, "\033[1m");
  free(colour);
  free(text);
  mhb_response_destroy(r);
}

/* Curves that end below their resonance have no peak. */
static void largest_at_the_end(void **state) {
  (void)state;
  fixture_options o     = fixture_usual();
  mhb_response   *r     = fixture_response(&o);
  r->branch[0].n_points = 12;
  assert_int_equal(r->branch[0].kind, MHB_BRANCH_OPEN);
  assert_ok(mhb_response_write(r, scratch("e.response.h5"), &PROVENANCE));
  char *text = inspect("e.response.h5", PLAIN, SHB_OK);
  assert_has(text, "open, largest ");
  assert_has(text, ", the end of the range; stuck peak ");
  free(text);
  mhb_response_destroy(r);
}

static void run_up(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  r->run_up         = true;
  assert_ok(mhb_response_write(r, scratch("r.response.h5"), &PROVENANCE));
  char *text = inspect("r.response.h5", PLAIN, SHB_OK);
  assert_has(text, "run-up: speed 1102.76 to 1656 rpm along E = 5");
  assert_has(text, "speed of the rotor, frequency/engine_order");
  free(text);
  mhb_response_destroy(r);
}

static void parameter(void **state) {
  (void)state;
  static const char *const range[] = {"n0 −250 … 1000 N at 240 Hz", "scale 0.05 … 10 at 240 Hz"};
  for (int k = 0; k < 2; k++) {
    fixture_options o = fixture_usual();
    o.parameter       = k ? MHB_IN_SCALE : MHB_IN_N0;
    mhb_response *r   = fixture_response(&o);
    assert_ok(mhb_response_write(r, scratch("p.response.h5"), &PROVENANCE));
    char *text = inspect("p.response.h5", PLAIN, SHB_OK);
    assert_has(text, range[k]);
    assert_has(text,
               k ? "open peak 1.24\u00a0mm at level\u00a0" : "open peak 618\u00a0µm at every n₀");
    assert_int_equal(strstr(text, "lowest (n0 = ") != NULL, k);
    free(text);
    mhb_response_destroy(r);
  }
}

static void modal(void **state) {
  (void)state;
  double frequency[] = {103.6, 410.25}, damping[] = {0.002, 0.002}, shape[6] = {1, 2, 3, -4, 5, 6};
  double _Complex force[4] = {0, 0, 1.5, 2.5 * 1i};
  char        tip[] = "tip", *name[] = {tip};
  modal_model m = {.n_modes       = 2,
                   .n_pairs       = 1,
                   .n_probes      = 1,
                   .n_load        = 1,
                   .has_left      = true,
                   .frequency     = frequency,
                   .damping_ratio = damping,
                   .right         = shape,
                   .left          = shape,
                   .modal_force   = force,
                   .probe_name    = name,
                   .probe         = shape};
  hid_t       file;
  assert_ok(h5_create(scratch("x.modal.h5"), &file));
  assert_ok(modal_model_write(file, &m, &PROVENANCE));
  assert_ok(h5_close(file));
  char *text = inspect("x.modal.h5", PLAIN, SHB_OK);
  assert_has(text, "shroudhb modal model, version 1");
  assert_has(
      text,
      "2 modes 103.6 … 410.25 Hz; 1 pair, neighbour; load harmonics 0..1; probe tip; residual "
      "flexibility no, inertia no");
  assert_has(text, "−4 … 6");
  assert_has(text, "|0 … 2.5|"); /* a complex range is of magnitudes */
  assert_has(text, "complex");
  assert_has(text, "kg^-1/2");
  assert_has(text, "shroudhb-mhb");
  free(text);
  /* a file of an earlier version: the load's residual response without its inertia */
  double soft[36]           = {1e-9};
  double _Complex moved[12] = {1e-6};
  m.residual_flexibility = m.residual_inertia = soft;
  m.load_residual                             = moved;
  for (int i = 0; i < 2; i++) {
    m.load_inertia = i ? moved : NULL;
    assert_ok(h5_create(scratch("x.modal.h5"), &file));
    assert_ok(modal_model_write(file, &m, &PROVENANCE));
    assert_ok(h5_close(file));
    text = inspect("x.modal.h5", PLAIN, SHB_OK);
    assert_has(text, i ? "flexibility yes, inertia yes\n"
                       : "inertia of the contact alone: not of load and probes\n");
    free(text);
  }
}

static void write_phases(hid_t file, int n, int ranks) {
  static const char *const name[]    = {"mesh", "factor"};
  static const double      seconds[] = {0.125, 2.5}, cpu[] = {0.25, 4.75}, memory[] = {8e7, 3.21e9};
  static const double      most[] = {5e7, 1.7e9};
  const h5_shape           shape  = H5_SHAPE((hsize_t)n);
  assert_ok(h5_write_strings(file, "/phases/name", 2, name, "phase"));
  assert_ok(h5_write_double(file, "/phases/seconds", H5_SHAPE(2), seconds, "s", "s"));
  assert_ok(h5_write_double(file, "/phases/cpu", shape, cpu, "s", "s"));
  assert_ok(h5_write_double(file, "/phases/memory", H5_SHAPE(2), memory, "B", "B"));
  assert_ok(h5_write_double(file, "/phases/greatest_memory", H5_SHAPE(2), most, "B", "B"));
  assert_ok(h5_write_attribute_int(file, "/phases", "ranks", ranks));
}

/* Times of the modal stage: a line for each phase, and one for all. */
static void phases(void **state) {
  (void)state;
  double frequency[] = {103.6}, damping[] = {0.002}, shape[3] = {1, 2, 3};
  double _Complex force[1] = {1};
  modal_model m            = {.n_modes       = 1,
                              .n_pairs       = 1,
                              .frequency     = frequency,
                              .damping_ratio = damping,
                              .right         = shape,
                              .modal_force   = force};
  for (int i = 0; i < 3; i++) {
    hid_t file;
    assert_ok(h5_create(scratch("x.modal.h5"), &file));
    assert_ok(modal_model_write(file, &m, &PROVENANCE));
    assert_ok(h5_write_attribute_text(file, "/modes", "checked", i == 0 ? "restart" : "no"));
    assert_ok(h5_write_attribute_int(file, "/modes", "checked_count", 19));
    assert_ok(h5_write_attribute_double(file, "/modes", "checked_below", 11836.25));
    assert_ok(h5_write_attribute_double(file, "/modes", "missed_chance", 4e-10));
    write_phases(file, i == 2 ? 1 : 2, i == 0 ? 1 : 4);
    assert_ok(h5_close(file));
    char *text = inspect("x.modal.h5", PLAIN, i == 2 ? SHB_ERR_INPUT : SHB_OK);
    if (i == 0) {
      assert_has(text, "  factor               2.50     4.75     3210\n");
      assert_has(text, "  all                  2.62     5.00     3210\n");
      assert_has_not(text, "ranks)");
      assert_has(text,
                 "no mode is missing: 19 below 11836.2 Hz, counted by restart, wrong with a chance "
                 "of 4.0×10⁻¹⁰ at most\n");
    } else if (i == 1) {
      assert_has(text, "  mesh                 0.12     0.25       80       50\n");
      assert_has(text, "(4 ranks)");
      assert_has(text, "not checked whether a mode is missing\n");
    } else
      assert_has(shb_message(), "/phases/cpu");
    free(text);
  }
}

/* A file that claims our format and is not: the tree is shown, and the fault. */
static void pretender(void **state) {
  (void)state;
  hid_t file;
  assert_ok(h5_create(scratch("p.h5"), &file));
  assert_ok(h5_write_provenance(file, "shroudhb modal model", 1, &PROVENANCE));
  assert_ok(
      h5_write_double(file, "/modes/frequency", H5_SHAPE(2), (const double[]){3, 1}, "Hz", "f"));
  assert_ok(h5_close(file));
  char *text = inspect("p.h5", PLAIN, SHB_ERR_INPUT);
  assert_has(text, "not usable: ");
  assert_has(text, "1 … 3");
  assert_has(shb_message(), "p.h5");
  free(text);
}

static void write_raw(hid_t file, const char *name, hid_t type, int rank, const hsize_t *dim,
                      const void *data) {
  hid_t space = H5Screate_simple(rank, dim, NULL);
  hid_t set   = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(set >= 0);
  if (data) assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Dclose(set);
  H5Sclose(space);
}

static void foreign(void **state) {
  (void)state;
  hid_t        file      = H5Fcreate(scratch("f.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const double odd[]     = {2.385, NAN, -7, INFINITY};
  const int    whole[]   = {-3, 12};
  hid_t        text_type = H5Tcopy(H5T_C_S1);
  H5Tset_size(text_type, 6);
  write_raw(file, "odd", H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){4}, odd);
  write_raw(file, "whole", H5T_NATIVE_INT, 2, (const hsize_t[]){2, 1}, whole);
  write_raw(file, "none", H5T_NATIVE_FLOAT, 1, (const hsize_t[]){0}, NULL);
  write_raw(file, "words", text_type, 1, (const hsize_t[]){2}, "ab\x1b[2mcdefgh");
  write_raw(file, "scalar", H5T_NATIVE_UCHAR, 0, NULL, "\x07");
  H5Tclose(text_type);
  hid_t group = H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Lcreate_hard(file, "odd", group, "same", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  assert_true(H5Lcreate_hard(file, "/", group, "loop", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  assert_true(H5Lcreate_soft("/odd", group, "soft", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  assert_true(H5Lcreate_soft("/nowhere", group, "broken", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  for (int i = 0; i < 12; i++) {
    char name[16];
    snprintf(name, sizeof name, "s_%d", i);
    write_raw(group, name, H5T_NATIVE_INT, 1, (const hsize_t[]){1}, &i);
  }
  H5Gclose(group);
  H5Fclose(file);
  char                    *text    = inspect("f.h5", PLAIN, SHB_OK);
  static const char *const parts[] = {"foreign HDF5 file",
                                      "−7 … 2.385, 2 NaN",
                                      "−3 … 12",
                                      "[2, 1]",
                                      "int32",
                                      "empty",
                                      "float32",
                                      "ab [2m, cdefgh",
                                      "uint8",
                                      "→ /odd\n",
                                      "→ /nowhere (missing)",
                                      "⋮ 10 more",
                                      "s_11"};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) assert_has(text, parts[i]);
  assert_true(strlen(text) < 4000); /* the loop of links is not followed */
  free(text);
}

/* Several pieces: the extremes are in the first and the last. */
static void large(void **state) {
  (void)state;
  enum { ROWS = 700, COLUMNS = 901 };
  double *x    = calloc(ROWS * COLUMNS, sizeof *x);
  hid_t   file = H5Fcreate(scratch("l.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  x[3] = -2.385, x[ROWS * COLUMNS - 1] = 9.5;
  write_raw(file, "wide", H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){ROWS, COLUMNS}, x);
  write_raw(file, "flat", H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){1, ROWS * COLUMNS}, x);
  H5Fclose(file);
  free(x);
  char *text = inspect("l.h5", PLAIN, SHB_OK), *first = strstr(text, "−2.385 … 9.5");
  assert_non_null(first);
  assert_non_null(strstr(first + 1, "−2.385 … 9.5"));
  free(text);
}

static void write_text(const char *name, const char *from, size_t n) {
  char *data = calloc(n + 1, 1);
  FILE *in   = from ? fopen(from, "rb") : NULL;
  if (in) {
    assert_int_equal(fread(data, 1, n, in), n);
    fclose(in);
  }
  FILE *out = fopen(scratch(name), "wb");
  assert_int_equal(fwrite(data, 1, n, out), n);
  fclose(out);
  free(data);
}

static void errors(void **state) {
  (void)state;
  hid_t file = H5Fcreate(scratch("out.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Lcreate_external("other.h5", "/x", file, "outside", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  H5Fclose(file);
  assert_null(inspect("out.h5", PLAIN, SHB_ERR_INPUT));
  assert_has(shb_message(), "/outside is an external link");
  assert_null(inspect("missing.h5", PLAIN, SHB_ERR_IO));
  assert_has(shb_message(), "missing.h5");
  write_text("zero.h5", NULL, 4000);
  assert_null(inspect("zero.h5", PLAIN, SHB_ERR_IO));
  write_text("cut.h5", scratch("x.response.h5"), 30000);
  assert_null(inspect("cut.h5", PLAIN, SHB_ERR_IO));
  assert_has(shb_message(), "truncated");
  assert_null(strchr(shb_message(), '\n'));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(response),  cmocka_unit_test(run_up),
      cmocka_unit_test(parameter), cmocka_unit_test(largest_at_the_end),
      cmocka_unit_test(modal),     cmocka_unit_test(phases),
      cmocka_unit_test(pretender), cmocka_unit_test(foreign),
      cmocka_unit_test(large),     cmocka_unit_test(errors)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
