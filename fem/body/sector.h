/* Matrices of a sector at any nodal diameter.
 *
 * With theta = 2 pi n/N the nodes of cyclic_right move as e^(-j theta) T times their partners. The
 * motion of all nodes of the sector is C x, x that of the block rows, C = C_i + e^(-j theta) C_r.
 * Of the matrices K and M of the sector with free sides
 *
 *   K(theta) = C^H K C = K(0) + (cos theta - 1) (B + B^T) + j sin theta (B^T - B),
 *   B = C_i^T K C_r, which only elements at cyclic_right have; M(theta) = C^H M C.
 *
 * On one rank. Plain arrays: any number of threads may use one sector at a time. Derivation:
 * docs/theory/cyclic_sector.md. */
#ifndef FEM_BODY_SECTOR_H
#define FEM_BODY_SECTOR_H

#include <complex.h>

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "fem/solver/hermitian.h"

typedef struct {
  int        n_nodes, n_rows;      /* of the mesh; block rows */
  int       *row;                  /* [n_nodes] block row, -1 where clamped */
  bool      *turned;               /* [n_nodes] */
  double     turn[3][3];           /* T */
  fem_blocks blocks;               /* upper triangle of K, owned */
  double    *stiffness;            /* [block][9] K(0), each block by columns */
  int        n_coupled;            /* blocks that depend on theta */
  int       *coupled;              /* [n_coupled] */
  double (*cosine)[9], (*sine)[9]; /* [n_coupled] of B + B^T and of B^T - B */
  signed char *exponent; /* [n_coupled] fem_hermitian_matrix.exponent: 1 of B^T, -1 of B alone */
  int    *mass_start, *mass_node; /* [n_nodes + 1]; nodes that share an element with each node */
  double *mass;                   /* kg, one number a pair of nodes */
} fem_sector;

/* Create it from the system at nodal diameter 0.
 *   body    in  whose mesh has cyclic sides
 *   state   in  [n_nodes][3] m, displacements at which system->K is the tangent; NULL: at rest
 *   system  in  fem_system_create of the mesh on one rank, K at that state
 * Errors: PETSC_ERR_MEM. */
PetscErrorCode fem_sector_create(const fem_body *body, const double *state,
                                 const fem_system *system, fem_sector *sector);

/* e^(-j theta) of nodal diameter n of N blades; n may be negative. Real without rounding at 0 and
 * N/2. */
double complex fem_sector_phase(int n, int blades);

/* Order and analyse K(theta) of all theta; the sector must outlive the order. */
shb_status fem_sector_analyse(const fem_sector *sector, fem_hermitian_order **order);

/* The coupled blocks of K(theta), [n_coupled][9]; phase = e^(-j theta) here and below. */
void fem_sector_coupled(const fem_sector *sector, double complex phase, double complex (*value)[9]);

/* C x: motion of all nodes, [n_nodes][3], zero where clamped. */
void fem_sector_expand(const fem_sector *sector, double complex phase, const double complex *x,
                       double complex *nodal);

/* Motion of one node from x, and the share C^H f of a force f at a node in its block row. */
void fem_sector_motion(const fem_sector *sector, int node, double complex phase,
                       const double complex *x, double complex v[3]);
void fem_sector_force(const fem_sector *sector, int node, double complex phase, const double f[3],
                      double complex v[3]);

/* Numbers in the scratch of a product with that many columns. */
size_t fem_sector_scratch(const fem_sector *sector, int columns);

/* Y = M(theta) X.
 *   X, Y     in/out   [columns][3 n_rows], different
 *   scratch  scratch  [fem_sector_scratch] */
void fem_sector_mass(const fem_sector *sector, double complex phase, int columns,
                     const double complex *X, double complex *Y, double *scratch);

/* Diagonal of M(theta) without the coupling of the sides, [n_rows] kg. */
void fem_sector_mass_diagonal(const fem_sector *sector, double *diagonal);

void fem_sector_free(fem_sector *sector); /* also on a zeroed struct */

#endif
