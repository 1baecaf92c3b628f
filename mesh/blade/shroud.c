#include "mesh/blade/shroud.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/blade/airfoil.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

enum { CORNERS = MESH_SHROUD_LEGS + 1 };

static const double degree = SHB_PI / 180;

/* Least distance between the airfoil and the edges of the shroud, as a share of its length. */
static const double margin_share = 0.03;

static double half_sector(const mesh_blade *blade) {
  return SHB_PI / blade->blades;
}

static double underside(const mesh_blade *blade) {
  return blade->section[blade->n_sections - 1].radius;
}

/* Corners (tangential, axial) of the Z at mid thickness; origin at the centre of the contact
 * leg. */
static void z_corners(const mesh_blade *blade, double z[CORNERS][2]) {
  double t                  = blade->shroud_contact / 2 * sin(blade->psi);
  double a                  = blade->shroud_contact / 2 * cos(blade->psi);
  double l                  = blade->shroud_length / 2;
  double corner[CORNERS][2] = {{0, -l}, {t, -a}, {-t, a}, {0, l}};
  for (int i = 0; i < CORNERS; i++)
    for (int d = 0; d < 2; d++) z[i][d] = corner[i][d];
}

/* Tangential shift for a unit of radius: tan phi/cos psi. */
static double radial_slope(const mesh_blade *blade) {
  return tan(blade->phi) / cos(blade->psi);
}

/* Corner i of the Z at the underside (level 0) or top (level 1), relative to the radial plane of
 * the side. */
static void corner(const mesh_blade *blade, int i, int level, double own[3]) {
  double z[CORNERS][2], up = (level ? 0.5 : -0.5) * blade->shroud_thickness;
  z_corners(blade, z);
  own[0] = z[i][0] + up * radial_slope(blade);
  own[1] = z[i][1];
  own[2] = underside(blade) + 0.5 * blade->shroud_thickness + up;
}

/* Tangential coordinate of the side at (axial, radial), relative to the radial plane of the
 * side. */
static double side_at(const mesh_blade *blade, double axial, double radial) {
  double z[CORNERS][2];
  z_corners(blade, z);
  int leg = 0;
  while (leg < MESH_SHROUD_LEGS - 1 && axial > z[leg + 1][1]) leg++;
  double x  = (axial - z[leg][1]) / (z[leg + 1][1] - z[leg][1]);
  double up = radial - underside(blade) - 0.5 * blade->shroud_thickness;
  return z[leg][0] + x * (z[leg + 1][0] - z[leg][0]) + up * radial_slope(blade);
}

void mesh_shroud_centre(const mesh_blade *blade, int leg, bool right, double own[3]) {
  double c[3], sum[3] = {0, 0, 0};
  for (int i = leg; i <= leg + 1; i++)
    for (int level = 0; level < 2; level++) {
      corner(blade, i, level, c);
      for (int d = 0; d < 3; d++) sum[d] += c[d] / 4;
    }
  mesh_frame_rotate(right ? half_sector(blade) : -half_sector(blade), sum, own);
}

static double middle_radius(const mesh_blade *blade) {
  return underside(blade) + 0.5 * blade->shroud_thickness;
}

void mesh_shroud_outline(const mesh_blade *blade, double out[2 * CORNERS][2]) {
  const double half = middle_radius(blade) * half_sector(blade);
  double       z[CORNERS][2];
  z_corners(blade, z);
  for (int i = 0; i < CORNERS; i++) {
    double *right = out[i], *left = out[2 * CORNERS - 1 - i];
    right[0] = z[i][0] + half;
    left[0]  = z[i][0] - half;
    right[1] = left[1] = z[i][1];
  }
}

int mesh_shroud_contact_side(const mesh_blade *blade, const double at[2]) {
  const double half = middle_radius(blade) * half_sector(blade);
  const double from = at[0] - side_at(blade, at[1], middle_radius(blade));
  if (fabs(at[1]) >= blade->shroud_contact / 2 * cos(blade->psi)) return 0;
  return fabs(from - half) < 1e-9 ? 1 : fabs(from + half) < 1e-9 ? -1 : 0;
}

void mesh_shroud_roll_up(const mesh_blade *blade, const double at[2], double share, double own[3]) {
  const double radial = underside(blade) + share * blade->shroud_thickness;
  const double angle = (at[0] - side_at(blade, at[1], middle_radius(blade))) / middle_radius(blade);
  const double side[3] = {side_at(blade, at[1], radial), at[1], radial};
  mesh_frame_rotate(angle, side, own);
}

void mesh_shroud_unroll(const mesh_blade *blade, const double own[3], double at[2]) {
  const double side  = side_at(blade, own[1], underside(blade));
  const double angle = atan2(own[0], own[2]) - atan2(side, underside(blade));
  at[0]              = middle_radius(blade) * angle + side_at(blade, own[1], middle_radius(blade));
  at[1]              = own[1];
}

double mesh_shroud_underside(const mesh_blade *blade, const double own[3]) {
  const double radius = hypot(underside(blade), side_at(blade, own[1], underside(blade)));
  return sqrt(radius * radius - own[0] * own[0]);
}

static shb_status check_sizes(const mesh_blade *blade) {
  double axial = blade->shroud_contact * cos(blade->psi), r = underside(blade);
  SHB_CHECK(blade->blades >= 3, SHB_ERR_INPUT,
            "rotor.blades: %d; the shroud of the parametric blade spans one sector of at least 3",
            blade->blades);
  SHB_CHECK(fabs(blade->psi) <= (MESH_MAX_PSI + 1e-3) * degree, SHB_ERR_INPUT,
            "contact.psi: %g deg; the parametric blade takes -%d to %d deg", blade->psi / degree,
            MESH_MAX_PSI, MESH_MAX_PSI);
  SHB_CHECK(fabs(blade->phi) <= (MESH_MAX_PHI + 1e-3) * degree, SHB_ERR_INPUT,
            "contact.phi: %g deg; the parametric blade takes -%d to %d deg", blade->phi / degree,
            MESH_MAX_PHI, MESH_MAX_PHI);
  SHB_CHECK(blade->shroud_length > 0 && isfinite(blade->shroud_length), SHB_ERR_INPUT,
            "mesh.blade.shroud.length: %g mm; it must be positive", 1e3 * blade->shroud_length);
  SHB_CHECK(blade->shroud_thickness > 0 && blade->shroud_thickness <= 0.2 * r, SHB_ERR_INPUT,
            "mesh.blade.shroud.thickness: %g mm; it must be positive and at most a fifth of the "
            "radius below it, %g mm",
            1e3 * blade->shroud_thickness, 200 * r);
  SHB_CHECK(blade->shroud_contact > 0 && isfinite(blade->shroud_contact), SHB_ERR_INPUT,
            "mesh.blade.shroud.contact: %g mm; it must be positive", 1e3 * blade->shroud_contact);
  SHB_CHECK(axial <= 0.9 * blade->shroud_length, SHB_ERR_INPUT,
            "mesh.blade.shroud.contact: %g mm is too long: at contact.psi %g deg it takes %g mm of "
            "the shroud's length, %g mm; at most 90 %%, that is %g mm",
            1e3 * blade->shroud_contact, blade->psi / degree, 1e3 * axial,
            1e3 * blade->shroud_length, 900 * blade->shroud_length / cos(blade->psi));
  return SHB_OK;
}

/* Points of the airfoil's outline at the underside, then at the end inside the shroud. */
enum { AROUND = 2 * MESH_AIRFOIL_POINTS, POINTS = 2 * AROUND };

static void airfoil_points(const mesh_blade *blade, double own[POINTS][3]) {
  const double radius[2] = {underside(blade), mesh_airfoil_high_radius(blade)};
  for (int k = 0; k < 2; k++) {
    mesh_outline outline;
    mesh_section section = mesh_airfoil_at(blade, radius[k]);
    mesh_airfoil_outline(blade, &section, &outline);
    memcpy(own[k * AROUND], outline.suction, sizeof outline.suction);
    memcpy(own[k * AROUND + MESH_AIRFOIL_POINTS], outline.pressure, sizeof outline.pressure);
  }
}

static double margin(const mesh_blade *blade) {
  return margin_share * blade->shroud_length;
}

static shb_status check_length(const mesh_blade *blade, const double own[3]) {
  SHB_CHECK(fabs(own[1]) <= blade->shroud_length / 2 - margin(blade), SHB_ERR_INPUT,
            "mesh.blade.shroud.length: %g mm does not cover the last section, which reaches %g mm "
            "from its stacking line; give at least %.4g mm",
            1e3 * blade->shroud_length, 1e3 * fabs(own[1]),
            2e3 * fabs(own[1]) / (1 - 2 * margin_share));
  return SHB_OK;
}

/* The point nearest to a side of the shroud. */
typedef struct {
  double inside; /* distance from the side along the tangent, m; negative: outside */
  bool   right;  /* the side */
  int    point;
} clearance;

static clearance least_clearance(const mesh_blade *blade, const double own[POINTS][3]) {
  clearance least = {.inside = INFINITY};
  for (int i = 0; i < POINTS; i++)
    for (int s = -1; s <= 1; s += 2) { /* s = -1 left, 1 right, in the radial plane of the side */
      double seen[3];
      mesh_frame_rotate(-s * half_sector(blade), own[i], seen);
      const double inside = s * (side_at(blade, seen[1], seen[2]) - seen[0]);
      if (inside < least.inside) least = (clearance){inside, s > 0, i};
    }
  return least;
}

/* The angles psi nearest to the blade's own at which the shroud covers the airfoil, in whole
 * degrees. */
static bool covering_angles(const mesh_blade *blade, const double own[POINTS][3], int range[2]) {
  mesh_blade turned = *blade;
  double     best   = INFINITY;
  bool       inside = false;
  int        start  = 0;
  for (int psi = -MESH_MAX_PSI; psi <= MESH_MAX_PSI + 1; psi++) {
    turned.psi      = psi * degree;
    const bool fits = psi <= MESH_MAX_PSI && least_clearance(&turned, own).inside >= margin(blade);
    if (fits && !inside) start = psi;
    const double away = fmax(start * degree - blade->psi, blade->psi - (psi - 1) * degree);
    if (!fits && inside && away < best) {
      best     = away;
      range[0] = start;
      range[1] = psi - 1;
    }
    inside = fits;
  }
  return best < INFINITY;
}

static shb_status check_sides(const mesh_blade *blade, const double own[POINTS][3]) {
  const clearance least = least_clearance(blade, own);
  if (least.inside >= margin(blade)) return SHB_OK;
  int  range[2] = {0, 0};
  char turn[60] = "";
  if (covering_angles(blade, own, range))
    snprintf(turn, sizeof turn, ", or a contact.psi from %d to %d deg", range[0], range[1]);
  SHB_FAIL(SHB_ERR_INPUT,
           "mesh.blade.sections[%d]: the last section reaches %s the shroud's %s side (at %g mm "
           "tangential, %g mm axial) at contact.psi %g deg; less chord, camber or twist there, "
           "fewer rotor.blades%s",
           blade->n_sections - 1, least.inside > 0 ? "too near to" : "past",
           least.right ? "right" : "left", 1e3 * own[least.point][0], 1e3 * own[least.point][1],
           blade->psi / degree, turn);
}

/* The end of the airfoil must lie within the thickness; the ring is curved, the end is flat. */
static shb_status check_depth(const mesh_blade *blade, const double own[3]) {
  double h = blade->shroud_thickness, bottom = underside(blade), r = hypot(own[0], own[2]);
  double low  = hypot(bottom, side_at(blade, own[1], bottom)) + 0.1 * h;
  double high = hypot(bottom + h, side_at(blade, own[1], bottom + h)) - 0.1 * h;
  SHB_CHECK(r > low && r < high, SHB_ERR_INPUT,
            "mesh.blade.shroud.thickness: %g mm is too thin for the last section to end inside a "
            "shroud that curves with radius %g mm",
            1e3 * h, 1e3 * bottom);
  return SHB_OK;
}

shb_status mesh_shroud_check(const mesh_blade *blade) {
  double own[POINTS][3];
  SHB_TRY(check_sizes(blade));
  airfoil_points(blade, own);
  for (int i = 0; i < POINTS; i++) SHB_TRY(check_length(blade, own[i]));
  SHB_TRY(check_sides(blade, (const double(*)[3])own));
  for (int i = AROUND; i < POINTS; i++) SHB_TRY(check_depth(blade, own[i]));
  return SHB_OK;
}

/* Revolve the planar face of one leg of the left side by the sector angle. */
static shb_status revolve(const mesh_blade *blade, const mesh_frame *frame, int face, int *volume) {
  double axial[3];
  int    from[2] = {2, face}, *made = NULL;
  size_t n = 0;
  mesh_axis_vector(frame->axis, axial);
  GMSH_TRY("mesh.blade.shroud",
           gmshModelOccRevolve(from, 2, 0, 0, 0, axial[0], axial[1], axial[2],
                               2 * half_sector(blade), &made, &n, NULL, 0, NULL, 0, 0, &ierr));
  *volume = 0;
  for (size_t i = 0; i + 1 < n; i += 2)
    if (made[i] == 3) *volume = made[i + 1];
  gmshFree(made);
  SHB_CHECK(*volume, SHB_ERR_INPUT, "mesh.blade.shroud: gmsh cannot revolve its side");
  return SHB_OK;
}

shb_status mesh_shroud_build(const mesh_blade *blade, const mesh_frame *frame,
                             int volumes[MESH_SHROUD_LEGS]) {
  int point[CORNERS][2], rise[CORNERS], run[2];
  for (int i = 0; i < CORNERS; i++) {
    for (int level = 0; level < 2; level++) {
      double own[3];
      corner(blade, i, level, own);
      mesh_frame_rotate(-half_sector(blade), own, own);
      SHB_TRY(mesh_frame_add_point(frame, own, &point[i][level]));
    }
    GMSH_TRY("mesh.blade.shroud",
             rise[i] = gmshModelOccAddLine(point[i][0], point[i][1], -1, &ierr));
  }
  for (int leg = 0; leg < MESH_SHROUD_LEGS; leg++) {
    for (int level = 0; level < 2; level++)
      GMSH_TRY("mesh.blade.shroud", run[level] = gmshModelOccAddLine(
                                        point[leg][level], point[leg + 1][level], -1, &ierr));
    int curves[4] = {run[0], rise[leg + 1], run[1], rise[leg]}, loop = 0, face = 0;
    GMSH_TRY("mesh.blade.shroud", loop = gmshModelOccAddCurveLoop(curves, 4, -1, &ierr));
    GMSH_TRY("mesh.blade.shroud", face = gmshModelOccAddPlaneSurface(&loop, 1, -1, &ierr));
    SHB_TRY(revolve(blade, frame, face, &volumes[leg]));
  }
  return SHB_OK;
}
