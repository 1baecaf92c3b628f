#include "mesh/gmsh/script_files.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "mesh/base/memory.h"
#include "mesh/core/file_format.h"

/* Take over a path, malloc'ed. */
static void put(mesh_file_list *list, char *path, const struct stat *about) {
  list->path[list->n]   = path;
  list->device[list->n] = about->st_dev;
  list->inode[list->n]  = about->st_ino;
  list->n++;
}

void mesh_files_begin(const char *path, mesh_file_list *list) {
  struct stat about = {0};
  list->n           = 0;
  (void)stat(path, &about); /* who reads it tells that it is not there */
  put(list, shb_text(path), &about);
}

void mesh_files_free(mesh_file_list *list) {
  for (int i = 0; i < list->n; i++) free(list->path[i]);
  list->n = 0;
}

static int place_of(const mesh_file_list *list, const struct stat *about) {
  for (int i = 0; i < list->n; i++)
    if (list->device[i] == about->st_dev && list->inode[i] == about->st_ino) return i;
  return -1;
}

shb_status mesh_files_add(mesh_file_list *list, const char *from, const char *name, size_t n,
                          int *at) {
  struct stat about;
  const char *slash   = strrchr(from, '/');
  const int   folder  = slash && name[0] != '/' ? (int)(slash + 1 - from) : 0;
  char       *path    = shb_text_of("%.*s%.*s", folder, from, (int)n, name);
  const bool  present = stat(path, &about) == 0 && S_ISREG(about.st_mode);
  const int   known = present ? place_of(list, &about) : -1, full = list->n == MESH_MOST_FILES;
  *at = known < 0 && present && !full ? list->n : known;
  if (*at == list->n)
    put(list, path, &about);
  else
    free(path);
  SHB_CHECK(*at >= 0 || !present, SHB_ERR_INPUT, "%s: includes more than %d files", list->path[0],
            MESH_MOST_FILES);
  return SHB_OK;
}

/* The text of a file; malloc'ed. NULL: it cannot be read. */
static char *text_of(const char *path) {
  struct stat about;
  FILE       *file = stat(path, &about) == 0 && S_ISREG(about.st_mode) ? fopen(path, "rb") : NULL;
  char       *text = file ? shb_alloc((size_t)about.st_size + 1, 1) : NULL;
  if (text) text[fread(text, 1, (size_t)about.st_size, file)] = '\0';
  if (file) fclose(file);
  return text;
}

/* What stands between quotes of either kind on a line. A text outside that names a file counts too,
 * since an apostrophe in a comment opens none. */
static shb_status add_quoted(mesh_file_list *list, const char *from, const char *text) {
  enum { LONGEST = 4096 };
  static const char quotes[] = "\"'\n";
  int               place;
  for (const char *at = text; *at;) {
    const size_t n = strcspn(at, quotes);
    if (n > 0 && n < LONGEST) SHB_TRY(mesh_files_add(list, from, at, n, &place));
    at += at[n] ? n + 1 : n;
  }
  return SHB_OK;
}

/* What a script merges with the ending of a mesh or a solid includes nothing. */
shb_status mesh_script_files(const char *path, mesh_file_list *list) {
  mesh_files_begin(path, list);
  for (int i = 0; i < list->n; i++) {
    const mesh_format format = mesh_format_of(list->path[i]);
    if (format != MESH_FORMAT_GEO && format != MESH_FORMAT_UNKNOWN) continue;
    char            *text   = text_of(list->path[i]);
    const shb_status status = text ? add_quoted(list, list->path[i], text) : SHB_OK;
    free(text);
    SHB_TRY(status);
  }
  return SHB_OK;
}
