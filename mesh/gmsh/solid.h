/* A solid (STEP, BREP, gmsh's .geo) meshed by gmsh with second-order tetrahedra. */
#ifndef MESH_GMSH_SOLID_H
#define MESH_GMSH_SOLID_H

#include "mesh/base/progress.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/solid_check.h"
#include "mesh/gmsh/source_settings.h"

/* An open gmsh session that holds the solid. */
typedef struct {
  const mesh_source *source;
  shb_progress      *progress;
  mesh_session       session;
  mesh_solid_faults  faults; /* of the last mesh */
} mesh_solid;

/* Start gmsh and load the solid; after success call mesh_solid_close.
 * Errors: SHB_ERR_INPUT not readable, or without a volume; SHB_ERR_IO. */
shb_status mesh_solid_open(const mesh_source *source, shb_progress *progress, mesh_solid *solid);
void       mesh_solid_close(mesh_solid *solid);

/* Mesh the solid, again if called again, and copy the mesh. Coordinates are in the source's unit,
 * groups those of the file. Inverted elements are straightened.
 * Errors: SHB_ERR_INPUT if a solid got no elements, more than 1 % of the elements are inverted, or
 * there are too many nodes. */
shb_status mesh_solid_mesh(mesh_solid *solid, mesh_fe *mesh);

/* Prepare matching contact faces and cyclic sides for the next mesh. Nothing is done if the faces
 * to the neighbour match node for node. Otherwise the mesh of the right face becomes a copy of that
 * of the left one, rotated by the sector angle. Swaps the two groups if they are the wrong way
 * round.
 *   mesh   in/out  coordinates in m
 *   again  out     true: mesh again. False also if the faces of the two sides do not correspond. */
shb_status mesh_solid_make_periodic(mesh_solid *solid, mesh_fe *mesh, bool *again);

#endif
