/* Study files beside a case.yaml: values of designs that pass are finite. */
#include <math.h>

#include "cases/designs/study_spec.h"
#include "tests/fuzz/fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  study_spec spec;
  if (size > FUZZ_MOST) return 0;
  fuzz_case("case.yaml", size);
  const char *path   = fuzz_text("study.yaml", data, size);
  shb_status  status = study_spec_read(path, false, fuzz_messages(), &spec);
  fuzz_messages_end(status != SHB_OK);
  if (status == SHB_OK)
    for (int i = 0; i < spec.n_designs * spec.keys.n; i++)
      fuzz_assert(isfinite(spec.design[i]), "a design that is accepted is not finite");
  study_spec_free(&spec);
  return 0;
}
