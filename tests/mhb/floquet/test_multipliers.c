/* Floquet multipliers with known answers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/check.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

enum { N = 256, MOST = 64 };

/* Moduli that must be there, and no others among the largest. */
static void assert_moduli(const mhb_multipliers *out, const double *wanted, int n) {
  for (int i = 0; i < n; i++) {
    double nearest = INFINITY;
    for (int k = 0; k < out->n; k++) {
      double size = cabs(out->multiplier[k]);
      if (fabs(size - wanted[i]) < fabs(nearest - wanted[i])) nearest = size;
    }
    assert_near(nearest, wanted[i], 1e-3);
  }
  for (int k = 0; k < out->n; k++) {
    double size = cabs(out->multiplier[k]), nearest = INFINITY;
    for (int i = 0; i < n; i++)
      if (fabs(size - wanted[i]) < fabs(nearest - size)) nearest = wanted[i];
    if (size > wanted[n - 1] + 1e-3) assert_near(nearest, size, 1e-3);
  }
}

/* Computed outside this program, by an event-driven integration. */
static void three_degree_multipliers(void **state) {
  (void)state;
  static const struct {
    double       n0, w, amplitude, modulus[4]; /* amplitude of u */
    int          n, stuck, zeros;
    mhb_verdict  verdict;
    mhb_crossing crossing;
  } rows[] = {
      {.3, 1.42, .396878, {.876878, .725133, .691540}, 3, 0, 2, MHB_STABLE, MHB_THROUGH_PAIR},
      {0,
       1.05,
       .114818,
       {.957200, .754947, .743689, .705078},
       4,
       0,
       2,
       MHB_STABLE,
       MHB_THROUGH_PLUS_ONE},
      {.1, 1.25, .079726, {1.021574, .826291, .576229}, 3, 0, 2, MHB_UNSTABLE, MHB_THROUGH_PAIR},
      {1, 1.2, .147642, {.951031, .936524, .915382}, 3, 2, 0, MHB_STABLE, MHB_THROUGH_PAIR}};
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    mhb_settings   s = ground_settings(.4, .8, .5, rows[i].n0, 21);
    periodic       p;
    double complex mu[MOST];
    periodic_create(&model, &s, rows[i].w, NULL, &p);
    const double *u = p.x + p.residual->nb;
    assert_near(hypot(u[1], u[2]), rows[i].amplitude, 1e-5);
    mhb_multipliers out = periodic_multipliers(&p, N, mu);
    print_message("n0 %.1f W %.2f: %.6f %.6f %.6f %.6f\n", rows[i].n0, rows[i].w, cabs(mu[0]),
                  cabs(mu[1]), cabs(mu[2]), cabs(mu[4]));
    assert_moduli(&out, rows[i].modulus, rows[i].n);
    assert_int_equal(out.n, 6);
    assert_int_equal(out.n_stuck, rows[i].stuck);
    assert_int_equal(out.n_zero, rows[i].zeros);
    assert_int_equal(out.verdict, rows[i].verdict);
    assert_int_equal(out.crossing, rows[i].crossing);
    assert_int_equal(out.n_unstable, rows[i].verdict == MHB_UNSTABLE ? 2 : 0);
    if (rows[i].n0 == .1) assert_near(cabs(mu[0] - CMPLX(.984706, fabs(.271972))), 0, 1e-3);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Point `at` of a branch with one pair in real form, or the mixture of two neighbours. */
static void between(const mhb_response *r, const mhb_branch *b, int at, double share, double *x) {
  int K = r->n_harmonics + 1, nb = mhb_real_size(r->n_harmonics);
  for (int c = 0; c < 3; c++) {
    double complex A[K];
    for (int k = 0; k < K; k++)
      A[k] = (1 - share) * b->motion[(at * 3 + c) * K + k] +
             (share > 0 ? share * b->motion[((at + 1) * 3 + c) * K + k] : 0);
    mhb_to_real(r->n_harmonics, A, x + c * nb);
  }
}

static mhb_response *sweep(const modal_model *model, mhb_settings *s, double from, double to) {
  mhb_response *response;
  s->frequency[0] = from / SHB_TWO_PI;
  s->frequency[1] = to / SHB_TWO_PI;
  assert_int_equal(mhb_forced_response(model, s, NULL, NULL, NULL, &response), SHB_OK);
  return response;
}

/* Three branches at one frequency; at each fold a multiplier passes +1. */
static void one_degree_with_jumps(void **state) {
  (void)state;
  static const struct {
    double n0, F, w, amplitude[3], largest[3], smallest;
  } rows[] = {{-4.5, .1, 1.30, {.144518, .908380, 1.141048}, {.907861, 1.389312, .907861}, .593251},
              {1, .06, 2.30, {.012736, .432375, .461382}, {.946829, 1.295319, .946829}, .692097}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(.02, 0, rows[i].F, &model);
    mhb_settings      s = ground_settings(0, 9, 1, rows[i].n0, 31);
    mhb_response     *r = sweep(&model, &s, .5, 3.6);
    const mhb_branch *b = &r->branch[2];
    double complex    mu[MOST];
    double            x[3 * 63];
    int               seen = 0, folds = 0;
    for (int at = 0; at + 1 < b->n_points; at++) {
      double   here = SHB_TWO_PI * b->frequency[at], next = SHB_TWO_PI * b->frequency[at + 1];
      periodic p;
      if (b->special[at] == MHB_FOLD) {
        between(r, b, at, 0, x);
        periodic_create(&model, &s, here, x, &p);
        mhb_multipliers out = periodic_multipliers(&p, 1024, mu);
        print_message("%c fold at %.6f: %.5f %.5f\n", 'A' + i, here, creal(mu[0]), creal(mu[1]));
        assert_near(creal(mu[0]), 1, 2e-2);
        assert_int_equal(out.crossing, MHB_THROUGH_PLUS_ONE);
        periodic_destroy(&p);
        folds++;
      }
      if ((here < rows[i].w) == (next < rows[i].w)) continue;
      between(r, b, at, (rows[i].w - here) / (next - here), x);
      periodic_create(&model, &s, rows[i].w, x, &p);
      mhb_multipliers out = periodic_multipliers(&p, N, mu);
      for (int k = 0; k < 3; k++) {
        if (fabs(hypot(p.x[1], p.x[2]) - rows[i].amplitude[k]) > 1e-4) continue;
        print_message("%c at %.2f, %.6f: %.6f %.6f\n", 'A' + i, rows[i].w, rows[i].amplitude[k],
                      cabs(mu[0]), cabs(mu[1]));
        assert_near(out.largest, rows[i].largest[k], 1e-3);
        assert_int_equal(out.verdict, k == 1 ? MHB_UNSTABLE : MHB_STABLE);
        assert_int_equal(out.n_unstable, k == 1);
        if (k == 1) assert_near(creal(mu[1]), rows[i].smallest, 1e-3);
        if (k == 1) assert_int_equal(out.crossing, MHB_THROUGH_PLUS_ONE);
        seen |= 1 << k;
      }
      periodic_destroy(&p);
    }
    assert_int_equal(seen, 7);
    assert_int_equal(folds, 2);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
}

/* Multipliers of the period map between exact events, the oscillator being linear from one to the
 * next. */
static void friction_oscillator(void **state) {
  (void)state;
  static const double rows[2][3] = {{1.18, .599848, .317776}, {1.30, .428216, .428216}};
  modal_model         model;
  one_degree_model(.01, 1, .8, &model);
  for (int i = 0; i < 2; i++) {
    mhb_settings   s = ground_settings(1, 1, 1, 1, 31);
    periodic       p;
    double complex mu[MOST];
    periodic_create(&model, &s, rows[i][0], NULL, &p);
    mhb_multipliers out = periodic_multipliers(&p, N, mu);
    print_message("W %.2f: %.6f %.6f (%.6f across the motion)\n", rows[i][0], cabs(mu[0]),
                  cabs(mu[1]), cabs(mu[2]));
    assert_near(cabs(mu[0]), rows[i][1], 1e-3);
    assert_near(cabs(mu[1]), rows[i][2], 1e-3);
    assert_int_equal(out.n_zero, 1);
    assert_int_equal(out.verdict, MHB_STABLE);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Without friction nothing but the dampers changes volumes in the space of the state: the product
 * is exp(-2 sum zeta_i w_i T). */
static void product_without_friction(void **state) {
  (void)state;
  static const double rows[][2] = {{-.05, 1.2}, {0, .96}, {.02, 1.1}, {-.1, 1.15}};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    mhb_settings   s = ground_settings(0, .8, .5, rows[i][0], 21);
    periodic       p;
    double complex mu[MOST], product = 1;
    double         rate = 0;
    periodic_create(&model, &s, rows[i][1], NULL, &p);
    mhb_multipliers out = periodic_multipliers(&p, N, mu);
    for (int k = 0; k < out.n; k++) product *= mu[k];
    for (int k = 0; k < 3; k++) rate += SHB_TWO_PI * model.frequency[k] * model.damping_ratio[k];
    double wanted = exp(-2 * rate * SHB_TWO_PI / p.omega);
    print_message("n0 %5.2f: product %.8f (%.8f), open %.2f\n", rows[i][0], creal(product), wanted,
                  p.residual->eval->info[0].share[MHB_SEPARATE]);
    assert_near(cabs(product / wanted - 1), 0, 1e-5);
    assert_true(p.residual->eval->info[0].share[MHB_SEPARATE] > .1);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Harmonics of what 250 periods from a start lead to. */
static void march_to(const modal_model *model, const mhb_settings *s, double omega,
                     const double start[2], double *x) {
  enum { STEPS = 400 };
  mhb_balance *b;
  disturbed    d;
  double       y[4] = {start[0], start[1], 0, 0};
  assert_int_equal(mhb_balance_create(model, s, &b), SHB_OK);
  mhb_balance_set_preload(b, s->n0[0]);
  disturbed_create(model, s, b, x, omega, STEPS, &d);
  for (int i = 0; i < 250; i++) disturbed_period(&d, y);
  double basis[b->nb];
  memset(x, 0, sizeof(double) * (size_t)b->n);
  for (int i = 0; i < STEPS; i++) {
    mhb_basis(b->m, SHB_TWO_PI * i / STEPS, basis, NULL);
    for (int k = 0; k < b->nb; k++) x[k] += (k ? 2. : 1.) / STEPS * basis[k] * y[0];
    disturbed_step(&d, y, i);
  }
  disturbed_destroy(&d);
  mhb_balance_destroy(b);
}

/* Along the branch through its fold at the lower end and back to where it began. */
static void other_side(periodic *p, double low, double high, double *x) {
  mhb_arclength *path;
  path = mhb_balance_curve_create(p->residual, low, high);
  assert_int_equal(mhb_arclength_start(path, p->x, p->omega, -1), MHB_CONVERGED);
  for (int i = 0; i < 1000; i++) {
    assert_int_equal(mhb_arclength_step(path), MHB_ARCLENGTH_ON);
    double now = path->current.value, next = path->next.value,
           share = (p->omega - now) / (next - now);
    if (now < p->omega && next >= p->omega) {
      for (int k = 0; k < path->n; k++)
        x[k] = (1 - share) * path->current.x[k] + share * path->next.x[k];
      break;
    }
    mhb_arclength_advance(path);
    assert_true(i < 999);
  }
  mhb_arclength_destroy(path);
}

/* Branches of order 2 and 3 that nothing connects to the open one: period-doubled and -tripled
 * motions, a stable and an unstable. */
static void detached_subharmonics(void **state) {
  (void)state;
  static const struct {
    int    order, harmonics;
    double w, low, start[2], stable, unstable, multiplier[2];
  } rows[] = {{2, 16, 2.5, 2.0, {1.2, 0}, .984855, .734821, {1.7797, .45955}},
              {3, 21, 3.6, 3.2, {-1.2, -.88}, .770513, .719994, {0, 0}}};
  modal_model model;
  one_degree_model(.02, 0, .5, &model);
  for (int i = 0; i < 2; i++) {
    mhb_settings   s = ground_settings(0, 9, 1, -4.5, rows[i].harmonics);
    periodic       p, q;
    double         x[3 * 43];
    double complex mu[MOST];
    s.subharmonics = rows[i].order;
    march_to(&model, &s, rows[i].w, rows[i].start, x);
    periodic_create(&model, &s, rows[i].w, x, &p);
    mhb_multipliers out     = periodic_multipliers(&p, 1024, mu);
    double          product = exp(-.04 * rows[i].order * SHB_TWO_PI / rows[i].w);
    print_message("order %d: %.6f, largest %.5f;", rows[i].order, hypot(p.x[1], p.x[2]),
                  out.largest);
    assert_near(hypot(p.x[1], p.x[2]), rows[i].stable, 2e-5);
    assert_int_equal(out.verdict, MHB_STABLE);
    assert_near(out.largest, sqrt(product), 1e-3);
    other_side(&p, rows[i].low, rows[i].w + 1, x);
    periodic_create(&model, &s, rows[i].w, x, &q);
    out = periodic_multipliers(&q, 1024, mu);
    print_message(" %.6f, %.5f %.5f\n", hypot(q.x[1], q.x[2]), creal(mu[0]), creal(mu[1]));
    assert_near(hypot(q.x[1], q.x[2]), rows[i].unstable, 2e-5);
    assert_int_equal(out.verdict, MHB_UNSTABLE);
    assert_int_equal(out.crossing, MHB_THROUGH_PLUS_ONE);
    assert_near(creal(mu[0] * mu[1]), product, 1e-4);
    for (int k = 0; k < 2 && rows[i].multiplier[0] > 0; k++)
      assert_near(creal(mu[k]), rows[i].multiplier[k], 1e-3);
    periodic_destroy(&p);
    periodic_destroy(&q);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_degree_multipliers), cmocka_unit_test(one_degree_with_jumps),
      cmocka_unit_test(friction_oscillator),      cmocka_unit_test(product_without_friction),
      cmocka_unit_test(detached_subharmonics),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
