#include <complex.h>

#include "mesh/base/constants.h"
#include "postproc/analysis/outputs.h"
#include "postproc/analysis/response_analysis.h"
#include "tests/support/check.h"

/* Largest |x(t)| over a fine scan. */
static double scan(int n, const double complex *a) {
  double most = 0;
  for (int i = 0; i < 200000; i++) {
    double         sum  = 0;
    double complex turn = cexp(I * (SHB_TWO_PI * i / 200000));
    for (int k = 0; k < n; k++) sum += pow(creal(a[k] * turn), 2);
    most = fmax(most, sqrt(sum));
  }
  return most;
}

static void ellipse(void **state) {
  (void)state;
  const double complex one[1] = {3 - 4 * I};
  assert_near(post_semi_major_axis(1, one, 1), 5, 1e-15);
  const double complex circle[3] = {2.385, -2.385 * I, 0};
  assert_near(post_semi_major_axis(3, circle, 1), 2.385,
              1e-14); /* the root of the sum of squares would say 3.37 */
  const double complex line[3] = {3 * cexp(0.7 * I), 4 * cexp(0.7 * I), 0};
  assert_near(post_semi_major_axis(3, line, 1), 5, 1e-14);
  const double complex any[3] = {1.3 - 0.2 * I, 0.4 + 0.9 * I, -0.7 + 0.1 * I};
  assert_near(post_semi_major_axis(3, any, 1), scan(3, any), 1e-9);
  const double complex apart[5] = {3, 99, 99, 99, 4};
  assert_near(post_semi_major_axis(2, apart, 4), 5, 1e-14);
  assert_near(post_semi_major_axis(3, (const double complex[3]){0}, 1), 0, 0);
}

static void peak_to_peak(void **state) {
  (void)state;
  /* the mean does not count; one harmonic: twice its amplitude */
  const double complex plain[2] = {17, 2.385 * cexp(1.1 * I)};
  assert_near(post_peak_to_peak(1, 1, plain), 4.77, 1e-13);
  /* cos t - a cos 3t with a > 1/9: extreme at cos^2 t = (1 + 3a)/(12a), value (1 + 3a)^1.5/(3
   * sqrt(3a)) */
  const double         a       = 0.45;
  const double complex flat[4] = {0, 1, 0, -a};
  assert_near(post_peak_to_peak(1, 3, flat), 2 * pow(1 + 3 * a, 1.5) / (3 * sqrt(3 * a)), 1e-12);
  /* circle: its diameter */
  const double complex circle[3][2] = {{0, 1.7}, {0, -1.7 * I}, {5, 0}};
  assert_near(post_peak_to_peak(3, 1, &circle[0][0]), 3.4, 1e-13);
  /* straight line in space: as one axis along it */
  const double complex space[3][4] = {{0, 0.6, 0, -0.6 * a}, {0, 0, 0, 0}, {0, 0.8, 0, -0.8 * a}};
  assert_near(post_peak_to_peak(3, 3, &space[0][0]), 2 * pow(1 + 3 * a, 1.5) / (3 * sqrt(3 * a)),
              1e-12);
  assert_near(post_peak_to_peak(1, 3, (const double complex[4]){2, 0, 0, 0}), 0, 1e-15);
}

/* A time shift and a rotation of the axes change nothing. */
static void invariance(void **state) {
  (void)state;
  const double complex x[3][4] = {{0.2, 1.0 - 0.4 * I, 0.3 * I, 0.21},
                                  {0, 0.5 + 0.3 * I, -0.2, 0.1 * I},
                                  {1, 0.1, 0.05 * I, -0.3}};
  double complex       y[3][4];
  double               c = cos(0.73), s = sin(0.73), shift = 1.234;
  for (int k = 0; k < 4; k++) {
    double complex turn = cexp(I * k * shift);
    y[0][k]             = (c * x[0][k] - s * x[1][k]) * turn;
    y[1][k]             = (s * x[0][k] + c * x[1][k]) * turn;
    y[2][k]             = x[2][k] * turn;
  }
  double wanted = post_peak_to_peak(3, 3, &x[0][0]);
  assert_near(post_peak_to_peak(3, 3, &y[0][0]), wanted, 1e-12);
  assert_true(wanted > 2 * post_semi_major_axis(3, &x[0][1], 4) * 0.7);
}

/* A curve of order 2 beside one of order 1: it has its own harmonics, the excitation's first at k =
 * 2, and zero beyond the last. */
static void orders(void **state) {
  (void)state;
  mhb_response *r = mhb_response_create(1, 0, 3);
  int           at[2];
  char          note[64];
  double       *series;
  assert_non_null(r);
  for (int i = 0; i < 2; i++) {
    at[i] = mhb_response_branch(r, MHB_BRANCH_NONLINEAR);
    if (i) r->branch[1].order = 2;
    if (i) r->branch[1].n_harmonics = 6;
    if (i) r->branch[1].origin = MHB_FROM_SEARCH;
    for (int k = 0; k < 2; k++) mhb_response_point(r, at[i]);
    int K                                  = r->branch[i].n_harmonics + 1;
    r->branch[i].motion[3 * K + 1]         = 3;
    r->branch[i].motion[3 * K + 2]         = 5 + i;
    r->branch[i].motion[3 * K + 2 * K + 2] = 100;
  }
  post_output v = {POST_PLACE_CONTACT, 0, 0};
  for (int i = 0; i < 2; i++) {
    assert_ok(post_series(r, &r->branch[i], v, POST_QUANTITY_FIRST_HARMONIC, &series));
    assert_true(series[0] == 0);
    assert_near(series[1], i ? 6 : 3, 1e-15);
    free(series);
    assert_near(post_amplitude(r, &r->branch[i], 1, v, 2), 5 + i, 1e-15);
  }
  assert_near(post_amplitude(r, &r->branch[0], 1, v, 5), 0, 0);
  post_branch_note(r, &r->branch[0], note);
  assert_string_equal(note, "");
  post_branch_note(r, &r->branch[1], note);
  assert_string_equal(note, ", order 2, isolated curve found by search");
  mhb_response_destroy(r);
}

static void places(void **state) {
  (void)state;
  mhb_response *r = mhb_response_create(2, 1, 3);
  int           at;
  char          name[128];
  assert_non_null(r);
  r->probe_name[0] = strdup("tip");
  at               = mhb_response_branch(r, MHB_BRANCH_NONLINEAR);
  mhb_response_point(r, at);
  mhb_response_point(r, at);
  /* [point 1][pair 1][axis 2][k]: layout as in mhb/response/response.h */
  r->branch[0].motion[((1 * 2 + 1) * 3 + 2) * 4 + 1] = 3 + 4 * I;
  r->branch[0].motion[((1 * 2 + 1) * 3 + 2) * 4 + 2] = 2;
  r->branch[0].probe[(1 * 3 + 1) * 4 + 2]            = 7;
  post_output w                                      = {POST_PLACE_CONTACT, 1, 2};
  assert_near(post_amplitude(r, &r->branch[0], 1, w, 1), 5, 1e-15);
  assert_near(post_amplitude(r, &r->branch[0], 0, w, 1), 0, 0);
  assert_near(
      post_amplitude(r, &r->branch[0], 1, (post_output){POST_PLACE_PROBE, 0, POST_WHOLE}, 2), 7,
      1e-15);
  double *series;
  r->branch[0].order = 2; /* the excitation's first harmonic is now k = 2 */
  assert_ok(post_series(r, &r->branch[0], w, POST_QUANTITY_FIRST_HARMONIC, &series));
  assert_near(series[1], 2, 1e-15);
  free(series);
  post_place_name(r, w, name);
  assert_string_equal(name, "contact 2");
  assert_string_equal(post_axis_name(w), "w, sliding");
  assert_int_equal(post_output_primary(r).place, POST_PLACE_PROBE);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(ellipse), cmocka_unit_test(peak_to_peak),
                                     cmocka_unit_test(invariance), cmocka_unit_test(places),
                                     cmocka_unit_test(orders)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
