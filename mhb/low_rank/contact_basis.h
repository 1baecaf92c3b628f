/* The few motions of the contact that matter to the balance.
 *
 * Seen through the contact stiffness D the receptance has a small rank. The face moves as a rigid
 * body, and what its patches yield by themselves is weak. X_k spans the singular vectors of
 * D^1/2 R_k D^1/2 above a bound over the frequency range, X_k^H D X_k = I. Then
 *
 *   R_k = X_k K_k X_k^H + rest,   K_k(omega) = X_k^H D R_k D X_k,
 *
 * with a rest below the bound. K_k follows from projections that are made once. Candidates for X_k
 * are the modes, the residual modes and the leading eigenvectors of the residual flexibility. */
#ifndef MHB_LOW_RANK_CONTACT_BASIS_H
#define MHB_LOW_RANK_CONTACT_BASIS_H

#include "mhb/low_rank/receptance_product.h"

/* Projections a harmonic: self, even, odd of each residual term; of a disc the whole term as the
 * first of them. */
enum { MHB_PROJECTIONS = 3 * MODAL_TERMS };

typedef struct {
  const mhb_receptance *receptance;
  int                   n, m;
  double                bound;     /* of the singular values left out */
  int                   size;      /* real coefficients of all harmonics: rank_0 + 2 sum rank_k */
  int                  *rank;      /* [k] */
  int                  *first;     /* [k] first real coefficient */
  double              **X;         /* [k] [3 pairs][parts][columns] real form; see below */
  double              **K;         /* [k] [columns][columns] real form, at omega */
  double complex      **projected; /* [k] [projection][rank][rank] X^H D . D X */
  double complex      **pole;      /* [k] [rank][poles] X^H D [B S] */
  double               *stiffness; /* [n] D, N/m */
  double                omega;     /* rad/s, of K; NAN: none */
  shb_arena             arena;
} mhb_contact_basis;

/* Rows of X_k in real form for one axis of a pair: real and imaginary part. Its columns are those
 * of Re y, then those of Im y. At k = 0 there is one row. */
static inline int mhb_basis_parts(int k) {
  return k ? 2 : 1;
}

/* On the receptance of a product, for excitation frequencies low..high rad/s. The bound is raised
 * from 0.05, up to 0.8, until size is at most `most`.
 *   stiffness  in  [n] D, N/m, > 0
 * SHB_NOT_CONVERGED: no eigenvalues. */
shb_status mhb_contact_basis_create(const mhb_receptance_product *product, int m,
                                    const double *stiffness, double low, double high, int most,
                                    mhb_contact_basis **out);
void       mhb_contact_basis_destroy(mhb_contact_basis *basis);

/* K at the receptance's frequency, whose lambda is up to date. */
void mhb_contact_basis_update(mhb_contact_basis *basis);

#endif
