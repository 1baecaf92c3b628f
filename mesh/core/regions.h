/* Which volume each element lies in: every one in exactly one of those that are asked for. */
#ifndef MESH_CORE_REGIONS_H
#define MESH_CORE_REGIONS_H

#include "mesh/core/fe_mesh.h"

typedef struct {
  const char       *path;
  const mesh_names *names;
  mesh_fe          *mesh;
  int twice, element, other; /* elements in two volumes; the first, its other volume */
} mesh_regions;

/* Names of the further groups into an empty mesh; names may be NULL. */
void mesh_regions_name(const mesh_names *names, mesh_fe *mesh);

/* Makes mesh->region for the names' volumes, no element in any. path heads error texts. SHB_ERR_IO no memory. */
shb_status mesh_regions_begin(const char *path, const mesh_names *names, mesh_fe *mesh,
                              mesh_regions *regions);

/* An element lies in volume i. */
void mesh_regions_assign(mesh_regions *regions, int element, int volume);

/* SHB_ERR_INPUT: elements in no volume, or in two; their number and one of them are named. */
shb_status mesh_regions_end(const mesh_regions *regions);

#endif
