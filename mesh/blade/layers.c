#include "mesh/blade/layers.h"

#include <math.h>
#include <stddef.h>

static const double thin[2] = {.08, .30};

void mesh_layers_make(double length, double size, int thin_low, int thin_high,
                      mesh_layers *layers) {
  const double most = MESH_MAX_LAYERS - 4, wanted = fmax(1, round(length / size));
  const int    n  = (int)fmin(most, wanted);
  double      *at = layers->at;
  size_t       k  = 0;
  /* an interval with thin layers at both ends is cut at 8, 30, 70 and 92 % */
  for (int i = 0; i < n; i++) {
    at[2 * k++] = (double)i / n;
    if (i == 0 && thin_low)
      for (int t = 0; t < 2; t++) at[2 * k++] = thin[t] / n;
    if (i == n - 1 && thin_high)
      for (int t = 1; t >= 0; t--) at[2 * k++] = 1 - thin[t] / n;
  }
  at[2 * k] = 1;
  for (size_t i = 0; i < k; i++) at[2 * i + 1] = (at[2 * i] + at[2 * i + 2]) / 2;
  layers->n = (int)k;
}
