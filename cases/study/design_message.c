#include "cases/study/design_message.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

typedef struct {
  int32_t state, n_outputs, n_derivatives, reason,
      curve; /* length of the reason, points of the curve */
  double seconds;
} header;

enum { PLACES = 2 }; /* value and error of each output */

static size_t size_of(const header *h) {
  size_t outputs = (PLACES * (size_t)h->n_outputs + (size_t)h->n_derivatives) * sizeof(double);
  size_t points  = (size_t)h->curve * (2 * sizeof(double) + 2 * sizeof(int));
  return sizeof *h + outputs + points + (size_t)h->reason;
}

/* Copy between a struct and the bytes at *at, in the direction of pack. */
static void move(bool pack, char **at, void *data, size_t size) {
  if (pack) memcpy(*at, data, size);
  if (!pack) memcpy(data, *at, size);
  *at += size;
}

static void move_body(bool pack, char *at, const header *h, study_design *d) {
  size_t       outputs = (size_t)h->n_outputs * sizeof(double), points = (size_t)h->curve;
  study_curve *c = &d->curve;
  move(pack, &at, d->value, outputs);
  move(pack, &at, d->error, outputs);
  move(pack, &at, d->derivative, (size_t)h->n_derivatives * sizeof(double));
  if (h->curve > 0) {
    move(pack, &at, c->frequency, points * sizeof *c->frequency);
    move(pack, &at, c->amplitude, points * sizeof *c->amplitude);
    move(pack, &at, c->branch, points * sizeof *c->branch);
    move(pack, &at, c->stable, points * sizeof *c->stable);
  }
  if (h->reason > 0) move(pack, &at, d->reason, (size_t)h->reason);
}

shb_status design_message_pack(const study_design *d, int n_outputs, int n_derivatives,
                               char **bytes, size_t *size) {
  header h = {(int32_t)d->state, n_outputs,
              n_derivatives,     d->reason ? (int32_t)strlen(d->reason) : 0,
              d->curve.n,        d->seconds};
  *size    = size_of(&h);
  *bytes   = shb_alloc(*size, 1);
  memcpy(*bytes, &h, sizeof h);
  study_design copy = *d; /* packing only reads it */
  move_body(true, *bytes + sizeof h, &h, &copy);
  return SHB_OK;
}

shb_status design_message_unpack(const char *bytes, size_t size, int n_outputs, int n_derivatives,
                                 study_design *d) {
  header h;
  SHB_CHECK(size >= sizeof h, SHB_ERR_IO, "the message of a design is cut");
  memcpy(&h, bytes, sizeof h);
  bool good = h.n_outputs == n_outputs && h.n_derivatives == n_derivatives && h.reason >= 0 &&
              h.curve >= 0 && h.curve <= STUDY_CURVE && h.state >= 0 && h.state < STUDY_N_STATES;
  SHB_CHECK(good && size == size_of(&h), SHB_ERR_IO, "the message of a design is damaged");
  SHB_TRY(study_curve_take(&d->curve, h.curve));
  free(d->reason);
  d->reason  = h.reason ? shb_alloc_zeroed((size_t)h.reason + 1, 1) : NULL;
  d->state   = (study_state)h.state;
  d->seconds = h.seconds;
  move_body(false, (char *)bytes + sizeof h, &h, d);
  return SHB_OK;
}

shb_status design_message_copy(const study_design *from, int n_outputs, int n_derivatives,
                               study_design *to) {
  char  *bytes;
  size_t size;
  SHB_TRY(design_message_pack(from, n_outputs, n_derivatives, &bytes, &size));
  shb_status status = design_message_unpack(bytes, size, n_outputs, n_derivatives, to);
  to->seconds       = 0;
  free(bytes);
  return status;
}
