/* Contact patches: weights, areas, axes, normals, images, and errors of the input. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/condense/contact_patches.h"
#include "tests/support/fem.h"

enum { BLADES = 23 };

static const double size[3] = {0.04, 1, 0.11}, inner = 0.2, degree = 0.017453292519943295;
static const int    cells[3] = {4, 3, 6};

static modal_patches create(const mesh_fe *mesh, bool to_ground, int points) {
  modal_patches face;
  if (modal_patches_create(mesh, MESH_AXIS_X, BLADES, to_ground, points, &face) != SHB_OK)
    fail_msg("%s", shb_message());
  return face;
}

/* Centroid of the right face from the patches, and totals, for any division. */
static void check_totals(const modal_patches *face) {
  double area = 0, centroid[3] = {0};
  for (int p = 0; p < face->n_pairs; p++) {
    double sum = 0;
    for (int e = face->start[p]; e < face->start[p + 1]; e++) sum += face->weight[e];
    check_close(sum, 1, 1e-13, "sum of a patch's weights");
    assert_true(face->area[p] > 0);
    area += face->area[p];
    for (int d = 0; d < 3; d++) centroid[d] += face->area[p] * face->centroid[0][3 * p + d];
  }
  const double radius = inner + size[2] / 2, half = SHB_PI / BLADES;
  check_close(area, size[0] * size[2], 1e-12, "sum of the areas");
  check_close(face->total_area, size[0] * size[2], 1e-12, "area of the face");
  check_close(centroid[0] / area, size[0] / 2, 1e-12, "centroid");
  check_close(centroid[1] / area, -radius * sin(half), 1e-12, "centroid");
  check_close(centroid[2] / area, radius * cos(half), 1e-12, "centroid");
}

/* The sides are planes of constant angle: their normals are tangential. The left image lies one
 * sector back. */
static void check_pairs(const mesh_fe *mesh, const modal_patches *face) {
  const double sector = SHB_TWO_PI / BLADES;
  for (int p = 0; p < face->n_pairs; p++) {
    double image[3];
    check_close(face->normal[3 * p], 1, 1e-12, "normal is tangential");
    mesh_axis_rotate(MESH_AXIS_X, sector, face->centroid[1] + 3 * p, image);
    for (int d = 0; d < 3; d++)
      check_below(image[d] - face->centroid[0][3 * p + d], 1e-12, "image of a patch");
    for (int e = face->start[p]; e < face->start[p + 1]; e++) {
      mesh_axis_rotate(MESH_AXIS_X, sector, mesh->coordinates + 3 * face->node[1][e], image);
      for (int d = 0; d < 3; d++)
        check_below(image[d] - mesh->coordinates[3 * face->node[0][e] + d], 1e-12, "image");
    }
    for (int d = 0; d < 3; d++) {
      double rotated[3];
      mesh_axis_rotate(MESH_AXIS_X, sector, face->axes[1][p][d], rotated);
      for (int c = 0; c < 3; c++)
        check_below(rotated[c] - face->axes[0][p][d][c], 1e-12, "axes of a patch");
    }
  }
}

/* The side has 24 cells, each one quadrangle or two triangles. */
static int facets(void) {
  return used_elements() == MESH_HEX20 ? 24 : 48;
}

static void any_division_keeps_the_totals(void **state) {
  (void)state;
  mesh_fe   mesh      = make_sector(size, inner, BLADES, cells);
  const int points[5] = {1, 2, 4, 7, facets()};
  for (int i = 0; i < 5; i++) {
    modal_patches face = create(&mesh, false, points[i]);
    assert_int_equal(face.n_pairs, points[i]);
    check_totals(&face);
    check_pairs(&mesh, &face);
    for (int p = 0; p < face.n_pairs && points[i] < 8;
         p++) /* a facet is 1/24 of the area or less */
      check_close(face.area[p], face.total_area / points[i], 7. / facets(), "equal areas");
    modal_patches_free(&face);
  }
  mesh_fe_free(&mesh);
}

/* Flat straight-sided faces: only mid-side nodes carry weight. 48 triangles have (3*48 + 20)/2 = 82
 * sides, 20 of them on the boundary; 24 quadrangles have (4*24 + 20)/2 = 58. A side carries a third
 * or a quarter of each of its facets. */
static void all_nodes(void **state) {
  (void)state;
  mesh_fe       mesh = make_sector(size, inner, BLADES, cells);
  modal_patches face = create(&mesh, false, 0);
  const bool    hex  = used_elements() == MESH_HEX20;
  const double  part = hex ? 0.25 : 1. / 3;
  assert_int_equal(face.n_pairs, hex ? 58 : 82);
  check_totals(&face);
  check_pairs(&mesh, &face);
  for (int p = 0; p < face.n_pairs; p++) {
    double share = face.area[p] / face.total_area * facets();
    assert_true(fabs(share - part) < 1e-9 || fabs(share - 2 * part) < 1e-9);
  }
  modal_patches_free(&face);
  mesh_fe_free(&mesh);
}

/* A patch moves as the mean of its face: exact for a quadratic field. */
static void patch_is_the_mean_of_its_face(void **state) {
  (void)state;
  mesh_fe       mesh = make_sector(size, inner, BLADES, cells);
  modal_patches face = create(&mesh, false, 1);
  double        mean = 0;
  for (int e = 0; e < face.start[1]; e++) {
    const double *x = mesh.coordinates + 3 * face.node[0][e];
    double        r = hypot(x[1], x[2]);
    mean += face.weight[e] * (3 + 5 * x[0] * x[0] - 7 * x[0] * r + 2 * r * r);
  }
  double a = size[0], low = inner, high = inner + size[2], h = size[2];
  double exact = 3 + 5 * a * a / 3 - 7 * a / 2 * (low + high) / 2 +
                 2 * (high * high * high - low * low * low) / (3 * h);
  check_close(mean, exact, 1e-12, "mean of a quadratic field");
  modal_patches_free(&face);
  mesh_fe_free(&mesh);
}

static void angles_must_agree_with_the_faces(void **state) {
  (void)state;
  mesh_fe       mesh = make_sector(size, inner, BLADES, cells);
  modal_patches face = create(&mesh, false, 1);
  const double zero = 0.5 * degree, full = 359.5 * degree, wrong = 35 * degree, steep = -2 * degree;
  check_below(face.psi, 1e-12, "psi");
  check_below(face.phi, 1e-12, "phi");
  assert_int_equal(modal_patches_check_angles(&face, NULL, NULL), SHB_OK);
  assert_int_equal(modal_patches_check_angles(&face, &zero, &full), SHB_OK);
  assert_int_equal(modal_patches_check_angles(&face, &wrong, NULL), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "contact.psi: 35 deg given"));
  assert_int_equal(modal_patches_check_angles(&face, &zero, &steep), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "contact.phi: -2 deg given"));
  modal_patches_free(&face);
  mesh_fe_free(&mesh);
}

/* psi and phi of a skewed face by the paper's convention, v = (cos psi cos phi, sin psi cos phi,
 * -sin phi). */
static void angles_of_a_skewed_face(void **state) {
  (void)state;
  const double psi = 31 * degree, phi = 8 * degree, thin[3] = {0.01, 1, 0.01};
  const int    one[3] = {1, 1, 1};
  mesh_fe      mesh   = make_sector(thin, inner, 3600, one); /* nearly a box: tangential is -y */
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i;
    /* plane through the centroid: v . (tangential, axial, radial) = 0 with tangential = -y */
    x[1] += ((x[0] - 0.005) * sin(psi) * cos(phi) - (x[2] - inner - 0.005) * sin(phi)) /
            (cos(psi) * cos(phi));
  }
  modal_patches face = create(&mesh, true, 1);
  check_below(face.psi - psi, 0.06 * degree, "psi"); /* the centroid is 0.05 deg off the z axis */
  check_below(face.phi - phi, 0.06 * degree, "phi");
  modal_patches_free(&face);
  mesh_fe_free(&mesh);
}

static void refused(const mesh_fe *mesh, bool to_ground, int points, const char *text) {
  modal_patches face;
  assert_int_equal(modal_patches_create(mesh, MESH_AXIS_X, BLADES, to_ground, points, &face),
                   SHB_ERR_INPUT);
  if (!strstr(shb_message(), text)) fail_msg("'%s' lacks '%s'", shb_message(), text);
}

static void bad_faces_are_one_line(void **state) {
  (void)state;
  mesh_fe       mesh = make_sector(size, inner, BLADES, cells);
  modal_patches face;
  refused(&mesh, false, 49,
          used_elements() == MESH_HEX20 ? "contact face of 24 facets"
                                        : "49 patches asked of a contact face of 48 facets");
  mesh.set[MESH_CONTACT_LEFT].n = 0;
  refused(&mesh, false, 1, "no group \"contact_left\"");
  face = create(&mesh, true, 3);
  assert_false(face.has_left);
  check_totals(&face);
  modal_patches_free(&face);
  mesh.set[MESH_CONTACT_RIGHT].n = 0;
  refused(&mesh, true, 1, "no group \"contact_right\"");
  mesh_fe_free(&mesh);
  mesh = make_sector(size, inner, BLADES, cells);
  for (int i = 0; i < 8; i++) /* off by a tenth of the face */
    mesh.coordinates[3 * mesh.set[MESH_CONTACT_LEFT].nodes[i] + 1] += 0.1 * size[2];
  assert_int_equal(modal_patches_create(&mesh, MESH_AXIS_X, BLADES, false, 1, &face),
                   SHB_ERR_INPUT);
  mesh_fe_free(&mesh);
}

/* With displaced nodes on the left face, left patches reproduce a linear field as their right
 * counterparts do, rotated back by a sector. */
static void faces_that_do_not_match_are_projected(void **state) {
  (void)state;
  mesh_fe mesh = make_sector(size, inner, BLADES, cells);
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, r = hypot(x[1], x[2]), high = (r - inner) / size[2];
    double  bump = 0.05 * sin(SHB_PI * x[0] / size[0]) * sin(SHB_PI * high);
    if (x[1] / x[2] < tan(SHB_PI / BLADES) * (1 - 1e-9)) continue; /* not on the left side */
    x[0] += bump * size[0];
    for (int d = 1; d < 3; d++) x[d] *= 1 + bump * size[2] / r;
  }
  for (int points = 0; points < 4; points++) {
    modal_patches face;
    assert_int_equal(modal_patches_create(&mesh, MESH_AXIS_X, BLADES, false, points, &face),
                     SHB_OK);
    assert_true(face.projected && face.gap < 1e-12);
    for (int p = 0; p < face.n_pairs; p++) {
      double sum[2] = {0, 0}, centroid[3] = {0, 0, 0}, image[3];
      for (int e = face.start[p]; e < face.start[p + 1]; e++) {
        sum[0] += face.weight[e];
        sum[1] += face.left_weight[e];
        for (int d = 0; d < 3; d++)
          centroid[d] += face.left_weight[e] * mesh.coordinates[3 * face.node[1][e] + d];
      }
      check_close(sum[0], 1, 1e-12, "weights of the right");
      check_close(sum[1], 1, 1e-12, "weights of the left");
      mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI / BLADES, centroid, image);
      for (int d = 0; d < 3; d++)
        check_below(image[d] - face.centroid[0][3 * p + d], 1e-12, "image of a patch");
    }
    modal_patches_free(&face);
  }
  mesh_fe_free(&mesh);
}

/* A side and the root in one group: they meet at a right angle. Each alone is flat. */
static void a_patch_of_two_faces_is_refused_with_the_angle(void **state) {
  (void)state;
  mesh_fe       mesh = make_sector(size, inner, BLADES, cells);
  mesh_face_set own = mesh.set[MESH_CONTACT_RIGHT], other = mesh.set[MESH_ROOT], both;
  const size_t  each = (size_t)mesh_topology_of(mesh.kind)->face_nodes;
  both.n             = own.n + other.n;
  both.nodes         = malloc(each * (size_t)both.n * sizeof *both.nodes);
  memcpy(both.nodes, own.nodes, each * (size_t)own.n * sizeof *own.nodes);
  memcpy(both.nodes + each * (size_t)own.n, other.nodes,
         each * (size_t)other.n * sizeof *own.nodes);
  mesh.set[MESH_CONTACT_RIGHT] = both;
  for (int points = 0; points < 2; points++) {
    modal_patches face;
    assert_int_equal(modal_patches_create(&mesh, MESH_AXIS_X, BLADES, true, points, &face),
                     SHB_ERR_INPUT);
    print_message("points %d: %s\n", points, shb_message());
    assert_non_null(strstr(shb_message(), "group contact_right: its face at ("));
    assert_non_null(strstr(shb_message(), " deg against the mean of its contact patch"));
    assert_non_null(strstr(shb_message(), "contact.interfaces"));
  }
  mesh.set[MESH_CONTACT_RIGHT] = own;
  modal_patches face           = create(&mesh, true, 1);
  modal_patches_free(&face);
  free(both.nodes);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_division_keeps_the_totals),
      cmocka_unit_test(all_nodes),
      cmocka_unit_test(patch_is_the_mean_of_its_face),
      cmocka_unit_test(angles_must_agree_with_the_faces),
      cmocka_unit_test(a_patch_of_two_faces_is_refused_with_the_angle),
      cmocka_unit_test(angles_of_a_skewed_face),
      cmocka_unit_test(faces_that_do_not_match_are_projected),
      cmocka_unit_test(bad_faces_are_one_line),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = run_with_both_elements(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
