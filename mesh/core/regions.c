#include "mesh/core/regions.h"

#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/memory.h"

void mesh_regions_name(const mesh_names *names, mesh_fe *mesh) {
  mesh->n_more = names ? names->n_more : 0;
  for (int i = 0; i < mesh->n_more; i++)
    snprintf(mesh->more[i], sizeof mesh->more[i], "%s", names->more[i].label);
}

void mesh_regions_begin(const char *path, const mesh_names *names, mesh_fe *mesh,
                        mesh_regions *regions) {
  *regions          = (mesh_regions){.path = path, .names = names, .mesh = mesh};
  mesh->n_regions   = names->n_volumes;
  mesh->region_name = shb_alloc_zeroed((size_t)names->n_volumes, sizeof *mesh->region_name);
  mesh->region      = shb_alloc((size_t)mesh->n_elements, sizeof *mesh->region);
  for (int i = 0; i < names->n_volumes; i++)
    snprintf(mesh->region_name[i], MESH_WORD, "%s", names->volume[i].label);
  for (int e = 0; e < mesh->n_elements; e++) mesh->region[e] = -1;
}

void mesh_regions_assign(mesh_regions *r, int element, int volume) {
  int *region = &r->mesh->region[element];
  if (*region >= 0 && *region != volume && r->twice++ == 0) {
    r->element = element;
    r->other   = volume;
  }
  if (*region < 0) *region = volume;
}

/* Mean of the corners and middles of an element, m. */
static void centre_of(const mesh_fe *mesh, int element, double centre[3]) {
  const int n = mesh_topology_of(mesh->kind)->nodes;
  for (int d = 0; d < 3; d++) {
    centre[d] = 0;
    for (int i = 0; i < n; i++)
      centre[d] += mesh->coordinates[3 * mesh->connectivity[element * n + i] + d] / n;
  }
}

shb_status mesh_regions_end(const mesh_regions *r) {
  const mesh_fe *mesh = r->mesh;
  int            none = 0, first = 0;
  for (int e = mesh->n_elements - 1; e >= 0; e--) {
    if (mesh->region[e] >= 0) continue;
    none++;
    first = e;
  }
  SHB_CHECK(r->twice == 0, SHB_ERR_INPUT,
            "%s: %d element%s in two volumes of materials, such as element %ld (%s and %s); every "
            "element needs one material",
            r->path, r->twice, r->twice == 1 ? " is" : "s are", mesh->element_tag[r->element],
            mesh->region_name[mesh->region[r->element]], mesh->region_name[r->other]);
  double at[3];
  centre_of(mesh, first, at);
  SHB_CHECK(none == 0, SHB_ERR_INPUT,
            "%s: %d of %d elements %s in no volume of materials, such as element %ld at [%.4g, "
            "%.4g, %.4g] m; every element needs one material",
            r->path, none, mesh->n_elements, none == 1 ? "is" : "are", mesh->element_tag[first],
            at[0], at[1], at[2]);
  return SHB_OK;
}
