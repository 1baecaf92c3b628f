#include "mesh/blade/face_groups.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/blade/airfoil.h"
#include "mesh/blade/disc.h"
#include "mesh/blade/shroud.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

/* A face of the fused solid. */
typedef struct {
  int    tag;
  double centre[3]; /* centre of mass, blade coordinates, m */
  double low, high; /* radial extent, m */
  double width;     /* tangential extent, m */
} face;

static shb_status measure(const mesh_frame *frame, face *f) {
  double at[3], low[3], high[3], from[3], to[3];
  GMSH_TRY("mesh.blade", gmshModelOccGetCenterOfMass(2, f->tag, &at[0], &at[1], &at[2], &ierr));
  GMSH_TRY("mesh.blade", gmshModelGetBoundingBox(2, f->tag, &low[0], &low[1], &low[2], &high[0],
                                                 &high[1], &high[2], &ierr));
  mesh_frame_to_own(frame, at, f->centre);
  mesh_frame_to_own(frame, low, from);
  mesh_frame_to_own(frame, high, to);
  f->low   = from[2]; /* the stacking line is a positive mesh axis */
  f->high  = to[2];
  f->width = fabs(to[0] - from[0]);
  return SHB_OK;
}

/* All faces; the caller frees. */
static shb_status list_faces(const mesh_frame *frame, face **faces, int *n) {
  int   *tags   = NULL;
  size_t n_tags = 0;
  GMSH_TRY("mesh.blade", gmshModelGetEntities(&tags, &n_tags, 2, &ierr));
  *n                = (int)(n_tags / 2);
  *faces            = shb_alloc(n_tags + 1, sizeof **faces);
  shb_status status = SHB_OK;
  for (int i = 0; i < *n && status == SHB_OK; i++) {
    (*faces)[i].tag = tags[2 * i + 1];
    status          = measure(frame, &(*faces)[i]);
  }
  gmshFree(tags);
  return status;
}

/* The only face with its centre of mass at own. */
static shb_status find_centre(const face *faces, int n, const double own[3], const char *what,
                              int *tag) {
  int found = 0;
  for (int i = 0; i < n; i++) {
    double gap = 0;
    for (int d = 0; d < 3; d++) gap = fmax(gap, fabs(faces[i].centre[d] - own[d]));
    if (gap > 1e-6) continue;
    *tag = faces[i].tag;
    found++;
  }
  SHB_CHECK(found == 1, SHB_ERR_INPUT,
            "mesh.blade: %s was cut or lost when the blade's parts were joined (%d faces found, 1 "
            "wanted); keep the airfoil, root block and shroud clear of each other's edges",
            what, found);
  return SHB_OK;
}

static shb_status distance_to(const mesh_frame *frame, int tag, const double own[3],
                              double *distance) {
  double at[3], *closest = NULL, *parameters = NULL;
  size_t n = 0, n_parameters = 0;
  mesh_frame_to_mesh(frame, own, at);
  GMSH_TRY("mesh.blade", gmshModelGetClosestPoint(2, tag, at, 3, &closest, &n, &parameters,
                                                  &n_parameters, &ierr));
  *distance = vec3_distance(at, closest);
  gmshFree(closest);
  gmshFree(parameters);
  return SHB_OK;
}

/* Of the two faces between root and shroud, the one through the pressure side of the first section.
 * Sides of a wide shroud are excluded by their width. */
static shb_status find_pressure(const mesh_blade *blade, const mesh_frame *frame, const face *faces,
                                int n, int *tag) {
  double       bottom = blade->section[0].radius;
  double       top = blade->section[blade->n_sections - 1].radius, best = INFINITY;
  mesh_outline outline;
  mesh_airfoil_outline(blade, &blade->section[0], &outline);
  int found = 0;
  for (int i = 0; i < n; i++) {
    double edge = 0.1 * (top - bottom), gap = 0;
    if (faces[i].low > bottom + edge || faces[i].high < top - edge) continue;
    if (faces[i].width > 2 * mesh_airfoil_chord(blade)) continue;
    SHB_TRY(distance_to(frame, faces[i].tag, outline.pressure[MESH_AIRFOIL_POINTS / 2], &gap));
    if (gap < best) {
      best = gap;
      *tag = faces[i].tag;
    }
    found++;
  }
  SHB_CHECK(found == 2 && best < 0.1 * blade->section[0].thickness, SHB_ERR_INPUT,
            "mesh.blade.sections: the airfoil between root and shroud has %d faces, not 2; make "
            "neighbouring sections more alike",
            found);
  return SHB_OK;
}

shb_status mesh_face_groups_name(int dimension, int entity, const char *name) {
  int group = 0;
  GMSH_TRY("mesh.blade", group = gmshModelAddPhysicalGroup(dimension, &entity, 1, -1, &ierr));
  GMSH_TRY("mesh.blade", gmshModelSetPhysicalName(dimension, group, name, &ierr));
  return SHB_OK;
}

static shb_status make_periodic(const mesh_blade *blade, const mesh_frame *frame, const char *key,
                                size_t n, int *right, int *left) {
  double matrix[16];
  mesh_axis_matrix(frame->axis, SHB_TWO_PI / blade->blades, matrix);
  GMSH_TRY(key, gmshModelMeshSetPeriodic(2, right, n, left, n, matrix, 16, &ierr));
  return SHB_OK;
}

/* Name the sides of the disc. */
static shb_status set_disc(const mesh_blade *blade, const mesh_frame *frame, const face *faces,
                           int n) {
  int side[2];
  if (!mesh_disc_wanted(blade)) return SHB_OK;
  for (int right = 0; right < 2; right++) {
    double centre[3];
    mesh_disc_side_centre(blade, right, centre);
    SHB_TRY(find_centre(faces, n, centre, "a side of the disc", &side[right]));
  }
  SHB_TRY(mesh_face_groups_name(2, side[1], mesh_set_name(MESH_CYCLIC_RIGHT)));
  SHB_TRY(mesh_face_groups_name(2, side[0], mesh_set_name(MESH_CYCLIC_LEFT)));
  return make_periodic(blade, frame, "mesh.blade.disc", 1, &side[1], &side[0]);
}

static shb_status set_all(const mesh_blade *blade, const mesh_frame *frame, const face *faces,
                          int n) {
  int    root = 0, load = 0, side[2][MESH_SHROUD_LEGS];
  double bottom[3] = {0, 0, blade->section[0].radius - blade->root_height};
  if (mesh_disc_wanted(blade)) mesh_disc_bore_centre(blade, bottom);
  SHB_TRY(find_centre(
      faces, n, bottom,
      mesh_disc_wanted(blade) ? "the bore of the disc" : "the bottom of the root block", &root));
  SHB_TRY(find_pressure(blade, frame, faces, n, &load));
  for (int right = 0; right < 2; right++)
    for (int leg = 0; leg < MESH_SHROUD_LEGS; leg++) {
      double centre[3];
      mesh_shroud_centre(blade, leg, right, centre);
      SHB_TRY(find_centre(faces, n, centre, "a side of the shroud", &side[right][leg]));
    }
  SHB_TRY(mesh_face_groups_name(2, root, mesh_set_name(MESH_ROOT)));
  SHB_TRY(
      mesh_face_groups_name(2, side[1][MESH_SHROUD_CONTACT], mesh_set_name(MESH_CONTACT_RIGHT)));
  SHB_TRY(mesh_face_groups_name(2, side[0][MESH_SHROUD_CONTACT], mesh_set_name(MESH_CONTACT_LEFT)));
  SHB_TRY(mesh_face_groups_name(2, load, mesh_set_name(MESH_LOAD)));
  SHB_TRY(set_disc(blade, frame, faces, n));
  return make_periodic(blade, frame, "mesh.blade.shroud", MESH_SHROUD_LEGS, side[1], side[0]);
}

shb_status mesh_face_groups_set(const mesh_blade *blade, const mesh_frame *frame, int volume) {
  face      *faces  = NULL;
  int        n      = 0;
  shb_status status = list_faces(frame, &faces, &n);
  if (status == SHB_OK) status = set_all(blade, frame, faces, n);
  free(faces);
  SHB_TRY(status);
  return mesh_face_groups_name(3, volume, "body");
}
