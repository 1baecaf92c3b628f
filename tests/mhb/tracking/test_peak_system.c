/* The derivative of (r, G) against differences, and its slope by the parameter. */
#include "mhb/tracking/peak_system.h"

#include <math.h>
#include <string.h>

#include "mhb/numerics/vector.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/solution.h"

enum { H = 4, PAIRS = 2, N = 3 * PAIRS * (2 * H + 1) };

int main(void) {
  return 0;
}
