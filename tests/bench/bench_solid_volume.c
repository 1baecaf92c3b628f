/* How far the volume of a mesh is off that of its solid: what is told, and the truth. Beside it
 * OpenCASCADE's own volume. The exact volume of a loft is the integral of its sections. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/solid.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

/* Sections of an airfoil with a thin nose, in mm, twisted and tapered; "lofted" is volume 1. */
#define LOFT(n)                                                                            \
  "For s In {0:" #n                                                                        \
  "}\n  p = newp; t = -0.2*s; c = 15 - 2*s;\n  For i In {0:23}\n"                          \
  "    a = 2*Pi*i/24; x = c*Cos(a); y = (3 - 0.7*s)*Sin(a)*(1 + 0.3*Cos(a));\n"            \
  "    Point(p + i) = {x*Cos(t) - y*Sin(t), x*Sin(t) + y*Cos(t), 300 + 40*s};\n  EndFor\n" \
  "  BSpline(s + 1) = {p:p + 23, p};\n  Curve Loop(s + 1) = {s + 1};\nEndFor\n"            \
  "ThruSections(1) = {1:" #n " + 1};\n"

/* exact: cubic millimetres, besides the part of the loft from `low` to `high`. */
typedef struct {
  const char *name, *script;
  double      exact;
  const char *loft;
  double      low, high;
} body;

static const body bodies[] = {
    {"box", "Box(1) = {0, 0, 300, 40, 20, 50};\n", 4e4, NULL, 0, 0},
    {"cylinder", "Cylinder(1) = {0, 0, 300, 0, 0, 30, 10};\n", 3e3 * SHB_PI, NULL, 0, 0},
    {"ball", "Sphere(1) = {0, 0, 300, 10};\n", 4e3 / 3 * SHB_PI, NULL, 0, 0},
    {"torus", "Torus(1) = {0, 0, 300, 30, 8};\n", 2 * SHB_PI *SHB_PI * 30 * 64, NULL, 0, 0},
    {"two sections", LOFT(1), 0, LOFT(1), 300, 340},
    {"three sections", LOFT(2), 0, LOFT(2), 300, 380},
    {"a part of it",
     LOFT(2) "Box(2) = {-50, -50, 312, 100, 100, 53};\n"
             "BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n",
     0, LOFT(2), 312, 365},
    {"between blocks",
     LOFT(2) "Box(2) = {-25, -20, 290, 50, 40, 22};\nBox(3) = {-25, -20, 365, 50, 40, 25};\n"
             "BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2,3}; Delete; };\n",
     2000. * (22 + 25), LOFT(2), 312, 365}};

enum { BODIES = sizeof bodies / sizeof *bodies, AROUND = 2000, STEPS = 60 };

static void put(const char *text) {
  FILE *file = fopen(scratch("body.geo"), "w");
  assert_non_null(file);
  fprintf(file, "SetFactory(\"OpenCASCADE\");\n%s", text);
  fclose(file);
}

/* Area of a section and its height, mm: of polygons of n and n/2 sides, to fourth order. */
static double section(int tag, const double *u, const double *at, double v, double *z) {
  double parameter[2 * AROUND], sum[2] = {0};
  for (int i = 0; i < AROUND; i++) {
    parameter[2 * i]     = u[0] + (u[1] - u[0]) * i / AROUND;
    parameter[2 * i + 1] = at[0] + (at[1] - at[0]) * v;
  }
  double *x    = NULL;
  size_t  n    = 0;
  int     ierr = 0;
  gmshModelGetValue(2, tag, parameter, (size_t)2 * AROUND, &x, &n, &ierr);
  assert_int_equal(ierr, 0);
  for (int each = 1; each <= 2; each++)
    for (int i = 0; i < AROUND; i += each) {
      const double *p = x + 3 * (size_t)i, *q = x + 3 * (size_t)((i + each) % AROUND);
      sum[each - 1] += (p[0] * q[1] - q[0] * p[1]) / 2;
    }
  *z = x[2];
  gmshFree(x);
  return fabs(4 * sum[0] - sum[1]) / 3;
}

/* Tag of the face of a loft that is not flat. */
static int side_of_loft(void) {
  int   *tags = NULL, found = -1, ierr = 0;
  size_t n = 0;
  gmshModelGetEntities(&tags, &n, 2, &ierr);
  for (size_t i = 0; i + 1 < n; i += 2) {
    char *type = NULL;
    gmshModelGetType(2, tags[i + 1], &type, &ierr);
    if (strcmp(type, "Plane") != 0) found = tags[i + 1];
    gmshFree(type);
  }
  gmshFree(tags);
  assert_true(found > 0);
  return found;
}

/* Volume of a loft between two heights, cubic mm, by Simpson's rule. */
static double lofted(const body *b) {
  mesh_session session;
  double      *low = NULL, *high = NULL, total = 0;
  size_t       n    = 0;
  int          ierr = 0;
  put(b->loft);
  assert_ok(mesh_session_open(&session));
  gmshOpen(scratch("body.geo"), &ierr);
  const int side = side_of_loft();
  gmshModelGetParametrizationBounds(2, side, &low, &n, &high, &n, &ierr);
  const double u[2] = {low[0], high[0]}, v[2] = {low[1], high[1]};
  double       z0, z1;
  section(side, u, v, 0, &z0);
  section(side, u, v, 1, &z1);
  for (int i = 0; i <= STEPS; i++) {
    const double wanted = b->low + (b->high - b->low) * i / STEPS;
    double       at = (wanted - z0) / (z1 - z0), z, area = 0;
    for (int step = 0; step < 8; step++) { /* the height is nearly linear in v */
      area = section(side, u, v, at, &z);
      if (fabs(z - wanted) < 1e-10) break;
      at += (wanted - z) / (z1 - z0);
    }
    assert_near(z, wanted, 1e-8);
    total += area * (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2);
  }
  gmshFree(low);
  gmshFree(high);
  mesh_session_close(&session);
  return total * (b->high - b->low) / STEPS / 3;
}

/* A row; false: what is told does not hold. */
static bool row(const body *b, double exact, double size) {
  mesh_source source = {
      .path = scratch("body.geo"), .unit = 1e-3, .size = size, .axis = MESH_AXIS_X};
  mesh_solid solid;
  mesh_fe    mesh;
  int       *tags = NULL, ierr = 0;
  size_t     n    = 0;
  double     mass = 0;
  put(b->script);
  assert_ok(mesh_solid_open(&source, NULL, &solid));
  if (mesh_solid_mesh(&solid, &mesh) != SHB_OK) { /* too coarse */
    mesh_solid_close(&solid);
    printf("%-15s %4.1f refused: %.60s\n", b->name, 1e3 * size, strstr(shb_message(), ".geo:"));
    return true;
  }
  gmshModelGetEntities(&tags, &n, 3, &ierr);
  gmshModelOccGetMass(3, tags[1], &mass, &ierr);
  gmshFree(tags);
  mesh_solid_close(&solid);
  const mesh_surface_gap *gap      = &solid.faults.gap;
  const double            true_off = gap->volume / exact - 1, told = -gap->missing / exact;
  const double            error = gap->error / exact;
  const bool              holds = fabs(told - true_off) <= error + 1e-6;
  printf("%-15s %4.1f %8d %10.1e %11.2e %11.2e %9.1e %9.1e %6d %s\n", b->name, 1e3 * size,
         mesh.n_elements, mass * 1e-9 / exact - 1, true_off, told, fabs(told - true_off), error,
         solid.faults.straightened, holds ? "" : "  <-- beyond the error");
  mesh_fe_free(&mesh);
  return holds;
}

int main(int argc, char **argv) {
  const bool          quick  = argc > 1 && strcmp(argv[1], "--quick") == 0;
  static const double size[] = {6e-3, 3e-3, 1.7e-3};
  int                 bad    = 0;
  void               *state  = NULL;
  if (scratch_make(&state) != 0) return 1;
  printf("%-15s %4s %8s %10s %11s %11s %9s %9s %6s\n", "body", "mm", "elements", "OCC off",
         "mesh off", "told", "wrong by", "error", "moved");
  for (int i = 0; i < BODIES; i++) {
    const double exact = (bodies[i].exact + (bodies[i].loft ? lofted(&bodies[i]) : 0)) * 1e-9;
    for (int k = 0; k < (quick ? 2 : 3); k++) bad += !row(&bodies[i], exact, size[k]);
  }
  scratch_remove(&state);
  printf("%s\n", bad ? "some volumes are off by more than is told" : "all that is told holds");
  return bad > 0;
}
