#include "cases/schema/unused_keys.h"

#include <string.h>

#include "cases/parse/key_table.h"

/* Does the key matter only for modes that are computed here? */
static bool of_own_modes(const case_key *key) {
  return key->when != CASE_IF_ORDER && key->when != CASE_IF_SECTOR &&
         (key->stages & (CASE_MESH | CASE_MODAL)) != 0;
}

static bool has_block(const case_reader *r, const char *path) {
  for (int i = 0; i < r->n_blocks; i++)
    if (strcmp(r->block[i].path, path) == 0) return true;
  return false;
}

/* The outermost block of the key if nothing in it is read, else the key itself. */
static void whole(const case_reader *r, const case_key *key, char path[CASE_PATH]) {
  size_t n = strcspn(key->path, ".");
  case_path(path, "%.*s", (int)n, key->path);
  bool none = has_block(r, path);
  for (int i = 0; i < r->keys.n && none; i++) {
    const case_key *other = &r->keys.key[i];
    if (strncmp(other->path, key->path, n) == 0 && other->path[n] == '.' &&
        !strstr(other->path, "[]"))
      none = !case_key_applies(other, r->file, r->file);
  }
  if (!none) case_path(path, "%s", key->path);
}

/* Keys reported elsewhere, or allowed. The check of mesh.file reports mesh.size beside a mesh, that
 * of the interfaces the keys of a single one.
 * search.at and search.orders may stay while search.starts is 0. */
static bool told(const case_reader *r, const case_key *key) {
  if (key->when == CASE_IF_SIZE) return r->file->mesh_file != NULL;
  if (key->when == CASE_IF_SEARCH || key->when == CASE_IF_SEARCH_AT)
    return case_reader_given(r, "mhb.search.starts") != NULL && r->file->mhb.search.starts == 0;
  return false;
}

static bool of_single_interface(const case_reader *r, const case_key *key) {
  const size_t n = strlen("contact.");
  char         path[CASE_PATH];
  if (!r->file->has_interfaces || strncmp(key->path, "contact.", n) != 0) return false;
  case_path(path, "contact.interfaces[].%s", key->path + n);
  return case_key_find(r->keys, path) != NULL;
}

void case_check_unused(const case_reader *r) {
  char last[CASE_PATH] = "", path[CASE_PATH];
  for (int i = 0; i < r->keys.n; i++) {
    const case_key *key = &r->keys.key[i];
    if (!r->good[i] || !r->given[i]) continue;
    if (case_key_applies(key, r->file, r->file) || of_single_interface(r, key)) continue;
    if (r->file->modal_file && of_own_modes(key)) {
      whole(r, key, path);
      if (strcmp(path, last) != 0)
        case_reader_issue(r, path, "leave it out: modal.file is given, which holds what it made");
      strcpy(last, path);
    } else if (case_condition_needed(key->when) && !told(r, key)) {
      case_reader_issue(r, key->path, "%s", case_condition_needed(key->when));
    }
  }
}
