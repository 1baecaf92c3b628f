/* Hard cases: a figure and a verdict in one row. */
#ifndef TESTS_HARD_VERDICT_H
#define TESTS_HARD_VERDICT_H

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* One row: what was measured, its value, the bound, pass or FAIL. If the value is not <= bound, the
 * test fails once all rows are printed (verdict_all). */
void verdict(double figure, double bound, const char *text, ...)
    __attribute__((format(printf, 3, 4)));

/* A count that must be exact. */
void verdict_count(int count, int wanted, const char *text, ...)
    __attribute__((format(printf, 3, 4)));

void verdict_all(void);

/* Sweep from..to, rad/s; every branch must cover the range: a row each time one does not. */
mhb_response *covered_sweep(const modal_model *model, mhb_settings *s, double from, double to);

/* Point i of a branch with its share of point i + 1, in real form x[3 pairs (2m+1)]. */
void point_of(const mhb_response *r, const mhb_branch *b, int i, double share, double *x);

/* Amplitude of harmonic k of component c (v, u, w) of the first pair. */
double harmonic_of(const mhb_response *r, const mhb_branch *b, int point, int c, int k);

/* The next point before (step -1) or after (1) i. A located point that nearly coincides with i is
 * skipped. */
int distinct(const mhb_branch *b, int i, int step);

int count_special(const mhb_branch *b, int special);

/* Angular frequency of the special point nearest to w, and its index; -1 if there is none. */
int special_near(const mhb_branch *b, int special, double w);

#endif
