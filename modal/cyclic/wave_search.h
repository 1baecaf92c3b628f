/* Search for eigenvalues that a block Lanczos run has missed, at one nodal diameter.
 *
 * It is modal/eigen/missed_modes.h with Hermitian matrices. The square of a complex component is a
 * sum of two real ones. So p columns of order n bound the probability as 2 p real ones of 2 n. */
#ifndef MODAL_CYCLIC_WAVE_SEARCH_H
#define MODAL_CYCLIC_WAVE_SEARCH_H

#include "modal/cyclic/wave_basis.h"
#include "modal/eigen/missed_modes.h"

/* b: basis after a converged run, H holding the eigenvectors, theta the Ritz values, W the next
 * block; W is overwritten. t: limit of the eigenvalues of K^-1 M. */
shb_status wave_search(wave_basis *b, double t, modal_missed_modes *out);

#endif
