/* Integrals over the faces of elements: nodal areas, and the nodal forces of a load. */
#ifndef FEM_ELEMENT_SURFACE_H
#define FEM_ELEMENT_SURFACE_H

#include "fem/element/load.h"
#include "fem/element/quadrature.h"
#include "mesh/core/fe_mesh.h"

/* Integrals of one face, n = rule->nodes.
 *   x       in   [n][3] m
 *   area    out  [n]    integral of N_i dA, m2. On a flat straight-sided triangle of area A: 0 at the corners, A/3 at the
 *                       middles of the sides; on a parallelogram -A/12 and A/3
 *   normal  out  [n][3] integral of N_i n dA, m2, n the outward unit normal */
void fem_face_integrate(const fem_face_rule *rule, const double x[][3], double *area,
                        double normal[][3]);

/* Coordinates of face f of a set, [face_nodes][3]. */
void fem_face_coordinates(const mesh_fe *mesh, const mesh_face_set *set, int face, double x[][3]);

/* Consistent nodal forces of the load's spatial pattern (before the factors of its harmonics).
 *   fallback  in   point where a force acts whose load->has_at is false (the first probe); NULL: none
 *   force     out  [n_nodes][3] N, mesh axes
 * Pressure p acts as the traction -p n, n outward: positive pushes into the surface.
 * Errors: SHB_ERR_INPUT if the group load is needed and missing, or a force has no place. */
shb_status fem_load_pattern(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                            double *force);

#endif
