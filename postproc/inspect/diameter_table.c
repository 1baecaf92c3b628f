#include "postproc/inspect/diameter_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"

enum { AT_FIRST = 24, COLUMNS = 8 };

static void put_block(const modal_nodal_diameters *d, int first, int rows, post_buffer *out) {
  const int last = first + COLUMNS < d->n ? first + COLUMNS : d->n;
  post_put(out, "  %5s", "mode");
  for (int i = first; i < last; i++) post_put(out, "%12d", d->diameter[i]);
  post_put(out, "\n");
  for (int m = 0; m < rows; m++) {
    post_put(out, "  %5d", m + 1);
    for (int i = first; i < last; i++) {
      char hz[POST_NUMBER];
      post_put(out, "%12s", post_plain(hz, d->model[i].frequency[m], 6));
    }
    post_put(out, "\n");
  }
}

/* Was it checked that no mode is missing at nodal diameter n? */
static shb_status was_checked(hid_t file, int n, bool *yes) {
  char path[48], *by = NULL;
  snprintf(path, sizeof path, "/nodal_diameter_%d/modes", n);
  SHB_TRY(h5_read_attribute_text(file, path, "checked", &by));
  *yes = by && strcmp(by, "no") != 0;
  free(by);
  return SHB_OK;
}

static shb_status put_checks(hid_t file, const modal_nodal_diameters *d, post_buffer *out) {
  int unchecked = 0;
  for (int i = 0; i < d->n; i++) {
    bool yes = false;
    SHB_TRY(was_checked(file, d->diameter[i], &yes));
    if (!yes)
      post_put(out,
               unchecked++ ? ", %d"
                           : "  not checked whether a mode is missing at "
                             "nodal diameter %d",
               d->diameter[i]);
  }
  post_put(out, unchecked ? "\n" : "  no mode is missing at any of these nodal diameters\n");
  return SHB_OK;
}

shb_status post_diameter_table(hid_t file, const modal_nodal_diameters *d, bool all,
                               post_buffer *out) {
  const int modes = d->model[0].n_modes, rows = all || modes <= AT_FIRST ? modes : AT_FIRST;
  post_put(out, "  frequencies in Hz over the nodal diameter; %d blades, 0 to %d are possible\n",
           d->blades, d->blades / 2);
  for (int first = 0; first < d->n; first += COLUMNS) put_block(d, first, rows, out);
  if (rows < modes) post_put(out, "  … %d more (--verbose shows them)\n", modes - rows);
  return put_checks(file, d, out);
}
