/* The contact law of a pair at a recorded point. */
#ifndef MHB_RESPONSE_PAIR_LAW_H
#define MHB_RESPONSE_PAIR_LAW_H

#include "mhb/contact/law.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response_types.h"

/* Shares of the pairs (mhb/problem/interfaces.h), those of a ring included.
 *   area   in   [n_pairs] m2, or NULL
 *   share  out  [n_pairs] */
void mhb_recorded_shares(const mhb_response *response, const double *area, double *share);

/* The law that the balance had there.
 *   settings  in  those that the response was made from
 *   share     in  of the pair */
mhb_law mhb_recorded_law(const mhb_settings *settings, const mhb_response *response,
                         const mhb_branch *branch, int point, int pair, double share);

/* Motion of the pair in real form, for mhb_contact_force.
 *   motion  out  [3][2m+1], m of the branch */
void mhb_recorded_pair_motion(const mhb_response *response, const mhb_branch *branch, int point,
                              int pair, double *motion);

#endif
