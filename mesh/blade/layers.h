/* Positions of the layers of a swept part. */
#ifndef MESH_BLADE_LAYERS_H
#define MESH_BLADE_LAYERS_H

enum { MESH_MAX_LAYERS = 4000 };

typedef struct {
  int    n;                           /* layers */
  double at[2 * MESH_MAX_LAYERS + 1]; /* ends and middles of the layers, shares of the length */
} mesh_layers;

/* Divide a length into length/size equal intervals, at least one. At a thin end the interval is cut
 * at 8 % and 30 % of its length. Errors due to a clamp or a re-entrant edge are largest there. */
void mesh_layers_make(double length, double size, int thin_low, int thin_high, mesh_layers *layers);

#endif
