#include "mesh/io/source_files.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>

#include "mesh/base/publish.h"
#include "mesh/core/file_format.h"
#include "mesh/gmsh/script_files.h"
#include "mesh/io/inp_deck.h"

static shb_status deck_files(const char *path, mesh_file_list *list) {
  mesh_deck  deck;
  mesh_card  card;
  bool       more   = true;
  shb_status status = mesh_deck_open(path, &deck);
  while (status == SHB_OK && more) status = mesh_deck_card(&deck, &card, &more);
  *list      = deck.files;
  deck.files = (mesh_file_list){0};
  mesh_deck_close(&deck);
  return status;
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
