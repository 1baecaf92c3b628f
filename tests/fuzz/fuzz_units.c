/* Numbers with units: what is accepted is finite, and read alike a second time. */
#include <math.h>
#include <string.h>

#include "cases/parse/units.h"
#include "tests/fuzz/fuzz_file.h"

static const char *const unit[] = {"", "N", "N/m", "m", "rad", "rad/s", "Hz", "Pa", "kg/m3", "s"};

/* The first byte chooses the unit of the key. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  char   text[256], why[CASE_WHY];
  double value = 0, again = 1;
  int    whole;
  if (size < 1 || size >= sizeof text) return 0;
  const char *wanted = unit[data[0] % (sizeof unit / sizeof *unit)];
  memcpy(text, data + 1, size - 1);
  text[size - 1] = '\0';
  if (case_quantity(text, wanted, &value, why)) {
    fuzz_assert(isfinite(value), "a value that is accepted is not finite");
    fuzz_assert(case_quantity(text, wanted, &again, why) && again == value,
                "a value is read in two ways");
  } else {
    fuzz_assert(why[0], "a refusal without a word");
  }
  case_integer(text, &whole, why);
  return 0;
}
