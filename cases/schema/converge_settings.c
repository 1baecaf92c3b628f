#include "cases/schema/converge_settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/schema/stage_settings.h"
#include "mesh/base/publish.h"
#include "mesh/io/source_files.h"

shb_status converge_settings(const case_file *file, char **text) {
  const char *input     = file->modal_file ? file->modal_file : file->mesh_file;
  char        print[17] = "none";
  if (file->modal_file) SHB_TRY(shb_fingerprint(input, print));
  if (input && !file->modal_file) SHB_TRY(mesh_source_fingerprint(input, print));
  char *keys = case_settings(file, (case_stage)CONVERGE_STAGES);
  SHB_CHECK(keys, SHB_ERR_IO, "out of memory");
  size_t size = strlen(keys) + 64;
  *text       = malloc(size);
  if (*text) snprintf(*text, size, "%sinput.fingerprint = %s\n", keys, print);
  free(keys);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}
