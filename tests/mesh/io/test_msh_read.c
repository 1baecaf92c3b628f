/* Meshes read without gmsh are those that gmsh gives; what is not foreseen is left to gmsh. */
#include "mesh/blade/blade.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/import.h"
#include "mesh/gmsh/session.h"
#include "mesh/io/msh_read.h"
#include "mesh/io/msh_write.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/odd_blade.h"
#include "tests/support/scratch_folder.h"

static char path[sizeof scratch_folder + 16];

static void by_gmsh(const mesh_names *names, mesh_fe *mesh) {
  mesh_session session;
  int          ierr = 0;
  assert_ok(mesh_session_open(&session));
  gmshMerge(path, &ierr);
  assert_int_equal(ierr, 0);
  assert_ok(mesh_import(path, names, mesh));
  mesh_session_close(&session);
}

/* Every number and its place. */
static void assert_equal_bits(const mesh_fe *a, const mesh_fe *b) {
  const mesh_topology *topology = mesh_topology_of(a->kind);
  const size_t         n = (size_t)a->n_nodes, each = (size_t)topology->nodes;
  assert_true(a->kind == b->kind && a->n_nodes == b->n_nodes && a->n_elements == b->n_elements);
  assert_memory_equal(a->coordinates, b->coordinates, 3 * n * sizeof(double));
  assert_memory_equal(a->node_tag, b->node_tag, n * sizeof(long));
  assert_memory_equal(a->element_tag, b->element_tag, (size_t)a->n_elements * sizeof(long));
  assert_memory_equal(a->connectivity, b->connectivity, each * (size_t)a->n_elements * sizeof(int));
  assert_string_equal(a->found, b->found);
  assert_int_equal(mesh_fe_sets(a), mesh_fe_sets(b));
  for (int s = 0; s < mesh_fe_sets(a); s++) {
    const size_t all = (size_t)(topology->face_nodes * a->set[s].n);
    assert_string_equal(mesh_fe_set_name(a, s), mesh_fe_set_name(b, s));
    assert_int_equal(a->set[s].n, b->set[s].n);
    if (all) assert_memory_equal(a->set[s].nodes, b->set[s].nodes, all * sizeof(int));
  }
}

static void compare(const mesh_names *names) {
  mesh_fe own, other;
  assert_true(mesh_msh_read(path, names, &own));
  by_gmsh(names, &other);
  assert_equal_bits(&own, &other);
  mesh_fe_free(&own);
  mesh_fe_free(&other);
}

static void write_blade(mesh_kind kind) {
  const shb_provenance none  = {0};
  mesh_blade           blade = odd_blade();
  blade.elements             = kind;
  assert_ok(mesh_blade_write(&blade, path, &none, NULL));
}

/* Version 4.1, as gmsh writes it. */
static void blades_are_those_of_gmsh(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    write_blade((mesh_kind)kind);
    compare(NULL);
  }
}

/* A box with tags that are not in order, two volumes and a group with another name.
 *   twice  in  two nodes have the same tag */
static void write_box(mesh_kind kind, bool twice) {
  const double         size[3]  = {0.7, 0.31, 0.23};
  const int            cells[3] = {2, 2, 1};
  const shb_provenance none     = {.settings = "mesh: {}\n"};
  mesh_fe              mesh;
  assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh));
  mesh.n_more = 1;
  snprintf(mesh.more[0], sizeof mesh.more[0], "lower snubber");
  assert_ok(box_set(&mesh, (mesh_set_id)MESH_N_SETS, 0, size[0]));
  mesh.n_regions   = 2;
  mesh.region_name = calloc(2, sizeof *mesh.region_name);
  mesh.region      = malloc((size_t)mesh.n_elements * sizeof *mesh.region);
  snprintf(mesh.region_name[0], MESH_WORD, "foot");
  snprintf(mesh.region_name[1], MESH_WORD, "tip");
  for (int e = 0; e < mesh.n_elements; e++) mesh.region[e] = e % 3 == 1;
  for (int i = 0; i < mesh.n_nodes; i++) mesh.node_tag[i] = 1 + (long)i * 131 % mesh.n_nodes;
  for (int e = 0; e < mesh.n_elements; e++) mesh.element_tag[e] = 5 * e + 11;
  if (twice) mesh.node_tag[3] = mesh.node_tag[8];
  assert_ok(mesh_msh_write(&mesh, path, &none));
  mesh_fe_free(&mesh);
}

/* Version 2.2. */
static void boxes_are_those_of_gmsh(void **state) {
  (void)state;
  const mesh_names names = {.set    = {[MESH_ROOT] = "load", [MESH_LOAD] = "root"},
                            .n_more = 1,
                            .more   = {{"snubber", "lower snubber"}}};
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    write_box((mesh_kind)kind, false);
    compare(NULL);
    compare(&names);
  }
}

/* The whole file; free it. */
static char *read_text(void) {
  char  *text = NULL;
  size_t size = 0;
  FILE  *file = fopen(path, "r");
  assert_non_null(file);
  assert_true(getdelim(&text, &size, 0, file) > 0);
  fclose(file);
  return text;
}

/* The text with to in the place of from is left to gmsh. */
static void assert_left(const char *text, const char *from, const char *to) {
  mesh_fe     mesh;
  const char *at   = strstr(text, from);
  FILE       *file = fopen(path, "w");
  assert_true(file && at);
  fprintf(file, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
  fclose(file);
  assert_false(mesh_msh_read(path, NULL, &mesh));
  assert_int_equal(mesh.n_nodes, 0);
}

static void what_is_not_foreseen_is_left_to_gmsh(void **state) {
  (void)state;
  const mesh_names volumes = {.n_volumes = 1, .volume = {{.label = "foot", .name = "foot"}}};
  mesh_fe          mesh;
  write_box(MESH_TET10, true);
  assert_false(mesh_msh_read(path, NULL, &mesh));
  write_box(MESH_TET10, false);
  assert_false(mesh_msh_read(path, &volumes, &mesh));
  char *text = read_text();
  assert_left(text, "2.2 0 8", "2.2 1 8");
  assert_left(text, "2.2 0 8", "2.1 0 8");
  assert_left(text, "$Nodes", "$Periodic\n0\n$EndPeriodic\n$Nodes");
  assert_left(text, "$Nodes\n", "$Nodes\n1");
  assert_left(text, "$EndNodes", "1 0 0 0\n$EndNodes");
  assert_left(text, "11 11 2", "11 4 2"); /* four nodes */
  assert_left(text, "11 11 2", "11 11 3");
  assert_left(text, "11 11 2", "-11 11 2");
  assert_left(text, "$EndElements", "");
  assert_left(text, "$EndComments", "");
  assert_left(text, "\"load\"", "\"load");
  free(text);
}

static void a_file_that_is_absent_is_not_read(void **state) {
  (void)state;
  mesh_fe mesh;
  assert_false(mesh_msh_read("/no/such.msh", NULL, &mesh));
}

static int make(void **state) {
  const int code = scratch_make(state);
  snprintf(path, sizeof path, "%s/a.msh", scratch_folder);
  return code;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(blades_are_those_of_gmsh),
                                     cmocka_unit_test(boxes_are_those_of_gmsh),
                                     cmocka_unit_test(what_is_not_foreseen_is_left_to_gmsh),
                                     cmocka_unit_test(a_file_that_is_absent_is_not_read)};
  return cmocka_run_group_tests(tests, make, scratch_remove);
}
