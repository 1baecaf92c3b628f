/* Residual terms and residual modes where all contact dofs and load patterns fit into one batch of
 * columns. */
#ifndef MODAL_CONDENSE_FEW_COLUMNS_H
#define MODAL_CONDENSE_FEW_COLUMNS_H

#include "modal/condense/residual_terms.h"

enum { MODAL_FEW_COLUMNS = 96 }; /* contact dofs and load patterns, at most */

/* Also false where the vectors of all columns would take more than 1 GB. */
bool modal_columns_are_few(const fem_system *system, const modal_condensation *to);

/* Fill the residual terms, residual modes and tails of the model. Collective. Errors: SHB_ERR_IO
 * solver. */
shb_status modal_few_columns_fill(const fem_system *system, const modal_eigen *eigen,
                                  const modal_condensation *to, modal_model *model);

#endif
