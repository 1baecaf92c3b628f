#include "mesh/base/shortest.h"

#include <stdio.h>
#include <stdlib.h>

const char *shb_shortest(double value, char out[SHB_SHORTEST]) {
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(out, SHB_SHORTEST, "%.*g", digits, value);
    if (strtod(out, NULL) == value) break;
  }
  return out;
}
