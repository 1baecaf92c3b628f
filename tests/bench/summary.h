/* The suite in a few numbers: medians and largest errors of each method, time for an error,
 * goals. */
#ifndef TESTS_SUMMARY_H
#define TESTS_SUMMARY_H

#include "method.h"

/* One method over the suite. */
typedef struct {
  double us[2], us_worst[2]; /* force; force and derivative */
  double error, error_worst;
} summary;

/* measured [motion][METHOD_MAX] */
summary summary_of(int motions, const measurement (*measured)[METHOD_MAX], int i);

/* Error against time of one family, medians over the suite, at the harmonics of the motion; fast
 * points first. */
typedef struct {
  int    n;
  double us[METHOD_MAX], us_derivative[METHOD_MAX], error[METHOD_MAX];
  int    method[METHOD_MAX]; /* which of the methods */
} work_precision;

work_precision work_precision_of(method_family family, const method *all, const summary *sum,
                                 int n);

/* Observed order: slope of log error against log samples, least squares. */
double order_of(const work_precision *curve, const method *all);

/* Prints medians, goals and ratios. Returns the number of failed verdicts on errors. Verdicts on
 * times are only printed. */
int summary_print(const method *all, const summary *sum, int n);

#endif
