#include "cases/fresh.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal/h5.h"

shb_status fresh_settings(const case_file *file, case_stage stage, const char *input, char **text) {
  const char *name = stage == CASE_MODAL ? "mesh" : "modal";
  char        fingerprint[17], field[64] = "", of_field[17];
  SHB_TRY(shb_fingerprint(input, fingerprint));
  if (stage == CASE_MODAL && file->load.kind == FEM_LOAD_FIELD) {
    SHB_TRY(shb_fingerprint(file->field_file, of_field));
    snprintf(field, sizeof field, "excitation.field.fingerprint = %s\n", of_field);
  }
  char *keys = case_settings(file, stage);
  SHB_CHECK(keys, SHB_ERR_IO, "out of memory");
  size_t size = strlen(keys) + 128;
  *text       = malloc(size);
  if (*text) snprintf(*text, size, "%s%s.fingerprint = %s\n%s", keys, name, fingerprint, field);
  free(keys);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

/* The settings a file was made from; malloc'ed, NULL if it cannot be told. */
static char *written(const char *path) {
  hid_t file;
  char *text = NULL;
  if (h5_open(path, &file) != SHB_OK) return NULL;
  if (h5_read_attribute_text(file, "/", "settings", &text) != SHB_OK) text = NULL;
  h5_close(file);
  return text;
}

bool fresh_equal(const char *path, const char *settings) {
  char *text = written(path);
  bool  same = text && strcmp(text, settings) == 0;
  free(text);
  return same;
}

bool fresh_keys(const case_file *file, case_stage stage, const char *path) {
  char *text = written(path), *keys = case_settings(file, stage);
  bool  same = text && keys && strncmp(text, keys, strlen(keys)) == 0; /* the keys come first */
  free(text);
  free(keys);
  return same;
}

void fresh_warn(const case_file *file, case_stage stage, const char *path) {
  char *text = written(path), *keys = case_settings(file, stage);
  if (text && keys && strncmp(text, keys, strlen(keys)) != 0) /* the keys come first */
    fprintf(stderr, "shroudhb: warning: %s was made from other settings; run `shroudhb %s` first\n",
            path, stage == CASE_MODAL ? "modal" : "mhb");
  free(text);
  free(keys);
}
