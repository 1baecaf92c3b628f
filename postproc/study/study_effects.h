/* What a key does to an output over the designs of a study, and which output is compared. */
#ifndef POSTPROC_STUDY_STUDY_EFFECTS_H
#define POSTPROC_STUDY_STUDY_EFFECTS_H

#include "postproc/draw/number_format.h"
#include "postproc/study/design_study.h"

enum { STUDY_GROUPS = 12 };

/* Main effect of a key: the designs are grouped by the key's value. */
typedef struct {
  int    n_groups;
  double at[STUDY_GROUPS];   /* mean of the key in the group, SI */
  double mean[STUDY_GROUPS]; /* mean of the output in the group, SI */
  double share;              /* of the output's variance that the key explains alone; NAN */
} study_effect;

/* Main effect of a key on an output over the designs that are done.
 *
 * Groups are the levels of the key where there are at most STUDY_GROUPS with two designs each on
 * average, else groups of equally many designs. The share is the correlation ratio eta squared.
 * For groups of many levels it is corrected for chance (epsilon squared; Kelley, An unbiased
 * correlation ratio measure, 1935). It is NAN with fewer than 8 designs, with a single key, while
 * designs wait, and after an optimisation, whose designs are no sample. */
study_effect study_main_effect(const design_study *study, int output, int key);

/* Output that the page compares: the objective of an optimisation, else "peak", else the first.
 * -1: there is no output. */
int study_objective(const design_study *study);

/* Design that is done with the lowest value of the objective, or the one an optimisation chose. -1:
 * none, or a robust study, whose samples are no choice. */
int study_best(const design_study *study);

/* Of a robust study: the group with the least highest percentile of the objective; -1: none.
 *
 *   level  out  which percentile */
int study_best_group(const design_study *study, int *level);

/* Number of other groups whose interval of that percentile reaches down to it. */
int study_count_equal_groups(const design_study *study, int best, int level);

/* Number of other designs whose objective differs from the best by no more than both errors. */
int study_count_equals(const design_study *study, int best);

/* Key with the largest effect on the objective: by the total Sobol' index where there is one, else
 * by the main effect. -1: not judged. share: that number. */
int study_chief_key(const design_study *study, double *share);

/* Value of an output, or NAN where the design is not done. */
double study_done_value(const study_design *design, int output);

/* Unit in which a column of largest magnitude `largest` reads best; degrees for rad. */
post_unit study_unit(const study_column *column, double largest);
/* The same for key or output i over all designs. */
post_unit study_key_unit(const design_study *study, int key);
post_unit study_output_unit(const design_study *study, int output);

#endif
