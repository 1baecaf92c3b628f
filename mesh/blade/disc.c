#include "mesh/blade/disc.h"

#include <math.h>

#include "mesh/base/constants.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

enum { CORNERS = 8 };

/* The profile: radii of bore, lower end of the taper, foot and top of the rim; half lengths of web
 * and rim, m. */
typedef struct {
  double bore, taper, foot, top, web, rim;
} profile;

/* Radius of the lower corners of the root block. */
static double corner_radius(const mesh_blade *blade) {
  return hypot(blade->section[0].radius - blade->root_height, blade->root_width / 2);
}

static profile profile_of(const mesh_blade *blade) {
  const double top  = (corner_radius(blade) + blade->section[0].radius) / 2;
  const double foot = top - blade->disc_rim;
  return (profile){blade->disc_bore,    foot - blade->disc_taper, foot, top,
                   blade->disc_web / 2, blade->root_length / 2};
}

void mesh_disc_radii(const mesh_blade *blade, double radius[4]) {
  const profile p = profile_of(blade);
  radius[0]       = p.bore;
  radius[1]       = p.taper;
  radius[2]       = p.foot;
  radius[3]       = p.top;
}

double mesh_disc_angle(const mesh_blade *blade, double tangential) {
  return asin(tangential / profile_of(blade).top);
}

double mesh_disc_top(const mesh_blade *blade, double tangential) {
  const double top = profile_of(blade).top;
  return sqrt(top * top - tangential * tangential);
}

/* Half length of the profile at a radius. */
static double half_length(const profile *p, double radius) {
  if (radius >= p->foot) return p->rim;
  if (radius <= p->taper) return p->web;
  return p->web + (p->rim - p->web) * (radius - p->taper) / (p->foot - p->taper);
}

void mesh_disc_point(const mesh_blade *blade, double radius, const double place[2], double own[3]) {
  const profile p = profile_of(blade);
  own[0]          = 0;
  own[1]          = place[1] * half_length(&p, radius) / p.rim;
  own[2]          = radius;
  mesh_frame_rotate(place[0], own, own);
}

bool mesh_disc_wanted(const mesh_blade *blade) {
  return blade->disc_bore > 0;
}

/* The block must stand in the rim, inside the sector. */
static shb_status check_root(const mesh_blade *blade) {
  const double bottom = blade->section[0].radius - blade->root_height;
  const double pitch  = 2 * bottom * tan(SHB_PI / blade->blades);
  const double least  = corner_radius(blade) - bottom;
  SHB_CHECK(blade->root_height >= 1.2 * least, SHB_ERR_INPUT,
            "mesh.blade.root.height: %g mm is too low for a block of that width on the rim of a "
            "disc; give at least %.4g mm",
            1e3 * blade->root_height, 1.2e3 * least);
  SHB_CHECK(blade->root_width <= 0.95 * pitch, SHB_ERR_INPUT,
            "mesh.blade.root.width: %g mm reaches the sides of the disc; give at most %.4g mm",
            1e3 * blade->root_width, 0.95e3 * pitch);
  return SHB_OK;
}

/* Hexahedra follow the taper; a steep one would make flat elements. */
static shb_status check_taper(const mesh_blade *blade, const profile *p) {
  static const double steepest = 2; /* axial by radial */
  const double        least    = (p->rim - p->web) / steepest;
  SHB_CHECK(blade->disc_taper >= 0, SHB_ERR_INPUT,
            "mesh.blade.disc.taper: %g mm; it must not be negative", 1e3 * blade->disc_taper);
  SHB_CHECK(
      blade->elements != MESH_HEX20 || p->foot - p->taper >= least, SHB_ERR_INPUT,
      "mesh.blade.disc.taper: hexahedra are swept along the radius, and need the web to widen "
      "over %.4g mm at least, not %g mm; give that, or mesh.blade.elements: tet10",
      1e3 * least, 1e3 * blade->disc_taper);
  return SHB_OK;
}

shb_status mesh_disc_check(const mesh_blade *blade) {
  if (!mesh_disc_wanted(blade)) return SHB_OK;
  SHB_TRY(check_root(blade));
  const profile p      = profile_of(blade);
  const double  bottom = blade->section[0].radius - blade->root_height;
  SHB_CHECK(p.foot <= 0.99 * bottom, SHB_ERR_INPUT,
            "mesh.blade.disc.rim: %g mm leaves the root block below the rim; give at least %.4g mm",
            1e3 * blade->disc_rim, 1e3 * (p.top - 0.99 * bottom));
  SHB_CHECK(p.taper > 1.02 * p.bore, SHB_ERR_INPUT,
            "mesh.blade.disc.bore: %g mm is not below the rim, whose foot%s is at %.4g mm",
            1e3 * p.bore, blade->disc_taper > 0 ? " with its taper" : "", 1e3 * p.taper);
  SHB_CHECK(p.web > 0 && p.web <= 0.95 * p.rim, SHB_ERR_INPUT,
            "mesh.blade.disc.web: %g mm; it must be above 0 and at most %.4g mm, as the rim is as "
            "long as the root block",
            1e3 * blade->disc_web, 1.9e3 * p.rim);
  return check_taper(blade, &p);
}

enum { PARTS = 3 };

/* Areas of web, taper and rim in the profile, and their mean radii. */
static void parts_of(const profile *p, double area[PARTS], double radius[PARTS]) {
  const double height = p->foot - p->taper, both = p->web + p->rim;
  area[0]   = 2 * p->web * (p->taper - p->bore);
  area[1]   = both * height;
  area[2]   = 2 * p->rim * (p->top - p->foot);
  radius[0] = (p->taper + p->bore) / 2;
  radius[1] = p->taper + height * (p->web + 2 * p->rim) / (3 * both);
  radius[2] = (p->top + p->foot) / 2;
}

/* Area of the profile, and that times its mean radius. */
static void moments_of(const profile *p, double *area, double *moment) {
  double part[PARTS], radius[PARTS];
  parts_of(p, part, radius);
  *area = *moment = 0;
  for (int i = 0; i < PARTS; i++) {
    *area += part[i];
    *moment += part[i] * radius[i];
  }
}

double mesh_disc_volume(const mesh_blade *blade) {
  const profile p = profile_of(blade);
  double        area, moment;
  if (!mesh_disc_wanted(blade)) return 0;
  moments_of(&p, &area, &moment);
  return SHB_TWO_PI / blade->blades * moment;
}

void mesh_disc_bore_centre(const mesh_blade *blade, double own[3]) {
  const double half = SHB_PI / blade->blades;
  own[0] = own[1] = 0;
  own[2]          = blade->disc_bore * sin(half) / half;
}

void mesh_disc_side_centre(const mesh_blade *blade, bool right, double own[3]) {
  const profile p = profile_of(blade);
  double        area, moment;
  moments_of(&p, &area, &moment);
  own[0] = own[1] = 0;
  own[2]          = moment / area;
  mesh_frame_rotate((right ? 1 : -1) * SHB_PI / blade->blades, own, own);
}

/* The profile on the left side, as a plane surface. */
static shb_status build_profile(const mesh_blade *blade, const mesh_frame *frame, int *surface) {
  const profile p                  = profile_of(blade);
  const double  corner[CORNERS][2] = {{-p.web, p.bore}, {p.web, p.bore},  {p.web, p.taper},
                                      {p.rim, p.foot},  {p.rim, p.top},   {-p.rim, p.top},
                                      {-p.rim, p.foot}, {-p.web, p.taper}};
  int           point[CORNERS], line[CORNERS], loop = 0;
  for (int i = 0; i < CORNERS; i++) {
    double own[3] = {0, corner[i][0], corner[i][1]};
    mesh_frame_rotate(-SHB_PI / blade->blades, own, own);
    SHB_TRY(mesh_frame_add_point(frame, own, &point[i]));
  }
  for (int i = 0; i < CORNERS; i++)
    GMSH_TRY("mesh.blade.disc",
             line[i] = gmshModelOccAddLine(point[i], point[(i + 1) % CORNERS], -1, &ierr));
  GMSH_TRY("mesh.blade.disc", loop = gmshModelOccAddCurveLoop(line, CORNERS, -1, &ierr));
  GMSH_TRY("mesh.blade.disc", *surface = gmshModelOccAddPlaneSurface(&loop, 1, -1, &ierr));
  return SHB_OK;
}

shb_status mesh_disc_build(const mesh_blade *blade, const mesh_frame *frame, int *volume) {
  int    surface = 0, *made = NULL;
  size_t n = 0;
  double axial[3];
  SHB_TRY(build_profile(blade, frame, &surface));
  mesh_axis_vector(frame->axis, axial);
  GMSH_TRY("mesh.blade.disc",
           gmshModelOccRevolve((int[]){2, surface}, 2, 0, 0, 0, axial[0], axial[1], axial[2],
                               SHB_TWO_PI / blade->blades, &made, &n, NULL, 0, NULL, 0, 0, &ierr));
  *volume = 0;
  for (size_t i = 0; i + 1 < n; i += 2)
    if (made[i] == 3) *volume = made[i + 1];
  gmshFree(made);
  SHB_CHECK(*volume > 0, SHB_ERR_INPUT, "mesh.blade.disc: the profile makes no solid");
  return SHB_OK;
}
