/* Airfoil sections and the solid lofted through them.
 *
 * In the chord's axes (xi from leading to trailing edge, eta towards the bulge) and s = xi/chord:
 *   camber line  eta = 4 camber s (1 - s)
 *   thickness    t(s) = thickness g(s)/max g,  g = s (1 - s) (1 + 0.3 (1 - 2 s)),  measured along eta
 * so both edges are sharp: a rounding would be smaller than an element. The section is turned by twist and
 * stacked by its centroid. With positive camber it bulges towards +tangential (suction side), and the pressure
 * side, concave when camber > thickness/2, faces -tangential; negative camber mirrors that. */
#ifndef MESH_BLADE_AIRFOIL_H
#define MESH_BLADE_AIRFOIL_H

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

enum { MESH_AIRFOIL_POINTS = 13 };

/* Points from leading to trailing edge (shared), in own coordinates (tangential, axial, radial), m. */
typedef struct {
  double suction[MESH_AIRFOIL_POINTS][3];
  double pressure[MESH_AIRFOIL_POINTS][3];
} mesh_outline;

/* The suction side is that of the blade's camber, also where a section's own is zero or, run on beyond the ends, less. */
void mesh_airfoil_outline(const mesh_blade *blade, const mesh_section *section,
                          mesh_outline *outline);

/* Section parameters at a radius: linear between sections, and beyond the first and last. */
mesh_section mesh_airfoil_at(const mesh_blade *blade, double radius);

double mesh_airfoil_chord(const mesh_blade *blade); /* greatest, m */

/* Radii at which the lofted solid begins (inside the root block) and ends (inside the shroud). */
double mesh_airfoil_low_radius(const mesh_blade *blade);
double mesh_airfoil_high_radius(const mesh_blade *blade);

/* SHB_ERR_INPUT for sections that are not an airfoil, in words of the case. */
shb_status mesh_airfoil_check(const mesh_blade *blade);

/* Add the solid to gmsh's OpenCASCADE model. */
shb_status mesh_airfoil_build(const mesh_blade *blade, const mesh_frame *frame, int *volume);

#endif
