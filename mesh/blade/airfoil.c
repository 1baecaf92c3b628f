#include "mesh/blade/airfoil.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

enum { N = MESH_AIRFOIL_POINTS };

/* Thickness divided by its maximum, which lies where 1.3 - 3.8 s + 1.8 s^2 = 0. */
static double thickness_at(double s) {
  const double skew = 0.3, top = (3.8 - sqrt(3.8 * 3.8 - 4 * 1.3 * 1.8)) / 3.6;
  double       here = s * (1 - s) * (1 + skew * (1 - 2 * s));
  return here / (top * (1 - top) * (1 + skew * (1 - 2 * top)));
}

/* Centroid in (xi, eta) of the closed polygon: suction side forward, pressure side back. */
static void centroid(double suction[N][2], double pressure[N][2], double centre[2]) {
  double loop[2 * N - 2][2], area = 0;
  for (int i = 0; i < N; i++) memcpy(loop[i], suction[i], sizeof loop[i]);
  for (int i = 1; i < N - 1; i++) memcpy(loop[N - 1 + i], pressure[N - 1 - i], sizeof loop[i]);
  centre[0] = centre[1] = 0;
  for (int i = 0; i < 2 * N - 2; i++) {
    const double *p = loop[i], *q = loop[(i + 1) % (2 * N - 2)];
    double        cross = p[0] * q[1] - p[1] * q[0];
    area += cross / 2;
    for (int d = 0; d < 2; d++) centre[d] += (p[d] + q[d]) * cross / 6;
  }
  for (int d = 0; d < 2; d++) centre[d] /= area;
}

/* Index of the first section with camber, or -1. */
static int cambered_section(const mesh_blade *blade) {
  for (int i = 0; i < blade->n_sections; i++)
    if (blade->section[i].camber != 0) return i;
  return -1;
}

void mesh_airfoil_outline(const mesh_blade *blade, const mesh_section *section,
                          mesh_outline *outline) {
  double       suction[N][2], pressure[N][2], centre[2];
  const int    cambered = cambered_section(blade);
  const double side     = cambered >= 0 && blade->section[cambered].camber < 0 ? -1 : 1;
  for (int i = 0; i < N; i++) {
    double s = (double)i / (N - 1), half = section->thickness / 2 * thickness_at(s);
    double camber  = 4 * section->camber * s * (1 - s);
    suction[i][0]  = s * section->chord;
    suction[i][1]  = camber + side * half;
    pressure[i][0] = s * section->chord;
    pressure[i][1] = camber - side * half;
  }
  centroid(suction, pressure, centre);
  double c = cos(section->twist), sn = sin(section->twist);
  for (int i = 0; i < 2 * N; i++) {
    const double *from = i < N ? suction[i] : pressure[i - N];
    double       *to   = i < N ? outline->suction[i] : outline->pressure[i - N];
    double        xi = from[0] - centre[0], eta = from[1] - centre[1];
    to[0] = sn * xi + c * eta;
    to[1] = c * xi - sn * eta;
    to[2] = section->radius;
  }
}

mesh_section mesh_airfoil_at(const mesh_blade *blade, double radius) {
  int i = 0;
  while (i < blade->n_sections - 2 && radius > blade->section[i + 1].radius) i++;
  const mesh_section *a = &blade->section[i], *b = &blade->section[i + 1];
  double              x  = (radius - a->radius) / (b->radius - a->radius);
  mesh_section        at = {.radius    = radius,
                            .chord     = a->chord + x * (b->chord - a->chord),
                            .thickness = a->thickness + x * (b->thickness - a->thickness),
                            .camber    = a->camber + x * (b->camber - a->camber),
                            .twist     = a->twist + x * (b->twist - a->twist)};
  return at;
}

double mesh_airfoil_chord(const mesh_blade *blade) {
  double chord = 0;
  for (int i = 0; i < blade->n_sections; i++) chord = fmax(chord, blade->section[i].chord);
  return chord;
}

double mesh_airfoil_low_radius(const mesh_blade *blade) {
  double span = blade->section[1].radius - blade->section[0].radius;
  return blade->section[0].radius - fmin(0.3 * blade->root_height, 0.2 * span);
}

double mesh_airfoil_high_radius(const mesh_blade *blade) {
  return blade->section[blade->n_sections - 1].radius + 0.5 * blade->shroud_thickness;
}

static shb_status check_section(const mesh_blade *blade, int i) {
  const mesh_section *s        = &blade->section[i];
  const int           cambered = cambered_section(blade);
  SHB_CHECK(s->radius > 0 && isfinite(s->radius), SHB_ERR_INPUT,
            "mesh.blade.sections[%d].radius: %g mm; it must be positive", i, 1e3 * s->radius);
  SHB_CHECK(i == 0 || s->radius > s[-1].radius, SHB_ERR_INPUT,
            "mesh.blade.sections[%d].radius: %g mm is not above the section before it, %g mm", i,
            1e3 * s->radius, i ? 1e3 * s[-1].radius : 0);
  SHB_CHECK(s->chord > 0 && isfinite(s->chord), SHB_ERR_INPUT,
            "mesh.blade.sections[%d].chord: %g mm; it must be positive", i, 1e3 * s->chord);
  SHB_CHECK(s->thickness > .01 * MESH_MIN_THICKNESS * s->chord &&
                s->thickness < .01 * MESH_MAX_THICKNESS * s->chord,
            SHB_ERR_INPUT,
            "mesh.blade.sections[%d].thickness: %g mm; it must be between 1 %% and 50 %% of the "
            "chord, %g mm to %g mm",
            i, 1e3 * s->thickness, 10 * s->chord, 500 * s->chord);
  SHB_CHECK(fabs(s->camber) <= .01 * MESH_MAX_CAMBER * s->chord, SHB_ERR_INPUT,
            "mesh.blade.sections[%d].camber: %g mm; at most 40 %% of the chord, %g mm, either way",
            i, 1e3 * s->camber, 400 * s->chord);
  SHB_CHECK(cambered < 0 || s->camber * blade->section[cambered].camber >= 0, SHB_ERR_INPUT,
            "mesh.blade.sections[%d].camber: %g mm bends the other way than sections[%d], %g mm", i,
            1e3 * s->camber, cambered, 1e3 * blade->section[cambered].camber);
  SHB_CHECK(fabs(s->twist) <= MESH_MAX_TWIST * SHB_PI / 180, SHB_ERR_INPUT,
            "mesh.blade.sections[%d].twist: %g deg; it must be between -80 and 80 deg", i,
            s->twist * 180 / SHB_PI);
  return SHB_OK;
}

/* The loft extends into root and shroud; the sections at its ends must still have a thickness. */
static shb_status check_extension(const mesh_blade *blade) {
  int          last  = blade->n_sections - 1;
  mesh_section below = mesh_airfoil_at(blade, mesh_airfoil_low_radius(blade));
  mesh_section above = mesh_airfoil_at(blade, mesh_airfoil_high_radius(blade));
  SHB_CHECK(below.chord > 0 && below.thickness > 0, SHB_ERR_INPUT,
            "mesh.blade.sections[0]: the airfoil tapers to nothing within the root block; make "
            "sections[0] and sections[1] more alike");
  SHB_CHECK(above.chord > 0 && above.thickness > 0, SHB_ERR_INPUT,
            "mesh.blade.sections[%d]: the airfoil tapers to nothing within the shroud; make "
            "sections[%d] and sections[%d] more alike",
            last, last - 1, last);
  return SHB_OK;
}

shb_status mesh_airfoil_check(const mesh_blade *blade) {
  SHB_CHECK(blade->n_sections >= 2 && blade->n_sections <= MESH_MAX_SECTIONS, SHB_ERR_INPUT,
            "mesh.blade.sections: %d given; 2 to %d are needed", blade->n_sections,
            MESH_MAX_SECTIONS);
  for (int i = 0; i < blade->n_sections; i++) SHB_TRY(check_section(blade, i));
  return check_extension(blade);
}

/* Spline through the points of one side; both sides share the points of the edges. */
static shb_status add_side(const mesh_frame *frame, double side[N][3], const int edge[2],
                           int *curve) {
  int tags[N];
  tags[0]     = edge[0];
  tags[N - 1] = edge[1];
  for (int i = 1; i < N - 1; i++) SHB_TRY(mesh_frame_add_point(frame, side[i], &tags[i]));
  GMSH_TRY("mesh.blade.sections", *curve = gmshModelOccAddSpline(tags, N, -1, &ierr));
  return SHB_OK;
}

static shb_status add_wire(const mesh_blade *blade, const mesh_section *section,
                           const mesh_frame *frame, int *wire) {
  mesh_outline outline;
  mesh_airfoil_outline(blade, section, &outline);
  int edge[2], curve[2];
  SHB_TRY(mesh_frame_add_point(frame, outline.suction[0], &edge[0]));
  SHB_TRY(mesh_frame_add_point(frame, outline.suction[N - 1], &edge[1]));
  SHB_TRY(add_side(frame, outline.suction, edge, &curve[0]));
  SHB_TRY(add_side(frame, outline.pressure, edge, &curve[1]));
  GMSH_TRY("mesh.blade.sections", *wire = gmshModelOccAddCurveLoop(curve, 2, -1, &ierr));
  return SHB_OK;
}

shb_status mesh_airfoil_build(const mesh_blade *blade, const mesh_frame *frame, int *volume) {
  int          wires[MESH_MAX_SECTIONS + 2], n = 0;
  mesh_section below = mesh_airfoil_at(blade, mesh_airfoil_low_radius(blade));
  mesh_section above = mesh_airfoil_at(blade, mesh_airfoil_high_radius(blade));
  SHB_TRY(add_wire(blade, &below, frame, &wires[n++]));
  for (int i = 0; i < blade->n_sections; i++)
    SHB_TRY(add_wire(blade, &blade->section[i], frame, &wires[n++]));
  SHB_TRY(add_wire(blade, &above, frame, &wires[n++]));
  enum { DEGREE = 3 }; /* radial degree; a higher one makes the fusion three times slower */
  int   *made   = NULL;
  size_t n_made = 0;
  GMSH_TRY("mesh.blade.sections",
           gmshModelOccAddThruSections(wires, (size_t)n, &made, &n_made, -1, 1, 0, DEGREE, &ierr));
  bool solid = n_made == 2 && made[0] == 3;
  *volume    = solid ? made[1] : 0;
  gmshFree(made);
  SHB_CHECK(solid, SHB_ERR_INPUT,
            "mesh.blade.sections: the sections cannot be lofted into a solid; make neighbouring "
            "sections more alike");
  return SHB_OK;
}
