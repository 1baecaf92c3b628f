#include "tests/hard/oblique_cantilever.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/support/scratch.h"

/* Elements along x (11 of the bar, 5 of the tip), y and z. Nodes lie on the grid of half elements:
 * corners at even indices, the middle of an edge where one index is odd. */
enum { BAR = 11, NX = 16, NY = 11, NZ = 12 };

static bool is_node(int i, int j, int k) {
  return i % 2 + j % 2 + k % 2 <= 1;
}

static int number(int i, int j, int k) {
  return 1 + k + (2 * NZ + 1) * (j + (2 * NY + 1) * i);
}

static void corner(int i, int j, int k, double at[3]) {
  double beyond = i > BAR ? i - BAR : 0;
  at[0]         = i > BAR ? .3 + 4e-3 * beyond : .3 * i / BAR;
  at[1]         = (50e-3 - 7e-3 * beyond) * j / NY;
  at[2]         = -2.5e-3 * k;
}

/* Edges are straight: the mean of their ends. */
static void place(int i, int j, int k, double at[3]) {
  double a[3], b[3];
  corner(i / 2, j / 2, k / 2, a);
  corner((i + 1) / 2, (j + 1) / 2, (k + 1) / 2, b);
  for (int d = 0; d < 3; d++) at[d] = (a[d] + b[d]) / 2;
}

static void write_set(FILE *out, const char *name, const int low[3], const int high[3]) {
  fprintf(out, "*NSET, NSET=%s\n", name);
  for (int i = low[0]; i <= high[0]; i++)
    for (int j = low[1]; j <= high[1]; j++)
      for (int k = low[2]; k <= high[2]; k++)
        if (is_node(i, j, k)) fprintf(out, "%d,\n", number(i, j, k));
}

static void write_elements(FILE *out) {
  /* offsets of the twenty nodes of a C3D20, in half elements */
  static const int at[20][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2},
                                {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
                                {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2},
                                {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
  int              element   = 0;
  fprintf(out, "*ELEMENT, TYPE=C3D20, ELSET=body\n");
  for (int i = 0; i < NX; i++)
    for (int j = 0; j < NY; j++)
      for (int k = 0; k < NZ; k++) {
        fprintf(out, "%d", ++element);
        for (int a = 0; a < 20; a++) /* z falls with k: count it upwards */
          fprintf(out, ",%s%d", a == 10 ? "\n" : "",
                  number(2 * i + at[a][0], 2 * j + at[a][1], 2 * k + 2 - at[a][2]));
        fprintf(out, "\n");
      }
}

static void write_mesh(const char *path) {
  FILE *out = fopen(path, "w");
  assert_non_null(out);
  fprintf(out, "*NODE\n");
  for (int i = 0; i <= 2 * NX; i++)
    for (int j = 0; j <= 2 * NY; j++)
      for (int k = 0; k <= 2 * NZ; k++) {
        double at[3];
        if (!is_node(i, j, k)) continue;
        place(i, j, k, at);
        fprintf(out, "%d,%.12g,%.12g,%.12g\n", number(i, j, k), at[0], at[1], at[2]);
      }
  write_elements(out);
  write_set(out, "root", (int[]){0, 0, 0}, (int[]){0, 2 * NY, 2 * NZ});
  write_set(out, "contact_right", (int[]){2 * NX - 2, 2 * NY, 0}, (int[]){2 * NX, 2 * NY, 2 * NZ});
  assert_int_equal(fclose(out), 0);
}

void oblique_cantilever_write(const char *folder) {
  static const char text[] =
      "name: oblique\n"
      "mesh: {file: oblique.inp}\n"
      "material: {E: 210 GPa, nu: 0.3, rho: 9000}\n"
      "modal: {modes: 20, damping: 0.05}\n"
      "excitation: {force: {vector: [0, 25, 0]}}\n"
      "probe: {force: [245.4545 mm, 0 mm, -15 mm]}\n"
      "contact: {to: ground, points: all, mu: 0.36, ku: 1e9, kv: 1e9, n0: 97}\n"
      "mhb: {frequency: [100 Hz, 200 Hz]}\n";
  char path[SCRATCH_PATH + 16];
  snprintf(path, sizeof path, "%s/oblique.inp", folder);
  write_mesh(path);
  scratch_write(folder, "oblique.yaml", text, sizeof text - 1);
}
