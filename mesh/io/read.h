/* Mesh files read by their kind. */
#ifndef MESH_IO_READ_H
#define MESH_IO_READ_H

#include "mesh/core/fe_mesh.h"

/* Read a gmsh .msh file (2.2 or 4.1) with physical groups, or an .inp file (mesh/io/inp_read.h).
 * Only nodes that an element uses are kept. A group that the file lacks is empty.
 *   names  in   of groups and volumes in the file; NULL: the usual six groups, no volumes
 *   mesh   out  free with mesh_fe_free
 * Errors: SHB_ERR_IO unreadable. SHB_ERR_INPUT if elements are neither all tet10 nor all hex20.
 * SHB_ERR_INPUT if an element has det J <= 0; the message names up to five tags. SHB_ERR_INPUT if a
 * face of a group is not on the surface of the body. SHB_ERR_INPUT if a volume is absent, or
 * elements lie in no volume or in two. */
shb_status mesh_fe_read(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
