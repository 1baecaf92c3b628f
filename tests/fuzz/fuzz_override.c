/* Overrides of a case: `--set PATH=VALUE`. Load factors that pass are finite. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/schema/case.h"
#include "tests/fuzz/fuzz_file.h"

enum { MOST_OVERRIDES = 16 };

static void check_load(const fem_load *load) {
  for (int k = 0; k <= load->n_harmonics; k++)
    fuzz_assert(isfinite(creal(load->factor[k])) && isfinite(cimag(load->factor[k])),
                "a load factor that is accepted is not finite");
}

/* Each line of the input is an override. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const char *word[MOST_OVERRIDES];
  case_file   file;
  int         n = 0;
  if (size > FUZZ_MOST) return 0;
  char *text = malloc(size + 1), *rest = text;
  if (!text) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  for (char *line; n < MOST_OVERRIDES && (line = strtok_r(rest, "\n", &rest));) word[n++] = line;
  case_overrides overrides = {.n = n, .text = word};
  const char    *path      = fuzz_case("case.yaml", size);
  shb_status     status =
      case_read_with(path, &overrides, CASE_MODAL | CASE_MHB, fuzz_messages(), &file);
  fuzz_messages_end(status != SHB_OK);
  if (status == SHB_OK) check_load(&file.loads[0].load);
  case_free(&file);
  free(text);
  return 0;
}
