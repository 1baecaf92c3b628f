/* What gmsh made of a solid, compared with the solid. */
#ifndef MESH_GMSH_SOLID_CHECK_H
#define MESH_GMSH_SOLID_CHECK_H

#include "mesh/base/progress.h"
#include "mesh/gmsh/source_settings.h"
#include "mesh/gmsh/surface_gap.h"

enum { MESH_SOLID_REASON = 400 };

/* Faults of a mesh that can still be used. Lengths in m. */
typedef struct {
  char             errors[MESH_SOLID_REASON]; /* gmsh's own, "" if there are none */
  int              straightened;              /* elements that got straight edges */
  int              moved;                     /* nodes that moved for that */
  double           farthest, at[3];           /* the largest move, and where */
  int              solid, n_solids;           /* the solid that is farthest off, from 1 */
  mesh_surface_gap gap;                       /* its own */
} mesh_solid_faults;

/* Every solid must have elements.
 *   errors  in  what gmsh said while it meshed
 * Errors: SHB_ERR_INPUT; the text gives the place of the solid, and gmsh's reason. */
shb_status mesh_solid_check_filled(const mesh_source *source, const char *errors);

/* Straighten inverted elements of a mesh in the unit of the file. Errors: SHB_ERR_INPUT if they are
 * more than 1 %, or some are still inverted. */
shb_status mesh_solid_straighten(const mesh_source *source, mesh_fe *mesh,
                                 mesh_solid_faults *faults);

/* The surface of each solid in the mesh against the solid's. Errors: as mesh_surface_gap_of. */
shb_status mesh_solid_compare(const mesh_source *source, const mesh_fe *mesh,
                              mesh_solid_faults *faults);

/* Tell what is wrong, as warnings, and with --verbose the surface and the volume. */
void mesh_solid_tell(const mesh_source *source, const mesh_solid_faults *faults,
                     shb_progress *progress);

#endif
