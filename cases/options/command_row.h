/* A row of the table of commands, and what a command line says. */
#ifndef CASES_OPTIONS_COMMAND_ROW_H
#define CASES_OPTIONS_COMMAND_ROW_H

#include <stdbool.h>
#include <stddef.h>

enum { COMMAND_SETS = 64, COMMAND_FILES = 12, COMMAND_WORDS = 2 * COMMAND_SETS + 48 };

/* What a command line says. Numbers are below 0 where not given, texts NULL. Texts point into
 * argv. */
typedef struct {
  int         n_files;
  const char *file[COMMAND_FILES];
  const char *path, *other; /* the first two files, or NULL */
  bool        quiet, verbose, force, csv, json, no_report, inp, ring, face;
  const char *mode; /* the name of an option that excludes others of its kind */
  int         n_set;
  const char *set[COMMAND_SETS]; /* of --set */
  const char *into;              /* folder of the results */
  const char *text; /* file with the text of the case, for programs that start each other */
  const char *svg, *params, *results, *modal;
  int         design, branch, point, peak, rank, diameter, steps; /* rank: the mode, from 1 */
  double      scale;
} command_options;

typedef enum {
  OPTION_FLAG,    /* bool */
  OPTION_MODE,    /* its name becomes the mode; one at most */
  OPTION_TEXT,    /* const char *, not empty; the last one counts */
  OPTION_OUTPUT,  /* the same, once, and no option */
  OPTION_SET,     /* set and n_set */
  OPTION_COUNT,   /* int from low to high */
  OPTION_RANK,    /* the same, or nothing: the default */
  OPTION_POSITIVE /* double above 0 */
} option_kind;

typedef struct {
  const char *word;     /* with "--" */
  const char *argument; /* "KEY=VALUE"; NULL: it takes none */
  const char *text;     /* of the help; lines end by \n but the last; NULL: it is not shown */
  option_kind kind;
  size_t      at;    /* of the member */
  const char *needs; /* what is missing without an argument */
  int         low, high;
} command_option;

/* Which document --json gives, and who prints it. */
typedef enum {
  JSON_NONE,    /* there is none */
  JSON_OWN,     /* the command itself */
  JSON_MODES,   /* post --modes, of the modal file */
  JSON_SUMMARY, /* post --summary, of all results of the case */
  JSON_CHECK    /* post --check: the file is in order */
} command_json;

/* A row of the table of commands (cases/options/command_table). */
typedef struct {
  const char           *name;
  const char           *brief;    /* lines of `shroudhb --help`; NULL: the command is not shown */
  const char           *synopsis; /* what follows the name, a line a form */
  const char           *text;     /* what it does: paragraphs */
  const char           *codes;    /* exit codes that differ; NULL */
  const command_option *option;   /* ended by a row without a word */
  int                   least, most; /* files; below 0: the words are not read here */
  command_json          json;
  bool                  may_crash; /* over a file of another program: it runs as a child */
} command_row;

#endif
