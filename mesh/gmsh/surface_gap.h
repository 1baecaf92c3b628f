/* How far the surface of a mesh is off that of the solid in gmsh. */
#ifndef MESH_GMSH_SURFACE_GAP_H
#define MESH_GMSH_SURFACE_GAP_H

#include "mesh/base/status.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/gmsh/source_settings.h"

typedef struct {
  double volume;          /* m3, inside the mesh of the solid */
  double missing, error;  /* m3, by which the solid is larger, and how far that may be off; NAN */
  double farthest, at[3]; /* m, the largest distance of the surfaces that was found, and where */
} mesh_surface_gap;

/* Gap between the faces of a solid and its mesh, which may have straightened elements. Of many
 * elements on curved faces every k-th is measured, since a point on a spline takes 0.4 ms. The
 * volume of the solid is that of mesh_solid_volume_of.
 *   mesh   in  in the unit of the file, as imported, with the tags of gmsh
 *   solid  in  gmsh's tag
 * Errors: SHB_ERR_INPUT. */
shb_status mesh_surface_gap_of(const mesh_source *source, const mesh_fe *mesh, int solid,
                               mesh_surface_gap *gap);

#endif
