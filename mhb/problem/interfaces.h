/* Several contact interfaces (a shroud and a mid-span snubber): the condition that each sees, and which one a pair belongs to.
 *
 * One interface leads: a condition holds its parameters, and a curve follows one of them. The others have the values of the case at
 * the same place of the preload lists. What is followed they either keep, or (together) have in the proportion of the case.
 * On the way to a first solution all preloads move alike: n0 of the case + (n0 - anchor) of the leading one. */
#ifndef MHB_PROBLEM_INTERFACES_H
#define MHB_PROBLEM_INTERFACES_H

#include "mhb/problem/parameter.h"
#include "modal/model/model.h"

/* How many there are: 1 where the settings name none. */
int mhb_interfaces(const mhb_settings *settings);

/* The condition as an interface sees it; where there is one, or it leads, the condition itself. */
mhb_operating_point mhb_interface_operating_point(const mhb_operating_point *condition,
                                                  const mhb_settings *settings, int interface);

/* Change of the interface's own parameter with that of the leading one. */
double mhb_interface_rate(const mhb_operating_point *condition, const mhb_settings *settings,
                          int interface, mhb_parameter parameter);

/* interface[pair] of the model, in the order of the settings.
 * SHB_ERR_INPUT: an interface of the model that the settings do not have, or the other way round. */
shb_status mhb_interfaces_match(const modal_model *model, const mhb_settings *settings,
                                int *interface);

#endif
