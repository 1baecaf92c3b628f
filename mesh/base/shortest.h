/* A number as text with the fewest digits that give it back: 0.3, not 0.29999999999999999. */
#ifndef MESH_BASE_SHORTEST_H
#define MESH_BASE_SHORTEST_H

#include <stdio.h>

enum { SHB_SHORTEST = 32 };

/* At least 15 digits are tried, so that zeros at the end fall away. Returns out. */
const char *shb_shortest(double value, char out[SHB_SHORTEST]);

/* Print n of them with spaces between. */
void shb_print_shortest(FILE *out, int n, const double *value);

#endif
