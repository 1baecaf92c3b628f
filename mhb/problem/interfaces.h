/* Several contact interfaces (a shroud and a mid-span snubber): the operating point of each, and
 * the interface of each pair.
 *
 * One interface leads: the operating point holds its parameters, and a curve follows one of them.
 * The others have the values of the case at the same place of the preload lists. The parameter
 * followed they either keep, or change in the proportion of the case (together). On the way to a
 * first solution all preloads move alike: n0 of the case + (n0 - tied_n0) of the leading one. */
#ifndef MHB_PROBLEM_INTERFACES_H
#define MHB_PROBLEM_INTERFACES_H

#include "mhb/problem/parameter.h"
#include "modal/model/model.h"

/* Number of interfaces: 1 where the settings name none. */
int mhb_interfaces(const mhb_settings *settings);

/* The operating point of an interface; that given, if there is one interface or it leads. */
mhb_operating_point mhb_interface_operating_point(const mhb_operating_point *point,
                                                  const mhb_settings *settings, int interface);

/* Derivative of the interface's own parameter by that of the leading one. */
double mhb_interface_rate(const mhb_operating_point *point, const mhb_settings *settings,
                          int interface, mhb_parameter parameter);

/* interface[pair] <- index in the settings. SHB_ERR_INPUT: model and settings do not have the same
 * interfaces. */
shb_status mhb_interfaces_match(const modal_model *model, const mhb_settings *settings,
                                int *interface);

/* Share of each pair in the totals of its interface: by area, equal ones without areas.
 *   interface  in   [n_pairs] below n, or NULL: all pairs have one
 *   area       in   [n_pairs] m2, or NULL
 *   contacts   in   equal groups of pairs, each a whole contact, as one a blade of a ring
 *   share      out  [n_pairs] their sum over an interface is `contacts` */
void mhb_pair_shares(int n_pairs, int n, const int *interface, const double *area, int contacts,
                     double *share);

#endif
