/* Number of contact points of a case with contact.points: auto. */
#ifndef CASES_COMMANDS_CONTACT_POINTS_H
#define CASES_COMMANDS_CONTACT_POINTS_H

#include "mhb/problem/other_pairs.h"

/* A model of the contact faces with fewer pairs, and by which other model its error is estimated.
 */
typedef struct {
  modal_model           other; /* owned; the finer or the coarser one; of a disc that of 0 */
  modal_nodal_diameters disc;  /* of a disc the owner of other; n = 0: none */
  modal_joining         joining;
  mhb_other_pairs       pairs; /* of the two above */
  double estimate; /* spatial error of the sampled points by which it was chosen; or NAN */
} contact_points;

/* Join the pairs of a model to patches. The model becomes the joined one, points hold its own pairs
 * as the finer model. With as many patches as pairs nothing changes and *points is NULL.
 *
 *   disc  in-out  NULL, or all models of a disc; it owns the model, which is its first
 *
 * Errors: as modal_joining_create. */
shb_status contact_points_join(modal_model *model, modal_nodal_diameters *disc, int patches,
                               contact_points **points);

/* Join them to the fewest patches, 1, 2, 4, ... or all pairs, for which the estimated spatial error
 * keeps the tolerance at nine of ten points of curves in outline. The points are those that slip or
 * open, evenly along the curves of every preload. No face is turned by more than MODAL_FLAT against
 * its patch.
 *
 * Errors: as contact_points_join, mhb_forced_response. */
shb_status contact_points_choose(modal_model *model, modal_nodal_diameters *disc,
                                 const mhb_settings *settings, double tolerance,
                                 contact_points **points);

/* Half as many pairs as the other, coarser model. NULL for one pair a face, or without
 * positions. */
shb_status contact_points_halve(const modal_model *model, const modal_nodal_diameters *disc,
                                contact_points **points);

void contact_points_free(contact_points *points); /* also NULL */

#endif
