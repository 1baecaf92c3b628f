/* The mass of a subtree of the elimination tree, condensed to the rows beyond it.
 *
 * In statics the motion of the subtree's rows follows from few coordinates q. They are the motion
 * of the rows beyond, the loads, and the parts of modes that are taken off. What its masses add to
 * x^T M x is q^T Q q. Panels are eliminated from the leaves up, as in the factorisation of K.
 * docs/theory/receptance.md, "Many contact points". Free of PETSc. */
#ifndef FEM_SUPERNODAL_CONDENSED_MASS_H
#define FEM_SUPERNODAL_CONDENSED_MASS_H

#include "fem/supernodal/lower_blocks.h"
#include "fem/supernodal/supernodes.h"

/* A body with its modes and loads, in the order of a factor of K. */
typedef struct {
  const fem_supernodes *panels;
  const double         *value;        /* [n_values] the factor */
  const int            *owner;        /* [n] panel of each row */
  const int            *below;        /* [n_panels] first panel of the subtree; -1: no range */
  const int            *place, *node; /* [n / 3] a node's place in the factor, and back */
  const int    *start, *column;       /* mass between nodes by rows: m_rc times the 3x3 identity */
  const double *mass;
  int           modes;
  const double *phi;          /* [n][modes] */
  int           n_loads;      /* b_c */
  const int    *entry, *load; /* entries e of row r: entry[r] <= e < entry[r + 1] */
  const double *weight;       /* b_c at row r is the sum of weight[e] with load[e] = c */
  bool (*go_on)(void *context, double share); /* asked at each step; share: of the rows, done */
  void *context;
} fem_loaded_body;

/* Coordinates q: motion of the rows beyond, loads, modes. */
typedef struct {
  int       beyond, loads, size; /* size: beyond + loads + modes */
  int      *row;                 /* [beyond] in the factor, ascending */
  int      *load;                /* [loads] ascending */
  fem_lower Q;                   /* of order size */
  double   *U;                   /* [beyond][loads] the loads, moved to the rows beyond */
  double   *F;                   /* [loads][loads] b^T K^-1 b with the rows beyond at rest */
} fem_condensed;

/* Coordinates of the subtree whose last panel is root, and room for its matrices.
 *   stack  out  numbers that fem_condense needs as scratch */
fem_condensed *fem_condensed_create(const fem_loaded_body *body, int root, size_t *stack);

/* Fill the matrices. Returns false when the body's go_on says so.
 *   stack  scratch */
bool fem_condense(const fem_loaded_body *body, int root, double *stack, fem_condensed *to);

void fem_condensed_free(fem_condensed *c); /* NULL: nothing */

#endif
