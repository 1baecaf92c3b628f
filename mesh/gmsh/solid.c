#include "mesh/gmsh/solid.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/crash_guard.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/face_match.h"
#include "mesh/core/file_format.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/import.h"
#include "mesh/gmsh/reading.h"
#include "mesh/gmsh/size_estimate.h"

static shb_status set_options(const mesh_source *source) {
  const struct {
    const char *name;
    double      value;
  } option[] = {{"Mesh.Algorithm3D", 1},
                {"Mesh.Optimize", 1},
                {"Mesh.RandomSeed", 1}, /* same case, same mesh */
                {"Mesh.ElementOrder", 1}};
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    GMSH_TRY(source->path, gmshOptionSetNumber(option[i].name, option[i].value, &ierr));
  return SHB_OK;
}

static shb_status load(const mesh_source *source) {
  FILE *file = fopen(source->path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s", source->path, strerror(errno));
  fclose(file);
  SHB_TRY(set_options(source));
  mesh_session_log_start(source->path);
  const shb_status read   = mesh_reading_solid(source->path);
  const shb_status logged = mesh_session_log_check(source->path); /* also ends the log */
  SHB_TRY(read);
  SHB_TRY(logged);
  int   *tags = NULL;
  size_t n    = 0;
  GMSH_TRY(source->path, gmshModelGetEntities(&tags, &n, 3, &ierr));
  gmshFree(tags);
  SHB_CHECK(n > 0, SHB_ERR_INPUT, "%s: holds no solid (volume)", source->path);
  if (n == 2 || mesh_format_of(source->path) == MESH_FORMAT_GEO) return SHB_OK;
  /* solids in contact have one face each there; a common mesh needs a common face */
  GMSH_TRY(source->path, gmshModelOccRemoveAllDuplicates(&ierr));
  GMSH_TRY(source->path, gmshModelOccSynchronize(&ierr));
  return SHB_OK;
}

shb_status mesh_solid_open(const mesh_source *source, shb_progress *progress, mesh_solid *solid) {
  *solid = (mesh_solid){.source = source, .progress = progress};
  SHB_TRY(mesh_session_open(&solid->session));
  shb_progress_show(progress, 0, "loading the solid");
  shb_guard_begin(source->path, "is damaged: gmsh crashed while it was read", false);
  shb_status status = load(source);
  shb_guard_end();
  if (status != SHB_OK) mesh_session_close(&solid->session);
  return status;
}

void mesh_solid_close(mesh_solid *solid) {
  mesh_session_close(&solid->session);
}

/* Elements a turn. The tip of a cone has curvature without bound: the size has a least one. */
static shb_status refine_curved(const mesh_source *source, double size) {
  double least = 0;
  GMSH_TRY(source->path, gmshOptionGetNumber("Mesh.MeshSizeMin", &least, &ierr));
  least = fmax(least, size / MESH_FINEST);
  GMSH_TRY(source->path, gmshOptionSetNumber("Mesh.MeshSizeMin", least, &ierr));
  GMSH_TRY(source->path,
           gmshOptionSetNumber("Mesh.MeshSizeFromCurvature", source->curvature, &ierr));
  return SHB_OK;
}

/* A script may set smaller sizes of its own: ours is the maximum. */
static shb_status set_size(const mesh_source *source) {
  if (!(source->size > 0)) return SHB_OK;
  double size = source->size / source->unit;
  GMSH_TRY(source->path, gmshOptionSetNumber("Mesh.MeshSizeMax", size, &ierr));
  return source->curvature > 0 ? refine_curved(source, size) : SHB_OK;
}

static shb_status generate_dimensions(mesh_solid *solid) {
  const char *path = solid->source->path;
  mesh_extent extent;
  GMSH_TRY(path, gmshModelMeshClear(NULL, 0, &ierr));
  SHB_TRY(mesh_estimate_check_solid(solid->source, &extent));
  SHB_TRY(set_size(solid->source));
  for (int dimension = 1; dimension <= 3; dimension++) {
    shb_progress_show(solid->progress, 25 * dimension, "meshing %s",
                      (const char *[]){"curves", "faces", "the volume"}[dimension - 1]);
    GMSH_TRY(path, gmshModelMeshGenerate(dimension, &ierr));
    SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted while meshing; nothing written");
    if (dimension < 3) SHB_TRY(mesh_estimate_check_dimension(solid->source, dimension, &extent));
  }
  GMSH_TRY(path, gmshModelMeshSetOrder(2, &ierr));
  return SHB_OK;
}

/* gmsh continues where it cannot mesh a face or a solid. */
static shb_status generate(mesh_solid *solid) {
  mesh_session_log_start(solid->source->path);
  const shb_status status = generate_dimensions(solid);
  mesh_session_log_errors(solid->faults.errors, sizeof solid->faults.errors);
  SHB_TRY(status);
  return mesh_solid_check_filled(solid->source, solid->faults.errors);
}

shb_status mesh_solid_mesh(mesh_solid *solid, mesh_fe *mesh) {
  mesh_names names = mesh_rules_names(&solid->source->rules, solid->source->unit);
  solid->faults    = (mesh_solid_faults){.solid = 0};
  SHB_TRY(generate(solid));
  SHB_TRY(mesh_import(solid->source->path, &names, mesh));
  shb_status status = mesh_solid_straighten(solid->source, mesh, &solid->faults);
  if (status == SHB_OK) status = mesh_solid_compare(solid->source, mesh, &solid->faults);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

/* Faces (entities) of the solid that form a group. */
typedef struct {
  int n, *tag;
  double (*centre)[3]; /* mean of the nodes, in the file's unit */
} patch;

static void patch_free(patch *p) {
  free(p->tag);
  free(p->centre);
}

static int by_tag(const void *a, const void *b) {
  long p = *(const long *)a, q = *(const long *)b;
  return (p > q) - (p < q);
}

/* Are all nodes of face tag marked? Mean position of its nodes.
 *   marked  in   [n_nodes]
 *   centre  out  in the file's unit */
static shb_status measure_face(const mesh_solid *solid, const mesh_fe *mesh, const char *marked,
                               int tag, bool *whole, double centre[3]) {
  size_t *nodes = NULL, n = 0, n_xyz = 0, n_unused = 0;
  double *xyz = NULL, *unused = NULL;
  GMSH_TRY(solid->source->path, gmshModelMeshGetNodes(&nodes, &n, &xyz, &n_xyz, &unused, &n_unused,
                                                      2, tag, 1, 0, &ierr));
  *whole    = n > 0;
  centre[0] = centre[1] = centre[2] = 0;
  for (size_t i = 0; i < n && *whole; i++) {
    long        wanted = (long)nodes[i];
    const long *found =
        bsearch(&wanted, mesh->node_tag, (size_t)mesh->n_nodes, sizeof wanted, by_tag);
    *whole = found && marked[found - mesh->node_tag];
    for (int d = 0; d < 3; d++) centre[d] += xyz[3 * i + (size_t)d] / (double)n;
  }
  gmshFree(nodes);
  gmshFree(xyz);
  gmshFree(unused);
  return SHB_OK;
}

static shb_status find_patch(const mesh_solid *solid, const mesh_fe *mesh, int id, patch *p) {
  const mesh_face_set *set  = &mesh->set[id];
  const size_t         each = (size_t)mesh_topology_of(mesh->kind)->face_nodes;
  int                 *tags = NULL;
  size_t               n    = 0;
  GMSH_TRY(solid->source->path, gmshModelGetEntities(&tags, &n, 2, &ierr));
  char *marked      = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  p->tag            = shb_alloc(n + 1, sizeof *p->tag);
  p->centre         = shb_alloc(n + 1, sizeof *p->centre);
  shb_status status = SHB_OK;
  for (size_t i = 0; i < each * (size_t)set->n; i++) marked[set->nodes[i]] = 1;
  for (size_t i = 0; status == SHB_OK && i + 1 < n; i += 2) {
    bool whole   = false;
    p->tag[p->n] = tags[i + 1];
    status       = measure_face(solid, mesh, marked, tags[i + 1], &whole, p->centre[p->n]);
    p->n += whole;
  }
  free(marked);
  gmshFree(tags);
  return status;
}

/* Order the left faces so that each, rotated by angle, is nearest to the right face of the same
 * index. */
static void put_in_order(const patch *right, patch *left, mesh_axis axis, double angle) {
  for (int i = 0; i < right->n; i++) {
    int    best  = i;
    double least = INFINITY;
    for (int j = i; j < left->n; j++) {
      double at[3];
      mesh_axis_rotate(axis, angle, left->centre[j], at);
      const double distance = vec3_distance(at, right->centre[i]);
      if (distance < least) best = j;
      least = fmin(least, distance);
    }
    int swap        = left->tag[i];
    left->tag[i]    = left->tag[best];
    left->tag[best] = swap;
    for (int d = 0; d < 3; d++) {
      double moved          = left->centre[i][d];
      left->centre[i][d]    = left->centre[best][d];
      left->centre[best][d] = moved;
    }
  }
}

static bool matches(const mesh_fe *mesh, mesh_axis axis, int blades) {
  int pairs = 0, *right = NULL, *left = NULL;
  if (mesh_fe_match(mesh, axis, blades, &pairs, &right, &left) != SHB_OK) return false;
  free(right);
  free(left);
  return true;
}

/* One pair of faces; again as in mesh_solid_make_periodic. */
static shb_status make_periodic(mesh_solid *solid, mesh_fe *mesh, int right_set, int left_set,
                                bool *again) {
  const mesh_source *source = solid->source;
  if (!mesh->set[right_set].n || !mesh->set[left_set].n) return SHB_OK;
  SHB_TRY(mesh_fe_orient_groups(mesh, source->axis, right_set, left_set));
  mesh_fe view = mesh_fe_facing(mesh, right_set, left_set);
  if (matches(&view, source->axis, source->blades)) return SHB_OK;
  const double angle = SHB_TWO_PI / source->blades;
  patch        right = {0}, left = {0};
  bool         periodic = false;
  shb_status   status   = find_patch(solid, mesh, right_set, &right);
  if (status == SHB_OK) status = find_patch(solid, mesh, left_set, &left);
  if (status == SHB_OK && right.n > 0 && right.n == left.n) {
    double matrix[16];
    int    ierr = 0;
    put_in_order(&right, &left, source->axis, angle);
    mesh_axis_matrix(source->axis, angle, matrix);
    gmshModelMeshSetPeriodic(2, right.tag, (size_t)right.n, left.tag, (size_t)left.n, matrix, 16,
                             &ierr);
    periodic = ierr == 0;
  }
  patch_free(&right);
  patch_free(&left);
  if (!periodic)
    shb_progress_note(solid->progress, "%s and %s cannot be meshed alike",
                      mesh_fe_set_name(mesh, right_set), mesh_fe_set_name(mesh, left_set));
  *again = *again || periodic;
  return status;
}

shb_status mesh_solid_make_periodic(mesh_solid *solid, mesh_fe *mesh, bool *again) {
  const mesh_source *source = solid->source;
  *again                    = false;
  if (source->blades == 0) return SHB_OK;
  SHB_TRY(make_periodic(solid, mesh, MESH_CYCLIC_RIGHT, MESH_CYCLIC_LEFT, again));
  for (int i = 0; i < source->n_contacts; i++) {
    int right = mesh_fe_set_named(mesh, source->contact[i].right);
    int left  = mesh_fe_set_named(mesh, source->contact[i].left);
    if (right >= 0 && left >= 0) SHB_TRY(make_periodic(solid, mesh, right, left, again));
  }
  return SHB_OK;
}
