/* Smoothing of planar quadrangles: fixed nodes stay, the worst corner improves. */
#include "mesh/blade/section_smoothing.h"

#include "tests/support/check.h"

enum { CELLS = 4, LINE = CELLS + 1, CORNERS = LINE * LINE, EDGES = 2 * CELLS * LINE };

/* A unit square of 4 x 4 quadrangles without a section; corner nodes first, then middles. */
static void make_square(mesh_planar *plan, double (*at)[2], int (*quad)[8]) {
  *plan =
      (mesh_planar){.n_nodes = CORNERS + EDGES, .n_quads = CELLS * CELLS, .at = at, .quad = quad};
  for (int i = 0; i < CORNERS; i++) {
    at[i][0] = (double)(i % LINE) / CELLS;
    at[i][1] = (double)(i / LINE) / CELLS;
  }
  for (int q = 0; q < CELLS * CELLS; q++) {
    const int x = q % CELLS, y = q / CELLS, low = LINE * y + x;
    const int own[8] = {low,
                        low + 1,
                        low + LINE + 1,
                        low + LINE,
                        CORNERS + CELLS * y + x,
                        CORNERS + CELLS * LINE + CELLS * (x + 1) + y,
                        CORNERS + CELLS * (y + 1) + x,
                        CORNERS + CELLS * LINE + CELLS * x + y};
    memcpy(quad[q], own, sizeof own);
  }
}

static void the_worst_corner_improves_and_the_rim_stays(void **state) {
  (void)state;
  double      at[CORNERS + EDGES][2];
  int         quad[CELLS * CELLS][8];
  mesh_planar plan;
  make_square(&plan, at, quad);
  at[6][0] += 0.2;
  at[6][1] += 0.15;
  at[18][0] -= 0.22;
  const double before = mesh_planar_least_sine(&plan);
  mesh_planar_smooth(&plan);
  const double after = mesh_planar_least_sine(&plan);
  print_message("least sine %.3f, smoothed %.3f\n", before, after);
  assert_true(before < 0.5 && after > 0.9);
  for (int i = 0; i < CORNERS; i++) {
    const int x = i % LINE, y = i / LINE;
    if (x > 0 && x < CELLS && y > 0 && y < CELLS) continue;
    assert_true(at[i][0] == (double)x / CELLS && at[i][1] == (double)y / CELLS);
  }
  for (int q = 0; q < plan.n_quads; q++)
    for (int c = 0; c < 4; c++)
      for (int d = 0; d < 2; d++)
        assert_near(at[quad[q][4 + c]][d], (at[quad[q][c]][d] + at[quad[q][(c + 1) % 4]][d]) / 2,
                    0);
}

static void a_square_mesh_is_left_alone(void **state) {
  (void)state;
  double      at[CORNERS + EDGES][2], was[CORNERS][2];
  int         quad[CELLS * CELLS][8];
  mesh_planar plan;
  make_square(&plan, at, quad);
  memcpy(was, at, sizeof was);
  mesh_planar_smooth(&plan);
  assert_memory_equal(at, was, sizeof was);
  assert_near(mesh_planar_least_sine(&plan), 1, 1e-15);
}

/* A contour that the quadrangles do not touch is told by -1. */
static void a_contour_that_is_not_met(void **state) {
  (void)state;
  double      at[CORNERS + EDGES][2];
  int         quad[CELLS * CELLS][8];
  mesh_planar plan;
  make_square(&plan, at, quad);
  plan.n_contour = 8;
  assert_near(mesh_planar_least_sine(&plan), -1, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_worst_corner_improves_and_the_rim_stays),
                                     cmocka_unit_test(a_square_mesh_is_left_alone),
                                     cmocka_unit_test(a_contour_that_is_not_met)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
