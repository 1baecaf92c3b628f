#include "fem/body/partition.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* The arrays are those that mesh_fe_free frees. */
static PetscErrorCode share(MPI_Comm comm, int rank, void **data, size_t count, MPI_Datatype type) {
  int size;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_size(type, &size));
  if (rank != 0) *data = shb_alloc(count, (size_t)size);
  PetscCallMPI(MPI_Bcast(*data, (int)count, type, 0, comm));
  PetscFunctionReturn(0);
}

/* The paired sides of a sector. */
static PetscErrorCode share_sides(MPI_Comm comm, int rank, mesh_fe *mesh) {
  PetscFunctionBeginUser;
  PetscCall(share(comm, rank, (void **)&mesh->image, (size_t)mesh->n_nodes, MPI_INT));
  PetscCallMPI(MPI_Bcast(mesh->turn, 9, MPI_DOUBLE, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_mesh_broadcast(MPI_Comm comm, mesh_fe *mesh) {
  enum { HEAD = 6 };
  int rank, n[HEAD + MESH_MAX_SETS];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    n[0] = mesh->n_nodes;
    n[1] = mesh->n_elements;
    n[2] = (int)mesh->kind;
    n[3] = mesh->n_more;
    n[4] = mesh->n_regions;
    n[5] = mesh->image != NULL;
    for (int s = 0; s < MESH_MAX_SETS; s++) n[HEAD + s] = mesh->set[s].n;
  } else {
    memset(mesh, 0, sizeof *mesh);
  }
  PetscCallMPI(MPI_Bcast(n, HEAD + MESH_MAX_SETS, MPI_INT, 0, comm));
  mesh->n_nodes    = n[0];
  mesh->n_elements = n[1];
  mesh->kind       = (mesh_kind)n[2];
  mesh->n_more     = n[3];
  mesh->n_regions  = n[4];
  PetscCallMPI(MPI_Bcast(mesh->more, (int)sizeof mesh->more, MPI_CHAR, 0, comm));
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         nodes = (size_t)n[0], elements = (size_t)n[1];
  const size_t         each = (size_t)topology->nodes, face = (size_t)topology->face_nodes;
  PetscCall(share(comm, rank, (void **)&mesh->coordinates, 3 * nodes, MPI_DOUBLE));
  PetscCall(share(comm, rank, (void **)&mesh->connectivity, each * elements, MPI_INT));
  PetscCall(share(comm, rank, (void **)&mesh->node_tag, nodes, MPI_LONG));
  PetscCall(share(comm, rank, (void **)&mesh->element_tag, elements, MPI_LONG));
  for (int s = 0; s < MESH_MAX_SETS; s++) {
    mesh->set[s].n = n[HEAD + s];
    if (n[HEAD + s] == 0) continue;
    PetscCall(share(comm, rank, (void **)&mesh->set[s].nodes, face * (size_t)n[HEAD + s], MPI_INT));
  }
  if (n[5]) PetscCall(share_sides(comm, rank, mesh));
  if (n[4] == 0) PetscFunctionReturn(0);
  PetscCall(share(comm, rank, (void **)&mesh->region_name, MESH_WORD * (size_t)n[4], MPI_CHAR));
  PetscCall(share(comm, rank, (void **)&mesh->region, elements, MPI_INT));
  PetscFunctionReturn(0);
}

typedef struct {
  double x[3];
  int    node;
} free_node;

/* Node numbers break ties, so every rank sorts alike. */
static int compare(const void *a, const void *b, int d) {
  const free_node *p = a, *q = b;
  if (p->x[d] != q->x[d]) return p->x[d] < q->x[d] ? -1 : 1;
  return p->node - q->node;
}

static int compare_x(const void *a, const void *b) {
  return compare(a, b, 0);
}

static int compare_y(const void *a, const void *b) {
  return compare(a, b, 1);
}

static int compare_z(const void *a, const void *b) {
  return compare(a, b, 2);
}

static int longest_side(const free_node *nodes_free, int n) {
  double side[3];
  int    longest = 0;
  for (int d = 0; d < 3; d++) {
    double low = nodes_free[0].x[d], high = low;
    for (int i = 1; i < n; i++) {
      if (nodes_free[i].x[d] < low) low = nodes_free[i].x[d];
      if (nodes_free[i].x[d] > high) high = nodes_free[i].x[d];
    }
    side[d] = high - low;
    if (side[d] > side[longest]) longest = d;
  }
  return longest;
}

static void bisect(free_node *nodes_free, int n, int first_rank, int n_ranks, int *rank) {
  if (n_ranks == 1 || n == 0) {
    for (int i = 0; i < n; i++) rank[nodes_free[i].node] = first_rank;
    return;
  }
  int (*const order[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
  qsort(nodes_free, (size_t)n, sizeof *nodes_free, order[longest_side(nodes_free, n)]);
  int lower = n_ranks / 2, cut = (int)((long)n * lower / n_ranks);
  bisect(nodes_free, cut, first_rank, lower, rank);
  bisect(nodes_free + cut, n - cut, first_rank + lower, n_ranks - lower, rank);
}

PetscErrorCode fem_partition(const mesh_fe *mesh, const bool *is_free, int n_ranks, int *rank) {
  free_node *nodes_free;
  int        n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &nodes_free));
  for (int i = 0; i < mesh->n_nodes; i++) {
    rank[i] = -1;
    if (!is_free[i]) continue;
    memcpy(nodes_free[n].x, mesh->coordinates + 3 * (size_t)i, sizeof nodes_free[n].x);
    nodes_free[n++].node = i;
  }
  bisect(nodes_free, n, 0, n_ranks, rank);
  PetscCall(PetscFree(nodes_free));
  PetscFunctionReturn(0);
}
