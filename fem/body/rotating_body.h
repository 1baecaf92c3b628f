/* The body under its steady loads: mesh, material, speed, pressure. */
#ifndef FEM_BODY_ROTATING_BODY_H
#define FEM_BODY_ROTATING_BODY_H

#include "fem/body/rotation.h"
#include "fem/element/element.h"
#include "fem/element/material.h"
#include "mesh/core/fe_mesh.h"

/* The body under large displacements and its loads. It owns nothing. */
typedef struct {
  const mesh_fe      *mesh;
  const fem_material *material; /* one, or one a region (fem_material_at) */
  const fem_element  *element;
  fem_rotation        rotation;
  double              pressure; /* Pa, steady, on group load, into the deformed surface */
} fem_body;

/* Coordinates and displacements of the nodes of an element, m.
 *   u  in   [n_nodes][3]; NULL: none
 *   x  out  [n][3] coordinates, undeformed
 *   v  out  [n][3] displacements */
void fem_body_element(const fem_body *body, int element, const double *u, double x[][3],
                      double v[][3]);

#endif
