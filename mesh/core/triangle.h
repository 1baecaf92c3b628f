/* Flat triangles of an element's face, and the point of a triangle nearest to a given point. */
#ifndef MESH_CORE_TRIANGLE_H
#define MESH_CORE_TRIANGLE_H

#include "mesh/core/fe_mesh.h"

enum { MESH_TRIANGLES = 6 }; /* of the largest face */

typedef struct {
  const double *x[3];     /* corners, m; outward */
  int           local[3]; /* local nodes of the face at the corners */
} mesh_triangle;

/* Divide a face (nodes as in mesh_face_set) at its nodes: 4 triangles of a six-node face, 6 of an
 * eight-node face. Returns their number. */
int mesh_triangles(const mesh_fe *mesh, const int *face, mesh_triangle part[MESH_TRIANGLES]);

/* Area vector, m2, outward. */
void mesh_triangle_area(const mesh_triangle *triangle, double area[3]);

/* Distance to the nearest point of the triangle, m.
 *   foot    out  that point, m
 *   weight  out  its barycentric coordinates; may be NULL */
double mesh_triangle_closest(const mesh_triangle *triangle, const double at[3], double foot[3],
                             double weight[3]);

#endif
