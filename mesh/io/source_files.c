#include "mesh/io/source_files.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/publish.h"
#include "mesh/core/file_format.h"
#include "mesh/gmsh/script_files.h"

/* Cards "*INCLUDE, INPUT=NAME", the name with or without quotes. */
static shb_status add_cards(mesh_file_list *list, const char *from, const char *text) {
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
    SHB_TRY(mesh_files_add(list, from, at, n));
  }
  return SHB_OK;
}

static shb_status deck_files(const char *path, mesh_file_list *list) {
  mesh_files_begin(path, list);
  for (int i = 0; i < list->n; i++) {
    char            *text   = mesh_files_text(list->path[i]);
    const shb_status status = text ? add_cards(list, list->path[i], text) : SHB_OK;
    free(text);
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* FNV-1a over the fingerprints, in the order of the list. */
static shb_status hash(const mesh_file_list *list, char out[17]) {
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
  mesh_file_list    list   = {0};
  const mesh_format format = mesh_format_of(path);
  shb_status        status = SHB_OK;
  if (format == MESH_FORMAT_GEO)
    status = mesh_script_files(path, &list);
  else if (format == MESH_FORMAT_INP)
    status = deck_files(path, &list);
  else
    mesh_files_begin(path, &list);
  if (status == SHB_OK) status = hash(&list, out);
  mesh_files_free(&list);
  return status;
}
