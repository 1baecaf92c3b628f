/* Axes at a point and rotations about every engine axis, against their definitions. */
#include "mesh/base/axes.h"

#include "mesh/base/vec3.h"
#include "tests/support/check.h"

static const double point[3] = {1.7, -2.3, 0.9};

static void axes_are_right_handed_and_radial(void **state) {
  (void)state;
  for (int k = MESH_AXIS_X; k <= MESH_AXIS_MZ; k++) {
    double axes[3][3], axial[3], product[3];
    mesh_axes_at((mesh_axis)k, point, axes);
    mesh_axis_vector((mesh_axis)k, axial);
    for (int a = 0; a < 3; a++) {
      assert_near(vec3_norm(axes[a]), 1, 1e-15);
      assert_near(axes[1][a], axial[a], 0);
      assert_near(vec3_dot(axes[a], axes[(a + 1) % 3]), 0, 1e-15);
    }
    vec3_cross(axes[1], axes[2], product);
    assert_near(vec3_distance(product, axes[0]), 0, 1e-15);
    /* the radial component is the distance from the axis */
    const double along = vec3_dot(point, axial);
    assert_near(vec3_dot(point, axes[2]), sqrt(vec3_dot(point, point) - along * along), 1e-14);
  }
}

static void rotation_moves_along_the_tangent(void **state) {
  (void)state;
  const double angle = 0.37;
  for (int k = MESH_AXIS_X; k <= MESH_AXIS_MZ; k++) {
    double turned[3], back[3], axes[3][3], matrix[16], product[3], from[3];
    mesh_axis_rotate((mesh_axis)k, angle, point, turned);
    mesh_axes_at((mesh_axis)k, point, axes);
    vec3_minus(turned, point, from);
    const double radius = vec3_dot(point, axes[2]);
    assert_near(vec3_dot(from, axes[0]), radius * sin(angle), 1e-14);
    assert_near(vec3_dot(from, axes[1]), 0, 1e-15);
    assert_near(vec3_dot(from, axes[2]), radius * (cos(angle) - 1), 1e-14);
    mesh_axis_rotate((mesh_axis)k, -angle, turned, back);
    assert_near(vec3_distance(back, point), 0, 1e-15);
    mesh_axis_matrix((mesh_axis)k, angle, matrix);
    for (int row = 0; row < 3; row++) product[row] = vec3_dot(matrix + 4 * row, point);
    assert_near(vec3_distance(product, turned), 0, 1e-14);
    assert_true(matrix[15] == 1 && matrix[3] == 0 && matrix[12] == 0);
  }
}

static void stacking_line_is_across_the_axis(void **state) {
  (void)state;
  for (int k = MESH_AXIS_X; k <= MESH_AXIS_MZ; k++) {
    double axial[3], radial[3];
    mesh_axis_vector((mesh_axis)k, axial);
    mesh_axis_stacking((mesh_axis)k, radial);
    assert_near(vec3_dot(axial, radial), 0, 0);
    assert_near(vec3_norm(radial), 1, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(axes_are_right_handed_and_radial),
                                     cmocka_unit_test(rotation_moves_along_the_tangent),
                                     cmocka_unit_test(stacking_line_is_across_the_axis)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
