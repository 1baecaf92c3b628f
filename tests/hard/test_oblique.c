/* Hard case 17: a mitred cantilever on a rigid wall. Stick, slip and lift-off over an area; contact
 * springs that become rigid, against rigid contact by time steps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/continuation/first_solution.h"
#include "tests/hard/oblique_cantilever.h"
#include "tests/hard/rigid_contact.h"
#include "tests/hard/verdict.h"
#include "tests/support/scratch.h"
#include "tests/support/settings.h"

static modal_model model;

/* Statically exact, so that both sides solve the same equations. */
static void leave_out_inertia(void) {
  void **parts[] = {(void **)&model.residual_inertia,      (void **)&model.residual_fourth,
                    (void **)&model.load_inertia,          (void **)&model.load_fourth,
                    (void **)&model.probe_contact_inertia, (void **)&model.probe_load_inertia,
                    (void **)&model.probe_contact_fourth,  (void **)&model.probe_load_fourth};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    free(*parts[i]);
    *parts[i] = NULL;
  }
  model.n_residual = 0;
}

/* Damping in proportion to the mass. Returns the second frequency of the held blade, rad/s. */
static double damp(void) {
  double held[model.n_modes];
  rigid_contact_frequencies(&model, held);
  for (int i = 0; i < model.n_modes; i++)
    model.damping_ratio[i] = OBLIQUE_DAMPING * held[1] / (SHB_TWO_PI * model.frequency[i]);
  return held[1];
}

static int make(void **state) {
  char folder[SCRATCH_PATH], line[4 * SCRATCH_PATH];
  (void)state;
  scratch_create(folder);
  oblique_cantilever_write(folder);
  snprintf(line, sizeof line, "'%s' modal --quiet '%s/oblique.yaml'", SHROUDHB, folder);
  assert_int_equal(system(line), 0);
  snprintf(line, sizeof line, "%s/oblique.modal.h5", folder);
  assert_int_equal(modal_model_read(line, &model), SHB_OK);
  scratch_remove(folder);
  leave_out_inertia();
  return 0;
}

static int clean(void **state) {
  (void)state;
  modal_model_free(&model);
  return 0;
}

static double area(void) {
  double sum = 0;
  for (int a = 0; a < model.n_pairs; a++) sum += model.area[a];
  return sum;
}

/* The balance with springs of some stiffness, and its solutions at the last two. */
typedef struct {
  int     harmonics, n;
  double  omega, stiffness, before; /* rad/s, N/m in all */
  double *x, *x_before;             /* [n]; NULL: none yet */
  int     solves, failed;
} spring_path;

static mhb_balance *balance_with(const spring_path *path, double stiffness, mhb_settings *s) {
  mhb_balance *b;
  *s =
      ground_settings(OBLIQUE_MU, stiffness, stiffness, OBLIQUE_PRESSURE * area(), path->harmonics);
  assert_int_equal(mhb_balance_create(&model, s, &b), SHB_OK);
  mhb_balance_set_preload(b, s->n0[0]);
  return b;
}

/* One step to a stiffness, from the line through the last two solutions over the compliance. */
static bool step_to(spring_path *path, double stiffness, double complex probe[3]) {
  mhb_settings s;
  mhb_newton  *newton;
  mhb_balance *b = balance_with(path, stiffness, &s);
  int          iterations, n = b->n;
  double      *x = calloc((size_t)n, sizeof *x);
  newton         = mhb_newton_create(n);
  mhb_reason status;
  if (!path->x) {
    status = mhb_first_solution(newton, b, path->omega, 1e-10, x, &iterations);
  } else {
    double share = path->x_before ? (1 / stiffness - 1 / path->stiffness) /
                                        (1 / path->stiffness - 1 / path->before)
                                  : 0;
    for (int i = 0; i < n; i++)
      x[i] = path->x[i] + (path->x_before ? share * (path->x[i] - path->x_before[i]) : 0);
    status = mhb_newton_solve(newton, b, path->omega, 1e-10, x, &iterations);
  }
  path->solves++;
  if (status == MHB_CONVERGED) {
    double complex force[3 * b->n_pairs];
    mhb_balance_evaluate(b, x, path->omega, newton->r, NULL, NULL);
    mhb_balance_contact_force(b, 1, force);
    mhb_balance_update_probes(b, 1);
    mhb_receptance_probe(b->receptance, 1, force, probe);
    free(path->x_before);
    path->x_before  = path->x;
    path->before    = path->stiffness;
    path->x         = x;
    path->stiffness = stiffness;
  } else {
    free(x);
    path->failed++;
  }
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  return status == MHB_CONVERGED;
}

/* First harmonic of the probe at a stiffness, by steps as long as Newton's method allows. */
static void stiffen(spring_path *path, double stiffness, double complex probe[3]) {
  double factor = path->x ? stiffness / path->stiffness : 1;
  while (path->stiffness < stiffness) {
    double next = path->x ? fmin(stiffness, path->stiffness * factor) : stiffness;
    if (step_to(path, next, probe)) {
      factor *= factor;
    } else {
      factor = sqrt(factor);
      assert_true(factor > 1.0005);
    }
  }
}

static double distance(const double complex a[3], const double complex b[3]) {
  double sum = 0, size = 0;
  for (int d = 0; d < 3; d++) {
    sum += pow(cabs(a[d] - b[d]), 2);
    size += pow(cabs(b[d]), 2);
  }
  return sqrt(sum / size);
}

static void march(double omega, int steps, rigid_motion *out) {
  const rigid_contact contact = {OBLIQUE_MU, OBLIQUE_PRESSURE, omega, steps, 200};
  rigid_contact_march(&model, &contact, out);
}

/* At 0.8 of the second frequency of the held blade. On average half of the strip sticks, a third
 * slips and a sixth is open. */
static void towards_rigid(void **state) {
  (void)state;
  static const double stiffness[] = {1e9, 1e10, 1e11};
  static const struct {
    int    harmonics;
    double bound[3]; /* at each stiffness */
  } rows[]           = {{3, {.4, .13, .2}}, {7, {.45, .07, .035}}};
  const double omega = .8 * damp();
  rigid_motion coarse, rigid;
  march(omega, 128, &coarse);
  march(omega, 256, &rigid);
  verdict(rigid.change, 1e-8, "17 rigid: change over a period (%.1f sweeps a step)", rigid.sweeps);
  verdict(distance(coarse.probe, rigid.probe), 1e-2, "17 rigid: 128 steps against 256");
  verdict(-fmin(fmin(rigid.stuck, rigid.slip), rigid.open), -.1,
          "17 rigid: stuck %.2f, slipping %.2f, open %.2f", rigid.stuck, rigid.slip, rigid.open);
  for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
    spring_path path = {.harmonics = rows[row].harmonics, .omega = omega};
    for (int i = 0; i < 3; i++) {
      double complex probe[3];
      stiffen(&path, stiffness[i], probe);
      verdict(distance(probe, rigid.probe), rows[row].bound[i],
              "17 %d harmonics, %.0e N/m: motion against rigid contact (%d solutions, %d failed)",
              path.harmonics, stiffness[i], path.solves, path.failed);
    }
    free(path.x);
    free(path.x_before);
  }
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(towards_rigid)};
  return cmocka_run_group_tests_name("hard.oblique", tests, make, clean);
}
