/* Several contact interfaces: against one where they are one, against time integration, derivatives
 * against differences, files. */
#include "mhb/problem/interfaces.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mhb/branches/forced_response.h"
#include "mhb/branches/main_branch.h"
#include "mhb/integration/steady_state.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

/* A random model whose pair a belongs to interface a % 2. "mid" is the first interface of the
 * settings and the second of the model. */
static void two_faced_model(int n_pairs, int parts, unsigned long long seed, modal_model *model) {
  random_model(n_pairs, parts, seed, model);
  model->n_interfaces   = 2;
  model->interface      = malloc((size_t)n_pairs * sizeof(int));
  model->interface_name = malloc(2 * sizeof(char *));
  for (int a = 0; a < n_pairs; a++) model->interface[a] = a % 2;
  model->interface_name[0] = strdup("shroud");
  model->interface_name[1] = strdup("mid");
}

/* Of a lone interface. */
static void forget_interfaces(modal_model *model) {
  for (int i = 0; i < 2; i++) free(model->interface_name[i]);
  free(model->interface_name);
  free(model->interface);
  model->interface      = NULL;
  model->interface_name = NULL;
  model->n_interfaces   = 0;
}

static mhb_interface interface_of(const char *name, const mhb_settings *s, double share) {
  mhb_interface out = {
      .mu = s->mu, .kv = share * s->kv, .n_preloads = s->n_preloads, .psi = s->psi, .phi = s->phi};
  snprintf(out.name, sizeof out.name, "%s", name);
  for (int i = 0; i < 3; i++) out.ku[i] = share * s->ku[i];
  for (int i = 0; i < s->n_preloads; i++) out.n0[i] = share * s->n0[i];
  return out;
}

static void lead_with(mhb_settings *s, int lead) {
  const mhb_interface *own = &s->interface[lead];
  s->lead                  = lead;
  s->mu                    = own->mu;
  s->kv                    = own->kv;
  s->n_preloads            = own->n_preloads;
  memcpy(s->ku, own->ku, sizeof s->ku);
  memcpy(s->n0, own->n0, sizeof s->n0);
}

/* mid: mu .4, ..., as random_settings; shroud: its own mu, n0. */
static mhb_settings two_settings(int harmonics, double mu, double n0, double stiffness) {
  mhb_settings s       = random_settings(harmonics);
  s.interface[0]       = interface_of("mid", &s, 1);
  s.interface[1]       = interface_of("shroud", &s, stiffness);
  s.n_interfaces       = 2;
  s.interface[1].mu    = mu;
  s.interface[1].n0[0] = n0;
  lead_with(&s, 0);
  return s;
}

/* Greatest difference relative to the greatest value. */
static double apart(int n, const double *a, const double *b) {
  double worst = 0, size = 0;
  for (int i = 0; i < n; i++) {
    worst = fmax(worst, fabs(a[i] - b[i]));
    size  = fmax(size, fabs(b[i]));
  }
  return worst / size;
}

/* Halves of one whole, each with its share of the stiffnesses and the preload. */
static void halves_make_a_whole(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings whole = random_settings(5), halves = whole;
  two_faced_model(4, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 7, &model);
  double own[2]       = {model.area[1] + model.area[3], model.area[0] + model.area[2]};
  halves.n_interfaces = 2;
  halves.interface[0] = interface_of("mid", &whole, own[0] / (own[0] + own[1]));
  halves.interface[1] = interface_of("shroud", &whole, own[1] / (own[0] + own[1]));
  lead_with(&halves, 0);
  for (double omega = .9; omega < 1.6; omega += .3) {
    periodic a, b;
    periodic_create(&model, &halves, omega, NULL, &a);
    modal_model one  = model;
    one.n_interfaces = 0;
    periodic_create(&one, &whole, omega, NULL, &b);
    double difference = apart(a.residual->n, a.x, b.x);
    print_message("omega %.1f: halves and whole differ by %.1e; slipping %.2f, open %.2f\n", omega,
                  difference, a.residual->eval->info[0].share[MHB_SLIDE],
                  a.residual->eval->info[0].share[MHB_SEPARATE]);
    assert_small(difference, 1e-12);
    periodic_destroy(&a);
    periodic_destroy(&b);
  }
  modal_model_free(&model);
}

/* The model's pair `at` alone. */
static void only_pair(const modal_model *model, int at, modal_model *out) {
  const size_t m = (size_t)model->n_modes, all = 6 * (size_t)model->n_pairs;
  *out              = *model;
  out->n_pairs      = 1;
  out->n_interfaces = 0;
  out->right += 3 * m * (size_t)at;
  out->left += 3 * m * (size_t)at;
  out->normal += 3 * at;
  int dof[6];
  for (int i = 0; i < 6; i++) dof[i] = (i / 3 * model->n_pairs + at) * 3 + i % 3;
  const double  *from[] = {model->residual_flexibility, model->residual_inertia,
                           model->residual_fourth};
  double **const to[] = {&out->residual_flexibility, &out->residual_inertia, &out->residual_fourth};
  for (int t = 0; t < 3; t++) {
    *to[t] = malloc(36 * sizeof(double));
    for (int i = 0; i < 36; i++)
      (*to[t])[i] = from[t][(size_t)dof[i / 6] * all + (size_t)dof[i % 6]];
  }
  const double complex  *load[]    = {model->load_residual, model->load_inertia};
  double complex **const load_to[] = {&out->load_residual, &out->load_inertia};
  for (int t = 0; t < 2; t++) {
    *load_to[t] = malloc(6 * (size_t)(model->n_load + 1) * sizeof **load_to[t]);
    for (int i = 0; i < 6 * (model->n_load + 1); i++)
      (*load_to[t])[i] = load[t][(size_t)(i / 6) * all + (size_t)dof[i % 6]];
  }
  out->probe_contact_residual = out->probe_contact_inertia = NULL;
}

static void free_pair(modal_model *one) {
  free(one->residual_flexibility);
  free(one->residual_inertia);
  free(one->residual_fourth);
  free(one->load_residual);
  free(one->load_inertia);
}

/* What never meets is not there. */
static void an_open_one_is_none(void **state) {
  (void)state;
  modal_model  model, one;
  mhb_settings two = two_settings(5, .2, -1e3, 1.7), single = random_settings(5);
  two_faced_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 11, &model);
  only_pair(&model, 1, &one);
  int slips = 0;
  for (double omega = .8; omega < 1.9; omega += .15) {
    periodic a, b;
    periodic_create(&model, &two, omega, NULL, &a);
    periodic_create(&one, &single, omega, a.x + a.residual->n / 2, &b);
    slips += b.residual->eval->kind[0] == MHB_PAIR_NONLINEAR;
    assert_true(a.residual->eval->info[0].share[MHB_SEPARATE] == 1);
    assert_small(apart(b.residual->n, a.x + b.residual->n, b.x), 1e-12);
    periodic_destroy(&a);
    periodic_destroy(&b);
  }
  assert_true(slips > 2);
  free_pair(&one);
  modal_model_free(&model);
}

/* dr/dparameter at a motion that slips and opens, by central differences. */
static double slope_error(mhb_balance *b, const double *x, mhb_parameter parameter) {
  const int n  = b->n;
  double    at = mhb_parameter_get(&b->eval->at, parameter), h = 1e-4 * fmax(fabs(at), .1);
  double    r[4][n], slope[n], wanted[n], J[(size_t)n * (size_t)n];
  mhb_balance_set_parameter(b, parameter);
  mhb_balance_evaluate(b, x, at, r[0], J, slope);
  for (int i = 0; i < 4; i++)
    mhb_balance_evaluate(b, x, at + (i < 2 ? i - 2 : i - 1) * h, r[i], NULL, NULL);
  for (int i = 0; i < n; i++)
    wanted[i] = (r[0][i] - 8 * r[1][i] + 8 * r[2][i] - r[3][i]) / (12 * h);
  mhb_balance_evaluate(b, x, at, r[0], NULL, NULL);
  return apart(n, slope, wanted);
}

static void slopes_are_exact(void **state) {
  (void)state;
  static const mhb_parameter parameters[] = {MHB_IN_N0, MHB_IN_MU, MHB_IN_KU, MHB_IN_KV,
                                             MHB_IN_SCALE};
  modal_model                model;
  two_faced_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 5, &model);
  for (int which = 0; which < 4; which++)
    for (int p = 0; p < 5; p++) {
      mhb_settings       s = two_settings(4, .23, .11, 1.7);
      mhb_balance       *b;
      unsigned long long seed = 3;
      double             x[2 * 3 * 9];
      s.parameter = parameters[p];
      s.together  = which % 2;
      lead_with(&s, which / 2);
      s.range[0] = -10, s.range[1] = 10;
      assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_OK);
      for (int i = 0; i < b->n; i++) x[i] = (i % 9 ? .5 : .1) * random_unit(&seed) / (1 + i % 9);
      double error = slope_error(b, x, parameters[p]);
      if (!(b->eval->kind[0] == MHB_PAIR_NONLINEAR && b->eval->kind[1] == MHB_PAIR_NONLINEAR))
        fail_msg("kinds %d %d", b->eval->kind[0], b->eval->kind[1]);
      assert_true(b->eval->kind[0] == MHB_PAIR_NONLINEAR && b->eval->kind[1] == MHB_PAIR_NONLINEAR);
      if (p < 4 && which == 0)
        print_message("%s: slope %.1e\n", mhb_parameter_name(parameters[p]), error);
      assert_small(error, 1e-7);
      if (p == 0) { /* all preloads alike, as on the way to a first solution */
        mhb_balance_tie_preloads(b, 1);
        assert_small(slope_error(b, x, MHB_IN_N0), 1e-7);
        double before = b->law[0].n0 - b->law[1].n0;
        mhb_balance_set_value(b, 3.3);
        assert_small(b->law[0].n0 - b->law[1].n0 - before, 1e-14);
        assert_small(b->law[model.interface[0] == 0 ? 1 - which / 2 : which / 2].n0 - 3.3, 1e-14);
      }
      mhb_balance_destroy(b);
    }
  modal_model_free(&model);
}

/* What a pair's law is: its own interface's, shared out by area. */
static void laws_are_their_own(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = two_settings(2, .23, .11, 1.7);
  mhb_balance *b;
  two_faced_model(3, WITH_LEFT | WITH_AREAS, 5, &model);
  s.n_preloads = s.interface[0].n_preloads = s.interface[1].n_preloads = 3;
  for (int i = 0; i < 3; i++) {
    s.n0[i] = s.interface[0].n0[i] = .3 + .2 * i;
    s.interface[1].n0[i]           = .1 - .4 * i;
  }
  assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_OK);
  for (int i = 0; i < 3; i++) {
    mhb_balance_set_preload(b, s.n0[i]);
    double share = model.area[0] / (model.area[0] + model.area[2]);
    assert_small(b->law[0].n0 - share * s.interface[1].n0[i], 1e-15);
    assert_small(b->law[2].n0 - (1 - share) * s.interface[1].n0[i], 1e-15);
    assert_small(b->law[1].n0 - s.n0[i], 1e-15);
    assert_small(b->law[0].mean_offset - fmax(b->law[0].n0, 0), 0);
  }
  assert_true(b->law[0].mu == .23 && b->law[1].mu == .4 && b->law[1].kv == .8);
  assert_small(b->law[0].kv + b->law[2].kv - 1.7 * .8, 1e-15);
  mhb_balance_destroy(b);

  s.parameter  = MHB_IN_N0; /* follows: in proportion, or not at all */
  s.n_preloads = 1;
  for (s.together = 0;; s.together = 1) {
    assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_OK);
    mhb_balance_set_preload(b, .9);
    assert_small(b->law[0].n0 + b->law[2].n0 - .1 * (s.together ? 3 : 1), 1e-15);
    mhb_balance_destroy(b);
    if (s.together) break;
  }
  modal_model_free(&model);
}

/* Different friction, preload (one gap) and stiffness against a march in time, to ground and around
 * a ring. */
static void time_integration_agrees(void **state) {
  (void)state;
  for (int ring = 0; ring < 2; ring++) {
    modal_model  model;
    mhb_settings s = two_settings(31, .15, -.02, .6);
    two_faced_model(2, ring ? WITH_LEFT : 0, 19, &model);
    s.to_ground          = !ring;
    s.tolerance          = 1e-10;
    s.interface[0].n0[0] = s.n0[0] = .05;
    periodic p;
    double   omega = 1.13;
    periodic_create(&model, &s, omega, NULL, &p);
    mhb_integrator   *g;
    mhb_steady_state *orbit;
    assert_int_equal(mhb_integrator_create(&model, &s, 31, &g), SHB_OK);
    orbit = mhb_steady_state_create(g);
    mhb_integrator_set(g, omega, s.n0[0], 256);
    int             n = 3 * model.n_pairs, m = p.residual->m, nb = p.residual->nb;
    double complex *force = calloc((size_t)(n * (m + 1)), sizeof *force);
    for (int k = 0; k <= m; k++) mhb_balance_contact_force(p.residual, k, force + k * n);
    mhb_integrator_balance(g, m, force);
    free(force);
    const mhb_steady_state_result *r =
        mhb_steady_state_run(orbit, &(mhb_steady_state_settings){1e-9, 3000}, NULL, NULL);
    assert_true(r->multiple == 1 && !r->failed);
    double worst = 0, size = 0;
    for (int row = 0; row < n; row++)
      for (int k = 0; k <= m; k++) {
        const double  *x = p.x + row * nb;
        double complex b = k ? CMPLX(x[2 * k - 1], x[2 * k]) : x[0];
        worst            = fmax(worst, cabs(r->motion[row * (r->n_harmonics + 1) + k] - b));
        size             = fmax(size, cabs(b));
      }
    print_message(
        "%s: balance and integration differ by %.1e of the motion; slip %.2f %.2f, open %.2f "
        "%.2f\n",
        ring ? "ring" : "ground", worst / size, r->state[1], r->state[4], r->state[2], r->state[5]);
    assert_small(worst / size, 2e-4);
    assert_true(r->state[1] + r->state[4] > .1 && r->state[2] > .1);
    mhb_steady_state_destroy(orbit);
    mhb_integrator_destroy(g);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* Names of the model and of the settings must be the same ones. */
static void names_must_agree(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = two_settings(2, .2, .1, 1);
  mhb_balance *b;
  two_faced_model(2, WITH_LEFT, 5, &model);
  strcpy(s.interface[1].name, "tip");
  assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_ERR_INPUT);
  assert_non_null(
      strstr(shb_message(), "the contact interface 'shroud', which contact.interfaces"));
  s.n_interfaces = 0;
  assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_ERR_INPUT);
  s = two_settings(2, .2, .1, 1);
  forget_interfaces(&model);
  assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_ERR_INPUT);
  assert_non_null(
      strstr(shb_message(), "contact.interfaces has 'mid', which the modal file does not"));
  modal_model_free(&model);
}

/* A sweep over lists of preloads, its file, and the model's. */
static void files_tell_which(void **state) {
  (void)state;
  char           path[] = "/tmp/shb_interfaces_XXXXXX";
  modal_model    model, again;
  mhb_settings   s = two_settings(3, .23, .11, 1.7);
  mhb_response  *response, *read;
  shb_provenance origin = {
      .case_path = "c.yaml", .case_text = "", .settings = "a = 1\n", .command = "t"};
  hid_t file;
  close(mkstemp(path));
  two_faced_model(2, WITH_LEFT | WITH_NORMALS, 5, &model);
  assert_int_equal(h5_create(path, &file), SHB_OK);
  assert_int_equal(modal_model_write(file, &model, &origin), SHB_OK);
  assert_int_equal(h5_close(file), SHB_OK);
  assert_int_equal(modal_model_read(path, &again), SHB_OK);
  assert_int_equal(again.n_interfaces, 2);
  assert_string_equal(again.interface_name[1], "mid");
  assert_true(again.interface[0] == 0 && again.interface[1] == 1);

  s.n_preloads = s.interface[0].n_preloads = s.interface[1].n_preloads = 2;
  s.n0[1] = s.interface[0].n0[1] = .5;
  s.interface[1].n0[1]           = -.2;
  s.frequency[0] = .17, s.frequency[1] = .2;
  s.stability        = MHB_STABILITY_NEVER;
  shb_progress quiet = shb_progress_start("test", true, false);
  assert_int_equal(mhb_forced_response(&again, &s, path, &origin, &quiet, &response), SHB_OK);
  assert_int_equal(mhb_response_read(path, &read), SHB_OK);
  assert_int_equal(read->n_interfaces, 2);
  assert_string_equal(read->interface_name[0], "mid");
  assert_true(read->interface[0] == 1 && read->interface[1] == 0 && read->lead == 0);
  for (int i = 0; i < 2; i++) {
    const mhb_branch *b = &read->branch[2 + i];
    assert_true(b->n_points > 3);
    for (int p = 0; p < b->n_points; p++) {
      assert_true(b->n0[p] == s.n0[i] && b->interface_n0[2 * p] == s.n0[i]);
      assert_true(b->interface_n0[2 * p + 1] == s.interface[1].n0[i]);
    }
  }
  mhb_response_destroy(read);
  mhb_response_destroy(response);
  modal_model_free(&again);
  modal_model_free(&model);
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(laws_are_their_own),      cmocka_unit_test(halves_make_a_whole),
      cmocka_unit_test(an_open_one_is_none),     cmocka_unit_test(slopes_are_exact),
      cmocka_unit_test(time_integration_agrees), cmocka_unit_test(names_must_agree),
      cmocka_unit_test(files_tell_which)};
  return cmocka_run_group_tests_name("mhb.interfaces", tests, NULL, NULL);
}
