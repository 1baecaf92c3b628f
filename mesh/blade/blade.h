/* The parametric shrouded blade: root block, lofted airfoil, tip shroud with Z-notch contact faces. */
#ifndef MESH_BLADE_BLADE_H
#define MESH_BLADE_BLADE_H

#include "mesh/base/axes.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mesh/core/element_topology.h"

/* What a section may be: thickness and camber in per cent of the chord, twist in degrees either way. */
enum {
  MESH_MAX_SECTIONS    = 16,
  MESH_LEAST_THICKNESS = 1,
  MESH_MOST_THICKNESS  = 50,
  MESH_MOST_CAMBER     = 40,
  MESH_MOST_TWIST      = 80
};

/* Airfoil section at a radius; lengths in m, twist in rad (stagger of the chord from the axial direction,
 * positive turning the trailing edge towards +tangential). */
typedef struct {
  double radius, chord, thickness, camber, twist;
} mesh_section;

typedef struct {
  int       blades;   /* N; sector angle 2 pi/N */
  mesh_axis axis;     /* engine axis */
  double    psi, phi; /* orientation of the contact plane, rad, paper's eq. 2 */
  double    root_length, root_width,
      root_height;         /* axial, tangential, radial, m; below the first section */
  int          n_sections; /* at least 2, radii increasing */
  mesh_section section[MESH_MAX_SECTIONS];
  double       shroud_length;    /* axial, m */
  double       shroud_thickness; /* radial, m; the shroud sits on the last section */
  double       shroud_contact; /* length of the contact face along u, m; the middle leg of the Z */
  double       size;           /* element size, m */
  double       shroud_size;    /* element size in the shroud, m (0: as size) */
  double    edge_size; /* tetrahedra: element size at the re-entrant edges, m (0: as elsewhere) */
  mesh_kind elements;  /* hexahedra: mesh/blade/hex_sweep.h */
} mesh_blade;

/* Mesh the blade (second order) and publish it as a gmsh 4.1 file with the groups root, contact_right,
 * contact_left, load (the pressure side) and a $Comments section that holds the provenance (mesh/gmsh/provenance.h).
 * The same blade gives the same file. With verbose progress: the sharpest corner of all elements. Where curved edges invert elements, at thin places, these are made
 * straight if they are at most 1 % of all. progress may be NULL.
 * Errors: SHB_ERR_INPUT for a geometry that cannot be built (what is wrong in the case's words) or inverted
 * elements (tags named); SHB_ERR_IO when the file cannot be written; SHB_INTERRUPTED. Nothing is left behind
 * on failure. */
shb_status mesh_blade_write(const mesh_blade *blade, const char *path,
                            const shb_provenance *provenance, shb_progress *progress);

#endif
