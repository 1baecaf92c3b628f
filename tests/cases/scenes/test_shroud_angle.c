/* The study of the shroud angle: the numbers of its README. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/scene.h"

enum { ANGLES = 9, PRELOADS = 5 };

static const double preload[PRELOADS] = {10, 25, 60, 150, 400};

static char   folder[SCRATCH_PATH];
static double peak[ANGLES][PRELOADS], frequency[ANGLES][PRELOADS]; /* m, Hz */

/* Column of a word in the head of a CSV file. */
static int column_of(const char *head, const char *word) {
  int column = 0;
  for (const char *at = head; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL, column++)
    if (strncmp(at, word, strlen(word)) == 0 && strchr(",\n", at[strlen(word)])) return column;
  fail_msg("no column %s in %s", word, head);
  return -1;
}

static const char *field(const char *row, int column) {
  for (; column > 0; column--) row = strchr(row, ',') + 1;
  return row;
}

static int run_study(void **state) {
  (void)state;
  char path[SCRATCH_PATH + 64], head[500], row[500];
  scratch_create(folder);
  if (scene_run_study(folder, SCENE, "shroud_angle") != 0) return 1;
  snprintf(path, sizeof path, "%s/shroud_angle/shroud_angle.study.csv", folder);
  FILE *file = fopen(path, "r");
  if (!file || !fgets(head, sizeof head, file)) return 1;
  const int psi = column_of(head, "contact.psi"), n0 = column_of(head, "contact.n0");
  while (fgets(row, sizeof row, file)) {
    const double degrees = atof(field(row, psi)) * 180 / SHB_PI;
    const int    angle   = (int)lround((degrees + 60) / 15);
    int          load    = 0;
    while (load < PRELOADS && fabs(atof(field(row, n0)) - preload[load]) > 1e-9) load++;
    if (angle < 0 || angle >= ANGLES || load == PRELOADS) return 1;
    peak[angle][load]      = atof(field(row, column_of(head, "peak")));
    frequency[angle][load] = atof(field(row, column_of(head, "frequency")));
  }
  return fclose(file);
}

static int clean(void **state) {
  (void)state;
  return scene_remove(folder);
}

/* um and Hz */
static void peaks_are_those_of_the_table(void **state) {
  (void)state;
  static const double wanted[ANGLES][2 * PRELOADS] = {
      {24.07, 162.91, 32.82, 221.58, 69.39, 220.72, 156.8, 222.62, 378.3, 225.50},
      {22.87, 183.28, 36.57, 223.34, 77.51, 227.63, 174.1, 231.60, 431.1, 233.36},
      {24.49, 204.01, 46.71, 232.75, 101.9, 238.74, 233.5, 241.86, 588.4, 242.98},
      {54.29, 224.08, 61.73, 242.33, 138.0, 248.06, 337.1, 250.87, 847.2, 251.83},
      {184.1, 214.67, 80.39, 237.47, 149.9, 247.09, 284.6, 253.78, 650.8, 255.73},
      {63.33, 233.31, 93.25, 243.07, 150.5, 251.58, 316.8, 253.51, 781.1, 253.86},
      {36.84, 208.44, 54.40, 236.79, 114.8, 243.55, 271.6, 245.72, 699.2, 246.41},
      {26.51, 193.62, 41.17, 220.10, 79.91, 237.24, 188.9, 236.91, 485.3, 236.95},
      {26.95, 170.87, 37.21, 208.13, 68.99, 222.53, 154.1, 227.45, 391.1, 228.86}};
  double worst[2] = {0, 0};
  for (int a = 0; a < ANGLES; a++)
    for (int n = 0; n < PRELOADS; n++) {
      worst[0] = fmax(worst[0], fabs(peak[a][n] / (1e-6 * wanted[a][2 * n]) - 1));
      worst[1] = fmax(worst[1], fabs(frequency[a][n] / wanted[a][2 * n + 1] - 1));
    }
  print_message("peaks within %.1e, frequencies within %.1e\n", worst[0], worst[1]);
  assert_true(worst[0] < 0.01 && worst[1] < 3e-3);
}

static int best_angle(int load) {
  int best = 0;
  for (int a = 1; a < ANGLES; a++)
    if (peak[a][load] < peak[best][load]) best = a;
  return -60 + 15 * best;
}

/* A face across the motion is pressed and opened; an oblique one slides. */
static void oblique_faces_damp_better(void **state) {
  (void)state;
  assert_int_equal(best_angle(0), -45);
  assert_int_equal(best_angle(1), -60);
  for (int n = 0; n < PRELOADS; n++) {
    assert_true(abs(best_angle(n)) >= 45);
    for (int a = 0; a < ANGLES; a++)
      if (a != ANGLES / 2) assert_true(frequency[a][4] < frequency[ANGLES / 2][4]);
  }
  assert_true(peak[ANGLES / 2][0] > 7 * peak[1][0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(peaks_are_those_of_the_table),
      cmocka_unit_test(oblique_faces_damp_better),
  };
  return cmocka_run_group_tests(tests, run_study, clean);
}
