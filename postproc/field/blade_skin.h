/* The surface of a blade as flat triangles, with the nodes that lie on it. */
#ifndef POSTPROC_FIELD_BLADE_SKIN_H
#define POSTPROC_FIELD_BLADE_SKIN_H

#include "mesh/core/fe_mesh.h"

typedef struct {
  int    n_nodes, n_triangles;
  int   *node;     /* [n_nodes] of the mesh */
  int   *triangle; /* [n_triangles][3] indices into node, outward */
  float *normal;   /* [n_nodes][3] unit, outward, weighted by area */
} post_skin;

/* A face is divided at its nodes. Errors: SHB_ERR_IO no memory. To be freed in any case. */
shb_status post_skin_create(const mesh_fe *mesh, post_skin *skin);
void       post_skin_free(post_skin *skin); /* also on a zeroed struct */

#endif
