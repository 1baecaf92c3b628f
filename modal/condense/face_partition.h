/* Dividing a contact face into patches of about equal area. */
#ifndef MODAL_CONDENSE_FACE_PARTITION_H
#define MODAL_CONDENSE_FACE_PARTITION_H

#include "mesh/core/fe_mesh.h"

/* Integrals over the facets of a set, and the patch of each facet. */
typedef struct {
  int n;                                /* facets */
  int nodes;                            /* of a facet */
  double (*area)[MESH_FACE_NODES];      /* [n] integral of N_i dA, m2 */
  double (*normal)[MESH_FACE_NODES][3]; /* [n] integral of N_i n dA, m2 */
  double *total;                        /* [n] facet area, m2 */
  double (*centroid)[3];                /* [n] m */
  int *patch;                           /* [n] */
} modal_facets;

/* Integrate over the facets; every patch index is 0. */
shb_status modal_facets_create(const mesh_fe *mesh, const mesh_face_set *set, modal_facets *facets);

/* Partition the facets into n_patches of about equal area by recursive bisection. Each cut is
 * across the longest principal direction of the centroids. SHB_ERR_INPUT if there are fewer facets
 * than patches. */
shb_status modal_facets_partition(modal_facets *facets, int n_patches);

void modal_facets_free(modal_facets *facets);

#endif
