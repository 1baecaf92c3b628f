/* Walks a document against a key table: every key read, unknown and missing ones told. */
#ifndef CASES_PARSE_READER_H
#define CASES_PARSE_READER_H

#include <stdbool.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

enum { CASE_MAX_KEYS = 192, CASE_MAX_BLOCKS = 32 };

/* A block of keys that is in the file. */
typedef struct {
  char             path[CASE_PATH];
  const case_node *node;
} case_block;

typedef struct {
  case_issues     *issues;
  case_keys        keys;
  case_file       *file;                 /* where the slots are */
  const case_node *given[CASE_MAX_KEYS]; /* a row's node in the file, or NULL */
  bool             good[CASE_MAX_KEYS];  /* given and read without an issue, or its default */
  int              n_blocks;
  case_block       block[CASE_MAX_BLOCKS];
} case_reader;

/* Read every key of root (a mapping, or NULL for an empty file) into file, defaults first. */
void case_reader_walk(case_reader *reader, const case_node *root);

/* Record the required keys of stages that apply and are not there: a block that is missing as a whole is told
 * once. */
void case_reader_require(case_reader *reader, int stages);

/* Node of a key, NULL if it is not in the file. */
const case_node *case_reader_given(const case_reader *reader, const char *path);

/* Whether a block of keys is in the file. */
bool case_reader_has_block(const case_reader *reader, const char *path);

/* Whether the value of a key may be used: read well, or its default. */
bool case_reader_good(const case_reader *reader, const char *path);

/* Record an issue at a key or block: at its value, else at the nearest block around it. */
void case_reader_issue(const case_reader *reader, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
