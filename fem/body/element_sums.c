#include "fem/body/element_sums.h"

#include <omp.h>
#include <stdlib.h>

#include "mesh/base/memory.h"
#include "mesh/core/element_topology.h"

/* CHUNK: elements that are computed, then added. BAND: block rows in a row that a thread owns. */
enum { CHUNK = 256, BAND = 32 };

/* What all threads share. */
typedef struct {
  const fem_elements *elements;
  const fem_sums     *sums;
  int                 threads;
  size_t              K_size, M_size; /* numbers of an element */
  double             *K, *M;          /* [CHUNK] of them */
} work;

/* Index of a column that row r has. */
static size_t find(const fem_row_values *to, PetscInt r, PetscInt column) {
  PetscInt low = to->start[r], high = to->start[r + 1] - 1;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (to->column[middle] < column)
      low = middle + 1;
    else
      high = middle;
  }
  return (size_t)low;
}

/* Add the block of local nodes a and b. */
static void add_block(int n, int a, int b, const double *K, double *value) {
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) value[d + 3 * e] += K[(3 * a + d) * 3 * n + 3 * b + e];
}

/* Add the blocks of local node a, in block row r. */
static void add_row(const work *w, int slot, int a, PetscInt r, const PetscInt *row) {
  const int     n = w->elements->nodes;
  const double *K = w->K + w->K_size * (size_t)slot, *M = w->M + w->M_size * (size_t)slot;
  for (int b = 0; b < n; b++) {
    const PetscInt column = row[b];
    if (column < 0) continue;
    if (column >= r) {
      const size_t at = find(&w->sums->stiffness, r, column);
      add_block(n, a, b, K, w->sums->stiffness.value + 9 * at);
      if (w->sums->blocks) add_block(n, a, b, M, w->sums->mass.value + 9 * at);
    }
    if (!w->sums->blocks) w->sums->mass.value[find(&w->sums->mass, r, column)] += M[n * a + b];
  }
}

/* Add the chunk to the rows of a thread. */
static void add_chunk(const work *w, int first, int count, int thread) {
  const int n = w->elements->nodes;
  for (int slot = 0; slot < count; slot++) {
    const int *node = w->elements->connectivity + (size_t)n * (size_t)(first + slot);
    PetscInt   row[MESH_NODES];
    for (int i = 0; i < n; i++) row[i] = w->elements->row[node[i]];
    for (int a = 0; a < n; a++)
      if (row[a] >= 0 && row[a] / BAND % w->threads == thread) add_row(w, slot, a, row[a], row);
  }
}

static void add_all(work *w) {
  const fem_elements *all = w->elements;
#pragma omp parallel num_threads(w->threads)
  {
#pragma omp single
    w->threads = omp_get_num_threads();
    for (int first = 0; first < all->n; first += CHUNK) {
      const int count = all->n - first < CHUNK ? all->n - first : CHUNK;
#pragma omp for schedule(static)
      for (int slot = 0; slot < count; slot++)
        all->compute(all->context, first + slot, w->K + w->K_size * (size_t)slot,
                     w->M + w->M_size * (size_t)slot);
      add_chunk(w, first, count, omp_get_thread_num());
#pragma omp barrier
    }
  }
}

void fem_element_sums_add(const fem_elements *elements, int threads, const fem_sums *sums) {
  const size_t pairs = (size_t)elements->nodes * (size_t)elements->nodes;
  work         w     = {.elements = elements,
                        .sums     = sums,
                        .threads  = threads,
                        .K_size   = 9 * pairs,
                        .M_size   = (sums->blocks ? 9 : 1) * pairs};
  w.K                = shb_alloc(w.K_size * CHUNK, sizeof *w.K);
  w.M                = shb_alloc(w.M_size * CHUNK, sizeof *w.M);
  add_all(&w);
  free(w.K);
  free(w.M);
}
