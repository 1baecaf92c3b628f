/* Meshes in every format of gmsh, solids meshed here, groups by rule, units; refused input. */
#include "mesh/io/source.h"

#include <gmshc.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/core/face_match.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/size_estimate.h"
#include "mesh/io/inp_write.h"
#include "mesh/io/msh_write.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/read_mesh.h"
#include "tests/support/read_source.h"
#include "tests/support/scratch_folder.h"

enum { BLADES = 23 };

static const double size[3]  = {0.237, 0.041, 0.023};
static const int    cells[3] = {3, 2, 2};

/* Summed area vector of a group's corners, m2. */
static void area(const mesh_fe *mesh, mesh_set_id id, double sum[3]) {
  const mesh_topology *t = mesh_topology_of(mesh->kind);
  sum[0] = sum[1] = sum[2] = 0;
  for (int f = 0; f < mesh->set[id].n; f++)
    for (int c = 2; c < t->face_corners; c++) {
      const int *n = mesh->set[id].nodes + t->face_nodes * f;
      double     a[3], b[3];
      for (int d = 0; d < 3; d++) {
        a[d] = mesh->coordinates[3 * n[c - 1] + d] - mesh->coordinates[3 * n[0] + d];
        b[d] = mesh->coordinates[3 * n[c] + d] - mesh->coordinates[3 * n[0] + d];
      }
      for (int d = 0; d < 3; d++)
        sum[d] += 0.5 * (a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
    }
}

static void assert_area(const mesh_fe *mesh, mesh_set_id id, double x, double y, double z) {
  double sum[3];
  area(mesh, id, sum);
  assert_near(sum[0], x, 1e-12);
  assert_near(sum[1], y, 1e-12);
  assert_near(sum[2], z, 1e-12);
}

/* Volume of straight tetrahedra (det J / 6) or of equal bricks (det J). */
static double volume(const mesh_fe *mesh) {
  double sum = 0;
  for (int e = 0; e < mesh->n_elements; e++)
    sum += mesh_jacobian_least(mesh, e) / (mesh->kind == MESH_HEX20 ? 1 : 6);
  return sum;
}

/* The box through gmsh into one of its formats. */
static void convert(const char *from, const char *to, double version, double binary) {
  mesh_session kernel;
  int          ierr = 0;
  assert_ok(mesh_session_open(&kernel));
  gmshOpen(from, &ierr);
  gmshOptionSetNumber("Mesh.MshFileVersion", version, &ierr);
  gmshOptionSetNumber("Mesh.Binary", binary, &ierr);
  gmshWrite(to, &ierr);
  assert_int_equal(ierr, 0);
  mesh_session_close(&kernel);
}

static void every_msh_format_is_read(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++)
    for (int format = 0; format < 4; format++) {
      mesh_fe     box, mesh;
      double      version = format < 2 ? 2.2 : 4.1;
      const char *to      = scratch("other.msh");
      assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &box) : box_mesh(size, cells, &box));
      assert_ok(box_write(&box, scratch("box.msh")));
      convert(scratch("box.msh"), to, version, format % 2);
      FILE *file = fopen(to, "rb");
      char  line[64], head[32];
      assert_non_null(file);
      assert_non_null(fgets(line, sizeof line, file));
      assert_non_null(fgets(line, sizeof line, file));
      fclose(file);
      snprintf(head, sizeof head, "%g %d 8", version, format % 2);
      assert_int_equal(strncmp(line, head, strlen(head)), 0); /* it is what it should be */
      assert_ok(read_mesh(to, &mesh));
      assert_int_equal(mesh.kind, kind);
      assert_int_equal(mesh.n_nodes, box.n_nodes);
      assert_int_equal(mesh.n_elements, box.n_elements);
      assert_near(volume(&mesh), volume(&box), 1e-18);
      for (int i = 0; i < 3 * box.n_nodes && version == 4.1; i++) /* 2.2: gmsh numbers anew */
        assert_near(mesh.coordinates[i], box.coordinates[i], format % 2 ? 0 : 1e-16);
      assert_area(&mesh, MESH_ROOT, -size[1] * size[2], 0, 0);
      assert_area(&mesh, MESH_LOAD, 0, 0, size[0] * size[1]);
      mesh_fe_free(&mesh);
      mesh_fe_free(&box);
    }
}

static void what_is_written_comes_back(void **state) {
  (void)state;
  const shb_provenance origin = {.case_path = "case.yaml", .settings = "a = 1\n"};
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe     box, mesh;
    const char *path = scratch("own.msh");
    assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &box) : box_mesh(size, cells, &box));
    assert_ok(mesh_msh_write(&box, path, &origin));
    assert_ok(read_mesh(path, &mesh));
    assert_int_equal(mesh.n_nodes, box.n_nodes);
    assert_memory_equal(mesh.coordinates, box.coordinates, 3 * (size_t)box.n_nodes * 8);
    assert_area(&mesh, MESH_ROOT, -size[1] * size[2], 0, 0);
    mesh_fe_free(&mesh);
    mesh_fe_free(&box);
  }
  mesh_fe none = {0};
  assert_int_equal(mesh_msh_write(&none, "/nowhere/a.msh", &origin), SHB_ERR_IO);
}

/* A mesh without groups, in mm: planes, a radius and the nearest face. */
static void rules_find_the_faces(void **state) {
  (void)state;
  const char *const name[2] = {"bare.msh", "bare.inp"};
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++)
    for (int format = 0; format < 2; format++) {
      mesh_fe     box, mesh;
      mesh_source source = {.path = scratch(name[format]), .unit = 1e-3, .axis = MESH_AXIS_Z};
      assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &box) : box_mesh(size, cells, &box));
      for (int i = 0; i < 3 * box.n_nodes; i++) box.coordinates[i] *= 1e3;
      box.set[MESH_ROOT].n = box.set[MESH_LOAD].n = 0;
      assert_ok(format ? mesh_inp_write(&box, source.path) : box_write(&box, source.path));
      mesh_fe_free(&box);
      assert_source_refused(&source, "group root is absent");
      source.rules.usual[MESH_ROOT] = (mesh_rule){
          .kind = MESH_RULE_PLANE, .at = {0, 9, 9}, .normal = {-3, 0, 0}, .tolerance = 1e-6};
      source.rules.usual[MESH_LOAD] = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.1, .02, .03}};
      source.rules.usual[MESH_CONTACT_RIGHT] =
          (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.1, -.001, .012}};
      assert_ok(mesh_source_read(&source, NULL, &mesh));
      assert_area(&mesh, MESH_ROOT, -size[1] * size[2], 0, 0);
      assert_area(&mesh, MESH_LOAD, 0, 0, size[0] * size[1]);
      assert_area(&mesh, MESH_CONTACT_RIGHT, 0, -size[0] * size[2], 0);
      assert_int_equal(mesh.set[MESH_CONTACT_LEFT].n, 0);
      mesh_fe_free(&mesh);
      source.rules.usual[MESH_ROOT].at[0] = -.001;
      assert_source_refused(&source, "mesh.groups.root: ");
      assert_source_refused(&source, "the nearest is 0.001 m off");
      source.rules.usual[MESH_ROOT].normal[0] = 0;
      assert_source_refused(&source, "has no direction");
    }
}

/* The curved inner face of a ring segment, whose facets bend by some degrees: by radius, and as the
 * nearest face. */
static void curved_faces_are_found(void **state) {
  (void)state;
  const int   many[3] = {2, 6, 2};
  mesh_fe     box, mesh;
  mesh_source source = {.path = scratch("ring.msh"), .unit = 1, .axis = MESH_AXIS_X};
  assert_ok(box_mesh(size, many, &box));
  for (int i = 0; i < box.n_nodes; i++) {
    double *x     = box.coordinates + 3 * i;
    double  angle = SHB_PI / 4 * (x[1] / size[1] - .5), r = .31 + x[2];
    x[1] = r * sin(angle);
    x[2] = r * cos(angle);
  }
  box.set[MESH_ROOT].n = box.set[MESH_LOAD].n = 0;
  assert_ok(box_write(&box, source.path));
  source.rules.usual[MESH_ROOT] =
      (mesh_rule){.kind = MESH_RULE_RADIUS, .radius = .31, .tolerance = 1e-9};
  source.rules.usual[MESH_LOAD] = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.1, 0, .2}};
  assert_source_refused(&source, "ring.msh: groups load and root share 24 of 24 faces, one at (");
  assert_source_refused(&source, "what is clamped does not move");
  source.rules.usual[MESH_ROOT].kind = MESH_RULE_NONE;
  mesh_fe other;
  source.rules.usual[MESH_ROOT]      = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.1, 0, .2}};
  source.rules.usual[MESH_LOAD].kind = MESH_RULE_NONE;
  assert_ok(mesh_source_read(&source, NULL, &other));
  source.rules.usual[MESH_ROOT] =
      (mesh_rule){.kind = MESH_RULE_RADIUS, .radius = .31, .tolerance = 1e-9};
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  assert_int_equal(mesh.set[MESH_ROOT].n, 2 * many[0] * many[1]);
  assert_int_equal(other.set[MESH_ROOT].n, 2 * many[0] * many[1]);
  assert_memory_equal(mesh.set[MESH_ROOT].nodes, other.set[MESH_ROOT].nodes,
                      6 * (size_t)mesh.set[MESH_ROOT].n * sizeof(int));
  mesh_fe_free(&other);
  mesh_fe_free(&mesh);
  source.rules.usual[MESH_ROOT].radius = .32;
  assert_source_refused(&source, "no face at radius 0.32 m; the nearest is 0.01 m off");
  mesh_fe_free(&box);
}

static void groups_may_have_other_names(void **state) {
  (void)state;
  mesh_fe     box, mesh;
  mesh_source source = {.path = scratch("named.inp"), .unit = 1, .axis = MESH_AXIS_Z};
  assert_ok(box_mesh(size, cells, &box));
  assert_ok(mesh_inp_write(&box, source.path));
  source.rules.usual[MESH_ROOT].kind = MESH_RULE_NAME;
  strcpy(source.rules.usual[MESH_ROOT].name, "load");
  source.rules.usual[MESH_LOAD].kind = MESH_RULE_NAME;
  strcpy(source.rules.usual[MESH_LOAD].name, "root");
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  assert_area(&mesh, MESH_ROOT, 0, 0, size[0] * size[1]);
  mesh_fe_free(&mesh);
  source.path = scratch("named.msh");
  assert_ok(box_write(&box, source.path));
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  assert_area(&mesh, MESH_ROOT, 0, 0, size[0] * size[1]);
  mesh_fe_free(&mesh);
  mesh_fe_free(&box);
}

/* Contact on clamped faces, one face in two groups, and rules without sense are refused. */
static void groups_that_cannot_be_right(void **state) {
  (void)state;
  mesh_fe         box, mesh;
  const double    far    = 900;
  mesh_source     source = {.path = scratch("wrong.msh"), .unit = 1, .axis = MESH_AXIS_Z};
  const mesh_rule clamp  = {.kind = MESH_RULE_PLANE, .normal = {1, 0, 0}, .tolerance = 1e-6};
  assert_ok(box_mesh(size, cells, &box));
  assert_ok(box_write(&box, source.path));
  mesh_fe_free(&box);
  source.rules.usual[MESH_CONTACT_RIGHT] = clamp;
  assert_source_refused(&source, "groups contact_right and root share 8 of 8 faces, one at (0, ");
  source.rules.usual[MESH_CONTACT_RIGHT].normal[0] = 0;
  source.rules.usual[MESH_CONTACT_RIGHT].normal[1] =
      1; /* it meets the clamp along an edge, which is allowed */
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  mesh_fe_free(&mesh);
  source.rules.usual[MESH_CONTACT_LEFT] = source.rules.usual[MESH_CONTACT_RIGHT];
  assert_source_refused(&source, "groups contact_right and contact_left share 12 of 12 faces");
  source.rules.usual[MESH_CONTACT_LEFT].kind       = MESH_RULE_NONE;
  source.rules.usual[MESH_CONTACT_RIGHT].tolerance = 1;
  assert_source_refused(&source,
                        "mesh.groups.contact_right.tolerance: 1 m is too wide for the body of");
  assert_source_refused(
      &source, "which measures 0.242 m: other faces would be taken too; give at most 0.0024 m");
  source.rules.usual[MESH_CONTACT_RIGHT] =
      (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.1, .01, far}};
  assert_source_refused(
      &source, "mesh.groups.contact_right.nearest: (0.1, 0.01, 900) m is 900 m off the body");
}

static void put(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* A block as a script in mm, and exported as STEP (mm) and BREP (numbers only). */
static void solids_are_meshed(void **state) {
  (void)state;
  const char *const name[3] = {"block.geo", "block.step", "block.brep"};
  put(scratch("block.geo"), "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, -10, 300, 40, 20, 50};\n");
  mesh_session kernel;
  int          ierr = 0;
  assert_ok(mesh_session_open(&kernel));
  gmshOpen(scratch("block.geo"), &ierr);
  gmshWrite(scratch("block.step"), &ierr);
  gmshWrite(scratch("block.brep"), &ierr);
  assert_int_equal(ierr, 0);
  mesh_session_close(&kernel);
  for (int i = 0; i < 3; i++) {
    mesh_fe     mesh;
    mesh_source source = {.path = scratch(name[i]), .unit = 1e-3, .size = .01, .axis = MESH_AXIS_X};
    source.rules.usual[MESH_ROOT] = (mesh_rule){
        .kind = MESH_RULE_PLANE, .at = {0, 0, .3}, .normal = {0, 0, 1}, .tolerance = 1e-6};
    source.rules.usual[MESH_LOAD] = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.05, 0, .32}};
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    assert_near(volume(&mesh), .04 * .02 * .05, 1e-10);
    assert_in_range(mesh.n_elements, 100, 2000);
    assert_area(&mesh, MESH_ROOT, 0, 0, -.04 * .02);
    assert_area(&mesh, MESH_LOAD, .02 * .05, 0, 0);
    int coarse = mesh.n_elements;
    mesh_fe_free(&mesh);
    source.size = .004;
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    assert_true(mesh.n_elements > 2 * coarse);
    mesh_fe_free(&mesh);
  }
}

/* A sector whose sides are meshed independently unless they are made periodic. */
static void sides_are_made_to_match(void **state) {
  (void)state;
  mesh_fe     mesh;
  mesh_source source = {.path       = scratch("sector.geo"),
                        .unit       = 1,
                        .size       = .012,
                        .axis       = MESH_AXIS_X,
                        .blades     = BLADES,
                        .n_contacts = 1,
                        .contact    = {{"contact_right", "contact_left"}}};
  put(source.path,
      "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, .3, 0, .05, .04};\n"
      "Extrude {{1, 0, 0}, {0, 0, 0}, 2*Pi/23} { Surface{1}; }\n"
      "MeshSize{ PointsOf{ Surface{1}; } } = .007;\n");
  source.rules.usual[MESH_ROOT] =
      (mesh_rule){.kind = MESH_RULE_RADIUS, .radius = .3, .tolerance = 1e-6};
  source.rules.usual[MESH_CONTACT_RIGHT] =
      (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.02, .32, 0}};
  double angle = SHB_TWO_PI / BLADES, r = .32;
  source.rules.usual[MESH_CONTACT_LEFT] =
      (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.02, r * cos(angle), r * sin(angle)}};
  for (int tied = 0; tied < 2; tied++) {
    int pairs = 0, *right = NULL, *left = NULL;
    source.blades = tied ? BLADES : 0;
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    assert_ok(mesh_fe_orient(&mesh, source.axis));
    shb_status status = mesh_fe_match(&mesh, source.axis, BLADES, &pairs, &right, &left);
    assert_int_equal(status, tied ? SHB_OK : SHB_ERR_INPUT);
    if (tied) assert_true(pairs > 50);
    free(right);
    free(left);
    mesh_fe_free(&mesh);
  }
}

/* A disc with a blade, in mm: of a script and of a STEP file the cyclic sides match by rule. */
static void cyclic_sides_of_solids_match(void **state) {
  (void)state;
  const double angle = SHB_TWO_PI / BLADES, r = .32;
  int          ierr = 0;
  mesh_session session;
  put(scratch("disc.geo"),
      "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 300, 0, 50, 40};\n"
      "Extrude {{1, 0, 0}, {0, 0, 0}, 2*Pi/23} { Surface{1}; }\n"
      "Box(2) = {10, 330, 40, 30, 60, 10};\nBooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; "
      "}\n");
  assert_ok(mesh_session_open(&session));
  gmshOpen(scratch("disc.geo"), &ierr);
  gmshWrite(scratch("disc.step"), &ierr);
  assert_int_equal(ierr, 0);
  mesh_session_close(&session);
  for (int step = 0; step < 2; step++) {
    mesh_fe           mesh;
    mesh_cyclic_sides sides;
    mesh_source       source = {.path   = scratch(step ? "disc.step" : "disc.geo"),
                                .unit   = 1e-3,
                                .size   = .014,
                                .axis   = MESH_AXIS_X,
                                .blades = BLADES};
    source.rules.usual[MESH_ROOT] =
        (mesh_rule){.kind = MESH_RULE_RADIUS, .radius = .3, .tolerance = 1e-6};
    source.rules.usual[MESH_CYCLIC_LEFT] =
        (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.02, r, 0}};
    source.rules.usual[MESH_CYCLIC_RIGHT] =
        (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {.02, r * cos(angle), r * sin(angle)}};
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    assert_ok(mesh_cyclic_pair(&mesh, source.axis, BLADES, &sides));
    print_message("%s: %d pairs, gap %.1e m\n", step ? "STEP" : ".geo", sides.n, sides.gap);
    assert_true(sides.n > 20 && sides.gap < 1e-9);
    mesh_fe_free(&mesh);
  }
}

static const char block_text[] = /* 40 x 10 x 100 mm of gmsh's own geometry */
    "Point(1)={0,0,100,%g};Point(2)={40,0,100,%g};Point(3)={40,10,100,%g};Point(4)={0,10,100,%g};\n"
    "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};\n"
    "Line Loop(1)={1,2,3,4};Plane Surface(1)={1};Extrude{0,0,100}{Surface{1};}\n";

static void put_block(const char *path, double h) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, block_text, h, h, h, h);
  fclose(file);
}

/* The estimate is near the mesh; a mesh that no memory holds is refused before it is made. */
static void nodes_are_foreseen(void **state) {
  (void)state;
  const mesh_extent block       = {.length = .6, .area = 10.8e-3, .volume = 4e-5};
  const double      of[]        = {4e-3, 2e-3};
  mesh_source       source      = {.path = scratch("many.geo"), .unit = 1e-3, .axis = MESH_AXIS_X};
  source.rules.usual[MESH_ROOT] = (mesh_rule){
      .kind = MESH_RULE_PLANE, .at = {0, 0, .1}, .normal = {0, 0, 1}, .tolerance = 1e-6};
  for (int i = 0; i < 4; i++) {
    mesh_fe mesh;
    double  h = of[i / 2];
    put_block(source.path, i % 2 ? 1e3 * h : 5);
    source.size = i % 2 ? 0 : h;
    assert_ok(mesh_source_read(&source, NULL, &mesh));
    double ratio = mesh_estimate_nodes(&block, h) / mesh.n_nodes;
    if (!(ratio > .7 && ratio < 1.5)) fail_msg("size %g: %g of the nodes foreseen", h, ratio);
    mesh_fe_free(&mesh);
  }
  double least = mesh_estimate_size(&block, 1e5);
  assert_near(mesh_estimate_nodes(&block, least), 1e5, 500);
  source.size = 1e-9;
  assert_source_refused(&source,
                        "many.geo: mesh.size 1e-09 m would give about 2.5e+16 nodes; with ");
  source.size = 0;
  put_block(source.path, 1e-7);
  assert_source_refused(&source,
                        "many.geo: its own element size of 4e-07 m would give about 1.6e+11 nodes");
  put(source.path, "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 100, 40, 10, 100};\n");
  source.size = 1e-6;
  assert_source_refused(&source, "many.geo: mesh.size 1e-06 m would give about 2.4e+14 nodes");
}

/* Nodes and most memory, bytes, of a process of its own that meshes the block. */
static double memory_of(const mesh_source *source, double h, int *nodes) {
  int           ends[2], status;
  struct rusage used;
  assert_int_equal(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    mesh_fe mesh;
    put_block(source->path, 1e3 * h);
    if (mesh_source_read(source, NULL, &mesh) != SHB_OK) _exit(1);
    _exit(write(ends[1], &mesh.n_nodes, sizeof mesh.n_nodes) != sizeof mesh.n_nodes);
  }
  assert_int_equal(wait4(child, &status, 0, &used), child);
  assert_int_equal(status, 0);
  assert_int_equal(read(ends[0], nodes, sizeof *nodes), sizeof *nodes);
  close(ends[0]);
  close(ends[1]);
  return 1024. * (double)used.ru_maxrss;
}

/* The memory that is foreseen against that of a mesh. The first test: a heap that other meshes left
 * would be used again. */
static void memory_is_foreseen(void **state) {
  (void)state;
  mesh_source source            = {.path = scratch("block.geo"), .unit = 1e-3, .axis = MESH_AXIS_X};
  source.rules.usual[MESH_ROOT] = (mesh_rule){
      .kind = MESH_RULE_PLANE, .at = {0, 0, .1}, .normal = {0, 0, 1}, .tolerance = 1e-6};
  int          few, many;
  const double least = memory_of(&source, 8e-3, &few), most = memory_of(&source, 2e-3, &many);
  const double told = mesh_estimate_bytes(many) - mesh_estimate_bytes(few);
  print_message("%d nodes more: told %.1f MB, measured %.1f MB\n", many - few, 1e-6 * told,
                1e-6 * (most - least));
#ifndef __SANITIZE_ADDRESS__ /* its heap is larger */
  assert_true(told > 0.8 * (most - least) && told < 3 * (most - least));
#endif
}

static void bad_solids_are_refused(void **state) {
  (void)state;
  mesh_source source = {.path = scratch("bad.step"), .unit = 1, .size = .01};
  mesh_fe     mesh;
  put(source.path, "ISO-10303-21;\nnothing\n");
  assert_source_refused(&source, "bad.step: ");
  source.path = scratch("bad.geo");
  put(source.path, "Point(1) = {0, 0, 0};\n");
  assert_source_refused(&source, "bad.geo: holds no solid");
  put(source.path, "Point(1) = {0, 0;\n");
  assert_source_refused(&source, "bad.geo: ");
  put(source.path, "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nFoo(3) = {;\n");
  assert_source_refused(&source, "line 3: syntax error");
  put(source.path, "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n");
  source.size = .5;
  assert_source_refused(&source, "group root is absent");
  source.path = scratch("none.brep");
  assert_int_equal(mesh_source_read(&source, NULL, &mesh), SHB_ERR_IO);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_foreseen),
      cmocka_unit_test(every_msh_format_is_read),
      cmocka_unit_test(what_is_written_comes_back),
      cmocka_unit_test(rules_find_the_faces),
      cmocka_unit_test(curved_faces_are_found),
      cmocka_unit_test(groups_may_have_other_names),
      cmocka_unit_test(solids_are_meshed),
      cmocka_unit_test(sides_are_made_to_match),
      cmocka_unit_test(cyclic_sides_of_solids_match),
      cmocka_unit_test(bad_solids_are_refused),
      cmocka_unit_test(groups_that_cannot_be_right),
      cmocka_unit_test(nodes_are_foreseen),
  };
  return cmocka_run_group_tests_name("mesh.source", tests, scratch_make, scratch_remove);
}
