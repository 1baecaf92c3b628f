/* Reading meshes, matching contact faces, orientation, and faulty files. */
#include "mesh/core/fe_mesh.h"

#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <gmshc.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mesh/core/face_match.h"
#include "mesh/core/jacobian.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

static const double size[3]  = {0.237, 0.041, 0.023};
static const int    cells[3] = {5, 3, 2};

static char path[300];

static int set_up(void **state) {
  int failed = scratch_make(state);
  snprintf(path, sizeof path, "%s/bar.msh", scratch_folder);
  return failed;
}

/* Fails if a test left another file behind. */
static int tear_down(void **state) {
  (void)state;
  unlink(path);
  return rmdir(scratch_folder);
}

/* Volume by the four-point rule, exact for straight elements. */
static double volume(const mesh_fe *mesh) {
  double sum = 0;
  for (int e = 0; e < mesh->n_elements; e++) sum += mesh_jacobian_least(mesh, e) / 6;
  return sum;
}

/* Summed area vector of a set of triangles or parallelograms. */
static void area(const mesh_fe *mesh, mesh_set_id id, double sum[3]) {
  sum[0] = sum[1] = sum[2] = 0;
  for (int f = 0; f < mesh->set[id].n; f++) {
    const int    *n = mesh->set[id].nodes + mesh_topology_of(mesh->kind)->face_nodes * f;
    const double *x = mesh->coordinates + 3 * n[0], *y = mesh->coordinates + 3 * n[1],
                 *z = mesh->coordinates + 3 * n[2];
    double a[3], b[3];
    for (int d = 0; d < 3; d++) {
      a[d] = y[d] - x[d];
      b[d] = z[d] - x[d];
    }
    for (int d = 0; d < 3; d++)
      sum[d] += (mesh->kind == MESH_HEX20 ? 1 : 0.5) *
                (a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
  }
}

static void box_is_exact(void **state) {
  (void)state;
  mesh_fe mesh;
  assert_int_equal(box_mesh(size, cells, &mesh), SHB_OK);
  assert_int_equal(mesh.n_nodes, 11 * 7 * 5);
  assert_int_equal(mesh.n_elements, 6 * 30);
  assert_near(volume(&mesh), size[0] * size[1] * size[2], 1e-17);
  assert_int_equal(mesh_jacobian_check(&mesh, "box"), SHB_OK);
  double sum[3];
  area(&mesh, MESH_ROOT, sum);
  assert_near(sum[0], -size[1] * size[2], 1e-17);
  area(&mesh, MESH_LOAD, sum);
  assert_near(sum[2], size[0] * size[1], 1e-17);
  mesh_fe_free(&mesh);
}

static void middles_lie_between_their_ends(void **state) {
  (void)state;
  mesh_fe mesh;
  assert_int_equal(box_mesh(size, cells, &mesh), SHB_OK);
  for (int e = 0; e < mesh.n_elements; e++)
    for (int k = 0; k < 6; k++)
      for (int d = 0; d < 3; d++) {
        const int *n = mesh.connectivity + 10 * e;
        double     a = mesh.coordinates[3 * n[mesh_topology_of(MESH_TET10)->edge[k][0]] + d];
        double     b = mesh.coordinates[3 * n[mesh_topology_of(MESH_TET10)->edge[k][1]] + d];
        assert_near(mesh.coordinates[3 * n[4 + k] + d], (a + b) / 2, 1e-16);
      }
  mesh_fe_free(&mesh);
}

static void reads_back_what_was_written(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  assert_int_equal(box_write(&box, path), SHB_OK);
  for (int again = 0; again < 2; again++) {
    assert_int_equal(read_mesh(path, &mesh), SHB_OK);
    assert_int_equal(mesh.n_nodes, box.n_nodes);
    assert_int_equal(mesh.n_elements, box.n_elements);
    assert_near(volume(&mesh), size[0] * size[1] * size[2], 1e-17);
    assert_int_equal(mesh.set[MESH_ROOT].n, box.set[MESH_ROOT].n);
    assert_int_equal(mesh.set[MESH_LOAD].n, box.set[MESH_LOAD].n);
    assert_int_equal(mesh.set[MESH_CONTACT_LEFT].n, 0);
    for (int i = 0; i < 3 * box.n_nodes; i++)
      assert_near(mesh.coordinates[i], box.coordinates[i], 1e-16);
    mesh_fe_free(&mesh);
  }
  mesh_fe_free(&box);
}

/* Faces written inward are read outward, with their middles in step. */
static void faces_are_turned_outward(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  for (int f = 0; f < box.set[MESH_ROOT].n; f++) {
    int *n = box.set[MESH_ROOT].nodes + 6 * f, corner = n[1], middle = n[3];
    n[1] = n[2];
    n[2] = corner;
    n[3] = n[5];
    n[5] = middle;
  }
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  double sum[3];
  area(&mesh, MESH_ROOT, sum);
  assert_near(sum[0], -size[1] * size[2], 1e-17);
  for (int f = 0; f < mesh.set[MESH_ROOT].n; f++)
    for (int s = 0; s < 3; s++)
      for (int d = 0; d < 3; d++) {
        const int *n = mesh.set[MESH_ROOT].nodes + 6 * f;
        assert_near(mesh.coordinates[3 * n[3 + s] + d],
                    (mesh.coordinates[3 * n[s] + d] + mesh.coordinates[3 * n[(s + 1) % 3] + d]) / 2,
                    1e-16);
      }
  mesh_fe_free(&mesh);
  mesh_fe_free(&box);
}

/* The places of the nodes agree with gmsh's types 17 (hexahedron) and 16 (its faces). */
static void node_order_is_gmshs(void **state) {
  (void)state;
  const mesh_kind both[2] = {MESH_TET10, MESH_HEX20};
  int             ierr    = 0;
  gmshInitialize(0, NULL, 0, &ierr);
  for (int k = 0; k < 2; k++) {
    const mesh_topology *t       = mesh_topology_of(both[k]);
    const int            type[2] = {t->gmsh, t->gmsh_face};
    for (int face = 0; face < 2; face++) {
      char   *label = NULL;
      double *place = NULL;
      int     dim = 0, order = 0, nodes = 0, primary = 0;
      size_t  n = 0;
      gmshModelMeshGetElementProperties(type[face], &label, &dim, &order, &nodes, &place, &n,
                                        &primary, &ierr);
      assert_int_equal(ierr, 0);
      assert_int_equal(nodes, face ? t->face_nodes : t->nodes);
      assert_int_equal(primary, face ? t->face_corners : t->corners);
      for (int i = 0; i < nodes; i++) {
        double shape[MESH_NODES], slope[MESH_FACE_NODES][2], unused[MESH_NODES][3], at[3];
        /* gmsh's cube is [-1, 1], ours [0, 1] */
        for (int d = 0; d < dim; d++)
          at[d] = both[k] == MESH_HEX20 ? (place[dim * i + d] + 1) / 2 : place[dim * i + d];
        if (face)
          mesh_face_shape(both[k], at, shape, slope);
        else
          mesh_shape(both[k], at, shape, unused);
        for (int j = 0; j < nodes; j++) assert_near(shape[j], i == j, 1e-14);
      }
      gmshFree(label);
      gmshFree(place);
    }
  }
  gmshFinalize(&ierr);
}

/* Hexahedra written and read: the volume, the area of each group, the far side. */
static void hexahedra_are_read(void **state) {
  (void)state;
  mesh_fe box, mesh;
  double  sum[3];
  assert_int_equal(box_hex(size, cells, &box), SHB_OK);
  assert_int_equal(box.n_elements, 30);
  assert_int_equal(box_set(&box, MESH_CONTACT_LEFT, 1, size[1]), SHB_OK);
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  assert_int_equal(mesh.kind, MESH_HEX20);
  assert_int_equal(mesh.n_nodes, box.n_nodes);
  assert_int_equal(mesh.n_elements, box.n_elements);
  assert_near(mesh_jacobian_least(&mesh, 17), size[0] * size[1] * size[2] / 30, 1e-18);
  for (int i = 0; i < 20 * mesh.n_elements; i++)
    assert_int_equal(mesh.node_tag[mesh.connectivity[i]], box.node_tag[box.connectivity[i]]);
  area(&mesh, MESH_ROOT, sum);
  assert_near(sum[0], -size[1] * size[2], 1e-15);
  area(&mesh, MESH_CONTACT_LEFT, sum);
  assert_near(sum[1], size[0] * size[2], 1e-15);
  assert_near(sum[0], 0, 1e-15);
  mesh_fe_free(&mesh);
  int *face = box.set[MESH_ROOT].nodes, corner = face[1]; /* given inward: turned round */
  face[1] = face[3];
  face[3] = corner;
  for (int i = 0; i < 2; i++) {
    int middle  = face[4 + i];
    face[4 + i] = face[7 - i];
    face[7 - i] = middle;
  }
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  area(&mesh, MESH_ROOT, sum);
  assert_near(sum[0], -size[1] * size[2], 1e-15);
  mesh_fe_free(&mesh);
  box.coordinates[3 * box.connectivity[20 * 7 + 6]] -= size[0]; /* a corner through its element */
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "elements inverted");
  mesh_fe_free(&box);
}

static void hexahedra_of_other_orders_are_refused(void **state) {
  (void)state;
  mesh_fe mesh;
  int     ierr = 0;
  for (int order = 1; order <= 2; order++) {
    gmshInitialize(0, NULL, 0, &ierr);
    gmshOptionSetNumber("General.Terminal", 0, &ierr);
    int    square = gmshModelOccAddRectangle(0, 0, 0, .1, .1, -1, 0, &ierr), *made = NULL;
    int    from[2] = {2, square}, layers[1] = {2};
    size_t n = 0;
    gmshModelOccExtrude(from, 2, 0, 0, .1, &made, &n, layers, 1, NULL, 0, 1, &ierr);
    gmshFree(made);
    gmshModelOccSynchronize(&ierr);
    gmshModelMeshSetTransfiniteSurface(square, "Left", NULL, 0, &ierr);
    gmshModelMeshSetRecombine(2, square, &ierr);
    gmshOptionSetNumber("Mesh.MeshSizeMax", .05, &ierr);
    gmshModelMeshGenerate(3, &ierr);
    gmshModelMeshSetOrder(order, &ierr);
    gmshWrite(path, &ierr);
    assert_int_equal(ierr, 0);
    gmshFinalize(&ierr);
    assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT,
                   order == 1 ? "linear (eight-node) hexahedra" : "hexahedra of 27 nodes");
  }
}

static void unused_nodes_are_dropped(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  box.n_elements -= 6; /* the last cell, at the far corner: three of its faces were outside */
  box.set[MESH_LOAD].n = 0;
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  assert_in_range(mesh.n_nodes, box.n_nodes - 26, box.n_nodes - 1);
  for (int i = 0; i < 10 * mesh.n_elements; i++)
    assert_int_equal(mesh.node_tag[mesh.connectivity[i]], box.node_tag[box.connectivity[i]]);
  mesh_fe_free(&mesh);
  mesh_fe_free(&box);
}

/* A block between two radial planes of a ring of n sectors: its sides match after one pitch. */
static void wedge(int n, mesh_fe *mesh) {
  const double block[3] = {0.013, 0.02, 0.011};
  const int    few[3]   = {2, 3, 2};
  assert_int_equal(box_mesh(block, few, mesh), SHB_OK);
  assert_int_equal(box_set(mesh, MESH_CONTACT_RIGHT, 1, 0), SHB_OK);
  assert_int_equal(box_set(mesh, MESH_CONTACT_LEFT, 1, block[1]), SHB_OK);
  for (int i = 0; i < mesh->n_nodes; i++) {
    double *x     = mesh->coordinates + 3 * i;
    double  angle = SHB_TWO_PI / n * (0.5 - x[1] / block[1]), r = 0.31 + x[2];
    /* about +x, tangential = axial x radial: radial z at angle 0 goes towards -y */
    x[1] = -r * sin(angle);
    x[2] = r * cos(angle);
  }
}

static void contact_faces_are_paired(void **state) {
  (void)state;
  mesh_fe mesh;
  wedge(37, &mesh);
  int pairs = 0, *right = NULL, *left = NULL;
  assert_int_equal(mesh_fe_orient(&mesh, MESH_AXIS_X), SHB_OK);
  assert_int_equal(mesh_fe_match(&mesh, MESH_AXIS_X, 37, &pairs, &right, &left), SHB_OK);
  assert_int_equal(pairs, 25);
  for (int i = 0; i < pairs; i++) {
    double at[3];
    mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI / 37, mesh.coordinates + 3 * left[i], at);
    for (int d = 0; d < 3; d++) assert_near(at[d], mesh.coordinates[3 * right[i] + d], 1e-15);
    assert_true(i == 0 || right[i] > right[i - 1]);
  }
  free(right);
  free(left);
  assert_refused(mesh_fe_match(&mesh, MESH_AXIS_X, 36, &pairs, &right, &left), SHB_ERR_INPUT,
                 "do not match");
  mesh.coordinates[3 * mesh.set[MESH_CONTACT_LEFT].nodes[4]] += 3e-9;
  assert_refused(mesh_fe_match(&mesh, MESH_AXIS_X, 37, &pairs, &right, &left), SHB_ERR_INPUT,
                 "3e-09 m from the nearest");
  mesh.set[MESH_CONTACT_LEFT].n--;
  assert_refused(mesh_fe_match(&mesh, MESH_AXIS_X, 37, &pairs, &right, &left), SHB_ERR_INPUT,
                 "contact_right has 25 nodes");
  mesh.set[MESH_CONTACT_LEFT].n = 0;
  assert_refused(mesh_fe_match(&mesh, MESH_AXIS_X, 37, &pairs, &right, &left), SHB_ERR_INPUT,
                 "contact_left is absent");
  mesh_fe_free(&mesh);
}

static void right_is_the_tangential_side(void **state) {
  (void)state;
  mesh_fe mesh;
  wedge(37, &mesh);
  const int *right = mesh.set[MESH_CONTACT_RIGHT].nodes, *left = mesh.set[MESH_CONTACT_LEFT].nodes;
  assert_int_equal(mesh_fe_orient(&mesh, MESH_AXIS_X), SHB_OK);
  assert_ptr_equal(mesh.set[MESH_CONTACT_RIGHT].nodes, right);
  assert_int_equal(mesh_fe_orient(&mesh, MESH_AXIS_MX), SHB_OK); /* the other way round the axis */
  assert_ptr_equal(mesh.set[MESH_CONTACT_RIGHT].nodes, left);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_RIGHT, 0, 0), SHB_OK);
  mesh_face_set *sets = mesh.set;
  free(sets[MESH_CONTACT_RIGHT].nodes);
  sets[MESH_CONTACT_RIGHT].n     = sets[MESH_CONTACT_LEFT].n;
  sets[MESH_CONTACT_RIGHT].nodes = malloc(24 * (size_t)sets[MESH_CONTACT_LEFT].n);
  memcpy(sets[MESH_CONTACT_RIGHT].nodes, sets[MESH_CONTACT_LEFT].nodes,
         24 * (size_t)sets[MESH_CONTACT_LEFT].n);
  assert_refused(mesh_fe_orient(&mesh, MESH_AXIS_X), SHB_ERR_INPUT, "both face");
  mesh_fe_free(&mesh);
}

static void nearest_node_is_found(void **state) {
  (void)state;
  mesh_fe mesh;
  assert_int_equal(box_mesh(size, cells, &mesh), SHB_OK);
  for (int i = 0; i < mesh.n_nodes; i += 7) {
    const double *x     = mesh.coordinates + 3 * i;
    double        at[3] = {x[0] + 0.004, x[1] - 0.003, x[2] + 0.002};
    assert_int_equal(mesh_fe_nearest(&mesh, at), i);
  }
  const double extent = sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
  double       far[3] = {0, 0, -.099 * extent};
  int          node   = -1;
  assert_true(fabs(mesh_fe_extent(&mesh) - extent) < 1e-15);
  assert_int_equal(mesh_fe_near(&mesh, far, "probe.tip", &node), SHB_OK);
  assert_int_equal(node, 0);
  far[2] = -.101 * extent;
  assert_int_equal(mesh_fe_near(&mesh, far, "probe.tip", &node), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "probe.tip: (0, 0, -0."));
  assert_non_null(strstr(shb_message(), "m off the nearest node of the body, which measures"));
  assert_null(strstr(shb_message(), "mesh.unit"));
  for (int i = 0; i < 3 * mesh.n_nodes; i++) mesh.coordinates[i] *= 1e3;
  assert_int_equal(mesh_fe_near(&mesh, (double[3]){0, 0, -1e3}, "probe.tip", &node), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "; are its coordinates in mm? Say so with mesh.unit"));
  mesh.unit_given = true; /* nothing is asked that the case says */
  assert_int_equal(mesh_fe_near(&mesh, (double[3]){0, 0, -1e3}, "probe.tip", &node), SHB_ERR_INPUT);
  assert_null(strstr(shb_message(), "mesh.unit"));
  mesh_fe_free(&mesh);
}

static void put(const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void bad_files_are_refused(void **state) {
  (void)state;
  mesh_fe mesh;
  unlink(path);
  assert_refused(read_mesh(path, &mesh), SHB_ERR_IO, "No such file");
  assert_refused(read_mesh("blade.step", &mesh), SHB_ERR_INPUT, "end in .msh");
  put("");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "not a gmsh mesh file");
  put("Point(1) = {0, 0, 0};\nSystemCall \"false\";\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "not a gmsh mesh file");
  put("$MeshFormat\n4 0 8\n$EndMeshFormat\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "mesh format 4;");
  put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "no $EndNodes");
  put("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\ngarbage\n$EndNodes\n$Elements\n1 2 3\n"
      "$EndElements\n");
  assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
  assert_null(strchr(shb_message(), '\n'));
  assert_non_null(strstr(shb_message(), path));
}

/* A good file cut at many lengths: never a crash, never a mesh. */
static void truncated_files_are_refused(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  assert_int_equal(box_write(&box, path), SHB_OK);
  mesh_fe_free(&box);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  long whole = ftell(file);
  fclose(file);
  for (int part = 19; part >= 0; part--) {
    assert_int_equal(truncate(path, whole * part / 20), 0);
    assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
    assert_null(mesh.coordinates);
  }
}

static void first_order_is_refused(void **state) {
  (void)state;
  mesh_fe mesh;
  put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"root\"\n3 2 \"body\"\n"
      "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
      "$Elements\n2\n1 2 2 1 1 1 2 3\n2 4 2 2 1 1 2 3 4\n$EndElements\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "second order is needed");
}

static void surface_only_is_refused(void **state) {
  (void)state;
  mesh_fe mesh;
  put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"root\"\n"
      "$EndPhysicalNames\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "no volume elements");
}

static void an_element_without_its_node_is_refused(void **state) {
  (void)state;
  mesh_fe mesh;
  put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"root\"\n3 2 \"body\"\n"
      "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
      "$Elements\n2\n1 2 2 1 1 1 2 3\n2 4 2 2 1 1 2 3 99\n$EndElements\n");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "99");
}

/* As many names as fit, in one line whatever their characters. */
static void groups_are_listed(void **state) {
  (void)state;
  mesh_fe mesh = {0};
  char    text[MESH_FOUND + 40], long_name[80];
  assert_string_equal(mesh_fe_found(&mesh, text), "the mesh has no groups of faces");
  mesh_fe_note_group(&mesh, "foot");
  mesh_fe_note_group(&mesh, "tip\nshroud");
  assert_string_equal(mesh_fe_found(&mesh, text), "the mesh has the groups foot, tip?shroud");
  memset(long_name, 'x', sizeof long_name);
  long_name[sizeof long_name - 1] = 0;
  for (int i = 0; i < 5; i++) mesh_fe_note_group(&mesh, long_name);
  mesh_fe_note_group(&mesh, "late"); /* nothing follows the dots */
  mesh_fe_found(&mesh, text);
  assert_true(strlen(text) < sizeof text && strlen(mesh.found) < MESH_FOUND);
  assert_string_equal(text + strlen(text) - 6, "x, ...");
  memset(&mesh, 0, sizeof mesh);
  memset(long_name, 'y', sizeof long_name);
  long_name[sizeof long_name - 1] = 0;
  for (size_t n = 1; n < 60; n++) { /* names of every length */
    char name[80];
    memset(&mesh, 0, sizeof mesh);
    snprintf(name, sizeof name, "%.*s", (int)n, long_name);
    for (int i = 0; i < 120; i++) mesh_fe_note_group(&mesh, name);
    assert_true(strlen(mesh.found) < MESH_FOUND);
    assert_string_equal(mesh.found + strlen(mesh.found) - 6, "y, ...");
  }
}

static void bad_groups_are_refused(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  int roots            = box.set[MESH_ROOT].n;
  box.set[MESH_ROOT].n = 0;
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "group root is absent");
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "; the mesh has the groups load");
  box.set[MESH_ROOT].n = roots;
  assert_int_equal(box_set(&box, MESH_LOAD, 0, size[0] * 2 / cells[0]), SHB_OK);
  assert_true(box.set[MESH_LOAD].n > 0);
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "group load: the face on nodes");
  mesh_fe_free(&box);
}

static void inverted_elements_are_named(void **state) {
  (void)state;
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  for (int e = 0; e < box.n_elements; e++) box.element_tag[e] = 1000 + 3 * e;
  /* move one mid-side node far along its edge: det J < 0 near that end */
  const int *n = box.connectivity + 10 * 77;
  for (int d = 0; d < 3; d++)
    box.coordinates[3 * n[4] + d] =
        0.1 * box.coordinates[3 * n[0] + d] + 0.9 * box.coordinates[3 * n[1] + d];
  assert_true(mesh_jacobian_least(&box, 77) < 0);
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_refused(read_mesh(path, &mesh), SHB_ERR_INPUT, "inverted");
  assert_null(mesh.coordinates);
  char tag[16];
  int  named = 0;
  for (int e = 0; e < box.n_elements; e++) {
    if (mesh_jacobian_least(&box, e) > 0) continue;
    snprintf(tag, sizeof tag, " %ld", box.element_tag[e]);
    if (named++ < 5) assert_non_null(strstr(shb_message(), tag));
  }
  assert_true(named > 0);
  mesh_fe_free(&box);
}

/* gmsh leaves the program's signal handlers in place. */
static void signals_stay_ours(void **state) {
  (void)state;
  shb_interrupt_catch();
  struct sigaction before, after;
  sigaction(SIGINT, NULL, &before);
  mesh_fe box, mesh;
  assert_int_equal(box_mesh(size, cells, &box), SHB_OK);
  assert_int_equal(box_write(&box, path), SHB_OK);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  sigaction(SIGINT, NULL, &after);
  assert_true(before.sa_handler == after.sa_handler);
  mesh_fe_free(&mesh);
  mesh_fe_free(&box);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(box_is_exact),
      cmocka_unit_test(middles_lie_between_their_ends),
      cmocka_unit_test(reads_back_what_was_written),
      cmocka_unit_test(faces_are_turned_outward),
      cmocka_unit_test(node_order_is_gmshs),
      cmocka_unit_test(hexahedra_are_read),
      cmocka_unit_test(hexahedra_of_other_orders_are_refused),
      cmocka_unit_test(unused_nodes_are_dropped),
      cmocka_unit_test(contact_faces_are_paired),
      cmocka_unit_test(right_is_the_tangential_side),
      cmocka_unit_test(nearest_node_is_found),
      cmocka_unit_test(bad_files_are_refused),
      cmocka_unit_test(truncated_files_are_refused),
      cmocka_unit_test(first_order_is_refused),
      cmocka_unit_test(surface_only_is_refused),
      cmocka_unit_test(an_element_without_its_node_is_refused),
      cmocka_unit_test(groups_are_listed),
      cmocka_unit_test(bad_groups_are_refused),
      cmocka_unit_test(inverted_elements_are_named),
      cmocka_unit_test(signals_stay_ours),
  };
  return cmocka_run_group_tests_name("mesh.fe_mesh", tests, set_up, tear_down);
}
