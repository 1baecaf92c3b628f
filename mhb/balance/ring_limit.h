/* A ring of different blades whose contacts stick or are open throughout: one harmonic. */
#ifndef MHB_BALANCE_RING_LIMIT_H
#define MHB_BALANCE_RING_LIMIT_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "mhb/contact/law.h"
#include "mhb/structure/ring_receptance.h"

/* u[3 pairs] <- (I + R_k S)^-1 u, S the springs of the pairs that stick; the other pairs are open.
 * The blocks of harmonic k are up to date.
 *   law    in  [pairs]
 *   stuck  in  [pairs]
 * SHB_ERR_INPUT: the system is singular. SHB_ERR_IO: no memory. */
shb_status mhb_ring_linear_limit(const mhb_ring_receptance *ring, const mhb_law *law, int k,
                                 const bool *stuck, double complex *u);

#endif
