/* Random starts in a ring of equal blades find a motion of two of six blades beside the wave. Time
 * integration of the whole ring stays on it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/secondary_branches.h"
#include "mhb/integration/integration_sweep.h"
#include "mhb/mistuning/dense_ring.h"
#include "mhb/response/ring_description.h"
#include "mhb/search/solution_set.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { N = 6, STARTS = 20, SEARCH_HARMONICS = 5, M = 31, NB = 2 * M + 1, ALL = 3 * N * NB };

static const double ZETA = 0.003, GAP = 0.6, KV = 0.4, SEARCHED_AT = 1.03, COMPARED_AT = 1.04;

/* Blades m = k = 1 whose shrouds meet where neighbours come nearer than the gap. The peak of a
 * blade alone is 1. */
typedef struct {
  modal_model        blade, dense;
  mhb_settings       settings, of_dense;
  mhb_mistuned_ring *ring;
} problem;

static void make_ring(problem *g, int blades, int engine_order, const double *deviation) {
  one_degree_model(ZETA, 0, 2 * ZETA, &g->blade);
  g->blade.left               = calloc(3, sizeof(double));
  g->blade.left[0]            = 1;
  g->blade.has_left           = true;
  g->settings                 = ground_settings(0, KV, KV, -GAP * KV, SEARCH_HARMONICS);
  g->settings.to_ground       = false;
  g->settings.blades          = blades;
  g->settings.engine_order    = engine_order;
  g->settings.frequency[0]    = 0.99 / SHB_TWO_PI;
  g->settings.frequency[1]    = 1.15 / SHB_TWO_PI;
  g->settings.search.starts   = STARTS;
  g->settings.search.n_at     = 1;
  g->settings.search.at[0]    = SEARCHED_AT / SHB_TWO_PI;
  g->settings.search.n_orders = 2;
  g->settings.search.order[0] = 1;
  g->settings.search.order[1] = 2;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, deviation, 1, &g->ring));
  g->settings.ring = g->ring;
  mhb_dense_ring(g->ring, &g->dense);
  mhb_dense_ring_settings(&g->settings, &g->of_dense);
}

static void make(problem *g, const double *deviation) {
  make_ring(g, N, 1, deviation);
}

static void drop(problem *g) {
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->dense);
  modal_model_free(&g->blade);
}

static mhb_response *sweep(const problem *g) {
  mhb_response *r = NULL;
  if (mhb_forced_response(&g->ring->whole, &g->settings, NULL, NULL, NULL, &r) != SHB_OK)
    fail_msg("%s", shb_message());
  return r;
}

static const mhb_branch *found_branch(const mhb_response *r) {
  for (int i = 2; i < r->n_branches; i++)
    if (r->branch[i].origin == MHB_FROM_SEARCH && r->branch[i].order == 1) return &r->branch[i];
  return NULL;
}

/* x[ALL] <- motion of a point of the integration. */
static void motion_of(const mhb_branch *b, int point, double *x) {
  const int K = b->n_harmonics + 1;
  memset(x, 0, sizeof(double) * ALL);
  for (int row = 0; row < 3 * N; row++)
    for (int k = 0; k < K && k <= M; k++) {
      const double complex a =
          b->motion[((size_t)point * 3 * N + (size_t)row) * (size_t)K + (size_t)k];
      x[row * NB + (k ? 2 * k - 1 : 0)] = creal(a);
      if (k) x[row * NB + 2 * k] = cimag(a);
    }
}

/* Distance of the normal vibrations, relative: no motion along the contact is determined. */
static double distance(const double *a, const double *b) {
  double away = 0, size = 0;
  for (int i = 0; i < ALL; i++) {
    if (i % NB == 0 || i / NB % 3 != 0) continue;
    away += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return sqrt(away / size);
}

/* Ratio of the largest normal vibration of a contact to the least. */
static double spread(const double *x) {
  double most = 0, least = INFINITY;
  for (int i = 0; i < N; i++) {
    const double size = hypot(x[3 * i * NB + 1], x[3 * i * NB + 2]);
    most              = fmax(most, size);
    least             = fmin(least, size);
  }
  return most / least;
}

static void a_localised_motion_lasts(const problem *g, const mhb_response *r) {
  mhb_settings             fine  = g->settings;
  mhb_integration_settings asked = {.n_frequencies = 1,
                                    .listed        = true,
                                    .frequency     = {COMPARED_AT / SHB_TWO_PI},
                                    .start         = MHB_START_FROM_BALANCE,
                                    .steps         = 64,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 4000,
                                    .harmonics     = M};
  mhb_response            *integrated;
  mhb_balance             *b;
  mhb_newton              *newton;
  static double            x[ALL], end[ALL];
  int                      localised = 0;
  fine.harmonics                     = M;
  assert_ok(
      mhb_integration_sweep(&g->dense, &g->of_dense, &asked, r, NULL, NULL, NULL, &integrated));
  assert_ok(mhb_balance_create(&g->ring->whole, &fine, &b));
  mhb_balance_set_preload(b, fine.n0[0]);
  newton                       = mhb_newton_create(b->n);
  const mhb_branch *end_states = &integrated->branch[0];
  for (int p = 0; p < end_states->n_points; p++) {
    int iterations;
    motion_of(end_states, p, end);
    memcpy(x, end, sizeof x);
    assert_int_equal(end_states->multiple[p], 1);
    assert_int_equal(
        mhb_newton_solve(newton, b, SHB_TWO_PI * end_states->frequency[p], 1e-10, x, &iterations),
        MHB_CONVERGED);
    print_message("contacts differ by a factor of %.2f; integration from the balance: %.1e\n",
                  spread(x), distance(end, x));
    assert_below(distance(end, x), 1e-5);
    localised += spread(x) > 5;
  }
  assert_true(localised > 0);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  mhb_response_destroy(integrated);
}

static void equal_blades_have_a_localised_motion(void **state) {
  static const double none[N] = {0};
  problem             g;
  (void)state;
  make(&g, none);
  mhb_response     *r    = sweep(&g);
  const mhb_branch *main = &r->branch[2], *found = found_branch(r);
  char              text[MHB_RING_TEXT];
  for (int p = 0; p < main->n_points; p++) {
    assert_int_equal(main->ring_kind[p], MHB_RING_WAVE);
    assert_near(main->ring_participation[p], 1, 1e-9);
  }
  assert_non_null(found);
  int stable = 0, least = mhb_ring_most_localised(r, found);
  for (int p = 0; p < found->n_points; p++)
    stable += found->stable[p] == 1 && found->ring_kind[p] == MHB_RING_LOCALISED;
  mhb_ring_describe(r, found, text);
  print_message("%d points, %d localised and stable; %s\n", found->n_points, stable, text);
  assert_int_equal(found->ring_kind[least], MHB_RING_LOCALISED);
  assert_near(found->ring_participation[least] * N, 2, 0.1); /* two blades */
  assert_true(stable > 10);
  assert_true(strstr(text, "localised: 2.0") == text);
  assert_true(strstr(found->reason, "joins") == found->reason); /* it leaves the wave */
  a_localised_motion_lasts(&g, r);
  /* one order closes around the ring as a wave, the other does not: both were looked for */
  assert_int_equal(main->n_searches, 2);
  for (int i = 0; i < 2; i++) {
    assert_int_equal(main->search[i].starts, STARTS);
    assert_int_equal(main->search[i].order, i + 1);
    assert_int_equal(main->search[i].seed, 1000 * (i + 1) + 1);
  }
  mhb_response_destroy(r);
  drop(&g);
}

/* No two of the branches are the same motion turned or shifted. */
static void a_turned_motion_counts_once(void **state) {
  static const double none[N] = {0};
  problem             g;
  mhb_balance        *b;
  mhb_newton         *newton;
  mhb_solution_set    set = {0};
  (void)state;
  make(&g, none);
  g.settings.search.starts   = 60;
  g.settings.search.n_orders = 1;
  mhb_response *r            = sweep(&g);
  assert_ok(mhb_balance_create(&g.ring->whole, &g.settings, &b));
  mhb_balance_set_preload(b, g.settings.n0[0]);
  newton    = mhb_newton_create(b->n);
  int found = 0;
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *c = &r->branch[i];
    const int         p = c->n_points / 3, K = c->n_harmonics + 1;
    double            x[b->n], copy[b->n];
    int               iterations;
    if (c->origin != MHB_FROM_SEARCH) continue;
    for (int row = 0; row < 3 * N; row++)
      for (int k = 0; k <= b->m; k++) {
        const double complex a =
            k < K ? c->motion[((size_t)p * 3 * N + (size_t)row) * (size_t)K + (size_t)k] : 0;
        x[row * b->nb + (k ? 2 * k - 1 : 0)] = creal(a);
        if (k) x[row * b->nb + 2 * k] = cimag(a);
      }
    const double omega = SHB_TWO_PI * c->frequency[p];
    assert_int_equal(mhb_newton_solve(newton, b, omega, 1e-10, x, &iterations), MHB_CONVERGED);
    set.n_solutions = 0;
    mhb_solution_set_add_copies(&set, b, x);
    assert_true(set.n_solutions > 1 && N % set.n_solutions == 0); /* 3: it repeats half way round */
    for (int j = 0; j < set.n_solutions; j++) { /* each of its copies is a solution */
      double r_of[b->n];
      memcpy(copy, set.x + (size_t)j * (size_t)b->n, sizeof copy);
      mhb_balance_evaluate(b, copy, omega, r_of, NULL, NULL);
      assert_below(mhb_norm(r_of, b->n), 1e-9 * mhb_norm(copy, b->n));
    }
    found++;
  }
  print_message("%d branches from %d starts\n", found, r->branch[2].search[0].starts);
  assert_true(found >= 1);
  assert_true(found < N); /* the starts find the same motions at other blades as well */
  mhb_solution_set_free(&set);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  mhb_response_destroy(r);
  drop(&g);
}

/* With blades that differ a little the localised motion is another one at every blade. */
static void different_blades_are_searched_too(void **state) {
  static const double deviation[N] = {0, 2e-4, -1e-4, 0, 1e-4, -2e-4};
  problem             g;
  (void)state;
  make(&g, deviation);
  g.settings.search.n_orders = 1;
  mhb_response *r            = sweep(&g);
  int           found        = 0;
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    const int         p = mhb_ring_most_localised(r, b);
    if (b->origin == MHB_FROM_SEARCH && b->ring_kind[p] == MHB_RING_LOCALISED) found++;
  }
  print_message("%d localised branches of different blades\n", found);
  assert_true(found >= 1);
  mhb_response_destroy(r);
  drop(&g);
}

/* Forty blades that differ have localised motions without end: curves wander from blade to blade.
 * No curve is longer than mhb.max_points, whether a search found it or not, and all starts are
 * tried. */
static void many_blades_are_searched_within_bounds(void **state) {
  enum { BLADES = 40, FEW = 30, POINTS = 100 };
  double             deviation[BLADES];
  unsigned long long seed = 1;
  problem            g;
  mhb_response      *r = NULL;
  (void)state;
  for (int i = 0; i < BLADES; i++) deviation[i] = 1e-4 * random_unit(&seed);
  make_ring(&g, BLADES, 5, deviation);
  g.settings.search.n_orders = 1;
  g.settings.search.starts   = FEW;
  g.settings.max_points      = POINTS;
  g.settings.stability       = MHB_STABILITY_NEVER;
  assert_int_equal(mhb_forced_response(&g.ring->whole, &g.settings, NULL, NULL, NULL, &r),
                   SHB_NOT_CONVERGED);
  const mhb_branch *main = &r->branch[2];
  int               cut = 0, found = 0;
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    assert_true(b->n_points <=
                2 * POINTS); /* a curve is traced both ways from where it was found */
    cut += strstr(b->reason, "mhb.max_points reached") != NULL;
    found += b->origin == MHB_FROM_SEARCH;
  }
  print_message("%d curves, %d found by %d starts, %d cut at %d points\n", r->n_branches - 2, found,
                main->search[0].starts, cut, POINTS);
  assert_true(cut >= 1 && found >= 1);
  assert_int_equal(main->n_searches, 1);
  assert_int_equal(main->search[0].starts, FEW);
  mhb_response_destroy(r);
  drop(&g);
}

/* What searches find has ten times the points of the main curve in all, and what is not traced is
 * counted. Without that bound a curve goes on to 20000 points, 24 of them together. */
static void searched_curves_share_their_points(void **state) {
  enum { BLADES = 40, FEW = 30, POINTS = 20 };
  double             deviation[BLADES];
  unsigned long long seed = 1;
  problem            g;
  mhb_response      *r       = NULL;
  quiet_monitor      monitor = quiet_monitor_create(0);
  (void)state;
  for (int i = 0; i < BLADES; i++) deviation[i] = 1e-4 * random_unit(&seed);
  make_ring(&g, BLADES, 5, deviation);
  g.settings.search.n_orders = 1;
  g.settings.search.starts   = FEW;
  g.settings.stability       = MHB_STABILITY_NEVER;
  g.settings.max_points      = POINTS;
  assert_ok(main_curve(&g.ring->whole, &g.settings, SEARCH_HARMONICS, NULL, &r));
  const int most        = 10 * r->branch[0].n_points;
  g.settings.max_points = 20000;
  assert_ok(mhb_secondary_branches(&g.ring->whole, &g.settings, r, &monitor.base));
  int points = 0, used_up = 0;
  for (int i = 1; i < r->n_branches; i++) {
    points += r->branch[i].n_points;
    used_up += strstr(r->branch[i].reason, "used up") != NULL && !r->branch[i].complete;
  }
  const mhb_search *search = &r->branch[0].search[0];
  print_message("%d of %d points, %d found, %d cut, %d not traced\n", points, most, search->found,
                used_up, search->untraced);
  assert_in_range(points, 1, most + 2); /* a curve may have one more at each end */
  assert_true(used_up > 0);
  assert_int_equal(search->starts, FEW);
  mhb_response_destroy(r);
  drop(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(equal_blades_have_a_localised_motion),
                                     cmocka_unit_test(a_turned_motion_counts_once),
                                     cmocka_unit_test(different_blades_are_searched_too),
                                     cmocka_unit_test(many_blades_are_searched_within_bounds),
                                     cmocka_unit_test(searched_curves_share_their_points)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
