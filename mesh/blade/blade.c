#include "mesh/blade/blade.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/blade/airfoil.h"
#include "mesh/blade/disc.h"
#include "mesh/blade/face_groups.h"
#include "mesh/blade/frame.h"
#include "mesh/blade/hex_sweep.h"
#include "mesh/blade/shroud.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/core/face_match.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/export.h"
#include "mesh/gmsh/import.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/size_estimate.h"

static const char *const case_key = "mesh.blade";

static shb_status check_root(const mesh_blade *blade) {
  const struct {
    const char *key;
    double      value;
  } size[] = {
      {"length", blade->root_length}, {"width", blade->root_width}, {"height", blade->root_height}};
  for (int i = 0; i < 3; i++)
    SHB_CHECK(size[i].value > 0 && isfinite(size[i].value), SHB_ERR_INPUT,
              "mesh.blade.root.%s: %g mm; it must be positive", size[i].key, 1e3 * size[i].value);
  double top = blade->section[0].radius, bottom = top - blade->root_height;
  SHB_CHECK(bottom > 0, SHB_ERR_INPUT,
            "mesh.blade.root.height: %g mm reaches the engine axis from the first section at %g mm",
            1e3 * blade->root_height, 1e3 * top);
  double pitch = 2 * bottom * tan(SHB_PI / blade->blades);
  SHB_CHECK(blade->root_width <= pitch, SHB_ERR_INPUT,
            "mesh.blade.root.width: %g mm is wider than the sector at the root's bottom, %.4g mm "
            "with rotor.blades %d",
            1e3 * blade->root_width, 1e3 * pitch, blade->blades);
  return SHB_OK;
}

/* The root block must contain the foot of the airfoil, with a margin of 2 % on each side. */
static shb_status check_foot(const mesh_blade *blade) {
  double radius[2] = {blade->section[0].radius, mesh_airfoil_low_radius(blade)}, extent[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    mesh_section section = mesh_airfoil_at(blade, radius[k]);
    mesh_outline outline;
    mesh_airfoil_outline(blade, &section, &outline);
    for (int i = 0; i < MESH_AIRFOIL_POINTS; i++)
      for (int d = 0; d < 2; d++) {
        extent[d] = fmax(extent[d], fabs(outline.suction[i][d]));
        extent[d] = fmax(extent[d], fabs(outline.pressure[i][d]));
      }
  }
  SHB_CHECK(extent[1] <= 0.49 * blade->root_length, SHB_ERR_INPUT,
            "mesh.blade.root.length: %g mm does not hold the first section; give at least %.4g mm",
            1e3 * blade->root_length, 1e3 * extent[1] / 0.49);
  SHB_CHECK(extent[0] <= 0.49 * blade->root_width, SHB_ERR_INPUT,
            "mesh.blade.root.width: %g mm does not hold the first section; give at least %.4g mm",
            1e3 * blade->root_width, 1e3 * extent[0] / 0.49);
  return SHB_OK;
}

/* 12 nodes in a cube of the element size: about 8.5 tetrahedra with 1.4 nodes each. */
static shb_status check_nodes(const char *key, double size, double volume) {
  const double most = mesh_estimate_most_nodes(), nodes = 12 * volume / pow(size, 3);
  SHB_CHECK(nodes < most, SHB_ERR_INPUT,
            "mesh.blade.%s: %g mm would give about %.2g nodes; give at least %.2g mm, which gives "
            "%.2g, the most that the free memory holds or can be computed with",
            key, 1e3 * size, nodes, 1e3 * cbrt(12 * volume / most), most);
  return SHB_OK;
}

static shb_status check_size(const mesh_blade *blade) {
  SHB_CHECK(blade->size > 0 && isfinite(blade->size), SHB_ERR_INPUT,
            "mesh.blade.size: %g mm; it must be positive", 1e3 * blade->size);
  SHB_CHECK(blade->shroud_size >= 0 && isfinite(blade->shroud_size), SHB_ERR_INPUT,
            "mesh.blade.shroud_size: %g mm; it must be positive (0: as mesh.blade.size)",
            1e3 * blade->shroud_size);
  double volume =
      blade->root_length * blade->root_width * blade->root_height + mesh_disc_volume(blade);
  for (int i = 1; i < blade->n_sections; i++) {
    const mesh_section *a = &blade->section[i - 1], *b = &blade->section[i];
    volume += 0.7 * (b->radius - a->radius) * a->chord * a->thickness;
  }
  SHB_TRY(check_nodes("size", blade->size, volume));
  double ring = blade->shroud_length * blade->shroud_thickness * SHB_TWO_PI / blade->blades *
                (blade->section[blade->n_sections - 1].radius + blade->shroud_thickness / 2);
  return blade->shroud_size > 0 ? check_nodes("shroud_size", blade->shroud_size, ring) : SHB_OK;
}

static shb_status check(const mesh_blade *blade) {
  SHB_TRY(mesh_airfoil_check(blade));
  SHB_TRY(mesh_shroud_check(blade));
  SHB_TRY(check_root(blade));
  SHB_TRY(check_foot(blade));
  SHB_TRY(mesh_disc_check(blade));
  return check_size(blade);
}

static shb_status build_root(const mesh_blade *blade, const mesh_frame *frame, int *volume) {
  double l = blade->root_length / 2, w = blade->root_width / 2, top = blade->section[0].radius;
  double own[2][3] = {{-w, -l, top - blade->root_height}, {w, l, top}}, at[2][3], low[3], span[3];
  for (int i = 0; i < 2; i++) mesh_frame_to_mesh(frame, own[i], at[i]);
  for (int d = 0; d < 3; d++) {
    low[d]  = fmin(at[0][d], at[1][d]);
    span[d] = fabs(at[1][d] - at[0][d]);
  }
  GMSH_TRY("mesh.blade.root", *volume = gmshModelOccAddBox(low[0], low[1], low[2], span[0], span[1],
                                                           span[2], -1, &ierr));
  return SHB_OK;
}

/* Fuse airfoil, root, the legs of the shroud and the disc (0: none) into one volume. */
static shb_status fuse(int airfoil, int root, const int shroud[MESH_SHROUD_LEGS], int disc,
                       int *volume) {
  enum { MOST = 2 * MESH_SHROUD_LEGS + 4 };
  int    object[2] = {3, airfoil}, tools[MOST] = {3, root};
  int   *made = NULL, **map = NULL;
  size_t n_made = 0, *n_map = NULL, nn_map = 0;
  for (int i = 0; i < MESH_SHROUD_LEGS; i++) {
    tools[2 * i + 2] = 3;
    tools[2 * i + 3] = shroud[i];
  }
  tools[MOST - 2] = 3;
  tools[MOST - 1] = disc;
  GMSH_TRY(case_key, gmshModelOccFuse(object, 2, tools, disc ? MOST : MOST - 2, &made, &n_made,
                                      &map, &n_map, &nn_map, -1, 1, 1, &ierr));
  int solids = 0;
  for (size_t i = 0; i + 1 < n_made; i += 2) {
    if (made[i] != 3) continue;
    *volume = made[i + 1];
    solids++;
  }
  gmshFree(made);
  for (size_t i = 0; i < nn_map; i++) gmshFree(map[i]);
  gmshFree(map);
  gmshFree(n_map);
  SHB_CHECK(solids == 1, SHB_ERR_INPUT,
            "mesh.blade: root, airfoil and shroud do not join into one solid (%d found)", solids);
  return SHB_OK;
}

/* Remove construction points and curves that bound nothing. */
static shb_status prune(void) {
  for (int dimension = 2; dimension >= 0; dimension--) {
    int   *tags = NULL, fault = 0;
    size_t n = 0;
    GMSH_TRY(case_key, gmshModelGetEntities(&tags, &n, dimension, &ierr));
    gmshModelRemoveEntities(tags, n, 0, &fault); /* entities that bound others stay */
    gmshFree(tags);
    if (fault) return mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, case_key);
  }
  return SHB_OK;
}

static shb_status build(const mesh_blade *blade, const mesh_frame *frame) {
  int airfoil = 0, root = 0, shroud[MESH_SHROUD_LEGS], disc = 0, volume = 0;
  SHB_TRY(mesh_airfoil_build(blade, frame, &airfoil));
  SHB_TRY(build_root(blade, frame, &root));
  SHB_TRY(mesh_shroud_build(blade, frame, shroud));
  if (mesh_disc_wanted(blade)) SHB_TRY(mesh_disc_build(blade, frame, &disc));
  SHB_TRY(fuse(airfoil, root, shroud, disc, &volume));
  GMSH_TRY(case_key, gmshModelOccSynchronize(&ierr));
  SHB_TRY(prune());
  return mesh_face_groups_set(blade, frame, volume);
}

/* Data of the size callback. */
typedef struct {
  const mesh_blade *blade;
  double            radial[3]; /* unit vector of the stacking line */
} sizing;

/* Size at the re-entrant edges (edge_size), growing by half the distance along the stacking
 * line. */
static double edge_limit(const mesh_blade *blade, double radial) {
  const double low  = fabs(radial - blade->section[0].radius);
  const double high = fabs(radial - blade->section[blade->n_sections - 1].radius);
  return blade->edge_size > 0 ? blade->edge_size + fmin(low, high) / 2 : INFINITY;
}

/* Element size: size on airfoil and root, shroud_size in the shroud, linear over 4 sizes below it.
 *
 * The distance runs along the stacking line, not the radius. A side of the shroud and its rotated
 * copy therefore differ, but gmsh copies the mesh of the periodic side. */
static double element_size(int dim, int tag, double x, double y, double z, void *data) {
  (void)dim;
  (void)tag;
  const sizing     *s      = data;
  const mesh_blade *blade  = s->blade;
  const double      radial = vec3_dot((const double[]){x, y, z}, s->radial);
  const double      edge   = edge_limit(blade, radial);
  if (!(blade->shroud_size > 0)) return fmin(edge, blade->size);
  double from  = blade->section[blade->n_sections - 1].radius - 4 * blade->size;
  double share = fmin(1, fmax(0, (radial - from) / (4 * blade->size)));
  return fmin(edge, blade->size + share * (blade->shroud_size - blade->size));
}

static shb_status set_options(void) {
  static const struct {
    const char *name;
    double      value;
  } option[] = {{"Mesh.MeshSizeExtendFromBoundary", 0},
                {"Mesh.MeshSizeFromPoints", 0},
                {"Mesh.MeshSizeFromCurvature", 0},
                {"Mesh.Algorithm", 6},   /* frontal Delaunay */
                {"Mesh.Algorithm3D", 1}, /* Delaunay */
                {"Mesh.Optimize", 1},
                {"Mesh.OptimizeNetgen", 1},
                {"Mesh.RandomSeed", 1}, /* same case, same mesh */
                {"Mesh.MshFileVersion", 4.1},
                {"Mesh.Binary", 0},
                {"Mesh.SaveAll", 0},
                /* mid-side nodes on the loft are placed 15 times faster */
                {"Geometry.OCCUseGenericClosestPoint", 1},
                /* unifying coplanar faces would merge the legs of a straight Z */
                {"Geometry.OCCUnionUnify", 0}};
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    GMSH_TRY(case_key, gmshOptionSetNumber(option[i].name, option[i].value, &ierr));
  return SHB_OK;
}

/* gmsh can fail to fill a volume without reporting an error. */
static shb_status check_filled(const mesh_blade *blade) {
  int   *types = NULL;
  size_t n     = 0;
  GMSH_TRY(case_key, gmshModelMeshGetElementTypes(&types, &n, 3, -1, &ierr));
  gmshFree(types);
  SHB_CHECK(n > 0, SHB_ERR_INPUT,
            "mesh.blade.size: gmsh cannot fill the blade with tetrahedra of %g mm: faces cross at "
            "thin or strongly curved places; give a smaller size",
            1e3 * blade->size);
  return SHB_OK;
}

static shb_status mesh_volume(const mesh_blade *blade, const mesh_frame *frame,
                              shb_progress *progress) {
  sizing s = {.blade = blade};
  mesh_axis_stacking(frame->axis, s.radial);
  GMSH_TRY(case_key, gmshModelMeshSetSizeCallback(element_size, &s, &ierr));
  for (int dimension = 1; dimension <= 3; dimension++) {
    shb_progress_show(progress, 25 * dimension, "meshing %s",
                      (const char *[]){"curves", "faces", "the volume"}[dimension - 1]);
    GMSH_TRY(case_key, gmshModelMeshGenerate(dimension, &ierr));
    SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted while meshing; nothing written");
  }
  GMSH_TRY(case_key, gmshModelMeshRemoveSizeCallback(&ierr));
  SHB_TRY(check_filled(blade));
  GMSH_TRY(case_key, gmshModelMeshSetOrder(2, &ierr));
  return SHB_OK;
}

/* Pass the moved nodes to gmsh. */
static shb_status move_nodes(const mesh_fe *mesh, const char *moved) {
  for (int i = 0; i < mesh->n_nodes; i++)
    if (moved[i])
      GMSH_TRY(case_key,
               gmshModelMeshSetNode((size_t)mesh->node_tag[i], mesh->coordinates + 3 * (size_t)i, 3,
                                    NULL, 0, &ierr));
  return SHB_OK;
}

/* Hexahedra are inverted where the loft crosses itself. The message gives the range of radii. No
 * blade is known that tetrahedra fill and hexahedra do not. */
static shb_status check_swept(const mesh_blade *blade, const mesh_fe *mesh) {
  double radial[3], low = INFINITY, high = 0;
  int    bad = 0;
  mesh_axis_stacking(blade->axis, radial);
  for (int e = 0; e < mesh->n_elements; e++) {
    if (mesh_jacobian_least(mesh, e) > 0) continue;
    bad++;
    for (int c = 0; c < 8; c++) {
      const double *x =
          mesh->coordinates + 3 * (size_t)mesh->connectivity[MESH_NODES * (size_t)e + (size_t)c];
      const double at = vec3_dot(x, radial);
      low             = fmin(low, at);
      high            = fmax(high, at);
    }
  }
  const double fine = mesh_airfoil_chord(blade) / 5;
  char         size[80];
  snprintf(size, sizeof size, ", or give a mesh.blade.size below %.2g mm", 1e3 * fine);
  SHB_CHECK(
      bad == 0, SHB_ERR_INPUT,
      "mesh.blade.sections: %d of %d hexahedra are inverted, from radius %.4g to %.4g mm: the "
      "airfoil crosses itself there; make neighbouring sections more alike%s",
      bad, mesh->n_elements, 1e3 * low, 1e3 * high, blade->size > fine ? size : "");
  return SHB_OK;
}

static shb_status check_shape(const mesh_blade *blade, const mesh_fe *mesh) {
  return mesh->kind == MESH_HEX20 ? check_swept(blade, mesh)
                                  : mesh_jacobian_check(mesh, "mesh.blade.size");
}

/* Curved edges can invert a few elements where the airfoil is thin. These edges are straightened,
 * which loses their sag. More than 1 % of such elements is an error: the mesh does not resolve the
 * blade. */
static shb_status straighten(const mesh_blade *blade, mesh_fe *mesh, shb_progress *progress) {
  int bad = mesh_jacobian_inverted(mesh);
  if (bad == 0 || bad > mesh->n_elements / 100) return check_shape(blade, mesh);
  char *moved = shb_alloc_zeroed((size_t)mesh->n_nodes, 1);
  mesh_jacobian_straighten(mesh, moved);
  shb_progress_note(progress, "%d inverted elements straightened", bad);
  shb_status status = check_shape(blade, mesh);
  if (status == SHB_OK) status = move_nodes(mesh, moved);
  free(moved);
  return status;
}

static void note_worst_corner(const mesh_fe *mesh, shb_progress *progress) {
  double       x[3];
  const double sine = mesh_jacobian_worst_corner(mesh, x);
  shb_progress_note(progress,
                    "sharpest corner of an element %.2g of a right one, at %.4g %.4g %.4g mm", sine,
                    1e3 * x[0], 1e3 * x[1], 1e3 * x[2]);
}

/* Check the mesh as it will be read: no element inverted, contact faces match. */
static shb_status verify(const mesh_blade *blade, mesh_fe *mesh, shb_progress *progress) {
  int               pairs = 0, *right = NULL, *left = NULL;
  mesh_cyclic_sides sides;
  SHB_TRY(straighten(blade, mesh, progress));
  SHB_TRY(mesh_cyclic_pair(mesh, blade->axis, blade->blades, &sides));
  SHB_TRY(mesh_fe_match(mesh, blade->axis, blade->blades, &pairs, &right, &left));
  free(right);
  free(left);
  return SHB_OK;
}

/* Build the solid and fill it with tetrahedra. */
static shb_status fill(const mesh_blade *blade, const mesh_frame *frame, shb_progress *progress) {
  shb_progress_show(progress, 0, "building the solid");
  SHB_TRY(build(blade, frame));
  shb_progress_phase(progress, "solid", "root, airfoil, shroud");
  SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted while meshing; nothing written");
  return mesh_volume(blade, frame, progress);
}

static shb_status make(const mesh_blade *blade, const char *path, const shb_provenance *provenance,
                       shb_progress *progress) {
  mesh_frame frame = mesh_frame_at(blade->axis);
  mesh_fe    mesh  = {0};
  SHB_TRY(set_options());
  SHB_TRY(blade->elements == MESH_HEX20 ? mesh_hex_sweep_build(blade, &frame, progress)
                                        : fill(blade, &frame, progress));
  SHB_TRY(mesh_import(case_key, NULL, &mesh));
  shb_status status = verify(blade, &mesh, progress);
  if (status == SHB_OK)
    shb_progress_phase(progress, "mesh", "%d nodes, %d elements, %d contact faces a side",
                       mesh.n_nodes, mesh.n_elements, mesh.set[MESH_CONTACT_RIGHT].n);
  if (status == SHB_OK) note_worst_corner(&mesh, progress);
  mesh_fe_free(&mesh);
  SHB_TRY(status);
  SHB_TRY(mesh_export(path, provenance));
  shb_progress_phase(progress, "write", "%s", path);
  return SHB_OK;
}

shb_status mesh_blade_write(const mesh_blade *blade, const char *path,
                            const shb_provenance *provenance, shb_progress *progress) {
  SHB_TRY(check(blade));
  mesh_session session;
  SHB_TRY(mesh_session_open(&session));
  shb_status status = make(blade, path, provenance, progress);
  mesh_session_close(&session);
  shb_progress_clear(progress);
  return status;
}
