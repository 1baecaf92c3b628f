/* Meshes written as .msh and as .inp are read back as they were, with all groups and volumes. */
#include "mesh/base/constants.h"
#include "mesh/io/inp_write.h"
#include "mesh/io/msh_write.h"
#include "mesh/io/read.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

/* A box with odd coordinates, a fifth group on the face x = size and two volumes. */
static mesh_fe make_mesh(mesh_kind kind) {
  const double size[3]  = {SHB_PI / 30, 0.1 / 3, -0.2 / 7};
  const int    cells[3] = {2, 2, 1};
  mesh_fe      mesh;
  const double positive[3] = {size[0], size[1], -size[2]};
  assert_ok(kind == MESH_HEX20 ? box_hex(positive, cells, &mesh)
                               : box_mesh(positive, cells, &mesh));
  mesh.n_more = 1;
  snprintf(mesh.more[0], sizeof mesh.more[0], "snubber");
  assert_ok(box_set(&mesh, (mesh_set_id)MESH_N_SETS, 0, size[0]));
  mesh.n_regions   = 2;
  mesh.region_name = calloc(2, sizeof *mesh.region_name);
  mesh.region      = malloc((size_t)mesh.n_elements * sizeof *mesh.region);
  snprintf(mesh.region_name[0], MESH_WORD, "foot");
  snprintf(mesh.region_name[1], MESH_WORD, "tip");
  for (int e = 0; e < mesh.n_elements; e++) mesh.region[e] = e % 3 == 1;
  for (int i = 0; i < mesh.n_nodes; i++) mesh.node_tag[i] = 7 * i + 3;
  for (int e = 0; e < mesh.n_elements; e++) mesh.element_tag[e] = 5 * e + 11;
  return mesh;
}

static const mesh_names names = {
    .n_more    = 1,
    .more      = {{"snubber", "snubber"}},
    .n_volumes = 2,
    .volume    = {{.label = "foot", .name = "foot"}, {.label = "tip", .name = "tip"}}};

static int by_value(const void *a, const void *b) {
  return *(const int *)a - *(const int *)b;
}

/* Sum over the faces of a set of a number of each, whatever their order and first corner. */
static double fold(const mesh_fe *mesh, int set) {
  const int each = mesh_topology_of(mesh->kind)->face_nodes;
  double    sum  = 0;
  for (int f = 0; f < mesh->set[set].n; f++) {
    int    node[MESH_FACE_NODES];
    double product = 1;
    memcpy(node, mesh->set[set].nodes + each * f, (size_t)each * sizeof *node);
    qsort(node, (size_t)each, sizeof *node, by_value);
    for (int i = 0; i < each; i++) product *= 1 + (i + 1) * 1e-3 * node[i];
    sum += product;
  }
  return sum;
}

static void assert_same(const mesh_fe *a, const mesh_fe *b, double tolerance) {
  const size_t each = (size_t)mesh_topology_of(a->kind)->nodes;
  assert_true(a->kind == b->kind && a->n_nodes == b->n_nodes && a->n_elements == b->n_elements);
  assert_memory_equal(a->node_tag, b->node_tag, (size_t)a->n_nodes * sizeof(long));
  for (int e = 0; e < a->n_elements; e++) { /* gmsh sorts elements by volume */
    const size_t at = (size_t)(a->element_tag[e] - 11) / 5;
    assert_int_equal(a->element_tag[e], b->element_tag[at]);
    assert_memory_equal(a->connectivity + each * (size_t)e, b->connectivity + each * at,
                        each * sizeof(int));
    assert_int_equal(a->region[e], b->region[at]);
  }
  for (int i = 0; i < 3 * a->n_nodes; i++)
    assert_near(a->coordinates[i], b->coordinates[i], tolerance * fabs(b->coordinates[i]));
  assert_int_equal(mesh_fe_sets(a), mesh_fe_sets(b));
  for (int s = 0; s < mesh_fe_sets(a); s++) {
    assert_int_equal(a->set[s].n, b->set[s].n);
    assert_near(fold(a, s), fold(b, s), 1e-12 * fold(b, s));
  }
}

/* .msh has 17 digits; .inp 20 characters, that is 14 digits at least. */
static void meshes_come_back(void **state) {
  (void)state;
  const shb_provenance none = {0};
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++)
    for (int inp = 0; inp < 2; inp++) {
      mesh_fe mesh = make_mesh((mesh_kind)kind), again;
      char    path[sizeof scratch_folder + 16];
      snprintf(path, sizeof path, "%s/box.%s", scratch_folder, inp ? "inp" : "msh");
      assert_ok(inp ? mesh_inp_write(&mesh, path) : mesh_msh_write(&mesh, path, &none));
      assert_ok(mesh_fe_read(path, &names, &again));
      assert_same(&again, &mesh, inp ? 1e-14 : 0);
      mesh_fe_free(&again);
      mesh_fe_free(&mesh);
    }
}

/* The format that docs/developer/map.md names for meshes of solids. */
static void the_format_is_the_one_stated(void **state) {
  (void)state;
  const shb_provenance none = {0};
  mesh_fe              mesh = make_mesh(MESH_TET10);
  char                 path[sizeof scratch_folder + 16];
  char                 head[20];
  snprintf(path, sizeof path, "%s/box.msh", scratch_folder);
  assert_ok(mesh_msh_write(&mesh, path, &none));
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
  fclose(file);
  assert_memory_equal(head, "$MeshFormat\n2.2 0 8\n", sizeof head);
  mesh_fe_free(&mesh);
}

static void a_folder_that_is_absent_is_told(void **state) {
  (void)state;
  const shb_provenance none = {0};
  mesh_fe              mesh = make_mesh(MESH_TET10);
  char                 path[sizeof scratch_folder + 16];
  snprintf(path, sizeof path, "%s/no/box", scratch_folder);
  assert_int_equal(mesh_msh_write(&mesh, path, &none), SHB_ERR_IO);
  assert_has(shb_message(), "cannot be written");
  assert_int_equal(mesh_inp_write(&mesh, path), SHB_ERR_IO);
  assert_has(shb_message(), "cannot be written");
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(meshes_come_back),
                                     cmocka_unit_test(the_format_is_the_one_stated),
                                     cmocka_unit_test(a_folder_that_is_absent_is_told)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
