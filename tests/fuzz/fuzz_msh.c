/* What is let through to gmsh: it begins as a mesh, or gmsh would run it as a script. */
#define _GNU_SOURCE /* memmem */
#include <string.h>

#include "mesh/io/msh_check.h"
#include "tests/fuzz/fuzz_file.h"

static int begins(const uint8_t *data, size_t size, const char *word) {
  return size >= strlen(word) && memcmp(data, word, strlen(word)) == 0;
}

static int holds(const uint8_t *data, size_t size, const char *word) {
  return memmem(data, size, word, strlen(word)) != NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 1 || size > FUZZ_MOST) return 0;
  if (mesh_msh_check(fuzz_text("blade.msh", data, size)) != SHB_OK) {
    fuzz_assert(shb_message()[0], "a refusal without a word");
    return 0;
  }
  fuzz_assert(begins(data, size, "$MeshFormat") || begins(data, size, "$Comments"),
              "gmsh would run a file that is accepted");
  fuzz_assert(holds(data, size, "$MeshFormat") && holds(data, size, "$EndNodes") &&
                  holds(data, size, "$EndElements"),
              "a file that is accepted lacks a part");
  return 0;
}
