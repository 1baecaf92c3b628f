/* Motion files of `shroudhb contact`: amplitudes that pass are finite. */
#include <math.h>

#include "cases/schema/motion.h"
#include "tests/fuzz/fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  case_motion motion;
  if (size > FUZZ_MOST) return 0;
  const char *path   = fuzz_text("motion.yaml", data, size);
  shb_status  status = case_motion_read(path, NULL, fuzz_messages(), &motion);
  fuzz_messages_end(status != SHB_OK);
  if (status == SHB_OK)
    for (int i = 0; i < 3 * (motion.n_harmonics + 1); i++)
      fuzz_assert(isfinite(creal(motion.motion[i])) && isfinite(cimag(motion.motion[i])),
                  "an amplitude that is accepted is not finite");
  case_motion_free(&motion);
  return 0;
}
