/* shroudhb-pool: every command but the modal stage, as the process that does the work. `shroudhb`
 * starts one for a command, a study one a core, and mpiexec those of several machines. */
#include <stdio.h>
#include <sys/prctl.h>

#include "cases/commands/stages.h"
#include "cases/converge/converge.h"
#include "cases/field/shroudhb_field.h"
#include "cases/front/check.h"
#include "cases/front/run.h"
#include "cases/front/shroudhb_samples.h"
#include "cases/options/help.h"
#include "cases/study/shroudhb_study.h"
#include "mesh/process/report.h"

static int run_command(const command_options *options) {
  return command_finish(run_case(options));
}

/* What the commands of the table do. */
static int (*const work[COMMANDS])(const command_options *) = {
    [COMMAND_RUN] = run_command,         [COMMAND_MESH] = mesh_command,
    [COMMAND_MHB] = mhb_command,         [COMMAND_INTEGRATE] = integrate_command,
    [COMMAND_POST] = post_command,       [COMMAND_CONVERGE] = converge_command,
    [COMMAND_STUDY] = study_command,     [COMMAND_EVAL] = eval_command,
    [COMMAND_CHECK] = check_command,     [COMMAND_INSPECT] = inspect_command,
    [COMMAND_FIELD] = field_command,     [COMMAND_CONTACT] = contact_command,
    [COMMAND_SAMPLES] = samples_command, [COMMAND_RUNG] = rung_command,
    [COMMAND_DESIGN] = design_command};

int main(int argc, char **argv) {
  const command_id   id  = argc > 1 ? command_find(argv[1]) : COMMANDS;
  const command_row *row = id < COMMANDS ? command_row_of(id) : NULL;
  char               name[32];
  command_options    options;
  int                code = help_answer(row, argc, argv);
  if (code >= 0) return code;
  if (!row || (!work[id] && id != COMMAND_KEYS)) {
    shb_error("shroudhb-pool does the work of a command of shroudhb: name one; see --help");
    return SHB_ERR_INPUT;
  }
  snprintf(name, sizeof name, "shroudhb-%s", row->name);
  prctl(PR_SET_NAME, name); /* what ps and top show */
  if (id == COMMAND_KEYS) return keys_command(argc - 1, argv + 1);
  code = options_read(row, argc - 1, argv + 1, &options);
  return code >= 0 ? code : work[id](&options);
}
