#include "mesh/blade/loft.h"

#include <math.h>
#include <string.h>

#include "mesh/base/root.h"
#include "mesh/blade/airfoil.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

static const char *const case_key = "mesh.blade.sections";

/* Point of a side at parameters (chord, radial), each from 0 at low to 1 at high; blade
 * coordinates. */
static shb_status evaluate(const mesh_loft *loft, const mesh_loft_side *side, double chord,
                           double radial, double own[3]) {
  double at[2], *xyz = NULL;
  size_t n             = 0;
  at[1 - side->radial] = side->low[0] + chord * (side->high[0] - side->low[0]);
  at[side->radial]     = side->low[1] + radial * (side->high[1] - side->low[1]);
  GMSH_TRY(case_key, gmshModelGetValue(2, side->face, at, 2, &xyz, &n, &ierr));
  mesh_frame_to_own(&loft->frame, xyz, own);
  gmshFree(xyz);
  return SHB_OK;
}

static void swap(double *a, double *b) {
  double was = *a;
  *a         = *b;
  *b         = was;
}

/* Find the radial parameter of a side and the directions of both parameters. */
static shb_status orient_parameters(const mesh_blade *blade, const mesh_loft *loft,
                                    mesh_loft_side *side) {
  double *low = NULL, *high = NULL, own[4][3];
  size_t  n_low = 0, n_high = 0;
  GMSH_TRY(case_key,
           gmshModelGetParametrizationBounds(2, side->face, &low, &n_low, &high, &n_high, &ierr));
  side->radial = 1;
  for (int i = 0; i < 2; i++) {
    side->low[i]  = low[i];
    side->high[i] = high[i];
  }
  gmshFree(low);
  gmshFree(high);
  SHB_TRY(evaluate(loft, side, 0, 0, own[0]));
  SHB_TRY(evaluate(loft, side, 1, 0, own[1]));
  if (fabs(own[1][2] - own[0][2]) > 1e-9) {
    side->radial = 0;
    swap(&side->low[0], &side->low[1]);
    swap(&side->high[0], &side->high[1]);
  }
  SHB_TRY(evaluate(loft, side, 0, 0, own[0]));
  SHB_TRY(evaluate(loft, side, 0, 1, own[1]));
  if (own[0][2] > own[1][2]) swap(&side->low[1], &side->high[1]);
  mesh_section section = mesh_airfoil_at(blade, mesh_airfoil_low_radius(blade));
  mesh_outline outline;
  mesh_airfoil_outline(blade, &section, &outline);
  SHB_TRY(evaluate(loft, side, 0, 0, own[0]));
  SHB_TRY(evaluate(loft, side, 1, 0, own[1]));
  const double *edge = outline.suction[0];
  if (hypot(own[0][0] - edge[0], own[0][1] - edge[1]) >
      hypot(own[1][0] - edge[0], own[1][1] - edge[1]))
    swap(&side->low[0], &side->high[0]);
  SHB_TRY(evaluate(loft, side, 0, 0, own[2]));
  SHB_TRY(evaluate(loft, side, 0, 1, own[3]));
  side->bottom = own[2][2];
  side->top    = own[3][2];
  return SHB_OK;
}

/* The two faces of the solid that are not planar. The pressure side is the one through the pressure
 * side of the outline. */
static shb_status find_sides(const mesh_blade *blade, mesh_loft *loft) {
  int   *tags = NULL, found = 0;
  size_t n = 0;
  double middle[2][3];
  GMSH_TRY(case_key, gmshModelGetEntities(&tags, &n, 2, &ierr));
  for (size_t i = 0; i + 1 < n; i += 2) {
    char *type = NULL;
    int   ierr = 0;
    gmshModelGetType(2, tags[i + 1], &type, &ierr);
    if (type && strcmp(type, "Plane") != 0) {
      if (found < 2) loft->side[found].face = tags[i + 1];
      found++;
    }
    gmshFree(type);
  }
  gmshFree(tags);
  SHB_CHECK(found == 2, SHB_ERR_INPUT, "%s: the lofted airfoil has %d sides, not 2", case_key,
            found);
  mesh_section section = mesh_airfoil_at(blade, mesh_airfoil_low_radius(blade));
  mesh_outline outline;
  mesh_airfoil_outline(blade, &section, &outline);
  const double *at = outline.pressure[MESH_AIRFOIL_POINTS / 2];
  for (int s = 0; s < 2; s++) {
    SHB_TRY(orient_parameters(blade, loft, &loft->side[s]));
    SHB_TRY(evaluate(loft, &loft->side[s], .5, 0, middle[s]));
  }
  if (hypot(middle[0][0] - at[0], middle[0][1] - at[1]) >
      hypot(middle[1][0] - at[0], middle[1][1] - at[1])) {
    mesh_loft_side first = loft->side[0];
    loft->side[0]        = loft->side[1];
    loft->side[1]        = first;
  }
  return SHB_OK;
}

shb_status mesh_loft_create(const mesh_blade *blade, const mesh_frame *frame, mesh_loft *loft) {
  int volume = 0;
  memset(loft, 0, sizeof *loft);
  loft->frame = *frame;
  SHB_TRY(mesh_airfoil_build(blade, frame, &volume));
  GMSH_TRY(case_key, gmshModelOccSynchronize(&ierr));
  return find_sides(blade, loft);
}

shb_status mesh_loft_point(const mesh_loft *loft, mesh_side side, double u, double radius,
                           double own[3]) {
  const mesh_loft_side *s         = &loft->side[side];
  const double          tolerance = 1e-13; /* m */
  double                off       = INFINITY;
  shb_root              root;
  SHB_CHECK(shb_root_start(&root, 0, s->bottom - radius, 1, s->top - radius,
                           tolerance / (s->top - s->bottom)),
            SHB_ERR_INPUT, "%s: the loft does not reach radius %g mm", case_key, 1e3 * radius);
  while (fabs(off) >= tolerance) {
    const bool   last   = shb_root_done(&root);
    const double radial = last ? root.x[0] : shb_root_next(&root);
    SHB_TRY(evaluate(loft, s, u, radial, own));
    if (last) break;
    off = own[2] - radius;
    shb_root_found(&root, radial, off);
  }
  return SHB_OK;
}
