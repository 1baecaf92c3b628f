#include "cases/parse/reader.h"

#include <assert.h>
#include <stdarg.h>
#include <string.h>

#include "cases/parse/key_table.h"
#include "cases/parse/value.h"
#include "cases/parse/value_context.h"

/* Open addressing: the slot of a path, or the empty one where it would be. */
static int slot_of(const case_reader *r, const char *path) {
  int at = (int)(case_hash(path) % CASE_KEY_SLOTS);
  while (r->slot[at] && strcmp(r->keys.key[r->slot[at] - 1].path, path) != 0)
    at = (at + 1) % CASE_KEY_SLOTS;
  return at;
}

static void index_rows(case_reader *r) {
  for (int i = 0; i < r->keys.n; i++) {
    short *slot = &r->slot[slot_of(r, r->keys.key[i].path)];
    if (!*slot) *slot = (short)(i + 1);
  }
}

static int index_of(const case_reader *r, const char *path) {
  return r->slot[slot_of(r, path)] - 1;
}

/* The row of a path; of one with indices that of its list. */
static int list_of(const case_reader *r, const char *path) {
  char list[CASE_PATH];
  case_path(list, "%.*s", (int)strcspn(path, "["), path);
  return index_of(r, list);
}

static const case_block *find_block(const case_reader *r, const char *path) {
  for (int i = 0; i < r->n_blocks; i++)
    if (strcmp(r->block[i].path, path) == 0) return &r->block[i];
  return NULL;
}

const case_node *case_reader_given(const case_reader *r, const char *path) {
  const int i = list_of(r, path);
  if (i >= 0) return case_node_at(r->given[i], path + strcspn(path, "["));
  return NULL;
}

bool case_reader_good(const case_reader *r, const char *path) {
  const int i = list_of(r, path);
  return i >= 0 && r->good[i];
}

bool case_reader_has_block(const case_reader *r, const char *path) {
  return find_block(r, path) != NULL;
}

/* Cuts the last part off a path. False at the top. */
static bool parent_of(char *path) {
  char *dot = strrchr(path, '.');
  if (dot) *dot = '\0';
  if (!dot) path[0] = '\0';
  return dot != NULL;
}

void case_reader_issue(const case_reader *r, const char *path, const char *format, ...) {
  char    text[1024], around[CASE_PATH];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  int line = 0, column = 0;
  case_path(around, "%s", path);
  while (line == 0 && around[0]) {
    const case_node *node = case_reader_given(r, around);
    if (node && (strchr(around, '[') || strcmp(around, path) == 0)) {
      line   = node->line;
      column = node->column;
      break;
    }
    const case_block *block = find_block(r, around);
    if (block && block->node->key_line != 0) {
      line   = block->node->key_line;
      column = block->node->key_column;
    }
    if (!parent_of(around)) break;
  }
  case_issue_add(r->issues, line ? line : 1, line ? column : 1, path, "%s", text);
}

/* A default is in order: without a value there is no memory. */
static void read_default(case_reader *r, const case_key *key, char *base) {
  case_issues none = case_issues_start("default", key->fallback, strlen(key->fallback));
  case_plain  plain;
  bool        simple = case_plain_value(key->fallback, &plain);
  case_node  *parsed = simple ? NULL : case_document_parse(&none);
  case_node  *node   = simple ? &plain.value : parsed;
  bool        good = node && case_value_read(&none, key, key->path, node, r->file, base + key->at);
  if (!good) case_issues_no_memory(r->issues);
  case_document_free(parsed);
  case_issues_free(&none);
}

static bool is_section_row(const case_key *key) {
  return strstr(key->path, "[].") != NULL;
}

static void walk(case_reader *r, const case_node *map, const char *path);

static void refuse_key(case_reader *r, const char *block, const char *path, const case_node *node) {
  char hint[512] = "";
  if (node->kind == CASE_NULL && node->key[0] >= '0' && node->key[0] <= '9') { /* {E: 2,1 GPa} */
    case_issue_add(r->issues, node->key_line, node->key_column, block,
                   "a number where a key belongs; write decimals with a point, such as 2.1");
    return;
  }
  if (r->issues->n < 2 * CASE_ISSUES_SHOWN) /* a search for each of thousands would take seconds */
    case_key_suggest(r->keys, block, node->key, hint, sizeof hint);
  case_issue_add(r->issues, node->key_line, node->key_column, path, "unknown key%s", hint);
}

/* Reads the keys of an element, or of a block in it, whose rows begin with prefix. */
static void read_members(case_reader *r, const char *prefix, const case_node *node,
                         const char *path, char *base) {
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             row[CASE_PATH], full[CASE_PATH];
    case_path(row, "%s.%s", prefix, child->key);
    case_path(full, "%s.%s", path, child->key);
    const int       index = index_of(r, row);
    const case_key *key   = index >= 0 ? &r->keys.key[index] : NULL;
    bool            block = !key && case_key_is_block(r->keys, row);
    if (key) {
      case_value_read(r->issues, key, full, child, r->file, base + key->at);
    } else if (block && child->kind == CASE_MAPPING) {
      read_members(r, row, child, full, base);
    } else if (block && child->kind != CASE_BROKEN) {
      case_issue_add(r->issues, child->line, child->column, full, "is %s; expected a mapping",
                     case_kind_name(child->kind));
    } else if (!block) {
      refuse_key(r, prefix, full, child);
    }
  }
}

/* Reads one element of a list of mappings, whose rows are "LIST[].KEY". */
static void read_element(case_reader *r, const case_key *list, const case_node *node,
                         const char *path, char *base) {
  char prefix[CASE_PATH];
  case_path(prefix, "%s[]", list->path);
  for (int i = 0; i < r->keys.n; i++)
    if (case_key_in_list(r->keys.key[i].path, list->path) && r->keys.key[i].fallback)
      read_default(r, &r->keys.key[i], base);
  read_members(r, prefix, node, path, base);
}

/* The shape of an element for messages, e.g. "{radius, chord}". */
static void list_shape(const case_reader *r, const case_key *list, char *text, size_t size) {
  char last[CASE_PATH] = "", part[CASE_PATH];
  for (int i = 0; i < r->keys.n; i++) {
    const char *rest = case_key_in_list(r->keys.key[i].path, list->path);
    if (!rest) continue;
    case_path(part, "%.*s", (int)strcspn(rest, "."), rest);
    if (strcmp(part, last) == 0) continue;
    case_append(text, size, "%s%s", last[0] ? ", " : "{", part);
    strcpy(last, part);
  }
  case_append(text, size, "}");
}

static void read_list(case_reader *r, const case_key *key, const char *path,
                      const case_node *node) {
  if (node->kind != CASE_SEQUENCE) {
    char shape[256] = "";
    list_shape(r, key, shape, sizeof shape);
    if (node->kind != CASE_BROKEN)
      case_issue_add(r->issues, node->line, node->column, path, "is %s; expected a list of %s",
                     case_kind_name(node->kind), shape);
    return;
  }
  if (node->n < (int)key->least || node->n > (int)key->most) {
    const char *leaf = case_key_leaf(path); /* a plural noun */
    int         n    = (int)strlen(leaf) - (node->n == 1);
    case_issue_add(r->issues, node->line, node->column, path, "has %d %.*s, must have %g to %g",
                   node->n, n, leaf, key->least, key->most);
    return;
  }
  *(int *)((char *)r->file + key->count_at) = node->n;
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             full[CASE_PATH];
    case_path(full, "%s[%d]", path, i);
    if (child->kind == CASE_MAPPING) {
      read_element(r, key, child, full, (char *)r->file + key->at + (size_t)i * key->each);
    } else if (child->kind != CASE_BROKEN) {
      case_issue_add(r->issues, child->line, child->column, full, "is %s; expected a mapping",
                     case_kind_name(child->kind));
    }
  }
}

static void read_key(case_reader *r, int index, const char *path, const case_node *node) {
  const case_key *key    = &r->keys.key[index];
  int             before = r->issues->n;
  r->given[index]        = node;
  if (key->type == CASE_LIST) {
    read_list(r, key, path, node);
  } else {
    case_value_read(r->issues, key, path, node, r->file, (char *)r->file + key->at);
  }
  r->good[index] = node->kind != CASE_BROKEN && r->issues->n == before;
}

static void read_block(case_reader *r, const char *path, const case_node *node) {
  if (node->kind != CASE_MAPPING) {
    char known[512];
    case_key_suggest(r->keys, path, "", known, sizeof known);
    if (node->kind != CASE_BROKEN)
      case_issue_add(r->issues, node->line, node->column, path, "is %s; expected a mapping%s",
                     case_kind_name(node->kind), known);
  }
  if (r->n_blocks < CASE_MAX_BLOCKS) {
    case_block *block = &r->block[r->n_blocks++];
    case_path(block->path, "%s", path);
    block->node = node;
  }
  if (node->kind == CASE_MAPPING) walk(r, node, path);
}

/* An unknown key. If it resembles a known key, its value is read as that key's. The known key is
 * then not reported as missing. */
static void read_unknown(case_reader *r, const char *path, const case_node *node,
                         const char *full) {
  char meant[CASE_LONGEST_WORD], right[CASE_PATH];
  refuse_key(r, path, full, node);
  if (!case_key_nearest(r->keys, path, node->key, meant)) return;
  case_path(right, "%s%s%s", path, path[0] ? "." : "", meant);
  int index = index_of(r, right);
  if (index >= 0 && !r->given[index]) {
    /* the name of a file decides which other keys are required */
    if (r->keys.key[index].type == CASE_FILE_NAME) read_key(r, index, right, node);
    r->given[index] = node;
    r->good[index]  = false;
  } else if (index < 0 && node->kind == CASE_MAPPING && !find_block(r, right)) {
    read_block(r, right, node);
  }
}

static void walk(case_reader *r, const case_node *map, const char *path) {
  for (int i = 0; i < map->n; i++) {
    const case_node *child = &map->child[i];
    char             full[CASE_PATH];
    /* "contact.mu: 1" at the top is not a block */
    bool plain = child->key[0] && !strpbrk(child->key, ".[");
    case_path(full, "%s%s%s", path, path[0] ? "." : "", child->key);
    int index = plain ? index_of(r, full) : -1;
    if (index >= 0) {
      read_key(r, index, full, child);
    } else if (plain && case_key_is_block(r->keys, full)) {
      read_block(r, full, child);
    } else {
      read_unknown(r, path, child, full);
    }
  }
}

void case_reader_walk(case_reader *r, const case_node *root) {
  assert(r->keys.n <= CASE_MAX_KEYS);
  index_rows(r);
  for (int i = 0; i < r->keys.n; i++) {
    const case_key *key = &r->keys.key[i];
    if (!key->fallback || is_section_row(key)) continue;
    read_default(r, key, (char *)r->file);
    r->good[i] = true;
  }
  if (root && root->kind == CASE_MAPPING) {
    walk(r, root, "");
  } else if (!root || root->kind == CASE_NULL) {
    case_issue_add(r->issues, 1, 1, NULL, "the file is empty");
  } else if (root->kind != CASE_BROKEN) {
    case_issue_add(r->issues, root->line, root->column, NULL,
                   "the file holds %s, not a mapping of keys", case_kind_name(root->kind));
  }
}

/* Modes alone need no damping and no load. They need the number of blades only for contact to the
 * neighbour, or to make the blade. */
static bool is_spared(const case_reader *r, const case_key *key, int stages) {
  bool sector = strcmp(key->path, "rotor.blades") == 0 &&
                (find_block(r, "mesh.blade") || find_block(r, "contact"));
  return key->spare && !(stages & CASE_MHB) && !sector;
}

static bool is_missing(const case_reader *r, int index, int stages) {
  const case_key *key = &r->keys.key[index];
  /* case_check_alternatives reports that both mesh.blade and mesh.file are missing */
  bool told = key->when == CASE_IF_BLADE && !find_block(r, "mesh.blade");
  return key->required && (key->stages & stages) && !r->given[index] && !is_section_row(key) &&
         !told && !is_spared(r, key, stages) && case_key_applies(key, r->file, r->file);
}

/* The outermost block around key that is not in the file. False if the block of the key is there.
 * broken: the block is there but not a mapping, which has its own message. */
static bool missing_block(const case_reader *r, const case_key *key, char block[CASE_PATH],
                          bool *broken) {
  char path[CASE_PATH];
  bool missing = false;
  *broken      = false;
  case_path(path, "%s", key->path);
  while (parent_of(path)) {
    const case_block *found = find_block(r, path);
    if (found) {
      *broken = found->node->kind != CASE_MAPPING;
      return missing;
    }
    missing = true;
    strcpy(block, path);
  }
  return missing;
}

static void require_block(case_reader *r, const char *block, int stages) {
  char text[512] = "";
  for (int i = 0, n = 0; i < r->keys.n; i++) {
    char path[CASE_PATH];
    bool broken;
    if (!is_missing(r, i, stages) || !missing_block(r, &r->keys.key[i], path, &broken)) continue;
    if (strcmp(path, block) != 0) continue;
    const case_key *key = &r->keys.key[i];
    case_append(text, sizeof text, "%s%s%s%s", n++ ? ", " : "", key->path + strlen(block) + 1,
                key->instead ? " or " : "", key->instead ? key->instead : "");
  }
  case_reader_issue(r, block, "missing; expected a mapping with %s", text);
}

/* Is there, in a mapping, a key that was probably meant to be leaf? It has its own message. */
static bool has_misspelt(const case_reader *r, const char *block, const case_node *map,
                         const char *leaf) {
  char meant[CASE_LONGEST_WORD];
  for (int i = 0; map && i < map->n; i++) {
    const char *word  = map->child[i].key;
    bool        known = false;
    for (int k = 0; k < r->keys.n; k++)
      known = known || strcmp(case_key_leaf(r->keys.key[k].path), word) == 0;
    if (!known && case_key_nearest(r->keys, block, word, meant) && strcmp(meant, leaf) == 0)
      return true;
  }
  return false;
}

static void missing(case_reader *r, const case_key *key, const char *path) {
  char expected[256];
  case_value_expected(key, expected, sizeof expected);
  case_reader_issue(r, path, "missing; expected %s%s%s", expected, key->instead ? ", or " : "",
                    key->instead ? key->instead : "");
}

/* The required keys of every element of a list. */
static void require_elements(case_reader *r, int index, int stages) {
  const case_key  *list = &r->keys.key[index];
  const case_node *node = r->given[index];
  if (!node || node->kind != CASE_SEQUENCE || node->n > (int)list->most ||
      !case_key_applies(list, r->file, r->file))
    return;
  const int   n    = node->n;
  const char *base = (const char *)r->file + list->at;
  for (int i = 0; i < n * r->keys.n; i++) {
    const case_key  *key     = &r->keys.key[i % r->keys.n];
    const case_node *element = &node->child[i / r->keys.n];
    const char      *rest    = case_key_in_list(key->path, list->path);
    char             path[CASE_PATH], block[CASE_PATH];
    if (!rest || !key->required || !(key->stages & stages) || element->kind != CASE_MAPPING ||
        !case_key_applies(key, r->file, base + (size_t)(i / r->keys.n) * list->each))
      continue;
    case_path(block, "%.*s", (int)(case_key_leaf(key->path) - key->path - 1), key->path);
    if (case_node_at(element, rest) || has_misspelt(r, block, element, rest)) continue;
    case_path(path, "%s[%d].%s", list->path, i / r->keys.n, rest);
    missing(r, key, path);
    r->good[index] = false;
  }
}

void case_reader_require(case_reader *r, int stages) {
  char last[CASE_PATH] = "";
  for (int i = 0; i < r->keys.n; i++) {
    const case_key *key = &r->keys.key[i];
    char            block[CASE_PATH];
    bool            broken;
    if (key->type == CASE_LIST) require_elements(r, i, stages);
    if (!is_missing(r, i, stages)) continue;
    bool whole = missing_block(r, key, block, &broken);
    if (broken) continue;
    if (!whole) {
      missing(r, key, key->path);
    } else if (strcmp(block, last) != 0) {
      require_block(r, block, stages);
      strcpy(last, block);
    }
  }
}

/* ---------------------------------------------------------------- one or many */

case_place case_reader_place(case_reader *r, const char *list, const char *block, int index) {
  case_place p = {.reader = r};
  if (case_reader_given(r, list))
    case_path(p.path, "%s[%d]", list, index);
  else
    case_path(p.path, "%s", block);
  return p;
}

static void below(const case_place *p, const char *leaf, char path[CASE_PATH]) {
  case_path(path, "%s%s%s", p->path, leaf[0] ? "." : "", leaf);
}

const case_node *case_place_given(const case_place *p, const char *leaf) {
  char path[CASE_PATH];
  below(p, leaf, path);
  const case_node  *node  = case_reader_given(p->reader, path);
  const case_block *block = node ? NULL : find_block(p->reader, path);
  return block ? block->node : node;
}

bool case_place_good(const case_place *p, const char *leaf) {
  char path[CASE_PATH];
  below(p, leaf, path);
  return case_reader_good(p->reader, path);
}

void case_place_issue(const case_place *p, const char *leaf, const char *format, ...) {
  char    path[CASE_PATH], text[1024];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  below(p, leaf, path);
  case_reader_issue(p->reader, path, "%s", text);
}
