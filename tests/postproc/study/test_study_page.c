/* The page of a study: of every kind of study, its JSON, its words, its size. `keep` as argument
 * leaves the files of every kind in the folder. */
#include "postproc/study/study_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "postproc/study/study_data.h"
#include "postproc/study/study_file.h"
#include "postproc/study/study_findings.h"
#include "postproc/study/study_picture.h"
#include "postproc/study/study_publish.h"
#include "tests/support/check.h"
#include "tests/support/json_syntax.h"
#include "tests/support/studies.h"

static char *page_of(studies_kind kind) {
  design_study s;
  post_buffer  out = {0};
  studies_make(kind, &s);
  assert_int_equal(study_page(&s, &out), SHB_OK);
  design_study_free(&s);
  return out.text;
}

static const char *json_of(const char *html) {
  static const char open[] = "id=\"data\">\n";
  const char       *start  = strstr(html, open);
  assert_non_null(start);
  return start + strlen(open);
}

static void the_numbers_of_every_kind_are_json(void **state) {
  (void)state;
  for (int kind = 0; kind < STUDIES_N; kind++) {
    char       *html = page_of((studies_kind)kind);
    const char *end  = json_value(json_of(html));
    assert_non_null(end);
    assert_memory_equal(json_blank(end), "</script>", 9);
    assert_null(strstr(html, "http://"));
    assert_null(strstr(html, "https://"));
    assert_null(strstr(html, "src=\""));
    free(html);
  }
}

static void two_thousand_designs_fit_into_three_megabytes(void **state) {
  (void)state;
  char *html = page_of(STUDIES_LARGE);
  print_message("page of 2000 designs: %.2f MB (3 allowed)\n", 1e-6 * (double)strlen(html));
  assert_true(strlen(html) < 3000000);
  free(html);
}

/* The lowest peak of the grid is at n0 mu nearest 45 N and the largest thickness. */
static void the_headline_names_the_lowest_design(void **state) {
  (void)state;
  design_study s;
  post_buffer  out  = {0};
  int          best = -1;
  char         number[64];
  studies_make(STUDIES_GRID, &s);
  for (int i = 0; i < s.n; i++) {
    const double *k = s.design[i].key;
    if (s.design[i].state != STUDY_DONE) continue;
    if (best < 0 ||
        studies_peak(k[0], k[1], k[2]) <
            studies_peak(s.design[best].key[0], s.design[best].key[1], s.design[best].key[2]))
      best = i;
  }
  study_headline(&s, &out);
  print_message("%s\n", out.text);
  snprintf(number, sizeof number, "Design %d has the lowest peak, ", best + 1);
  assert_has(out.text, number);
  snprintf(number, sizeof number, "%.2f", 1e6 * s.design[best].value[0]);
  assert_has(out.text, number);
  assert_has(out.text, "thickness\u00a0=\u00a06\u00a0mm");
  post_buffer_free(&out);
  design_study_free(&s);
}

static void designs_without_result_are_told_with_their_reason(void **state) {
  (void)state;
  char *html = page_of(STUDIES_GRID);
  assert_has(html, "Designs failed: 73, 74, 75. mesh: the sections overlap &lt;at 0.4&gt;");
  assert_has(html, "Design not converged: 41. the curve stalled at 182.4 Hz");
  free(html);
  html = page_of(STUDIES_FAILED);
  assert_has(html, "No design gave a result.");
  assert_has(html, "Designs failed: 1, 2, 3, 4. the case has no probe");
  assert_null(strstr(html, "class=\"figures\""));
  free(html);
  html = page_of(STUDIES_EMPTY);
  assert_has(html, "The study has no design yet.");
  assert_has(html, "The study is not finished.");
  free(html);
}

static void an_optimum_on_its_bound_is_a_warning(void **state) {
  (void)state;
  char *html = page_of(STUDIES_OPTIMISE);
  assert_has(html, "The search by SBPLX (NLopt) took 60 evaluations");
  assert_has(html, "The optimum lies on the upper bound of <b>contact.mu</b>");
  assert_has(html, "<li class=\"caution\">The optimum is within the error of its neighbours.");
  free(html);
}

static void an_uncertain_study_answers_with_mean_and_percentile(void **state) {
  (void)state;
  char *html = page_of(STUDIES_UNCERTAIN);
  assert_has(html, "µm; 95\u00a0% of the samples stay below ");
  assert_has(html, " samples give no upper bound).");
  assert_has(html, "<b>contact.n0</b> matters most for peak: its total Sobol’ index is 0.78");
  assert_has(html, "\"total\":[[[0.78,0.72,0.84]");
  assert_has(html, "<span>above "); /* so few samples give the 95 % percentile no upper bound */
  assert_null(strstr(html, "\u2013 µm"));
  free(html);
}

/* 60 um (0.25 + 0.6 ln^2(150 N 0.3 / 45 N)) at 150 N, 1.2 times that */
static void a_robust_study_answers_with_the_least_percentile(void **state) {
  (void)state;
  char *html = page_of(STUDIES_ROBUST);
  assert_has(html,
             "95\u00a0% of the samples of peak stay below 18\u00a0µm (above 17.1\u00a0µm at "
             "95\u00a0% confidence; 37 samples give no upper bound) at "
             "contact.n0\u00a0=\u00a0150\u00a0N, the least of 5.");
  assert_has(html, "<span>above 17.1\u00a0µm at 95\u00a0% confidence; 37 samples give no upper");
  assert_has(html,
             "Percentiles of 40 samples at each of 5 designs of the varied keys; 10 failed "
             "ones are left out.");
  assert_has(html, "The interval of the percentile at 4 other designs overlaps");
  assert_has(html, "\"robust\":{\"confidence\":0.95,\"key\":[[60],[90],[120],[150],[180]]");
  assert_null(strstr(html, "matters most for"));
  free(html);
}

/* A thinned curve keeps its highest point: the resonance is a point of the closed form. */
static void thinned_curves_keep_the_resonance(void **state) {
  (void)state;
  design_study s;
  post_buffer  out = {0};
  double       tolerance;
  studies_make(STUDIES_LARGE, &s);
  assert_int_equal(study_data(&s, &out, &tolerance), SHB_OK);
  print_message("2000 curves: drawn to %.2g of the chart\n", tolerance);
  assert_true(tolerance <= 0.0041);
  design_study_free(&s);
  post_buffer_free(&out);

  /* seven points, two of them on the chords between the others */
  static const double f[] = {100, 110, 120, 150, 180, 190, 200}, a[] = {0, 0, 0, 1e-4, 0, 0, 0};
  static const float  kept[] = {100, 120, 150, 180, 200, 0, 0, 1e-4f, 0, 0};
  studies_make(STUDIES_ONE, &s);
  assert_int_equal(study_curve_take(&s.design[0].curve, 7), SHB_OK);
  memcpy(s.design[0].curve.frequency, f, sizeof f);
  memcpy(s.design[0].curve.amplitude, a, sizeof a);
  post_buffer data = {0};
  post_put(&data, "\"data\":\"");
  post_put_base64(&data, 10, kept);
  post_put(&data, "\"");
  out = (post_buffer){0};
  assert_int_equal(study_data(&s, &out, &tolerance), SHB_OK);
  assert_near(tolerance, 1e-3, 1e-12);
  assert_has(out.text, data.text);
  assert_has(out.text, "\"start\":[0,5],\"run\":[0],\"code\":[5]");
  post_buffer_free(&data);
  post_buffer_free(&out);
  design_study_free(&s);
}

static void page_table_and_picture_stand_beside_the_file(void **state) {
  (void)state;
  static const char *const ending[] = {"h5", "csv", "svg", "html"};
  for (int kind = 0; kind < STUDIES_N; kind++) {
    design_study s;
    char         path[64], *summary;
    bool         picture = kind != STUDIES_EMPTY && kind != STUDIES_FAILED;
    studies_make((studies_kind)kind, &s);
    snprintf(path, sizeof path, "page_%s.study.h5", s.name);
    assert_int_equal(study_file_write(&s, path), SHB_OK);
    assert_int_equal(study_publish_file(path, &summary), SHB_OK);
    print_message("%s\n", summary);
    free(summary);
    for (int e = 0; e < 4; e++) {
      snprintf(path, sizeof path, "page_%s.study.%s", s.name, ending[e]);
      assert_int_equal(access(path, R_OK) == 0, e != 2 || picture);
      if (!*state) unlink(path);
    }
    design_study_free(&s);
  }
  assert_int_equal(study_publish_file("study.h5x", &(char *){NULL}), SHB_ERR_IO);
}

int main(int argc, char **argv) {
  bool                    keep    = argc > 1 && strcmp(argv[1], "keep") == 0;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_numbers_of_every_kind_are_json),
      cmocka_unit_test(two_thousand_designs_fit_into_three_megabytes),
      cmocka_unit_test(the_headline_names_the_lowest_design),
      cmocka_unit_test(designs_without_result_are_told_with_their_reason),
      cmocka_unit_test(an_optimum_on_its_bound_is_a_warning),
      cmocka_unit_test(an_uncertain_study_answers_with_mean_and_percentile),
      cmocka_unit_test(a_robust_study_answers_with_the_least_percentile),
      cmocka_unit_test(thinned_curves_keep_the_resonance),
      cmocka_unit_test_prestate(page_table_and_picture_stand_beside_the_file,
                                keep ? argv[1] : NULL),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
