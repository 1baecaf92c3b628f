/* Sliding loses stability because the friction limit follows the normal load. The contact of a ring
 * is blended from the limit mu n to the limit mu n0, as two contacts at one place:
 *   pair 0: load n0 + share kv v, friction
 *   pair 1: load 2 n0 + (1 - share) kv v, none
 * Both stay closed, so together they press with kv v for every share. */
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { HARMONICS = 7, SUBSTEPS = 128, MOST = 400, UNKNOWNS = 6 * (2 * HARMONICS + 1) };

static const double MU = 0.4, KV = 0.8, KU = 0.5, N0 = 0.1;

/* A lightly damped ring, its contact once. */
static void light_ring(unsigned seed, modal_model *model) {
  random_model(1, WITH_LEFT, seed, model);
  for (int i = 0; i < model->n_modes; i++) model->damping_ratio[i] = 0.001;
}

static double *twice(double *rows, size_t n) {
  double *both = realloc(rows, 2 * n * sizeof *both);
  memcpy(both + n, both, n * sizeof *both);
  return both;
}

static void double_contact(modal_model *model) {
  size_t n                 = 3 * (size_t)model->n_modes;
  model->right             = twice(model->right, n);
  model->left              = twice(model->left, n);
  model->n_pairs           = 2;
  model->n_interfaces      = 2;
  model->interface         = calloc(2, sizeof(int));
  model->interface[1]      = 1;
  model->interface_name    = malloc(2 * sizeof(char *));
  model->interface_name[0] = strdup("friction");
  model->interface_name[1] = strdup("spring");
}

static mhb_settings lone(void) {
  mhb_settings s = ground_settings(MU, KV, KU, N0, HARMONICS);
  s.to_ground    = false;
  s.blades       = 6;
  s.engine_order = 1;
  return s;
}

static mhb_settings blend(double share) {
  mhb_settings s = lone();
  s.kv           = share * KV;
  s.n_interfaces = 2;
  s.interface[0] = (mhb_interface){
      .name = "friction", .mu = MU, .kv = s.kv, .ku = {KU, 0, KU}, .n_preloads = 1, .n0 = {N0}};
  s.interface[1] = (mhb_interface){
      .name = "spring", .kv = KV - s.kv, .ku = {KU, 0, KU}, .n_preloads = 1, .n0 = {2 * N0}};
  return s;
}

/* Largest modulus of the wave at omega. x holds the solution: a guess unless cold, and the result.
 * Fails the test where a contact opens or nothing slips. */
static double largest(const modal_model *model, const mhb_settings *s, double omega, bool cold,
                      double *x) {
  periodic       p;
  double complex mu[MOST];
  periodic_create(model, s, omega, cold ? NULL : x, &p);
  memcpy(x, p.x, sizeof *x * (size_t)p.residual->n);
  mhb_multipliers out = periodic_multipliers(&p, SUBSTEPS, mu);
  for (int a = 0; a < model->n_pairs; a++)
    assert_true(p.residual->eval->info[a].share[MHB_SEPARATE] == 0);
  assert_true(p.residual->eval->info[0].share[MHB_SLIDE] > 0.1);
  periodic_destroy(&p);
  return out.largest;
}

static double at_share(const modal_model *model, double share, double omega, double *x) {
  mhb_settings s = blend(share);
  return largest(model, &s, omega, false, x);
}

/* Share at which the largest modulus passes 1, from x at share 1. x ends at share 0, whose modulus
 * is `still`. */
static double crossing_of(const modal_model *model, double omega, double *x, double *still) {
  double low = 1, high = 1, at[UNKNOWNS];
  while (at_share(model, low, omega, x) > 1) {
    assert_true(low > 0.05);
    high = low;
    low -= 0.1;
    memcpy(at, x, sizeof at);
  }
  double share = low - 0.1;
  for (int i = 0; i < 8; i++) {
    double middle = 0.5 * (low + high);
    if (at_share(model, middle, omega, at) > 1)
      high = middle;
    else
      low = middle;
  }
  for (; share > 0.05; share -= 0.1) assert_below(at_share(model, share, omega, x), 1);
  *still = at_share(model, 0, omega, x);
  return 0.5 * (low + high);
}

static void a_limit_that_follows_the_load_ends_stability(void **state) {
  (void)state;
  static const struct {
    unsigned seed;
    double   omega;
  } rows[] = {{1, 1.05}, {2, 0.9}, {2, 1.3}, {2, 1.4}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    modal_model  model;
    double       x[UNKNOWNS], still;
    mhb_settings one = lone(), two = blend(1);
    light_ring(rows[i].seed, &model);
    double alone = largest(&model, &one, rows[i].omega, true, x);
    double_contact(&model);
    double follows = largest(&model, &two, rows[i].omega, true, x);
    double share   = crossing_of(&model, rows[i].omega, x, &still);
    print_message("ring %u, %.2f rad/s: %.5f (one contact %.5f), 1 at share %.3f, %.5f at 0\n",
                  rows[i].seed, rows[i].omega, follows, alone, share, still);
    assert_near(follows, alone, 1e-5);
    assert_true(follows > 1.005);
    assert_true(share > 0.1 && share < 0.99);
    assert_below(still, 1);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_limit_that_follows_the_load_ends_stability),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
