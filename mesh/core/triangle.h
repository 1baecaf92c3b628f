/* Flat triangles that an element's face is cut into, and the point of one that is nearest to another point. */
#ifndef MESH_CORE_TRIANGLE_H
#define MESH_CORE_TRIANGLE_H

#include "mesh/core/fe_mesh.h"

enum { MESH_TRIANGLES = 6 }; /* of the largest face */

typedef struct {
  const double *x[3];     /* corners, m; outward */
  int           local[3]; /* their places in the face */
} mesh_triangle;

/* Cut a face (nodes as in mesh_face_set) at its nodes: four triangles of a six-node one, six of an eight-node one. Their
 * number. */
int mesh_triangles(const mesh_fe *mesh, const int *face, mesh_triangle part[MESH_TRIANGLES]);

/* Area vector, m2, outward. */
void mesh_triangle_area(const mesh_triangle *triangle, double area[3]);

/* Distance to the nearest point of the triangle, foot; weight (or NULL): its barycentric coordinates. */
double mesh_triangle_closest(const mesh_triangle *triangle, const double at[3], double foot[3],
                             double weight[3]);

#endif
