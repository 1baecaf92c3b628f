/* The key table: all that is known of a key of the case file, written once. Reading, ranges, defaults, the
 * list that "shroudhb keys" prints, suggestions and the settings of a stage all follow from it. */
#ifndef CASES_PARSE_KEYS_H
#define CASES_PARSE_KEYS_H

#include <stdbool.h>
#include <stddef.h>

#include "cases/parse/case_file.h"

/* What a key holds in the file, and (after the colon) what its slot is. */
typedef enum {
  CASE_NUMBER,    /* number with a unit: double */
  CASE_INTEGER,   /* int */
  CASE_COUNT,     /* integer or "all": int, 0 for all */
  CASE_AUTO,      /* integer or "auto": int, 0 for auto */
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
  CASE_PLACES,    /* list of frequencies: the case_file's mhb.search */
  CASE_ORDERS,    /* list of whole numbers, ascending: the case_file's mhb.search */
  CASE_POINTS,    /* number of points, or list: the case_file's integrate.frequency */
  CASE_FACTORS,   /* {k: [factor, phase]}: fem_load, its factors */
  CASE_PROBES,    /* {name: [x, y, z]}: the case_file's probe */
  CASE_DAMPING, /* ratio, list of them, {loss_factor: } or {rayleigh: }: the case_file's damping */
  CASE_GROUPS,  /* {group: rule}: the case_file's source.rules */
  CASE_LIST, /* list of mappings, whose keys are rows "LIST[].KEY": elements of each bytes, their number at count_at */
  CASE_SIGNAL, /* [[amplitude, phase], ...] from harmonic 0; read by motion.c */
  CASE_N_TYPES
} case_type;

/* When a key has a meaning at all. */
typedef enum {
  CASE_ALWAYS,
  CASE_IF_BLADE,      /* parametric blade: neither mesh.file nor modal.file */
  CASE_IF_MESH_FILE,  /* mesh.file, and no modal.file */
  CASE_IF_SIZE,       /* mesh.file is a solid */
  CASE_IF_OWN_MODES,  /* no modal.file */
  CASE_IF_MODAL_FILE, /* modal.file */
  CASE_IF_MATERIAL,   /* no modal.file, and one material */
  CASE_IF_MATERIALS,  /* several, by volumes */
  CASE_IF_AUTO_MODES, /* modal.modes: auto */
  CASE_IF_CRYSTAL,    /* material.G given */
  CASE_IF_INTERFACE,  /* one contact interface */
  CASE_IF_POINTS,     /* the same, and no modal.file */
  CASE_IF_INTERFACES, /* several by name */
  CASE_IF_VARIED,     /* several, and a parameter of one is followed */
  CASE_IF_ORDER,      /* contact.to: neighbour, or mhb.run_up: yes */
  CASE_IF_RUN_UP,     /* mhb.run_up: yes */
  CASE_IF_SECTOR,     /* neighbour or parametric blade */
  CASE_IF_PSI,        /* psi given */
  CASE_IF_PHI,        /* phi given */
  CASE_IF_PRESSURE,   /* excitation by pressure (not modal.file), and so on */
  CASE_IF_TRACTION,
  CASE_IF_FORCE,
  CASE_IF_FIELD,
  CASE_IF_LOADS,     /* several loads */
  CASE_IF_FACTORS,   /* any other load */
  CASE_IF_FORCE_AT,  /* excitation by force with a place of its own */
  CASE_IF_OUTPUT,    /* converge.output given */
  CASE_IF_AUTO,      /* harmonics: auto */
  CASE_IF_FOLLOWED,  /* the parameter of this row is followed */
  CASE_IF_STABILITY, /* multipliers are computed */
  CASE_IF_SEARCH,    /* there are random starts */
  CASE_IF_SEARCH_AT, /* at frequencies that are given */
  CASE_IF_SWEEP,     /* time integration that goes on from the frequency before */
  CASE_IF_NOT_SCALED /* curves do not follow the level of the excitation */
} case_condition;

typedef struct {
  const char    *path; /* "contact.mu"; "[]" stands for any index */
  case_type      type;
  const char    *unit;         /* SI; "" without a dimension */
  double         least, most;  /* range; both 0: any */
  bool           above, below; /* least, most themselves are excluded */
  const char    *words;        /* CASE_CHOICE, CASE_SWITCH, CASE_ACCURACY: separated by spaces */
  const char    *fallback;     /* default, as YAML text; NULL: none */
  bool           required;     /* by its stages, when it applies */
  int            stages;       /* case_stage mask: whose result depends on it */
  case_condition when;
  size_t         at;       /* offset in case_file (in the element for "[]" rows) */
  size_t         count_at; /* offset of the number of values or elements, likewise */
  size_t         each;    /* CASE_LIST: size of an element; least and most: how many there may be */
  const char    *help;    /* one line */
  const char    *instead; /* required, or one of these: "traction or force"; NULL */
} case_key;

typedef struct {
  int             n;
  const case_key *key; /* [n], in the order of the manual; keys of a block follow each other */
} case_keys;

/* Row of path (with "[]" for indices), or NULL. */
const case_key *case_key_find(case_keys keys, const char *path);

/* Whether path is a block of keys: a proper prefix of some row. */
bool case_key_is_block(case_keys keys, const char *path);

/* The rest of path below a block ("" for the top, which gives path itself); NULL if path is not in it. */
const char *case_key_below(const char *path, const char *block);

enum { CASE_LONGEST_WORD = 64 };

/* First part of path below a block: "sections" of "mesh.blade.sections[].radius" in "mesh.blade". False if path
 * is not in the block. */
bool case_key_part(const char *path, const char *block, char part[CASE_LONGEST_WORD]);

/* The last part of a path. */
const char *case_key_leaf(const char *path);

/* The part of block ("" for the top) most like word; false if none is. best holds CASE_LONGEST_WORD bytes. */
bool case_key_nearest(case_keys keys, const char *block, const char *word, char *best);

/* What to say of an unknown word in a block ("" for the top): "; did you mean 'mu'?", where the key belongs, or
 * what the block knows. */
void case_key_suggest(case_keys keys, const char *block, const char *word, char *text, size_t size);

/* Edits (insert, delete, replace, swap neighbours; case ignored) that turn a into b. */
int case_edit_distance(const char *a, const char *b);

/* Append text to a buffer that holds a string; cuts what does not fit. */
void case_append(char *buffer, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "0 to 10", "above 0", ... ; "" for any */
void case_key_range(const case_key *key, char *text, size_t size);

#endif
