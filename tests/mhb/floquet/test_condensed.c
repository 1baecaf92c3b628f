/* Stuck contacts as springs of the structure. The map is that of the band of all contacts. The
 * multipliers of many contacts agree with brute force. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/floquet/bloch.h"
#include "mhb/floquet/monodromy.h"
#include "tests/support/check.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { M = 15, SUBSTEPS = 64 };

typedef struct {
  const char *name;
  int         pairs, parts;
  double      mu, n0, stiff, soft; /* times the stiffnesses, times the flexibility */
} scene;

/* What the variational problem cannot hold is taken off the model. */
static void integrable(modal_model *model) {
  free(model->residual_inertia);
  free(model->load_residual);
  free(model->load_inertia);
  model->residual_inertia = NULL;
  model->load_residual    = NULL;
  model->load_inertia     = NULL;
}

static periodic solve(const scene *s, modal_model *model) {
  mhb_settings settings = random_settings(M);
  periodic     p;
  random_model(s->pairs, s->parts, 11, model);
  integrable(model);
  int nc = 3 * s->pairs;
  for (int k = 0; (s->parts & WITH_RESIDUAL) && k < nc * nc; k++)
    model->residual_flexibility[k] *= s->soft;
  settings.to_ground = true;
  settings.blades    = 1;
  settings.mu        = s->mu;
  settings.n0[0]     = s->n0;
  settings.kv *= s->stiff;
  for (int i = 0; i < 3; i++) settings.ku[i] *= s->stiff;
  periodic_create(model, &settings, 1.1, NULL, &p);
  return p;
}

/* The map of a solution, [n][n], by either way. */
static double *map_of(const periodic *p, bool condensed, int *n) {
  mhb_modal_structure     s;
  mhb_transition_schedule t;
  mhb_contact_evaluator  *contact;
  mhb_monodromy          *d;
  const mhb_receptance   *r = p->residual->receptance;
  assert_ok(mhb_modal_structure_create(r, &p->settings, r->n_modes, MHB_STRUCTURE_WHOLE, &s));
  mhb_transition_schedule_create(1, s.pairs, 0, false, &t);
  assert_ok(mhb_contact_evaluator_create(M, M, p->settings.tolerance, &contact));
  d = mhb_monodromy_create(&s, &t, contact, M, SUBSTEPS, 2, condensed);
  assert_true(mhb_transition_schedule_set(&t, p->solution.info));
  const char *why = mhb_monodromy_set(d, &p->solution, p->omega, 2, false);
  if (why) fail_msg("%s", why);
  *n             = d->n;
  size_t  square = (size_t)d->n * (size_t)d->n;
  double *map    = malloc(sizeof *map * (square + 1));
  memcpy(map, d->M, sizeof *map * square);
  mhb_monodromy_destroy(d);
  mhb_contact_evaluator_destroy(contact);
  mhb_transition_schedule_destroy(&t);
  mhb_modal_structure_destroy(&s);
  return map;
}

/* Multipliers of a map; they are sorted by nothing. */
static void eigenvalues(int n, const double *map, double complex *value) {
  mhb_bloch bloch;
  mhb_bloch_create(1, n, &bloch);
  assert_true(mhb_bloch_multipliers(&bloch, n, map, 1, 0, value));
  mhb_bloch_destroy(&bloch);
}

/* What happens in all contacts together. */
static void tell(const periodic *p, char text[64]) {
  int seen[3][3] = {{0}}, stuck = 0;
  for (int a = 0; a < p->residual->n_pairs; a++) {
    const mhb_contact_info *info = &p->solution.info[a];
    stuck += info->n_transitions == 0 && info->share[MHB_STICK] > 0;
    for (int i = 0, n = info->n_transitions; i < n; i++)
      seen[info->transition[(i + n - 1) % n].state][info->transition[i].state]++;
  }
  snprintf(text, 64, "%d stuck, %d+%d close, %d+%d turn", stuck, seen[2][0], seen[2][1], seen[0][1],
           seen[1][0]);
}

static void same_map(void **state) {
  (void)state;
  enum { RESIDUAL = WITH_RESIDUAL, AREAS = WITH_AREAS };
  static const scene scenes[] = {
      {"3 pairs", 3, AREAS, .4, .05, 1, 1},
      {"3 pairs, flexible", 3, AREAS | RESIDUAL, .4, .05, 1, 1},
      {"5 pairs, flexible", 5, AREAS | RESIDUAL, .4, .1, 1, 1},
      {"5 pairs, soft, stiff contact", 5, AREAS | RESIDUAL, .4, .1, 10, 5},
      {"8 pairs, no friction", 8, AREAS | RESIDUAL, 0, .1, 1, 1},
      {"8 pairs, flexible", 8, AREAS | RESIDUAL, .4, .2, 1, 1},
      {"8 pairs", 8, AREAS, 3, .2, 1, 1}};
  for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
    modal_model model;
    periodic    p = solve(&scenes[i], &model);
    char        events[64];
    int         n, other;
    double     *one = map_of(&p, true, &n), *two = map_of(&p, false, &other);
    assert_int_equal(n, other);
    double complex mine[n], full[n];
    eigenvalues(n, one, mine);
    eigenvalues(n, two, full);
    double apart = 0, size = 0, off = distance_to(mine, n, full, n);
    for (int k = 0; k < n * n; k++) {
      apart = fmax(apart, fabs(one[k] - two[k]));
      size  = fmax(size, fabs(two[k]));
    }
    tell(&p, events);
    print_message("%-28s %s: %d states, map %.1e, multipliers %.1e\n", scenes[i].name, events, n,
                  apart / size, off);
    assert_near(apart / size, 0, 1e-9);
    assert_near(off, 0, 1e-9);
    free(one);
    free(two);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* mhb_floquet condenses from eight contacts on. The march is of first order in slip. */
static void by_brute_force(void **state) {
  (void)state;
  static const scene scenes[] = {
      {"8 pairs", 8, WITH_AREAS, .4, .2, 1, 1},
      {"8 pairs, flexible", 8, WITH_AREAS | WITH_RESIDUAL, .4, .2, 1, 1}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    periodic    p = solve(&scenes[i], &model);
    disturbed   d;
    char        events[64];
    disturbed_create(&model, &p.settings, p.residual, p.x, p.omega, 2000, &d);
    double complex  brute[d.n], mine[d.n];
    mhb_multipliers out = periodic_multipliers(&p, 256, mine);
    disturbed_multipliers(&d, 1e-6, brute);
    double off = distance_to(mine, out.n, brute, d.n);
    tell(&p, events);
    print_message("%-28s %s: largest %.6f, by brute force %.6f, all off by %.1e\n", scenes[i].name,
                  events, out.largest, cabs(brute[out.n_stuck]), off);
    assert_near(off, 0, 2e-3);
    disturbed_destroy(&d);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_map), cmocka_unit_test(by_brute_force)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
