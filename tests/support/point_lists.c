#include "tests/support/point_lists.h"

#include "tests/support/check.h"

int add_point_list(mhb_response *response, int n, const double *value) {
  int index, point;
  index = mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
  for (int i = 0; i < n; i++) {
    point                                    = mhb_response_point(response, index);
    response->branch[index].value[point]     = value[i];
    response->branch[index].frequency[point] = value[i];
    response->branch[index].stable[point]    = -1;
  }
  return index;
}
