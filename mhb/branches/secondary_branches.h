/* Branches beside the main one of a preload. Those of doubled period leave it at its flips. Others
 * are found by a multistart search at some values (multistart.h), since no branch leads to them.
 * Both are of order nu: they repeat after nu periods of the excitation. */
#ifndef MHB_BRANCHES_SECONDARY_BRANCHES_H
#define MHB_BRANCHES_SECONDARY_BRANCHES_H

#include "mhb/response/monitor.h"
#include "modal/model/model.h"

/* Whether the settings ask for any. */
bool mhb_secondary_branches_wanted(const mhb_settings *settings);

/* Trace them, and append them to a response. Its branch 0 is the main one, and its others were
 * detached from it. Sets searched of branch 0, unless interrupted, and flips_untraced: there are 24
 * others at most. The branches depend on the settings and on the main branch alone. */
shb_status mhb_secondary_branches(const modal_model *model, const mhb_settings *settings,
                                  mhb_response *response, mhb_monitor *monitor);

/* Search for motions of the main branch's own period at n values of the parameter, as in
 * mhb_branch.value, with some random starts at each. Branches found are appended, and the searches
 * are noted in branch 0; none of it if the monitor stops the search. Errors: as above. */
shb_status mhb_secondary_branches_at(const modal_model *model, const mhb_settings *settings,
                                     mhb_response *response, int n, const double *value, int starts,
                                     mhb_monitor *monitor);

#endif
