/* Study files beside the example as case.yaml: values of designs that pass are finite. */
#include <math.h>
#include <stdlib.h>

#include "cases/designs/study_spec.h"
#include "tests/fuzz/fuzz_file.h"

static void place_example(void) {
  static char text[FUZZ_MOST];
  FILE       *file = fopen(SHROUDHB_EXAMPLE, "rb");
  fuzz_assert(file != NULL, SHROUDHB_EXAMPLE " cannot be opened");
  size_t length = fread(text, 1, sizeof text, file);
  fclose(file);
  fuzz_text("case.yaml", text, length);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static int placed;
  study_spec spec;
  if (size > FUZZ_MOST) return 0;
  if (!placed++) place_example();
  const char *path   = fuzz_text("study.yaml", data, size);
  shb_status  status = study_spec_read(path, false, fuzz_messages(), &spec);
  fuzz_messages_end(status != SHB_OK);
  if (status == SHB_OK)
    for (int i = 0; i < spec.n_designs * spec.keys.n; i++)
      fuzz_assert(isfinite(spec.design[i]), "a design that is accepted is not finite");
  study_spec_free(&spec);
  return 0;
}
