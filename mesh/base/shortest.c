#include "mesh/base/shortest.h"

#include <stdlib.h>

const char *shb_shortest(double value, char out[SHB_SHORTEST]) {
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(out, SHB_SHORTEST, "%.*g", digits, value);
    if (strtod(out, NULL) == value) break;
  }
  return out;
}

void shb_print_shortest(FILE *out, int n, const double *value) {
  char text[SHB_SHORTEST];
  for (int i = 0; i < n; i++) fprintf(out, "%s%s", i ? " " : "", shb_shortest(value[i], text));
}
