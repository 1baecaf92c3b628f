/* Static answers of a body to many unit loads, seen at few places, on one rank and all threads:
 *
 *   V_0 = P K^-1 b,   V_1 = P K^-1 M V_0,   P removes the modes of K phi = lambda M phi.
 *
 * Another load c sees c^T V_0 and c^T V_1. The latter is the product of both V_0 with M. Subtrees
 * of the elimination tree take part by their condensed mass (condensed_mass.h). The rows above are
 * solved. Free of PETSc. */
#ifndef FEM_SUPERNODAL_UNIT_LOADS_H
#define FEM_SUPERNODAL_UNIT_LOADS_H

#include "fem/supernodal/supernodes.h"

/* A factor of K and the order of its nodes. */
typedef struct {
  const fem_supernodes *panels;
  const double         *value; /* [n_values] */
  const int            *place; /* [n / 3] index of a node in the factor */
} fem_tree;

typedef struct {
  fem_tree      tree;
  const int    *node_start, *node_column; /* mass between nodes by rows: m_rc times the identity */
  const double *node_mass;
  int           modes;
  const double *phi;    /* [modes][n] phi^T M phi = 1 */
  const double *lambda; /* [modes] */
  int           n_loads;
  const int    *start,
      *row; /* b_c: the sum of weight[e] at dof row[e], start[c] <= e < start[c + 1] */
  const double *weight;
  bool (*go_on)(void *context, double share); /* asked now and then; share: of the work, done */
  void  *context;
  double room; /* bytes that may be taken */
} fem_unit_loads;

typedef enum { FEM_LOADS_SOLVED, FEM_LOADS_STOPPED, FEM_LOADS_NO_ROOM } fem_loads_end;

/* R, R2 [n_loads][n_loads] of all loads seen by each other: c^T V_0, and c^T V_1. Both are
 * symmetric. The numbers do not depend on the number of threads. FEM_LOADS_STOPPED: by go_on. */
fem_loads_end fem_unit_loads_solve(const fem_unit_loads *u, double *R, double *R2);

#endif
