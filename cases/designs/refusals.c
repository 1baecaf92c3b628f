#include "cases/designs/refusals.h"

#include <stdio.h>
#include <string.h>

void refusal_line(const char *messages, const char *case_path, char *out, size_t size) {
  size_t n = strlen(case_path);
  if (strncmp(messages, case_path, n) == 0 && messages[n] == ':') messages += n + 1;
  const char *error = strstr(messages, "error: ");
  if (error) messages = error + strlen("error: ");
  snprintf(out, size, "%.*s", (int)strcspn(messages, "\n"), messages);
}

/* Whether text begins with a path, and goes on as a key inside of it or behind it. */
static bool begins_with(const char *text, const char *path) {
  size_t n = strlen(path);
  return strncmp(text, path, n) == 0 && strchr("=:[.", text[n]) != NULL;
}

/* The varied key of which a message speaks; -1: none. The reader of a case names the --set that
 * sets it. Else the line begins with its path, or with that of the list of which it is an entry. */
static int key_at_fault(const study_keys *keys, const char *messages, const char *line,
                        const char *case_path) {
  static const char set[] = ": --set ";
  size_t            n     = strlen(case_path);
  bool              is_set =
      strncmp(messages, case_path, n) == 0 && strncmp(messages + n, set, sizeof set - 1) == 0;
  const char *named = is_set ? messages + n + sizeof set - 1 : line;
  for (int k = 0; k < keys->n; k++)
    if (begins_with(named, keys->key[k].path)) return k;
  size_t length = strcspn(line, ":");
  for (int k = 0; k < keys->n; k++) {
    const char *path = keys->key[k].path;
    if (length > 0 && strncmp(line, path, length) == 0 && (path[length] == '[' || !path[length]))
      return k;
  }
  return -1;
}

void refusals_take(refusals *r, const study_keys *keys, int design, const char *messages,
                   const char *case_path) {
  char line[REFUSAL_TEXT];
  refusal_line(messages, case_path, line, sizeof line);
  int key = key_at_fault(keys, messages, line, case_path), i = 0;
  r->n_designs++;
  while (i < r->n && (r->told[i].key != key || (key < 0 && strcmp(r->told[i].text, line) != 0)))
    i++;
  if (i == REFUSALS_TOLD) return;
  if (i == r->n) {
    r->told[r->n++] = (refusal){.key = key, .design = design};
    memcpy(r->told[i].text, line, sizeof line);
  }
  r->told[i].n++;
}

/* Where a key has its value: in the list, or else the range or distribution. */
static const case_node *place_of(const case_node *root, const study_key *key, double value,
                                 const case_node *at) {
  const case_node *block = case_node_find(root, key->is_uncertain ? "uncertain" : "vary");
  const case_node *node  = block ? case_node_find(block, key->path) : NULL;
  for (int i = 0; node && node->kind == CASE_SEQUENCE && i < key->n && i < node->n; i++)
    if (key->value[i] == value) return &node->child[i];
  return node ? node : at;
}

void refusals_report(const refusals *r, const study_keys *keys, const double *design,
                     const case_node *root, const case_node *at, case_issues *issues) {
  int told = 0;
  for (int i = 0; i < r->n; i++) {
    const refusal   *one     = &r->told[i];
    const case_node *node    = at;
    char             all[64] = "";
    if (one->key >= 0)
      node = place_of(root, &keys->key[one->key], design[one->design * keys->n + one->key], at);
    if (one->n > 1) snprintf(all, sizeof all, " (%d designs in all)", one->n);
    case_issue_add(issues, node->line, node->column, NULL, "design %d: %s%s", one->design + 1,
                   one->text, all);
    told += one->n;
  }
  if (told < r->n_designs)
    case_issue_add(issues, at->line, at->column, NULL, "%d designs are refused in all",
                   r->n_designs);
}
