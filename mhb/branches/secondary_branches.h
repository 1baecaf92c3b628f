/* Branches beside the main one of a preload: those of doubled period that leave it at its flips, and those that nothing leads to,
 * found by search at some frequencies (multistart.h) and then followed. Both are of order nu: they repeat after nu periods. */
#ifndef MHB_BRANCHES_SECONDARY_BRANCHES_H
#define MHB_BRANCHES_SECONDARY_BRANCHES_H

#include "mhb/branches/main_branch.h"
#include "modal/model/model.h"

/* At most this many beside each main branch. */
enum { MHB_MAX_SECONDARY = 24 };

/* Whether the settings ask for any. */
bool mhb_secondary_branches_wanted(const mhb_settings *settings);

/* Look for them and append them to the response, whose branches must have room (mhb_response_reserve): other threads may be at
 * work on it. Sets `searched` of the main branch, unless interrupted. What the branches are depends on the settings and the main
 * branch alone. Errors: SHB_ERR_IO no memory. */
shb_status mhb_secondary_branches(const modal_model *model, const mhb_settings *settings,
                                  mhb_response *response, int main, mhb_monitor *monitor);

#endif
