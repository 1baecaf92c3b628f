/* Product R p of the receptances of all harmonics with a contact force, without R.
 *
 *   R_k = own_0 + a_1 own_1 + U C_k U^T + [B_k, S_k] diag(L_k, g_k) [B_k, S_k]^H
 *
 * own_t: residual flexibility and inertia of a face by itself, of full rank. What couples the two
 * faces is smooth, and so is the third residual term. It lies in the span of a few vectors U: 86 of
 * 711 with 237 pairs of cases/z_notch_blade. It is found to 1e-12 in the norm of the contact
 * stiffness (smooth_span.h). Without a small U the products are dense.
 *
 * With a disc the terms differ by nodal diameter. own_t is the mean of their real parts over the
 * harmonics, and what a harmonic differs by is smooth: C_k is complex. L_k is a full matrix with
 * Coriolis terms.
 *
 * Forces and motions are in real form [n][2m+1]. Without the low harmonics they are [n][nb], real
 * and imaginary part of each harmonic. */
#ifndef MHB_LOW_RANK_RECEPTANCE_PRODUCT_H
#define MHB_LOW_RANK_RECEPTANCE_PRODUCT_H

#include "mhb/structure/receptance.h"

/* R itself, or its derivative by omega. */
typedef enum { MHB_PRODUCT_VALUE, MHB_PRODUCT_SLOPE, MHB_PRODUCTS } mhb_product_kind;

enum { MHB_SMOOTH_TERMS = 2 * MODAL_TERMS + 1 }; /* even, odd of each term, self of the third */

typedef struct {
  mhb_receptance *receptance;
  int             n, first, m, nb; /* 3 pairs; harmonics first..m; columns of a force */
  int             n_weights;       /* harmonics from 0 on that weight has room for */
  int             n_poles;         /* modes and residual modes */
  const double   *own[2];          /* [n][n] of the receptance; NULL: none */
  const float    *coarse[2];       /* [n][n] the same in single precision */
  double          own_size[2];     /* where I is 1, at weight 1 */
  int             n_smooth;        /* columns of U, n without U */
  double         *U;               /* [n][smooth] or NULL: the identity */
  double         *size;            /* [smooth] of U's columns in the terms, falling, where I is 1 */
  double         *smooth[MHB_SMOOTH_TERMS]; /* [smooth][smooth] U^+ of a term; NULL: none */

  double complex *wave[MODAL_TERMS]; /* [k][smooth][smooth] the same of a disc, by terms */

  /* at a frequency */
  double          omega;              /* rad/s; NAN: none */
  double         *weight;             /* [kind][term][k] of the residual terms */
  double complex *pole[MHB_PRODUCTS]; /* [k][poles] */

  double         *weighted[2]; /* [group][n][columns] a force in groups, its product with own */
  double         *coefficient; /* [smooth][2m+1] U^T p */
  double         *turned;      /* [smooth][2m+1] the same with weight and phase of a term */
  double         *response;    /* [smooth][2m+1] */
  float          *coarse_force, *coarse_motion; /* the same in single precision */
  double complex *force, *motion;               /* [n] */
  double complex *amplitude;                    /* [poles] */
  double complex *wave_force, *wave_motion;     /* [smooth] */
  shb_arena       arena;
} mhb_receptance_product;

/* Harmonics first..m of the receptance, which must outlive it and keep its model.
 *   stiffness  in  [n] size of the contact stiffness of each axis, N/m, > 0
 *   top        in  rad/s, highest excitation frequency */
mhb_receptance_product *mhb_receptance_product_create(mhb_receptance *receptance, int first, int m,
                                                      const double *stiffness, double top);
void                    mhb_receptance_product_destroy(mhb_receptance_product *product);

/* Go to the receptance's frequency. */
void mhb_receptance_product_update(mhb_receptance_product *product);

/* Column of harmonic k, its real part. */
static inline int mhb_product_column(const mhb_receptance_product *product, int k) {
  return product->first ? 2 * (k - product->first) : k ? 2 * k - 1 : 0;
}

/* out[n][nb] <- R p or dR/d omega p at the frequency of the last update. `negligible` is the
 * error allowed, in the norm of the contact stiffness, where I is 1; 0: none. Small terms are left
 * out then, and single precision is used where it serves. */
void mhb_receptance_product_apply(mhb_receptance_product *product, mhb_product_kind kind,
                                  double negligible, const double *p, double *out);

/* motion[n] <- R_k p[n] of harmonic k alone, first..m, at the frequency of the last update. At
 * k = 0 the real part of p counts. */
void mhb_receptance_product_of_harmonic(const mhb_receptance_product *product, int k,
                                        const double complex *p, double complex *motion);

#endif
