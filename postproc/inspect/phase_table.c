#include "postproc/inspect/phase_table.h"

#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"

enum { SECONDS, CPU, MEMORY, GREATEST, COLUMNS };

typedef struct {
  int     n, ranks;
  char  **name;
  double *value[COLUMNS]; /* [n] s, s, B, B */
} table;

static shb_status read_table(hid_t file, table *t) {
  static const char *const path[COLUMNS] = {"/phases/seconds", "/phases/cpu", "/phases/memory",
                                            "/phases/greatest_memory"};
  SHB_TRY(h5_read_strings(file, "/phases/name", &t->n, &t->name));
  SHB_TRY(h5_read_attribute_int(file, "/phases", "ranks", 1, &t->ranks));
  for (int c = 0; c < COLUMNS; c++) {
    h5_shape shape = H5_SHAPE((hsize_t)t->n);
    SHB_TRY(h5_read_double(file, path[c], &shape, &t->value[c]));
  }
  return SHB_OK;
}

static void put_row(const table *t, const char *name, const double value[COLUMNS],
                    post_buffer *out) {
  post_put(out, "  ");
  post_put_printable(out, name);
  for (size_t i = strlen(name); i < 16; i++) post_put(out, " ");
  post_put(out, "%9.2f%9.2f%9.0f", value[SECONDS], value[CPU], 1e-6 * value[MEMORY]);
  if (t->ranks > 1) post_put(out, "%9.0f", 1e-6 * value[GREATEST]);
  post_put(out, "\n");
}

static void put_table(const table *t, post_buffer *out) {
  double all[COLUMNS] = {0};
  post_put(out, "  %-16s%9s%9s%9s", "phase", "s", "CPU s", "peak MB");
  if (t->ranks > 1) post_put(out, "%9s  (%d ranks)", "a rank", t->ranks);
  post_put(out, "\n");
  for (int i = 0; i < t->n; i++) {
    double row[COLUMNS];
    for (int c = 0; c < COLUMNS; c++) {
      row[c] = t->value[c][i];
      all[c] = c == SECONDS || c == CPU ? all[c] + row[c] : row[c] > all[c] ? row[c] : all[c];
    }
    put_row(t, t->name[i], row, out);
  }
  put_row(t, "all", all, out);
}

shb_status post_phase_table(hid_t file, post_buffer *out) {
  table t = {0};
  if (!h5_exists(file, "/phases/name")) return SHB_OK;
  shb_status status = read_table(file, &t);
  if (status == SHB_OK) put_table(&t, out);
  for (int i = 0; t.name && i < t.n; i++) free(t.name[i]);
  free(t.name);
  for (int c = 0; c < COLUMNS; c++) free(t.value[c]);
  return status;
}
