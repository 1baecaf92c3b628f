#include "mesh/gmsh/provenance.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

static void put_block(FILE *file, const char *title, const char *text) {
  if (!text) return;
  fprintf(file, "%s:\n", title);
  for (const char *line = text; *line;) {
    size_t length = strcspn(line, "\n");
    fprintf(file, "  %.*s\n", (int)length, line);
    line += length + (line[length] == '\n');
  }
}

shb_status mesh_provenance_append(const char *path, const shb_provenance *provenance) {
  FILE *file = fopen(path, "ab");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
  fprintf(file, "$Comments\nshroudhb mesh\n");
  fprintf(file, "revision: %s\n", shb_revision());
  if (provenance->command) fprintf(file, "command: %s\n", provenance->command);
  if (provenance->case_path) fprintf(file, "case_path: %s\n", provenance->case_path);
  put_block(file, "settings", provenance->settings);
  put_block(file, "case", provenance->case_text);
  fprintf(file, "$EndComments\n");
  bool bad = ferror(file) != 0;
  bad      = fclose(file) != 0 || bad;
  SHB_CHECK(!bad, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
  return SHB_OK;
}

/* Read up to the line that equals mark. False at the end of the section or the file. */
static bool skip_to(FILE *file, const char *mark, char **line, size_t *size) {
  while (getline(line, size, file) > 0) {
    (*line)[strcspn(*line, "\n")] = 0;
    if (strcmp(*line, mark) == 0) return true;
    if (strcmp(*line, "$EndComments") == 0) return false;
  }
  return false;
}

static void copy_block(FILE *file, FILE *out, char **line, size_t *size) {
  while (getline(line, size, file) > 0 && strncmp(*line, "  ", 2) == 0) fputs(*line + 2, out);
}

shb_status mesh_settings_read(const char *path, char **settings) {
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  char  *line = NULL, *text = NULL;
  size_t size = 0, length = 0;
  FILE  *out = open_memstream(&text, &length);
  if (!out) shb_out_of_memory(0);
  if (skip_to(file, "shroudhb mesh", &line, &size) && skip_to(file, "settings:", &line, &size))
    copy_block(file, out, &line, &size);
  free(line);
  fclose(file);
  if (fclose(out) != 0 || !text) shb_out_of_memory((double)length);
  *settings = text;
  return SHB_OK;
}
