/* Faces of named groups against the elements behind them. */
#ifndef MESH_FACES_H
#define MESH_FACES_H

#include "mesh/fe_mesh.h"

/* Give every face of every set its element's own nodes, ordered outward. SHB_ERR_INPUT if a face is on no
 * element, or inside the body (between two elements); name heads the text. */
shb_status mesh_faces_orient(mesh_fe *mesh, const char *name);

#endif
