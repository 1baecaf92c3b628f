/* shroudhb-mhb: the harmonic balance of a case, or the contact law for a prescribed motion. No
 * MPI. */
#include <cblas.h>
#include <stdio.h>
#include <string.h>

#include "cases/commands/balance_run.h"
#include "cases/commands/command.h"
#include "cases/contact/contact_command.h"
#include "cases/schema/case.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"

static const char usage[] =
    "usage: shroudhb-mhb [--quiet] [--verbose] [--force] [--set KEY=VALUE]... [--into FOLDER] "
    "CASE.yaml\n"
    "       shroudhb-mhb --contact [--set KEY=VALUE]... [--into FOLDER] MOTION.yaml [--svg "
    "OUT.svg]\n"
    "\n"
    "Solves the multi-harmonic balance of CASE.yaml on its modal file and writes "
    "NAME.response.h5;\n"
    "does nothing if that file is up to date (unless --force). With --contact: prints the force\n"
    "harmonics, transitions and energy for a prescribed relative motion; with --svg also draws "
    "its\n"
    "hysteresis loops, friction path and states.\n";

/* The picture goes into the folder of --into. */
static int contact(const command_options *o) {
  const case_overrides overrides  = {.n = o->n_set, .text = o->set};
  const bool           moves      = o->svg && o->into && o->svg[0] != '/';
  char                 path[4096] = "";
  shb_status           status     = o->into ? shb_make_folder(o->into) : SHB_OK;
  if (moves) snprintf(path, sizeof path, "%s/%s", o->into, o->svg);
  if (status == SHB_OK)
    status = contact_command(o->path, &overrides, moves ? path : o->svg, stdout);
  return command_finish(status);
}

int main(int argc, char **argv) {
  command_options options;
  int             code = command_parse(argc, argv, usage, &options);
  if (code >= 0) return code;
  if (options.mode && strcmp(options.mode, "contact") == 0) return contact(&options);
  if (options.svg) {
    fputs("shroudhb: error: --svg goes with --contact; see --help\n", stderr);
    return SHB_ERR_INPUT;
  }
  case_file  file;
  shb_status status = command_read(&options, CASE_MHB, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  /* the preloads run in parallel and their systems are small, so BLAS uses one thread */
  openblas_set_num_threads(1);
  shb_memory_map_large(); /* those of many pairs come and go */
  file.mhb.resume = !options.force;
  status          = balance_run(&file, &options, NULL);
  case_free(&file);
  return command_finish(status);
}
