#include "mesh/io/source_files.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "mesh/core/file_format.h"

enum { MOST_FILES = 256 };

/* Files in the order in which they were found. */
typedef struct {
  int   n;
  char *path[MOST_FILES];
} file_list;

/* Add the file `name` of n characters beside another one, if it is a file and not there yet. */
static shb_status add(file_list *list, const char *from, const char *name, size_t n) {
  struct stat about;
  const char *slash  = strrchr(from, '/');
  const int   folder = slash && name[0] != '/' ? (int)(slash + 1 - from) : 0;
  char       *path   = shb_text_of("%.*s%.*s", folder, from, (int)n, name);
  bool        known  = stat(path, &about) != 0 || !S_ISREG(about.st_mode);
  for (int i = 0; i < list->n && !known; i++) known = strcmp(list->path[i], path) == 0;
  if (known || list->n == MOST_FILES) free(path);
  SHB_CHECK(known || list->n < MOST_FILES, SHB_ERR_INPUT, "%s: includes more than %d files",
            list->path[0], MOST_FILES);
  if (!known) list->path[list->n++] = path;
  return SHB_OK;
}

/* Texts in quotes within a line. */
static shb_status add_quoted(file_list *list, const char *from, const char *text) {
  enum { LONGEST = 4096 };
  for (const char *open = text; (open = strchr(open, '"')) != NULL;) {
    const size_t n = strcspn(open + 1, "\"\n");
    if (open[1 + n] == '"' && n > 0 && n < LONGEST) SHB_TRY(add(list, from, open + 1, n));
    open += open[1 + n] == '"' ? n + 2 : n + 1;
  }
  return SHB_OK;
}

/* Cards "*INCLUDE, INPUT=NAME", the name with or without quotes. */
static shb_status add_cards(file_list *list, const char *from, const char *text) {
  static const char card[] = "*INCLUDE", key[] = "INPUT";
  for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n') {
    if (strncasecmp(line, card, sizeof card - 1) != 0) continue;
    const char *end = line + strcspn(line, "\r\n"), *at = line + sizeof card - 1;
    while (at < end && strncasecmp(at, key, sizeof key - 1) != 0) at++;
    at = at < end ? at + sizeof key - 1 : end;
    at += strspn(at, " =\t\"'");
    if (at >= end) continue;
    size_t n = (size_t)(end - at);
    while (n > 0 && strchr(" \t\"'", at[n - 1])) n--;
    SHB_TRY(add(list, from, at, n));
  }
  return SHB_OK;
}

/* The text of a file; malloc'ed. NULL: it cannot be read, which its fingerprint will tell. */
static char *text_of(const char *path) {
  struct stat about;
  FILE       *file = stat(path, &about) == 0 && S_ISREG(about.st_mode) ? fopen(path, "rb") : NULL;
  char       *text = file ? shb_alloc((size_t)about.st_size + 1, 1) : NULL;
  if (text) text[fread(text, 1, (size_t)about.st_size, file)] = '\0';
  if (file) fclose(file);
  return text;
}

/* What a script merges with the ending of a mesh or a solid includes nothing. */
static shb_status add_included(file_list *list, const char *path) {
  const mesh_format of = mesh_format_of(list->path[0]), own = mesh_format_of(path);
  const bool        geo = of == MESH_FORMAT_GEO;
  if ((!geo && of != MESH_FORMAT_INP) || (own != of && own != MESH_FORMAT_UNKNOWN)) return SHB_OK;
  char *text = text_of(path);
  if (!text) return SHB_OK;
  const shb_status status = geo ? add_quoted(list, path, text) : add_cards(list, path, text);
  free(text);
  return status;
}

/* FNV-1a over the fingerprints, in the order of the list. */
static shb_status hash(const file_list *list, char out[17]) {
  uint64_t all = UINT64_C(14695981039346656037);
  SHB_TRY(shb_fingerprint(list->path[0], out));
  for (int i = 0; i < list->n && list->n > 1; i++) {
    char print[17];
    SHB_TRY(shb_fingerprint(list->path[i], print));
    for (const char *at = print; *at; at++)
      all = (all ^ (unsigned char)*at) * UINT64_C(1099511628211);
  }
  if (list->n > 1) snprintf(out, 17, "%016" PRIx64, all);
  return SHB_OK;
}

shb_status mesh_source_fingerprint(const char *path, char out[17]) {
  file_list  list   = {1, {shb_text(path)}};
  shb_status status = SHB_OK;
  for (int i = 0; i < list.n && status == SHB_OK; i++) status = add_included(&list, list.path[i]);
  if (status == SHB_OK) status = hash(&list, out);
  for (int i = 0; i < list.n; i++) free(list.path[i]);
  return status;
}
