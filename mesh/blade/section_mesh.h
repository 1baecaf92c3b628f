/* A planar mesh of eight-node quadrangles, to be swept: the airfoil's section, alone or inside an outline.
 *
 * The section's nodes and quadrangles come first and are the same in every plan of a blade; only places differ. */
#ifndef MESH_BLADE_SECTION_MESH_H
#define MESH_BLADE_SECTION_MESH_H

#include <stdbool.h>

#include "mesh/base/status.h"

/* Where a node lies in the airfoil's section. */
typedef struct {
  double u; /* along the sides' parameter, 0 leading edge, 1 trailing edge */
  double w; /* from pressure (-1) to suction (1) side */
} mesh_section_place;

typedef struct {
  int n_nodes, n_quads;
  double (*at)[2]; /* [n_nodes] m, or the places of mesh_section_mesh_create */
  int (*quad)[8];  /* [n_quads] corners, anticlockwise, then middles of 01, 12, 23, 30 */
  int  n_section_nodes, n_section_quads;
  int  n_contour; /* nodes around the section: corner, middle, corner, ...; a multiple of 4 */
  int *contour;   /* [n_contour] from the leading edge along the suction side and back */
} mesh_planar;

/* Numbers of elements of a section. */
typedef struct {
  int chord; /* along the middle part, even */
  int half;  /* through half the thickness */
  double
      tip[2]; /* share of u in the part at the leading and the trailing edge, of 2 half elements */
} mesh_section_grid;

/* The section alone: a middle part of chord x 2 half elements; in each tip three blocks of half x half around a point,
 * so that no corner of an element is flat.
 *   place  out  [n_nodes], malloc'ed */
shb_status mesh_section_mesh_create(const mesh_section_grid *grid, mesh_planar *plan,
                                    mesh_section_place **place);

/* After places were given: turn the quadrangles round if they run clockwise. */
void mesh_section_mesh_orient(mesh_planar *section);

void mesh_planar_free(mesh_planar *plan); /* also on a zeroed struct */

#endif
