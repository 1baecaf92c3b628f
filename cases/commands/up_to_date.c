#include "cases/commands/up_to_date.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cases/schema/case_paths.h"
#include "cases/schema/nodal_diameters.h"
#include "cases/schema/stage_settings.h"
#include "mesh/base/publish.h"
#include "mesh/gmsh/provenance.h"
#include "mesh/io/source_files.h"
#include "modal/hdf5/h5.h"

/* Adds a line for the field of a load, if it has one. */
static shb_status add_field(const case_file *file, int load, char *text, size_t size) {
  const char *path = file->loads[load].field;
  char        fingerprint[17], which[24] = "";
  if (!path) return SHB_OK;
  SHB_TRY(shb_fingerprint(path, fingerprint));
  if (file->has_loads) snprintf(which, sizeof which, "loads[%d].", load);
  size_t used = strlen(text);
  snprintf(text + used, size - used, "excitation.%sfield.fingerprint = %s\n", which, fingerprint);
  return SHB_OK;
}

shb_status up_to_date_settings(const case_file *file, case_stage stage, const char *input,
                               char **text) {
  const char *name = stage == CASE_MODAL ? "mesh" : "modal";
  char        fingerprint[17], field[64 * CASE_MAX_LOADS] = "";
  SHB_TRY(stage == CASE_MODAL ? mesh_source_fingerprint(input, fingerprint)
                              : shb_fingerprint(input, fingerprint));
  for (int i = 0; i < file->n_loads && stage == CASE_MODAL; i++)
    SHB_TRY(add_field(file, i, field, sizeof field));
  char *keys = case_settings(file, stage);
  SHB_CHECK(keys, SHB_ERR_IO, "out of memory");
  size_t size = strlen(keys) + strlen(field) + 128;
  *text       = malloc(size);
  if (*text) snprintf(*text, size, "%s%s.fingerprint = %s\n%s", keys, name, fingerprint, field);
  free(keys);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

shb_status up_to_date_mesh_settings(const case_file *file, char **text) {
  char fingerprint[17], *keys = case_settings(file, CASE_MESH);
  SHB_CHECK(keys, SHB_ERR_IO, "out of memory");
  *text = keys;
  if (!file->mesh_file) return SHB_OK;
  shb_status status = mesh_source_fingerprint(file->mesh_file, fingerprint);
  size_t     size   = strlen(keys) + 128;
  *text             = status == SHB_OK ? malloc(size) : NULL;
  if (*text)
    snprintf(*text, size, "%smesh.fingerprint = %s\nsector = %d\n", keys, fingerprint,
             file->source.blades);
  free(keys);
  SHB_TRY(status);
  SHB_CHECK(*text, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

bool up_to_date_mesh(const char *path, const char *settings) {
  char *found = NULL;
  if (access(path, R_OK) != 0 || mesh_settings_read(path, &found) != SHB_OK) return false;
  bool same = strcmp(found, settings) == 0;
  free(found);
  return same;
}

static bool holds(int n, const int *held, int diameter) {
  for (int i = 0; i < n; i++)
    if (held[i] == diameter) return true;
  return false;
}

bool up_to_date_diameters(const case_file *file, const char *path) {
  int   n = 0, *held = NULL, list[CASE_MOST_DIAMETERS];
  bool  all = true;
  hid_t at;
  if (h5_open(path, &at) != SHB_OK) return true;
  if (h5_exists(at, "/nodal_diameter_0") &&
      h5_read_attribute_ints(at, "/", "nodal_diameters", &n, &held) == SHB_OK && n > 0) {
    const int wanted = case_nodal_diameters(file, list);
    for (int i = 0; i < wanted; i++) all = all && holds(n, held, list[i]);
    for (int d = 0; wanted < 0 && d <= file->blades / 2; d++) all = all && holds(n, held, d);
  }
  free(held);
  h5_close(at);
  return all;
}

/* Is the mesh that the case makes the one of its settings? True where none is made. */
static bool mesh_is_current(const case_file *file, const char *mesh) {
  char *settings = NULL;
  if (file->mesh_file && !case_mesh_is_made(file)) return true;
  const bool same =
      up_to_date_mesh_settings(file, &settings) == SHB_OK && up_to_date_mesh(mesh, settings);
  free(settings);
  return same;
}

bool up_to_date_modes(const case_file *file) {
  char *mesh = case_mesh_path(file), *modal = case_modal_path(file), *settings = NULL;
  bool  same = mesh && modal && up_to_date_diameters(file, modal);
  if (same && access(mesh, R_OK) != 0) {
    same = up_to_date_keys(file, CASE_MODAL, modal);
  } else if (same && mesh_is_current(file, mesh)) {
    char *written = up_to_date_written(modal);
    same          = written && up_to_date_settings(file, CASE_MODAL, mesh, &settings) == SHB_OK &&
           strcmp(written, settings) == 0;
    free(written);
  } else {
    same = false;
  }
  free(mesh);
  free(modal);
  free(settings);
  return same;
}

bool up_to_date_modal_of(const char *path, char fingerprint[17]) {
  static const char name[] = "modal.fingerprint = ";
  char             *text   = up_to_date_written(path);
  const char       *line   = text ? strstr(text, name) : NULL;
  while (line && line > text && line[-1] != '\n') line = strstr(line + 1, name);
  if (line) snprintf(fingerprint, 17, "%.16s", line + sizeof name - 1);
  free(text);
  return line != NULL;
}

shb_status up_to_date_check_modal(const char *response, const char *modal) {
  char of_response[17], now[17];
  if (!up_to_date_modal_of(response, of_response)) return SHB_OK;
  SHB_TRY(shb_fingerprint(modal, now));
  SHB_CHECK(strcmp(of_response, now) == 0, SHB_ERR_INPUT,
            "%s was not computed from %s, which has changed since or is another one; run `shroudhb "
            "mhb` again",
            response, modal);
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

void up_to_date_warn(const case_file *file, const char *response) {
  char *settings = up_to_date_written(response), *keys = case_settings(file, CASE_MHB);
  if (settings && *settings && keys && strncmp(settings, keys, strlen(keys)) != 0)
    fprintf(stderr,
            "shroudhb: warning: %s was made from other settings; run `shroudhb mhb` first\n",
            response); /* the keys come first */
  free(keys);
  free(settings);
}
