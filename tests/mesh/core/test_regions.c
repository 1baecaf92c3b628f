/* Several volumes in a mesh: from gmsh, from solids by name or by a point, from element sets.
 * Elements without a material are refused. */
#include <gmshc.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/gmsh/session.h"
#include "mesh/gmsh/source_settings.h"
#include "mesh/io/inp_write.h"
#include "mesh/io/msh_write.h"
#include "mesh/io/read.h"
#include "mesh/io/source.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/read_mesh.h"
#include "tests/support/read_source.h"
#include "tests/support/scratch_folder.h"

/* Three blocks along x, cut at these places, of which the middle one is "shank". */
static const double cut[4] = {0, .013, .029, .037};

static const char blocks[] =
    "SetFactory(\"OpenCASCADE\");\n"
    "Box(1) = {0, 0, 0, .013, .01, .006};\nBox(2) = {.013, 0, 0, .016, .01, .006};\n"
    "Box(3) = {.029, 0, 0, .008, .01, .006};\nCoherence;\nMesh.MeshSizeMax = .004;\n";

static void put(const char *path, const char *text, const char *more) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fputs(more, file);
  fclose(file);
}

static double middle(const mesh_fe *mesh, int e) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  double               sum      = 0;
  for (int i = 0; i < topology->corners; i++)
    sum += mesh->coordinates[3 * mesh->connectivity[topology->nodes * e + i]] / topology->corners;
  return sum;
}

/* Every element is in the region of the block that contains its middle. */
static void check_blocks(const mesh_fe *mesh, const int region_of_block[3]) {
  int seen[3] = {0};
  assert_non_null(mesh->region);
  for (int e = 0; e < mesh->n_elements; e++) {
    int block = 0;
    while (block < 2 && middle(mesh, e) > cut[block + 1]) block++;
    assert_int_equal(mesh->region[e], region_of_block[block]);
    seen[block]++;
  }
  for (int i = 0; i < 3; i++) assert_true(seen[i] > 5);
}

static mesh_source source_of(const char *path, double unit) {
  mesh_source source = {.path = path, .unit = unit, .axis = MESH_AXIS_X};
  source.rules.usual[MESH_ROOT] =
      (mesh_rule){.kind = MESH_RULE_PLANE, .at = {0, 0, 0}, .normal = {1, 0, 0}, .tolerance = 1e-9};
  source.rules.n_volumes = 2;
  strcpy(source.rules.volume[0].name, "ends");
  strcpy(source.rules.volume[1].name, "shank");
  return source;
}

static void volumes_by_name(void **state) {
  (void)state;
  mesh_fe     mesh, again;
  mesh_source source = source_of(scratch("named.geo"), 1);
  put(source.path, blocks,
      "Physical Volume(\"ends\") = {1, 3};\nPhysical Volume(\"shank\") = {2};\n");
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  check_blocks(&mesh, (const int[]){0, 1, 0});
  assert_string_equal(mesh.region_name[1], "shank");

  const char *written[] = {scratch("again.msh"), scratch("again.inp")};
  assert_ok(mesh_msh_write(&mesh, written[0],
                           &(shb_provenance){.case_path = "c.yaml", .settings = "a = 1\n"}));
  assert_ok(mesh_inp_write(&mesh, written[1]));
  for (int i = 0; i < 2; i++) {
    mesh_names names = mesh_rules_labels(&source.rules);
    assert_ok(mesh_fe_read(written[i], &names, &again));
    assert_int_equal(again.n_elements, mesh.n_elements);
    check_blocks(&again, (const int[]){0, 1, 0});
    mesh_fe_free(&again);
    assert_ok(read_mesh(written[i], &again)); /* one material: volumes do not matter */
    assert_null(again.region);
    mesh_fe_free(&again);
  }
  mesh_fe_free(&mesh);
}

/* A solid without names: three bodies in contact, identified by points inside. */
static void volumes_by_point(void **state) {
  (void)state;
  mesh_session kernel;
  mesh_fe      mesh;
  int          ierr = 0;
  const char  *geo = scratch("solid.geo"), *step = scratch("solid.step"),
             *brep = scratch("solid.brep");
  put(geo, blocks, "");
  assert_ok(mesh_session_open(&kernel));
  gmshOpen(geo, &ierr);
  gmshModelOccSynchronize(&ierr);
  gmshWrite(step, &ierr);
  gmshWrite(brep, &ierr);
  mesh_session_close(&kernel);
  assert_int_equal(ierr, 0);
  for (int i = 0; i < 2; i++) { /* gmsh writes STEP files in mm; here a number of the file is 1 m */
    mesh_source source     = source_of(i ? step : brep, 1);
    source.size            = .004;
    source.rules.n_volumes = 3;
    for (int v = 0; v < 3; v++) {
      double x               = (cut[v] + cut[v + 1]) / 2;
      source.rules.volume[v] = (mesh_named_rule){
          "", {.kind = MESH_RULE_NEAREST, .at = {x, .004, .002}, .tolerance = 1e-6}};
      snprintf(source.rules.volume[v].name, MESH_WORD, "part %d", v);
    }
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    check_blocks(&mesh, (const int[]){0, 1, 2});
    mesh_fe_free(&mesh);
    source.rules.volume[2].rule.at[0] = cut[1] / 2; /* the first once more */
    assert_source_refused(&source, "in two volumes of materials");
  }
}

static void faults_are_told(void **state) {
  (void)state;
  mesh_source source = source_of(scratch("bad.geo"), 1);
  put(source.path, blocks, "Physical Volume(\"ends\") = {1};\nPhysical Volume(\"shank\") = {2};\n");
  assert_source_refused(&source, "are in no volume of materials, such as element ");
  put(source.path, blocks,
      "Physical Volume(\"ends\") = {1, 2, 3};\nPhysical Volume(\"shank\") = {2};\n");
  assert_source_refused(&source, "are in two volumes of materials, such as element ");
  put(source.path, blocks,
      "Physical Volume(\"end\") = {1, 3};\nPhysical Volume(\"shank\") = {2};\n");
  assert_source_refused(&source, "no physical volume 'ends' (there: end, shank)");
  source.rules.volume[0].rule = (mesh_rule){.kind = MESH_RULE_NAME, .name = "end"};
  mesh_fe mesh;
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  check_blocks(&mesh, (const int[]){0, 1, 0});
  mesh_fe_free(&mesh);
}

/* A bar of six tetrahedra a cell, element sets by hand. */
static void element_sets(void **state) {
  (void)state;
  mesh_fe     mesh;
  const char *path = scratch("sets.inp");
  assert_ok(box_mesh((const double[]){.02, .01, .01}, (const int[]){2, 1, 1}, &mesh));
  assert_ok(mesh_inp_write(&mesh, path));
  mesh_fe_free(&mesh);
  FILE *file = fopen(path, "a");
  fputs("*ELSET, ELSET=low, GENERATE\n1, 6\n*ELSET, ELSET=high, GENERATE\n7, 11\n", file);
  fclose(file);
  mesh_names names = {.n_volumes = 2,
                      .volume = {{.label = "low", .name = "LOW"}, {.label = "up", .name = "high"}}};
  assert_int_equal(mesh_fe_read(path, &names, &mesh), SHB_ERR_INPUT);
  assert_non_null(strstr(
      shb_message(), "1 of 12 elements is in no volume of materials, such as element 12 at [0.0"));
  file = fopen(path, "a");
  fputs("*ELSET, ELSET=high\n12\n", file);
  fclose(file);
  assert_ok(mesh_fe_read(path, &names, &mesh));
  for (int e = 0; e < 12; e++) assert_int_equal(mesh.region[e], e >= 6);
  assert_string_equal(mesh.region_name[1], "up");
  mesh_fe_free(&mesh);
  names.volume[1].name = "none";
  assert_int_equal(mesh_fe_read(path, &names, &mesh), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "no element set 'none'"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(volumes_by_name),
      cmocka_unit_test(volumes_by_point),
      cmocka_unit_test(faults_are_told),
      cmocka_unit_test(element_sets),
  };
  return cmocka_run_group_tests_name("mesh.regions", tests, scratch_make, scratch_remove);
}
