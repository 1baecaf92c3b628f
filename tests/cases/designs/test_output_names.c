/* Outputs of a design by name: units, probes, gauges, modes, and what is none. */
#include "cases/designs/output_names.h"

#include "mhb/tracking/peak_system.h"
#include "tests/support/check.h"

/* 12 modes, the probe tip, no stress limits. */
static case_file *make_case(void) {
  case_file *file = calloc(1, sizeof *file);
  assert_non_null(file);
  file->modes    = 12;
  file->n_probes = 1;
  strcpy(file->probe[0].name, "tip");
  file->damping = (modal_damping){.kind = MODAL_DAMPING_ALL, .ratio = 0.002};
  return file;
}

static void names_have_quantities_and_units(void **state) {
  (void)state;
  static const struct {
    const char    *name, *unit;
    study_quantity quantity;
    int            index;
  } known[]       = {{"peak", "m", STUDY_PEAK, 0},
                     {"frequency", "Hz", STUDY_FREQUENCY, 0},
                     {"peak_to_peak", "m", STUDY_PEAK_TO_PEAK, 0},
                     {"stable", "-", STUDY_STABLE, 0},
                     {"dissipation", "J", STUDY_DISSIPATION, 0},
                     {"stress", "Pa", STUDY_STRESS, 0},
                     {"tip", "m", STUDY_PROBE, 0},
                     {"modes[3].frequency", "Hz", STUDY_MODE_FREQUENCY, 2}};
  case_file *file = make_case();
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    study_output o;
    char         why[512];
    assert_true(study_output_parse(known[i].name, file, &o, why, sizeof why));
    assert_int_equal(o.quantity, known[i].quantity);
    assert_int_equal(o.index, known[i].index);
    assert_string_equal(o.name, known[i].name);
    assert_string_equal(o.unit, known[i].unit);
  }
  free(file);
}

static void what_is_no_output_is_told(void **state) {
  (void)state;
  static const char *const faults[][2] = {{"peek", "tip"},
                                          {"modes[13].frequency", "1 to 12"},
                                          {"modes[0].frequency", "1 to 12"},
                                          {"modes[1].damping", "modes[I].frequency"},
                                          {"safety", "material.fatigue"}};
  case_file               *file        = make_case();
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    study_output o;
    char         why[512] = "";
    assert_false(study_output_parse(faults[i][0], file, &o, why, sizeof why));
    assert_has(why, faults[i][1]);
    assert_null(strchr(why, '\n'));
  }
  free(file);
}

static void derivatives_are_those_of_the_peak(void **state) {
  (void)state;
  case_file         *file    = make_case();
  const study_output with[2] = {{.quantity = STUDY_FREQUENCY}, {.quantity = STUDY_PEAK}};
  char               name[STUDY_UNIT_TEXT], unit[STUDY_UNIT_TEXT];
  double             value;
  assert_int_equal(study_derivatives(2, with), MHB_PEAK_PARAMETERS);
  assert_int_equal(study_derivatives(1, with), 0);
  file->mhb.mu = 0.37;
  study_derivative(file, MHB_PEAK_BY_MU, name, unit, &value);
  assert_string_equal(name, "mu");
  assert_string_equal(unit, "m");
  assert_near(value, 0.37, 0);
  study_derivative(file, MHB_PEAK_BY_DAMPING, name, unit, &value);
  assert_string_equal(name, "damping");
  assert_near(value, 0.002, 0);
  file->damping.kind = MODAL_DAMPING_LOSS;
  file->damping.loss = 0.01;
  assert_near(study_damping(file), 0.01, 0);
  file->damping.kind = MODAL_DAMPING_RAYLEIGH; /* no number: a factor */
  study_derivative(file, MHB_PEAK_BY_DAMPING, name, unit, &value);
  assert_string_equal(name, "damping_factor");
  assert_near(value, 1, 0);
  assert_near(study_damping(NULL), 1, 0);
  free(file);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_have_quantities_and_units),
      cmocka_unit_test(what_is_no_output_is_told),
      cmocka_unit_test(derivatives_are_those_of_the_peak),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
