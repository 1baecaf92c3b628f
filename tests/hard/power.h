/* Power balance of a periodic solution: what the load puts in, modal damping and friction take out. */
#ifndef TESTS_HARD_POWER_H
#define TESTS_HARD_POWER_H

#include "mhb/balance/balance.h"

typedef struct {
  double input, damping, friction; /* J a cycle */
} power;

/* At the solution the residual was last evaluated at; the model without residual response to the load. */
power power_of(const mhb_balance *b, double omega);

#endif
