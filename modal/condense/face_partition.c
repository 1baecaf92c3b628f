#include "modal/condense/face_partition.h"

#include <stdlib.h>
#include <string.h>

#include "fem/element/surface.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"

#include <petscblaslapack.h> /* after petscsys.h */

shb_status modal_facets_create(const mesh_fe *mesh, const mesh_face_set *set,
                               modal_facets *facets) {
  const size_t n   = (size_t)set->n;
  facets->n        = set->n;
  facets->area     = shb_alloc_zeroed(n + 1, sizeof *facets->area);
  facets->normal   = shb_alloc_zeroed(n + 1, sizeof *facets->normal);
  facets->total    = shb_alloc_zeroed(n + 1, sizeof *facets->total);
  facets->centroid = shb_alloc_zeroed(n + 1, sizeof *facets->centroid);
  facets->patch    = shb_alloc_zeroed(n + 1, sizeof *facets->patch);
  fem_face_rule rule;
  FEM_PETSC(fem_face_rule_create(mesh->kind, &rule));
  facets->nodes = rule.nodes;
  for (int f = 0; f < set->n; f++) {
    double x[MESH_FACE_NODES][3];
    fem_face_coordinates(mesh, set, f, x);
    fem_face_integrate(&rule, (const double(*)[3])x, facets->area[f], facets->normal[f]);
    for (int i = 0; i < rule.nodes; i++) {
      facets->total[f] += facets->area[f][i];
      for (int d = 0; d < 3; d++) facets->centroid[f][d] += facets->area[f][i] * x[i][d];
    }
    for (int d = 0; d < 3; d++) facets->centroid[f][d] /= facets->total[f];
  }
  return SHB_OK;
}

typedef struct {
  double along; /* position along the direction of the cut */
  int    facet;
} site;

static int compare(const void *a, const void *b) {
  const site *p = a, *q = b;
  if (p->along != q->along) return p->along < q->along ? -1 : 1;
  return p->facet - q->facet;
}

/* Eigenvector of the largest eigenvalue of the area-weighted covariance of the centroids. */
static shb_status principal_direction(const modal_facets *facets, const site *sites, int n,
                                      double direction[3]) {
  double total = 0, mean[3] = {0}, covariance[9] = {0}, eigenvalue[3], work[32];
  for (int i = 0; i < n; i++) {
    total += facets->total[sites[i].facet];
    for (int d = 0; d < 3; d++)
      mean[d] += facets->total[sites[i].facet] * facets->centroid[sites[i].facet][d];
  }
  for (int i = 0; i < n; i++) {
    const double *c = facets->centroid[sites[i].facet];
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        covariance[3 * a + b] += facets->total[sites[i].facet] / total * (c[a] - mean[a] / total) *
                                 (c[b] - mean[b] / total);
  }
  PetscBLASInt three = 3, size = 32, info;
  LAPACKsyev_("V", "U", &three, covariance, &three, eigenvalue, work, &size, &info);
  SHB_CHECK(info == 0, SHB_ERR_IO, "the principal directions of the contact face were not found");
  memcpy(direction, covariance + 6, 3 * sizeof(double)); /* ascending: the last column */
  return SHB_OK;
}

/* Index of the first facet of the upper part. The lower part holds lower/patches of the area and at
 * least one facet for each patch. */
static int find_cut(const modal_facets *facets, const site *sites, int n, int lower, int patches) {
  double total = 0, sum = 0;
  for (int i = 0; i < n; i++) total += facets->total[sites[i].facet];
  int cut = 0;
  while (cut < n) {
    double facet = facets->total[sites[cut].facet];
    if (sum + facet / 2 > total * lower / patches) break;
    sum += facet;
    cut++;
  }
  if (cut < lower) cut = lower;
  if (cut > n - (patches - lower)) cut = n - (patches - lower);
  return cut;
}

static shb_status bisect(modal_facets *facets, site *sites, int n, int first, int patches) {
  if (patches == 1) {
    for (int i = 0; i < n; i++) facets->patch[sites[i].facet] = first;
    return SHB_OK;
  }
  double direction[3];
  SHB_TRY(principal_direction(facets, sites, n, direction));
  for (int i = 0; i < n; i++) {
    const double *c = facets->centroid[sites[i].facet];
    sites[i].along  = c[0] * direction[0] + c[1] * direction[1] + c[2] * direction[2];
  }
  qsort(sites, (size_t)n, sizeof *sites, compare);
  int lower = patches / 2, cut = find_cut(facets, sites, n, lower, patches);
  SHB_TRY(bisect(facets, sites, cut, first, lower));
  return bisect(facets, sites + cut, n - cut, first + lower, patches - lower);
}

shb_status modal_facets_partition(modal_facets *facets, int n_patches) {
  SHB_CHECK(
      n_patches <= facets->n, SHB_ERR_INPUT,
      "contact.points: %d patches asked of a contact face of %d facets; ask for fewer, refine "
      "the mesh there, or say all",
      n_patches, facets->n);
  site *sites = shb_alloc((size_t)facets->n, sizeof *sites);
  for (int f = 0; f < facets->n; f++) sites[f] = (site){0, f};
  shb_status status = bisect(facets, sites, facets->n, 0, n_patches);
  free(sites);
  return status;
}

void modal_facets_free(modal_facets *facets) {
  free(facets->area);
  free(facets->normal);
  free(facets->total);
  free(facets->centroid);
  free(facets->patch);
  memset(facets, 0, sizeof *facets);
}
