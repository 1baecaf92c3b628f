/* The modal model of a run-up against models made at the exact speed: values, orders, derivatives, refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/receptance.h"
#include "tests/mhb/random_model.h"
#include "tests/mhb/spinning.h"

enum { K = 5, N = 3, PROBE_DOFS = 3, PLACES = 23, VALUES = (K + 1) * (2 * N + PROBE_DOFS) };

#define assert_below(value, bound)                                      \
  do {                                                                  \
    double v_ = (value), b_ = (bound);                                  \
    if (!(v_ <= b_)) fail_msg("%s = %.3e, above %.3e", #value, v_, b_); \
  } while (0)

static void assert_ok(shb_status status) {
  if (status != SHB_OK) fail_msg("%s", shb_message());
}

static mhb_run_up *make_run_up(spinning_kind kind, int n, bool overlap, mhb_settings *s) {
  modal_speeds speeds;
  mhb_run_up  *run_up = NULL;
  spinning_speeds(kind, n, 0, 1, overlap, &speeds);
  assert_ok(mhb_run_up_create(&speeds, "blade.modal.h5", s->engine_order, s->frequency, &run_up));
  s->run_up = run_up;
  return run_up;
}

static void force(double complex p[N]) {
  unsigned long long seed = 11;
  for (int i = 0; i < N; i++) {
    double re = random_unit(&seed), im = random_unit(&seed);
    p[i] = .1 * CMPLX(re, im);
  }
}

/* All harmonics at omega: R p, free - R p by modes, probes; or their derivatives. */
static void outputs(mhb_receptance *r, double omega, bool slope, double complex out[VALUES]) {
  double complex p[N], zero[N] = {0};
  force(p);
  mhb_receptance_at(r, omega, K);
  for (int k = 0; k <= K; k++, out += 2 * N + PROBE_DOFS) {
    if (slope) {
      mhb_receptance_slope(r, k, p, out);
      memcpy(out + N, out, N * sizeof *out);
      mhb_receptance_probe_change(r, k, p, zero, 1, 0, out + 2 * N);
      continue;
    }
    for (int i = 0; i < N; i++) {
      out[i] = r->free[k * N + i];
      for (int j = 0; j < N; j++) out[i] -= r->R[(k * N + i) * N + j] * p[j];
    }
    mhb_receptance_motion(r, k, p, out + N);
    mhb_receptance_probe(r, k, p, out + 2 * N);
  }
}

/* Of each harmonic and kind of output by itself; the worst. */
static double distance(const double complex *a, const double complex *b) {
  double worst = 0;
  for (int g = 0; g < VALUES / 3; g++) {
    double apart = 0, size = 0;
    for (int i = 3 * g; i < 3 * g + 3; i++) {
      apart += pow(cabs(a[i] - b[i]), 2);
      size += pow(cabs(b[i]), 2);
    }
    if (size > 0) worst = fmax(worst, sqrt(apart / size));
  }
  return worst;
}

static double place(int i) {
  return .4 + 1.5 * (i + .37) / PLACES;
}

/* The worst over the range against a model of each speed. */
static double error(spinning_kind kind, int n, bool overlap) {
  mhb_settings    plain = spinning_settings(), s = plain;
  mhb_run_up     *run_up = make_run_up(kind, n, overlap, &s);
  mhb_receptance *r, *exact;
  double          worst = 0;
  assert_ok(mhb_receptance_create(run_up->given, &s, K, &r));
  for (int i = 0; i < PLACES; i++) {
    double complex a[VALUES], b[VALUES];
    modal_model    model;
    spinning_model(kind, place(i) / s.engine_order, &model, NULL);
    assert_ok(mhb_receptance_create(&model, &plain, K, &exact));
    outputs(r, place(i), false, a);
    outputs(exact, place(i), false, b);
    worst = fmax(worst, distance(a, b));
    mhb_receptance_destroy(exact);
    modal_model_free(&model);
  }
  mhb_receptance_destroy(r);
  mhb_run_up_destroy(run_up);
  return worst;
}

static void what_does_not_change_stays(void **state) {
  (void)state;
  for (int n = 2; n <= 5; n++)
    for (int overlap = 0; overlap < 2; overlap++)
      assert_below(error(SPINNING_STEADY, n, overlap), 1e-12);
}

/* Straight lines in Omega^2, constant shapes: exact. */
static void straight_lines_are_exact(void **state) {
  (void)state;
  for (int n = 2; n <= 5; n++)
    for (int overlap = 0; overlap < 2; overlap++)
      assert_below(error(SPINNING_STRAIGHT, n, overlap), 1e-11);
}

/* From 8 speeds on: twice as many are 16 times as good, or better. Splines of tracks go through a veering blindly. */
static void order_is_four(void **state) {
  (void)state;
  static const struct {
    spinning_kind kind;
    bool          overlap;
    const char   *name;
    double        bound; /* at 32 speeds */
  } all[] = {{SPINNING_TURNING, true, "turning shapes", 3e-8},
             {SPINNING_TURNING, false, "the same by tracks", 5e-7},
             {SPINNING_VEERING, true, "veering", 3e-9}};
  for (int c = 0; c < 3; c++) {
    double e[3];
    for (int i = 0; i < 3; i++) e[i] = error(all[c].kind, 8 << i, all[c].overlap);
    print_message("%s: %.2e with 8 speeds, %.2e with 16, %.2e with 32\n", all[c].name, e[0], e[1],
                  e[2]);
    assert_below(e[1], e[0] / 12);
    assert_below(e[2], e[1] / 12);
    assert_below(e[2], all[c].bound);
  }
}

/* Sixth order differences. */
static void difference(mhb_receptance *r, double omega, double complex out[VALUES]) {
  static const double weight[] = {3. / 4, -3. / 20, 1. / 60}, h = 7e-5;
  memset(out, 0, VALUES * sizeof *out);
  for (int step = -3; step <= 3; step++) {
    double complex at[VALUES];
    if (step == 0) continue;
    outputs(r, omega + step * h, false, at);
    for (int i = 0; i < VALUES; i++)
      out[i] += (step > 0 ? 1 : -1) * weight[abs(step) - 1] * at[i] / h;
  }
}

/* The mean too has a slope. Between the second and third mode's crossing nothing is lost either. */
static void slopes_are_derivatives(void **state) {
  (void)state;
  static const spinning_kind kind[] = {SPINNING_STRAIGHT, SPINNING_TURNING, SPINNING_VEERING};
  for (int c = 0; c < 3; c++)
    for (int nu = 1; nu <= 2; nu++) {
      mhb_settings s         = spinning_settings();
      s.subharmonics         = nu;
      mhb_run_up     *run_up = make_run_up(kind[c], 9, true, &s);
      mhb_receptance *r;
      double          worst = 0;
      assert_ok(mhb_receptance_create(run_up->given, &s, K, &r));
      for (int i = 0; i < PLACES; i++) {
        double complex exact[VALUES], wanted[VALUES];
        difference(r, place(i), wanted);
        outputs(r, place(i), true, exact);
        worst = fmax(worst, distance(exact, wanted));
      }
      print_message("kind %d, nu %d: slopes differ by %.1e\n", (int)kind[c], nu, worst);
      assert_below(worst, 1e-8);
      mhb_receptance_destroy(r);
      mhb_run_up_destroy(run_up);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_does_not_change_stays), cmocka_unit_test(straight_lines_are_exact),
      cmocka_unit_test(order_is_four), cmocka_unit_test(slopes_are_derivatives)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
