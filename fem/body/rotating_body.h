/* The body under its steady loads: mesh, material, speed, pressure. */
#ifndef FEM_BODY_ROTATING_BODY_H
#define FEM_BODY_ROTATING_BODY_H

#include "fem/body/rotation.h"
#include "fem/element/element.h"
#include "fem/element/material.h"
#include "mesh/core/fe_mesh.h"

/* The body; it owns nothing. */
typedef struct {
  const mesh_fe      *mesh;
  const fem_material *material; /* one, or one a region */
  const fem_element  *element;
  fem_rotation        rotation;
  double              pressure; /* Pa, steady, on group load, into the deformed surface */
} fem_body;

/* Coordinates and displacements of an element's nodes, m: [n][3]. u: [n_nodes][3], NULL for none. */
void fem_body_element(const fem_body *body, int element, const double *u, double x[][3],
                      double v[][3]);

#endif
