#include "cases/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/yaml.h"
#include "cases/schema/case.h"

shb_status command_read(const command_options *o, int stages, case_file *out) {
  case_overrides overrides = {.n = o->n_set, .text = o->set, .into = o->into};
  char          *document  = NULL;
  size_t         length;
  if (o->text) SHB_TRY(case_text_read(o->text, &document, &length));
  overrides.document = document;
  shb_status status  = case_read_with(o->path, &overrides, stages, stderr, out);
  free(document);
  SHB_TRY(status);
  status = o->into ? shb_make_folder(o->into) : SHB_OK;
  if (status != SHB_OK) case_free(out);
  return status;
}

shb_status command_keep_text(command_options *o, int *copy, char path[SHB_CHILD_TEXT]) {
  char  *text;
  size_t length;
  SHB_TRY(case_text_read(o->text ? o->text : o->path, &text, &length));
  const shb_status status = shb_child_text(text, copy, path);
  free(text);
  if (status == SHB_OK) o->text = path;
  return status;
}

shb_provenance command_provenance(const case_file *file, char *settings, const char *name) {
  return (shb_provenance){
      .case_path = file->path, .case_text = file->text, .settings = settings, .command = name};
}
