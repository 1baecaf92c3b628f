/* The table of events on a step: order, directions, ends, coincident events and vetoes. */
#include "mhb/continuation/events.h"

#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

/* Rising or falling through a value of the parameter; the context is that value. */
static double rising(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)curve;
  return point->value - *(const double *)context;
}

static double falling(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  return -rising(curve, point, context);
}

static bool never_near(mhb_arclength *curve, double at_current, double at_next, void *context) {
  (void)curve;
  (void)context;
  assert_true(at_current * at_next < 0);
  return false;
}

static bool never_accepted(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)curve;
  (void)point;
  (void)context;
  return false;
}

/* A step of the line from value 0 to 0.3. */
typedef struct {
  mhb_arclength *curve;
  mhb_events     events;
  mhb_end        end;
} step;

static void on_line(step *s, int n_tests, mhb_event_test *test) {
  s->curve               = scalar_curve(scalar_line, -1, 1);
  s->events              = (mhb_events){0};
  s->curve->current.x[0] = 2;
  scalar_step(s->curve, 2, 0, 2.3, 0.3);
  mhb_events_begin(s->curve, n_tests, test);
  mhb_events_locate(s->curve, n_tests, test, &s->events, &s->end);
}

static void finish(step *s) {
  mhb_events_destroy(&s->events);
  assert_null(s->events.system);
  mhb_arclength_destroy(s->curve);
}

static double at_1 = 0.1, at_2 = 0.2, at_05 = 0.05, at_25 = 0.25, at_9 = 0.9;

static void events_come_in_order_along_the_step(void **state) {
  (void)state;
  mhb_event_test test[]    = {{.g = rising, .context = &at_2, .special = 4},
                              {.g = falling, .context = &at_1, .special = 5},
                              {.g = rising, .context = &at_9, .special = 6},
                              {.g = rising, .context = &at_05, .special = 7}};
  const double   wanted[]  = {0.05, 0.1, 0.2};
  const int      special[] = {7, 5, 4};
  step           s;
  on_line(&s, 4, test);
  assert_int_equal(s.end, MHB_END_NONE);
  assert_int_equal(s.events.n, 3);
  for (int i = 0; i < 3; i++) {
    const mhb_curve_event *e = &s.events.event[i];
    assert_near(e->point->value, wanted[i], 1e-9);
    assert_near(e->point->x[0], 2 + wanted[i], 1e-9);
    assert_near(e->place, wanted[i] / 0.3, 1e-8);
    assert_int_equal(e->test->special, special[i]);
  }
  finish(&s);
}

static void only_changes_in_the_direction_count(void **state) {
  (void)state;
  mhb_event_test test[] = {{.g = rising, .context = &at_1, .direction = -1},
                           {.g = falling, .context = &at_2, .direction = 1},
                           {.g = rising, .context = &at_05, .direction = 1},
                           {.g = falling, .context = &at_25, .direction = -1}};
  step           s;
  on_line(&s, 4, test);
  assert_int_equal(s.events.n, 2);
  assert_near(s.events.event[0].point->value, 0.05, 1e-9);
  assert_near(s.events.event[1].point->value, 0.25, 1e-9);
  finish(&s);
}

static void vetoes_are_heard(void **state) {
  (void)state;
  mhb_event_test test[] = {{.g = rising, .context = &at_1, .is_near = never_near},
                           {.g = rising, .context = &at_2, .accept = never_accepted},
                           {.g = rising, .context = &at_05}};
  step           s;
  on_line(&s, 3, test);
  assert_int_equal(s.events.n, 1);
  assert_near(s.events.event[0].point->value, 0.05, 1e-9);
  finish(&s);
}

/* The step is cut short: next is the event, and what lay behind it is no event. */
static void the_first_end_cuts_the_step(void **state) {
  (void)state;
  mhb_event_test test[] = {{.g = rising, .context = &at_1, .direction = 1, .end = MHB_END_CLOSED},
                           {.g = rising, .context = &at_05, .direction = 1, .end = MHB_END_JOINED},
                           {.g = rising, .context = &at_2},
                           {.g = falling, .context = &at_05}};
  step           s;
  on_line(&s, 4, test);
  assert_int_equal(s.end, MHB_END_CLOSED); /* the first of the table */
  assert_near(s.curve->next.value, 0.1, 1e-9);
  assert_int_equal(s.events.n, 1);
  assert_near(s.events.event[0].point->value, 0.05, 1e-9);
  finish(&s);
}

static void an_end_may_be_next_itself(void **state) {
  (void)state;
  double         at_3   = 0.3;
  mhb_event_test test[] = {
      {.g = rising, .context = &at_9, .direction = 1, .at_next = true, .end = MHB_END_HIGH},
      {.g = rising, .context = &at_3, .direction = 1, .at_next = true, .end = MHB_END_JOINED}};
  step s;
  on_line(&s, 2, test);
  assert_int_equal(s.end, MHB_END_JOINED); /* 0 counts */
  assert_true(s.curve->next.value == 0.3);
  finish(&s);
}

/* Of events at one place one is left: the fold, whatever its place in the table. */
static void a_fold_wins_among_coincident_events(void **state) {
  (void)state;
  for (int fold = 0; fold < 2; fold++) {
    mhb_event_test test[2];
    test[fold]            = (mhb_event_test){.g = mhb_fold_test, .special = 1};
    test[1 - fold]        = (mhb_event_test){.g = mhb_fold_test, .special = 2};
    mhb_arclength *curve  = scalar_curve(scalar_circle, -2, 2);
    mhb_events     events = {0};
    mhb_end        end;
    curve->current.x[0] = 3;
    scalar_step(curve, 3 + sin(0.2), cos(0.2), 3 - sin(0.1), cos(0.1));
    mhb_events_begin(curve, 2, test);
    mhb_events_locate(curve, 2, test, &events, &end);
    assert_int_equal(events.n, 1);
    assert_near(events.event[0].point->value, 1, 1e-10);
    mhb_events_destroy(&events);
    mhb_arclength_destroy(curve);
  }
  /* twice the same place, without a fold */
  mhb_event_test test[] = {{.g = rising, .context = &at_1, .special = 3},
                           {.g = falling, .context = &at_1, .special = 4}};
  step           s;
  on_line(&s, 2, test);
  assert_int_equal(s.events.n, 1);
  finish(&s);
}

static void no_more_events_than_there_is_room_for(void **state) {
  (void)state;
  enum { N = MHB_MAX_EVENTS + 4 };
  double         at[N];
  mhb_event_test test[N];
  step           s;
  for (int i = 0; i < N; i++) {
    at[i]   = 0.3 * (i + 1) / (N + 1);
    test[i] = (mhb_event_test){.g = rising, .context = &at[i]};
  }
  on_line(&s, N, test);
  assert_int_equal(s.events.n, MHB_MAX_EVENTS);
  for (int i = 0; i < MHB_MAX_EVENTS; i++) assert_near(s.events.event[i].point->value, at[i], 1e-9);
  finish(&s);
}

/* ---- folds ---- */

/* A fold whose place cannot be located is told. */
static bool solve_nothing;

static double circle_or_nothing(double x, double value, double *f_x, double *f_value) {
  double f = scalar_circle(x, value, f_x, f_value);
  return solve_nothing ? NAN : f;
}

static void a_fold_that_cannot_be_located_is_told(void **state) {
  (void)state;
  mhb_event_test test[] = {{.g = mhb_fold_test}};
  mhb_events     events = {0};
  mhb_arclength *curve  = scalar_curve(circle_or_nothing, -2, 2);
  mhb_end        end;
  solve_nothing       = false;
  curve->current.x[0] = 3;
  scalar_step(curve, 3 + sin(0.2), cos(0.2), 3 - sin(0.1), cos(0.1));
  mhb_events_begin(curve, 1, test);
  solve_nothing = true;
  mhb_events_locate(curve, 1, test, &events, &end);
  solve_nothing = false;
  assert_int_equal(events.n, 0);
  assert_true(events.fold_not_located);
  mhb_events_locate(curve, 1, test, &events, &end);
  assert_int_equal(events.n, 1);
  assert_false(events.fold_not_located);
  mhb_events_destroy(&events);
  mhb_arclength_destroy(curve);
}

/* A value that runs back between points of one sense tells of a pair of folds between them. */
static void a_missed_pair_of_folds_is_seen(void **state) {
  (void)state;
  mhb_event_test  fold = {.g = mhb_fold_test}, other = {.g = rising, .context = &at_1};
  mhb_curve_point middle = {.value = 0.4};
  mhb_arclength  *curve  = scalar_curve(scalar_line, -1, 1);
  mhb_events      events = {0};
  curve->current.x[0]    = 2;
  scalar_step(curve, 2, 0, 2.3, 0.3);
  assert_false(mhb_events_miss_fold(curve, &events));
  events.n        = 1;
  events.event[0] = (mhb_curve_event){&other, 0.5, &middle};
  assert_true(mhb_events_miss_fold(curve, &events)); /* up to 0.4, and back to 0.3 */
  events.event[0].test = &fold;
  assert_false(mhb_events_miss_fold(curve, &events)); /* that is the fold */
  middle.value = 0.2;
  assert_true(mhb_events_miss_fold(curve, &events)); /* rising beyond a fold */
  events.n          = 0;
  curve->next.value = -1e-3;
  assert_true(mhb_events_miss_fold(curve, &events));
  curve->next.value = -1e-6; /* less than can be seen */
  assert_false(mhb_events_miss_fold(curve, &events));
  mhb_arclength_destroy(curve);
}

/* ---- the rest ---- */

static void values_move_on_with_the_step(void **state) {
  (void)state;
  mhb_event_test test[] = {{.g = rising, .context = &at_1}, {.g = falling, .context = &at_9}};
  step           s;
  on_line(&s, 2, test);
  assert_near(test[0].value_current, -0.1, 1e-15);
  assert_near(test[0].value_next, 0.2, 1e-15);
  mhb_events_advance(2, test);
  assert_near(test[0].value_current, 0.2, 1e-15);
  assert_near(test[1].value_current, 0.6, 1e-15);
  finish(&s);
}

static void every_end_has_a_text_of_its_own(void **state) {
  (void)state;
  for (int i = 0; i < MHB_N_ENDS; i++) {
    assert_non_null(mhb_end_text((mhb_end)i));
    for (int j = 0; j < i; j++)
      assert_string_not_equal(mhb_end_text((mhb_end)i), mhb_end_text((mhb_end)j));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(events_come_in_order_along_the_step),
                                     cmocka_unit_test(only_changes_in_the_direction_count),
                                     cmocka_unit_test(vetoes_are_heard),
                                     cmocka_unit_test(the_first_end_cuts_the_step),
                                     cmocka_unit_test(an_end_may_be_next_itself),
                                     cmocka_unit_test(a_fold_wins_among_coincident_events),
                                     cmocka_unit_test(no_more_events_than_there_is_room_for),
                                     cmocka_unit_test(a_fold_that_cannot_be_located_is_told),
                                     cmocka_unit_test(a_missed_pair_of_folds_is_seen),
                                     cmocka_unit_test(values_move_on_with_the_step),
                                     cmocka_unit_test(every_end_has_a_text_of_its_own)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
