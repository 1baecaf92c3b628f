/* Distance of the curves of a rung from those of a finer one: secondary branches. */
#include "cases/converge/compare.h"

#include "mhb/branches/forced_response.h"
#include "tests/support/check.h"
#include "tests/support/scratch.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 3 };

static char folder[SCRATCH_PATH];

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_response *response;
  char          stem[2][2 * SCRATCH_PATH]; /* of the rung, of the reference */
} fixture;

static void set_up(fixture *f) {
  three_degree_model(&f->model);
  f->settings              = ground_settings(0.4, 0.8, 0.5, 0.3, H);
  f->settings.frequency[0] = 0.19;
  f->settings.frequency[1] = 0.239;
  f->settings.stability    = MHB_STABILITY_NEVER;
  assert_ok(mhb_forced_response(&f->model, &f->settings, NULL, NULL, NULL, &f->response));
  snprintf(f->stem[0], sizeof f->stem[0], "%s/rung", folder);
  snprintf(f->stem[1], sizeof f->stem[1], "%s/reference", folder);
}

static void tear_down(fixture *f) {
  mhb_response_destroy(f->response);
  modal_model_free(&f->model);
}

static void save(const fixture *f, const char *stem) {
  static const shb_provenance none = {"", "", "", ""};
  char                       *path = rung_response(stem);
  assert_ok(mhb_response_write(f->response, path, &none));
  free(path);
}

/* A copy of the main branch whose motion is larger by a factor becomes a secondary one. */
static void add_secondary(fixture *f, double factor) {
  const int   index = mhb_response_branch(f->response, MHB_BRANCH_NONLINEAR);
  mhb_branch *b     = &f->response->branch[index];
  b->origin         = MHB_FROM_DETACHED;
  b->main           = 2;
  b->n_harmonics    = f->response->branch[2].n_harmonics;
  b->reason         = strdup("closed");
  mhb_response_copy_points(f->response, index, f->response, 2, 0,
                           f->response->branch[2].n_points - 1);
  b        = &f->response->branch[index];
  size_t n = (size_t)b->n_points * 3 * (size_t)f->response->n_probes * (H + 1);
  for (size_t i = 0; i < n; i++) b->probe[i] *= factor;
}

static rung_error compare(const fixture *f) {
  rung_error  error;
  post_output output = {POST_PLACE_PROBE, 0, POST_WHOLE};
  case_model  source = {.model = f->model, .settings = f->settings};
  assert_ok(compare_rungs(&source, output, f->stem[0], f->stem[1], &error));
  return error;
}

/* One side lacks the secondary branch. Its points count with their distance from the main one,
 * whichever side has them. */
static void a_missing_branch_counts_with_its_distance(void **state) {
  (void)state;
  for (int of_rung = 0; of_rung < 2; of_rung++) {
    fixture f;
    set_up(&f);
    save(&f, f.stem[!of_rung]);
    add_secondary(&f, 1.5);
    save(&f, f.stem[of_rung]);
    rung_error error = compare(&f);
    print_message("branch of the %s: %.3f\n", of_rung ? "reference" : "rung", error.curve);
    assert_true(error.curve > 0.1 && error.curve < 0.6);
    tear_down(&f);
  }
}

/* Both sides have it: no distance is left. */
static void equal_branches_have_no_distance(void **state) {
  (void)state;
  fixture f;
  set_up(&f);
  add_secondary(&f, 1);
  save(&f, f.stem[0]);
  save(&f, f.stem[1]);
  assert_below(compare(&f).curve, 1e-3);
  tear_down(&f);
}

static int start(void **state) {
  (void)state;
  scratch_create(folder);
  return 0;
}

static int clean(void **state) {
  (void)state;
  scratch_remove(folder);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_missing_branch_counts_with_its_distance),
      cmocka_unit_test(equal_branches_have_no_distance),
  };
  return cmocka_run_group_tests(tests, start, clean);
}
