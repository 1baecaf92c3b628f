/* Case files: every text is read or refused with an issue, never both. */
#include "cases/schema/case.h"
#include "tests/fuzz/fuzz_file.h"

enum {
  EVERY_STAGE = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST | CASE_CONVERGE | CASE_INTEGRATE
};

/* The length chooses the stages that require their keys. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  case_file file;
  if (size > FUZZ_MOST) return 0;
  const char *path   = fuzz_text("random.yaml", data, size);
  int         stages = size % 2 ? EVERY_STAGE : CASE_MODAL | CASE_OR_MODES;
  fuzz_messages_end(case_read(path, stages, fuzz_messages(), &file) != SHB_OK);
  case_free(&file);
  return 0;
}
