/* The contact law over a step: exact on straight motion, of second order on any, against radial
 * return in very small steps. */
#include "mesh/base/constants.h"
#include "mhb/ring/slip_flow.h"
#include "tests/support/check.h"

static mhb_slip_law law_of(double kv, double n0, double kuu, double kuw, double kww) {
  const mhb_law law = {.mu = .37, .kv = kv, .ku = {kuu, kuw, kww}, .n0 = n0};
  return mhb_slip_law_of(&law);
}

/* Direction of slip by the classical Runge-Kutta method, L e' = x' - (e.x') e, for x' = d over the
 * unit of time, constant limit. */
static double turned(double angle, const double d[2], double limit) {
  const int n = 4000;
  double    h = 1. / n;
  for (int i = 0; i < n; i++) {
    double k[5] = {0}, at[5] = {0, 0, .5, .5, 1};
    for (int j = 1; j <= 4; j++) {
      double a = angle + h * at[j] * k[j - 1];
      k[j]     = (d[1] * cos(a) - d[0] * sin(a)) / limit;
    }
    angle += h / 6 * (k[1] + 2 * k[2] + 2 * k[3] + k[4]);
  }
  return angle;
}

/* One step, however long, while the contact slips throughout. */
static void straight_motion_is_exact(void **state) {
  (void)state;
  const mhb_slip_law law   = law_of(0, 2.385, 1.7, 0, 1.7);
  double             limit = .37 * 2.385, worst = 0;
  for (int i = 0; i < 24; i++) {
    double         start = .4 + .11 * i, size = .2 + .17 * i; /* up to 2.3 rad apart */
    mhb_slip_state s    = {.load = 2.385, .f = {limit * cos(start), limit * sin(start)}};
    double         d[2] = {size, 0}, u[3] = {0, size / 1.7, 0};
    if (cos(start) < 0) continue; /* it would stick at first */
    mhb_slip_step(&law, u, &s);
    double wanted = turned(start, d, limit);
    worst         = fmax(worst, fabs(atan2(s.f[1], s.f[0]) - wanted));
    assert_near(hypot(s.f[0], s.f[1]), limit, 1e-12);
  }
  print_message("direction off by %.1e rad\n", worst);
  assert_below(worst, 1e-4);
}

/* Motion of a test: an ellipse with a second harmonic, normal motion with its own phase. */
static void motion_at(double t, double u[3]) {
  u[0] = .9 * cos(t + .7) + .2 * sin(2 * t);
  u[1] = 1.3 * cos(t) + .3 * cos(2 * t + .4);
  u[2] = .8 * sin(t + .3);
}

enum { PLACES = 16 };

/* Forces at 16 places of the second period, n steps a period. */
static void march(const mhb_slip_law *law, int n, double f[PLACES][2]) {
  mhb_slip_state s;
  double         u[3];
  motion_at(0, u);
  s = (mhb_slip_state){.load = law->n0 + law->kv * u[0], .s = {u[1], u[2]}};
  for (int i = 1; i <= 2 * n; i++) {
    motion_at(SHB_TWO_PI * i / n, u);
    mhb_slip_step(law, u, &s);
    int place = i % n / (n / PLACES);
    if (i > n && i % (n / PLACES) == 0) memcpy(f[place], s.f, sizeof s.f);
  }
}

/* The law by radial return, first order: elastic trial, then back along Ku e. */
static void march_by_return(const mhb_slip_law *law, int n, double out[PLACES][2]) {
  const double *k = law->ku;
  double        u[3], last[3], f[2] = {0, 0};
  motion_at(0, last);
  for (int i = 1; i <= 2 * n; i++, memcpy(last, u, sizeof last)) {
    motion_at(SHB_TWO_PI * i / n, u);
    double du = u[1] - last[1], dw = u[2] - last[2];
    double limit = law->mu * fmax(law->n0 + law->kv * u[0], 0);
    f[0] += k[0] * du + k[1] * dw;
    f[1] += k[1] * du + k[2] * dw;
    for (int j = 0; j < 3; j++) {
      double size = hypot(f[0], f[1]);
      if (size <= limit) break;
      double e[2] = {f[0] / size, f[1] / size}, Ke[2];
      Ke[0]       = k[0] * e[0] + k[1] * e[1];
      Ke[1]       = k[1] * e[0] + k[2] * e[1];
      double part = (size - limit) / (e[0] * Ke[0] + e[1] * Ke[1]);
      f[0] -= part * Ke[0];
      f[1] -= part * Ke[1];
    }
    double size = hypot(f[0], f[1]);
    if (size > limit)
      for (int c = 0; c < 2; c++) f[c] *= limit / size;
    if (i > n && i % (n / PLACES) == 0) memcpy(out[i % n / (n / PLACES)], f, sizeof f);
  }
}

/* |a - b| / |b| over all places. */
static double apart_of(double a[PLACES][2], double b[PLACES][2]) {
  double apart = 0, size = 0;
  for (int i = 0; i < PLACES; i++)
    for (int c = 0; c < 2; c++) {
      apart += pow(a[i][c] - b[i][c], 2);
      size += pow(b[i][c], 2);
    }
  return sqrt(apart / size);
}

static void order_of(const char *name, mhb_slip_law law) {
  double exact[PLACES][2], f[PLACES][2], error[5];
  march(&law, 1 << 17, exact);
  for (int i = 0; i < 5; i++) {
    march(&law, 64 << i, f);
    error[i] = apart_of(f, exact);
  }
  march_by_return(&law, 1 << 19, f);
  double apart = apart_of(f, exact);
  double slope = log2(error[0] / error[4]) / 4;
  print_message("%-22s errors %.1e %.1e %.1e %.1e %.1e, order %.2f; radial return %.1e\n", name,
                error[0], error[1], error[2], error[3], error[4], slope, apart);
  assert_true(slope > 1.8);
  assert_below(error[2], 1e-3);
  assert_below(apart, 1e-4);
}

static void the_law_is_of_second_order(void **state) {
  (void)state;
  order_of("slip", law_of(.3, 2.1, 1.7, 0, 1.7));
  order_of("slip, skew stiffness", law_of(.3, 2.1, 2.3, .5, 1.1));
  order_of("opening", law_of(1.4, .5, 1.7, 0, 1.7));
  order_of("opening, skew", law_of(1.4, .5, 2.3, .5, 1.1));
}

static void without_friction_there_is_no_force(void **state) {
  (void)state;
  const mhb_law  none = {.mu = 0, .kv = 1.2, .ku = {1, .2, 1}, .n0 = .3};
  mhb_slip_law   law  = mhb_slip_law_of(&none);
  mhb_slip_state s    = {.load = .3};
  for (int i = 0; i < 40; i++) {
    double u[3];
    motion_at(.3 * i, u);
    mhb_slip_step(&law, u, &s);
    assert_true(s.f[0] == 0 && s.f[1] == 0);
    assert_near(s.load, .3 + 1.2 * u[0], 1e-15);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(straight_motion_is_exact),
      cmocka_unit_test(the_law_is_of_second_order),
      cmocka_unit_test(without_friction_there_is_no_force),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
