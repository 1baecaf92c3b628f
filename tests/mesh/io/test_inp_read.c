/* Abaqus and CalculiX meshes: written and read back, all ways to name a group, faults with their
 * line. */

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

#include "mesh/io/inp_write.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

static const double size[3]  = {0.237, 0.041, 0.023};
static const int    cells[3] = {3, 2, 1};

static char path[300];

static int set_up(void **state) {
  int failed = scratch_make(state);
  snprintf(path, sizeof path, "%s/bar.inp", scratch_folder);
  return failed;
}

/* Fails if a test left another file behind. */
static int tear_down(void **state) {
  (void)state;
  unlink(path);
  return rmdir(scratch_folder);
}

static void put(const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* Reading fails with these words in one line, headed by the file and, unless line is 0, its
 * line. */
static void refused(int line, const char *words) {
  mesh_fe    mesh;
  char       head[320];
  shb_status status = read_mesh(path, &mesh);
  snprintf(head, sizeof head, line ? "%s:%d: " : "%s: ", path, line);
  if (status != SHB_ERR_INPUT || !strstr(shb_message(), words) ||
      strncmp(shb_message(), head, strlen(head)) != 0)
    fail_msg("status %d, text '%s'; wanted '%s' with '%s'", status, shb_message(), head, words);
  assert_null(strchr(shb_message(), '\n'));
  assert_null(mesh.coordinates);
  assert_null(mesh.connectivity);
}

/* The same nodes in any order; other tests check the orientation. */
static int same_nodes(const int *a, const int *b, int n) {
  int same = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) same += a[i] == b[j];
  return same == n;
}

static void same_faces(const mesh_fe *a, const mesh_fe *b, mesh_set_id id) {
  const int each = mesh_topology_of(a->kind)->face_nodes;
  assert_int_equal(a->set[id].n, b->set[id].n);
  for (int f = 0; f < a->set[id].n; f++) {
    int found = 0;
    for (int g = 0; g < b->set[id].n; g++)
      found += same_nodes(a->set[id].nodes + each * f, b->set[id].nodes + each * g, each);
    assert_int_equal(found, 1);
  }
}

static void same_mesh(const mesh_fe *a, const mesh_fe *b) {
  assert_int_equal(a->n_nodes, b->n_nodes);
  assert_int_equal(a->n_elements, b->n_elements);
  assert_memory_equal(a->coordinates, b->coordinates, 3 * (size_t)a->n_nodes * sizeof(double));
  assert_int_equal(a->kind, b->kind);
  assert_memory_equal(a->connectivity, b->connectivity,
                      (size_t)(mesh_topology_of(a->kind)->nodes * a->n_elements) * sizeof(int));
  assert_memory_equal(a->node_tag, b->node_tag, (size_t)a->n_nodes * sizeof(long));
  for (int id = 0; id < MESH_N_SETS; id++) same_faces(a, b, (mesh_set_id)id);
}

/* All four groups, on sides that use each face of a tetrahedron. */
static void full_box(mesh_kind kind, mesh_fe *box) {
  shb_status status = kind == MESH_HEX20 ? box_hex(size, cells, box) : box_mesh(size, cells, box);
  assert_int_equal(status, SHB_OK);
  assert_int_equal(box_set(box, MESH_CONTACT_RIGHT, 1, 0), SHB_OK);
  assert_int_equal(box_set(box, MESH_CONTACT_LEFT, 1, size[1]), SHB_OK);
}

static void what_was_written_comes_back(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe box, mesh;
    full_box((mesh_kind)kind, &box);
    for (int i = 0; i < box.n_nodes; i++) box.node_tag[i] = 7 + 3L * i;
    assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
    assert_int_equal(read_mesh(path, &mesh), SHB_OK);
    same_mesh(&mesh, &box); /* bit for bit */
    mesh_fe_free(&mesh);
    mesh_fe_free(&box);
  }
}

/* Coordinates of 17 digits of any size and sign: neighbours of the originals, in 20 characters
 * each. */
/* A byte order mark first; lines that end in CR LF, or in CR. */
static void other_ends_of_lines_are_read(void **state) {
  (void)state;
  mesh_fe box, mesh;
  full_box(MESH_TET10, &box);
  for (int way = 0; way < 4; way++) {
    assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
    FILE  *file = fopen(path, "rb");
    char  *text = calloc(1, 1 << 20);
    size_t n    = fread(text, 1, (1 << 20) - 1, file);
    assert_true(n > 1000 && n < (1 << 20) - 1);
    fclose(file);
    file = fopen(path, "wb");
    if (way != 1) fputs("\xEF\xBB\xBF", file);
    for (size_t i = 0; i < n; i++) {
      if (text[i] == '\n' && way > 0) fputc('\r', file);
      if (text[i] != '\n' || way < 2) fputc(text[i], file);
      if (text[i] == '\n' && way == 3) fputc('\r', file); /* empty lines between */
    }
    fclose(file);
    free(text);
    shb_status status = read_mesh(path, &mesh);
    if (status != SHB_OK) fail_msg("way %d: %s", way, shb_message());
    same_mesh(&box, &mesh);
    mesh_fe_free(&mesh);
  }
  mesh_fe_free(&box);
}

static void numbers_fit_calculix(void **state) {
  (void)state;
  mesh_fe box, mesh;
  full_box(MESH_TET10, &box);
  for (int i = 0; i < 3 * box.n_nodes; i++) {
    double shake = 1e-4 * sin(1. + 7. * i);
    box.coordinates[i] += shake;
    if (i % 3 == 0) box.coordinates[i] -= .4;
  }
  assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
  FILE *file = fopen(path, "r");
  char  line[256];
  assert_non_null(file);
  while (fgets(line, sizeof line, file))
    for (char *word = strtok(line, ", \n"); word; word = strtok(NULL, ", \n"))
      assert_true(strlen(word) <= 20 || strncmp(word, "TYPE=", 5) == 0);
  fclose(file);
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  for (int i = 0; i < 3 * box.n_nodes; i++)
    assert_true(fabs(mesh.coordinates[i] - box.coordinates[i]) <=
                6e-16 * fabs(box.coordinates[i]) + 1e-18); /* m */
  mesh_fe_free(&mesh);
  mesh_fe_free(&box);
}

static void cannot_be_written_nowhere(void **state) {
  (void)state;
  mesh_fe box;
  full_box(MESH_TET10, &box);
  assert_int_equal(mesh_inp_write(&box, "/nowhere/bar.inp"), SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "/nowhere/bar.inp: cannot be written"));
  mesh_fe_free(&box);
}

/* As other programs write: capitals, several rows an element, sets of sets, ranges, triangles, the
 * name of an instance. */
static void write_otherwise(const mesh_fe *box, FILE *file) {
  const mesh_topology *topology = mesh_topology_of(box->kind);
  fprintf(file, "** a comment\n*Heading\n a, b, c\n*Part, name=P\n*NODE\n");
  for (int i = box->n_nodes - 1; i >= 0; i--)
    fprintf(file, "%d ,%.17gD+0,\t%.17g,%.17g\r\n", i + 1, box->coordinates[3 * i],
            box->coordinates[3 * i + 1], box->coordinates[3 * i + 2]);
  fprintf(file, "999999, 1., 2., 3.\n*element , type = c3d%d ,\n elset=\"Part body\"\n",
          topology->nodes);
  for (int e = 0; e < box->n_elements; e++) {
    const int *node = box->connectivity + topology->nodes * e;
    fprintf(file, "%d, ", e + 1);
    for (int i = 0; i < topology->nodes; i++)
      fprintf(file, "%d,%s", node[topology->vtk_order[i]] + 1, i % 4 == 3 ? "\n" : " ");
    fprintf(file, "\n\n");
  }
  const mesh_face_set *load = &box->set[MESH_LOAD];
  fprintf(file, "*ELEMENT, TYPE=CPS%d, ELSET=LOAD\n", topology->face_nodes);
  for (int f = 0; f < load->n; f++) {
    fprintf(file, "%d", box->n_elements + 1 + f);
    for (int i = 0; i < topology->face_nodes; i++)
      fprintf(file, ", %d", load->nodes[topology->face_nodes * f + i] + 1);
    fprintf(file, "\n");
  }
  fprintf(file, "*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n");
}

/* Nodes of x = 0 as two ranges and single ones; nodes of y = 0 as a surface of nodes. */
static void write_sets(const mesh_fe *box, FILE *file) {
  int first = 0;
  fprintf(file, "*NSET, NSET=half\n");
  for (int i = 0; i < box->n_nodes / 2; i++)
    if (box->coordinates[3 * i] == 0) fprintf(file, "%d,\n", i + 1);
  fprintf(file, "*NSET, NSET=rest, GENERATE\n");
  for (int i = box->n_nodes / 2; i < box->n_nodes; i++) {
    if (box->coordinates[3 * i] != 0) continue;
    if (first) fprintf(file, "%d, %d, %d\n", first, i + 1, i + 1 - first);
    first = first ? 0 : i + 1;
  }
  if (first) fprintf(file, "%d, %d\n", first, first);
  fprintf(file, "*Nset, nset=ROOT, instance=P-1\nhalf, P-1.rest\n");
  fprintf(file, "*NSET, NSET=bottom\n");
  for (int i = 0; i < box->n_nodes; i++)
    if (box->coordinates[3 * i + 1] == 0) fprintf(file, "%d,\n", i + 1);
  fprintf(file, "*SURFACE, TYPE=NODE, NAME=Contact_Right\nbottom\n");
  fprintf(file, "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, .3\n*STEP\n*STATIC\n*END STEP\n");
}

static void other_ways_to_write_are_read(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe box, mesh;
    full_box((mesh_kind)kind, &box);
    box.set[MESH_CONTACT_LEFT].n = 0;
    FILE *file                   = fopen(path, "w");
    assert_non_null(file);
    write_otherwise(&box, file);
    write_sets(&box, file);
    fclose(file);
    assert_int_equal(read_mesh(path, &mesh), SHB_OK);
    same_mesh(&mesh, &box);
    mesh_fe_free(&mesh);
    mesh_fe_free(&box);
  }
}

/* A unit tetrahedron with its middles: lines 1 to 11 hold the nodes, 12 and 13 the element. */
#define NODES                                                                            \
  "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n" \
  "9,.5,0,.5\n10,0,.5,.5\n"
#define ELEMENT "*ELEMENT, TYPE=C3D10, ELSET=E\n1,1,2,3,4,5,6,7,8,9,10\n"

#define A(name) "*NSET, NSET=" name "\na\n"

typedef struct {
  const char *text;
  int         line;
  const char *words;
} fault;

static void every_face_label_is_right(void **state) {
  (void)state;
  static const int corners[4][3] = {{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
  for (int s = 0; s < 4; s++) {
    char    text[512];
    mesh_fe mesh;
    snprintf(text, sizeof text, NODES ELEMENT "*SURFACE, NAME=root\nE, S%d\n", s + 1);
    put(text);
    assert_int_equal(read_mesh(path, &mesh), SHB_OK);
    assert_int_equal(mesh.set[MESH_ROOT].n, 1);
    int same = 0;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        same += mesh.node_tag[mesh.set[MESH_ROOT].nodes[i]] == corners[s][j];
    assert_int_equal(same, 3);
    mesh_fe_free(&mesh);
  }
}

/* The unit cube's S1 to S6 by the coordinate that its nodes share. */
static void every_label_of_a_hexahedron_is_right(void **state) {
  (void)state;
  static const int    direction[6] = {2, 2, 1, 0, 1, 0};
  static const double value[6]     = {0, 1, 0, 1, 1, 0};
  const double        unit[3]      = {1, 1, 1};
  const int           one[3]       = {1, 1, 1};
  for (int s = 0; s < 6; s++) {
    mesh_fe box, mesh;
    char    line[256];
    assert_int_equal(box_hex(unit, one, &box), SHB_OK);
    assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
    char other[310];
    snprintf(other, sizeof other, "%s.other", path);
    FILE *from = fopen(path, "r"), *to = fopen(other, "w");
    assert_true(from && to);
    while (fgets(line, sizeof line, from) && strncmp(line, "*NSET", 5) != 0) fputs(line, to);
    fprintf(to, "*SURFACE, NAME=root, TYPE=ELEMENT\nbody, S%d\n", s + 1);
    fclose(from);
    fclose(to);
    assert_int_equal(rename(other, path), 0);
    assert_int_equal(read_mesh(path, &mesh), SHB_OK);
    assert_int_equal(mesh.set[MESH_ROOT].n, 1);
    for (int i = 0; i < 8; i++)
      assert_true(mesh.coordinates[3 * mesh.set[MESH_ROOT].nodes[i] + direction[s]] == value[s]);
    mesh_fe_free(&mesh);
    mesh_fe_free(&box);
  }
}

static void faults_are_named_with_their_line(void **state) {
  (void)state;
  static const fault faults[] = {
      {"", 0, "no volume elements"},
      {NODES ELEMENT, 0, "group root is absent or empty; a physical surface (in .inp a *SURFACE"},
      {"*NODE\n1, 0, 0\n", 2, "*NODE: 3 values"},
      {"*NODE\n1, 0, 0, zero\n", 2, "'zero' is not a number"},
      {"*NODE\n1, 0, nan, 0\n", 2, "'nan' is not a number"},
      {"*NODE\n1, 0, 1e999, 0\n", 2, "'1e999' is not a number"},
      {"*NODE\n1, 0, , 0\n", 2, "'' is not a number"},
      {"*NODE\n1.5, 0, 0, 0\n", 2, "'1.5' is not a number of a node"},
      {"*NODE\n-1, 0, 0, 0\n", 2, "'-1' is not a number of a node"},
      {"*NODE, SYSTEM=X\n1, 0, 0, 0\n", 1, "*NODE: SYSTEM=X; expected R, C or S"},
      {"*SYSTEM\n0, 0, 0, 1, 0, 0\n2, 0, 0\n", 1, "*SYSTEM: its points lie on a line"},
      {"** x\n*INCLUDE, INPUT=mesh/nodes.inp\n", 2, "*INCLUDE: 'mesh/nodes.inp' is no file"},
      {"*INCLUDE\n", 1, "*INCLUDE: names no file; give INPUT=FILE"},
      {"*Include, input='bar.inp'\n", 1, "*INCLUDE: 'bar.inp' includes itself"},
      {"*NODE, INPUT=none.csv\n", 1, "*NODE: 'none.csv' is no file"},
      {NODES "1, 2, 3, 4\n", 12, "node 1 is given twice, first in line 2"},
      {NODES ELEMENT "1,1,2,3,4,5,6,7,8,9,10\n", 14, "element 1 is given twice, first in line 13"},
      {NODES "*ELEMENT, TYPE=C3D10\n1,1,2,3,4,5,6,7,8\n", 13,
       "element 1 has 8 nodes, C3D10 needs 10"},
      {NODES "*ELEMENT, TYPE=C3D10\n1,1,2,3,4,5,6,7,8,9,10,11,12\n", 13, "more than the 10 nodes"},
      {NODES "*ELEMENT, TYPE=C3D10\n1,1,2,3,4,5,6,7,8,9,77\n", 13,
       "element 1 uses node 77, which is absent"},
      {NODES "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n", 12,
       "C3D4 is not supported; C3D10 and C3D20 are: second"},
      {NODES "*ELEMENT, TYPE=C3D15\n", 12, "C3D15 is not supported"},
      {NODES "*ELEMENT\n", 12, "(none) is not supported"},
      {NODES ELEMENT "*NGEN\n1, 5, 1\n", 14, "*NGEN is not supported"},
      {NODES ELEMENT "*NSET\n1\n", 14, "*NSET without a name"},
      {NODES ELEMENT "*NSET, NSET=root\n1, 2, side\n", 15, "node set 'side' is not defined"},
      {NODES ELEMENT "*NSET, NSET=root\n1, 2, 3\n", 14, "its 3 nodes hold no whole face"},
      {NODES ELEMENT "*NSET, NSET=root\n1, 2, 3, 5, 6, 7, 11\n", 15, "node 11 is not in the file"},
      {NODES ELEMENT "*NSET, NSET=root, GENERATE\n5, 1, 1\n", 15, "5 to 1 counts down"},
      {NODES ELEMENT "*NSET, NSET=root, GENERATE\n5\n", 15, "expected first, last, step"},
      {NODES ELEMENT "*NSET, NSET=root, GENERATE\n1, 999999999999\n", 15,
       "'999999999999' is not a number of a node or an element (1 to 999999999)"},
      {NODES ELEMENT "*NSET, NSET=root, GENERATE\n1, 100000000\n", 15,
       "GENERATE: 100000000 more members are too many for a file of "},
      {NODES ELEMENT "*NSET, NSET=top\n1\ntop,top,top,top\ntop,top,top,top\ntop,top,top,top\n", 17,
       "top: 128 more members are too many for a file of "},
      {NODES ELEMENT "*NSET, NSET=a, GENERATE\n1, 480\n" A("b") A("c") A("d") A("e") A("f") A("g")
           A("h") A("i") A("j") A("k") A("l") A("m") A("n") A("o") A("p") A("q") A("r") A("s")
               A("t") A("u"),
       49, "now sets have 8640 members in all, too many for a file of "},
      {NODES ELEMENT "*NSET, NSET=root\n", 14, "group root is empty"},
      {NODES ELEMENT "*SURFACE, NAME=root\n1\n", 15, "'1 alone'; expected"},
      {NODES ELEMENT "*SURFACE, NAME=root\n1, S7\n", 15, "expected an element or element set"},
      {NODES ELEMENT "*SURFACE, NAME=root\n1, S5\n", 15, "a ten-node tetrahedron has no face S5"},
      {NODES ELEMENT "*ELEMENT, TYPE=S8, ELSET=root\n2,1,2,3,4,5,6,7,8\n", 15,
       "element 2 has 8 nodes; a face of the body has 6"},
      {NODES ELEMENT "*ELEMENT, TYPE=C3D20R\n2,1,2,3,4,5,6,7,8,9,10,1,2,3,4,5,6\n7,8,9,10\n", 15,
       "tetrahedra and hexahedra in one mesh"},
      {NODES ELEMENT "*SURFACE, NAME=root\n7, S1\n", 15, "element 7 is not in the file"},
      {NODES ELEMENT "*SURFACE\nE, S1\n", 14, "*SURFACE without a name"},
      {NODES ELEMENT "*ELSET, ELSET=root\n1\n", 15, "is a volume, not a face"},
      {NODES ELEMENT "*ELEMENT, TYPE=S6, ELSET=root\n2, 1, 2, 3, 5, 6, 11\n", 15,
       "node 11 of element 2 belongs to no"},
      {NODES ELEMENT "*NSET, NSET=root, ELSET=F\n", 14, "element set 'F' is not defined"},
      {NODES ELEMENT "*SURFACE, NAME=a\nE, S1\n*SURFACE, NAME=root, COMBINE=DIFFERENCE\na\n", 16,
       "COMBINE=DIFFERENCE is not supported"},
      {NODES ELEMENT "*SURFACE, NAME=root, COMBINE=UNION\na\n", 15, "surface 'a' is not defined"},
      {"*PART, NAME=A\n*END PART\n*PART, NAME=B\n", 0, "has 2 parts, but no *INSTANCE"},
      {"*PART, NAME=A\n*END PART\n*PART, NAME=a\n", 3, "there are two of the name 'a'"},
      {"*INSTANCE, NAME=A\n0, 0, 1\n", 1, "there is no *PART '' before it"},
      {"*PART, NAME=P\n*END PART\n*INSTANCE, NAME=A, PART=p\n0, 0, 1\n1, 2\n", 3,
       "its rotation has 2 values"},
      {"*NSET, NSET=a, INSTANCE=I\n1\n", 1, "there is no *INSTANCE 'I' before it"},
      {NODES "*ELEMENT, TYPE=C3D10\n1,1,3,2,4,5,6,7,8,9,10\n*SURFACE, NAME=root\n1, S1\n", 0,
       "1 of 1 elements inverted"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    put(faults[i].text);
    refused(faults[i].line, faults[i].words);
  }
}

static void put_beside(const char *name, const char *text) {
  FILE *file = fopen(scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* Coordinates of the node of that number. */
static const double *node_of(const mesh_fe *mesh, long tag) {
  for (int i = 0; i < mesh->n_nodes; i++)
    if (mesh->node_tag[i] == tag) return mesh->coordinates + 3 * i;
  fail_msg("no node %ld", tag);
  return NULL;
}

static void assert_point(const double *x, double a, double b, double c) {
  assert_near(x[0], a, 1e-15);
  assert_near(x[1], b, 1e-15);
  assert_near(x[2], c, 1e-15);
}

/* The element at the origin of the tests below, read with one group or more. */
static void read_text_mesh(const char *text, mesh_fe *mesh) {
  put(text);
  if (read_mesh(path, mesh) != SHB_OK) fail_msg("%s: %s", text, shb_message());
}

static void included_text_stands_in_its_place(void **state) {
  (void)state;
  static const char whole[] =
      "*NODE\n*INCLUDE, INPUT=rows\n10,0,.5,.5\n*include, input=\"rest of it\"\n";
  mesh_fe mesh;
  put_beside("rows", "1,0,0,0\n2,1,0,0\n3,0,1,0\n*INCLUDE, INPUT=more\n9,.5,0,.5\n");
  put_beside("more", "4,0,0,1\r\n5,.5,0,0\r\n6,.5,.5,0\r\n7,0,.5,0\r\n8,0,0,.5");
  put_beside("rest of it", ELEMENT "*INCLUDE, INPUT=groups\n");
  put_beside("groups", "*SURFACE, NAME=root\nE, S1\n");
  read_text_mesh(whole, &mesh);
  assert_int_equal(mesh.n_nodes, 10);
  assert_int_equal(mesh.set[MESH_ROOT].n, 1);
  assert_point(node_of(&mesh, 8), 0, 0, .5);
  mesh_fe_free(&mesh);
  put_beside("groups", "*SURFACE, NAME=root\n\nE, S9\n");
  put(whole);
  assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "/groups:3: *SURFACE: 'E'; expected"));
  put_beside("groups", "*INCLUDE, INPUT=rest of it\n"); /* in a circle */
  assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "/groups:1: *INCLUDE: 'rest of it' includes itself"));
  put("*NODE, INPUT=rows\n" ELEMENT "*NODE\n10,0,.5,.5\n*SURFACE, NAME=root\n1, S2\n");
  assert_int_equal(read_mesh(path, &mesh), SHB_OK);
  mesh_fe_free(&mesh);
  for (int i = 0; i < 4; i++)
    unlink(scratch((const char *const[]){"rows", "more", "rest of it", "groups"}[i]));
}

static void instances_are_moved_and_then_turned(void **state) {
  (void)state;
  mesh_fe mesh;
  read_text_mesh("*PART, NAME=P\n" NODES ELEMENT
                 "*NSET, NSET=foot\n1,2,3,5,6,7\n"
                 "*SURFACE, NAME=contact_right\nE, S2\n*END PART\n*ASSEMBLY, NAME=all\n"
                 "*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n"
                 "*INSTANCE, NAME=B, PART=P\n1, 2, 3\n1, 0, 0, 1, 0, 2, 90\n"
                 "*NSET, NSET=own\n1,3,4,7,10,8\n*END INSTANCE\n"
                 "*NSET, NSET=root, INSTANCE=B\nfoot\n*NSET, NSET=load\nA.foot, B.own\n"
                 "*END ASSEMBLY\n",
                 &mesh);
  assert_int_equal(mesh.n_nodes, 20);
  assert_int_equal(mesh.n_elements, 2);
  assert_point(node_of(&mesh, 2), 1, 0, 0);
  assert_point(node_of(&mesh, 11), -1, 0, 3); /* (1, 2, 3) about the line x = 1, y = 0 */
  assert_point(node_of(&mesh, 12), -1, 1, 3);
  assert_point(node_of(&mesh, 14), -1, 0, 4);
  assert_int_equal(mesh.set[MESH_ROOT].n, 1);
  for (int i = 0; i < 6; i++) assert_true(mesh.node_tag[mesh.set[MESH_ROOT].nodes[i]] > 10);
  assert_int_equal(mesh.set[MESH_LOAD].n, 2);
  assert_int_equal(mesh.set[MESH_CONTACT_RIGHT].n, 2); /* of both instances */
  mesh_fe_free(&mesh);
}

/* An instance may have nodes of its own, which move with it. Nodes of the assembly have numbers of
 * their own, and a set of one instance is not that of another one. */
static void assemblies_have_numbers_of_their_own(void **state) {
  (void)state;
  static const char head[] = "*PART, NAME=P\n" NODES ELEMENT
                             "*END PART\n*PART, NAME=Q\n*END PART\n"
                             "*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n"
                             "*INSTANCE, NAME=B, PART=Q\n0, 0, 5\n" NODES ELEMENT
                             "*NSET, NSET=foot\n1,2,3,5,6,7\n*END INSTANCE\n*NODE\n1, 9, 9, 9\n";
  char    text[2048];
  mesh_fe mesh;
  snprintf(text, sizeof text, "%s*NSET, NSET=root\nB.foot\n*NSET, NSET=point\n1\n", head);
  read_text_mesh(text, &mesh);
  assert_int_equal(mesh.n_nodes, 20);
  assert_point(node_of(&mesh, 14), 0, 0, 6);
  assert_int_equal(mesh.set[MESH_ROOT].n, 1);
  for (int i = 0; i < 6; i++) assert_true(mesh.node_tag[mesh.set[MESH_ROOT].nodes[i]] > 10);
  mesh_fe_free(&mesh);
  snprintf(text, sizeof text, "%s*NSET, NSET=root\nA.foot\n", head);
  put(text);
  assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "node set 'A.foot' is not defined"));
}

static void systems_turn_and_move_nodes(void **state) {
  (void)state;
  mesh_fe mesh;
  read_text_mesh(
      "*SYSTEM\n0, 0, 1, 0, 1, 1\n-1, 0, 1\n*NODE, SYSTEM=C\n"
      "1, 0, 0, -1\n2, 1, -90, -1\n3, 1, 0, -1\n*SYSTEM\n*NODE\n4,0,0,1\n5,.5,0,0\n"
      "6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n9,.5,0,.5\n*SYSTEM\n0, .5\n*NODE\n10,0,0,.5\n"
      "*NODE, SYSTEM=S\n11, 1, 0, 90\n" ELEMENT
      "*NSET, NSET=all, ELSET=E\n*SURFACE, NAME=a\nE, S1\n*SURFACE, NAME=b\n1, S2\n"
      "*SURFACE, NAME=root, COMBINE=UNION\na\nb\n"
      "*NSET, NSET=load, GENERATE\n1, 4\n5, 100\n",
      &mesh);
  assert_point(node_of(&mesh, 1), 0, 0, 0);
  assert_point(node_of(&mesh, 2), 1, 0, 0);
  assert_point(node_of(&mesh, 3), 0, 1, 0);
  assert_point(node_of(&mesh, 10), 0, .5, .5);
  assert_int_equal(mesh.n_nodes, 10);
  assert_int_equal(mesh.set[MESH_ROOT].n, 2);
  assert_int_equal(mesh.set[MESH_LOAD].n, 4); /* a range skips numbers that are not there */
  mesh_fe_free(&mesh);
}

static void second_order_types_are_read_whatever_their_suffix(void **state) {
  (void)state;
  static const char *const types[] = {"C3D10MH", "c3d10hs", "C3D10T", "C3D10I"};
  for (int i = 0; i < 4; i++) {
    mesh_fe mesh;
    char    text[512];
    snprintf(text, sizeof text,
             NODES
             "*ELEMENT, TYPE=%s, ELSET=E\n1,1,2,3,4,5,6,7,8,9,10\n*SURFACE, NAME=root\nE, "
             "S1\n",
             types[i]);
    read_text_mesh(text, &mesh);
    mesh_fe_free(&mesh);
  }
}

static void face_inside_is_refused(void **state) {
  (void)state;
  mesh_fe box;
  full_box(MESH_TET10, &box);
  assert_int_equal(box_set(&box, MESH_LOAD, 0, size[0] / cells[0]), SHB_OK);
  assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
  refused(0, "is inside the body");
  mesh_fe_free(&box);
}

/* A file that ends before its groups is not read as a smaller mesh. */
static void cut_files_are_refused(void **state) {
  (void)state;
  mesh_fe box, mesh;
  full_box(MESH_TET10, &box);
  assert_int_equal(mesh_inp_write(&box, path), SHB_OK);
  mesh_fe_free(&box);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  long whole = ftell(file);
  fclose(file);
  for (int part = 15; part >= 0; part--) {
    assert_int_equal(truncate(path, whole * part / 20), 0);
    assert_int_equal(read_mesh(path, &mesh), SHB_ERR_INPUT);
    assert_null(mesh.coordinates);
  }
}

static void other_bytes_are_refused(void **state) {
  (void)state;
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fwrite("*NODE\n1, 0\0, 0, 0\n", 1, 18, file);
  fclose(file);
  refused(2, "not a text file");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_was_written_comes_back),
      cmocka_unit_test(other_ends_of_lines_are_read),
      cmocka_unit_test(numbers_fit_calculix),
      cmocka_unit_test(cannot_be_written_nowhere),
      cmocka_unit_test(other_ways_to_write_are_read),
      cmocka_unit_test(every_face_label_is_right),
      cmocka_unit_test(every_label_of_a_hexahedron_is_right),
      cmocka_unit_test(faults_are_named_with_their_line),
      cmocka_unit_test(included_text_stands_in_its_place),
      cmocka_unit_test(instances_are_moved_and_then_turned),
      cmocka_unit_test(assemblies_have_numbers_of_their_own),
      cmocka_unit_test(systems_turn_and_move_nodes),
      cmocka_unit_test(second_order_types_are_read_whatever_their_suffix),
      cmocka_unit_test(face_inside_is_refused),
      cmocka_unit_test(cut_files_are_refused),
      cmocka_unit_test(other_bytes_are_refused),
  };
  return cmocka_run_group_tests_name("mesh.inp", tests, set_up, tear_down);
}
