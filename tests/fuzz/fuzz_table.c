/* Tables of numbers: designs of a study, deviations of the blades, parameters of Dakota. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/study/dakota_files.h"
#include "mesh/table/csv.h"
#include "mhb/mistuning/deviation_table.h"
#include "mhb/mistuning/deviations.h"
#include "tests/fuzz/fuzz_file.h"

enum { WHY = 512, MOST_BLADES = 8 };

static void check_cells(const char *path) {
  mesh_table table;
  if (mesh_table_read(path, true, &table) != SHB_OK) {
    fuzz_assert(shb_message()[0], "a refusal without a word");
    return;
  }
  size_t length = 0;
  for (int i = 0; i < table.first[table.n_rows]; i++) length += table.cell[i].length;
  fuzz_assert(length <= FUZZ_MOST, "cells hold more than the file");
  mesh_table_free(&table);
}

static void check_deviations(const char *path, int blades, bool hz) {
  const mhb_deviation_table table = {.path = path, .hz = hz, .blades = blades, .n_modes = 2};
  int                       columns;
  double                   *value = NULL;
  if (mhb_deviation_table_read(&table, &columns, &value) == SHB_OK) {
    fuzz_assert(columns == 1 || columns == 2, "another number of columns");
    for (int i = 0; i < blades * columns; i++)
      fuzz_assert(isfinite(value[i]) && value[i] > MHB_LEAST_DEVIATION,
                  "a deviation that is accepted is not finite, or too low");
  } else {
    fuzz_assert(shb_message()[0], "a refusal without a word");
  }
  free(value);
}

static void check_parameters(const char *path) {
  static dakota_parameters parameters;
  char                     why[WHY] = "", key[2 * DAKOTA_TAG];
  if (!dakota_read(path, &parameters, why, sizeof why)) {
    fuzz_assert(why[0], "a refusal without a word");
    return;
  }
  for (int i = 0; i < parameters.n_variables; i++) {
    fuzz_assert(isfinite(parameters.value[i]), "a value that is accepted is not finite");
    dakota_path(parameters.variable[i], key);
  }
  for (int i = 0; i < parameters.n_derivatives; i++)
    fuzz_assert(parameters.derivative[i] >= 0 && parameters.derivative[i] < parameters.n_variables,
                "a derivative by a variable that is not there");
}

/* The first byte chooses the reader, and the number of blades. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 2 || size > FUZZ_MOST) return 0;
  const char *path = fuzz_text("table.csv", data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      check_cells(path);
      break;
    case 1:
      check_deviations(path, 1 + data[0] / 3 % MOST_BLADES, data[0] % 2);
      break;
    default:
      check_parameters(path);
  }
  return 0;
}
