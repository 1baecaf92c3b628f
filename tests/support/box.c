#include "tests/support/box.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Kuhn's cut: one tetrahedron for each permutation of the axes, along the cell's diagonal. The last
 * column is the sign of the permutation. Edges of neighbouring cells agree; their midpoints are
 * exactly the half-cell lattice. */
static const int path_of[6][4] = {{0, 1, 2, 1}, {1, 2, 0, 1}, {2, 0, 1, 1},
                                  {0, 2, 1, 0}, {2, 1, 0, 0}, {1, 0, 2, 0}};

static int lattice(const int n[3], const int at[3]) {
  return at[0] + (2 * n[0] + 1) * (at[1] + (2 * n[1] + 1) * at[2]);
}

static void element(const int n[3], const int cell[3], const int path[4], int *nodes) {
  int corner[4][3];
  for (int d = 0; d < 3; d++) corner[0][d] = 2 * cell[d];
  for (int c = 1; c < 4; c++) {
    memcpy(corner[c], corner[c - 1], sizeof corner[c]);
    corner[c][path[c - 1]] += 2;
  }
  if (!path[3]) { /* odd: swap two corners to keep det J > 0 */
    int swap[3];
    memcpy(swap, corner[1], sizeof swap);
    memcpy(corner[1], corner[2], sizeof swap);
    memcpy(corner[2], swap, sizeof swap);
  }
  for (int c = 0; c < 4; c++) nodes[c] = lattice(n, corner[c]);
  for (int e = 0; e < 6; e++) {
    const int *ends = mesh_topology_of(MESH_TET10)->edge[e];
    int        middle[3];
    for (int d = 0; d < 3; d++) middle[d] = (corner[ends[0]][d] + corner[ends[1]][d]) / 2;
    nodes[4 + e] = lattice(n, middle);
  }
}

static void lattice_point(const int n[3], int i, int at[3]) {
  at[0] = i % (2 * n[0] + 1);
  at[1] = i / (2 * n[0] + 1) % (2 * n[1] + 1);
  at[2] = i / ((2 * n[0] + 1) * (2 * n[1] + 1));
}

static void fill(const double size[3], const int n[3], mesh_fe *mesh) {
  for (int i = 0; i < mesh->n_nodes; i++) {
    int at[3];
    lattice_point(n, i, at);
    for (int d = 0; d < 3; d++) mesh->coordinates[3 * i + d] = size[d] * at[d] / (2 * n[d]);
    mesh->node_tag[i] = i + 1;
  }
  for (int e = 0; e < mesh->n_elements; e++) {
    int c                = mesh->kind == MESH_HEX20 ? e : e / 6;
    int cell[3]          = {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
    mesh->element_tag[e] = e + 1;
    if (mesh->kind == MESH_TET10) {
      element(n, cell, path_of[e % 6], mesh->connectivity + 10 * e);
      continue;
    }
    for (int i = 0; i < 20; i++) {
      const double *place = mesh_topology_of(MESH_HEX20)->place[i];
      int           at[3];
      for (int d = 0; d < 3; d++) at[d] = 2 * cell[d] + (int)(2 * place[d]);
      mesh->connectivity[20 * e + i] = lattice(n, at);
    }
  }
}

static shb_status make(mesh_kind kind, const double size[3], const int n[3], mesh_fe *mesh) {
  const int nodes = mesh_topology_of(kind)->nodes;
  memset(mesh, 0, sizeof *mesh);
  mesh->kind         = kind;
  mesh->n_nodes      = (2 * n[0] + 1) * (2 * n[1] + 1) * (2 * n[2] + 1);
  mesh->n_elements   = (kind == MESH_HEX20 ? 1 : 6) * n[0] * n[1] * n[2];
  mesh->coordinates  = malloc(3 * (size_t)mesh->n_nodes * sizeof(double));
  mesh->node_tag     = malloc((size_t)mesh->n_nodes * sizeof(long));
  mesh->connectivity = malloc((size_t)(nodes * mesh->n_elements) * sizeof(int));
  mesh->element_tag  = malloc((size_t)mesh->n_elements * sizeof(long));
  SHB_CHECK(mesh->coordinates && mesh->node_tag && mesh->connectivity && mesh->element_tag,
            SHB_ERR_IO, "no memory for a box mesh");
  fill(size, n, mesh);
  SHB_TRY(box_set(mesh, MESH_ROOT, 0, 0));
  return box_set(mesh, MESH_LOAD, 2, size[2]);
}

shb_status box_mesh(const double size[3], const int n[3], mesh_fe *mesh) {
  shb_status status = make(MESH_TET10, size, n, mesh);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

static void renumber(int *nodes, int count, const int *index) {
  for (int i = 0; i < count; i++) nodes[i] = index[nodes[i]];
}

/* Removes the lattice points that belong to no element. */
static shb_status compress(const int n[3], mesh_fe *mesh) {
  int *index = malloc((size_t)mesh->n_nodes * sizeof *index), kept = 0;
  SHB_CHECK(index, SHB_ERR_IO, "no memory for a box mesh");
  for (int i = 0; i < mesh->n_nodes; i++) {
    int at[3];
    lattice_point(n, i, at);
    index[i] = at[0] % 2 + at[1] % 2 + at[2] % 2 > 1 ? -1 : kept++;
    if (index[i] < 0) continue;
    memmove(mesh->coordinates + 3 * index[i], mesh->coordinates + 3 * i, 3 * sizeof(double));
    mesh->node_tag[index[i]] = index[i] + 1;
  }
  mesh->n_nodes = kept;
  renumber(mesh->connectivity, 20 * mesh->n_elements, index);
  for (int s = 0; s < MESH_N_SETS; s++) renumber(mesh->set[s].nodes, 8 * mesh->set[s].n, index);
  free(index);
  return SHB_OK;
}

shb_status box_hex(const double size[3], const int n[3], mesh_fe *mesh) {
  shb_status status = make(MESH_HEX20, size, n, mesh);
  if (status == SHB_OK) status = compress(n, mesh);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

static int on_plane(const mesh_fe *mesh, const int *nodes, const int *face, int d, double value) {
  for (int i = 0; i < mesh_topology_of(mesh->kind)->face_nodes; i++)
    if (fabs(mesh->coordinates[3 * nodes[face[i]] + d] - value) > 1e-12) return 0;
  return 1;
}

shb_status box_set(mesh_fe *mesh, mesh_set_id id, int direction, double value) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int            width    = topology->face_nodes;
  mesh_face_set       *set      = &mesh->set[id];
  free(set->nodes);
  set->n     = 0;
  set->nodes = malloc((size_t)(width * topology->faces * mesh->n_elements) * sizeof(int));
  SHB_CHECK(set->nodes, SHB_ERR_IO, "no memory for a box mesh");
  for (int e = 0; e < mesh->n_elements; e++)
    for (int f = 0; f < topology->faces; f++) {
      const int *nodes = mesh->connectivity + topology->nodes * e;
      if (!on_plane(mesh, nodes, topology->face[f], direction, value)) continue;
      for (int i = 0; i < width; i++) set->nodes[width * set->n + i] = nodes[topology->face[f][i]];
      set->n++;
    }
  return SHB_OK;
}

static void write_groups(const mesh_fe *mesh, FILE *file) {
  int groups = 1;
  for (int s = 0; s < MESH_N_SETS; s++) groups += mesh->set[s].n > 0;
  fprintf(file, "$PhysicalNames\n%d\n3 %d \"body\"\n", groups, MESH_N_SETS + 1);
  for (int s = 0; s < MESH_N_SETS; s++)
    if (mesh->set[s].n) fprintf(file, "2 %d \"%s\"\n", s + 1, mesh_set_name((mesh_set_id)s));
  fprintf(file, "$EndPhysicalNames\n");
}

static void write_elements(const mesh_fe *mesh, FILE *file) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int            width    = topology->face_nodes;
  int                  total    = mesh->n_elements;
  long                 next     = 0;
  for (int s = 0; s < MESH_N_SETS; s++) total += mesh->set[s].n;
  fprintf(file, "$Elements\n%d\n", total);
  for (int e = 0; e < mesh->n_elements; e++) {
    fprintf(file, "%ld %d 2 %d 1", mesh->element_tag[e], topology->gmsh, MESH_N_SETS + 1);
    for (int i = 0; i < topology->nodes; i++)
      fprintf(file, " %ld", mesh->node_tag[mesh->connectivity[topology->nodes * e + i]]);
    fputc('\n', file);
    if (mesh->element_tag[e] > next) next = mesh->element_tag[e];
  }
  for (int s = 0; s < MESH_N_SETS; s++)
    for (int f = 0; f < mesh->set[s].n; f++) {
      fprintf(file, "%ld %d 2 %d %d", ++next, topology->gmsh_face, s + 1, s + 1);
      for (int i = 0; i < width; i++)
        fprintf(file, " %ld", mesh->node_tag[mesh->set[s].nodes[width * f + i]]);
      fputc('\n', file);
    }
  fprintf(file, "$EndElements\n");
}

shb_status box_write(const mesh_fe *mesh, const char *path) {
  FILE *file = fopen(path, "w");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be written", path);
  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  write_groups(mesh, file);
  fprintf(file, "$Nodes\n%d\n", mesh->n_nodes);
  for (int i = 0; i < mesh->n_nodes; i++)
    fprintf(file, "%ld %.17g %.17g %.17g\n", mesh->node_tag[i], mesh->coordinates[3 * i],
            mesh->coordinates[3 * i + 1], mesh->coordinates[3 * i + 2]);
  fprintf(file, "$EndNodes\n");
  write_elements(mesh, file);
  SHB_CHECK(fclose(file) == 0, SHB_ERR_IO, "%s: cannot be written", path);
  return SHB_OK;
}
