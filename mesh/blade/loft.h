/* Points on the two sides of the lofted airfoil, as OpenCASCADE built it. */
#ifndef MESH_BLADE_LOFT_H
#define MESH_BLADE_LOFT_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

typedef enum { MESH_PRESSURE, MESH_SUCTION } mesh_side;

/* One side: its radial parameter and the directions of both parameters. */
typedef struct {
  int    face;        /* gmsh's tag */
  int    radial;      /* 0 or 1: index of the radial parameter */
  double low[2];      /* parameters at the leading edge and at the lowest radius: [chord, radial] */
  double high[2];     /* at the trailing edge and at the greatest radius */
  double bottom, top; /* m, radii there */
} mesh_loft_side;

typedef struct {
  mesh_frame     frame;
  mesh_loft_side side[2];
} mesh_loft;

/* Build the airfoil in gmsh's current model and find its sides. A gmsh session must be open.
 * Errors: SHB_ERR_INPUT for sections that cannot be lofted. */
shb_status mesh_loft_create(const mesh_blade *blade, const mesh_frame *frame, mesh_loft *loft);

/* Point of a side, to 1e-13 m in radius.
 *   u       in   0 leading edge, 1 trailing edge
 *   radius  in   m, radial coordinate
 *   own     out  blade coordinates, m
 * Errors: SHB_ERR_INPUT for a radius beyond the ends of the loft. */
shb_status mesh_loft_point(const mesh_loft *loft, mesh_side side, double u, double radius,
                           double own[3]);

#endif
