#include "tests/support/point_lists.h"

#include "tests/support/check.h"

int add_point_list(mhb_response *response, int n, const double *value) {
  int index, point;
  assert_ok(mhb_response_branch(response, MHB_BRANCH_NONLINEAR, &index));
  for (int i = 0; i < n; i++) {
    assert_ok(mhb_response_point(response, index, &point));
    response->branch[index].value[point]     = value[i];
    response->branch[index].frequency[point] = value[i];
    response->branch[index].stable[point]    = -1;
  }
  return index;
}
