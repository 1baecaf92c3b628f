/* Campbell diagram of modes with known frequencies: f^2 = a + b Omega^2. */
#include "mesh/base/constants.h"
#include "postproc/analysis/campbell.h"
#include "tests/support/check.h"

enum { MODES = 4, SPEEDS = 4 };

static const double a[MODES]       = {100. * 100, 300. * 300, 310. * 310, 900. * 900};
static const double b[MODES]       = {0.08, 0.05, 0.01, 0.02};
static const double speeds[SPEEDS] = {0, 100, 350, 600};
static double       value[SPEEDS][MODES], damping[MODES], shape[3 * MODES];
static double _Complex force[4 * MODES];

/* Modes 2 and 3 cross: the file orders them by frequency, the tracks identify them. The load has
 * harmonics 1 and 3. */
static void make(modal_speeds *s) {
  modal_speeds_create(SPEEDS, MODES, s);
  for (int t = 0; t < MODES; t++) force[MODES + t] = force[3 * MODES + t] = 1;
  for (int i = 0; i < SPEEDS; i++) {
    s->speed[i] = speeds[i];
    s->model[i] = (modal_model){.n_modes       = MODES,
                                .n_pairs       = 1,
                                .n_load        = 3,
                                .frequency     = value[i],
                                .damping_ratio = damping,
                                .right         = shape,
                                .modal_force   = force};
    for (int t = 0; t < MODES; t++) {
      int mode = t;
      if (a[1] + b[1] * speeds[i] * speeds[i] > a[2] + b[2] * speeds[i] * speeds[i])
        mode = t == 1 ? 2 : t == 2 ? 1 : t;
      s->mode[i * MODES + t] = mode;
      s->mac[i * MODES + t]  = 0.97;
      value[i][mode]         = sqrt(a[t] + b[t] * speeds[i] * speeds[i]);
    }
  }
}

static void release(modal_speeds *s) {
  memset(s->model, 0, SPEEDS * sizeof *s->model); /* the arrays are static */
  modal_speeds_free(s);
}

/* e^2 Omega^2 / (2 pi)^2 = a + b Omega^2, for all crossings within the range. */
static void crossings_are_exact(void **state) {
  (void)state;
  modal_speeds   s;
  post_crossing *found;
  int            n, wanted = 0, seen = 0;
  make(&s);
  assert_int_equal(s.mode[3 * MODES + 1], 2); /* they do cross */
  const post_campbell campbell = {.speeds = &s, .engine_order = 2};
  assert_ok(post_campbell_crossings(&campbell, &n, &found));
  for (int k = 1; k <= 3; k += 2)
    for (int t = 0; t < MODES; t++) {
      double slope = 2 * k / SHB_TWO_PI, square = a[t] / (slope * slope - b[t]);
      bool   inside = square > 0 && square <= 600. * 600;
      wanted += inside;
      for (int i = 0; i < n && inside; i++) {
        if (found[i].order != 2 * k || found[i].track != t) continue;
        seen++;
        assert_near(found[i].speed, sqrt(square), 1e-9 * 600);
        assert_near(found[i].frequency, slope * sqrt(square), 1e-6);
      }
    }
  assert_true(wanted >= 3);
  assert_int_equal(seen, wanted);
  assert_int_equal(n, wanted);
  for (int i = 1; i < n; i++) assert_true(found[i].speed >= found[i - 1].speed);
  free(found);
  release(&s);
}

static void picture_and_section(void **state) {
  (void)state;
  modal_speeds s;
  post_buffer  svg = {0}, html = {0}, text = {0};
  make(&s);
  const post_campbell campbell = {.speeds = &s, .engine_order = 2};
  post_campbell_picture(&campbell, "<x>", &svg);
  assert_has(svg.text, "Campbell diagram: &lt;x&gt;");
  assert_has(svg.text, "speed, rpm");
  assert_has(svg.text, "order excited");
  assert_has(svg.text, "class=\"crossing\"");
  assert_has(svg.text, ">mode 3<");
  assert_has(svg.text, ">6E<");
  assert_has_not(svg.text, "nan");
  post_campbell_section(1, &campbell, &html);
  assert_has(html.text, "<td>6E</td><td>1</td>");
  post_campbell_table(&s, false, &text);
  assert_has(text.text, "4 speeds; frequencies of the tracked modes");
  assert_has(text.text, "       2       300    300.832     310.04    328.634 \n"); /* the track */
  post_buffer_free(&svg);
  post_buffer_free(&html);
  post_buffer_free(&text);
  release(&s);
}

/* Of 40 sectors nodal diameter 6 meets order 6, and not order 2. */
static void orders_of_a_disc_meet_their_nodal_diameter(void **state) {
  (void)state;
  modal_speeds   s;
  post_crossing *found, *all;
  post_buffer    html = {0};
  int            n, whole, seen = 0;
  make(&s);
  const post_campbell blade  = {.speeds = &s, .engine_order = 2};
  const post_campbell disc[] = {{.speeds = &s, .engine_order = 2, .blades = 40, .diameter = 6},
                                {.speeds = &s, .engine_order = 2, .blades = 40, .diameter = 4}};
  assert_ok(post_campbell_crossings(&blade, &whole, &all));
  for (int i = 0; i < whole; i++) seen += all[i].order == 6;
  free(all);
  assert_ok(post_campbell_crossings(&disc[0], &n, &found));
  for (int i = 0; i < n; i++) assert_int_equal(found[i].order, 6);
  free(found);
  assert_true(n > 0);
  assert_int_equal(n, seen);
  assert_ok(post_campbell_crossings(&disc[1], &n, &found)); /* order 4 is not driven */
  assert_int_equal(n, 0);
  free(found);
  post_campbell_section(2, disc, &html);
  assert_has(html.text, "<h3>Nodal diameter 6</h3>");
  assert_has(html.text, "<h3>Nodal diameter 4</h3>");
  assert_has(html.text, "Modes of the sector");
  assert_has_not(html.text, "<td>2E</td>");
  post_buffer_free(&html);
  release(&s);
}

/* A lost track has no crossing, and the table marks it. */
static void lost_tracks_are_left_out(void **state) {
  (void)state;
  modal_speeds   s;
  post_crossing *found;
  post_buffer    text = {0};
  int            n;
  make(&s);
  for (int i = 1; i < SPEEDS; i++) s.mac[i * MODES] = 0.3;
  const post_campbell campbell = {.speeds = &s, .engine_order = 2};
  assert_ok(post_campbell_crossings(&campbell, &n, &found));
  for (int i = 0; i < n; i++) assert_int_not_equal(found[i].track, 0);
  free(found);
  post_campbell_table(&s, false, &text);
  assert_has(text.text, "103.923*");
  post_buffer_free(&text);
  release(&s);
}

/* Stuck frequencies with f^2 linear in Omega^2 are met exactly, by the order E alone. */
static void stuck_frequencies_are_met(void **state) {
  (void)state;
  enum { STUCK = 2 };
  static const double low[STUCK] = {30, 2000}, rate[STUCK] = {3e-3, 1e-3}; /* Hz, Hz^2 s^2 */
  modal_speeds        s;
  post_crossing      *found;
  post_buffer         html                  = {0};
  double              stuck[SPEEDS * STUCK] = {0};
  int                 n, seen = 0;
  make(&s);
  for (int i = 0; i < SPEEDS; i++)
    for (int j = 0; j < STUCK; j++)
      stuck[i * STUCK + j] = sqrt(low[j] * low[j] + rate[j] * s.speed[i] * s.speed[i]);
  const post_campbell campbell = {
      .speeds = &s, .engine_order = 2, .n_stuck = STUCK, .stuck = stuck};
  assert_ok(post_campbell_crossings(&campbell, &n, &found));
  for (int i = 0; i < n; i++) {
    if (!found[i].stuck) continue;
    double slope = 2 / SHB_TWO_PI;
    assert_int_equal(found[i].order, 2);
    assert_int_equal(found[i].track, 0); /* the other one is far above */
    assert_near(found[i].speed, low[0] / sqrt(slope * slope - rate[0]), 1e-9 * found[i].speed);
    seen++;
  }
  assert_int_equal(seen, 1);
  post_campbell_section(1, &campbell, &html);
  assert_non_null(strstr(html.text, "<td>stuck 1</td>"));
  post_buffer_free(&html);
  free(found);
  release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(crossings_are_exact),
                                     cmocka_unit_test(stuck_frequencies_are_met),
                                     cmocka_unit_test(picture_and_section),
                                     cmocka_unit_test(orders_of_a_disc_meet_their_nodal_diameter),
                                     cmocka_unit_test(lost_tracks_are_left_out)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
