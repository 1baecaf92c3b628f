#include "mesh/io/msh_write.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/gmsh/provenance.h"

/* Tags of volumes follow those of the groups. */
static int volume_tag(const mesh_fe *mesh, int element) {
  return mesh_fe_sets(mesh) + 1 + (mesh->region ? mesh->region[element] : 0);
}

static void write_groups(const mesh_fe *mesh, FILE *file) {
  int sets = mesh_fe_sets(mesh), volumes = mesh->n_regions ? mesh->n_regions : 1, groups = volumes;
  for (int s = 0; s < sets; s++) groups += mesh->set[s].n > 0;
  fprintf(file, "$PhysicalNames\n%d\n", groups);
  for (int i = 0; i < volumes; i++)
    fprintf(file, "3 %d \"%s\"\n", sets + 1 + i, mesh->n_regions ? mesh->region_name[i] : "body");
  for (int s = 0; s < sets; s++)
    if (mesh->set[s].n) fprintf(file, "2 %d \"%s\"\n", s + 1, mesh_fe_set_name(mesh, s));
  fprintf(file, "$EndPhysicalNames\n");
}

static void write_nodes(const mesh_fe *mesh, FILE *file) {
  fprintf(file, "$Nodes\n%d\n", mesh->n_nodes);
  for (int i = 0; i < mesh->n_nodes; i++) {
    const double *x = mesh->coordinates + 3 * (size_t)i;
    fprintf(file, "%ld %.17g %.17g %.17g\n", mesh->node_tag[i], x[0], x[1], x[2]);
  }
  fprintf(file, "$EndNodes\n");
}

/* Line "tag type 2 group entity nodes"; the entity is the group. */
static void write_one(const mesh_fe *mesh, long tag, int type, int group, const int *nodes, int n,
                      FILE *file) {
  fprintf(file, "%ld %d 2 %d %d", tag, type, group, group);
  for (int i = 0; i < n; i++) fprintf(file, " %ld", mesh->node_tag[nodes[i]]);
  fputc('\n', file);
}

static void write_elements(const mesh_fe *mesh, FILE *file) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  long                 total = mesh->n_elements, last = 0;
  for (int s = 0; s < mesh_fe_sets(mesh); s++) total += mesh->set[s].n;
  fprintf(file, "$Elements\n%ld\n", total);
  for (int e = 0; e < mesh->n_elements; e++) {
    long tag = mesh->element_tag[e];
    last     = tag > last ? tag : last;
    write_one(mesh, tag, topology->gmsh, volume_tag(mesh, e),
              mesh->connectivity + topology->nodes * (size_t)e, topology->nodes, file);
  }
  for (int s = 0; s < mesh_fe_sets(mesh); s++)
    for (int f = 0; f < mesh->set[s].n; f++)
      write_one(mesh, ++last, topology->gmsh_face, s + 1,
                mesh->set[s].nodes + topology->face_nodes * (size_t)f, topology->face_nodes, file);
  fprintf(file, "$EndElements\n");
}

static shb_status write_text(const mesh_fe *mesh, const char *temporary, const char *path) {
  FILE *file = fopen(temporary, "wb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  write_groups(mesh, file);
  write_nodes(mesh, file);
  write_elements(mesh, file);
  bool good = !ferror(file);
  good      = fclose(file) == 0 && good;
  SHB_CHECK(good, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
  return SHB_OK;
}

shb_status mesh_msh_write(const mesh_fe *mesh, const char *path, const shb_provenance *provenance) {
  char      *temporary = shb_publish_temporary(path);
  shb_status status    = write_text(mesh, temporary, path);
  if (status == SHB_OK) status = mesh_provenance_append(temporary, provenance);
  if (status == SHB_OK) status = shb_publish(temporary, path);
  if (status != SHB_OK) unlink(temporary);
  free(temporary);
  return status;
}
