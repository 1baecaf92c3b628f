/* A mesh in memory to a file of Abaqus and CalculiX (.inp). */
#ifndef MESH_IO_INP_WRITE_H
#define MESH_IO_INP_WRITE_H

#include "mesh/core/fe_mesh.h"

/* Write the mesh with its groups, as surfaces and as node sets, and publish it. Numbers of nodes and elements stay;
 * coordinates, in m, are read back as they were, or to 14 to 16 digits where 17 do not fit into the 20 characters that
 * CalculiX reads. The body is the element set "body", volumes are element sets, all nodes are "nodes"; nothing but the mesh is written. SHB_ERR_IO. */
shb_status mesh_inp_write(const mesh_fe *mesh, const char *path);

#endif
