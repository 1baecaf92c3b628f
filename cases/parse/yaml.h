/* A YAML document as a tree of nodes with their places. One document a file; no aliases, no
 * tags. */
#ifndef CASES_PARSE_YAML_H
#define CASES_PARSE_YAML_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cases/parse/diagnostics.h"
#include "mesh/base/status.h"

enum { CASE_MAX_BYTES = 1 << 20, CASE_MAX_DEPTH = 16, CASE_MAX_ENTRIES = 4096, CASE_PATH = 256 };

typedef enum {
  CASE_NULL, /* no value, ~ or null */
  CASE_SCALAR,
  CASE_SEQUENCE,
  CASE_MAPPING,
  CASE_BROKEN /* an issue has been recorded; no further one is needed */
} case_kind;

typedef struct case_node case_node;
struct case_node {
  case_kind  kind;
  int        line, column; /* of the value's first character, from 1; columns count characters */
  char      *key;          /* in a mapping; else NULL */
  uint64_t   key_hash;     /* of a key that the file holds: case_hash */
  int        key_line, key_column; /* of the key */
  char      *text;                 /* scalar */
  int        n;                    /* entries of a sequence or mapping */
  case_node *child;                /* [n], in the order of the file */
};

/* mesh_text_read of a case file, which has CASE_MAX_BYTES at most. */
shb_status case_text_read(const char *path, char **text, size_t *length);

/* Parse issues->text. NULL for a file without content, and after a syntax error, which is recorded.
 * A key given twice is recorded, and its first value is used. */
case_node *case_document_parse(case_issues *issues);
void       case_document_free(case_node *root);

/* A value that needs no parser: nodes and their text. */
enum { CASE_PLAIN_ENTRIES = 4, CASE_PLAIN_TEXT = 64 };
typedef struct {
  case_node value; /* borrows what follows */
  case_node entry[CASE_PLAIN_ENTRIES];
  char      text[CASE_PLAIN_TEXT];
} case_plain;

/* A text of letters, digits, spaces and _ . / % + -, a short list of such texts, or the mapping {},
 * as the node that YAML makes of it, without the places of the entries. False for other texts. */
bool case_plain_value(const char *text, case_plain *out);

/* FNV-1a of a string (Fowler, Noll, Vo). */
uint64_t case_hash(const char *text);

/* "a mapping", "a list", ... for messages */
const char *case_kind_name(case_kind kind);

/* Print the path of a key, e.g. "contact.n0[2]". A path longer than any that exists is cut. */
void case_path(char path[CASE_PATH], const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Entry of a mapping, or NULL. */
const case_node *case_node_find(const case_node *mapping, const char *key);

/* The node of a path below root, "force.vector" or "[2].n0"; NULL: there is none. */
const case_node *case_node_at(const case_node *root, const char *path);

#endif
