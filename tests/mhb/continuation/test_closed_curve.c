/* Places of a curve: distances, test functions of closure, copies, other numbers of harmonics. */
#include "mhb/continuation/closed_curve.h"

#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

/* ---- rows of unknowns, without equations ---- */

static void nothing(mhb_curve_system *system) {
  (void)system;
}

/* The copy j of x is x with j added to the last unknown of each row. */
static void shifted(const mhb_curve_system *system, const double *x, int j, double *to) {
  for (int i = 0; i < system->n; i++) to[i] = x[i] + ((i + 1) % system->row_length == 0 ? j : 0);
}

static mhb_curve_system rows_of(int rows, int length, int copies) {
  return (mhb_curve_system){.n          = rows * length,
                            .row_length = length,
                            .copies     = copies,
                            .destroy    = nothing,
                            .copy       = shifted};
}

/* A curve and a place of it. */
typedef struct {
  mhb_curve_system system; /* of rows */
  mhb_arclength   *curve;
  mhb_curve_place  place;
} scene;

/* A curve of rows in the range 0..high, at rest. */
static void begin(scene *s, mhb_curve_system system, double high) {
  *s       = (scene){.system = system};
  s->curve = mhb_arclength_create(&s->system, 0, high);
}

static void note(scene *s, const mhb_curve_point *point, double tolerance) {
  mhb_curve_place_note(&s->place, s->curve->system, point, tolerance);
}

static void end(scene *s) {
  mhb_curve_place_free(&s->place);
  mhb_arclength_destroy(s->curve);
}

/* A point of 2 rows: x = 1 + i and tangent = 0.1 (1 + i) over the first three of each row. */
static void fill(const mhb_curve_system *s, mhb_curve_point *point) {
  for (int i = 0; i < s->n; i++) {
    int row = i / s->row_length, k = i % s->row_length;
    point->x[i]       = k < 3 ? 1 + 3 * row + k : 0;
    point->tangent[i] = 0.1 * point->x[i];
  }
  point->value         = 7;
  point->tangent[s->n] = 0.2;
}

static void a_place_knows_its_copies(void **state) {
  (void)state;
  scene s;
  begin(&s, rows_of(2, 3, 3), 10);
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  fill(&s.system, &curve->current);
  note(&s, &curve->current, 1e-3);
  assert_int_equal(place->copies, 3);
  assert_true(place->value == 7 && place->rate == 0.2);
  assert_near(place->size, sqrt(1 + 4 + 9 + 16 + 25 + 36), 1e-12);
  fill(&s.system, &curve->next);
  for (int j = 0; j < 3; j++) {
    mhb_curve_return at = {place, j};
    for (int row = 0; row < 2; row++) curve->next.x[3 * row + 2] = 3 + 3 * row + j;
    assert_small(mhb_curve_place_distance(place, curve, &curve->next), 0);
    assert_true(mhb_curve_return_arrived(curve, &curve->next, &at));
    at.copy = (j + 1) % 3;
    assert_false(mhb_curve_return_arrived(curve, &curve->next, &at));
  }
  /* between two copies the distance is that of the nearer one, in y */
  for (int row = 0; row < 2; row++) curve->next.x[3 * row + 2] = 3 + 3 * row + 1.3;
  curve->next.value = 8;
  double unit       = mhb_norm(curve->current.x, 6);
  assert_near(mhb_curve_place_distance(place, curve, &curve->next),
              sqrt(2 * 0.09 / (unit * unit) + 0.01), 1e-12);
  end(&s);
  assert_null(place->x);
}

/* Copies of a motion that repeats early are the motion itself; copy 0 does not count. */
static void a_copy_may_be_the_place(void **state) {
  (void)state;
  scene s;
  begin(&s, rows_of(2, 3, 3), 10);
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  fill(&s.system, &curve->current);
  note(&s, &curve->current, 1e-3);
  for (int early = 0; early < 2; early++) {
    for (int j = 0; j < 3; j++) {
      mhb_curve_return at = {place, j};
      assert_true(mhb_curve_return_repeats(&at) == (early && j == 2));
    }
    memcpy(place->x + 12, place->x, sizeof(double) * 6);
    place->x[12] += 0.9e-3 * place->size; /* within the tolerance */
  }
  end(&s);
}

/* A place of fewer harmonics, and one of more, mean the same motion. */
static void harmonics_may_differ(void **state) {
  (void)state;
  mhb_curve_system narrow = rows_of(2, 3, 1), wide = rows_of(2, 5, 1);
  mhb_arclength   *a, *b;
  mhb_curve_place  place = {0};
  a                      = mhb_arclength_create(&narrow, 0, 10);
  b                      = mhb_arclength_create(&wide, 0, 10);
  fill(&narrow, &a->current);
  fill(&wide, &b->current);
  mhb_curve_return at = {&place, 0};
  for (int way = 0; way < 2; way++) {
    mhb_arclength *from = way ? b : a, *to = way ? a : b;
    mhb_curve_place_note(&place, from->system, &from->current, 1e-6);
    assert_small(mhb_curve_place_distance(&place, to, &to->current), 0);
    assert_small(mhb_curve_return_ahead(to, &to->current, &at), 0);
  }
  /* what the place has no room for counts as a distance */
  mhb_curve_place_note(&place, &narrow, &a->current, 1e-6);
  b->current.x[4] = 2;
  assert_near(mhb_curve_place_distance(&place, b, &b->current), 2 / mhb_norm(b->current.x, 10),
              1e-12);
  mhb_curve_place_free(&place);
  mhb_arclength_destroy(a);
  mhb_arclength_destroy(b);
}

/* ---- on the circle ---- */

static void set_angle(mhb_arclength *curve, double angle, mhb_curve_point *point) {
  scalar_point(curve, 3 + cos(angle), sin(angle), -sin(angle), cos(angle), point);
}

static void ahead_changes_its_sign_at_the_place(void **state) {
  (void)state;
  scene            s     = {.curve = scalar_curve(scalar_circle, -2, 2)};
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  curve->current.x[0]    = 3.5;
  set_angle(curve, 0.7, &curve->current);
  note(&s, &curve->current, 1e-6);
  mhb_curve_return at = {place, 0};
  for (int turned = 0; turned < 2; turned++, mhb_curve_place_turn(place))
    for (double away = -0.3; away < 0.31; away += 0.1) {
      set_angle(curve, 0.7 + away, &curve->next);
      double ahead = mhb_curve_return_ahead(curve, &curve->next, &at);
      if (fabs(away) < 1e-9)
        assert_small(ahead, 1e-9);
      else
        assert_true((ahead * away > 0) == !turned);
    }
  /* its rate along the tangent is the tangent's length, 1 */
  double h          = 1e-5, rate;
  curve->next.x[0]  = curve->current.x[0] + h * curve->current.tangent[0];
  curve->next.value = curve->current.value + h * curve->current.tangent[1];
  rate              = mhb_curve_return_ahead(curve, &curve->next, &at) / h;
  assert_near(rate, 1, 1e-9);
  end(&s);
}

/* A chord passes the place if it crosses its plane within 0.3 of the chord's length. */
static void a_chord_is_near_or_not(void **state) {
  (void)state;
  scene            s     = {.curve = scalar_curve(scalar_line, -1, 1)};
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  curve->current.x[0]    = 2;
  scalar_step(curve, 2, 0, 2.2, 0.2);
  scalar_point(curve, 2.1, 0.1, 1, 1, &curve->trial);
  note(&s, &curve->trial, 1e-6);
  mhb_curve_return at   = {place, 0};
  double           g[2] = {mhb_curve_return_ahead(curve, &curve->current, &at),
                           mhb_curve_return_ahead(curve, &curve->next, &at)};
  assert_true(g[0] < 0 && g[1] > 0);
  assert_true(mhb_curve_return_is_near(curve, g[0], g[1], &at));
  place->x[0] += 0.1; /* about 0.05 in y; the chord is 0.14 long */
  assert_false(mhb_curve_return_is_near(curve, g[0], g[1], &at));
  place->x[0] -= 0.08;
  assert_true(mhb_curve_return_is_near(curve, g[0], g[1], &at));
  end(&s);
}

static void arrival_is_to_the_tolerance_of_the_place(void **state) {
  (void)state;
  scene            s     = {.curve = scalar_curve(scalar_circle, -2, 2)};
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  curve->current.x[0]    = 4;
  set_angle(curve, 0, &curve->current);
  for (double tolerance = 1e-2; tolerance > 1e-6; tolerance *= 0.1) {
    note(&s, &curve->current, tolerance);
    mhb_curve_return at = {place, 0};
    set_angle(curve, 4 * 0.9 * tolerance, &curve->next); /* the range is 4 wide */
    assert_true(mhb_curve_return_arrived(curve, &curve->next, &at));
    set_angle(curve, 4 * 1.1 * tolerance, &curve->next);
    assert_false(mhb_curve_return_arrived(curve, &curve->next, &at));
  }
  end(&s);
}

/* At rest the unit is 1. */
static void a_place_at_rest(void **state) {
  (void)state;
  scene s;
  begin(&s, rows_of(1, 2, 1), 2);
  mhb_arclength   *curve = s.curve;
  mhb_curve_place *place = &s.place;
  note(&s, &curve->current, 1e-6);
  assert_true(place->size == 1);
  curve->next.x[1] = 0.25;
  assert_near(mhb_curve_place_distance(place, curve, &curve->next), 0.25, 1e-15);
  end(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_place_knows_its_copies),
                                     cmocka_unit_test(a_copy_may_be_the_place),
                                     cmocka_unit_test(harmonics_may_differ),
                                     cmocka_unit_test(ahead_changes_its_sign_at_the_place),
                                     cmocka_unit_test(a_chord_is_near_or_not),
                                     cmocka_unit_test(arrival_is_to_the_tolerance_of_the_place),
                                     cmocka_unit_test(a_place_at_rest)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
