/* Integrals over faces of elements: nodal areas and nodal forces of a load. */
#ifndef FEM_ELEMENT_SURFACE_H
#define FEM_ELEMENT_SURFACE_H

#include "fem/element/load.h"
#include "fem/element/quadrature.h"
#include "mesh/core/fe_mesh.h"

/* Integrals over one face, n = rule->nodes. For a flat triangle with straight sides and area A,
 * area is 0 at corners and A/3 at mid-sides; for a parallelogram -A/12 and A/3.
 *   x       in   [n][3] m
 *   area    out  [n]    integral of N_i dA, m2
 *   normal  out  [n][3] integral of N_i n dA, m2, n the outward unit normal */
void fem_face_integrate(const fem_face_rule *rule, const double x[][3], double *area,
                        double normal[][3]);

/* Coordinates of face f of a set, [face_nodes][3]. */
void fem_face_coordinates(const mesh_fe *mesh, const mesh_face_set *set, int face, double x[][3]);

/* Consistent nodal forces of the spatial pattern of a load, before the factors of its harmonics. A
 * pressure p is the traction -p n, n outward: positive p pushes into the surface.
 *   fallback  in   point of a force with load->has_at false (the first probe); NULL: none
 *   force     out  [n_nodes][3] N, mesh axes
 * Errors: SHB_ERR_INPUT if group load is needed and missing, or a force has no point. */
shb_status fem_load_pattern(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                            double *force);

#endif
