/* Surface, modes and kept points of the page's blade, and of a sector of a disc.
 * With "keep": pages for test_page_script.py. */
#include "postproc/report/blade_view.h"

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "postproc/field/blade_skin.h"
#include "postproc/field/whole_period.h"
#include "postproc/report/report.h"
#include "postproc/report/still_blade.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

enum { MODES = 8, FORCES = 6 };

/* A bar of hexahedra 40 x 10 x 160 mm above radius 0.3 m, with bending modes of the form sin. */
static void make_field(const int cells[3], post_blade_field *f) {
  memset(f, 0, sizeof *f);
  assert_ok(box_hex((const double[]){0.04, 0.01, 0.16}, cells, &f->mesh));
  f->n_nodes = f->mesh.n_nodes;
  f->n_modes = MODES;
  f->nodes   = f->mesh.coordinates;
  f->shape   = calloc((size_t)(MODES * f->n_nodes), 3 * sizeof *f->shape);
  f->stress  = calloc((size_t)(MODES * f->n_nodes), POST_STRESSES * sizeof *f->stress);
  assert_true(f->shape && f->stress);
  for (int i = 0; i < f->n_nodes; i++) f->mesh.coordinates[3 * i + 2] += 0.3;
  for (int m = 0; m < MODES; m++)
    for (int i = 0; i < f->n_nodes; i++) {
      const double *x = f->nodes + 3 * i, t = (m + 0.5) * SHB_PI * (x[2] - 0.3) / 0.16;
      f->shape[3 * (m * f->n_nodes + i) + m % 2]          = 3 * (1 - cos(t));
      f->stress[POST_STRESSES * (m * f->n_nodes + i) + 2] = 1e12 * cos(t) * (x[m % 2] - 0.005);
    }
}

static void free_field(post_blade_field *f) {
  for (int w = 0; w < f->n_waves; w++) {
    free(f->wave[w].frequency);
    free(f->wave[w].shape);
    free(f->wave[w].stress);
  }
  free(f->wave);
  free(f->diameter);
  mesh_fe_free(&f->mesh);
  free(f->shape);
  free(f->stress);
}

/* The same bar as a sector of twelve: modes of nodal diameters 0 to 6. The second bending is a
 * quarter of a period behind the first. */
static void make_disc(const int cells[3], post_blade_field *f) {
  make_field(cells, f);
  f->blades       = 12;
  f->engine_order = 5;
  f->n_waves      = 7;
  f->diameter     = calloc(7, sizeof *f->diameter);
  f->wave         = calloc(7, sizeof *f->wave);
  assert_true(f->diameter && f->wave);
  for (int w = 0; w < f->n_waves; w++) {
    post_wave_field *to = &f->wave[w];
    const size_t     n = (size_t)(MODES * f->n_nodes), complex_too = w > 0 && w < 6;
    f->diameter[w] = w;
    to->frequency  = calloc(MODES, sizeof *to->frequency);
    to->shape      = calloc(3 * n, sizeof *to->shape);
    to->stress     = calloc(POST_STRESSES * n, sizeof *to->stress);
    assert_true(to->frequency && to->shape && to->stress);
    for (int m = 0; m < MODES; m++) to->frequency[m] = 100 * (m + 1) + 10 * w;
    for (size_t i = 0; i < 3 * n; i++)
      to->shape[i] =
          f->shape[i] + (complex_too ? 0.2 * w * I * f->shape[i / 3 * 3 + (i + 1) % 3] : 0);
    for (size_t i = 0; i < POST_STRESSES * n; i++)
      to->stress[i] = f->stress[i] * (complex_too ? CMPLX(1, 0.3) : 1);
  }
  free(f->shape);
  free(f->stress);
  f->shape = f->stress = NULL;
}

/* Kept amplitudes at every 40th point of the nonlinear curves. */
static mhb_response *make_response(const fixture_options *o) {
  mhb_response *r = fixture_response(o);
  assert_non_null(r);
  for (int b = 0; b < r->n_branches; b++) {
    mhb_branch *branch = &r->branch[b];
    int         n = branch->n_points / 40, K = branch->n_harmonics + 1;
    if (branch->kind != MHB_BRANCH_NONLINEAR || n < 1) continue;
    mhb_response_modal(r, branch, n, FORCES);
    for (int i = 0; i < n; i++) {
      branch->modal.point[i] = 40 * i;
      branch->modal.scale[i] = 1;
      for (int k = 0; k < K; k++)
        for (int m = 0; m < r->n_modes; m++)
          branch->modal.amplitude[(i * K + k) * r->n_modes + m] =
              k == 1   ? 1e-4 / (1 + m) * CMPLX(1, 0.3 * m)
              : k == 3 ? 1e-5
                       : 1e-9;
    }
  }
  return r;
}

static post_buffer data_of(const post_blade_field *f, const mhb_response *r) {
  const post_blade_view view = {f, MESH_AXIS_X};
  post_analysis        *a;
  post_buffer           out = {0};
  assert_ok(post_analysis_create(r, &a));
  assert_true(post_blade_view_fits(&view, r));
  assert_ok(post_blade_data(a, &view, &out));
  assert_false(out.failed);
  post_analysis_destroy(a);
  return out;
}

/* ---------------------------------------------------------------- data */

static void a_small_surface_is_whole(void **state) {
  (void)state;
  fixture_options  o = fixture_usual();
  post_blade_field f;
  make_field((const int[]){4, 1, 10}, &f);
  mhb_response *r   = make_response(&o);
  post_buffer   out = data_of(&f, r);
  /* a face of 8 nodes gives 6 triangles; 108 faces have 110 corners and 216 sides */
  assert_has(out.text, "{\"nodes\":326,\"triangles\":648,");
  assert_has(out.text, "\"lo\":[0,0,0.3],\"size\":[0.04,0.01,0.16]");
  assert_has(out.text, "\"modesLeftOut\":0");
  assert_has(out.text, "\"k\":[1,3]"); /* what is below 2 % is left out */
  assert_has(out.text, "\"axis\":[1,0,0]");
  post_buffer_free(&out);
  r->n_modes--; /* of another modal file */
  assert_false(post_blade_view_fits(&(post_blade_view){&f, MESH_AXIS_X}, r));
  r->n_modes++;
  mhb_response_destroy(r);
  free_field(&f);
}

static void fifty_thousand_nodes_fit_into_three_megabytes(void **state) {
  (void)state;
  fixture_options  o = fixture_usual();
  post_blade_field f;
  make_field((const int[]){40, 4, 65}, &f);
  mhb_response *r       = make_response(&o);
  double        started = shb_seconds();
  post_buffer   out     = data_of(&f, r);
  print_message("%d nodes: %.2f MB in %.2f s; %.40s\n", f.n_nodes, 1e-6 * (double)out.length,
                shb_seconds() - started, out.text);
  assert_true(f.n_nodes > 50000);
  assert_true(out.length < 3000000);
  assert_has(out.text, "\"modesLeftOut\":0");
  post_buffer_free(&out);
  mhb_response_destroy(r);
  free_field(&f);
}

/* A million surface nodes would not fit: they are merged, and the surface stays closed. */
static void a_large_surface_is_merged(void **state) {
  (void)state;
  fixture_options  o = fixture_usual();
  post_blade_field f;
  make_field((const int[]){100, 4, 150}, &f);
  mhb_response *r   = make_response(&o);
  post_buffer   out = data_of(&f, r);
  int           nodes, triangles;
  assert_int_equal(sscanf(out.text, "{\"nodes\":%d,\"triangles\":%d", &nodes, &triangles), 2);
  print_message("%d nodes: %d on the page, %d triangles, %.2f MB\n", f.n_nodes, nodes, triangles,
                1e-6 * (double)out.length);
  assert_true(out.length < 3000000 && nodes > 5000);
  assert_true(triangles > 1.7 * nodes); /* a closed surface has two a node */
  post_buffer_free(&out);
  mhb_response_destroy(r);
  free_field(&f);
}

static void pictures_are_drawn(void **state) {
  (void)state;
  post_blade_field f;
  post_buffer      out = {0};
  make_field((const int[]){4, 1, 10}, &f);
  post_still_blade(&f, MESH_AXIS_X, &out);
  /* nine edges of a box are seen, and no other: 3 (4 + 1 + 10) x 2 halves */
  int pieces = 0;
  for (const char *c = strstr(out.text, " d=\"") + 4; *c != '"'; c++) pieces += *c == 'M';
  assert_int_equal(pieces, 90);
  post_buffer_free(&out);
  post_contact_axes(SHB_PI / 6, -0.1, &out);
  assert_has(out.text, "ψ = 30°");
  assert_has(out.text, "φ = −5.73°");
  post_buffer_free(&out);
  free_field(&f);
}

/* ---------------------------------------------------------------- a disc */

/* Harmonic 3 also as harmonic 2, which runs backwards: 2 x 5 of 12 is nodal diameter 2. */
static mhb_response *make_disc_response(const fixture_options *o) {
  mhb_response *r = make_response(o);
  r->engine_order = 5;
  r->blades       = 12;
  for (int b = 0; b < r->n_branches; b++) {
    mhb_branch  *branch = &r->branch[b];
    const size_t K = (size_t)branch->n_harmonics + 1, m = (size_t)r->n_modes;
    for (int i = 0; i < branch->modal.n; i++)
      for (size_t k = 0; k < m; k++)
        branch->modal.amplitude[((size_t)i * K + 2) * m + k] = 4e-5 * CMPLX(1, -0.4 * (double)k);
  }
  return r;
}

static void waves_of_a_disc_are_there(void **state) {
  (void)state;
  fixture_options  o = fixture_usual();
  post_blade_field f;
  make_disc((const int[]){4, 1, 10}, &f);
  mhb_response *r   = make_disc_response(&o);
  post_buffer   out = data_of(&f, r);
  assert_has(out.text, "\"waves\":[5,2,3],"); /* of harmonics 1, 2 and 3 */
  assert_has(out.text, "\"row\":8,");
  assert_has(out.text, "\"f\":150,"); /* of nodal diameter 5 */
  assert_has(out.text, ",\"im\":\"");
  assert_has(out.text, "\"k\":[1,2,3],\"w\":[0,1,2],\"back\":[0,1,0]");
  assert_has(out.text, "\"lag\":2.61799388,"); /* 2 pi 5/12 */
  post_buffer_free(&out);
  mhb_response_destroy(r);
  free_field(&f);
}

static void many_waves_fit_into_three_megabytes(void **state) {
  (void)state;
  fixture_options  o = fixture_usual();
  post_blade_field f;
  make_disc((const int[]){30, 4, 50}, &f);
  mhb_response *r   = make_disc_response(&o);
  post_buffer   out = data_of(&f, r);
  print_message("%d nodes: %.2f MB; %.40s\n", f.n_nodes, 1e-6 * (double)out.length, out.text);
  assert_true(out.length < 3000000);
  post_buffer_free(&out);
  mhb_response_destroy(r);
  free_field(&f);
}

/* ---------------------------------------------------------------- pages for a browser */

/* What `shroudhb field --ring` has at the first kept point: nodes of the page, of three sectors at
 * an instant. */
static void keep_motion(const post_blade_field *f, const mhb_response *r, const char *path) {
  static const int sector[] = {0, 1, 7};
  post_skin        skin;
  post_period      p;
  post_buffer      out    = {0};
  int              branch = 0;
  while (r->branch[branch].kind != MHB_BRANCH_NONLINEAR || r->branch[branch].modal.n == 0) branch++;
  const mhb_branch *b = &r->branch[branch];
  double           *u = calloc(3 * (size_t)f->n_nodes, sizeof *u);
  assert_ok(post_skin_create(&f->mesh, &skin));
  assert_ok(post_period_create(f, r, branch, 0, MESH_AXIS_X, &p));
  post_put(&out, "{\"b\":%d,\"x\":%.12g,\"sectors\":[0,1,7],\"instant\":0.31,\"u\":[", branch,
           b->frequency[b->modal.point[0]]);
  for (int s = 0; s < 3; s++) {
    post_period_at(&p, sector[s], 0.31, u, NULL);
    for (int i = 0; i < 3 * skin.n_nodes; i++)
      post_put(&out, s + i ? ",%.7g" : "%.7g", u[3 * skin.node[i / 3] + i % 3]);
  }
  post_put(&out, "]}");
  assert_ok(post_buffer_publish(&out, path));
  post_buffer_free(&out);
  post_period_free(&p);
  post_skin_free(&skin);
  free(u);
}

static void keep_page(const char *name, bool disc, const int cells[3]) {
  char             none[] = "", path[64];
  post_origin      source = {none, none, none, none, none, none, none, 1};
  fixture_options  o      = fixture_usual();
  post_blade_field f;
  post_buffer      out = {0};
  post_analysis   *a;
  (disc ? make_disc : make_field)(cells, &f);
  mhb_response         *r    = (disc ? make_disc_response : make_response)(&o);
  const post_blade_view view = {&f, MESH_AXIS_X};
  if (disc) keep_motion(&f, r, "motion.json");
  assert_ok(post_analysis_create(r, &a));
  assert_ok(post_report(a, &source, name, &view, &out));
  snprintf(path, sizeof path, "page_%s.html", name);
  assert_ok(post_buffer_publish(&out, path));
  post_buffer_free(&out);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
  free_field(&f);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_small_surface_is_whole),
      cmocka_unit_test(fifty_thousand_nodes_fit_into_three_megabytes),
      cmocka_unit_test(a_large_surface_is_merged),
      cmocka_unit_test(pictures_are_drawn),
      cmocka_unit_test(waves_of_a_disc_are_there),
      cmocka_unit_test(many_waves_fit_into_three_megabytes),
  };
  if (argc > 1 && strcmp(argv[1], "keep") == 0) {
    keep_page("blade", false, (const int[]){4, 1, 10});
    keep_page("large", false, (const int[]){20, 4, 32});
    keep_page("disc", true, (const int[]){4, 1, 10});
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
