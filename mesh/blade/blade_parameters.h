/* Parameters of the parametric blade. */
#ifndef MESH_BLADE_BLADE_PARAMETERS_H
#define MESH_BLADE_BLADE_PARAMETERS_H

#include "mesh/base/axes.h"
#include "mesh/core/element_topology.h"

/* Limits of a section: thickness and camber in per cent of the chord, twist in degrees. Limits of
 * the contact plane, either way, in degrees. */
enum {
  MESH_MAX_SECTIONS  = 16,
  MESH_MIN_THICKNESS = 1,
  MESH_MAX_THICKNESS = 50,
  MESH_MAX_CAMBER    = 40,
  MESH_MAX_TWIST     = 80,
  MESH_MAX_PSI       = 70,
  MESH_MAX_PHI       = 45
};

/* Airfoil section at a radius; lengths in m, twist in rad. Twist is the stagger of the chord from
 * the axial direction; positive twist turns the trailing edge towards +tangential. */
typedef struct {
  double radius, chord, thickness, camber, twist;
} mesh_section;

typedef struct {
  int          blades;   /* N; sector angle 2 pi/N */
  mesh_axis    axis;     /* engine axis */
  double       psi, phi; /* orientation of the contact plane, rad (Chen, Yang, Menq 1999, eq. 2) */
  double       root_length, root_width, root_height; /* axial, tangential, radial, m */
  double       disc_bore;          /* radius of the clamped bore of a disc, m; 0: no disc */
  double       disc_web, disc_rim; /* axial thickness of the web, radial height of the rim, m */
  double       disc_taper; /* radial height over which the web widens to the rim, m; 0: a step */
  int          n_sections; /* at least 2, in order of radius */
  mesh_section section[MESH_MAX_SECTIONS];
  double       shroud_length;    /* axial, m */
  double       shroud_thickness; /* radial, m; begins at the last section */
  double       shroud_contact;   /* length of the contact face along u, m: middle leg of the Z */
  double       size;             /* element size, m */
  double       shroud_size;      /* element size in the shroud, m (0: as size) */
  double       edge_size; /* tetrahedra: element size at re-entrant edges, m (0: as elsewhere) */
  mesh_kind    elements;  /* hexahedra: see mesh/blade/hex_sweep.h */
} mesh_blade;

#endif
