#include "cases/field/shroudhb_field.h"

#include <cblas.h>
#include <stdio.h>

#include "cases/field/face_command.h"
#include "cases/field/field_command.h"
#include "mesh/base/progress.h"
#include "mesh/process/report.h"

/* Options that need or exclude others; NULL: all is in order. */
static const char *conflict(const command_options *o) {
  if (o->point >= 0 && o->branch < 0) return "--point needs --branch";
  if (o->point >= 0 && o->peak >= 0) return "--peak needs no --point";
  if (o->face && o->ring) return "--face needs no --ring";
  if (o->rank >= 0 && (o->branch >= 0 || o->peak >= 0 || o->face || o->modal))
    return "--mode needs no --branch, --point, --peak, --face, --modal";
  if (o->diameter >= 0 && o->rank < 0) return "--nodal-diameter needs --mode";
  return NULL;
}

int field_command(const command_options *options) {
  const char *wrong = conflict(options);
  FILE       *out   = options->quiet ? NULL : stdout;
  if (wrong) {
    shb_error("%s; see --help", wrong);
    return SHB_ERR_INPUT;
  }
  openblas_set_num_threads(1);
  shb_interrupt_catch();
  return command_finish(options->face ? face_write(options, out) : field_write(options, out));
}
