/* A solid (STEP, BREP, gmsh's .geo) meshed by gmsh with second-order tetrahedra. */
#ifndef MESH_GMSH_SOLID_H
#define MESH_GMSH_SOLID_H

#include "mesh/base/progress.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/source_settings.h"

/* An open gmsh session with the solid in it. */
typedef struct {
  const mesh_source *source;
  shb_progress      *progress;
  mesh_session       session;
} mesh_solid;

/* Start gmsh and load the solid. SHB_ERR_INPUT: not readable as such, no volume; SHB_ERR_IO. After success close it. */
shb_status mesh_solid_open(const mesh_source *source, shb_progress *progress, mesh_solid *solid);
void       mesh_solid_close(mesh_solid *solid);

/* Mesh (anew) and copy out, coordinates in the source's unit, groups as the file has them. A few inverted
 * elements are straightened, more than 1 % are SHB_ERR_INPUT, and so are more nodes than can be computed with. */
shb_status mesh_solid_mesh(mesh_solid *solid, mesh_fe *mesh);

/* Where the blade meets its neighbour and the contact faces of mesh (in m) do not match node for node: make those of
 * contact_right copies of contact_left's, turned by the sector, in the next mesh. *again: there is something to do;
 * false too where the faces of the two sides do not correspond, or gmsh cannot. Swaps the two groups of mesh if they are
 * the wrong way round. */
shb_status mesh_solid_tie(mesh_solid *solid, mesh_fe *mesh, bool *again);

#endif
