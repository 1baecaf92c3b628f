/* STUDY.yaml in memory: which keys of a case are varied, by which plan, and which outputs are
 * wanted. */
#ifndef CASES_DESIGNS_STUDY_SPEC_H
#define CASES_DESIGNS_STUDY_SPEC_H

#include <stdbool.h>
#include <stdio.h>

#include "cases/designs/digest.h"
#include "cases/designs/output_names.h"
#include "cases/designs/study_optimise.h"
#include "cases/designs/study_plan.h"
#include "cases/parse/case_file.h"
#include "cases/schema/overrides.h"
#include "mesh/base/status.h"

typedef struct {
  char          *path, *text; /* of the study file; the overrides are comments below the text */
  char          *sets;        /* they, one a line */
  char          *folder;      /* of the results */
  char          *into;        /* it, if it was given; else NULL */
  char          *name;        /* of the output files */
  char          *case_path;   /* resolved */
  study_plan     plan;
  study_optimise optimise;
  study_keys     keys;
  int            n_outputs;
  study_output   output[STUDY_MAX_OUTPUTS];
  int            n_designs;
  double        *design;       /* [n_designs][keys.n]; of an optimisation study_optimise_starts */
  char (*digest)[DIGEST_TEXT]; /* [n_designs] of everything the outputs depend on, if checked */
  int       n_models; /* modal files that the designs need, if checked; 0 with modal.file */
  char     *inputs;   /* fingerprints of the files that the case reads */
  case_file base;     /* the case as it is */
} study_spec;

/* The texts of a study that was read, for the processes that compute designs. They read no file
 * again: one that was edited meanwhile would give rows of two cases in one table. */
typedef struct {
  const char *study, *base; /* texts of the study file and of its case */
  const char *columns;      /* keys of the table, one a line; "" without one */
  const char *inputs;       /* fingerprints of the files that the case reads, as digest_inputs */
  const char *sets;         /* overrides of the study file, one a line */
  const char *into;         /* folder of the results; "": that of the study file */
} study_texts;

/* Read and check a study file, its case and its table. All errors are printed to errors with line,
 * column and caret. Nothing is run. Free it in any case.
 *
 *   check  in  read each design as a case: a value out of its range is reported with the design;
 *              digests are made
 *
 * Errors: SHB_ERR_INPUT a fault in the file; SHB_ERR_IO a file cannot be opened. */
shb_status study_spec_read(const char *path, bool check, FILE *errors, study_spec *spec);
/* The same from the texts of another process, which has checked them. The designs of a table are
 * not made. */
shb_status study_spec_read_texts(const char *path, const study_texts *texts, FILE *errors,
                                 study_spec *spec);
/* study_spec_read with keys of the study file overridden, and another folder for the results. */
shb_status study_spec_read_with(const char *path, const case_overrides *overrides, bool check,
                                FILE *errors, study_spec *spec);
void       study_spec_free(study_spec *spec);

/* Whether the files that the case reads are still those of the study; inputs_of is the case or a
 * design. Errors: SHB_ERR_INPUT they are not; SHB_ERR_IO. */
shb_status study_spec_check_inputs(const study_spec *spec, const case_file *inputs_of);

/* Read a case with the values of a design. Errors as of case_read, printed to errors. */
shb_status study_spec_design(const study_spec *spec, const double *value, const char *name,
                             const char *into, FILE *errors, case_file *file);

/* Read a case with the values of a design as its digest.
 *   why  out  [size] the first fault of a case that is refused, "" if none is known
 * False: it is refused, or there is no memory; the digest is "" then. */
bool study_spec_digest(const study_spec *spec, const double *value, char digest[DIGEST_TEXT],
                       char *why, size_t size);

/* Words "--set", "PATH=VALUE", ... of a design; malloc'ed texts, at most [2 keys.n]. Returns their
 * number; -1: no memory. */
int study_spec_words(const study_spec *spec, const double *value, char **words);

#endif
