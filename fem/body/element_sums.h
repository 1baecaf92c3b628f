/* Sums of element matrices on one rank, on all threads.
 *
 * A chunk of elements is computed by all threads. Then each thread adds the chunk's blocks to the
 * rows it owns, in the order of the elements. So the numbers do not depend on the number of
 * threads. No call of PETSc: other threads may call it meanwhile. */
#ifndef FEM_BODY_ELEMENT_SUMS_H
#define FEM_BODY_ELEMENT_SUMS_H

#include <petscsystypes.h>
#include <stdbool.h>

/* Values of a matrix with a known pattern, by block rows; columns ascend in a row. */
typedef struct {
  const PetscInt *start, *column;
  double         *value; /* [block][9], each by columns; of a mass between nodes [entry] */
} fem_row_values;

typedef struct {
  fem_row_values stiffness; /* upper triangle */
  fem_row_values mass;      /* all entries, one number each; in blocks as the stiffness */
  bool           blocks;    /* of the mass */
} fem_sums;

/* The elements, and how one is computed. */
typedef struct {
  int             n, nodes;     /* number of elements, nodes of each */
  const int      *connectivity; /* [n][nodes] */
  const PetscInt *row;          /* [node of the mesh] block row, -1: left out */
  /* K [3 nodes][3 nodes] of an element, and M likewise or [nodes][nodes]. */
  void (*compute)(const void *context, int element, double *K, double *M);
  const void *context;
} fem_elements;

/* Add K and M of all elements.
 *   threads  in  number of threads, 1 or more */
void fem_element_sums_add(const fem_elements *elements, int threads, const fem_sums *sums);

#endif
