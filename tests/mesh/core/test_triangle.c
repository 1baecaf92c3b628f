/* Areas and nearest points of triangles, against closed forms and a search. */
#include "mesh/core/triangle.h"

#include "mesh/base/vec3.h"
#include "tests/support/box.h"
#include "tests/support/check.h"

static const double corner[3][3] = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};

static mesh_triangle right_angled(void) {
  return (mesh_triangle){.x = {corner[0], corner[1], corner[2]}};
}

/* Inside, beyond a side, beyond a corner. */
static void nearest_points_have_closed_forms(void **state) {
  (void)state;
  const mesh_triangle triangle     = right_angled();
  const double        point[4][3]  = {{1, 1, 2}, {1, -2, 0}, {5, -1, 2}, {3, 4, 0}};
  const double        wanted[4][3] = {{1, 1, 0}, {1, 0, 0}, {3, 0, 0}, {1.08, 2.56, 0}};
  for (int i = 0; i < 4; i++) {
    double       foot[3], weight[3], sum[3] = {0};
    const double distance = mesh_triangle_closest(&triangle, point[i], foot, weight);
    assert_near(vec3_distance(foot, wanted[i]), 0, 1e-14);
    assert_near(distance, vec3_distance(point[i], wanted[i]), 1e-14);
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) sum[d] += weight[c] * corner[c][d];
    assert_near(vec3_distance(sum, foot), 0, 1e-14);
    assert_near(mesh_triangle_closest(&triangle, point[i], foot, NULL), distance, 0);
  }
}

static void no_point_of_the_triangle_is_nearer(void **state) {
  (void)state;
  const double        tilted[3][3] = {{0.3, -1, 2}, {2.2, 0.7, 1.1}, {-0.4, 1.3, 0.2}};
  const mesh_triangle triangle     = {.x = {tilted[0], tilted[1], tilted[2]}};
  const double        at[3]        = {2, 2.5, 1.7};
  double              foot[3], least = INFINITY;
  const double        distance = mesh_triangle_closest(&triangle, at, foot, NULL);
  for (int i = 0; i <= 300; i++)
    for (int j = 0; i + j <= 300; j++) {
      double x[3];
      for (int d = 0; d < 3; d++)
        x[d] = (i * tilted[1][d] + j * tilted[2][d] + (300 - i - j) * tilted[0][d]) / 300;
      least = fmin(least, vec3_distance(x, at));
    }
  assert_true(distance <= least + 1e-14 && distance > least - 1e-3);
}

/* The area vectors of a plane face's triangles add up to its area, outward. */
static void parts_cover_a_face(void **state) {
  (void)state;
  const double size[3]  = {2, 3, 5};
  const int    cells[3] = {1, 1, 1};
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe mesh;
    double  sum[3] = {0};
    assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh));
    const mesh_face_set *set  = &mesh.set[MESH_LOAD];
    const int            each = mesh_topology_of(mesh.kind)->face_nodes;
    for (int f = 0; f < set->n; f++) {
      mesh_triangle part[MESH_TRIANGLES];
      const int     n = mesh_triangles(&mesh, set->nodes + each * f, part);
      assert_int_equal(n, kind == MESH_HEX20 ? 6 : 4);
      for (int p = 0; p < n; p++) {
        double area[3];
        mesh_triangle_area(&part[p], area);
        for (int d = 0; d < 3; d++) sum[d] += area[d];
      }
    }
    assert_near(vec3_distance(sum, (const double[]){0, 0, 6}), 0, 1e-14);
    mesh_fe_free(&mesh);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(nearest_points_have_closed_forms),
                                     cmocka_unit_test(no_point_of_the_triangle_is_nearer),
                                     cmocka_unit_test(parts_cover_a_face)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
