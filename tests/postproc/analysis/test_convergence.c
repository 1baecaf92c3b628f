/* A convergence study: verdicts, fastest rung, table, CSV, file, plot, section. */
#include "postproc/analysis/convergence.h"

#include <unistd.h>

#include "modal/hdf5/h5.h"
#include "postproc/report/convergence_chart.h"
#include "tests/support/check.h"

static void add(post_convergence *s, post_ladder ladder, const char *name, double seconds,
                double error, bool reference) {
  post_rung *r = post_convergence_add(s);
  assert_non_null(r);
  r->ladder    = ladder;
  r->state     = POST_RUNG_DONE;
  r->reference = reference;
  r->seconds   = seconds;
  r->total     = seconds + 0.031;
  r->memory    = 27.4e6;
  r->unknowns  = 21;
  r->peak      = error / 3;
  r->frequency = error / 7;
  r->curve     = error;
  snprintf(r->name, sizeof r->name, "%s", name);
}

/* 5 is too inaccurate, 9 is slow, 7 is best. */
static post_convergence sample(void) {
  post_convergence s = {.tolerance = 2e-3, .n_preloads = 3};
  snprintf(s.output, sizeof s.output, "tip <&> motion");
  add(&s, POST_LADDER_HARMONICS, "5", 0.21, 2.1e-3, false);
  add(&s, POST_LADDER_HARMONICS, "7", 0.34, 1.9e-3, false);
  add(&s, POST_LADDER_HARMONICS, "9", 0.55, 4e-4, false);
  add(&s, POST_LADDER_HARMONICS, "31", 5.1, 0, true);
  add(&s, POST_LADDER_MODES, "3", 0.21, 0.37, false);
  add(&s, POST_LADDER_MODES, "17", 0.42, 0, true);
  add(&s, POST_LADDER_MESH, "9 mm, shroud 5 mm", 3.3, 1.2e-3, false);
  add(&s, POST_LADDER_MESH, "6 mm, shroud 4 mm", 4.4, 0, true);
  return s;
}

static void verdicts(void **state) {
  (void)state;
  post_convergence s = sample();
  assert_int_equal(post_cheapest(&s, POST_LADDER_HARMONICS), 1);
  assert_int_equal(post_cheapest(&s, POST_LADDER_MODES), -1); /* never the reference itself */
  assert_int_equal(post_cheapest(&s, POST_LADDER_AUTO), -1);
  assert_int_equal(post_reference(&s, POST_LADDER_MODES), 5);
  assert_int_equal(post_reference(&s, POST_LADDER_ACCURACY), -1);
  s.rung[1].state = POST_RUNG_INCOMPLETE;
  assert_int_equal(post_cheapest(&s, POST_LADDER_HARMONICS), 2);
  s.rung[2].frequency = NAN; /* one unknown error makes the result unknown */
  assert_true(isnan(post_rung_error(&s.rung[2])));
  assert_int_equal(post_cheapest(&s, POST_LADDER_HARMONICS), -1);
  s.rung[2].frequency = 2.2e-3; /* each of the three may be the largest */
  assert_near(post_rung_error(&s.rung[2]), 2.2e-3, 0);
  assert_false(post_rung_meets(&s, &s.rung[2]));
  post_convergence_free(&s);
}

static void conclusion(void **state) {
  (void)state;
  post_convergence s    = sample();
  post_buffer      text = {0};
  post_convergence_conclusion(&s, &text);
  assert_has(text.text,
             "harmonics: 7 meets 0.2 % in 0.34 s (error 0.19 %); the finest, 31, takes 5.1 s\n");
  assert_has(
      text.text,
      "modes: none below the finest meets 0.2 %; the finest, 17, takes 0.42 s and is not known "
      "to be fine enough\n");
  assert_has(text.text, "mesh: 9 mm, shroud 5 mm meets 0.2 % in 3.3 s");
  assert_has(
      text.text,
      "Cheapest that meets 0.2 %: mhb.harmonics 7, 0.34 s, error 0.19 %; 15 times less than 31");
  assert_has_not(text.text, "auto");
  post_buffer_free(&text);
  add(&s, POST_LADDER_TOGETHER, "H 7, fast, 3 modes", 0.2, 1.95e-3, false);
  post_convergence_conclusion(&s, &text);
  assert_has(text.text, "Cheapest that meets 0.2 %: H 7, fast, 3 modes, 0.2 s");
  post_buffer_free(&text);
  assert_null(strstr(text.text ? text.text : "", "Time integration"));
  s.n_points            = 7;
  s.rung[3].integration = 3.1e-6;
  post_convergence_conclusion(&s, &text);
  assert_has(text.text,
             "Time integration: at 7 points 31 harmonics are within 0.00031 % of the largest "
             "amplitude.\n");
  post_buffer_free(&text);
  s.tolerance = 1e-5;
  post_convergence_conclusion(&s, &text);
  assert_has(text.text, "Nothing meets 0.001 % but the reference itself.");
  post_buffer_free(&text);
  post_convergence_free(&s);
}

static void table_and_csv(void **state) {
  (void)state;
  post_convergence s    = sample();
  post_buffer      text = {0};
  s.rung[0].of_case     = true;
  s.rung[4].state       = POST_RUNG_FAILED;
  s.rung[0].integration = 4.2e-3;
  s.rung[4].peak = s.rung[4].seconds = NAN;
  post_convergence_table(&s, "x", &text);
  assert_has(text.text, "5 *");
  assert_has(text.text, "reference\n");
  assert_has(text.text, "failed\n");
  assert_has_not(text.text, "nan");
  post_buffer_free(&text);
  post_convergence_csv(&s, &text);
  assert_has(text.text,
             "\"harmonics\",\"7\",0,complete,21,0.34,0.371,2.74e+07,0.000633333,0.000271429,0.0019,"
             ",yes\r\n");
  assert_has(text.text, "\"harmonics\",\"5\",1,complete,21,0.21,");
  assert_has(text.text, ",0.0021,0.0042,no\r\n");
  assert_has(text.text, "\"modes\",\"3\",0,failed,21,,0.241,2.74e+07,,");
  assert_has(text.text, "\"mesh\",\"9 mm, shroud 5 mm\",0,");
  int lines = 0;
  for (const char *at = text.text; (at = strstr(at, "\r\n")) != NULL; at += 2) lines++;
  assert_int_equal(lines, 1 + s.n);
  post_buffer_free(&text);
  post_convergence_free(&s);
}

static void plot_and_section(void **state) {
  (void)state;
  post_convergence s    = sample();
  post_buffer      text = {0};
  post_convergence_picture(&s, "a<b", &text);
  assert_has(text.text, "Speed against error: a&lt;b");
  assert_has(text.text, "tolerance 0.2 %");
  assert_has(text.text, ">9 mm</text>"); /* the label of a mesh is its size */
  assert_has_not(text.text, "nan");
  post_buffer_free(&text);
  s.note = strdup("Ends at 21.\n");
  post_convergence_section(&s, &text);
  assert_has(text.text, "<h2>Speed against error</h2>");
  assert_has(text.text, "<li>Ends at 21.</li>");
  assert_has(text.text, "tip &lt;&amp;&gt; motion");
  assert_has_not(text.text, "<&>");
  post_buffer_free(&text);
  for (int i = 0; i < s.n; i++) s.rung[i].peak = s.rung[i].seconds = NAN;
  post_convergence_picture(&s, "x", &text);
  assert_has(text.text, "no rung was compared");
  assert_has_not(text.text, "nan");
  post_buffer_free(&text);
  post_convergence_free(&s);
}

static void file_is_read_back(void **state) {
  (void)state;
  char             path[64];
  post_convergence s = sample(), t;
  snprintf(path, sizeof path, "/tmp/shroudhb-test-%d.converge.h5", (int)getpid());
  s.note                    = strdup("A note.\n");
  s.n_points                = 7;
  s.rung[3].integration     = 3e-7;
  s.rung[2].frequency       = NAN;
  s.rung[1].of_case         = true;
  s.rung[4].state           = POST_RUNG_INCOMPLETE;
  shb_provenance provenance = {"case", "text", "settings", "command"};
  assert_ok(post_convergence_write(&s, path, &provenance));
  assert_ok(post_convergence_read(path, &t));
  assert_int_equal(t.n, s.n);
  assert_string_equal(t.output, s.output);
  assert_string_equal(t.note, s.note);
  assert_near(t.tolerance, s.tolerance, 0);
  assert_int_equal(t.n_preloads, 3);
  assert_int_equal(t.n_points, 7);
  assert_near(t.rung[3].integration, 3e-7, 0);
  assert_true(isnan(t.rung[2].integration));
  for (int i = 0; i < s.n; i++) {
    const post_rung *a = &s.rung[i], *b = &t.rung[i];
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->ladder, b->ladder);
    assert_int_equal(a->state, b->state);
    assert_true(a->reference == b->reference && a->of_case == b->of_case);
    assert_near(a->seconds, b->seconds, 0);
    assert_near(a->memory, b->memory, 0);
    assert_near(a->curve, b->curve, 0);
    assert_true(isnan(a->frequency) ? isnan(b->frequency) : a->frequency == b->frequency);
  }
  post_convergence_free(&t);
  s.rung[3].state = (post_rung_state)9;
  assert_ok(post_convergence_write(&s, path, &provenance));
  assert_int_equal(post_convergence_read(path, &t), SHB_ERR_INPUT);
  assert_has(shb_message(), "/state: value 3 (from 0) is 9; 0 to 3 is wanted");
  hid_t file;
  assert_ok(h5_create(path, &file));
  assert_ok(h5_write_provenance(file, "shroudhb response", 1, &provenance));
  assert_ok(h5_close(file));
  assert_int_equal(post_convergence_read(path, &t), SHB_ERR_INPUT);
  unlink(path);
  assert_int_equal(post_convergence_read(path, &t), SHB_ERR_IO);
  assert_int_equal(post_convergence_write(&s, "/no/such/folder/x.h5", &provenance), SHB_ERR_IO);
  post_convergence_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(verdicts), cmocka_unit_test(conclusion), cmocka_unit_test(table_and_csv),
      cmocka_unit_test(plot_and_section), cmocka_unit_test(file_is_read_back)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
