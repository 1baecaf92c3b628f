/* The first solution of a curve. */
#ifndef MHB_CONTINUATION_FIRST_SOLUTION_H
#define MHB_CONTINUATION_FIRST_SOLUTION_H

#include <stdbool.h>

#include "mhb/balance/newton.h"

/* Who is told that a search goes on: before its first linearisation, and before every step of
 * Newton's method. */
typedef struct {
  bool (*go_on)(void *context); /* false: give up; NULL: nobody */
  void  *context;
  double share;     /* of the work that a search may take, 1: all */
  int    harmonics; /* out: the most, below those asked for, that had a solution; 0: none */
} mhb_watch;

/* A solution at a value of the parameter, without a guess. Newton's method starts from the open and
 * the stuck limit, and from zero. Then it starts from solutions of fewer harmonics, and the forces
 * of the others are let in along a curve. Then it follows the frequency from values near by, the
 * preload from both sides, and the tangential stiffness.
 *   value       in   of the balance's parameter
 *   tolerance   in   of |r|/|x|
 *   x           out  [n] m
 *   iterations  out  of the last Newton method
 * The parameter and the preload of the balance are left as they were. MHB_GIVEN_UP: a bound on the
 * number of linearisations was reached, or a signal came. */
mhb_reason mhb_first_solution(mhb_newton *newton, mhb_balance *balance, double value,
                              double tolerance, double *x, int *iterations);

/* The same under a watch. */
mhb_reason mhb_first_solution_watched(mhb_newton *newton, mhb_balance *balance, double value,
                                      double tolerance, mhb_watch *watch, double *x,
                                      int *iterations);

#endif
