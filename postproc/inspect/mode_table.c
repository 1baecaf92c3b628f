#include "postproc/inspect/mode_table.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/hdf5/h5.h"
#include "postproc/draw/number_format.h"

enum { AT_FIRST = 24 };

/* Effective masses of a file; mass 0: none. */
typedef struct {
  double *translation, *rotation; /* [m][3] kg, [m] kg m2 */
  double  mass, inertia;          /* of the whole blade */
} shares;

static shb_status read_shares(hid_t file, const modal_model *model, shares *s) {
  h5_shape each = H5_SHAPE((hsize_t)model->n_modes, 3), one = H5_SHAPE((hsize_t)model->n_modes);
  if (!h5_exists(file, "/modes/effective_mass") || !h5_exists(file, "/modes/effective_inertia"))
    return SHB_OK;
  SHB_TRY(h5_read_double(file, "/modes/effective_mass", &each, &s->translation));
  SHB_TRY(h5_read_double(file, "/modes/effective_inertia", &one, &s->rotation));
  SHB_TRY(h5_read_attribute_double(file, "/", "mass", 0, &s->mass));
  return h5_read_attribute_double(file, "/", "inertia", 0, &s->inertia);
}

static void put_share(double share, post_buffer *out) {
  post_put(out, "%8.2f", 100 * share);
}

static void put_row(const modal_model *m, const shares *s, int i, post_buffer *out) {
  char hz[POST_NUMBER], zeta[POST_NUMBER];
  post_put(out, "  %5d", i + 1);
  post_put_column(out, 13, post_plain(hz, m->frequency[i], 6));
  post_put_column(out, 10, post_plain(zeta, m->damping_ratio[i], 3));
  if (s->mass > 0) {
    for (int d = 0; d < 3; d++) put_share(s->translation[3 * i + d] / s->mass, out);
    put_share(s->inertia > 0 ? s->rotation[i] / s->inertia : 0, out);
  }
  post_put(out, "\n");
}

static void put_sums(const modal_model *m, const shares *s, post_buffer *out) {
  double sum[4] = {0};
  char   mass[POST_NUMBER], inertia[POST_NUMBER];
  for (int i = 0; i < m->n_modes; i++) {
    for (int d = 0; d < 3; d++) sum[d] += s->translation[3 * i + d] / s->mass;
    sum[3] += s->inertia > 0 ? s->rotation[i] / s->inertia : 0;
  }
  post_put(out, "  all %d modes of the file     ", m->n_modes);
  if (m->n_modes < 100) post_put(out, " ");
  if (m->n_modes < 10) post_put(out, " ");
  for (int d = 0; d < 4; d++) put_share(sum[d], out);
  post_put(out,
           "\n  of the blade's mass, %s kg, and its moment of inertia about the engine axis, %s kg "
           "m²\n",
           post_plain(mass, s->mass, 6), post_plain(inertia, s->inertia, 6));
}

static void put_table(const modal_model *m, const shares *s, bool all, post_buffer *out) {
  int shown = all || m->n_modes <= AT_FIRST ? m->n_modes : AT_FIRST;
  if (s->mass > 0) post_put(out, "  %28s%32s\n", "", "effective mass, %");
  post_put(out, "  %5s %12s %9s", "mode", "Hz", "damping");
  if (s->mass > 0) post_put(out, "%8s%8s%8s%8s", "x", "y", "z", "spin");
  post_put(out, "\n");
  for (int i = 0; i < shown; i++) put_row(m, s, i, out);
  if (shown < m->n_modes) post_put(out, "  … %d more (--verbose shows them)\n", m->n_modes - shown);
  if (s->mass > 0) put_sums(m, s, out);
}

/* Frequencies with Coriolis terms, where the file has them. */
static shb_status put_coriolis(const modal_model *m, bool all, post_buffer *out) {
  const modal_wave wave  = modal_wave_real(m);
  const int        shown = all || m->n_modes <= AT_FIRST ? m->n_modes : AT_FIRST;
  mhb_gyroscopic   g;
  if (!m->coriolis) return SHB_OK;
  shb_status status = mhb_gyroscopic_of_wave(&wave, &g);
  if (status == SHB_OK) post_put(out, "  with Coriolis terms\n");
  for (int i = 0; status == SHB_OK && i < shown; i++) {
    char hz[POST_NUMBER];
    post_put(out, "  %5d", i + 1);
    post_put_column(out, 13, post_plain(hz, g.omega[g.n + i] / SHB_TWO_PI, 6));
    post_put(out, "\n");
  }
  mhb_gyroscopic_free(&g);
  return status;
}

/* How the file's check for missing modes was made; nothing if the file does not say. */
static shb_status put_check(hid_t file, post_buffer *out) {
  char  *by = NULL, below[POST_NUMBER], number[POST_NUMBER];
  double limit, chance;
  int    count;
  SHB_TRY(h5_read_attribute_text(file, "/modes", "checked", &by));
  if (!by) return SHB_OK;
  shb_status status = h5_read_attribute_int(file, "/modes", "checked_count", 0, &count);
  if (status == SHB_OK)
    status = h5_read_attribute_double(file, "/modes", "checked_below", 0, &limit);
  if (status == SHB_OK)
    status = h5_read_attribute_double(file, "/modes", "missed_chance", 1, &chance);
  if (status == SHB_OK && strcmp(by, "no") == 0) {
    post_put(out, "  not checked whether a mode is missing\n");
  } else if (status == SHB_OK) {
    post_put(out, "  no mode is missing: %d below %s Hz, counted by ", count,
             post_plain(below, limit, 6));
    post_put_printable(out, by);
    if (chance > 0)
      post_put(out, ", wrong with a chance of %s at most", post_number(number, chance, 2));
    post_put(out, "\n");
  }
  free(by);
  return status;
}

shb_status post_mode_table(hid_t file, const modal_model *model, bool all, post_buffer *out) {
  shares     s      = {0};
  shb_status status = read_shares(file, model, &s);
  if (status == SHB_OK) put_table(model, &s, all, out);
  if (status == SHB_OK) status = put_coriolis(model, all, out);
  if (status == SHB_OK) status = put_check(file, out);
  free(s.translation);
  free(s.rotation);
  return status;
}
