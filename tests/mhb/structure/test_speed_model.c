/* The modal model of a run-up against models made at the exact speed: values, orders, derivatives,
 * refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/structure/receptance.h"
#include "modal/model/reduce.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/random_model.h"
#include "tests/support/spinning.h"

enum { K = 5, N = 3, PROBE_DOFS = 3, PLACES = 23, VALUES = (K + 1) * (2 * N + PROBE_DOFS) };

static mhb_speed_table *make_run_up(spinning_kind kind, int n, bool overlap, mhb_settings *s) {
  modal_speeds     speeds;
  mhb_speed_table *run_up = NULL;
  spinning_speeds(kind, n, 0, 1, overlap, &speeds);
  assert_ok(
      mhb_speed_table_create(&speeds, "blade.modal.h5", s->engine_order, s->frequency, &run_up));
  assert_ok(mhb_speed_model_check(run_up, "blade.modal.h5"));
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

/* The worst over harmonics and kinds of output, each relative to itself. */
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
  mhb_settings     plain = spinning_settings(), s = plain;
  mhb_speed_table *run_up = make_run_up(kind, n, overlap, &s);
  mhb_receptance  *r, *exact;
  double           worst = 0;
  assert_ok(mhb_receptance_create(run_up->common, &s, K, &r));
  for (int i = 0; i < PLACES; i++) {
    double complex a[VALUES], b[VALUES];
    modal_model    model;
    spinning_model(kind, place(i) / s.engine_order, &model, NULL);
    assert_ok(modal_model_reduce(&model, run_up->n_modes, true));
    modal_model_drop_residual_modes(&model);
    assert_ok(mhb_receptance_create(&model, &plain, K, &exact));
    outputs(r, place(i), false, a);
    outputs(exact, place(i), false, b);
    worst = fmax(worst, distance(a, b));
    mhb_receptance_destroy(exact);
    modal_model_free(&model);
  }
  mhb_receptance_destroy(r);
  mhb_speed_table_destroy(run_up);
  return worst;
}

static void what_does_not_change_stays(void **state) {
  (void)state;
  for (int n = 2; n <= 5; n++)
    for (int overlap = 0; overlap < 2; overlap++)
      assert_below(error(SPINNING_STEADY, n, overlap), 1e-12);
}

/* ---- a disc ---- */

/* With Coriolis terms half as large as the rotor's, from a speed above 0. */
enum { STILL, TURNING };
static const double coriolis_of[] = {0, 0.5}, lowest_of[] = {0, 0.05};

static mhb_disc_table *make_disc_run_up(int n, int terms, mhb_settings *s, mhb_disc_speeds **top) {
  modal_sector_speeds speeds;
  mhb_disc_table     *run_up = NULL;
  lumped_disc_speeds(n, lowest_of[terms], coriolis_of[terms], 8, &speeds);
  assert_ok(
      mhb_disc_table_create(&speeds, "disc.modal.h5", s->engine_order, s->frequency, &run_up));
  assert_ok(mhb_disc_table_check(run_up, "disc.modal.h5"));
  modal_sector_speeds_free(&speeds);
  *top = mhb_disc_speeds_create(run_up);
  mhb_disc_speeds_set_all(*top);
  s->run_up          = run_up->table[0];
  s->disc_run_up     = run_up;
  s->nodal_diameters = &(*top)->now;
  return run_up;
}

static mhb_settings disc_settings(int engine_order) {
  mhb_settings s = lumped_disc_settings(engine_order, 3);
  s.frequency[0] = spinning_settings().frequency[0];
  s.frequency[1] = spinning_settings().frequency[1];
  return s;
}

/* As error; some harmonics are backward waves, some those of nodal diameters 0 and N/2. */
static double disc_error(int n, int terms, int engine_order) {
  mhb_settings     s = disc_settings(engine_order), plain = s;
  mhb_disc_speeds *top;
  mhb_disc_table  *run_up = make_disc_run_up(n, terms, &s, &top);
  mhb_receptance  *r, *exact;
  double           worst = 0;
  assert_ok(mhb_receptance_create(&top->now.model[0], &s, K, &r));
  for (int i = 0; i < PLACES; i++) {
    double complex        a[VALUES], b[VALUES];
    modal_nodal_diameters waves;
    const lumped_disc     d = lumped_disc_spinning(place(i) / s.engine_order, coriolis_of[terms]);
    lumped_disc_waves(&d, 8, &waves);
    assert_ok(modal_nodal_diameters_reduce(&waves, run_up->table[0]->n_modes, true));
    for (int k = 0; k < waves.n; k++)
      modal_wave_drop_residual_modes(&waves.model[k], &waves.imaginary[k], &waves.backward[k]);
    plain.nodal_diameters = &waves;
    assert_ok(mhb_receptance_create(&waves.model[0], &plain, K, &exact));
    outputs(r, place(i), false, a);
    outputs(exact, place(i), false, b);
    worst = fmax(worst, distance(a, b));
    mhb_receptance_destroy(exact);
    modal_nodal_diameters_free(&waves);
  }
  mhb_receptance_destroy(r);
  mhb_disc_speeds_destroy(top);
  mhb_disc_table_destroy(run_up);
  return worst;
}

static void order_of_a_disc_is_four(void **state) {
  (void)state;
  for (int c = 0; c < 4; c++) {
    const int engine_order = 2 + c % 2, terms = c / 2;
    double    e[3];
    for (int i = 0; i < 3; i++) e[i] = disc_error(8 << i, terms, engine_order);
    print_message("disc%s, E = %d: %.2e with 8 speeds, %.2e with 16, %.2e with 32\n",
                  terms ? " with Coriolis terms" : "", engine_order, e[0], e[1], e[2]);
    assert_below(e[1], e[0] / 12);
    assert_below(e[2], e[1] / 12);
    assert_below(e[2], 3e-7);
  }
}

/* Straight lines in Omega^2, constant shapes: exact. */
static void straight_lines_are_exact(void **state) {
  (void)state;
  for (int n = 2; n <= 5; n++)
    for (int overlap = 0; overlap < 2; overlap++)
      assert_below(error(SPINNING_STRAIGHT, n, overlap), 1e-11);
}

/* From 8 speeds on: the error falls by 16 at least with twice as many. Splines over tracks ignore a
 * veering. */
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

/* The mean has a slope too. At the crossing of the second and third mode the derivative holds. */
static void slopes_are_derivatives(void **state) {
  (void)state;
  static const spinning_kind kind[] = {SPINNING_STRAIGHT, SPINNING_TURNING, SPINNING_VEERING};
  for (int c = 0; c < 3; c++)
    for (int nu = 1; nu <= 2; nu++) {
      mhb_settings s          = spinning_settings();
      s.subharmonics          = nu;
      mhb_speed_table *run_up = make_run_up(kind[c], 9, true, &s);
      mhb_receptance  *r;
      double           worst = 0;
      assert_ok(mhb_receptance_create(run_up->common, &s, K, &r));
      for (int i = 0; i < PLACES; i++) {
        double complex exact[VALUES], wanted[VALUES];
        difference(r, place(i), wanted);
        outputs(r, place(i), true, exact);
        worst = fmax(worst, distance(exact, wanted));
      }
      print_message("kind %d, nu %d: slopes differ by %.1e\n", (int)kind[c], nu, worst);
      assert_below(worst, 1e-8);
      mhb_receptance_destroy(r);
      mhb_speed_table_destroy(run_up);
    }
}

/* Modes that change places with ones left out are left out too. */
static void slopes_of_a_disc_are_derivatives(void **state) {
  (void)state;
  for (int c = 0; c < 4; c++) {
    const int        engine_order = 2 + c % 2, terms = c / 2;
    mhb_settings     s = disc_settings(engine_order);
    mhb_disc_speeds *top;
    mhb_disc_table  *run_up = make_disc_run_up(9, terms, &s, &top);
    mhb_receptance  *r;
    double           worst = 0;
    assert_ok(mhb_receptance_create(&top->now.model[0], &s, K, &r));
    for (int i = 0; i < PLACES; i++) {
      double complex exact[VALUES], wanted[VALUES];
      difference(r, place(i), wanted);
      outputs(r, place(i), true, exact);
      worst = fmax(worst, distance(exact, wanted));
    }
    print_message("disc%s, E = %d: slopes differ by %.1e\n", terms ? " with Coriolis terms" : "",
                  engine_order, worst);
    assert_below(worst, 1e-8);
    mhb_receptance_destroy(r);
    mhb_disc_speeds_destroy(top);
    mhb_disc_table_destroy(run_up);
  }
}

static void modes_that_leave_are_static(void **state) {
  (void)state;
  for (int overlap = 0; overlap < 2; overlap++) {
    mhb_settings     s      = spinning_settings();
    mhb_speed_table *run_up = make_run_up(SPINNING_LEAVING, 9, overlap, &s);
    assert_int_equal(run_up->n_modes, SPINNING_MODES - 1);
    assert_int_equal(run_up->n_dropped, 1);
    mhb_speed_table_destroy(run_up);
    assert_below(error(SPINNING_LEAVING, 33, overlap), 1e-5);
  }
}

/* At rest there are no terms to interpolate. */
static void coriolis_terms_at_rest_are_refused(void **state) {
  modal_sector_speeds speeds;
  mhb_disc_table     *table;
  const double        range[2] = {.4 / SHB_TWO_PI, 1.9 / SHB_TWO_PI};
  (void)state;
  lumped_disc_speeds(5, 0, 0.5, 8, &speeds);
  assert_refused(mhb_disc_table_create(&speeds, "disc.modal.h5", 2, range, &table), SHB_ERR_INPUT,
                 "Coriolis terms are needed at every speed or at none, and no speed may be 0");
  modal_sector_speeds_free(&speeds);
}

/* Only the speeds about the range count, two more on each side. */
static void speeds_far_away_do_not_count(void **state) {
  (void)state;
  mhb_settings     s = spinning_settings();
  modal_speeds     speeds;
  mhb_speed_table *run_up = NULL;
  spinning_speeds(SPINNING_TURNING, 41, 0, 1, false, &speeds);
  speeds.mac[5 * SPINNING_MODES] = .1; /* a track lost far below */
  s.frequency[0]                 = .81 / SHB_TWO_PI;
  s.frequency[1]                 = 1.19 / SHB_TWO_PI;
  assert_ok(mhb_speed_table_create(&speeds, "blade", 2, s.frequency, &run_up));
  assert_below(fabs(run_up->low - .35), 1e-12);
  assert_below(fabs(run_up->high - .65), 1e-12);
  assert_below(fabs(mhb_speed_table_speed(run_up, .8) - .4), 1e-12);
  assert_true(mhb_speed_table_speed(run_up, 2) == run_up->high); /* nothing is extrapolated */
  mhb_speed_table_destroy(run_up);
}

static void refuse(modal_speeds *speeds, int order, double from, double to, const char *text) {
  const double     range[2] = {from / SHB_TWO_PI, to / SHB_TWO_PI};
  mhb_speed_table *run_up   = NULL;
  assert_int_equal(mhb_speed_table_create(speeds, "blade.h5", order, range, &run_up),
                   SHB_ERR_INPUT);
  if (!strstr(shb_message(), text)) fail_msg("'%s' does not say '%s'", shb_message(), text);
  assert_int_equal(speeds->n, 0); /* taken over */
}

static void what_cannot_be_is_refused(void **state) {
  (void)state;
  const size_t all = SPINNING_MODES * SPINNING_MODES;
  modal_speeds s   = {0};
  refuse(&s, 2, .4, 1.9,
         "blade.h5 holds modes of one speed; several are wanted: rotor.speed as a list");
  spinning_speeds(SPINNING_TURNING, 3, 0, 1, true, &s);
  refuse(&s, 0, .4, 1.9, "excitation.engine_order is 0");
  spinning_speeds(SPINNING_TURNING, 3, .25, 1, true, &s);
  refuse(&s, 2, .4, 1.9, "2.38732 to 9.5493 rpm, which cover 0.0795775 to 0.31831 Hz");
  spinning_speeds(SPINNING_TURNING, 3, 0, 1, true, &s);
  refuse(&s, 2, .4, 2.1, "on engine order 2 is a rotor of 1.90986 to 10.0268 rpm");
  spinning_speeds(SPINNING_TURNING, 5, 0, 1, false, &s);
  s.mac[2 * SPINNING_MODES + 1] = .3;
  refuse(&s, 2, .4, 1.9, "mode 2 of 4.77465 rpm has a MAC of 0.3 only with any of 2.38732 rpm");
  spinning_speeds(SPINNING_TURNING, 5, 0, 1, true, &s);
  for (size_t i = 0; i < all; i++) /* all but two modes are others */
    if (i / SPINNING_MODES > 1 || i % SPINNING_MODES > 1) s.overlap[3 * all + i] = 0;
  refuse(&s, 2, .4, 1.9, "whatever number of the 6 modes is kept, some change places");
  spinning_speeds(SPINNING_TURNING, 3, 0, 1, true, &s);
  for (int i = 0; i < SPINNING_MODES; i++) s.model[1].frequency[i] *= i ? 1 : 1e-2;
  for (int i = 0; i < SPINNING_MODES; i++) s.model[2].frequency[i] *= i ? 1 : 5;
  const double     range[2] = {.4 / SHB_TWO_PI, 1.9 / SHB_TWO_PI};
  mhb_speed_table *table    = NULL;
  assert_ok(mhb_speed_table_create(&s, "blade.h5", 2, range, &table));
  assert_int_equal(mhb_speed_model_check(table, "blade.h5"), SHB_ERR_INPUT);
  if (!strstr(shb_message(), "blade.h5: the speeds are too far apart"))
    fail_msg("'%s'", shb_message());
  mhb_speed_table_destroy(table);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_does_not_change_stays),
                                     cmocka_unit_test(straight_lines_are_exact),
                                     cmocka_unit_test(order_is_four),
                                     cmocka_unit_test(slopes_are_derivatives),
                                     cmocka_unit_test(order_of_a_disc_is_four),
                                     cmocka_unit_test(slopes_of_a_disc_are_derivatives),
                                     cmocka_unit_test(modes_that_leave_are_static),
                                     cmocka_unit_test(coriolis_terms_at_rest_are_refused),
                                     cmocka_unit_test(speeds_far_away_do_not_count),
                                     cmocka_unit_test(what_cannot_be_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
