#include "postproc/inspect/diameter_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/structure/gyroscopic.h"
#include "postproc/draw/number_format.h"

enum { AT_FIRST = 24, COLUMNS = 8, FAMILIES = 6 };

static void put_block(const modal_nodal_diameters *d, int first, int rows, post_buffer *out) {
  const int last = first + COLUMNS < d->n ? first + COLUMNS : d->n;
  post_put(out, "  %5s", "mode");
  for (int i = first; i < last; i++) post_put(out, "%12d", d->diameter[i]);
  post_put(out, "\n");
  for (int m = 0; m < rows; m++) {
    post_put(out, "  %5d", m + 1);
    for (int i = first; i < last; i++) {
      char hz[POST_NUMBER];
      post_put_column(out, 12, post_plain(hz, d->model[i].frequency[m], 6));
    }
    post_put(out, "\n");
  }
}

/* Towards which side the rotor turns, "left" or "right"; NULL: the file does not say. */
static shb_status turning(hid_t file, char **side) {
  *side = NULL;
  return h5_read_attribute_text(file, "/nodal_diameter_0/modes/coriolis", "rotor_turns", side);
}

/* Frequencies of both waves of a nodal diameter, with the sense of the rotor and against it.
 * Positive frequencies belong to the wave that runs to the right. */
static shb_status put_waves(const modal_nodal_diameters *d, int at, bool left, int rows,
                            post_buffer *out) {
  modal_wave     wave;
  mhb_gyroscopic g;
  int            missing;
  if (!modal_nodal_diameters_wave(d, d->diameter[at], &wave, &missing)) return SHB_OK;
  shb_status status = mhb_gyroscopic_of_wave(&wave, &g);
  for (int m = 0; status == SHB_OK && m < rows; m++) {
    const double right = g.omega[g.n + m] / SHB_TWO_PI, back = -g.omega[g.n - 1 - m] / SHB_TWO_PI;
    char         a[POST_NUMBER], b[POST_NUMBER], c[POST_NUMBER];
    post_put(out, "  %5d%6d", d->diameter[at], m + 1);
    post_put_column(out, 14, post_plain(a, d->model[at].frequency[m], 6));
    post_put_column(out, 14, post_plain(b, left ? back : right, 6));
    post_put_column(out, 14, post_plain(c, left ? right : back, 6));
    post_put(out, "\n");
  }
  mhb_gyroscopic_free(&g);
  return status;
}

/* With Coriolis terms: forward and backward waves. */
static shb_status put_coriolis(hid_t file, const modal_nodal_diameters *d, int rows,
                               post_buffer *out) {
  char *side;
  if (!d->model[0].coriolis) return SHB_OK;
  SHB_TRY(turning(file, &side));
  const bool left = side && strcmp(side, "left") == 0;
  post_put(out, "  with Coriolis terms, Hz in the frame of the rotor, which turns %s\n",
           !side  ? "right (not said)"
           : left ? "left (-tangential)"
                  : "right (+tangential)");
  post_put(out, "  %5s%6s%14s%14s%14s\n", "nd", "mode", "without", "forward", "backward");
  free(side);
  for (int i = 0; i < d->n; i++) SHB_TRY(put_waves(d, i, left, rows, out));
  return SHB_OK;
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
  SHB_TRY(put_coriolis(file, d, all || rows < FAMILIES ? rows : FAMILIES, out));
  return put_checks(file, d, out);
}
