/* A planar mesh of eight-node quadrangles: the airfoil's section, alone or inside an outline.
 *
 * The nodes and quadrangles of the section come first. They are the same in every planar mesh of a
 * blade; only their places differ. */
#ifndef MESH_BLADE_SECTION_MESH_H
#define MESH_BLADE_SECTION_MESH_H

#include <stdbool.h>

#include "mesh/base/status.h"

/* Place of a node in the section of the airfoil. */
typedef struct {
  double u; /* parameter of the sides: 0 leading edge, 1 trailing edge */
  double w; /* from pressure (-1) to suction (1) side */
} mesh_section_place;

typedef struct {
  int n_nodes, n_quads;
  double (*at)[2]; /* [n_nodes] m; undefined after mesh_section_mesh_create */
  int (*quad)[8];  /* [n_quads] corners, anticlockwise, then middles of 01, 12, 23, 30 */
  int  n_section_nodes, n_section_quads;
  int  n_contour; /* nodes around the section: corner, middle, ...; a multiple of 4 */
  int *contour;   /* [n_contour] from the leading edge along the suction side, then back */
} mesh_planar;

/* Numbers of elements of a section. */
typedef struct {
  int    chord;  /* elements along the middle part, even */
  int    half;   /* elements through half the thickness */
  double tip[2]; /* shares of u of the parts at both edges, of 2 half elements */
} mesh_section_grid;

/* Mesh the section. Its middle part has chord x 2 half elements. Each tip has three blocks of half
 * x half elements around a point, so that no corner of an element is flat.
 *   place  out  [n_nodes], malloc'ed */
void mesh_section_mesh_create(const mesh_section_grid *grid, mesh_planar *plan,
                              mesh_section_place **place);

/* After the coordinates are set: reverse the quadrangles if they run clockwise. */
void mesh_section_mesh_orient(mesh_planar *section);

void mesh_planar_free(mesh_planar *plan); /* also on a zeroed struct */

#endif
