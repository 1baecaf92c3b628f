#include "mesh/gmsh/size_estimate.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

/* 550 bytes a node were measured with tetrahedra, 270 with swept hexahedra: docs/user/limits.md. */
enum { GMSH_LINE = 1, GMSH_TRIANGLE = 2, MOST = 3000000, BYTES_EACH = 700 };

double mesh_estimate_nodes(const mesh_extent *extent, double h) {
  return 2 * extent->length / h + 4.6 * extent->area / (h * h) + 6 * extent->volume / (h * h * h);
}

double mesh_estimate_size(const mesh_extent *extent, double nodes) {
  double high = extent->length + sqrt(extent->area) + cbrt(extent->volume), low = 0;
  for (int i = 0; i < 200 && high - low > 1e-3 * high; i++) {
    double middle = low > 0 ? sqrt(low * high) : high / 2;
    if (mesh_estimate_nodes(extent, middle) > nodes)
      low = middle;
    else
      high = middle;
  }
  return high;
}

double mesh_estimate_bytes(double nodes) {
  return BYTES_EACH * nodes;
}

double mesh_estimate_most_nodes(void) {
  return fmin(MOST, shb_memory_available() / BYTES_EACH);
}

/* Length, area or volume of an entity: exact from OpenCASCADE, else estimated from its box. */
static double measure(int dimension, int tag) {
  double size = -1, low[3], high[3], span[3];
  int    ierr = 0;
  gmshModelOccGetMass(dimension, tag, &size, &ierr);
  if (ierr == 0 && size >= 0) return size;
  ierr = 0;
  gmshModelGetBoundingBox(dimension, tag, &low[0], &low[1], &low[2], &high[0], &high[1], &high[2],
                          &ierr);
  if (ierr) return 0;
  for (int d = 0; d < 3; d++) span[d] = high[d] - low[d];
  double xy = span[0] * span[1], yz = span[1] * span[2], zx = span[2] * span[0];
  if (dimension == 1) return vec3_norm(span);
  /* a face fills at least about half of the largest side of its box */
  return dimension == 2 ? fmax(xy, fmax(yz, zx)) / 2 : 0;
}

static shb_status measure_all(const char *path, mesh_extent *extent) {
  double *sum[4] = {NULL, &extent->length, &extent->area, &extent->volume};
  *extent        = (mesh_extent){0};
  for (int dimension = 1; dimension <= 3; dimension++) {
    int   *tags = NULL;
    size_t n    = 0;
    GMSH_TRY(path, gmshModelGetEntities(&tags, &n, dimension, &ierr));
    for (size_t i = 0; i + 1 < n; i += 2) *sum[dimension] += measure(dimension, tags[i + 1]);
    gmshFree(tags);
  }
  return SHB_OK;
}

static shb_status check(const mesh_source *source, const mesh_extent *extent, double h) {
  double most = mesh_estimate_most_nodes(), nodes = mesh_estimate_nodes(extent, h);
  SHB_CHECK(
      nodes <= most, SHB_ERR_INPUT,
      "%s: %s %.3g m would give about %.2g nodes; with %.2g m they are %.2g, the most that %s",
      source->path,
      h * source->unit > .9 * source->size && source->size > 0 ? "mesh.size"
                                                               : "its own element size of",
      h * source->unit, nodes, 1.02 * source->unit * mesh_estimate_size(extent, most), most,
      most < MOST ? "the free memory holds" : "can be computed with");
  return SHB_OK;
}

shb_status mesh_estimate_check_solid(const mesh_source *source, mesh_extent *extent) {
  double floor = 0;
  SHB_TRY(measure_all(source->path, extent));
  if (source->size > 0) SHB_TRY(check(source, extent, source->size / source->unit));
  GMSH_TRY(source->path, gmshOptionGetNumber("Mesh.MeshSizeMin", &floor, &ierr));
  floor = fmax(floor, mesh_estimate_size(&(mesh_extent){.length = extent->length}, MOST));
  GMSH_TRY(source->path, gmshOptionSetNumber("Mesh.MeshSizeMin", floor, &ierr));
  return SHB_OK;
}

/* Corners of the lines or triangles on an entity.
 *   xyz  out  [n][dimension + 1][3]; the caller frees */
static shb_status corners(const char *path, int dimension, int tag, double **xyz, size_t *n) {
  const int type = dimension == 1 ? GMSH_LINE : GMSH_TRIANGLE;
  size_t   *tags = NULL, n_tags = 0, n_xyz = 0, n_unused = 0;
  double   *unused = NULL;
  GMSH_TRY(path, gmshModelMeshGetNodesByElementType(type, &tags, &n_tags, xyz, &n_xyz, &unused,
                                                    &n_unused, tag, 0, &ierr));
  gmshFree(tags);
  gmshFree(unused);
  *n = n_xyz / (size_t)(3 * (dimension + 1));
  return SHB_OK;
}

/* Length of a line or area of a triangle.
 *   cone  in/out  plus six times the signed volume between the triangle and the origin */
static double size_of(int dimension, const double *x, double *cone) {
  double a[3], b[3], c[3];
  vec3_minus(x + 3, x, a);
  if (dimension == 1) return vec3_norm(a);
  vec3_minus(x + 6, x, b);
  vec3_cross(a, b, c);
  *cone += vec3_dot(x, c);
  return vec3_norm(c) / 2;
}

/* Sums over the elements of an entity: sizes, sizes times element size h, cones. */
static shb_status add(const char *path, int dimension, int tag, double sum[3]) {
  double *xyz = NULL;
  size_t  n   = 0;
  SHB_TRY(corners(path, dimension, tag, &xyz, &n));
  for (size_t i = 0; i < n; i++) {
    double one = size_of(dimension, xyz + i * (size_t)(3 * (dimension + 1)), &sum[2]);
    sum[0] += one;
    sum[1] +=
        one * (dimension == 1 ? one : sqrt(2.3 * one)); /* 2.3 triangles in a square of side h */
  }
  gmshFree(xyz);
  return SHB_OK;
}

/* Volume enclosed by the meshed faces, by the divergence theorem. gmsh signs the faces of a
 * boundary by their orientation. */
static shb_status enclose(const char *path, double *volume) {
  int   *solids = NULL;
  size_t n      = 0;
  GMSH_TRY(path, gmshModelGetEntities(&solids, &n, 3, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i + 1 < n && status == SHB_OK; i += 2) {
    int   *face = NULL, ierr = 0;
    size_t n_face = 0;
    double six    = 0;
    gmshModelGetBoundary(&solids[i], 2, &face, &n_face, 0, 1, 0, &ierr);
    for (size_t f = 0; f + 1 < n_face && status == SHB_OK; f += 2) {
      double sum[3] = {0};
      status        = add(path, 2, abs(face[f + 1]), sum);
      six += face[f + 1] < 0 ? -sum[2] : sum[2];
    }
    *volume += fabs(six) / 6;
    gmshFree(face);
  }
  gmshFree(solids);
  return status;
}

shb_status mesh_estimate_check_dimension(const mesh_source *source, int dimension,
                                         mesh_extent *extent) {
  int   *tags   = NULL;
  size_t n      = 0;
  double sum[3] = {0};
  GMSH_TRY(source->path, gmshModelGetEntities(&tags, &n, dimension, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i + 1 < n && status == SHB_OK; i += 2)
    status = add(source->path, dimension, tags[i + 1], sum);
  gmshFree(tags);
  SHB_TRY(status);
  if (dimension == 2 && extent->volume == 0) SHB_TRY(enclose(source->path, &extent->volume));
  return sum[0] > 0 ? check(source, extent, sum[1] / sum[0]) : SHB_OK;
}
