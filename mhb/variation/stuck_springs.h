/* A blade on the ground with all its contacts stuck, as one linear structure. What a contact that
 * slips or opens does differently is a change at that contact alone.
 *
 * A contact's force is p = K u - z, with K = (kv, Ku) and z the force by its slider's place. While
 * the contact sticks, z is constant. With u = L q - R p follows
 *   u = L~ q + S z,   L~ = (I + R K)^-1 L,   S = (I + R K)^-1 R,
 *   L^T p = L^T K L~ q - L~^T z.
 * Derivation: docs/theory/stability.md. */
#ifndef MHB_VARIATION_STUCK_SPRINGS_H
#define MHB_VARIATION_STUCK_SPRINGS_H

#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mhb/contact/contact.h"
#include "mhb/structure/modal_structure.h"

typedef struct {
  const mhb_modal_structure *structure;
  int                        n, modes;  /* 3 contacts; m */
  bool                       flexible;  /* R is not zero */
  mhb_law                   *law;       /* [contact] the ones below were made with; kv < 0: none */
  double                    *K;         /* [contact][3][3] N/m */
  double                    *shape;     /* [n][m] L */
  double                    *stuck;     /* [n][m] L~ */
  double                    *lost;      /* [n][m] L - L~ */
  double                    *slider;    /* [n][n] S, m/N, symmetric; NULL: R is zero */
  double                    *stiffness; /* [m][m] L^T K L~ */
  double                    *matrix;    /* [n][n] scratch */
  int                       *pivot;     /* [n] */
  shb_arena                  arena;
} mhb_stuck_springs;

/* Of a structure on the ground, which must outlive it. */
mhb_stuck_springs *mhb_stuck_springs_create(const mhb_modal_structure *structure);
void               mhb_stuck_springs_destroy(mhb_stuck_springs *springs);

/* Set all from the laws [contact]; nothing is done if their stiffnesses are those of the last call.
 * Returns 0 if singular. */
int mhb_stuck_springs_set(mhb_stuck_springs *springs, const mhb_law *law);

/* The structure has changed: the next call sets all. */
void mhb_stuck_springs_forget(mhb_stuck_springs *springs);

/* x[3] <- K of a contact times u[3]. */
void mhb_stuck_springs_force(const mhb_stuck_springs *springs, int contact, const double u[3],
                             double x[3]);

#endif
