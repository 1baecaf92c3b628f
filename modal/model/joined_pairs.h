/* A modal model with fewer contact pairs: pairs joined to patches.
 *
 * A patch moves as the mean of its pairs by area, and its force is shared among them by area. In
 * the shroud axes T0 of a pair (columns v, u, w):
 *   motion of a patch = sum over its pairs i of weight_i (motion of i),   force on i = weight_i f.
 * The model holds cylindrical axes, so the motion of pair i enters a patch by weight_i turn_i.
 * Here turn_i = T0_patch T0_i^T. The joined model is the Galerkin projection of the first one. It
 * equals it for every force that is spread by area. */
#ifndef MODAL_MODEL_JOINED_PAIRS_H
#define MODAL_MODEL_JOINED_PAIRS_H

#include "modal/model/nodal_diameters.h"

/* Most that a face may be turned against its patch, degrees. The contact law has one normal a
 * patch, and a part sin^2 of the normal stiffness acts along the face then: 0.8 %. */
enum { MODAL_FLAT = 5 };

typedef struct {
  int     n_pairs, n_patches;
  int    *patch;  /* [pair] */
  double *weight; /* [pair] share of its patch's area */
  double *turn;   /* [pair][3][3] */
  double  spread; /* degrees, largest angle between the normals of a pair and of its patch */
} modal_joining;

/* Columns v, u, w of eq. 2 in (tangential, axial, radial), for the angles of a face. */
void modal_shroud_axes(double psi, double phi, double T0[3][3]);

/* The same for the face's normal; its angles. */
void modal_normal_angles(const double normal[3], double *psi, double *phi);

/* Number of patches that the model's pairs can be joined to. It is n_pairs, or 0 without the
 * positions of the pairs. */
int modal_joinable(const modal_model *model);

/* Join the pairs of every interface to patches of nearly equal area, by recursive bisection across
 * the longest extent. With powers of 2, n and 2 n patches are nested.
 *
 *   patches  in  1 to n_pairs, of all interfaces together; each has one at least
 *
 * Errors: SHB_ERR_INPUT a model without positions, or too few or too many patches. */
shb_status modal_joining_create(const modal_model *model, int patches, modal_joining *joining);
void       modal_joining_free(modal_joining *joining); /* also on a zeroed struct */

/* The joined model, to be freed. The tails become bounds: of the mean of several motions by the
 * mean of their roots. */
void modal_join(const modal_model *model, const modal_joining *joining, modal_model *joined);

/* The same at every nodal diameter, of a joining of the first model. */
void modal_join_diameters(const modal_nodal_diameters *diameters, const modal_joining *joining,
                          modal_nodal_diameters *joined);

/* out[n_contact of the model] <- forces on its pairs by forces on the patches, [n_contact of the
 * joined model], both with this stride. */
void modal_joining_spread(const modal_joining *joining, int sides, const double complex *force,
                          double complex *out);

#endif
