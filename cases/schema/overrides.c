#include "cases/schema/overrides.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Place of an override in messages: its line is negative, and the column is that in its text. */
static void mark(case_node *node, int line, int column) {
  node->line   = line;
  node->column = column;
  if (node->key) node->key_line = line;
  if (node->key) node->key_column = column;
  for (int i = 0; i < node->n; i++) mark(&node->child[i], line, column);
}

/* Append a null entry with this key. NULL: no memory. */
static case_node *append_entry(case_node *map, const char *key, size_t length, int line) {
  case_node *grown = realloc(map->child, (size_t)(map->n + 1) * sizeof *grown);
  if (!grown) return NULL;
  map->child       = grown;
  case_node *child = &map->child[map->n];
  *child           = (case_node){.kind = CASE_NULL, .key = strndup(key, length)};
  if (!child->key) return NULL;
  mark(child, line, 1);
  map->n++;
  return child;
}

static case_node *entry(case_node *map, const char *key, size_t length) {
  for (int i = 0; i < map->n; i++)
    if (strlen(map->child[i].key) == length && strncmp(map->child[i].key, key, length) == 0)
      return &map->child[i];
  return NULL;
}

/* One step of a path: a name in a mapping. A missing entry is added. */
static case_node *into_mapping(case_issues *issues, case_node *node, const char *text,
                               const char *name, size_t length, int line) {
  int where = (int)(name - text);
  if (node->kind == CASE_NULL) node->kind = CASE_MAPPING;
  if (length == 0) {
    case_issue_add(issues, line, where + 1, NULL,
                   "a path is made of names and dots; expected KEY=VALUE");
    return NULL;
  }
  if (node->kind != CASE_MAPPING) {
    case_issue_add(issues, line, where + 1, NULL, "'%.*s' is %s in the case, not a mapping",
                   where > 0 ? where - 1 : 0, text, case_kind_name(node->kind));
    return NULL;
  }
  case_node *found = entry(node, name, length);
  if (!found) found = append_entry(node, name, length, line);
  if (!found) case_issues_no_memory(issues);
  return found;
}

/* One step of a path: the entry [i] of a list, which must be there. at is behind the bracket. */
static case_node *into_list(case_issues *issues, case_node *node, const char *text, const char **at,
                            int line) {
  int   where = (int)(*at - text) - 1;
  char *end;
  long  index = isdigit((unsigned char)**at) ? strtol(*at, &end, 10) : -1;
  if (index < 0 || *end != ']') {
    case_issue_add(issues, line, where + 1, NULL, "expected a number from 0 and ']' after '['");
    return NULL;
  }
  *at = end + 1;
  if (node->kind != CASE_SEQUENCE) {
    case_issue_add(issues, line, where + 1, NULL, "'%.*s' is %s in the case, not a list", where,
                   text, case_kind_name(node->kind));
    return NULL;
  }
  if (index >= node->n) {
    case_issue_add(issues, line, where + 1, NULL, "'%.*s' has the entries 0 to %d in the case",
                   where, text, node->n - 1);
    return NULL;
  }
  return &node->child[index];
}

/* Length of the name at which a path goes on. It is the longest entry that is there. In a block
 * whose names are paths of another file it is the rest, else what the next dot ends. */
static size_t name_length(const case_keys keys, const case_node *node, const char *text,
                          const char *at, const char *stop) {
  size_t longest = 0;
  char   block[CASE_PATH];
  for (int i = 0; node->kind == CASE_MAPPING && i < node->n; i++) {
    const size_t n = strlen(node->child[i].key);
    if (n > longest && strncmp(at, node->child[i].key, n) == 0 && strchr(".[=", at[n])) longest = n;
  }
  case_path(block, "%.*s", at > text ? (int)(at - text) - 1 : 0, text);
  const case_key *row = case_key_find(keys, block);
  if (longest > 0) return longest;
  return row && row->type == CASE_KEYS ? (size_t)(stop - at) : strcspn(at, ".[=");
}

/* The node of a path, added if it is missing. NULL after an issue. */
static case_node *find(case_issues *issues, const case_keys keys, case_node *node, const char *text,
                       const char *stop, int line) {
  const char *at = text;
  for (bool first = true; node && at < stop; first = false) {
    if (*at == '[' && !first) {
      at++;
      node = into_list(issues, node, text, &at, line);
      continue;
    }
    if (!first && *at != '.') {
      case_issue_add(issues, line, (int)(at - text) + 1, NULL, "expected '.' or '[' or '='");
      return NULL;
    }
    if (!first) at++;
    size_t length = name_length(keys, node, text, at, stop);
    node          = into_mapping(issues, node, text, at, length, line);
    at += length;
  }
  return node;
}

/* Put the value in place of what the node holds; its key stays. */
static void replace(case_node *node, case_node *value, int line, int column) {
  case_node old = *node;
  *node         = *value;
  node->key     = old.key;
  old.key       = NULL;
  *value        = old;
  mark(node, line, column);
}

static void apply(case_issues *issues, const case_keys keys, const char *text, int line,
                  case_node *root) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text) {
    case_issue_add(issues, line, 1, NULL, "expected KEY=VALUE, such as contact.mu=0.4");
    return;
  }
  case_issues own   = case_issues_start("--set", equals + 1, strlen(equals + 1));
  case_node  *value = case_document_parse(&own);
  int         place = (int)(equals - text) + 2;
  if (own.no_memory) {
    case_issues_no_memory(issues);
  } else if (!value || own.n > 0) {
    case_issue_add(issues, line, place, NULL, "%s",
                   own.n > 0 ? own.issue[0].text : "the value is empty");
  } else {
    case_node *node = find(issues, keys, root, text, equals, line);
    if (node) replace(node, value, line, place);
  }
  case_issues_free(&own);
  case_document_free(value);
}

void case_overrides_apply(case_issues *issues, const case_overrides *o, case_node **root) {
  issues->override = o->text;
  if (o->n > 0 && !*root) *root = calloc(1, sizeof **root);
  if (o->n > 0 && !*root) case_issues_no_memory(issues);
  if (!*root) return;
  for (int i = 0; i < o->n; i++) apply(issues, o->keys, o->text[i], -1 - i, *root);
}

char *case_overrides_text(const case_overrides *o, const char *text) {
  size_t size = strlen(text) + 2;
  for (int i = 0; i < o->n; i++) size += strlen(o->text[i]) + 16;
  char *out = malloc(size);
  if (!out) return NULL;
  size_t used = (size_t)snprintf(out, size, "%s", text);
  if (o->n > 0 && used > 0 && text[used - 1] != '\n') out[used++] = '\n';
  out[used] = '\0';
  for (int i = 0; i < o->n; i++)
    used += (size_t)snprintf(out + used, size - used, "# --set %s\n", o->text[i]);
  return out;
}
