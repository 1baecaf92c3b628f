/* shroudhb mhb, shroudhb contact: the harmonic balance of a case, the contact law alone. */
#include <cblas.h>
#include <stdio.h>
#include <string.h>

#include "cases/commands/balance_run.h"
#include "cases/commands/stages.h"
#include "cases/contact/contact_command.h"
#include "cases/schema/case.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"

int mhb_command(const command_options *options) {
  case_file  file;
  shb_status status = command_read(options, CASE_MHB, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  /* the preloads run in parallel and their systems are small, so BLAS uses one thread */
  openblas_set_num_threads(1);
  shb_memory_map_large(); /* those of many pairs come and go */
  file.mhb.resume = !options->force;
  status          = balance_run(&file, options, NULL);
  case_free(&file);
  return command_finish(status);
}

/* The picture goes into the folder of --into. */
int contact_command(const command_options *o) {
  const case_overrides overrides  = {.n = o->n_set, .text = o->set};
  const bool           moves      = o->svg && o->into && o->svg[0] != '/';
  char                 path[4096] = "";
  shb_status           status     = o->into ? shb_make_folder(o->into) : SHB_OK;
  if (moves) snprintf(path, sizeof path, "%s/%s", o->into, o->svg);
  if (status == SHB_OK) status = contact_run(o->path, &overrides, moves ? path : o->svg, stdout);
  return command_finish(status);
}
