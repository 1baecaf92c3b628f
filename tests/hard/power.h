/* Power balance of a periodic solution: input of the load, losses of modal damping and of
 * friction. */
#ifndef TESTS_HARD_POWER_H
#define TESTS_HARD_POWER_H

#include "mhb/balance/balance.h"

typedef struct {
  double input, damping, friction; /* J a cycle */
} power;

/* At the solution at which the balance was evaluated last. The model must have no residual response
 * to the load. */
power power_of(const mhb_balance *b, double omega);

#endif
