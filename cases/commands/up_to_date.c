#include "cases/commands/up_to_date.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cases/schema/stage_settings.h"
#include "mesh/base/publish.h"
#include "modal/hdf5/h5.h"

/* Adds a line for the field of a load, if it has one. */
static shb_status add_field(const char *path, int load, char *text, size_t size) {
  char fingerprint[17], which[24] = "";
  if (!path) return SHB_OK;
  SHB_TRY(shb_fingerprint(path, fingerprint));
  if (load >= 0) snprintf(which, sizeof which, "loads[%d].", load);
  size_t used = strlen(text);
  snprintf(text + used, size - used, "excitation.%sfield.fingerprint = %s\n", which, fingerprint);
  return SHB_OK;
}

shb_status up_to_date_settings(const case_file *file, case_stage stage, const char *input,
                               char **text) {
  const char *name = stage == CASE_MODAL ? "mesh" : "modal";
  char        fingerprint[17], field[64 * (CASE_MAX_LOADS + 1)] = "";
  SHB_TRY(shb_fingerprint(input, fingerprint));
  for (int i = -1; i < file->n_loads && stage == CASE_MODAL; i++)
    SHB_TRY(add_field(i < 0 ? file->field_file : file->loads[i].field, i, field, sizeof field));
  char *keys = case_settings(file, stage);
  SHB_CHECK(keys, SHB_ERR_IO, "out of memory");
  size_t size = strlen(keys) + strlen(field) + 128;
  *text       = malloc(size);
  if (*text) snprintf(*text, size, "%s%s.fingerprint = %s\n%s", keys, name, fingerprint, field);
  free(keys);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

char *up_to_date_written(const char *path) {
  hid_t file;
  char *text = NULL;
  if (h5_open(path, &file) != SHB_OK) return NULL;
  if (h5_read_attribute_text(file, "/", "settings", &text) != SHB_OK) text = NULL;
  h5_close(file);
  return text;
}

bool up_to_date_with(const char *path, const char *settings) {
  struct stat about;
  if (lstat(path, &about) == 0 && S_ISDIR(about.st_mode)) return false; /* writing it will tell */
  if (h5_check_earlier(path) != SHB_OK) {
    fprintf(stderr, "shroudhb: warning: %s; it is replaced\n", shb_message());
    return false;
  }
  char *text = up_to_date_written(path);
  bool  same = text && strcmp(text, settings) == 0;
  free(text);
  return same;
}

bool up_to_date_keys(const case_file *file, case_stage stage, const char *path) {
  char *text = up_to_date_written(path), *keys = case_settings(file, stage);
  bool  same = text && keys && strncmp(text, keys, strlen(keys)) == 0; /* the keys come first */
  free(text);
  free(keys);
  return same;
}

void up_to_date_warn_of(const case_file *file, case_stage stage, const char *path,
                        const char *settings) {
  const char *name  = stage == CASE_MESH ? "mesh" : stage == CASE_MODAL ? "modal" : "mhb";
  char       *keys  = case_settings(file, stage);
  const bool  known = settings && *settings;
  if (known && keys && strncmp(settings, keys, strlen(keys)) != 0) /* the keys come first */
    fprintf(stderr, "shroudhb: warning: %s was made from other settings; run `shroudhb %s` first\n",
            path, name);
  free(keys);
}

void up_to_date_warn(const case_file *file, case_stage stage, const char *path) {
  char *text = up_to_date_written(path);
  up_to_date_warn_of(file, stage, path, text);
  free(text);
}
