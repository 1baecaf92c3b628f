/* The plan of a study: grids, samples, tables, and samples of uncertain keys. */
#include "cases/designs/study_plan.h"

#include "cases/designs/uncertain_keys.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/study_text.h"

/* A plan with its keys and designs. */
typedef struct {
  study_text plan_text, keys_text, uncertain_text;
  study_plan plan;
  study_keys keys;
  int        n;
  double    *design;
} scene;

/* vary, uncertain NULL: none. fault NULL: there must be none. */
static scene *make(const char *plan, const char *vary, const char *uncertain, int samples,
                   const char *fault) {
  scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->plan_text = study_text_parse(plan);
  study_plan_read(&s->plan_text.issues, case_node_find(s->plan_text.root, "plan"), scratch_folder,
                  &s->plan);
  s->plan.n_samples   = samples;
  s->plan.sample_seed = 1;
  if (vary) {
    s->keys_text = study_text_parse(vary);
    study_keys_read(&s->keys_text.issues, s->keys_text.root, &s->keys);
    study_text_check(&s->keys_text, NULL);
  }
  if (s->plan_text.issues.n == 0)
    study_plan_make(&s->plan_text.issues, s->plan_text.root, &s->plan, &s->keys, &s->n, &s->design);
  if (uncertain) {
    s->uncertain_text = study_text_parse(uncertain);
    uncertain_keys_read(&s->uncertain_text.issues, s->uncertain_text.root, &s->keys);
    study_text_check(&s->uncertain_text, NULL);
    study_plan_add_samples(&s->plan_text.issues, s->plan_text.root, &s->plan, &s->keys, &s->n,
                           &s->design);
  }
  study_text_check(&s->plan_text, fault);
  return s;
}

static void drop(scene *s) {
  study_text_free(&s->plan_text);
  study_text_free(&s->keys_text);
  study_text_free(&s->uncertain_text);
  study_keys_free(&s->keys);
  free(s->plan.table);
  free(s->design);
  free(s);
}

/* The last key runs fastest. */
static void a_grid_has_every_combination(void **state) {
  (void)state;
  scene *s =
      make("plan: grid", "contact.n0: [1 N, 2 N]\ncontact.mu: [0.1, 0.2, 0.3]\n", NULL, 0, NULL);
  char text[64];
  assert_int_equal(s->n, 6);
  for (int d = 0; d < 6; d++) {
    assert_near(s->design[2 * d], 1 + d / 3, 0);
    assert_near(s->design[2 * d + 1], 0.1 * (1 + d % 3), 1e-15);
  }
  assert_int_equal(study_plan_group(&s->plan, &s->keys), 1);
  study_plan_text(&s->plan, &s->keys, text, sizeof text);
  assert_string_equal(text, "grid");
  drop(s);
}

/* Each of the n layers of each key holds one design; the seed decides which. */
static void samples_fill_their_ranges(void **state) {
  (void)state;
  static const char vary[] = "contact.n0: {from: 10 N, to: 26 N}\ncontact.mu: {from: 0, to: 1}\n";
  static const char *const plans[] = {"plan: {sobol: 16, seed: 3}",
                                      "plan: {latin_hypercube: 16, seed: 3}"};
  for (int p = 0; p < 2; p++) {
    scene *s = make(plans[p], vary, NULL, 0, NULL), *again = make(plans[p], vary, NULL, 0, NULL);
    scene *other =
        make(p ? "plan: {latin_hypercube: 16}" : "plan: {sobol: 16}", vary, NULL, 0, NULL);
    assert_int_equal(s->n, 16);
    for (int k = 0; k < 2; k++) {
      int layer[16] = {0};
      for (int d = 0; d < 16; d++) {
        const double u = k ? s->design[2 * d + 1] : (s->design[2 * d] - 10) / 16;
        assert_true(u > 0 && u < 1);
        layer[(int)(16 * u)]++;
      }
      for (int i = 0; i < 16; i++) assert_int_equal(layer[i], 1);
    }
    assert_memory_equal(s->design, again->design, 32 * sizeof(double));
    assert_memory_not_equal(s->design, other->design, 32 * sizeof(double));
    drop(s);
    drop(again);
    drop(other);
  }
}

static void a_table_gives_keys_and_designs(void **state) {
  (void)state;
  FILE *file = fopen(scratch("table.csv"), "w");
  fputs("contact.n0,contact.mu\n10 N,0.3\n0.02 kN,0.1\n", file);
  fclose(file);
  scene *s = make("plan: {table: table.csv}", NULL, NULL, 0, NULL);
  assert_int_equal(s->n, 2);
  assert_int_equal(s->keys.n, 2);
  assert_string_equal(s->keys.key[1].path, "contact.mu");
  assert_near(s->design[2], 20, 1e-12);
  assert_near(s->design[3], 0.1, 0);
  drop(s);
  file = fopen(scratch("table.csv"), "w");
  fputs("contact.n0\n10 N\n10 m\n", file);
  fclose(file);
  drop(make("plan: {table: table.csv}", NULL, NULL, 0, "table.csv:3: contact.n0"));
  drop(make("plan: {table: none.csv}", NULL, NULL, 0, "none.csv"));
}

/* Every design of the varied keys has the same samples of the uncertain ones. */
static void samples_are_the_same_for_every_design(void **state) {
  (void)state;
  scene *s =
      make("plan: grid", "contact.n0: [1 N, 2 N]", "contact.mu: {uniform: [0.1, 0.5]}", 8, NULL);
  assert_int_equal(study_plan_group(&s->plan, &s->keys), 8);
  assert_false(study_plan_has_blocks(&s->plan, &s->keys));
  assert_int_equal(s->n, 16);
  int layer[8] = {0};
  for (int d = 0; d < 16; d++) {
    assert_near(s->design[2 * d], 1 + d / 8, 0);
    assert_near(s->design[2 * d + 1], s->design[2 * (d % 8) + 1], 0);
    layer[(int)((s->design[2 * d + 1] - 0.1) / 0.05)]++;
  }
  for (int i = 0; i < 8; i++) assert_int_equal(layer[i], 2);
  drop(s);
}

/* With uncertain keys alone: blocks of d + 2 designs, row i of a block but the first two mixes
 * both samples in one key. */
static void uncertain_keys_alone_come_in_blocks(void **state) {
  (void)state;
  scene *s = make("plan: grid", NULL,
                  "contact.mu: {uniform: [0, 1]}\nmhb.scale: {uniform: [0, 1]}\n", 8, NULL);
  char   text[64];
  assert_true(study_plan_has_blocks(&s->plan, &s->keys));
  assert_int_equal(study_plan_group(&s->plan, &s->keys), 16);
  assert_int_equal(s->n, 16);
  study_plan_text(&s->plan, &s->keys, text, sizeof text);
  assert_string_equal(text, "uncertain");
  drop(s);
}

static void faults_of_a_plan_are_told(void **state) {
  (void)state;
  static const char vary[] = "contact.n0: {from: 10 N, to: 26 N}";
  drop(make("plan: random", vary, NULL, 0, "expected grid"));
  drop(make("plan: {sobol: 0}", vary, NULL, 0, "plan.sobol: is 0, must be 1 to 100000"));
  drop(make("plan: {seed: 3}", vary, NULL, 0, "expected one of"));
  drop(make("plan: {sobol: 8, seed: -1}", vary, NULL, 0, "plan.seed: is -1, must be 0 to 1e+09"));
  drop(make("plan: grid", vary, NULL, 0, "number of points"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_grid_has_every_combination),
      cmocka_unit_test(samples_fill_their_ranges),
      cmocka_unit_test(a_table_gives_keys_and_designs),
      cmocka_unit_test(samples_are_the_same_for_every_design),
      cmocka_unit_test(uncertain_keys_alone_come_in_blocks),
      cmocka_unit_test(faults_of_a_plan_are_told),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
