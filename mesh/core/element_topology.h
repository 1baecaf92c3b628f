/* The second-order elements of a mesh, in gmsh's node order, and their shape functions.
 *
 * Reference coordinates run from 0 to 1 from corner 0 along three edges. They span the unit
 * tetrahedron (corners 1, 2, 3 at the ends) or the unit cube (corners 1, 3, 4). The nodes of a face
 * are its corners, seen from outside anticlockwise, then the middles of its sides. */
#ifndef MESH_CORE_ELEMENT_TOPOLOGY_H
#define MESH_CORE_ELEMENT_TOPOLOGY_H

typedef enum { MESH_TET10, MESH_HEX20 } mesh_kind;

enum { MESH_NODES = 20, MESH_FACE_NODES = 8 }; /* of the largest element and face */

typedef struct {
  const char *name;           /* "ten-node tetrahedron", for messages */
  const char *face_name;      /* "six-node triangle" */
  int         nodes, corners; /* the middle of an edge is node corners + edge */
  int         edges, faces;
  int         face_nodes, face_corners;
  int         gmsh, gmsh_face;        /* gmsh's element types */
  int         vtk;                    /* VTK's cell type */
  int         along[3];               /* corners at the ends of the reference axes */
  const int (*edge)[2];               /* [edges] corners */
  const int (*face)[MESH_FACE_NODES]; /* [faces] local nodes */
  const int *vtk_order;     /* [nodes] our node at each place of the cell of VTK and CalculiX */
  const double (*place)[3]; /* [nodes] reference coordinates */
  const double (*face_place)[2]; /* [face_nodes] the same on a face */
} mesh_topology;

const mesh_topology *mesh_topology_of(mesh_kind kind);

/* Shape functions and their gradients at a reference point.
 *   shape     out  [nodes]
 *   gradient  out  [nodes][3] dN_i / d(r, s, t) */
void mesh_shape(mesh_kind kind, const double at[3], double *shape, double (*gradient)[3]);

/* Shape functions of a face; (r, s) run from its corner 0 along its first and its last side.
 *   shape     out  [face_nodes]
 *   gradient  out  [face_nodes][2] dN_i / d(r, s) */
void mesh_face_shape(mesh_kind kind, const double at[2], double *shape, double (*gradient)[2]);

#endif
