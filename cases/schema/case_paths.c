#include "cases/schema/case_paths.h"

#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "mesh/core/file_format.h"

char *case_output(const case_file *file, const char *suffix) {
  const char *folder = file->output ? file->output : file->folder;
  const bool  here   = strcmp(folder, ".") == 0;
  return shb_text_of("%s%s%s%s", here ? "" : folder, here ? "" : "/", file->name, suffix);
}

shb_status case_output_check(const case_file *file, int n, const char *const *suffix) {
  for (int i = 0; i < n; i++) SHB_TRY(shb_publish_check_freed(case_output(file, suffix[i])));
  return SHB_OK;
}

bool case_mesh_is_made(const case_file *file) {
  const mesh_source *source = &file->source;
  if (!file->mesh_file) return false;
  bool made = MESH_FORMAT_IS_SOLID(mesh_format_of(file->mesh_file)) || source->unit != 1;
  const mesh_rules *rules = &source->rules;
  for (int i = 0; i < MESH_N_SETS; i++) made = made || rules->usual[i].kind != MESH_RULE_NONE;
  for (int i = 0; i < rules->n_more; i++) made = made || rules->more[i].rule.kind != MESH_RULE_NONE;
  for (int i = 0; i < rules->n_volumes; i++)
    made = made || rules->volume[i].rule.kind != MESH_RULE_NONE;
  return made;
}

char *case_mesh_path(const case_file *file) {
  return file->mesh_file && !case_mesh_is_made(file) ? shb_text(file->mesh_file)
                                                     : case_output(file, ".msh");
}

char *case_modal_path(const case_file *file) {
  return file->modal_file ? shb_text(file->modal_file) : case_output(file, ".modal.h5");
}
