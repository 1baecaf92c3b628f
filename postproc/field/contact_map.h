/* Maps of what friction does on the contact face, as the response file holds them. */
#ifndef POSTPROC_FIELD_CONTACT_MAP_H
#define POSTPROC_FIELD_CONTACT_MAP_H

#include "mesh/core/element_topology.h"
#include "mhb/response/response.h"
#include "modal/hdf5/h5.h"

/* Rows of state */
enum { POST_STUCK, POST_SLIPPING, POST_OPEN, POST_STATES };

/* The right contact face. */
typedef struct {
  mesh_kind kind; /* of the elements that it bounds */
  int       n_nodes, n_elements;
  double   *node;    /* [n_nodes][3] m, mesh axes */
  double   *area;    /* [n_nodes] m2 */
  int      *element; /* [n_elements][6 or 8] corners, then middles of sides */
} post_contact_face;

/* The maps of one curve at its peaks. */
typedef struct {
  int     n;           /* peaks; 0: the curve has none */
  int    *point;       /* [n] along the curve */
  double *pressure;    /* [n][n_nodes] Pa, mean over the period */
  double *slip;        /* [n][n_nodes] m, way slipped in a period */
  double *dissipation; /* [n][n_nodes] J/m2 in a period */
  double *state;       /* [n][n_nodes][POST_STATES] share of the period */
} post_contact_maps;

/* Read the face of an open response file; no nodes if it has none. Errors: SHB_ERR_INPUT nodes or
 * elements that do not fit. */
shb_status post_contact_face_read(hid_t file, post_contact_face *face);
void       post_contact_face_free(post_contact_face *face); /* also on a zeroed struct */

/* Read the maps of a curve of the file. Errors: as above. */
shb_status post_contact_maps_read(hid_t file, const post_contact_face *face, int branch,
                                  post_contact_maps *maps);
void       post_contact_maps_free(post_contact_maps *maps); /* also on a zeroed struct */

/* Row of the highest peak by the first output; -1 without maps. */
int post_contact_highest(const mhb_response *response, int branch, const post_contact_maps *maps);

#endif
