/* Two runs side by side: peaks at the same preload, modes, settings that differ. */
#ifndef POSTPROC_COMPARISON_RUN_COMPARISON_H
#define POSTPROC_COMPARISON_RUN_COMPARISON_H

#include "postproc/analysis/file_origin.h"
#include "postproc/analysis/response_analysis.h"

enum { POST_RUNS = 2 };

/* One run. */
typedef struct {
  char          *name; /* of the case or the file */
  mhb_response  *response;
  post_analysis *analysis;
  post_origin    origin;
} post_run;

/* Curves of one preload, or of one linear limit. A run without them has group -1. */
typedef struct {
  mhb_branch_kind  kind;
  double           n0;               /* N; NAN for the limits, and where it varies */
  int              rank;             /* by rising n0 over both runs; -1 for the others */
  int              group[POST_RUNS]; /* index in each analysis */
  post_track_point peak[POST_RUNS];  /* highest; amplitude NAN: none */
} post_pair;

/* A setting that differs; NULL where a run has not got it. */
typedef struct {
  char *key, *value[POST_RUNS];
} post_difference;

typedef struct {
  post_run         run[POST_RUNS];
  int              n_pairs, n_ranks;
  post_pair       *pair; /* open, stuck, then by rising n0, then those with a varying one */
  int              n_differences;
  post_difference *difference; /* in the order of the first run's settings */
} post_comparison;

/* Read both response files and compare them. Errors: as mhb_response_read; SHB_ERR_INPUT: they
 * follow different parameters, or one has no point. */
shb_status post_comparison_read(const char *const path[POST_RUNS],
                                const char *const name[POST_RUNS], post_comparison *comparison);
void       post_comparison_free(post_comparison *comparison);

/* "open", "n₀ = 50 N", as post_group_name. */
void post_pair_name(const post_pair *pair, char out[64]);

/* b / a - 1 of the peaks' amplitudes or, if place, of their abscissae; NAN where one is missing. */
double post_change(const post_pair *pair, bool place);

#endif
