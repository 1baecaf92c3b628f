/* The blade of cases/z_notch_blade, meshed as finely as asked. */
#ifndef SUPPORT_Z_NOTCH_H
#define SUPPORT_Z_NOTCH_H

#include "mesh/core/fe_mesh.h"

typedef struct {
  double size, shroud, edge; /* mm; edge 0: re-entrant edges as the rest */
} z_notch_sizes;

/* Write path (.msh). */
shb_status z_notch_write(mesh_kind kind, const z_notch_sizes *sizes, const char *path);

/* The blade of tetrahedra on a disc of that many: bore 150 mm, web 20 mm, rim 30 mm. */
shb_status z_notch_disc_write(int blades, const z_notch_sizes *sizes, const char *path);

/* z_notch_write, by way of a temporary file. */
shb_status z_notch_mesh(mesh_kind kind, const z_notch_sizes *sizes, mesh_fe *mesh);

#endif
