/* STUDY.yaml in memory: which keys of a case are varied, by which plan, and which outputs are
 * wanted. */
#ifndef CASES_DESIGNS_STUDY_SPEC_H
#define CASES_DESIGNS_STUDY_SPEC_H

#include <stdbool.h>
#include <stdio.h>

#include "cases/designs/output_names.h"
#include "cases/parse/case_file.h"
#include "cases/parse/yaml.h"
#include "mesh/base/status.h"

enum { STUDY_MAX_KEYS = 32, STUDY_MAX_OUTPUTS = 64, STUDY_MOST_DESIGNS = 100000 };

typedef enum { STUDY_GRID, STUDY_TABLE } study_plan;

/* A varied key. Values are SI. */
typedef struct {
  char    path[CASE_PATH]; /* "mesh.blade.sections[4].thickness" */
  char    unit[STUDY_UNIT_TEXT];
  bool    whole;    /* takes whole numbers only */
  bool    is_range; /* from, to instead of a list */
  bool    log;      /* a range in steps of equal ratio */
  double  from, to;
  int     n;     /* values of the list, or points of the range */
  double *value; /* [n] */
} study_key;

typedef struct {
  char        *path, *text, *folder; /* of the study file */
  char        *name;                 /* of the output files */
  char        *case_path;            /* resolved */
  study_plan   plan;
  char        *table; /* resolved path of the CSV file of STUDY_TABLE, else NULL */
  int          n_keys;
  study_key    key[STUDY_MAX_KEYS];
  int          n_outputs;
  study_output output[STUDY_MAX_OUTPUTS];
  int          n_designs;
  double      *design; /* [n_designs][n_keys] */
  char (*digest)[17];  /* [n_designs] of everything the outputs depend on, if checked */
  char     *inputs;    /* fingerprints of the files that the case reads */
  case_file base;      /* the case as it is */
} study_spec;

/* Read and check a study file, its case and its table. All errors are printed to errors with line,
 * column and caret. Nothing is run. Free it in any case.
 *
 *   check  in  read each design as a case: a value out of its range is reported with the design;
 *              digests are made
 *
 * Errors: SHB_ERR_INPUT a fault in the file; SHB_ERR_IO a file cannot be opened. */
shb_status study_spec_read(const char *path, bool check, FILE *errors, study_spec *spec);
void       study_spec_free(study_spec *spec);

/* Read a case with the values of a design. Errors as of case_read, printed to errors. */
shb_status study_spec_design(const study_spec *spec, const double *value, const char *name,
                             const char *into, FILE *errors, case_file *file);

/* Words "--set", "PATH=VALUE", ... of a design; malloc'ed texts, [2 n_keys]. False: no memory. */
bool study_spec_words(const study_spec *spec, const double *value, char **words);

#endif
