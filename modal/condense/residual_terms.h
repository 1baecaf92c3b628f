/* Dofs to which the body is condensed, and the residual terms of a model there. They come from
 * sampled vectors: R from V_0, R2 from V_1, R3 from V_2. */
#ifndef MODAL_CONDENSE_RESIDUAL_TERMS_H
#define MODAL_CONDENSE_RESIDUAL_TERMS_H

#include "modal/condense/load_patterns.h"
#include "modal/condense/residual_chain.h"
#include "modal/model/damping.h"
#include "modal/model/model.h"

/* Dofs to condense to. contact: (side * n_pairs + pair) * 3 + axis; probe: 3 for each probe. */
typedef struct {
  int           n_pairs;
  bool          has_left;
  modal_dofs    contact, probe;
  modal_load    load;
  modal_damping damping;
} modal_condensation;

/* Store term (0, 1, 2: R, R2, R3) of contact dofs first .. first + count - 1, which are the first
 * columns of the chain. Its samples begin with all contact dofs. */
void modal_residual_terms_put(const modal_residual_chain *chain, int term, int first, int count,
                              modal_model *model);

/* Add all terms of load patterns first .. first + count - 1, which are the columns of the chain
 * from column on, in each harmonic of the load. */
void modal_residual_terms_add_load(const modal_residual_chain *chain, int column,
                                   const modal_load *load, int first, int count,
                                   modal_model *model);

/* Remove the rounding differences of R, R2, R3: the harmonic balance relies on symmetry. */
void modal_residual_terms_symmetrise(modal_model *model);

/* Store the tails of the contact dofs and of the load harmonics in a model. The error matrix of the
 * columns is positive semi-definite: this bounds the tail of a sum of patterns.
 *   order  in  model->tail_order
 *   tail   in  [n_contact + patterns of the load] both terms of each column */
void modal_store_tails(int order, int n_contact, double *const tail[2], const modal_load *load,
                       modal_model *model);

#endif
