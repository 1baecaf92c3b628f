/* An optimisation as a study: closed objectives, limits, former results, failed designs. */
#include "cases/study/optimisation.h"

#include "tests/support/study_file.h"

static const char two[] =
    "vary:\n  contact.n0: {from: 10 N, to: 50 N}\n"
    "  contact.mu: {from: 0.1, to: 0.5}\noutputs: [frequency]\n"
    "optimise: {minimise: peak, evaluations: 120, starts: 2, "
    "algorithm: sbplx%s}\n";

/* Least at n0 = 37 N, mu = 0.22. */
static double peak_of(const double *key) {
  return 1 + pow((key[0] - 37) / 40, 2) + 2 * pow((key[1] - 0.22) / 0.4, 2);
}

static int output_of(const study_spec *spec, const char *name) {
  for (int i = 0; i < spec->n_outputs; i++)
    if (strcmp(spec->output[i].name, name) == 0) return i;
  fail();
  return -1;
}

/* Answer all designs by closed forms: the peak, and n0 as the frequency. Designs below `fails` N
 * fail. Returns how many were computed. */
static int answer_all(const study_spec *spec, double fails, optimisation *o, design_study *s) {
  const double *value;
  int           n = 0;
  for (int d; (d = optimisation_next(o, &value)) >= 0; n++) {
    study_design *design = &s->design[d];
    assert_memory_equal(value, design->key, 2 * sizeof *value);
    design->state = value[0] < fails ? STUDY_FAILED : STUDY_DONE;
    if (design->state == STUDY_DONE) {
      design->value[output_of(spec, "peak")]      = peak_of(value);
      design->value[output_of(spec, "frequency")] = value[0];
    }
    optimisation_done(o, d);
  }
  return n;
}

static design_study make_study(const study_spec *spec) {
  design_study s;
  assert_ok(design_study_create(spec->keys.n, spec->n_outputs, 0, &s));
  return s;
}

static void read_study(const char *limits, study_spec *spec) {
  char text[512];
  snprintf(text, sizeof text, two, limits);
  study_file_read(text, NULL, spec);
}

static const double *best_of(const design_study *s) {
  assert_true(s->optimum.best >= 0);
  return s->design[s->optimum.best].key;
}

static void the_least_peak_is_found(void **state) {
  (void)state;
  study_spec spec;
  read_study("", &spec);
  design_study  s = make_study(&spec);
  optimisation *o;
  assert_ok(optimisation_create(&spec, &s, &o));
  const int n = answer_all(&spec, 0, o, &s);
  assert_ok(optimisation_finish(o));
  const double *best = best_of(&s);
  print_message("%d designs: n0 %.4f, mu %.5f\n", n, best[0], best[1]);
  assert_true(n <= 120 && s.n >= n);
  assert_near(best[0], 37, 0.4);
  assert_near(best[1], 0.22, 0.004);
  assert_string_equal(s.optimum.objective, "peak");
  assert_has(s.optimum.method, "SBPLX");
  for (int k = 0; k < 2; k++) assert_int_equal(s.optimum.on_bound[k], 0);
  for (int i = 0; i < s.n; i++) /* nothing was better */
    assert_true(s.design[i].value[output_of(&spec, "peak")] >= peak_of(best));
  optimisation_destroy(o);
  design_study_free(&s);
  study_spec_free(&spec);
}

/* The frequency, here n0, may be at most 25 Hz: the best lies there, and meets the limit. */
static void a_limit_is_met(void **state) {
  (void)state;
  study_spec spec;
  read_study(", at_most: {frequency: 25 Hz}", &spec);
  design_study  s = make_study(&spec);
  optimisation *o;
  assert_ok(optimisation_create(&spec, &s, &o));
  answer_all(&spec, 0, o, &s);
  assert_ok(optimisation_finish(o));
  const double *best = best_of(&s);
  print_message("n0 %.4f, mu %.5f\n", best[0], best[1]);
  assert_true(best[0] <= 25);
  assert_near(best[0], 25, 0.5);
  optimisation_destroy(o);
  design_study_free(&s);
  study_spec_free(&spec);
}

/* A second run that knows the first one computes nothing, and comes to the same best. */
static void known_designs_are_not_computed_again(void **state) {
  (void)state;
  study_spec spec;
  read_study("", &spec);
  design_study  s[2] = {make_study(&spec), make_study(&spec)};
  optimisation *o[2];
  assert_ok(optimisation_create(&spec, &s[0], &o[0]));
  assert_true(answer_all(&spec, 15, o[0], &s[0]) > 20);
  assert_ok(optimisation_finish(o[0]));
  double best[2];
  memcpy(best, best_of(&s[0]), sizeof best);
  int failed = design_study_count(&s[0], STUDY_FAILED);
  optimisation_destroy(o[0]);
  assert_ok(optimisation_create(&spec, &s[1], &o[1]));
  assert_ok(optimisation_know(o[1], &s[0]));
  assert_int_equal(answer_all(&spec, 15, o[1], &s[1]), failed); /* those are tried again */
  assert_ok(optimisation_finish(o[1]));
  assert_memory_equal(best_of(&s[1]), best, sizeof best);
  optimisation_destroy(o[1]);
  design_study_free(&s[1]);
  study_spec_free(&spec);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_least_peak_is_found),
      cmocka_unit_test(a_limit_is_met),
      cmocka_unit_test(known_designs_are_not_computed_again),
  };
  return cmocka_run_group_tests(tests, study_folder_make, study_folder_remove);
}
