/* Record of the check that no mode is missing among those found. */
#ifndef MODAL_COMMON_COMPLETENESS_H
#define MODAL_COMMON_COMPLETENESS_H

/* In the order of the words of the key modal.check. */
typedef enum {
  /* Search (modal/eigen/missed_modes.h); inertia count where the search is undecided or has no
   * basis. */
  MODAL_CHECK_AUTO,
  MODAL_CHECK_INERTIA, /* modal/eigen/inertia_count.h */
  MODAL_CHECK_NEVER
} modal_check_kind;

/* The limit is the last eigenvalue, lowered by a relative margin of its distance from the shift.
 * The margin is 1e-6, or the solver's tolerance if that is larger. */
typedef struct {
  const char *method;      /* "inertia", "restart" (modal/eigen/missed_modes.h), "no" */
  int         count;       /* eigenvalues below limit; all of them are among those found */
  double      limit;       /* rad2/s2 */
  double      probability; /* bound of the probability that a mode is missing; 1: not checked */
} modal_check;

/* Frequency of the limit, Hz. */
double modal_check_frequency(const modal_check *check);

#endif
