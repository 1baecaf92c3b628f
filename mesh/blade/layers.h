/* Where the layers of a swept part lie. */
#ifndef MESH_BLADE_LAYERS_H
#define MESH_BLADE_LAYERS_H

enum { MESH_MAX_LAYERS = 4000 };

typedef struct {
  int    n; /* layers */
  double at[2 * MESH_MAX_LAYERS +
            1]; /* shares of the length: ends and middles of the layers, 0 to 1 */
} mesh_layers;

/* length/size equal layers, at least one; where an end is thin, two thin layers are cut off the interval there, at 8 % and
 * 30 % of it: the error of a clamp or a re-entrant edge sits next to it. */
void mesh_layers_make(double length, double size, int thin_low, int thin_high, mesh_layers *layers);

#endif
