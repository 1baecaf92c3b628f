/* What a study minimises: its members, the first designs of its starts, the choice of a method. */
#include "cases/designs/study_optimise.h"

#include "tests/support/study_text.h"

enum { MOST = STUDY_MAX_OUTPUTS };

/* An optimisation over the keys of a text, of a case with damping and 12 modes. */
typedef struct {
  case_file      base;
  study_output   output[MOST];
  int            n_outputs;
  study_optimise o;
  study_keys     keys;
  int            n;
  double        *design;
} scene;

static scene *make(const char *optimise, const char *vary, const char *fault) {
  scene     *s = calloc(1, sizeof *s);
  study_text t = study_text_parse(optimise), v = study_text_parse(vary);
  assert_non_null(s);
  s->base.modes               = 12;
  s->base.damping.ratio       = 0.002;
  const study_outputs outputs = {&s->base, &s->n_outputs, s->output};
  study_keys_read(&v.issues, v.root, &s->keys);
  study_text_check(&v, NULL);
  study_optimise_read(&t.issues, t.root, &outputs, &s->o);
  if (t.issues.n == 0)
    study_optimise_starts(&t.issues, t.root, &outputs, &s->keys, &s->o, &s->n, &s->design);
  study_text_check(&t, fault);
  study_text_free(&t);
  study_text_free(&v);
  return s;
}

static void drop(scene *s) {
  study_keys_free(&s->keys);
  free(s->design);
  free(s);
}

static const char two[] = "contact.n0: {from: 10 N, to: 50 N}\ncontact.mu: {from: 0.1, to: 0.5}\n";
static const char one[] = "contact.n0: {from: 10 N, to: 50 N}\n";

static void members_are_read_in_si(void **state) {
  (void)state;
  scene *s = make(
      "minimise: peak\nat_most: {frequency: 0.2 kHz}\nat_least: {dissipation: 0.003 J}\n"
      "evaluations: 90\nstarts: 3\nseed: 7\nalgorithm: crs\n",
      two, NULL);
  assert_true(s->o.wanted && !s->o.free_algorithm);
  assert_int_equal(s->o.objective, 0);
  assert_int_equal(s->n_outputs, 3);
  assert_int_equal(s->o.n_limits, 2);
  assert_false(s->o.limit[0].least);
  assert_near(s->o.limit[0].value, 200, 1e-10);
  assert_true(s->o.limit[1].least);
  assert_near(s->o.limit[1].value, 0.003, 1e-17);
  assert_int_equal(s->o.limit[1].output, 2);
  assert_int_equal(s->o.evaluations, 90);
  assert_int_equal(s->o.starts, 3);
  assert_int_equal(s->o.seed, 7);
  assert_int_equal(s->o.algorithm, STUDY_CRS);
  assert_string_equal(study_algorithm_name(s->o.algorithm), "crs");
  drop(s);
}

/* Both corners, the middle, and the other starts inside the ranges. */
static void starts_lie_in_the_ranges(void **state) {
  (void)state;
  scene *s = make("{minimise: peak, starts: 6, algorithm: sbplx}", two, NULL);
  assert_int_equal(s->n, 8);
  for (int d = 0; d < 8; d++) {
    const double u = (s->design[2 * d] - 10) / 40, v = (s->design[2 * d + 1] - 0.1) / 0.4;
    if (d < 3) assert_near(u, d < 2 ? d : 0.5, 1e-14);
    if (d < 3) assert_near(v, d < 2 ? d : 0.5, 1e-14);
    assert_true(u >= 0 && u <= 1 && v >= 0 && v <= 1);
  }
  drop(s);
}

/* One key with a derivative and no limit: the root of the slope; else simplices. */
static void the_method_is_chosen_by_the_keys(void **state) {
  (void)state;
  scene *s = make("{minimise: peak}", one, NULL);
  assert_int_equal(s->o.algorithm, STUDY_SLOPE);
  assert_int_equal(study_key_derivative(&s->base, &s->keys.key[0]), 0);
  drop(s);
  s = make("{minimise: peak}", two, NULL);
  assert_int_equal(s->o.algorithm, STUDY_SBPLX);
  drop(s);
  s = make("{minimise: frequency}", one, NULL);
  assert_int_equal(s->o.algorithm, STUDY_SBPLX);
  drop(s);
  s = make("{minimise: peak}", "mesh.blade.size: {from: 5 mm, to: 9 mm}", NULL);
  assert_int_equal(s->o.algorithm, STUDY_SBPLX);
  assert_int_equal(study_key_derivative(&s->base, &s->keys.key[0]), -1);
  drop(s);
}

static void faults_are_told(void **state) {
  (void)state;
  static const char *const faults[][3] = {
      {"{evaluations: 50}", two, "minimise is missing"},
      {"{minimise: peek}", two, "peek"},
      {"{minimise: peak, evaluations: 10, starts: 4}", two, "too few for 4 starts"},
      {"{minimise: peak, algorithm: newton}", two,
       "optimise.algorithm: 'newton' is not known; expected one of sbplx"},
      {"{minimise: peak, at_most: {frequency: 3 m}}", two, "frequency"},
      {"{minimise: peak, tries: 3}", two, "unknown key"},
      {"{minimise: peak, algorithm: slope}", two, "slope varies one key"},
      {"{minimise: peak, algorithm: direct, starts: 2}", two, "direct divides the whole ranges"},
      {"{minimise: peak}", "contact.n0: [10 N, 20 N]", "needs a range"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
    drop(make(faults[i][0], faults[i][1], faults[i][2]));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(members_are_read_in_si),
      cmocka_unit_test(starts_lie_in_the_ranges),
      cmocka_unit_test(the_method_is_chosen_by_the_keys),
      cmocka_unit_test(faults_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
