/* Characteristic exponents of the blade or the ring while every contact stays stuck, open or
 * frictionless. The structure is linear; disturbances of different nodal diameter d are
 * independent, neighbours 2 pi d/N apart in phase:
 *
 *   B = right - exp(-j 2 pi d/N) left,   S = (I + diag(kv, Ku) R)^-1 diag(kv, Ku)
 *   lambda: eigenvalues of [0 I; -(w_i^2 + B^H S B), -2 zeta w_i]
 *
 * A mistuned ring has no nodal diameters: its exponents are those of all blades at once.
 *
 * They do not depend on the excitation. They are computed anew if a state or a stiffness
 * changes. */
#ifndef MHB_FLOQUET_LINEAR_EXPONENTS_H
#define MHB_FLOQUET_LINEAR_EXPONENTS_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mhb/contact/contact.h"
#include "mhb/variation/variational.h"

typedef struct {
  const mhb_modal_structure *structure;
  int                        n;      /* 2 modes blades */
  int                        known;  /* 1: the exponents are those of the states and laws below */
  int                        orbits; /* contacts with a state of their own: pairs; mistuned: all */
  int                       *state;  /* [orbit] */
  mhb_law                   *law;    /* [orbit] */
  double complex            *exponent;            /* [n] 1/s */
  double complex            *A, *left, *S, *work; /* of one nodal diameter */
  double complex            *R;                   /* [3][3 pairs] its rows of one contact */
  double                    *ring; /* mistuned, in their place: A [n][n], then [n3][n3 + n/2] and
                                      [10 n] */
  double                    *rwork;
  int                       *pivot;
  shb_arena                  arena;
} mhb_linear_exponents;

/* The structure must outlive it; a mistuned one has flexibility of all. */
void mhb_linear_exponents_create(const mhb_modal_structure *structure,
                                 mhb_linear_exponents      *exponents);
void mhb_linear_exponents_destroy(mhb_linear_exponents *exponents);

/* Exponents for states (mhb_state) and laws [orbit]; equal blades have equal contacts. Returns 0 if
 * the eigensolver failed. */
int mhb_linear_exponents_set(mhb_linear_exponents *exponents, const int *state, const mhb_law *law);

#endif
