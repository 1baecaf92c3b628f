/* Volume of each element: every element lies in exactly one of the volumes asked for. */
#ifndef MESH_CORE_REGIONS_H
#define MESH_CORE_REGIONS_H

#include "mesh/core/fe_mesh.h"

typedef struct {
  const char       *path;
  const mesh_names *names;
  mesh_fe          *mesh;
  int               twice, element,
      other; /* number of elements in two volumes; the first of them, its other volume */
} mesh_regions;

/* Names of the groups besides the usual six, put into an empty mesh; names may be NULL. */
void mesh_regions_name(const mesh_names *names, mesh_fe *mesh);

/* Make mesh->region for the volumes of names, with no element in any.
 *   path  in  heads the messages */
void mesh_regions_begin(const char *path, const mesh_names *names, mesh_fe *mesh,
                        mesh_regions *regions);

/* Element lies in this volume. */
void mesh_regions_assign(mesh_regions *regions, int element, int volume);

/* SHB_ERR_INPUT if elements lie in no volume or in two; the message gives their number and one of
 * them. */
shb_status mesh_regions_end(const mesh_regions *regions);

#endif
