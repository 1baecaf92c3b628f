/* /harmonic and /node of a field file: harmonics that pass are in range, each once, and every node
 * is found where it is. */
#include <stdlib.h>
#include <string.h>

#include "fem/element/load.h"
#include "modal/condense/load_field.h"
#include "tests/fuzz/fuzz_file.h"

enum { NODES = 40 };

/* Values of one byte or of four, by the first bit. Returns how many. */
static int take(const uint8_t *data, size_t size, int **out) {
  size_t each = data[0] % 2 ? 4 : 1, n = (size - 1) / each;
  *out = calloc(n + 1, sizeof **out);
  if (!*out) return 0;
  for (size_t i = 0; i < n; i++) memcpy(&(*out)[i], data + 1 + i * each, each);
  return (int)n;
}

static void check(const modal_load_field *field, const mesh_fe *mesh) {
  int given[FEM_MAX_LOAD_HARMONICS + 1] = {0}, located = 0;
  for (int i = 0; i < field->harmonics; i++) {
    int k = field->harmonic[i];
    fuzz_assert(k >= 0 && k <= FEM_MAX_LOAD_HARMONICS && !given[k]++,
                "a harmonic that is accepted is out of range, or given twice");
  }
  for (int i = 0; i < mesh->n_nodes; i++) {
    if (field->at[i] < 0) continue;
    fuzz_assert(field->at[i] < field->nodes && field->node[field->at[i]] == mesh->node_tag[i],
                "a node is taken for another one");
    located++;
  }
  fuzz_assert(located == field->nodes, "a node that is accepted is in no place");
}

/* The first byte shares the rest between both. The mesh has the nodes 1, 4, 7, ... */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  long             tag[NODES];
  mesh_fe          mesh  = {.n_nodes = NODES, .node_tag = tag};
  modal_load_field field = {.path = "load.h5"};
  if (size < 3 || size > FUZZ_MOST) return 0;
  for (int i = 0; i < NODES; i++) tag[i] = 1 + 3 * i;
  size_t first    = 1 + data[0] % (size - 2);
  field.harmonics = take(data + 1, first, &field.harmonic);
  field.nodes     = take(data + 1 + first, size - 1 - first, &field.node);
  if (field.harmonic && field.node) {
    if (modal_load_field_check(&mesh, &field) == SHB_OK)
      check(&field, &mesh);
    else
      fuzz_assert(shb_message()[0], "a refusal without a word");
  }
  modal_load_field_free(&field);
  return 0;
}
