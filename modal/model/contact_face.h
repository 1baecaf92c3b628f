/* The right contact face of a modal file as a surface of its own, for maps of what friction
 * does. */
#ifndef MODAL_MODEL_CONTACT_FACE_H
#define MODAL_MODEL_CONTACT_FACE_H

#include "modal/model/joined_pairs.h"

typedef struct modal_contact_face {
  int     n_nodes, n_elements, corners; /* corners: nodes of an element, 6 or 8 */
  double *node;                         /* [n_nodes][3] m, mesh axes */
  double *area;                         /* [n_nodes] m2, sum over the entries of a node */
  int    *element;                      /* [n_elements][corners] from 0, in gmsh's order */
  int     n_entries;
  int    *entry_node, *entry_pair; /* a node belongs to one pair or more */
  double *entry_part;              /* 0 to 1, sums to 1 over the entries of a node */
} modal_contact_face;

/* Read it. No nodes: the file holds no mesh, or several interfaces. Errors: as h5_open,
 * SHB_ERR_INPUT indices that do not fit. */
shb_status modal_contact_face_read(const char *path, modal_contact_face *face);
/* Pairs become the patches that they are joined to. */
void modal_contact_face_join(modal_contact_face *face, const modal_joining *joining);
void modal_contact_face_free(modal_contact_face *face); /* also on a zeroed struct */

/* out[n_nodes][rows] <- values of the pairs, [pair][rows], mean over the pairs of a node. */
void modal_contact_face_spread(const modal_contact_face *face, const double *of_pair, int rows,
                               double *out);

#endif
