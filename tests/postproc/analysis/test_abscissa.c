#include "postproc/analysis/abscissa.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

static mhb_response *response(mhb_parameter parameter, bool limits) {
  static const double n0[] = {40};
  fixture_options     o    = {1, 9, n0, 1, 1, 1, limits, false, 1, parameter};
  mhb_response       *r    = fixture_response(&o);
  assert_non_null(r);
  return r;
}

/* Names, units and values of each parameter. */
static void words(void **state) {
  (void)state;
  static const struct {
    double      value;
    const char *label, *place;
  } row[MHB_N_PARAMETERS] = {
      {103.8, "frequency, Hz", "103.80\u00a0Hz"},
      {-120.5, "preload n₀, N", "n₀ = −120.5\u00a0N"},
      {2.5, "excitation level", "level\u00a02.5"},
      {0.3, "friction coefficient μ", "μ = 0.3"},
      {5e5, "tangential stiffness kuu, MN/m", "kuu = 0.5\u00a0MN/m"},
      {8e5, "normal stiffness kv, MN/m", "kv = 0.8\u00a0MN/m"},
  };
  for (int p = 0; p < MHB_N_PARAMETERS; p++) {
    mhb_response *r = response((mhb_parameter)p, true);
    post_abscissa x = post_abscissa_of(r);
    char          label[POST_LABEL], place[POST_PLACE];
    assert_string_equal(post_abscissa_label(&x, "", label), row[p].label);
    assert_string_equal(post_abscissa_place(&x, row[p].value, 5, place), row[p].place);
    for (int end = 0; end < 2 && p != MHB_IN_FREQUENCY; end++)
      assert_near(x.range[end], fixture_range[p][end], 1e-9 * fixture_range[p][1]);
    assert_ptr_equal(post_abscissa_values(r, &r->branch[0]),
                     p == MHB_IN_FREQUENCY ? r->branch[0].frequency : r->branch[0].value);
    mhb_response_destroy(r);
  }
}

/* Logarithmic only over decades of positive values, never for the frequency. The unit fits the
 * upper end. */
static void ranges(void **state) {
  (void)state;
  static const struct {
    mhb_parameter parameter;
    double        lo, hi;
    bool          log;
    const char   *unit;
  } row[] = {{MHB_IN_N0, 10, 1000, true, "N"},       {MHB_IN_N0, 0, 1000, false, "N"},
             {MHB_IN_N0, -20e3, 100, false, "kN"},   {MHB_IN_N0, -5, -1, false, "N"},
             {MHB_IN_N0, 0, 0, false, "N"},          {MHB_IN_SCALE, -1, 1, false, ""},
             {MHB_IN_SCALE, 0.5, 2, false, ""},      {MHB_IN_KU, 1e3, 2e9, true, "GN/m"},
             {MHB_IN_FREQUENCY, 1, 500, false, "Hz"}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    mhb_response *r = response(row[i].parameter, false);
    double *x = row[i].parameter == MHB_IN_FREQUENCY ? r->branch[0].frequency : r->branch[0].value;
    for (int p = 0; p < 9; p++) x[p] = row[i].lo + (row[i].hi - row[i].lo) * p / 8;
    post_abscissa a    = post_abscissa_of(r);
    plot_axis     axis = post_abscissa_axis(&a, NULL);
    assert_int_equal(a.log, row[i].log);
    assert_int_equal(axis.log, row[i].log);
    assert_string_equal(a.unit.name, row[i].unit);
    assert_true(axis.lo <= row[i].lo && axis.hi >= row[i].hi && axis.hi > axis.lo);
    double ticks[PLOT_MAX_TICKS];
    int    n = plot_ticks(&axis, 6, ticks);
    assert_true(n >= 3);
    for (int k = 0; k < n; k++) assert_true(isfinite(ticks[k]));
    mhb_response_destroy(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(words), cmocka_unit_test(ranges)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
