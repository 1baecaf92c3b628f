/* Reading of a document by the key table: all keys are read, unknown and missing ones reported. */
#ifndef CASES_PARSE_READER_H
#define CASES_PARSE_READER_H

#include <stdbool.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

enum { CASE_MAX_KEYS = 192, CASE_MAX_BLOCKS = 32, CASE_KEY_SLOTS = 512 };

/* A block of keys in the file. */
typedef struct {
  char             path[CASE_PATH];
  const case_node *node;
} case_block;

typedef struct {
  case_issues     *issues;
  case_keys        keys;
  short            slot[CASE_KEY_SLOTS]; /* 1 + row by hash of its path, 0: empty; by walk */
  case_file       *file;                 /* holds the slots */
  const case_node *given[CASE_MAX_KEYS]; /* the node of a row in the file, or NULL */
  bool             good[CASE_MAX_KEYS];  /* read without an issue, or default */
  int              n_blocks;
  case_block       block[CASE_MAX_BLOCKS];
} case_reader;

/* Read every key of root into file, defaults first. root is a mapping, or NULL for an empty
 * file. */
void case_reader_walk(case_reader *reader, const case_node *root);

/* Record the required keys of stages that are missing. A block that is missing as a whole is one
 * issue. */
void case_reader_require(case_reader *reader, int stages);

/* Node of a key; NULL if the file does not have it. Here and below an element of a list is named as
 * in messages, "contact.interfaces[1].n0"; it is good if its whole list is. */
const case_node *case_reader_given(const case_reader *reader, const char *path);

/* Is a block of keys in the file? */
bool case_reader_has_block(const case_reader *reader, const char *path);

/* May the value of a key be used, because it was read without an issue or is the default? */
bool case_reader_good(const case_reader *reader, const char *path);

/* Record an issue at a key or block: at its value, or else at the nearest block around it. */
void case_reader_issue(const case_reader *reader, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The place of one of several elements: an element of a list. Where the list is not given, the
 * block that stands for a list of one. */
typedef struct {
  case_reader *reader;
  char         path[CASE_PATH]; /* "materials[1]" or "material" */
} case_place;

case_place case_reader_place(case_reader *reader, const char *list, const char *block, int index);

/* As case_reader_given, of a key or a block of keys below a place; "": of the place itself. */
const case_node *case_place_given(const case_place *place, const char *leaf);
bool             case_place_good(const case_place *place, const char *leaf);
void case_place_issue(const case_place *place, const char *leaf, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
