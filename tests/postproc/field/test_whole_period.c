/* A blade of the ring is blade 0 turned, at its phase: motion and stress, also of subharmonics. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "postproc/field/peak_stress.h"
#include "postproc/field/whole_period.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { NODES = 3, MODES = 2, M = 5, BLADES = 10, E = 4 };

/* A field of random numbers, with one kept point. */
typedef struct {
  double         nodes[3 * NODES], shape[MODES * 3 * NODES], stress[MODES * 6 * NODES];
  double complex amplitude[(M + 1) * MODES];
  double         frequency, scale;
  int            point, special;
  mhb_branch     branch;
  mhb_response   response;
} example;

static void fill(unsigned long long *seed, int n, double *out) {
  for (int i = 0; i < n; i++) out[i] = random_unit(seed);
}

static post_blade_field make(example *e, int order) {
  unsigned long long seed = 11;
  fill(&seed, 3 * NODES, e->nodes);
  fill(&seed, MODES * 3 * NODES, e->shape);
  fill(&seed, MODES * 6 * NODES, e->stress);
  fill(&seed, 2 * (M + 1) * MODES, (double *)e->amplitude);
  e->frequency = 124.5;
  e->scale     = 1;
  e->point     = 0;
  e->branch =
      (mhb_branch){.order = order, .n_harmonics = M, .n_points = 1, .frequency = &e->frequency};
  e->branch.modal = (mhb_modal_motion){1, 0, &e->point, e->amplitude, NULL, &e->scale};
  e->response     = (mhb_response){.n_branches = 1, .branch = &e->branch, .n_modes = MODES};
  e->response.engine_order = E;
  e->response.blades       = BLADES;
  return (post_blade_field){.n_nodes = NODES,
                            .n_modes = MODES,
                            .nodes   = e->nodes,
                            .stress  = e->stress,
                            .shape   = e->shape};
}

static double distance(int n, const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

static double size_of(const double stress[6]) {
  return fabs(post_signed_mises(stress));
}

/* The same time later in the ring: blade b at t is blade 0 at t less its lag, turned. */
static void check_blades(int order, mesh_axis axis) {
  example          e;
  post_blade_field field = make(&e, order);
  post_period      p;
  double           u[3 * NODES], s[6 * NODES], v[3 * NODES], w[6 * NODES], off = 0;
  assert_ok(post_period_create(&field, &e.response, 0, 0, axis, &p));
  assert_int_equal(p.n_harmonics, M);
  assert_near(post_period_seconds(&p), order / e.frequency, 1e-15);
  for (int b = 0; b < BLADES; b++) {
    const double t = 0.237, angle = SHB_TWO_PI * b / BLADES;
    post_period_at(&p, b, t, u, s);
    post_period_at(&p, 0, t - b * p.lag / SHB_TWO_PI, v, w);
    for (int i = 0; i < NODES; i++) {
      off = fmax(off, fabs(size_of(s + 6 * i) - size_of(w + 6 * i)));
      mesh_axis_rotate(axis, angle, v + 3 * i, v + 3 * i);
    }
    off = fmax(off, distance(3 * NODES, u, v));
  }
  print_message("order %d: motion of the blades off by %.1e\n", order, off);
  assert_true(off < 1e-12);
  /* around the ring the wave closes: blade N is blade 0 */
  post_period_at(&p, BLADES, 0.4, u, s);
  post_period_at(&p, 0, 0.4, v, w);
  assert_true(distance(3 * NODES, u, v) < 1e-12 && distance(6 * NODES, s, w) < 1e-12);
  post_period_free(&p);
}

static void every_blade_is_the_first_turned_at_its_phase(void **state) {
  (void)state;
  check_blades(1, MESH_AXIS_X);
  check_blades(1, MESH_AXIS_MY);
  check_blades(2, MESH_AXIS_Z); /* E = 4: the wave of two periods closes as it is */
  check_blades(7, MESH_AXIS_X); /* 7 divides 4 + 10 */
}

static void a_wave_that_does_not_close_is_told(void **state) {
  (void)state;
  example          e;
  post_blade_field field = make(&e, 5);
  post_period      p;
  assert_ok(post_period_create(&field, &e.response, 0, 0, MESH_AXIS_X, &p));
  assert_false(p.closes);
  post_period_free(&p);
}

/* A force n n^T turns with n. */
static void stress_turns_as_a_tensor(void **state) {
  (void)state;
  const post_period p           = {.blades = BLADES, .axis = MESH_AXIS_Y};
  double            n[3]        = {0.3, -0.5, 0.8}, s[6];
  const int         place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int c = 0; c < 6; c++) s[c] = n[place[c][0]] * n[place[c][1]];
  post_period_turn_stresses(&p, 3, 1, s);
  post_period_turn_vectors(&p, 3, 1, n);
  for (int c = 0; c < 6; c++) assert_near(s[c], n[place[c][0]] * n[place[c][1]], 1e-14);
}

static void extremes_are_those_of_the_instants(void **state) {
  (void)state;
  example          e;
  post_blade_field field = make(&e, 1);
  post_period      p;
  double           largest[NODES], moved, most = 0, greatest[NODES] = {0};
  double           u[3 * NODES], s[6 * NODES];
  assert_ok(post_period_create(&field, &e.response, 0, 0, MESH_AXIS_X, &p));
  assert_ok(post_period_extremes(&p, 16, largest, &moved));
  for (int t = 0; t < 16; t++) {
    post_period_at(&p, 0, t / 16., u, s);
    for (int i = 0; i < NODES; i++) {
      double square = 0;
      for (int d = 0; d < 3; d++) square += pow(u[3 * i + d] - p.displacement[3 * i + d], 2);
      most        = fmax(most, sqrt(square));
      greatest[i] = fmax(greatest[i], fabs(post_signed_mises(s + 6 * i)));
    }
  }
  assert_near(moved, most, 1e-14);
  for (int i = 0; i < NODES; i++) assert_near(largest[i], greatest[i], 1e-13);
  post_period_free(&p);
}

/* Finite numbers whose sums are not; no single number is beyond a double. */
static void what_is_not_finite_is_refused(void **state) {
  (void)state;
  example          e;
  post_blade_field field = make(&e, 1);
  post_period      p;
  e.shape[4] = 1.7e308;
  assert_refused(post_period_create(&field, &e.response, 0, 0, MESH_AXIS_X, &p), SHB_ERR_INPUT,
                 "the displacement, in m, of node 2 of the mesh is ");
  post_period_free(&p);
  assert_refused(post_period_of_mode(&field, 1, -1, 100, 1e-3, MESH_AXIS_X, &p), SHB_ERR_INPUT,
                 "the shape of mode 1 is not finite");
  post_period_free(&p);
  e.shape[4]  = 0.3;
  e.stress[7] = 1e300;
  assert_refused(post_period_create(&field, &e.response, 0, 0, MESH_AXIS_X, &p), SHB_ERR_INPUT,
                 "the stress, in Pa, of node 2 of the mesh is ");
  post_period_free(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_blade_is_the_first_turned_at_its_phase),
                                     cmocka_unit_test(a_wave_that_does_not_close_is_told),
                                     cmocka_unit_test(stress_turns_as_a_tensor),
                                     cmocka_unit_test(extremes_are_those_of_the_instants),
                                     cmocka_unit_test(what_is_not_finite_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
