/* One step of many contacts that are coupled through the modes and residual flexibility.
 *
 * A change of state does not end the step: each contact follows its law through its own changes
 * (contact_path.h). The modes see quadratic forces. All steps therefore have one length and one set
 * of coefficients, however many changes fall into them. The motion at the stages is
 *   w_i = y_i - sum_j B W_ij B^T p_j - R p_i,
 * with W_ij the response of the modes at stage i to the force at stage j. The contacts are solved
 * one after the other until nothing changes. A sweep costs 3 pairs (12 modes + 9 pairs)
 * multiplications a side and pair. */
#ifndef MHB_INTEGRATION_JOINT_STEP_H
#define MHB_INTEGRATION_JOINT_STEP_H

#include "mhb/integration/contact_path.h"

typedef struct {
  const mhb_ring_step *ring;
  double               h;                              /* s */
  double               onward[MHB_STAGES][MHB_STAGES]; /* l_j at the stages of the next step */
  double              *response;                       /* [stage][stage by][modes] W, m/N kg */
  double              *motion; /* [blade][stage][modes] of the modes by the forces of the step */
  double              *force;  /* [stage][3 contacts] N */
  double              *R;      /* [neighbour][3 pairs][3 pairs] m/N */
  double              *seen;   /* [contact][9] w at which a contact was followed last */
  mhb_contact_spring  *spring; /* [pair] */
  mhb_contact_path    *path;   /* [contact] the result */
  long                 sweeps; /* since the start */
  shb_arena            arena;
} mhb_joint_step;

/* For modes without Coriolis terms. */
mhb_joint_step *mhb_joint_step_create(const mhb_ring_step *ring);
void            mhb_joint_step_destroy(mhb_joint_step *joint);

/* Coefficients for the length of a modal step, and the laws [pair]. */
void mhb_joint_step_set(mhb_joint_step *joint, const mhb_modal_step *modal, const mhb_law *law);

/* All contacts over a step: joint->path.
 *   point  in  [contact] at the start of the step
 *   y      in  [contact][9] motion at the stages without the forces of the step, m
 *   scale  in  N; forces are solved to 1e-11 of it
 * Returns 0 if they do not settle. */
int mhb_joint_step_solve(mhb_joint_step *joint, const mhb_contact_point *point, const double *y,
                         double scale);

#endif
