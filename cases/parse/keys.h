/* The key table. A row holds everything about one key of the case file. Reading, ranges, defaults,
 * `shroudhb keys`, suggestions and the settings of a stage are all derived from it. */
#ifndef CASES_PARSE_KEYS_H
#define CASES_PARSE_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cases/options/spelling.h"
#include "cases/parse/conditions.h"

/* Type of a key: the value in the file, and after the colon the type of its slot. A row of
 * case_types (cases/parse/value.c) says the rest. */
typedef enum {
  CASE_NUMBER,    /* number with a unit: double */
  CASE_INTEGER,   /* int */
  CASE_COUNT,     /* integer or "all": int, 0 for all; or the word, least - 2 */
  CASE_AUTO,      /* integer or "auto": int, for auto one less than the least */
  CASE_CHOICE,    /* one of words: enum of int size, the place in words */
  CASE_SWITCH,    /* one of two words: bool, true for the second */
  CASE_ACCURACY,  /* one of words, or a number: double */
  CASE_WORD,      /* safe file name: char * */
  CASE_LABEL,     /* name of a group: char[MESH_WORD] */
  CASE_FILE_NAME, /* path, relative to the case file: char * */
  CASE_VECTOR,    /* [x, y, z]: double[3] */
  CASE_TRIPLE,    /* number for all three axes, or [1, 2, 3]: double[3] */
  CASE_INTERVAL,  /* [from, to], increasing: double[2] */
  CASE_SWEEP,     /* the same, or a number for both: double[2] */
  CASE_STIFFNESS, /* number or [kuu, kuw, kww], positive definite: double[3] */
  CASE_PRELOADS,  /* number, list, or {from, to, points}: double[], their number at count_at */
  CASE_NUMBERS,   /* list: double[], their number at count_at, at most room */
  CASE_INTEGERS,  /* list of whole numbers, ascending: int[], likewise */
  CASE_WORD_OR_NUMBERS,  /* one of words, its place at what_at, or a list, the place after them */
  CASE_WORD_OR_INTEGERS, /* likewise */
  CASE_POINTS,           /* number of points, or list: the case_file's integrate.frequency */
  CASE_FACTORS,          /* {k: [factor, phase]}: fem_load, its factors */
  CASE_PROBES,           /* {name: [x, y, z]}: the case_file's probe */
  CASE_GAUGES,           /* {name: {at: [x, y, z], direction: [x, y, z]}}: the case_file's gauge */
  CASE_DAMPING,          /* ratio, list of ratios, {loss_factor: } or {rayleigh: }: damping */
  CASE_GROUPS,           /* {group: rule}: the case_file's source.rules */
  /* list of mappings, whose keys are rows "LIST[].KEY"; elements of size each, counted at
   * count_at */
  CASE_LIST,
  /* list of deviations, {file: }, or {deviation: , seed: , samples: }: the case_file's mistuning */
  CASE_MISTUNING,
  CASE_KEYS,   /* {name of the user's choice: value}; read by cases/designs, as the next */
  CASE_NAMES,  /* list of names */
  CASE_SIGNAL, /* [[amplitude, phase], ...] from harmonic 0; read by schema/motion.c */
  CASE_N_TYPES
} case_type;

typedef struct case_key {
  const char    *path; /* "contact.mu"; "[]" stands for any index */
  case_type      type;
  const char    *unit;         /* SI; "" without a dimension */
  double         least, most;  /* range; both 0: any */
  bool           above, below; /* least, most themselves are excluded */
  const char    *words;        /* CASE_CHOICE, CASE_SWITCH, CASE_ACCURACY: separated by spaces */
  const char    *fallback;     /* default, as YAML text; NULL: none */
  bool           required;     /* whether its stages require it when the condition holds */
  bool           spare;        /* the modes alone do not require it */
  int            stages;       /* mask of the stages whose result depends on the key */
  case_condition when, only;   /* both must hold: of the file, of the element */
  size_t         at;           /* offset in case_file, or in the element for "[]" rows */
  size_t         element;      /* likewise, of what the conditions are about */
  size_t         count_at;     /* offset of the number of values or elements */
  size_t         each;    /* CASE_LIST: size of an element; least and most bound their number */
  size_t         what_at; /* of a word or a list: offset of an enum of int size */
  int            room;    /* most numbers of a list */
  const char    *help;    /* one line */
  /* the keys that may be given in place of a required one, for messages; NULL if none */
  const char *instead;
} case_key;

struct case_value_context;
struct case_node;

/* A value to be printed as it stands in the settings of a stage. */
typedef struct {
  FILE            *out;
  const case_key  *key;
  const char      *path; /* of the line */
  const case_file *file;
  const void      *slot;
} case_printed;

/* What all keys of a type have in common. */
typedef struct {
  const char *name;     /* in `shroudhb keys` */
  const char *expected; /* in messages; the words and the unit of a key follow */
  const char *forms;    /* in the JSON Schema (cases/schema/key_schema.c) */
  bool (*read)(const struct case_value_context *c, const struct case_node *node, void *slot);
  void (*print)(const case_printed *p);
  bool own_lines;     /* print makes whole lines, one or more or none; else the value alone */
  bool number, whole; /* a study can vary it; in whole numbers */
} case_type_row;

extern const case_type_row case_types[CASE_N_TYPES];

typedef struct {
  int n;
  /* [n] in the order of the reference page; the keys of a block are consecutive */
  const case_key *key;
} case_keys;

/* Row of path (with "[]" for indices), or NULL. */
const case_key *case_key_find(case_keys keys, const char *path);

/* The rest of path in the elements of a list, "radius" of "LIST[].radius"; NULL: it is none. */
const char *case_key_in_list(const char *path, const char *list);

/* Whether the conditions of a row hold. base: the file, or the element of a "[]" row. */
bool case_key_applies(const case_key *key, const case_file *file, const void *base);

/* Whether path is a block of keys: a proper prefix of some row. */
bool case_key_is_block(case_keys keys, const char *path);

/* The rest of path below a block. The block "" is the top, which gives path itself. NULL if path is
 * not in the block. */
const char *case_key_below(const char *path, const char *block);

/* First part of path below a block, e.g. "sections" of "mesh.blade.sections[].radius" in
 * "mesh.blade". False if path is not in the block. */
bool case_key_part(const char *path, const char *block, char part[CASE_LONGEST_WORD]);

/* The last part of a path. */
const char *case_key_leaf(const char *path);

/* The key of a block ("" for the top) most like word. False if none is like it. best holds
 * CASE_LONGEST_WORD bytes. */
bool case_key_nearest(case_keys keys, const char *block, const char *word, char *best);

/* Message about an unknown word in a block ("" for the top). It names the key that was probably
 * meant, the block to which the word belongs, or the keys of the block. */
void case_key_suggest(case_keys keys, const char *block, const char *word, char *text, size_t size);

/* Append text to a buffer that holds a string. Text that does not fit is cut. */
void case_append(char *buffer, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Write the range as "0 to 10" or "above 0"; "" if every value is allowed. */
void case_key_range(const case_key *key, char *text, size_t size);

#endif
