/* A mesh in memory written to a file of Abaqus and CalculiX (.inp). */
#ifndef MESH_IO_INP_WRITE_H
#define MESH_IO_INP_WRITE_H

#include "mesh/core/fe_mesh.h"

/* Write the mesh and publish it as path. Groups are written as surfaces and as node sets, volumes
 * as element sets. The set "body" holds all elements, "nodes" all nodes. Numbers of nodes and
 * elements are kept.
 *
 * Coordinates, in m, are reproduced exactly where 17 digits fit into the 20 characters that
 * CalculiX reads. Otherwise 14 to 16 digits are written. SHB_ERR_IO. */
shb_status mesh_inp_write(const mesh_fe *mesh, const char *path);

#endif
