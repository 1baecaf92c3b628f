/* Gauges on a bar: pulled, bent and sheared in closed form, both elements; faults; the table. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "postproc/field/strain_gauge.h"
#include "tests/support/box.h"
#include "tests/support/check.h"

/* Modes of the bar: a pull along x, a pure bending about y, a shear in the face z. */
enum { PULL, BEND, SHEAR, MODES };

static const double SIZE[3] = {0.2, 0.03, 0.01};
static const double NU = 0.3, STRAIN = 1.7e-3, CURVATURE = 0.23, ANGLE = 4.1e-3;

/* Exact displacement of a mode; the middle plane of the bending is z = h/2. */
static void displacement(int mode, const double x[3], double u[3]) {
  const double z = x[2] - SIZE[2] / 2, y = x[1] - SIZE[1] / 2;
  if (mode == PULL) {
    u[0] = STRAIN * x[0], u[1] = -NU * STRAIN * x[1], u[2] = -NU * STRAIN * x[2];
  } else if (mode == BEND) { /* strain -CURVATURE z along x, its contraction, and the deflection */
    u[0] = -CURVATURE * x[0] * z;
    u[1] = NU * CURVATURE * y * z;
    u[2] = CURVATURE * (x[0] * x[0] + NU * (z * z - y * y)) / 2;
  } else {
    u[0] = ANGLE * x[1], u[1] = u[2] = 0;
  }
}

static post_blade_field make(const mesh_fe *mesh, double *shape) {
  for (int m = 0; m < MODES; m++)
    for (int i = 0; i < mesh->n_nodes; i++)
      displacement(m, mesh->coordinates + 3 * i, shape + 3 * ((size_t)m * mesh->n_nodes + i));
  return (post_blade_field){.n_nodes             = mesh->n_nodes,
                            .n_modes             = MODES,
                            .nodes               = mesh->coordinates,
                            .mesh                = *mesh,
                            .shape               = shape,
                            .static_displacement = shape};
}

/* At the top, off every node, along (cos a, sin a). */
static void check(const post_blade_field *field, double angle, double height) {
  const double c = cos(angle), s = sin(angle), z = height - SIZE[2] / 2;
  post_gauge   g = {.name      = "g",
                    .at        = {0.0837, 0.0123, height},
                    .direction = {3 * c, 3 * s, 0.2}}; /* 0.2 is normal to the surface */
  assert_ok(post_gauge_place(field, &g));
  const double wanted[MODES] = {STRAIN * (c * c - NU * s * s),
                                -CURVATURE * z * (c * c - NU * s * s), ANGLE * c * s};
  const double least[MODES]  = {STRAIN, CURVATURE * SIZE[2] / 2, ANGLE};
  for (int m = 0; m < MODES; m++) {
    print_message("%.4g rad, mode %d: strain %.6e, off by %.1e\n", angle, m, creal(g.mode[m]),
                  cabs(g.mode[m] - wanted[m]) / least[m]);
    assert_near(creal(g.mode[m]) / least[m], wanted[m] / least[m], 1e-11);
  }
  assert_near(g.at_speed / STRAIN, wanted[PULL] / STRAIN, 1e-11);
  assert_near(g.foot[2], height, 1e-15);
  post_gauge_free(&g);
}

static void strain_is_that_of_the_closed_form(void **state) {
  (void)state;
  const int n[3] = {9, 3, 2};
  for (int hex = 0; hex < 2; hex++) {
    mesh_fe mesh = {0};
    assert_ok(hex ? box_hex(SIZE, n, &mesh) : box_mesh(SIZE, n, &mesh));
    double          *shape = malloc(sizeof(double) * MODES * 3 * (size_t)mesh.n_nodes);
    post_blade_field field = make(&mesh, shape);
    check(&field, 0, SIZE[2]);
    check(&field, 0.61, SIZE[2]);
    check(&field, -1.2, 0);
    free(shape);
    mesh_fe_free(&mesh);
  }
}

static void faults_are_told(void **state) {
  (void)state;
  const int n[3] = {4, 2, 2};
  mesh_fe   mesh = {0};
  assert_ok(box_hex(SIZE, n, &mesh));
  double          *shape = malloc(sizeof(double) * MODES * 3 * (size_t)mesh.n_nodes);
  post_blade_field field = make(&mesh, shape);
  post_gauge       far   = {.name = "g1", .at = {0.1, 0.01, 0.06}, .direction = {1, 0, 0}};
  post_gauge       up    = {.name = "g2", .at = {0.1, 0.01, 0.01}, .direction = {0, 0.01, 1}};
  assert_int_equal(post_gauge_place(&field, &far), SHB_ERR_INPUT);
  assert_string_equal(shb_message(), "gauge.g1.at: is 50 mm from the surface of the blade");
  assert_int_equal(post_gauge_place(&field, &up), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "gauge.g2.direction: is normal to the surface there"));
  free(shape);
  mesh_fe_free(&mesh);
}

/* Two modes and a residual column: 2 sin, mean 0.5; peak to peak of one harmonic is twice. */
static void the_table_has_a_row_a_point_and_gauge(void **state) {
  (void)state;
  double           frequency = 97.5, n0 = 30, scale = 1;
  double complex   mode[2] = {1e-3, 2e-3}, residual = 1e-4;
  int              point = 0, special = MHB_PEAK, stable = 0;
  double complex   amplitude[4] = {0.5, 0, CMPLX(0, 2), 1}, force[2] = {0, 10};
  mhb_branch       b        = {.order = 1, .n_harmonics = 1, .n_points = 1};
  post_buffer      table    = {0};
  double complex   weight   = 0;
  post_blade_field field    = {.n_modes = 2, .n_contact = 1, .n_column = 1, .load_weight = &weight};
  post_gauge       g        = {.name = "g1", .mode = mode, .residual = &residual, .at_speed = NAN};
  mhb_response     response = {.n_branches = 1, .branch = &b};
  b.frequency               = &frequency;
  b.n0                      = &n0;
  b.special                 = &special;
  b.stable                  = &stable;
  b.modal                   = (mhb_modal_motion){1, 1, &point, amplitude, force, &scale};
  assert_ok(post_gauge_table(&field, &response, 1, &g, &table));
  /* 2e-3 + 1e-3 + 2e-3 j, so the amplitude is sqrt(13) 1e-3 */
  assert_string_equal(strchr(table.text, '\n') + 1,
                      "0,nonlinear,30,97.5,0,peak,0,g1,0.00360555127546,0.00721110255093,0.0005,"
                      "\r\n");
  post_buffer_free(&table);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(strain_is_that_of_the_closed_form),
                                     cmocka_unit_test(faults_are_told),
                                     cmocka_unit_test(the_table_has_a_row_a_point_and_gauge)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
