/* Pages of solved responses: what they draw at a point is what the file holds. With "keep": pages
 * and files for test_point_numbers.py. */
#include "mesh/base/constants.h"
#include "mhb/amplification/ring_response.h"
#include "mhb/branches/forced_response.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "modal/hdf5/h5.h"
#include "postproc/report/contact_points.h"
#include "postproc/report/publish.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/random_model.h"

enum { BLADES = 4, PAIRS = 3, HARMONICS = 5 };

static const shb_provenance NONE = {
    .case_path = "test.yaml", .case_text = "test", .settings = "test = 1\n", .command = "test"};

typedef enum { WAVE, EQUAL_RING, RING, DISC } kind;

typedef struct {
  const char *name;
  kind        kind;
  int         sides;   /* contact interfaces */
  int         order;   /* periods of the excitation in one of the motion */
  double      n0;      /* N; 0: that of the settings */
  bool        pressed; /* the preload is an interference */
} scene;

static const scene scenes[] = {
    {"wave", WAVE, 1, 1, 0, false},   {"equal", EQUAL_RING, 1, 1, 0, false},
    {"ring", RING, 1, 1, 0, false},   {"sides", WAVE, 2, 1, 0, false},
    {"parted", RING, 2, 1, 0, false}, {"disc", DISC, 1, 1, 0, false},
    {"gap", WAVE, 1, 1, -0.2, false}, {"pressed", WAVE, 1, 1, 0, true},
    {"doubled", WAVE, 1, 2, 0, false}};

enum { SCENES = sizeof scenes / sizeof *scenes };

typedef struct {
  modal_model           model;
  modal_nodal_diameters waves; /* of a disc; model is then empty */
  lumped_disc           disc;
  mhb_settings          settings;
  mhb_mistuned_ring    *ring;
  mhb_response         *response;
} solved;

/* The first pair is the shroud, the others are the snubber, with numbers of its own. */
static void part(modal_model *model, mhb_settings *s) {
  static const char *const name[] = {"shroud", "snubber"};
  model->n_interfaces             = 2;
  model->interface                = calloc(PAIRS, sizeof(int));
  model->interface_name           = malloc(2 * sizeof(char *));
  for (int a = 1; a < PAIRS; a++) model->interface[a] = 1;
  s->n_interfaces = 2;
  for (int i = 0; i < 2; i++) {
    mhb_interface *own       = &s->interface[i];
    model->interface_name[i] = strdup(name[i]);
    *own = (mhb_interface){.mu = s->mu, .kv = s->kv, .n_preloads = 1, .n0 = {s->n0[0]}};
    memcpy(own->ku, s->ku, sizeof own->ku);
    snprintf(own->name, sizeof own->name, "%s", name[i]);
  }
  s->interface[1].mu    = 0.23;
  s->interface[1].kv    = 0.55;
  s->interface[1].ku[0] = 0.65;
  s->interface[1].n0[0] = 0.17;
}

static void set_up(const scene *c, solved *s) {
  const double equal[BLADES] = {0}, differ[BLADES] = {0.008, -0.013, 0.004, -0.002};
  *s = (solved){.settings = random_settings(HARMONICS)};
  if (c->kind == DISC) {
    s->disc = lumped_disc_of(0.8, 1.7);
    lumped_disc_waves(&s->disc, DISC_DOFS, &s->waves);
    s->settings                 = lumped_disc_settings(3, HARMONICS);
    s->settings.nodal_diameters = &s->waves;
    s->settings.scale           = 5;
    s->settings.frequency[0]    = 0.88 / SHB_TWO_PI;
    s->settings.frequency[1]    = 0.98 / SHB_TWO_PI;
  } else {
    random_model(PAIRS, WITH_LEFT | WITH_AREAS, 3, &s->model);
    if (c->sides > 1) part(&s->model, &s->settings);
    s->settings.blades       = BLADES;
    s->settings.scale        = 2;
    s->settings.frequency[0] = 1.35 / SHB_TWO_PI;
    s->settings.frequency[1] = 1.45 / SHB_TWO_PI;
  }
  if (c->n0 != 0) s->settings.n0[0] = c->n0;
  if (c->pressed) s->settings.preload = MHB_INTERFERENCE;
  if (c->order > 1) {
    s->settings.subharmonics = c->order;
    s->settings.engine_order = c->order; /* its wave closes around the ring */
    s->settings.harmonics *= c->order;
  }
  s->settings.tolerance = 1e-8;
  s->settings.stability = MHB_STABILITY_NEVER;
  if (c->kind == EQUAL_RING || c->kind == RING)
    assert_ok(mhb_mistuned_ring_create(&s->model, &s->settings, c->kind == RING ? differ : equal, 1,
                                       &s->ring));
}

static void solve(const scene *c, const char *path, solved *s) {
  shb_progress quiet = shb_progress_start("test", true, false);
  set_up(c, s);
  mhb_settings all = s->settings;
  all.ring         = s->ring;
  if (s->ring)
    assert_ok(mhb_ring_response(&all, NULL, path, path ? &NONE : NULL, &quiet, &s->response));
  else
    assert_ok(mhb_forced_response(c->kind == DISC ? &s->waves.model[0] : &s->model, &all, path,
                                  path ? &NONE : NULL, &quiet, &s->response));
}

static void solved_free(solved *s) {
  mhb_response_destroy(s->response);
  mhb_mistuned_ring_destroy(s->ring);
  modal_nodal_diameters_free(&s->waves);
  modal_model_free(&s->model);
}

/* Loops of all points of a response, and those of them that are not drawn. */
static int undrawn(const solved *s, const double *area, int *loops) {
  post_analysis    *a;
  post_contact_plan plan;
  int               empty = 0;
  *loops                  = 0;
  assert_ok(post_analysis_create(s->response, &a));
  a->settings = &s->settings;
  a->area     = area;
  assert_ok(post_contact_points(a, &plan));
  for (int b = 0; b < s->response->n_branches; b++) {
    const int   n    = s->response->branch[b].n_points;
    int        *kept = calloc((size_t)n + 1, sizeof *kept);
    post_buffer out  = {0};
    for (int i = 0; i < n; i++) kept[i] = i;
    assert_ok(post_put_contact_points(a, &plan, b, n, kept, &out));
    const char *at = out.text ? strstr(out.text, "\"loops\":[") + 8 : NULL;
    for (; at && at[1] == '['; at = strchr(at, ']') + 1, ++*loops) empty += at[2] == '0';
    post_buffer_free(&out);
    free(kept);
  }
  post_contact_plan_free(&plan);
  post_analysis_destroy(a);
  return empty;
}

/* Where areas differ, a law of equal shares is another one. */
static void every_loop_has_the_forces_of_the_file(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    solved s;
    int    loops;
    solve(&scenes[i], NULL, &s);
    const double *area  = s.ring ? s.ring->whole.area : s.model.area;
    const int     empty = undrawn(&s, area, &loops);
    const int     other = undrawn(&s, NULL, &loops);
    print_message("%s: %d of %d loops are not drawn, with equal shares %d\n", scenes[i].name, empty,
                  loops, other);
    assert_true(loops > 20);
    assert_int_equal(empty, 0);
    if (area) assert_true(other > loops / 4);
    solved_free(&s);
  }
}

/* ---------------------------------------------------------------- pages */

static void write_modal(const char *path, const solved *s) {
  hid_t file;
  assert_ok(h5_create(path, &file));
  if (s->waves.n > 0) {
    assert_ok(h5_write_provenance(file, "shroudhb modal model", 3, &NONE));
    assert_ok(modal_nodal_diameters_write(file, &s->waves));
  } else {
    assert_ok(modal_model_write(file, &s->model, &NONE));
  }
  assert_ok(h5_close(file));
}

/* What a reader of the file must know of the case: {"mu": [of each interface], ...}. */
static void write_case(const char *path, const scene *c, const solved *s) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, "{\"blades\": %d, \"order\": %d, \"pressed\": %s, \"area\": [",
          s->ring ? BLADES : 1, c->order, c->pressed ? "true" : "false");
  for (int a = 0; a < s->model.n_pairs; a++)
    fprintf(file, "%s%.17g", a ? ", " : "", s->model.area[a]);
  fprintf(file, "], \"interfaces\": [");
  for (int i = 0; i < c->sides; i++) {
    const mhb_settings  *all = &s->settings;
    const mhb_interface *own = &all->interface[i];
    const bool           one = c->sides < 2;
    fprintf(file, "%s{\"mu\": %.17g, \"kv\": %.17g, \"n0\": %.17g}", i ? ", " : "",
            one ? all->mu : own->mu, one ? all->kv : own->kv, one ? all->n0[0] : own->n0[0]);
  }
  fprintf(file, "]}\n");
  assert_int_equal(fclose(file), 0);
}

static void keep(const scene *c) {
  shb_progress             quiet = shb_progress_start("test", true, false);
  char                     path[6][64];
  solved                   s;
  static const char *const suffix[] = {"response.h5", "modal.h5", "html", "csv", "svg", "json"};
  for (int i = 0; i < 6; i++) snprintf(path[i], sizeof path[i], "%s.%s", c->name, suffix[i]);
  solve(c, path[0], &s);
  write_modal(path[1], &s);
  write_case(path[5], c, &s);
  const post_job job = {.case_name = c->name,
                        .response  = path[0],
                        .modal     = path[1],
                        .html      = path[2],
                        .csv       = path[3],
                        .svg       = path[4],
                        .settings  = &s.settings};
  assert_ok(post_publish(&job, &quiet, NULL));
  solved_free(&s);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_loop_has_the_forces_of_the_file)};
  if (argc > 1 && strcmp(argv[1], "keep") == 0) {
    for (int i = 0; i < SCENES; i++) keep(&scenes[i]);
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
