#include "mhb/numerics/tail.h"

#include <math.h>

/* With a lower order the sum of the sizes hardly converges. */
static const double LEAST_ORDER = 1.25;

mhb_tail mhb_tail_of(int top, const double *power, double margin) {
  double   square[2] = {0, 0}, size = 0;
  mhb_tail tail = {.order = INFINITY};
  if (top < MHB_LEAST_OF_TAIL) return tail;
  for (int k = top / 4 + 1; k <= top; k++) {
    const int last = k > top / 2;
    square[last] += power[k];
    if (last) size += sqrt(power[k]);
  }
  if (!(square[0] > 0 && square[1] > 0)) return tail;
  tail.order             = 0.5 * (1 - log2(square[1] / square[0]));
  const double counted   = fmax(tail.order - margin, LEAST_ORDER);
  const double of_square = exp2(1 - 2 * counted), of_size = exp2(1 - counted);
  tail.rms = sqrt(square[1] * of_square / (1 - of_square));
  tail.sum = size * of_size / (1 - of_size);
  return tail;
}
