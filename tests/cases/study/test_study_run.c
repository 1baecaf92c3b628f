/* A study from its designs to its files, with designs in closed form: what is computed, what is
 * taken from files, what is published. */
#include "cases/study/study_run.h"

#include <mpi.h>
#include <unistd.h>

#include "cases/study/design_message.h"
#include "tests/support/study_file.h"

enum { DESIGNS = 4 };

static const char grid[] =
    "vary:\n  contact.n0: [10 N, 20 N]\n  contact.mu: [0.2, 0.4]\n"
    "plan: grid\noutputs: [frequency, dissipation]\n";

typedef struct {
  int    calls;
  double fails; /* designs above this n0 fail */
} closed_form;

/* frequency = n0 + mu, dissipation = n0 mu */
static shb_status compute(void *context, const double *value, char **bytes, size_t *size) {
  closed_form  *c = context;
  design_study  one;
  study_design *d;
  c->calls++;
  SHB_TRY(design_study_create(2, 2, 0, &one));
  d = design_study_add(&one, value);
  assert_non_null(d);
  d->state = value[0] > c->fails ? STUDY_FAILED : STUDY_DONE;
  if (d->state == STUDY_FAILED) study_design_set_reason(d, "too stiff");
  d->value[0] = d->state == STUDY_DONE ? value[0] + value[1] : NAN;
  d->value[1] = d->state == STUDY_DONE ? value[0] * value[1] : NAN;
  d->error[0] = d->error[1] = 0;
  shb_status status         = design_message_pack(d, 2, 0, bytes, size);
  design_study_free(&one);
  return status;
}

static shb_status manage(void *context, const crew_work *work) {
  return crew_manage(work, context);
}

/* Run; returns how many designs were computed. */
static int run(const study_spec *spec, bool force, double fails, shb_status wanted,
               design_study *s) {
  closed_form      c        = {.fails = fails};
  crew_computer    computer = {&c, 4, compute};
  const crew_staff alone    = {&computer, 1, manage};
  shb_progress     progress = shb_progress_start("study", true, false);
  assert_int_equal(study_run(spec, force, &alone, &progress, s), wanted);
  return c.calls;
}

static void remove_results(void) {
  static const char *const names[] = {"study.study.h5", "study.study.csv", "study.study.html",
                                      "study.study.svg"};
  for (int i = 0; i < 4; i++) {
    char path[SCRATCH_PATH + 32];
    snprintf(path, sizeof path, "%s/%s", study_folder, names[i]);
    unlink(path);
  }
}

static void designs_are_computed_and_published(void **state) {
  (void)state;
  study_spec   spec;
  design_study s;
  remove_results();
  study_file_read(grid, NULL, &spec);
  assert_int_equal(run(&spec, false, INFINITY, SHB_OK, &s), DESIGNS);
  assert_int_equal(design_study_count(&s, STUDY_DONE), DESIGNS);
  assert_true(s.finished);
  for (int i = 0; i < DESIGNS; i++) {
    assert_near(s.design[i].value[0], s.design[i].key[0] + s.design[i].key[1], 0);
    assert_near(s.design[i].value[1], s.design[i].key[0] * s.design[i].key[1], 0);
  }
  char *h5 = study_path(&spec, ".study.h5"), *csv = study_path(&spec, ".study.csv");
  assert_int_equal(access(h5, R_OK), 0);
  assert_int_equal(access(csv, R_OK), 0);
  assert_has(h5, "/study.study.h5");
  free(h5);
  free(csv);
  design_study_free(&s);
  study_spec_free(&spec);
}

/* The same study again computes nothing; force computes all; a new value only its designs. */
static void former_results_are_taken(void **state) {
  (void)state;
  static const char more[] =
      "vary:\n  contact.n0: [10 N, 20 N, 30 N]\n  contact.mu: [0.2, 0.4]\n"
      "plan: grid\noutputs: [frequency, dissipation]\n";
  study_spec   spec;
  design_study s;
  remove_results();
  study_file_read(grid, NULL, &spec);
  assert_int_equal(run(&spec, false, INFINITY, SHB_OK, &s), DESIGNS);
  design_study_free(&s);
  assert_int_equal(run(&spec, false, INFINITY, SHB_OK, &s), 0);
  assert_near(s.design[3].value[0], 20.4, 1e-14);
  design_study_free(&s);
  assert_int_equal(run(&spec, true, INFINITY, SHB_OK, &s), DESIGNS);
  design_study_free(&s);
  study_spec_free(&spec);
  study_file_read(more, NULL, &spec);
  assert_int_equal(run(&spec, false, INFINITY, SHB_OK, &s), 2);
  assert_near(s.design[5].value[0], 30.4, 1e-14);
  design_study_free(&s);
  study_spec_free(&spec);
}

/* Failed designs are told, published, and computed again. */
static void failed_designs_are_told(void **state) {
  (void)state;
  study_spec   spec;
  design_study s;
  char        *text = NULL;
  size_t       size = 0;
  remove_results();
  study_file_read(grid, NULL, &spec);
  assert_true(run(&spec, false, 15, SHB_NOT_CONVERGED, &s) >= DESIGNS);
  assert_has(shb_message(), "2 designs failed");
  assert_int_equal(design_study_count(&s, STUDY_FAILED), 2);
  assert_string_equal(s.design[2].reason, "too stiff");
  FILE *out = open_memstream(&text, &size);
  study_run_summary(&spec, &s, out);
  fclose(out);
  assert_has(text, "study: 4 designs, 2 failed, 0 not converged");
  assert_has(text, "10.2 to 10.4 Hz, designs 1 and 2");
  assert_has(text, "study.study.csv");
  free(text);
  design_study_free(&s);
  assert_int_equal(run(&spec, false, INFINITY, SHB_OK, &s), 2);
  assert_int_equal(design_study_count(&s, STUDY_DONE), DESIGNS);
  design_study_free(&s);
  study_spec_free(&spec);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(designs_are_computed_and_published),
      cmocka_unit_test(former_results_are_taken),
      cmocka_unit_test(failed_designs_are_told),
  };
  MPI_Init(&argc, &argv);
  const int failed = cmocka_run_group_tests(tests, study_folder_make, study_folder_remove);
  MPI_Finalize();
  return failed;
}
