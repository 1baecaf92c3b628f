#include "mesh/blade/hex_sweep.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/blade/disc.h"
#include "mesh/blade/disc_plan.h"
#include "mesh/blade/face_groups.h"
#include "mesh/blade/layers.h"
#include "mesh/blade/loft.h"
#include "mesh/blade/section_mesh.h"
#include "mesh/blade/section_outline.h"
#include "mesh/blade/section_smoothing.h"
#include "mesh/blade/shroud.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

enum { DISC, ROOT, AIRFOIL, SHROUD, PARTS };

/* A part of the blade: a planar mesh swept through layers. */
typedef struct {
  const mesh_planar *plan;
  mesh_layers        layers;
  int               *id; /* [2 layers + 1][plan nodes] node of the mesh, -1: none */
} part;

typedef struct {
  const mesh_blade   *blade;
  mesh_loft           loft;
  mesh_section_place *place;  /* [section nodes] */
  double             *height; /* [section nodes] radial extent of the airfoil there, m */
  mesh_planar         section, disc_plan, root_plan, shroud_plan;
  int                 first; /* part that is clamped: DISC or ROOT */
  part                parts[PARTS];
  mesh_fe             mesh; /* the mesh that is made */
} sweep;

/* ------------------------------------------------------------------ places */

/* Point of the section at a radius, interpolated between the two sides. */
static shb_status section_point(const sweep *s, int node, double radius, double own[3]) {
  const mesh_section_place *at = &s->place[node];
  double                    side[2][3];
  for (int k = 0; k < 2; k++) {
    if (at->w == (k == MESH_SUCTION ? -1 : 1)) continue;
    SHB_TRY(mesh_loft_point(&s->loft, (mesh_side)k, at->u, radius, side[k]));
  }
  for (int d = 0; d < 3; d++)
    own[d] = at->w == -1  ? side[MESH_PRESSURE][d]
             : at->w == 1 ? side[MESH_SUCTION][d]
                          : (1 - at->w) / 2 * side[MESH_PRESSURE][d] +
                                (1 + at->w) / 2 * side[MESH_SUCTION][d];
  return SHB_OK;
}

/* Height at which the airfoil meets the curved underside of the shroud, by fixed-point
 * iteration. */
static shb_status find_height(sweep *s, int node, double own[3]) {
  enum { STEPS = 50 };
  const double bottom = s->blade->section[0].radius;
  double       radius = s->blade->section[s->blade->n_sections - 1].radius;
  for (int i = 0; i < STEPS; i++) {
    SHB_TRY(section_point(s, node, radius, own));
    double next = mesh_shroud_underside(s->blade, own);
    if (fabs(next - radius) < 1e-13) break;
    radius = next;
  }
  s->height[node] = radius - bottom;
  return SHB_OK;
}

static shb_status point_at(const sweep *s, int which, int node, double share, double own[3]) {
  const mesh_blade *blade = s->blade;
  if (which == AIRFOIL)
    return section_point(s, node, blade->section[0].radius + share * s->height[node], own);
  const double *at = s->parts[which].plan->at[node];
  if (which == SHROUD) {
    mesh_shroud_roll_up(blade, at, share, own);
    return SHB_OK;
  }
  if (which == DISC) {
    double radius[4];
    mesh_disc_radii(blade, radius);
    mesh_disc_point(blade, radius[0] + share * (radius[3] - radius[0]), at, own);
    return SHB_OK;
  }
  const double top = blade->section[0].radius;
  const double low = s->first == DISC ? mesh_disc_top(blade, at[0]) : top - blade->root_height;
  own[0]           = at[0];
  own[1]           = at[1];
  own[2]           = top - (1 - share) * (top - low);
  return SHB_OK;
}

/* ------------------------------------------------------------------ plans */

static mesh_section_grid section_grid(const mesh_blade *blade) {
  double            chord = 0, thickness = 0;
  mesh_section_grid grid;
  for (int i = 0; i < blade->n_sections; i++) {
    chord     = fmax(chord, blade->section[i].chord);
    thickness = fmax(thickness, blade->section[i].thickness);
  }
  grid.half   = (int)fmax(1, round(thickness / (2 * blade->size)));
  grid.tip[0] = grid.tip[1] = fmin(.2, fmax(.1, 2 * grid.half * blade->size / chord));
  grid.chord = 2 * (int)fmax(2, round((1 - 2 * grid.tip[0]) * chord / (2 * blade->size)));
  return grid;
}

/* Number of elements on a straight side, even. */
static int parts_of(const double a[2], const double b[2], double size) {
  return 2 * (int)fmax(1, round(hypot(b[0] - a[0], b[1] - a[1]) / (2 * size)));
}

/* Elements can be slivers where the section is close to the outline. Meshes of triangles and of
 * smaller elements are then tried; the best is used. */
static shb_status plan_outline(const sweep *s, int n, const double (*corner)[2], double size,
                               const char *what, mesh_planar *plan) {
  static const struct {
    double share; /* of the element size */
    bool   recombine;
  } way[]           = {{1, true},    {1, false}, {.8, true},  {.8, false},  {.65, true},
                       {.65, false}, {.5, true}, {.5, false}, {.35, false}, {.25, false}};
  const double good = .2;
  double       best = -2;
  for (size_t t = 0; t < sizeof way / sizeof *way && best < good; t++) {
    const double here = way[t].share * size;
    mesh_planar  next = {0};
    int          parts[2 * (MESH_SHROUD_LEGS + 1)];
    for (int i = 0; i < n; i++) parts[i] = parts_of(corner[i], corner[(i + 1) % n], here);
    SHB_TRY(mesh_section_outline_create(&s->section, n, corner, parts, here, way[t].recombine, what,
                                        &next));
    const double worst = mesh_planar_least_sine(&next);
    mesh_planar_free(worst > best ? plan : &next);
    if (worst > best) *plan = next;
    best = fmax(best, worst);
  }
  return SHB_OK;
}

static shb_status make_root_plan(sweep *s) {
  const double w = s->blade->root_width / 2, l = s->blade->root_length / 2;
  const double corner[4][2] = {{-w, -l}, {w, -l}, {w, l}, {-w, l}};
  for (int i = 0; i < s->section.n_nodes; i++) {
    double own[3];
    SHB_TRY(section_point(s, i, s->blade->section[0].radius, own));
    memcpy(s->section.at[i], own, sizeof s->section.at[i]);
  }
  mesh_section_mesh_orient(&s->section);
  return plan_outline(s, 4, corner, s->blade->size, "mesh.blade.root", &s->root_plan);
}

static shb_status make_shroud_plan(sweep *s) {
  const double size = s->blade->shroud_size > 0 ? s->blade->shroud_size : s->blade->size;
  double       corner[2 * (MESH_SHROUD_LEGS + 1)][2];
  mesh_shroud_outline(s->blade, corner);
  for (int i = 0; i < s->section.n_nodes; i++) {
    double own[3];
    SHB_TRY(find_height(s, i, own));
    mesh_shroud_unroll(s->blade, own, s->section.at[i]);
  }
  return plan_outline(s, 2 * (MESH_SHROUD_LEGS + 1), (const double(*)[2])corner, size,
                      "mesh.blade.shroud", &s->shroud_plan);
}

static shb_status make_plans(sweep *s) {
  mesh_section_grid grid = section_grid(s->blade);
  mesh_section_mesh_create(&grid, &s->section, &s->place);
  s->height = shb_alloc_zeroed((size_t)s->section.n_nodes, sizeof *s->height);
  SHB_TRY(make_root_plan(s));
  if (s->first == DISC) mesh_disc_plan_create(s->blade, &s->root_plan, &s->disc_plan);
  return make_shroud_plan(s);
}

/* ------------------------------------------------------------------ nodes */

/* Layers of web, taper and rim, of about the element size each. */
static void make_disc_layers(const mesh_blade *blade, mesh_layers *layers) {
  double      radius[4];
  mesh_layers piece;
  mesh_disc_radii(blade, radius);
  layers->n = 0;
  for (int i = 0; i < 3; i++) {
    const double low = radius[i], length = radius[i + 1] - low, all = radius[3] - radius[0];
    mesh_layers_make(length, fmax(blade->size, 3 * length / MESH_MAX_LAYERS), 0, 0, &piece);
    for (int k = 0; k <= 2 * piece.n; k++)
      layers->at[2 * layers->n + k] = (low + piece.at[k] * length - radius[0]) / all;
    layers->n += piece.n;
  }
}

/* Thin layers lie on both sides of the re-entrant edges, where the airfoil meets root and shroud.
 * Thin layers at the clamp changed frequencies by less than 1e-4 for root blocks of 4 to 18 mm. The
 * shroud has two layers an element size, as it bends like a plate. */
static void prepare_parts(sweep *s) {
  const mesh_blade  *blade = s->blade;
  const double       size = blade->size, fine = blade->shroud_size > 0 ? blade->shroud_size : size;
  const double       span = blade->section[blade->n_sections - 1].radius - blade->section[0].radius;
  const mesh_planar *plan[PARTS] = {&s->disc_plan, &s->root_plan, &s->section, &s->shroud_plan};
  double             block       = blade->root_height;
  if (s->first == DISC) {
    make_disc_layers(blade, &s->parts[DISC].layers);
    block = blade->section[0].radius - mesh_disc_top(blade, 0);
  }
  mesh_layers_make(block, size, 0, 1, &s->parts[ROOT].layers);
  mesh_layers_make(span, size, 1, 1, &s->parts[AIRFOIL].layers);
  mesh_layers_make(blade->shroud_thickness, fine / 2, 1, 0, &s->parts[SHROUD].layers);
  for (int p = s->first; p < PARTS; p++) {
    size_t n         = (size_t)(2 * s->parts[p].layers.n + 1) * (size_t)plan[p]->n_nodes;
    s->parts[p].plan = plan[p];
    s->parts[p].id   = shb_alloc(n, sizeof *s->parts[p].id);
    for (size_t i = 0; i < n; i++) s->parts[p].id[i] = -1;
    s->mesh.n_elements += s->parts[p].layers.n * plan[p]->n_quads;
    s->mesh.n_nodes += (int)n; /* upper bound */
  }
}

static int *level_of(const part *p, int level) {
  return p->id + (size_t)level * (size_t)p->plan->n_nodes;
}

/* Make the nodes of one level: all nodes of the plan at the ends of a layer, its corners in the
 * middle.
 *   known  in  ids of the first n_known nodes of the plan, from the part below */
static shb_status make_level(sweep *s, int which, int level, const int *known, int n_known) {
  const part *p  = &s->parts[which];
  int        *id = level_of(p, level);
  for (int q = 0; q < p->plan->n_quads; q++)
    for (int c = 0; c < (level % 2 ? 4 : 8); c++) {
      int node = p->plan->quad[q][c];
      if (id[node] >= 0) continue;
      if (node < n_known) {
        id[node] = known[node];
        continue;
      }
      double own[3];
      SHB_TRY(point_at(s, which, node, p->layers.at[level], own));
      id[node] = s->mesh.n_nodes++;
      mesh_frame_to_mesh(&s->loft.frame, own, s->mesh.coordinates + 3 * (size_t)id[node]);
    }
  return SHB_OK;
}

static shb_status make_nodes(sweep *s, shb_progress *progress) {
  s->mesh.coordinates = shb_alloc(3 * (size_t)s->mesh.n_nodes, sizeof *s->mesh.coordinates);
  s->mesh.n_nodes     = 0;
  for (int which = s->first; which < PARTS; which++) {
    const part *below  = which > s->first ? &s->parts[which - 1] : NULL;
    const int  *known  = below ? level_of(below, 2 * below->layers.n) : NULL;
    const int   shared = which == ROOT ? s->root_plan.n_nodes : s->section.n_nodes;
    shb_progress_show(progress, 20 * (which + 1), "meshing %s",
                      (const char *[]){"the disc", "the root", "the airfoil", "the shroud"}[which]);
    for (int level = 0; level <= 2 * s->parts[which].layers.n; level++) {
      SHB_TRY(
          make_level(s, which, level, level == 0 ? known : NULL, level == 0 && known ? shared : 0));
      SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted while meshing; nothing written");
    }
  }
  return SHB_OK;
}

/* ------------------------------------------------------------------ elements and faces */

/* Nodes of a hexahedron by their level in the layer and their index in the quadrangle. */
static void hexahedron(const part *p, int layer, const int *quad, int nodes[MESH_NODES]) {
  static const int local[MESH_NODES][2] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {2, 0}, {2, 1}, {2, 2},
                                           {2, 3}, {0, 4}, {0, 7}, {1, 0}, {0, 5}, {1, 1}, {0, 6},
                                           {1, 2}, {1, 3}, {2, 4}, {2, 7}, {2, 5}, {2, 6}};
  for (int i = 0; i < MESH_NODES; i++)
    nodes[i] = level_of(p, 2 * layer + local[i][0])[quad[local[i][1]]];
}

/* Group of the face above a side of a quadrangle, or MESH_N_SETS. */
static mesh_set_id side_group(const sweep *s, int which, int middle) {
  if (which == DISC) {
    const double angle = s->disc_plan.at[middle][0], half = SHB_PI / s->blade->blades;
    return angle == half ? MESH_CYCLIC_RIGHT : angle == -half ? MESH_CYCLIC_LEFT : MESH_N_SETS;
  }
  if (which == AIRFOIL && s->place[middle].w == -1) return MESH_LOAD;
  if (which != SHROUD || middle < s->section.n_nodes) return MESH_N_SETS;
  int side = mesh_shroud_contact_side(s->blade, s->shroud_plan.at[middle]);
  return side > 0 ? MESH_CONTACT_RIGHT : side < 0 ? MESH_CONTACT_LEFT : MESH_N_SETS;
}

static void add_face(mesh_face_set *set, const int *element, int face) {
  const int *local = mesh_topology_of(MESH_HEX20)->face[face];
  int       *grow  = shb_realloc(set->nodes, 8 * ((size_t)set->n + 1), sizeof *grow);
  set->nodes       = grow;
  for (int i = 0; i < 8; i++) grow[8 * set->n + i] = element[local[i]];
  set->n++;
}

static void add_groups(sweep *s, int which, int layer, const int *quad, const int *element) {
  static const int face_of_side[4] = {1, 3, 4, 2}; /* of quadrangle sides 01, 12, 23, 30 */
  if (which == s->first && layer == 0) add_face(&s->mesh.set[MESH_ROOT], element, 0);
  for (int c = 0; c < 4; c++) {
    mesh_set_id group = side_group(s, which, quad[4 + c]);
    if (group < MESH_N_SETS) add_face(&s->mesh.set[group], element, face_of_side[c]);
  }
}

static void make_elements(sweep *s) {
  mesh_fe *mesh      = &s->mesh;
  mesh->kind         = MESH_HEX20;
  mesh->connectivity = shb_alloc((size_t)mesh->n_elements * MESH_NODES, sizeof *mesh->connectivity);
  int *element       = mesh->connectivity;
  for (int which = s->first; which < PARTS; which++) {
    const part *p = &s->parts[which];
    for (int layer = 0; layer < p->layers.n; layer++)
      for (int q = 0; q < p->plan->n_quads; q++, element += MESH_NODES) {
        hexahedron(p, layer, p->plan->quad[q], element);
        add_groups(s, which, layer, p->plan->quad[q], element);
      }
  }
}

/* ------------------------------------------------------------------ to gmsh */

/* Add n elements of a type to a discrete entity; node tags are index + 1. */
static shb_status put_elements(int entity, int type, int each, int n, const int *nodes,
                               size_t first) {
  const size_t count = (size_t)n, total = count * (size_t)each;
  size_t      *tag = shb_alloc(count + 1, sizeof *tag), *node = shb_alloc(total + 1, sizeof *node);
  int          ierr = 0;
  for (size_t i = 0; i < count; i++) tag[i] = first + i;
  for (size_t i = 0; i < total; i++) node[i] = (size_t)nodes[i] + 1;
  gmshModelMeshAddElementsByType(entity, type, tag, count, node, total, &ierr);
  free(tag);
  free(node);
  if (ierr) return mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "mesh.blade");
  return SHB_OK;
}

static shb_status put_nodes(const mesh_fe *mesh) {
  const size_t n    = (size_t)mesh->n_nodes;
  size_t      *tag  = shb_alloc(n + 1, sizeof *tag);
  int          ierr = 0;
  for (size_t i = 0; i < n; i++) tag[i] = i + 1;
  gmshModelMeshAddNodes(3, 1, tag, n, mesh->coordinates, 3 * n, NULL, 0, &ierr);
  free(tag);
  if (ierr) return mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "mesh.blade");
  return SHB_OK;
}

static shb_status put_mesh(const mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(MESH_HEX20);
  size_t               next     = 1;
  GMSH_TRY("mesh.blade", gmshModelAddDiscreteEntity(3, 1, NULL, 0, &ierr));
  SHB_TRY(put_nodes(mesh));
  for (int g = 0; g < MESH_N_SETS; g++) {
    GMSH_TRY("mesh.blade", gmshModelAddDiscreteEntity(2, g + 1, NULL, 0, &ierr));
    SHB_TRY(put_elements(g + 1, topology->gmsh_face, topology->face_nodes, mesh->set[g].n,
                         mesh->set[g].nodes, next));
    next += (size_t)mesh->set[g].n;
    SHB_TRY(mesh_face_groups_name(2, g + 1, mesh_set_name((mesh_set_id)g)));
  }
  SHB_TRY(
      put_elements(1, topology->gmsh, topology->nodes, mesh->n_elements, mesh->connectivity, next));
  return mesh_face_groups_name(3, 1, "body");
}

static shb_status make(sweep *s, shb_progress *progress) {
  SHB_TRY(make_plans(s));
  prepare_parts(s);
  SHB_TRY(make_nodes(s, progress));
  make_elements(s);
  return SHB_OK;
}

/* The loft has a gmsh model of its own, so that the current model holds the mesh alone. */
static shb_status make_in_model(sweep *s, const mesh_frame *frame, shb_progress *progress) {
  char *current = NULL;
  GMSH_TRY("mesh.blade", gmshModelGetCurrent(&current, &ierr));
  int ierr = 0;
  gmshModelAdd("loft", &ierr);
  shb_status status = mesh_loft_create(s->blade, frame, &s->loft);
  if (status == SHB_OK) status = make(s, progress);
  gmshModelRemove(&ierr);
  gmshModelSetCurrent(current, &ierr);
  gmshFree(current);
  return status;
}

shb_status mesh_hex_sweep_build(const mesh_blade *blade, const mesh_frame *frame,
                                shb_progress *progress) {
  sweep *s          = shb_alloc_zeroed(1, sizeof *s);
  s->blade          = blade;
  s->first          = mesh_disc_wanted(blade) ? DISC : ROOT;
  shb_status status = make_in_model(s, frame, progress);
  if (status == SHB_OK) status = put_mesh(&s->mesh);
  mesh_planar_free(&s->section);
  mesh_planar_free(&s->disc_plan);
  mesh_planar_free(&s->root_plan);
  mesh_planar_free(&s->shroud_plan);
  for (int p = 0; p < PARTS; p++) free(s->parts[p].id);
  free(s->place);
  free(s->height);
  mesh_fe_free(&s->mesh);
  free(s);
  return status;
}
