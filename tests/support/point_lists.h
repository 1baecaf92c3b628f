/* Branches of a response that hold values alone: for tests of what joins and edits them. */
#ifndef TESTS_SUPPORT_POINT_LISTS_H
#define TESTS_SUPPORT_POINT_LISTS_H

#include "mhb/response/response.h"

/* Append a nonlinear branch of n points; value[n] as the file shows it. Returns its index. */
int add_point_list(mhb_response *response, int n, const double *value);

#endif
