/* That no mode is missing among those found: how it was checked. */
#ifndef MODAL_COMMON_COMPLETENESS_H
#define MODAL_COMMON_COMPLETENESS_H

/* In the order of the words of modal.check. */
typedef enum {
  MODAL_CHECK_AUTO, /* modal/eigen/missed_modes.h; where that has no basis or does not decide, inertia */
  MODAL_CHECK_INERTIA, /* modal/eigen/inertia_count.h */
  MODAL_CHECK_NEVER
} modal_check_kind;

/* limit: the last eigenvalue less 1e-6 (or the solver's tolerance) of its distance from the shift. */
typedef struct {
  const char *method;      /* "inertia", "restart" (modal/eigen/missed_modes.h), "no" */
  int         count;       /* eigenvalues below limit: all of them are among those found */
  double      limit;       /* rad2/s2 */
  double      probability; /* that one is missing nevertheless, at most; 1: not checked */
} modal_check;

/* Frequency of the limit, Hz. */
double modal_check_frequency(const modal_check *check);

#endif
