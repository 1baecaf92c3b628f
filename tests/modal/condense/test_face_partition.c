/* Partition of a contact face: integrals over its facets, and parts of about equal area. */
#include "modal/condense/face_partition.h"

#include "modal/common/session.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"

static const double size[3]  = {0.9, 0.2, 0.11};
static const int    cells[3] = {9, 2, 1};

/* The top face, z = size[2]. */
static modal_facets facets_of(const mesh_fe *mesh) {
  modal_facets facets = {0};
  assert_ok(modal_facets_create(mesh, &mesh->set[MESH_LOAD], &facets));
  return facets;
}

static void integrals_are_exact(void **state) {
  (void)state;
  mesh_fe      mesh   = make_box(size, cells);
  modal_facets facets = facets_of(&mesh);
  double       area = 0, nodal = 0, normal[3] = {0}, centre[3] = {0};
  assert_int_equal(facets.n, 2 * cells[0] * cells[1]);
  for (int f = 0; f < facets.n; f++) {
    area += facets.total[f];
    for (int i = 0; i < facets.nodes; i++) {
      nodal += facets.area[f][i];
      for (int d = 0; d < 3; d++) normal[d] += facets.normal[f][i][d];
    }
    for (int d = 0; d < 3; d++) centre[d] += facets.total[f] * facets.centroid[f][d];
  }
  assert_near(area, size[0] * size[1], 1e-15);
  assert_near(nodal, area, 1e-15);
  assert_near(normal[2], area, 1e-15);
  assert_near(hypot(normal[0], normal[1]), 0, 1e-15);
  assert_near(centre[0] / area, size[0] / 2, 1e-14);
  assert_near(centre[1] / area, size[1] / 2, 1e-14);
  assert_near(centre[2] / area, size[2], 1e-14);
  modal_facets_free(&facets);
  mesh_fe_free(&mesh);
}

/* Every part has its share of the area, to less than a facet for each cut above it. */
static void parts_have_equal_area(void **state) {
  (void)state;
  static const int counts[] = {1, 2, 3, 5, 9, 36};
  mesh_fe          mesh     = make_box(size, cells);
  for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
    const int    n        = counts[k];
    modal_facets facets   = facets_of(&mesh);
    double       area[36] = {0};
    const double facet    = facets.total[0];
    assert_ok(modal_facets_partition(&facets, n));
    for (int f = 0; f < facets.n; f++) {
      assert_true(facets.patch[f] >= 0 && facets.patch[f] < n);
      area[facets.patch[f]] += facets.total[f];
    }
    for (int p = 0; p < n; p++) assert_near(area[p], size[0] * size[1] / n, 1.001 * facet);
    modal_facets_free(&facets);
  }
  mesh_fe_free(&mesh);
}

/* Two parts of the long face lie on either side of its middle. */
static void cut_is_across_the_length(void **state) {
  (void)state;
  mesh_fe      mesh   = make_box(size, cells);
  modal_facets facets = facets_of(&mesh);
  int          left   = -1;
  assert_ok(modal_facets_partition(&facets, 2));
  for (int f = 0; f < facets.n; f++) {
    const double x = facets.centroid[f][0] - size[0] / 2;
    if (fabs(x) < size[0] / cells[0]) continue; /* the cell in the middle may go either way */
    if (left < 0) left = x < 0 ? facets.patch[f] : 1 - facets.patch[f];
    assert_int_equal(facets.patch[f], x < 0 ? left : 1 - left);
  }
  modal_facets_free(&facets);
  mesh_fe_free(&mesh);
}

static void too_many_parts_are_refused(void **state) {
  (void)state;
  mesh_fe      mesh   = make_box(size, cells);
  modal_facets facets = facets_of(&mesh);
  assert_int_equal(modal_facets_partition(&facets, facets.n + 1), SHB_ERR_INPUT);
  assert_has(shb_message(), "37 patches asked of a contact face of 36 facets");
  modal_facets_free(&facets);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals_are_exact), cmocka_unit_test(parts_have_equal_area),
      cmocka_unit_test(cut_is_across_the_length), cmocka_unit_test(too_many_parts_are_refused)};
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
