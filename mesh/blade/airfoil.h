/* Airfoil sections and the solid lofted through them.
 *
 * With xi along the chord from the leading edge, eta across it and s = xi/chord:
 *   camber line  eta = 4 camber s (1 - s)
 *   thickness    t(s) = thickness g(s)/max g,  g = s (1 - s) (1 + 0.3 (1 - 2 s)),  along eta
 * Both edges are sharp, as a rounding would be smaller than an element. The section is rotated by
 * twist and stacked by its centroid. With positive camber the suction side bulges towards
 * +tangential. The pressure side faces -tangential and is concave if camber > thickness/2. Negative
 * camber mirrors the section. */
#ifndef MESH_BLADE_AIRFOIL_H
#define MESH_BLADE_AIRFOIL_H

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

enum { MESH_AIRFOIL_POINTS = 13 };

/* Points from leading to trailing edge (both shared) in blade coordinates (tangential, axial,
 * radial), m. */
typedef struct {
  double suction[MESH_AIRFOIL_POINTS][3];
  double pressure[MESH_AIRFOIL_POINTS][3];
} mesh_outline;

/* Outline of a section. The suction side is that of the blade's camber, also where the section has
 * none. */
void mesh_airfoil_outline(const mesh_blade *blade, const mesh_section *section,
                          mesh_outline *outline);

/* Section at a radius, interpolated linearly, and extrapolated beyond the first and last
 * section. */
mesh_section mesh_airfoil_at(const mesh_blade *blade, double radius);

double mesh_airfoil_chord(const mesh_blade *blade); /* maximum, m */

/* Radii of the ends of the loft: inside the root block and inside the shroud, m. */
double mesh_airfoil_low_radius(const mesh_blade *blade);
double mesh_airfoil_high_radius(const mesh_blade *blade);

/* SHB_ERR_INPUT for invalid sections; the message names the key of the case. */
shb_status mesh_airfoil_check(const mesh_blade *blade);

/* Add the solid to gmsh's OpenCASCADE model. */
shb_status mesh_airfoil_build(const mesh_blade *blade, const mesh_frame *frame, int *volume);

#endif
