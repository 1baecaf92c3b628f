/* Surface, modes and kept points of the page's blade.
 * With "keep": pages for test_page_script.py. */
#include "postproc/report/blade_view.h"

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
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
  mesh_fe_free(&f->mesh);
  free(f->shape);
  free(f->stress);
}

/* Kept amplitudes at every 40th point of the nonlinear curves. */
static mhb_response *make_response(const fixture_options *o) {
  mhb_response *r = fixture_response(o);
  assert_non_null(r);
  for (int b = 0; b < r->n_branches; b++) {
    mhb_branch *branch = &r->branch[b];
    int         n = branch->n_points / 40, K = branch->n_harmonics + 1;
    if (branch->kind != MHB_BRANCH_NONLINEAR || n < 1) continue;
    assert_ok(mhb_response_modal(r, branch, n, FORCES));
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

/* ---------------------------------------------------------------- pages for a browser */

static void keep_page(const char *name, const int cells[3]) {
  char             none[] = "", path[64];
  post_origin      source = {none, none, none, none, none, none, none, 1};
  fixture_options  o      = fixture_usual();
  post_blade_field f;
  post_buffer      out = {0};
  post_analysis   *a;
  make_field(cells, &f);
  mhb_response         *r    = make_response(&o);
  const post_blade_view view = {&f, MESH_AXIS_X};
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
  };
  if (argc > 1 && strcmp(argv[1], "keep") == 0) {
    keep_page("blade", (const int[]){4, 1, 10});
    keep_page("large", (const int[]){40, 4, 65});
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
