/* The methods of the contact benchmark: what they are called, run, wrong by and timed. */
#ifndef TESTS_METHOD_H
#define TESTS_METHOD_H

#include "baseline.h"
#include "mesh/base/status.h"
#include "mhb/contact/contact.h"
#include "tests/support/motion_suite.h"

typedef enum { METHOD_RETURN, METHOD_CLOSED, METHOD_LAW, METHOD_FAMILIES } method_family;

enum { METHOD_H = 15, METHOD_MAX = 64 }; /* highest harmonic compared; methods at most */

typedef struct {
  method_family          family;
  int                    N;         /* samples a period; the law: 0 */
  double                 tolerance; /* of the law; a baseline: 0 */
  int                    H;         /* force harmonics 0..H */
  const char            *accuracy;  /* "fast", "balanced", "exact", or NULL */
  char                   name[32];
  baseline               baseline;
  mhb_contact_evaluator *contact;
} method;

/* One method on one motion. */
typedef struct {
  double us[2]; /* medians, force and force with derivative; NAN: not measured */
  double error; /* of harmonics 0..H, relative to the largest */
  int    laps;  /* until the slider was periodic */
} measurement;

/* All methods with workspaces; quick: just those that errors are judged by. Returns how many in *n.
 * SHB_ERR_IO: no memory. */
shb_status methods_create(int quick, method all[METHOD_MAX], int *n);
void       methods_destroy(method *all, int n);

/* Errors against reference [3][2 METHOD_H + 1], and laps; times are set to NAN. */
measurement method_judge(method *m, const suite_motion *s, const double *reference);

/* Medians over rounds of batches. The methods take turns, so that a busy moment affects all alike.
 * Errors: SHB_ERR_IO no memory. */
shb_status methods_time(method *all, int n, const suite_motion *s, int rounds,
                        measurement *measured);

/* Median of t[n], which is sorted in place. */
double median_of(double *t, int n);

#endif
