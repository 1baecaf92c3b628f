/* A YAML document as a tree of nodes that know their place. One document a file; no aliases, no tags. */
#ifndef CASES_PARSE_YAML_H
#define CASES_PARSE_YAML_H

#include <stdbool.h>
#include <stddef.h>

#include "cases/parse/diagnostics.h"
#include "mesh/base/status.h"

enum { CASE_MAX_BYTES = 1 << 20, CASE_MAX_DEPTH = 16, CASE_MAX_ENTRIES = 4096, CASE_PATH = 256 };

typedef enum {
  CASE_NULL, /* nothing, ~ or null */
  CASE_SCALAR,
  CASE_SEQUENCE,
  CASE_MAPPING,
  CASE_BROKEN /* an issue has been recorded; say no more about it */
} case_kind;

typedef struct case_node case_node;
struct case_node {
  case_kind  kind;
  int        line, column; /* of the value's first character, from 1; columns count characters */
  char      *key;          /* in a mapping; else NULL */
  int        key_line, key_column; /* of the key */
  char      *text;                 /* scalar */
  int        n;                    /* entries of a sequence or mapping */
  case_node *child;                /* [n], in the order of the file */
};

/* Whole file into malloc'ed memory, NUL added after length bytes.
 * Errors: SHB_ERR_IO unreadable; SHB_ERR_INPUT larger than CASE_MAX_BYTES or holding NUL bytes. */
shb_status case_text_read(const char *path, char **text, size_t *length);

/* Parse issues->text. NULL after a syntax error (the issue is recorded) or for a file without content; keys
 * given twice are recorded and the first one is kept. */
case_node *case_document_parse(case_issues *issues);
void       case_document_free(case_node *root);

/* "a mapping", "a list", ... for messages */
const char *case_kind_name(case_kind kind);

/* Print a key's path ("contact.n0[2]"); cut if too long for one that exists. */
void case_path(char path[CASE_PATH], const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Entry of a mapping, or NULL. */
const case_node *case_node_find(const case_node *mapping, const char *key);

#endif
