#include "modal/common/completeness.h"

#include <math.h>

double modal_check_frequency(const modal_check *check) {
  return sqrt(fmax(check->limit, 0)) / (2 * acos(-1));
}
