/* The volume of a solid in gmsh, by quadrature over its own faces. */
#ifndef MESH_GMSH_SOLID_VOLUME_H
#define MESH_GMSH_SOLID_VOLUME_H

#include "mesh/base/status.h"
#include "mesh/core/element_topology.h"

typedef struct {
  double volume, error; /* in the unit of the file, cubed */
} mesh_solid_volume;

/* Flux of x / 3 through the faces of a solid, from their parametrisation: no point of the mesh
 * counts but as a parameter.
 *
 *   V = 1/3 sum over elements of the integral of x . (x_u cross x_v) du dv
 *
 * The elements on a face divide its domain in (u, v), with parabolas at its edges. Pieces are
 * divided further until two rules agree. OpenCASCADE's own volume has no such control; it is up to
 * 2e-4 off on lofts (tests/bench/bench_solid_volume.c).
 *
 * error has three parts: what the rules leave open; the edges; the net area of the faces, which is
 * zero where they close. That of the edges is half of what straight lines in place of parabolas
 * change; at most 0.3 of it was measured. NAN: a face has no parameters, as of a script without a
 * solid.
 *   kind   in  of the volume elements
 *   solid  in  gmsh's tag
 *   face   in  [n] gmsh's tags of its faces, below 0 where their elements look inwards
 * Errors: SHB_ERR_INPUT. */
shb_status mesh_solid_volume_of(const char *path, mesh_kind kind, int solid, int n, const int *face,
                                mesh_solid_volume *out);

#endif
