#include "cases/parse/yaml.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "mesh/table/number.h"
#include "mesh/table/text_file.h"

typedef struct {
  yaml_parser_t parser;
  case_issues  *issues;
  bool          indexed; /* indices are written <1> */
} builder;

shb_status case_text_read(const char *path, char **text, size_t *length) {
  return mesh_text_read(path, CASE_MAX_BYTES >> 20, "a case file is a page of YAML text", text,
                        length);
}

/* Line and column (from 1, in characters) of a byte offset. */
static void place_of(const case_issues *issues, size_t offset, int *line, int *column) {
  *line = *column = 1;
  for (size_t i = 0; i < offset && i < issues->length; i++) {
    unsigned char c = (unsigned char)issues->text[i];
    if (c == '\n') {
      (*line)++;
      *column = 1;
    } else if ((c & 0xC0) != 0x80) {
      (*column)++;
    }
  }
}

static char byte_at(const case_issues *issues, const yaml_mark_t *mark) {
  size_t line = 0, i = 0;
  for (; i < issues->length && line < mark->line; i++) line += issues->text[i] == '\n';
  i += mark->column;
  return i < issues->length ? issues->text[i] : '\0';
}

/* A fault of the text in plain words, by what libyaml says of it; NULL: its own are as good. */
static const char *in_plain_words(const yaml_parser_t *p) {
  static const struct {
    const char *context, *problem, *words;
  } rows[] = {
      {"flow sequence", "did not find expected ','", "the list has no ']', or an entry no ','"},
      {"flow mapping", "did not find expected ','", "the mapping has no '}', or an entry no ','"},
      {"quoted scalar", "unexpected end", "the quotation mark is not closed"},
      {"quoted scalar", "unknown escape",
       "unknown sign after \\ in \"...\"; in '...' a \\ stands for itself"},
      {"", "mapping values are not allowed",
       "no ':' can stand here; a text with ': ' needs quotation marks, and the keys of a block "
       "begin in one column"},
      {"block mapping", "did not find expected key",
       "expected a key here; the keys of a block begin in one column"},
      {"block collection", "did not find expected '-'",
       "expected '-' here; the entries of a list begin in one column"},
      {"next token", "cannot start", "no value begins with this sign; put it in quotation marks"},
      {"simple key", "could not find expected ':'", "expected 'key: value'"},
      {"node", "did not find expected node content", "a value is missing before this sign"},
      {"block scalar", "expected comment or line break",
       "nothing can follow '|' or '>' on its line"}};
  for (size_t i = 0; p->problem && i < sizeof rows / sizeof *rows; i++)
    if (strstr(p->problem, rows[i].problem) &&
        strstr(p->context ? p->context : "", rows[i].context))
      return rows[i].words;
  return NULL;
}

static void syntax_issue(builder *b) {
  const yaml_parser_t *p = &b->parser;
  int                  line, column;
  if (p->error == YAML_MEMORY_ERROR) {
    case_issues_no_memory(b->issues);
  } else if (p->error == YAML_READER_ERROR) {
    place_of(b->issues, p->problem_offset, &line, &column);
    case_issue_add(b->issues, line, column, NULL, "not UTF-8 text: %s", p->problem);
  } else if (byte_at(b->issues, &p->problem_mark) == '\t') {
    case_issue_add(b->issues, (int)p->problem_mark.line + 1, (int)p->problem_mark.column + 1, NULL,
                   "a tab; YAML indents with spaces");
  } else {
    bool        begun = p->context && p->context_mark.line != p->problem_mark.line;
    const char *words = in_plain_words(p);
    char        where[96];
    snprintf(where, sizeof where, " (begun on line %d)", (int)p->context_mark.line + 1);
    if (!words) words = p->problem ? p->problem : "syntax error";
    case_issue_add(b->issues, (int)p->problem_mark.line + 1, (int)p->problem_mark.column + 1, NULL,
                   "not valid YAML: %s%s", words, begun ? where : "");
  }
}

static bool next_event(builder *b, yaml_event_t *event) {
  if (yaml_parser_parse(&b->parser, event)) return true;
  syntax_issue(b);
  return false;
}

static void node_clear(case_node *node) {
  for (int i = 0; i < node->n; i++) node_clear(&node->child[i]);
  free(node->child);
  free(node->text);
  free(node->key);
  *node = (case_node){0};
}

/* Adds an entry. NULL with an issue recorded if there are too many or there is no memory. */
static case_node *add_child(builder *b, case_node *parent) {
  bool many = parent->n >= CASE_MAX_ENTRIES;
  if (!many && (parent->n & (parent->n - 1)) == 0) { /* the array is full at 0, 1, 2, 4, 8, ... */
    int        capacity = parent->n ? 2 * parent->n : 1;
    case_node *grown    = realloc(parent->child, (size_t)capacity * sizeof *grown);
    if (grown) parent->child = grown;
    if (!grown) {
      case_issues_no_memory(b->issues);
      return NULL;
    }
  }
  if (many) {
    case_issue_add(b->issues, parent->line, parent->column, NULL, "more than %d entries",
                   CASE_MAX_ENTRIES);
    return NULL;
  }
  case_node *child = &parent->child[parent->n++];
  *child           = (case_node){0};
  return child;
}

static bool is_null(const yaml_event_t *event) {
  const char *text = (const char *)event->data.scalar.value;
  if (event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE) return false;
  return text[0] == '\0' || strcmp(text, "~") == 0 || strcmp(text, "null") == 0;
}

static bool has_tag(const yaml_event_t *event) {
  if (event->type == YAML_SCALAR_EVENT) return event->data.scalar.tag != NULL;
  if (event->type == YAML_SEQUENCE_START_EVENT) return event->data.sequence_start.tag != NULL;
  return event->type == YAML_MAPPING_START_EVENT && event->data.mapping_start.tag != NULL;
}

static bool build(builder *b, const yaml_event_t *event, const char *path, int depth,
                  case_node *out);

/* Does a scalar stand at this place, a character behind another one? Columns count characters,
 * which are bytes in a number. */
static bool is_adjacent(const case_node *value, int line, int column) {
  return value->kind == CASE_SCALAR && line == value->line &&
         column == value->column + (int)strlen(value->text) + 1;
}

/* Is the value the whole part of 0,05, and text at this place the rest? */
static bool is_cut(const case_node *value, const char *text, int line, int column) {
  return is_adjacent(value, line, column) && mesh_text_is_whole(value->text) &&
         isdigit((unsigned char)text[0]) && !strchr(text, '.');
}

static void refuse_cut(builder *b, const char *path, const case_node *value, const char *rest,
                       const char *or_else) {
  case_issue_add(b->issues, value->line, value->column, path,
                 "%.40s,%.40s has a decimal comma; write %.40s.%.40s%s", value->text, rest,
                 value->text, rest, or_else);
}

/* Decimals with a comma make two values each: [0,2, 0,4] has four. They are told where other commas
 * of the list have a blank behind them, or where a value begins with a zero, as in 0,05. Without
 * any blank they are told where all values are such pairs, and do not ascend as a list does. */
static void refuse_decimal_comma(builder *b, const char *path, case_node *list) {
  const case_node *value = list->child;
  int              found = -1;
  bool             told = false, pairs = list->n >= 4 && list->n % 2 == 0, ascends = true;
  for (int i = 0; i + 1 < list->n; i++) {
    const case_node *next = &value[i + 1];
    const bool       both = value[i].kind == CASE_SCALAR && next->kind == CASE_SCALAR;
    const bool       near = both && is_adjacent(&value[i], next->line, next->column);
    const bool       cut  = both && is_cut(&value[i], next->text, next->line, next->column);
    if (cut && found < 0) found = i;
    told  = told || !near || (cut && next->text[0] == '0' && isdigit((unsigned char)next->text[1]));
    pairs = pairs && (i % 2 == 1 || cut);
    ascends = ascends && both && strtod(value[i].text, NULL) <= strtod(next->text, NULL);
  }
  if (found < 0 || !(told || (pairs && !ascends))) return;
  refuse_cut(b, path, &value[found], value[found + 1].text,
             ", or a blank behind every comma of the list");
  list->kind = CASE_BROKEN;
}

static bool build_sequence(builder *b, const char *path, int depth, case_node *out) {
  for (;;) {
    yaml_event_t event;
    if (!next_event(b, &event)) return false;
    bool done = event.type == YAML_SEQUENCE_END_EVENT, good = true;
    if (!done) {
      char inner[CASE_PATH];
      case_path(inner, "%s[%d]", path, out->n);
      case_node *child = add_child(b, out);
      good             = child && build(b, &event, inner, depth + 1, child);
    }
    yaml_event_delete(&event);
    if (done || !good) return good;
  }
}

/* {from: 0,5, to: 1} has a key 5 without a value behind the 0. */
static bool is_rest(const case_node *map, const case_node *child, const case_node *key) {
  return map->n > 1 && child->kind == CASE_NULL && key->text &&
         is_cut(child - 1, key->text, key->line, key->column);
}

static void refuse_rest(builder *b, case_node *map, const case_node *key, const char *path) {
  case_node *whole = &map->child[map->n - 2];
  char       entry[CASE_PATH];
  case_path(entry, "%.*s%s", (int)(strlen(path) - strlen(key->text)), path, whole->key);
  refuse_cut(b, entry, whole, key->text, "");
  whole->kind = CASE_BROKEN;
  node_clear(&map->child[--map->n]);
}

/* Stores the key of an entry in child->key, and drops an entry that is not allowed. */
static void settle_entry(builder *b, case_node *map, case_node *key, const char *path) {
  case_node *child = &map->child[map->n - 1];
  if (is_rest(map, child, key)) {
    refuse_rest(b, map, key, path);
    return;
  }
  child->key_line   = key->line;
  child->key_column = key->column;
  child->key        = key->text;
  key->text         = NULL;
  bool keep         = child->key != NULL;
  child->key_hash   = keep ? case_hash(child->key) : 0;
  if (!keep && key->kind != CASE_BROKEN)
    case_issue_add(b->issues, key->line, key->column, path, "a key must be a word, not %s",
                   case_kind_name(key->kind));
  for (int i = 0; keep && i < map->n - 1; i++) {
    const case_node *other = &map->child[i];
    if (other->key_hash != child->key_hash || strcmp(other->key, child->key) != 0) continue;
    case_issue_add(b->issues, key->line, key->column, path, "given twice; first on line %d",
                   other->key_line);
    keep = false;
  }
  if (!keep) {
    node_clear(child);
    map->n--;
  }
}

static bool build_entry(builder *b, const yaml_event_t *key_event, const char *path, int depth,
                        case_node *out) {
  case_node key = {0};
  if (!build(b, key_event, path, depth + 1, &key)) {
    node_clear(&key);
    return false;
  }
  char inner[CASE_PATH];
  case_path(inner, "%s%s%s", path, path[0] ? "." : "", key.text ? key.text : "?");
  yaml_event_t event;
  bool         good = next_event(b, &event);
  if (good) {
    case_node *child = add_child(b, out);
    good             = child && build(b, &event, inner, depth + 1, child);
    yaml_event_delete(&event);
  }
  if (good) settle_entry(b, out, &key, inner);
  node_clear(&key);
  return good;
}

static bool build_mapping(builder *b, const char *path, int depth, case_node *out) {
  for (;;) {
    yaml_event_t event;
    if (!next_event(b, &event)) return false;
    bool done = event.type == YAML_MAPPING_END_EVENT, good = true;
    if (!done) good = build_entry(b, &event, path, depth, out);
    yaml_event_delete(&event);
    if (done || !good) return good;
  }
}

/* Rewrite the brackets of every index behind a word, such as modes[1], to other ones. In a flow
 * list YAML ends a word at '[', so indices are parsed as modes<1>. Places stay what they are. */
static void set_index_brackets(char *text, const char from[2], const char to[2]) {
  for (char *at = text; (at = strchr(at, from[0])); at++) {
    size_t digits = strspn(at + 1, "0123456789");
    bool   word   = at > text && (isalnum((unsigned char)at[-1]) || at[-1] == '_');
    if (!word || digits == 0 || at[digits + 1] != from[1]) continue;
    at[0]          = to[0];
    at[digits + 1] = to[1];
  }
}

static bool build_scalar(builder *b, const yaml_event_t *event, const char *path, case_node *out) {
  if (strlen((const char *)event->data.scalar.value) != event->data.scalar.length) {
    out->kind = CASE_BROKEN;
    case_issue_add(b->issues, out->line, out->column, path,
                   "holds the character \\0, which ends text");
    return true;
  }
  out->kind = is_null(event) ? CASE_NULL : CASE_SCALAR;
  out->text = strdup((const char *)event->data.scalar.value);
  if (out->text && b->indexed) set_index_brackets(out->text, "<>", "[]");
  if (!out->text) case_issues_no_memory(b->issues);
  return out->text != NULL;
}

static bool build(builder *b, const yaml_event_t *event, const char *path, int depth,
                  case_node *out) {
  out->line   = (int)event->start_mark.line + 1;
  out->column = (int)event->start_mark.column + 1;
  if (depth > CASE_MAX_DEPTH) {
    case_issue_add(b->issues, out->line, out->column, path, "nested more than %d deep",
                   CASE_MAX_DEPTH);
    return false;
  }
  if (has_tag(event))
    case_issue_add(b->issues, out->line, out->column, path, "tags (!...) are not supported");
  switch (event->type) {
    case YAML_SCALAR_EVENT:
      return build_scalar(b, event, path, out);
    case YAML_SEQUENCE_START_EVENT:
      out->kind = CASE_SEQUENCE;
      if (!build_sequence(b, path, depth, out)) return false;
      refuse_decimal_comma(b, path, out);
      return true;
    case YAML_MAPPING_START_EVENT:
      out->kind = CASE_MAPPING;
      return build_mapping(b, path, depth, out);
    default:
      out->kind = CASE_BROKEN;
      case_issue_add(b->issues, out->line, out->column, path,
                     "aliases (*name) are not supported; write the value out");
      return true;
  }
}

/* Skips the starts of stream and document. False at the end of the stream or after an issue. */
static bool first_event(builder *b, yaml_event_t *event) {
  while (next_event(b, event)) {
    if (event->type != YAML_STREAM_START_EVENT && event->type != YAML_DOCUMENT_START_EVENT &&
        event->type != YAML_STREAM_END_EVENT)
      return true;
    bool end = event->type == YAML_STREAM_END_EVENT;
    yaml_event_delete(event);
    if (end) return false;
  }
  return false;
}

/* Refuses anything after the document. */
static bool expect_end(builder *b) {
  yaml_event_t event;
  for (bool end = false; !end;) {
    if (!next_event(b, &event)) return false;
    bool again = event.type == YAML_DOCUMENT_START_EVENT;
    if (again)
      case_issue_add(b->issues, (int)event.start_mark.line + 1, (int)event.start_mark.column + 1,
                     NULL, "a second document begins here; one file holds one case");
    end = again || event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
    if (again) return false;
  }
  return true;
}

case_node *case_document_parse(case_issues *issues) {
  builder b    = {.issues = issues, .indexed = !memchr(issues->text, '<', issues->length)};
  char   *text = calloc(issues->length + 1, 1);
  if (!text || !yaml_parser_initialize(&b.parser)) {
    free(text);
    case_issues_no_memory(issues);
    return NULL;
  }
  memcpy(text, issues->text, issues->length);
  if (b.indexed) set_index_brackets(text, "[]", "<>");
  yaml_parser_set_input_string(&b.parser, (const unsigned char *)text, issues->length);
  case_node   *root = NULL;
  yaml_event_t event;
  if (first_event(&b, &event)) {
    root = calloc(1, sizeof *root);
    if (!root) case_issues_no_memory(issues);
    bool good = root && build(&b, &event, "", 0, root) && expect_end(&b);
    yaml_event_delete(&event);
    if (!good) {
      case_document_free(root);
      root = NULL;
    }
  }
  yaml_parser_delete(&b.parser);
  free(text);
  return root;
}

static bool is_plain(const char *text) {
  static const char plain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./%+- ";
  return isalnum((unsigned char)text[0]) && text[strspn(text, plain)] == '\0' &&
         strcmp(text, "null") != 0;
}

/* The entries of "[a, b]", whose copy is cut at its commas. */
static bool plain_list(case_plain *out) {
  char *end = strchr(out->text, ']'), *rest = out->text + 1;
  if (!end || end[1]) return false;
  *end            = '\0';
  out->value.kind = CASE_SEQUENCE;
  for (char *one; (one = strsep(&rest, ","));) {
    one += strspn(one, " ");
    if (out->value.n == CASE_PLAIN_ENTRIES || !is_plain(one)) return false;
    out->entry[out->value.n++] = (case_node){.kind = CASE_SCALAR, .text = one};
  }
  out->value.child = out->entry;
  return true;
}

bool case_plain_value(const char *text, case_plain *out) {
  const size_t length = strlen(text);
  if (length >= sizeof out->text) return false;
  memcpy(out->text, text, length + 1);
  out->value = (case_node){.kind = CASE_SCALAR, .line = 1, .column = 1};
  if (text[0] == '[') return plain_list(out);
  out->value.text = out->text;
  if (strcmp(text, "{}") == 0) out->value = (case_node){.kind = CASE_MAPPING, 1, 1};
  return out->value.kind == CASE_MAPPING || is_plain(text);
}

void case_document_free(case_node *root) {
  if (!root) return;
  node_clear(root);
  free(root);
}

uint64_t case_hash(const char *text) {
  uint64_t hash = 14695981039346656037u;
  for (const unsigned char *at = (const unsigned char *)text; *at; at++)
    hash = (hash ^ *at) * 1099511628211u;
  return hash;
}

const char *case_kind_name(case_kind kind) {
  static const char *const names[] = {"nothing", "a single value", "a list", "a mapping",
                                      "something broken"};
  return names[kind];
}

void case_path(char path[CASE_PATH], const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(path, CASE_PATH, format, args);
  va_end(args);
}

const case_node *case_node_find(const case_node *mapping, const char *key) {
  for (int i = 0; mapping && mapping->kind == CASE_MAPPING && i < mapping->n; i++)
    if (strcmp(mapping->child[i].key, key) == 0) return &mapping->child[i];
  return NULL;
}

const case_node *case_node_at(const case_node *root, const char *path) {
  const case_node *node = root;
  for (const char *at = path; node && *at;) {
    at += *at == '.';
    if (*at == '[') {
      char      *end;
      const long i  = strtol(at + 1, &end, 10);
      const bool is = *end == ']' && node->kind == CASE_SEQUENCE && i >= 0 && i < node->n;
      node          = is ? &node->child[i] : NULL;
      at            = *end ? end + 1 : end;
    } else {
      char key[CASE_PATH];
      case_path(key, "%.*s", (int)strcspn(at, ".["), at);
      node = case_node_find(node, key);
      at += strlen(key);
    }
  }
  return node;
}
