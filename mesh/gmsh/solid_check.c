#include "mesh/gmsh/solid_check.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

/* What is told. Elements of second order on a smooth face are off by some 1e-3 of their size, and
 * an edge across a nose by a tenth. An airfoil whose volume was 6 % low had frequencies that were
 * 1.3 % off. */
static const double off_surface = 0.1, off_volume = 1e-2;

/* "solid 2 of 3, about (x, y, z) m": the middle of its box. */
static void describe(const mesh_source *source, size_t solid, size_t n, int tag, char text[120]) {
  double low[3] = {0}, high[3] = {0}, middle[3];
  int    ierr = 0;
  gmshModelGetBoundingBox(3, tag, &low[0], &low[1], &low[2], &high[0], &high[1], &high[2], &ierr);
  for (int d = 0; d < 3; d++) middle[d] = source->unit * (low[d] + high[d]) / 2;
  snprintf(text, 120, "solid %zu of %zu, about (%.4g, %.4g, %.4g) m,", solid + 1, n, middle[0],
           middle[1], middle[2]);
}

static shb_status check_solid(const mesh_source *source, const char *errors, size_t solid, size_t n,
                              int tag) {
  int   *types   = NULL;
  size_t n_types = 0;
  char   which[120];
  GMSH_TRY(source->path, gmshModelMeshGetElementTypes(&types, &n_types, 3, tag, &ierr));
  gmshFree(types);
  if (n_types > 0) return SHB_OK;
  describe(source, solid, n, tag, which);
  SHB_FAIL(SHB_ERR_INPUT,
           "%s: %s got no elements: gmsh: %s; mesh it finer (mesh.size, mesh.curvature), or mend "
           "the solid there",
           source->path, which, *errors ? errors : "no reason given");
}

shb_status mesh_solid_check_filled(const mesh_source *source, const char *errors) {
  int   *solids = NULL;
  size_t n      = 0;
  GMSH_TRY(source->path, gmshModelGetEntities(&solids, &n, 3, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i < n / 2 && status == SHB_OK; i++)
    status = check_solid(source, errors, i, n / 2, solids[2 * i + 1]);
  gmshFree(solids);
  return status;
}

/* ------------------------------------------------------------------ straightened elements */

static void note_moves(const mesh_source *source, const mesh_fe *mesh, const double *before,
                       mesh_solid_faults *faults) {
  for (size_t i = 0; i < (size_t)mesh->n_nodes; i++) {
    const double *x    = mesh->coordinates + 3 * i;
    const double  move = source->unit * vec3_distance(x, before + 3 * i);
    faults->moved += move > 0;
    if (!(move > faults->farthest)) continue;
    faults->farthest = move;
    for (int d = 0; d < 3; d++) faults->at[d] = source->unit * x[d];
  }
}

shb_status mesh_solid_straighten(const mesh_source *source, mesh_fe *mesh,
                                 mesh_solid_faults *faults) {
  const int    bad  = mesh_jacobian_inverted(mesh);
  const size_t size = 3 * (size_t)mesh->n_nodes * sizeof(double);
  if (bad == 0 || bad > mesh->n_elements / 100) return mesh_jacobian_check(mesh, source->path);
  char   *moved  = shb_alloc_zeroed((size_t)mesh->n_nodes, 1);
  double *before = shb_alloc(size, 1);
  memcpy(before, mesh->coordinates, size);
  mesh_jacobian_straighten(mesh, moved);
  faults->straightened = bad;
  note_moves(source, mesh, before, faults);
  free(moved);
  free(before);
  return mesh_jacobian_check(mesh, source->path);
}

static double off(const mesh_surface_gap *gap) {
  return gap->volume > 0 && isfinite(gap->missing) ? fabs(gap->missing) / gap->volume : 0;
}

/* Above 1: told as a warning. Without a size of the case the distance has no measure. */
static double severity(const mesh_source *source, const mesh_surface_gap *gap) {
  const double far = source->size > 0 ? gap->farthest / (off_surface * source->size) : 0;
  return fmax(far, off(gap) / off_volume);
}

shb_status mesh_solid_compare(const mesh_source *source, const mesh_fe *mesh,
                              mesh_solid_faults *faults) {
  int   *tags = NULL;
  size_t n    = 0;
  GMSH_TRY(source->path, gmshModelGetEntities(&tags, &n, 3, &ierr));
  faults->n_solids  = (int)(n / 2);
  shb_status status = SHB_OK;
  for (int i = 0; i < faults->n_solids && status == SHB_OK; i++) {
    mesh_surface_gap gap;
    status = mesh_surface_gap_of(source, mesh, tags[2 * i + 1], &gap);
    if (status != SHB_OK) continue;
    if (i > 0 && severity(source, &gap) <= severity(source, &faults->gap)) continue;
    faults->gap   = gap;
    faults->solid = i + 1;
  }
  gmshFree(tags);
  return status;
}

/* ------------------------------------------------------------------ telling */

/* "0.8 % (within 0.02 %) less than the solid", or that no difference is seen. */
static void compare_volume(const mesh_surface_gap *gap, char text[80]) {
  const double error = gap->volume > 0 ? gap->error / gap->volume : 0;
  if (!isfinite(gap->missing))
    snprintf(text, 80, "not compared with the solid, whose faces have no parameters");
  else if (off(gap) > error)
    snprintf(text, 80, "%.2g %% (within %.1g %%) %s than the solid", 100 * off(gap), 100 * error,
             gap->missing > 0 ? "less" : "more");
  else
    snprintf(text, 80, "as the solid within %.1g %%", 100 * (error + off(gap)));
}

static void tell_surface(const mesh_source *source, const mesh_solid_faults *f,
                         shb_progress *progress) {
  const mesh_surface_gap *gap = &f->gap;
  char                    text[80];
  compare_volume(gap, text);
  if (severity(source, gap) > 1)
    shb_progress_warn(progress,
                      "%s: the surface of the mesh is up to %.2g mm off that of solid %d of %d, at "
                      "(%.4g, %.4g, %.4g) m; it holds %.4g m3, %s; mesh.curvature or a smaller "
                      "mesh.size follows it more closely",
                      source->path, 1e3 * gap->farthest, f->solid, f->n_solids, gap->at[0],
                      gap->at[1], gap->at[2], gap->volume, text);
  else
    shb_progress_note(progress, "the surface is at most %.2g mm off that of the solid; %.4g m3, %s",
                      1e3 * gap->farthest, gap->volume, text);
}

void mesh_solid_tell(const mesh_source *source, const mesh_solid_faults *f,
                     shb_progress *progress) {
  if (*f->errors) shb_progress_warn(progress, "%s: gmsh: %s", source->path, f->errors);
  if (f->straightened > 0)
    shb_progress_warn(progress,
                      "%s: %d inverted elements got straight edges: %d of their nodes moved, the "
                      "farthest by %.2g mm at (%.4g, %.4g, %.4g) m; mesh.curvature or a smaller "
                      "mesh.size follows the solid more closely there",
                      source->path, f->straightened, f->moved, 1e3 * f->farthest, f->at[0],
                      f->at[1], f->at[2]);
  tell_surface(source, f, progress);
}
