#include "cases/front/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/stage.h"
#include "cases/commands/stages.h"
#include "cases/designs/study_schema.h"
#include "cases/designs/study_table.h"
#include "cases/front/run.h"
#include "cases/parse/key_listing.h"
#include "cases/parse/yaml.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/key_schema.h"
#include "cases/schema/motion.h"
#include "cases/study/shroudhb_study.h"
#include "mesh/process/report.h"

/* A study file has the keys case and vary, plan or uncertain. */
static bool is_study(const char *path) {
  char  *text;
  size_t length;
  if (case_text_read(path, &text, &length) != SHB_OK) return false;
  case_issues issues = case_issues_start(path, text, length);
  case_node  *root   = case_document_parse(&issues);
  bool        study  = case_node_find(root, "case") &&
               (case_node_find(root, "vary") || case_node_find(root, "plan") ||
                case_node_find(root, "uncertain"));
  case_document_free(root);
  case_issues_free(&issues);
  free(text);
  return study;
}

/* With a modal file there is more to tell; a child reads it, since it may be damaged. */
static void add_facts(const case_file *file, const command_options *options) {
  command_options facts = *options;
  shb_child_end   end;
  char           *modal = case_modal_path(file);
  facts.mode            = "facts";
  fflush(stdout);
  if (modal && access(modal, R_OK) == 0)
    (void)stage_run(COMMAND_POST, &facts, &end); /* its own message, if any, is on standard error */
  free(modal);
}

static shb_status check_case(const command_options *options) {
  case_file file;
  SHB_TRY(command_read(options, RUN_ALL | CASE_OR_MODES, &file));
  shb_status status = SHB_OK;
  if (options->json) {
    status = check_print_json(&file);
  } else if (!options->quiet) {
    run_describe(&file, stdout);
    add_facts(&file, options);
  }
  case_free(&file);
  return status;
}

int check_command(const command_options *options) {
  command_options own = *options;
  if (is_study(own.path)) {
    own.mode = "check";
    return study_command(&own);
  }
  own.into = NULL; /* nothing is written: no folder is made */
  return command_finish(check_case(&own));
}

int keys_command(int argc, char **argv) {
  static const struct {
    const char *word;
    void (*print)(FILE *);
  } forms[]             = {{"case", case_print_keys},
                           {"study", study_print_keys},
                           {"motion", case_print_motion_keys},
                           {"--markdown", case_print_reference},
                           {"--schema", case_print_schema},
                           {"--schema=case", case_print_schema},
                           {"--schema=motion", case_print_motion_schema},
                           {"--schema=study", study_print_schema}};
  void (*print)(FILE *) = argc > 1 ? NULL : case_print_keys;
  for (size_t i = 0; argc == 2 && i < sizeof forms / sizeof *forms; i++)
    if (strcmp(argv[1], forms[i].word) == 0) print = forms[i].print;
  if (!print) {
    shb_error("keys takes case, study, motion, --markdown or --schema; unexpected '%s'",
              argv[argc - 1]);
    return SHB_ERR_INPUT;
  }
  print(stdout);
  return command_finish(SHB_OK);
}
