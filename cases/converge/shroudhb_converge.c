/* shroudhb-converge: speed against error of a case, setting by setting. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/command.h"
#include "cases/converge/converge.h"
#include "cases/schema/case.h"
#include "cases/schema/converge_settings.h"
#include "mesh/base/progress.h"

static const char usage[] =
    "usage: shroudhb-converge [--no-mesh | --finer] [--quiet] [--verbose] [--force] [--json]\n"
    "                         [--set KEY=VALUE]... [--into FOLDER] CASE.yaml\n"
    "\n"
    "What accuracy costs on CASE.yaml: ladders of harmonics (fixed and auto), contact accuracy, "
    "modes (with\n"
    "and without residual flexibility) and, for a parametric blade, mesh sizes; each rung's "
    "seconds, memory\n"
    "and errors against the finest one; which settings meet converge.tolerance, and the cheapest. "
    "Writes\n"
    "NAME.converge.csv, NAME.converge.svg and NAME.converge.h5, which `shroudhb post` puts into "
    "the report.\n"
    "What was computed stays in the folder NAME.converge and is used again.\n"
    "\n"
    "  --no-mesh  leave out the mesh ladder          --finer  add a finer mesh than the case's\n"
    "  --force    compute everything anew\n"
    "\n"
    "Exit codes: 0 every rung ran and every ladder has a rung below its finest that meets the "
    "tolerance;\n"
    "3 a ladder has none (whether its finest is fine enough is then not known), a finest curve has "
    "a gap,\n"
    "or a rung failed; 2, 4, 130 as for shroudhb.\n";

int main(int argc, char **argv) {
  command_options options;
  case_file       file;
  int             code = command_parse(argc, argv, usage, &options);
  if (code >= 0) return code;
  int        copy;
  char       path[SUBPROCESS_COPY];
  shb_status status = command_keep_text(&options, &copy, path); /* the same for every rung */
  if (status == SHB_OK) status = command_read(&options, CONVERGE_STAGES, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  status = converge_case(&file, &options);
  case_free(&file);
  return command_finish(status);
}
