#include "postproc/draw/plot.h"
#include "tests/support/check.h"

static void ticks(void **state) {
  (void)state;
  double    t[PLOT_MAX_TICKS];
  plot_axis linear = {89.7, 121.3, false, 0, 1, "f"};
  int       n      = plot_ticks(&linear, 6, t);
  assert_int_equal(n, 4); /* 90 100 110 120: the next finer step, 5, would give 7 */
  assert_near(t[0], 90, 1e-12);
  assert_near(t[3], 120, 1e-12);
  plot_axis unlucky = {-43.2, 43.2, false, 0, 1, "f"}; /* the step for 4, 50, would leave 0 alone */
  n                 = plot_ticks(&unlucky, 4, t);
  assert_int_equal(n, 5); /* -40 -20 ... 40 */
  assert_near(t[0], -40, 1e-12);
  plot_axis micro = {0, 2.385e-4, false, 0, 1e-6, "a"};
  n               = plot_ticks(&micro, 5, t);
  assert_int_equal(n, 5); /* 0 50 ... 200 */
  assert_near(t[4], 200, 1e-9);
  plot_axis wide = {3e-6, 2e3, true, 0, 1, "a"};
  n              = plot_ticks(&wide, 10, t);
  assert_int_equal(n, 9); /* 1e-5 ... 1e3 */
  for (int i = 1; i < n; i++) assert_near(t[i] / t[i - 1], 10, 1e-9);
  plot_axis decade = {0.9, 11, true, 0, 1, "a"};
  n                = plot_ticks(&decade, 6, t);
  assert_int_equal(n, 4); /* 1 2 5 10 */
  assert_near(t[2], 5, 1e-12);
  plot_axis gap = plot_axis_signed(-250, 1000, 10, 1, "n0"); /* both signs over decades */
  n             = plot_ticks(&gap, 8, t);
  assert_true(n >= 5 && n <= 12);
  assert_near(t[0], 0, 0);
  for (int i = 1; i < n; i++) { /* 1, 2 or 5 of a decade */
    double mantissa = fabs(t[i]) / pow(10, floor(log10(fabs(t[i])) + 1e-9));
    assert_true(fabs(mantissa - 1) < 1e-9 || fabs(mantissa - 2) < 1e-9 ||
                fabs(mantissa - 5) < 1e-9);
    assert_true(t[i] >= gap.lo && t[i] <= gap.hi);
  }
  assert_int_equal(plot_ticks(&(plot_axis){0, 1, false, 0, 0, NULL}, 5, t), 0);
  assert_int_equal(plot_ticks(&(plot_axis){2, 2, false, 0, 1, NULL}, 5, t), 0);
}

static void ranges(void **state) {
  (void)state;
  plot_axis a = plot_axis_around(7, 7, false, 1, NULL);
  assert_true(a.lo < 7 && a.hi > 7);
  a = plot_axis_around(-3, 50, true, 1, NULL);
  assert_false(a.log); /* a gap has no logarithm */
  a = plot_axis_around(10, 1000, true, 1, NULL);
  assert_true(a.log && a.lo > 5 && a.lo < 10 && a.hi > 1000);
  a = plot_axis_around(INFINITY, -INFINITY, false, 1e-6, NULL); /* no data at all */
  assert_true(a.lo < a.hi);
}

static post_plot area(post_buffer *b, bool log) {
  return (post_plot){
      b, "p", 10, 20, 100, 200, {0, 10, false, 0, 1, NULL}, {log ? 1 : 0, 100, log, 0, 1, NULL}};
}

static void places(void **state) {
  (void)state;
  post_buffer b = {0};
  post_plot   p = area(&b, true);
  assert_near(plot_x(&p, 2.5), 35, 1e-12);
  assert_near(plot_y(&p, 10), 120, 1e-12);
  assert_true(isnan(plot_y(&p, 0)));
  assert_true(isnan(plot_y(&p, -1)));
  assert_true(isnan(plot_x(&p, NAN)));
  assert_true(fabs(plot_x(&p, 1e30)) < 1e4);
  p.x = (plot_axis){-100, 100, false, 1, 1, NULL}; /* odd about the middle, asinh */
  assert_near(plot_x(&p, 0), 60, 1e-12);
  assert_near(plot_x(&p, 7) - 60, 50 * asinh(7) / asinh(100), 1e-12);
  assert_near(plot_x(&p, -7) - 60, -50 * asinh(7) / asinh(100), 1e-12);
}

static int count(const char *text, char c) {
  int n = 0;
  for (; *text; text++) n += *text == c;
  return n;
}

/* Pieces, gaps and merged points. */
static void lines(void **state) {
  (void)state;
  post_buffer  b   = {0};
  post_plot    p   = area(&b, false);
  const double x[] = {0, 1, 2, 3, 4, 5}, y[] = {0, 10, NAN, 30, 40, 50};
  const bool   on[] = {true, true, true, true, true, false};
  plot_line(&p, "line c1", 6, x, y, on); /* 0-1, gap, 3-4, and 4-5 is not wanted */
  const char *d = strstr(b.text, " d=\"") + 4;
  assert_int_equal(count(d, 'M'), 2);
  assert_int_equal(count(d, 'L'), 2);
  assert_has(d, "M10.0 220.0L20.0 200.0M40.0 160.0L50.0 140.0");
  post_buffer_free(&b);
  double many[2001], level[2001];
  for (int i = 0; i <= 2000; i++) {
    many[i]  = i * 0.005;
    level[i] = 50;
  }
  plot_line(&p, "line", 2001, many, level, NULL); /* 0.05 px apart */
  d = strstr(b.text, " d=\"");
  assert_true(count(d, 'L') > 200 && count(d, 'L') <= 252);
  assert_has(d, "L110.0 120.0"); /* the last point is kept */
  post_buffer_free(&b);
  plot_line(&p, "line", 2, x, (const double[]){NAN, 1}, NULL);
  assert_null(b.text); /* nothing to draw, no empty path */
  plot_line(&p, "line", 1, x, y, NULL);
  assert_has(b.text, "<circle");
  post_buffer_free(&b);
}

static void words(void **state) {
  (void)state;
  post_buffer b = {0};
  post_plot   p = area(&b, false);
  plot_svg_open(&b, "p", 100, 50, "a <b> & c", "d \"e\"");
  p.x.label = "<script>";
  p.y.label = "µm & more";
  plot_frame(&p);
  plot_text(&p, "mark", 5, 50, (const double[2]){1, 2}, "end", "<&>");
  plot_svg_close(&b);
  assert_has(b.text, "a &lt;b&gt; &amp; c</title>");
  assert_has(b.text, "&lt;script&gt;</text>");
  assert_has(b.text, "µm &amp; more");
  assert_has(b.text, "x=\"61.0\" y=\"122.0\" text-anchor=\"end\">&lt;&amp;&gt;</text>");
  assert_has_not(b.text, "<script>");
  post_buffer_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(ticks), cmocka_unit_test(ranges),
                                     cmocka_unit_test(places), cmocka_unit_test(lines),
                                     cmocka_unit_test(words)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
