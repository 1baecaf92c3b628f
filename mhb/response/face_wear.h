/* What friction does at each contact pair: pressure, slip, dissipation, at the peaks of a curve. */
#ifndef MHB_RESPONSE_FACE_WEAR_H
#define MHB_RESPONSE_FACE_WEAR_H

#include "mhb/contact/time_history.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response_types.h"
#include "modal/model/model.h"

/* Way that a pair slips in a period, m, and the work of friction along it, J.
 *   contact  in  an evaluator of m harmonics
 *   motion   in  [3][2m+1] as in mhb_contact_force
 *   samples  in  at least, 2 or more; transitions are added to them
 * While the pair slips, the slider goes by ds - Ku^-1 df. Chords between samples: the error falls
 * with their square. */
void mhb_slip_way(mhb_contact_evaluator *contact, const mhb_law *law, const double *motion, int m,
                  int samples, double *way, double *work);

/* wear of every nonlinear branch <- its peaks, where the model has areas and one interface.
 * Not in a run-up, nor for rings of different blades. SHB_ERR_IO: no memory for a contact
 * evaluator. */
shb_status mhb_face_wear_keep(const modal_model *model, const mhb_settings *settings,
                              mhb_response *response);
void       mhb_face_wear_free(mhb_face_wear *wear);

/* Write /contact_face, and /branch_i/face for a branch with wear. */
shb_status mhb_contact_face_write(hid_t file, const modal_contact_face *face);
shb_status mhb_face_wear_write(hid_t group, const modal_contact_face *face, int n_pairs,
                               const mhb_face_wear *wear);

#endif
