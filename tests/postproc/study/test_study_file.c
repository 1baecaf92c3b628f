/* A design study: written, read back, as a table; damaged files are refused. */
#include "postproc/study/study_file.h"

#include <string.h>
#include <unistd.h>

#include "modal/hdf5/h5.h"
#include "postproc/study/study_csv.h"
#include "tests/support/check.h"

static const char path[] = "test_study_file.h5";

static void name(study_column *column, const char *text, const char *unit) {
  snprintf(column->name, sizeof column->name, "%s", text);
  snprintf(column->unit, sizeof column->unit, "%s", unit);
}

/* Three designs: one with a curve, one that failed, one not run. */
static void fill(design_study *s) {
  assert_int_equal(design_study_create(2, 2, 1, s), SHB_OK);
  s->name      = strdup("sample");
  s->text      = strdup("name: sample\n");
  s->case_text = strdup("name: blade\n");
  snprintf(s->plan, sizeof s->plan, "grid");
  name(&s->key[0], "contact.n0", "N");
  name(&s->key[1], "contact.mu", "-");
  name(&s->output[0], "peak", "m");
  name(&s->output[1], "frequency", "Hz");
  name(&s->derivative[0], "n0", "m/N");
  for (int i = 0; i < 3; i++)
    assert_non_null(design_study_add(s, (const double[]){10. * (i + 1), 0.3}));
  study_design *d  = &s->design[0];
  d->state         = STUDY_DONE;
  d->value[0]      = 3.5e-5;
  d->value[1]      = 212.5;
  d->error[0]      = 1e-9;
  d->derivative[0] = -2e-7;
  d->seconds       = 0.12;
  memcpy(d->digest, "0123456789abcdef", STUDY_DIGEST);
  assert_int_equal(study_curve_take(&d->curve, 2), SHB_OK);
  d->curve.frequency[1]   = 212.5;
  d->curve.amplitude[1]   = 3.5e-5;
  d->curve.stable[1]      = -1;
  s->design[1].state      = STUDY_FAILED;
  s->design[2].tried_from = 1;
  study_design_set_reason(&s->design[1], "mesh: \"sections\", folded");
}

static void round_trip(void **state) {
  (void)state;
  design_study s, t;
  fill(&s);
  assert_int_equal(design_study_take_optimum(&s, 2), SHB_OK);
  snprintf(s.optimum.method, sizeof s.optimum.method, "SBPLX");
  s.optimum.best       = 1;
  s.optimum.history[1] = 2;
  assert_int_equal(design_study_take_uncertainty(&s, 1, true), SHB_OK);
  s.uncertainty.percentile[1] = 7;
  s.uncertainty.total[3]      = 0.25;
  assert_int_equal(design_study_take_robust(&s, 3, 1, 2), SHB_OK);
  s.robust.key[2]        = 30;
  s.robust.n_failed[1]   = 4;
  s.robust.percentile[7] = 9;
  s.robust.confidence    = 0.9;
  s.robust.percentile[2] = NAN;
  assert_int_equal(study_file_write(&s, path), SHB_OK);
  assert_int_equal(study_file_read(path, &t), SHB_OK);
  assert_int_equal(t.n, 3);
  assert_string_equal(t.name, "sample");
  assert_string_equal(t.text, s.text);
  assert_string_equal(t.key[1].name, "contact.mu");
  assert_string_equal(t.derivative[0].unit, "m/N");
  assert_near(t.design[2].key[0], 30, 0);
  assert_int_equal(t.design[0].tried_from, -1);
  assert_int_equal(t.design[2].tried_from, 1);
  assert_near(t.design[0].value[1], 212.5, 0);
  assert_true(isnan(t.design[0].error[1]));
  assert_true(isnan(t.design[1].value[0]));
  assert_near(t.design[0].derivative[0], -2e-7, 0);
  assert_string_equal(t.design[0].digest, "0123456789abcdef");
  assert_int_equal(t.design[1].state, STUDY_FAILED);
  assert_string_equal(t.design[1].reason, s.design[1].reason);
  assert_null(t.design[0].reason);
  assert_int_equal(t.design[0].curve.n, 2);
  assert_int_equal(t.design[0].curve.stable[1], -1);
  assert_near(t.design[0].curve.amplitude[1], 3.5e-5, 0);
  assert_int_equal(t.design[1].curve.n, 0);
  assert_int_equal(t.optimum.best, 1);
  assert_int_equal(t.optimum.history[1], 2);
  assert_near(t.uncertainty.percentile[1], 7, 0);
  assert_near(t.uncertainty.total[3], 0.25, 0);
  assert_true(isnan(t.uncertainty.mean[0]));
  assert_int_equal(t.robust.n_groups, 3);
  assert_int_equal(t.robust.n_failed[1], 4);
  assert_near(t.robust.key[2], 30, 0);
  assert_near(t.robust.percentile[7], 9, 0);
  assert_near(t.robust.confidence, 0.9, 0);
  assert_true(isnan(t.robust.percentile[2]));
  design_study_free(&s);
  design_study_free(&t);
  unlink(path);
}

static void empty_study(void **state) {
  (void)state;
  design_study s, t;
  assert_int_equal(design_study_create(1, 1, 0, &s), SHB_OK);
  name(&s.key[0], "contact.n0", "N");
  name(&s.output[0], "peak", "m");
  assert_int_equal(study_file_write(&s, path), SHB_OK);
  assert_int_equal(study_file_read(path, &t), SHB_OK);
  assert_int_equal(t.n, 0);
  assert_int_equal(t.n_keys, 1);
  assert_int_equal(t.optimum.best, -1);
  assert_null(t.uncertainty.mean);
  design_study_free(&s);
  design_study_free(&t);
  unlink(path);
}

static void damaged_files(void **state) {
  (void)state;
  design_study s, t;
  hid_t        file;
  fill(&s);
  s.design[2].state = (study_state)9;
  assert_int_equal(study_file_write(&s, path), SHB_OK);
  assert_int_equal(study_file_read(path, &t), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "/design/status[2]"));
  design_study_free(&s);
  assert_int_equal(h5_create(path, &file), SHB_OK);
  assert_int_equal(h5_close(file), SHB_OK);
  assert_int_equal(study_file_read(path, &t), SHB_ERR_INPUT);
  unlink(path);
  assert_int_equal(study_file_read(path, &t), SHB_ERR_IO);
}

static void table(void **state) {
  (void)state;
  design_study s;
  post_buffer  out = {0};
  fill(&s);
  study_csv(&s, &out);
  assert_string_equal(
      out.text,
      "design,contact.n0,contact.mu,peak,frequency,peak_error,dpeak_dn0,status,reason\r\n"
      "1,10,0.3,3.5e-05,212.5,1e-09,-2e-07,done,\r\n"
      "2,20,0.3,,,,,failed,\"mesh: \"\"sections\"\", folded\"\r\n"
      "3,30,0.3,,,,,not run,\r\n");
  post_buffer_free(&out);
  design_study_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(round_trip),
      cmocka_unit_test(empty_study),
      cmocka_unit_test(damaged_files),
      cmocka_unit_test(table),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
