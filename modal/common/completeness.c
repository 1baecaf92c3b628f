#include "modal/common/completeness.h"

#include <math.h>

#include "mesh/base/constants.h"

double modal_check_frequency(const modal_check *check) {
  return sqrt(fmax(check->limit, 0)) / SHB_TWO_PI;
}
