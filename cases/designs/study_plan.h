/* The plan of a study: which values of its keys are computed. */
#ifndef CASES_DESIGNS_STUDY_PLAN_H
#define CASES_DESIGNS_STUDY_PLAN_H

#include "cases/designs/study_keys.h"

typedef enum { STUDY_GRID, STUDY_TABLE, STUDY_SOBOL, STUDY_LATIN_HYPERCUBE } study_plan_kind;

typedef struct {
  study_plan_kind kind;
  char           *table;     /* resolved path of the CSV file of STUDY_TABLE, else NULL */
  const char     *columns;   /* its keys, one a line, where the file is not read again; else NULL */
  int             n_points;  /* of STUDY_SOBOL and STUDY_LATIN_HYPERCUBE */
  int             seed;      /* of these */
  int             n_samples; /* of the uncertain keys; 0: there are none */
  int             sample_seed;
} study_plan;

/* Read the value of `plan`; folder: where a table is. Faults are recorded, here and below. */
void study_plan_read(case_issues *issues, const case_node *node, const char *folder,
                     study_plan *plan);

/* Read `samples` and `seed`, either of which may be NULL. */
void study_plan_read_samples(case_issues *issues, const case_node *samples, const case_node *seed,
                             study_plan *plan);

/* With uncertain keys alone the samples are a plan of Saltelli: blocks of d + 2 designs, of which
 * two are samples. With one uncertain key, or beside varied keys, each design is a sample. */
bool study_plan_has_blocks(const study_plan *plan, const study_keys *keys);

/* Number of designs for each design of the varied keys: 1 without uncertain keys. */
int study_plan_group(const study_plan *plan, const study_keys *keys);

/* Make the designs of the varied keys: one without any. The columns of a table become keys. Without
 * its rows there are no designs.
 *
 *   at      in   for messages
 *   design  out  [n][keys->n] malloc'ed, NULL after a fault */
void study_plan_make(case_issues *issues, const case_node *at, const study_plan *plan,
                     study_keys *keys, int *n, double **design);

/* Replace the designs of the varied keys by each of them with every sample of the uncertain keys,
 * which were appended to the keys. The designs of one group follow one another; all groups have the
 * same samples. */
void study_plan_add_samples(case_issues *issues, const case_node *at, const study_plan *plan,
                            const study_keys *keys, int *n, double **design);

/* "grid", "sobol", "uncertain", ... for files and pages. */
void study_plan_text(const study_plan *plan, const study_keys *keys, char *out, size_t size);

#endif
