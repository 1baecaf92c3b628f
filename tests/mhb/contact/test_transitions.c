/* Transition times against closed forms, also where they fall between points of the grid. */
#include "mesh/base/constants.h"
#include "mhb/contact/transitions.h"
#include "tests/support/check.h"

enum { M = 9, SIZE = 2 * M + 1 };

typedef struct {
  mhb_signals           signals;
  mhb_contact_intervals closed;
  double                a[3][SIZE]; /* n, x_1, x_2 */
} fixture;

static void start(fixture *f) {
  memset(f->a, 0, sizeof f->a);
  assert_ok(mhb_signals_create(M, &f->signals));
  assert_ok(mhb_contact_intervals_create(M, &f->closed));
}

static void find(fixture *f) {
  mhb_signals_set(&f->signals, (const double *const[3]){f->a[0], f->a[1], f->a[2]});
  mhb_contact_intervals_find(&f->signals, &f->closed);
}

static void stop(fixture *f) {
  mhb_signals_destroy(&f->signals);
  mhb_contact_intervals_destroy(&f->closed);
}

/* n = .3 + cos t opens at acos(-.3). */
static void one_interval(void **state) {
  (void)state;
  fixture f;
  start(&f);
  f.a[0][0] = .3;
  f.a[0][1] = 1;
  find(&f);
  assert_int_equal(f.closed.n, 1);
  assert_near(f.closed.opening[0], SHB_TWO_PI + acos(-.3), 1e-14);
  assert_near(f.closed.closing[0], SHB_TWO_PI - acos(-.3), 1e-14);
  stop(&f);
}

/* n = cos(9 t + .4) - .2: nine intervals, in order, whatever the contact is at t = 0. */
static void as_many_as_the_harmonic(void **state) {
  (void)state;
  fixture f;
  start(&f);
  f.a[0][0]         = -.2;
  f.a[0][2 * M - 1] = cos(.4);
  f.a[0][2 * M]     = sin(.4);
  find(&f);
  assert_int_equal(f.closed.n, M);
  for (int i = 0; i < M; i++) {
    double length = 2 * acos(.2) / M;
    assert_near(f.closed.opening[i] - f.closed.closing[i], length, 1e-13);
    assert_near(cos(M * f.closed.closing[i] + .4), .2, 1e-12);
    if (i) assert_near(f.closed.closing[i] - f.closed.closing[i - 1], SHB_TWO_PI / M, 1e-13);
  }
  stop(&f);
}

/* n = 1 - (1 + d) cos(t - .3) opens for 2 sqrt(2 d) rad, down to a thousandth of a cell of the
 * grid. With 1 - d it stays closed. */
static void short_openings_are_found(void **state) {
  (void)state;
  fixture f;
  start(&f);
  for (double d = 1e-3; d > 1e-9; d /= 10) {
    for (int sign = -1; sign <= 1; sign += 2) {
      double amplitude = 1 + sign * d;
      f.a[0][0]        = 1;
      f.a[0][1]        = -amplitude * cos(-.3);
      f.a[0][2]        = -amplitude * sin(-.3);
      find(&f);
      assert_int_equal(f.closed.always_closed, sign < 0);
      assert_int_equal(f.closed.n, sign > 0);
      if (sign < 0) continue;
      double half = acos(1 / amplitude);
      assert_near(f.closed.closing[0], .3 + half, 1e-15 / half);
      assert_near(f.closed.opening[0], .3 - half + SHB_TWO_PI, 1e-14 + 1e-15 / half);
    }
  }
  stop(&f);
}

static void without_roots(void **state) {
  (void)state;
  fixture f;
  start(&f);
  f.a[0][0] = 2;
  f.a[0][1] = .7;
  find(&f);
  assert_true(f.closed.always_closed && !f.closed.always_open && f.closed.n == 0);
  f.a[0][0] = -2;
  find(&f);
  assert_true(!f.closed.always_closed && f.closed.always_open && f.closed.n == 0);
  stop(&f);
}

/* |2 sin t - z| = mu n with n = 1: slip begins where sin t = (mu + z)/2. */
static void onset_of_slip(void **state) {
  (void)state;
  const double z[2] = {.2, 0}, mu = .9;
  double       y[3];
  fixture      f;
  start(&f);
  f.a[0][0] = 1;
  f.a[1][2] = -2;
  find(&f);
  double t = mhb_slip_onset(&f.signals, mu, z, 0, SHB_TWO_PI, y);
  assert_near(t, asin(.55), 1e-14);
  assert_near(y[0], 1, 1e-15);
  assert_near(y[1], 1.1, 1e-14);
  assert_near(y[2], 0, 1e-15);
  assert_true(mhb_slip_onset(&f.signals, mu, z, 0, .5, y) > .5); /* later than the end */
  assert_true(mhb_slip_onset(&f.signals, 2.5, z, 0, SHB_TWO_PI, y) > SHB_TWO_PI);
  stop(&f);
}

/* Slip ended at t = pi/2, where x turns: z = 2 - mu. From that double zero the next onset is where
 * 2 sin t = z - mu. */
static void onset_after_a_double_zero(void **state) {
  (void)state;
  const double mu = .9, z[2] = {2 - mu, 0};
  double       y[3];
  fixture      f;
  start(&f);
  f.a[0][0] = 1;
  f.a[1][2] = -2;
  find(&f);
  double t = mhb_slip_onset(&f.signals, mu, z, SHB_PI / 2, SHB_TWO_PI, y);
  assert_near(t, SHB_PI - asin(1 - mu), 1e-13);
  stop(&f);
}

/* x = 2 (cos t, sin t) starts at z: the limit is reached where the chord is mu n. */
static void onset_in_the_plane(void **state) {
  (void)state;
  const double mu = .7, z[2] = {2, 0};
  double       y[3];
  fixture      f;
  start(&f);
  f.a[0][0] = 1.5;
  f.a[1][1] = 2;
  f.a[2][2] = -2;
  find(&f);
  double t = mhb_slip_onset(&f.signals, mu, z, 0, SHB_TWO_PI, y);
  assert_near(t, 2 * asin(mu * 1.5 / 4), 1e-14);
  stop(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_interval),
      cmocka_unit_test(as_many_as_the_harmonic),
      cmocka_unit_test(short_openings_are_found),
      cmocka_unit_test(without_roots),
      cmocka_unit_test(onset_of_slip),
      cmocka_unit_test(onset_after_a_double_zero),
      cmocka_unit_test(onset_in_the_plane),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
