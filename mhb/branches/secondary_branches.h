/* Branches beside the main one of a preload. Those of doubled period leave it at its flips. Others
 * are found by a multistart search at some values (multistart.h), since no branch leads to them.
 * Both are of order nu: they repeat after nu periods of the excitation. */
#ifndef MHB_BRANCHES_SECONDARY_BRANCHES_H
#define MHB_BRANCHES_SECONDARY_BRANCHES_H

#include "mhb/branches/monitor.h"
#include "modal/model/model.h"

/* Whether the settings ask for any. */
bool mhb_secondary_branches_wanted(const mhb_settings *settings);

/* Trace them, and append them to a response. Its branch 0 is the main one, and its others were
 * detached from it. Sets searched of branch 0, unless interrupted. The branches depend on the
 * settings and on the main branch alone. SHB_ERR_IO: no memory. */
shb_status mhb_secondary_branches(const modal_model *model, const mhb_settings *settings,
                                  mhb_response *response, mhb_monitor *monitor);

#endif
