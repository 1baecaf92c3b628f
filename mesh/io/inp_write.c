#include "mesh/io/inp_write.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "mesh/base/arena.h"
#include "mesh/base/publish.h"
#include "mesh/io/inp_table.h"

/* Label 1, 2, ... of the face of element e with the corners of face, or 0. */
static int face_label(const mesh_fe *mesh, int e, const int *face) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int           *node     = mesh->connectivity + (size_t)topology->nodes * (size_t)e;
  for (int label = 1; label <= topology->faces; label++) {
    const int *local = topology->face[mesh_inp_face(mesh->kind, label)];
    int        same  = 0;
    for (int i = 0; i < topology->face_corners; i++)
      for (int j = 0; j < topology->face_corners; j++) same += node[local[i]] == face[j];
    if (same == topology->face_corners) return label;
  }
  return 0;
}

typedef struct {
  int set, face, corner; /* corner: the smallest node index of the face's corners */
} group_face;

static int by_corner(const void *a, const void *b) {
  return ((const group_face *)a)->corner - ((const group_face *)b)->corner;
}

/* Faces of all sets, sorted by their smallest corner. */
static group_face *list_faces(const mesh_fe *mesh, shb_arena *arena, int *n) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  size_t               total    = 0;
  for (int s = 0; s < mesh_fe_sets(mesh); s++) total += (size_t)mesh->set[s].n;
  group_face *list = shb_arena_take(arena, total, sizeof *list);
  *n               = 0;
  for (int s = 0; s < mesh_fe_sets(mesh); s++)
    for (int f = 0; f < mesh->set[s].n; f++) {
      const int *node  = mesh->set[s].nodes + (size_t)topology->face_nodes * (size_t)f;
      int        least = node[0];
      for (int i = 1; i < topology->face_corners; i++) least = node[i] < least ? node[i] : least;
      list[(*n)++] = (group_face){s, f, least};
    }
  qsort(list, total, sizeof *list, by_corner);
  return list;
}

/* Element and label of each face of each group: element[set][face], label[set][face]. */
static void locate(const mesh_fe *mesh, const group_face *list, int n,
                   int *const element[MESH_MAX_SETS], int *const label[MESH_MAX_SETS]) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int e = 0; e < mesh->n_elements; e++)
    for (int c = 0; c < topology->corners; c++) {
      group_face  key   = {.corner =
                               mesh->connectivity[(size_t)topology->nodes * (size_t)e + (size_t)c]};
      group_face *found = bsearch(&key, list, (size_t)n, sizeof *list, by_corner);
      while (found && found > list && found[-1].corner == key.corner) found--;
      for (; found && found < list + n && found->corner == key.corner; found++) {
        int s = found->set, f = found->face;
        int at = face_label(mesh, e, mesh->set[s].nodes + topology->face_nodes * (size_t)f);
        if (!at) continue;
        element[s][f] = e;
        label[s][f]   = at;
      }
    }
}

/* Print the fewest digits that reproduce the number, within the 20 characters that CalculiX
 * reads. */
static void print_real(FILE *file, double value) {
  char text[40];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, NULL) == value) break;
  }
  for (int digits = 17; digits > 1; digits--) {
    char *zero = strstr(text, "0.");
    if (zero == text + (*text == '-')) memmove(zero, zero + 1, strlen(zero)); /* -0.5 as -.5 */
    if (strlen(text) <= 20) break;
    snprintf(text, sizeof text, "%.*g", digits - 1, value);
  }
  fprintf(file, ", %s", text);
}

/* Name of the set of all elements, different from the volumes' names. */
static const char *body_name(const mesh_fe *mesh) {
  for (int i = 0; i < mesh->n_regions; i++)
    if (strcasecmp(mesh->region_name[i], "body") == 0) return "whole_body";
  return "body";
}

static void write_body(const mesh_fe *mesh, FILE *file) {
  fprintf(file, "*NODE, NSET=nodes\n");
  for (int i = 0; i < mesh->n_nodes; i++) {
    fprintf(file, "%ld", mesh->node_tag[i]);
    for (int d = 0; d < 3; d++) print_real(file, mesh->coordinates[3 * (size_t)i + (size_t)d]);
    fputc('\n', file);
  }
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  fprintf(file, "*ELEMENT, TYPE=%s, ELSET=%s\n", mesh->kind == MESH_HEX20 ? "C3D20R" : "C3D10",
          body_name(mesh));
  for (int e = 0; e < mesh->n_elements; e++) { /* a row holds 16 numbers at most */
    const int *node = mesh->connectivity + topology->nodes * (size_t)e;
    fprintf(file, "%ld", mesh->element_tag[e]);
    for (int i = 0; i < topology->nodes; i++)
      fprintf(file, i == 12 ? ",\n%ld" : ", %ld", mesh->node_tag[node[topology->vtk_order[i]]]);
    fputc('\n', file);
  }
}

static void write_volumes(const mesh_fe *mesh, FILE *file) {
  for (int i = 0; i < mesh->n_regions; i++) {
    fprintf(file, "*ELSET, ELSET=%s\n", mesh->region_name[i]);
    for (int e = 0; e < mesh->n_elements; e++)
      if (mesh->region[e] == i) fprintf(file, "%ld\n", mesh->element_tag[e]);
  }
}

/* Node sets of the groups, for *BOUNDARY and similar cards. */
static void write_node_sets(const mesh_fe *mesh, char *marked, FILE *file) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->face_nodes;
  for (int s = 0; s < mesh_fe_sets(mesh); s++) {
    const mesh_face_set *set = &mesh->set[s];
    memset(marked, 0, (size_t)mesh->n_nodes);
    for (size_t i = 0; i < each * (size_t)set->n; i++) marked[set->nodes[i]] = 1;
    if (set->n > 0) fprintf(file, "*NSET, NSET=%s\n", mesh_fe_set_name(mesh, s));
    for (int i = 0; i < mesh->n_nodes; i++)
      if (marked[i]) fprintf(file, "%ld\n", mesh->node_tag[i]);
  }
}

static void write_groups(const mesh_fe *mesh, int *const element[MESH_MAX_SETS],
                         int *const label[MESH_MAX_SETS], FILE *file) {
  for (int s = 0; s < mesh_fe_sets(mesh); s++) {
    if (mesh->set[s].n > 0)
      fprintf(file, "*SURFACE, NAME=%s, TYPE=ELEMENT\n", mesh_fe_set_name(mesh, s));
    for (int f = 0; f < mesh->set[s].n; f++)
      fprintf(file, "%ld, S%d\n", mesh->element_tag[element[s][f]], label[s][f]);
  }
}

static void write_all(const mesh_fe *mesh, FILE *file) {
  shb_arena   arena                  = {0};
  int        *element[MESH_MAX_SETS] = {0}, *label[MESH_MAX_SETS] = {0}, n = 0;
  group_face *list   = list_faces(mesh, &arena, &n);
  char       *marked = shb_arena_take(&arena, (size_t)mesh->n_nodes, 1);
  for (int s = 0; s < mesh_fe_sets(mesh); s++) {
    element[s] = shb_arena_take(&arena, (size_t)mesh->set[s].n, sizeof **element);
    label[s]   = shb_arena_take(&arena, (size_t)mesh->set[s].n, sizeof **label);
  }
  locate(mesh, list, n, element, label);
  write_body(mesh, file);
  write_volumes(mesh, file);
  write_node_sets(mesh, marked, file);
  write_groups(mesh, element, label, file);
  shb_arena_free(&arena);
}

shb_status mesh_inp_write(const mesh_fe *mesh, const char *path) {
  char      *temporary = shb_publish_temporary(path);
  FILE      *file      = fopen(temporary, "wb");
  int        why       = errno;
  shb_status status    = SHB_OK;
  if (file) {
    write_all(mesh, file);
    bool good = !ferror(file);
    why       = errno;
    good      = fclose(file) == 0 && good;
    if (good) status = shb_publish(temporary, path);
    if (!good) file = NULL;
  }
  if (!file)
    status =
        shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: cannot be written: %s", path, strerror(why));
  if (status != SHB_OK) unlink(temporary);
  free(temporary);
  return status;
}
