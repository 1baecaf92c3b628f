/* Residual terms of eqs. 34, 35: the response of the modes left out to contact forces and load.
 *
 * At harmonic k, w rad/s, with the weights a_t of the terms and g_j of the residual modes
 * (modal/model/residual_series.h), in relative motion (relative_motion.h):
 *   matrix = T (R + a_1 R2 + a_2 R3) T^H + S g S^H             [n][n] m/N, n = 3 pairs
 *   load   = T (x + a_1 x2 + a_2 x3) + S g F                   [n] m, at scale 1
 * S = T times the residual modes at the contact, F the modal forces of the load on them. The probes
 * have the same terms with their own shapes. All that does not depend on w is made once. Motions
 * are [n] in the order pair, (v, u, w). */
#ifndef MHB_STRUCTURE_RESIDUAL_TERMS_H
#define MHB_STRUCTURE_RESIDUAL_TERMS_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/structure/cyclic_flexibility.h"
#include "mhb/structure/relative_motion.h"
#include "modal/model/nodal_diameters.h"
#include "modal/model/residual_series.h"

typedef struct mhb_residual_terms {
  const modal_model      *model;
  const modal_wave       *wave; /* [k] model of each harmonic, the caller's */
  mhb_relative            relative;
  int                     n_harmonics, nu;
  const double complex   *phase;                   /* [k] e_k, the caller's */
  mhb_cyclic_flexibility *contact[MODAL_TERMS];    /* R, R2, R3; NULL: none, as below */
  bool                    borrowed;                /* contact is that of other terms */
  double complex         *own[MODAL_TERMS];        /* [k][n][n] in their place: complex R, R2, R3 */
  double complex         *load[MODAL_TERMS];       /* [k][n] */
  double complex         *probe_load[MODAL_TERMS]; /* [k][3 q] */
  double complex         *probe_contact[MODAL_TERMS]; /* [k][3 q][n] */
  int                     r;                          /* most residual modes of a harmonic */
  double complex         *S, *F;                      /* [k][n][r], [k][r] of r residual modes */
  double complex         *Sg;                         /* [n][r] S g of one harmonic */
  shb_arena               arena;
} mhb_residual_terms;

/* What the harmonics of a structure are. */
typedef struct {
  int                   nu, n_harmonics; /* load harmonic h drives harmonic nu h */
  const double complex *phase;           /* [n_harmonics + 1] e_k */
  const modal_wave     *wave;            /* [n_harmonics + 1] model of each */
  bool                  nodal_diameters; /* the models differ: complex residual terms */
  /* Other terms of the same model and axes. Their matrices of the contact, which have no harmonics,
   * are used; they must outlive these. NULL: own ones. */
  const struct mhb_residual_terms *like;
} mhb_harmonics;

/* model (of all harmonics, or of the mean), relative.T0 and the arrays of harmonics must outlive
 * it. SHB_ERR_INPUT: the model has released its matrices, and there are no terms like these. */
shb_status mhb_residual_terms_create(const modal_model *model, mhb_relative relative,
                                     const mhb_harmonics *harmonics, mhb_residual_terms **out);
void       mhb_residual_terms_destroy(mhb_residual_terms *terms);

/* Anew from the model, whose arrays have other values. Not where the matrices are borrowed. */
void mhb_residual_terms_update(mhb_residual_terms *terms);

/* Whether the load has this harmonic. */
bool mhb_residual_terms_driven(const mhb_residual_terms *terms, int k);

/* to[n] += factor times term t (R, R2, R3) in relative motion times p[n]; nothing without it. */
void mhb_residual_terms_add_product(const mhb_residual_terms *terms, int t, int k, double factor,
                                    const double complex *p, double complex *to);

/* R[n][n] += matrix. Not for two threads at once. */
void mhb_residual_terms_matrix(const mhb_residual_terms *terms, int k, double w, double complex *R);

/* R[3][3] += the block of a pair with itself. */
void mhb_residual_terms_block(const mhb_residual_terms *terms, int k, double w, int pair,
                              double complex R[3][3]);

/* motion[n] += scale load */
void mhb_residual_terms_load(const mhb_residual_terms *terms, int k, double w, double scale,
                             double complex *motion);

/* motion[n] += scale load - matrix p */
void mhb_residual_terms_motion(const mhb_residual_terms *terms, int k, double w, double scale,
                               const double complex *p, double complex *motion);

/* The same with given weights, without residual modes. */
void mhb_residual_terms_motion_by(const mhb_residual_terms *terms, int k,
                                  const modal_series *series, double scale, const double complex *p,
                                  double complex *motion);

/* slope[n] += d/d(w^2) of that, times dw2; p NULL: of the load alone. */
void mhb_residual_terms_slope(const mhb_residual_terms *terms, int k, double w, double dw2,
                              double scale, const double complex *p, double complex *slope);

/* Forces of a harmonic on the structure, or a change of them. */
typedef struct {
  double                scale; /* of the load */
  const double complex *p;     /* [n] contact forces, N */
} mhb_structure_forces;

/* change[3 q] += the change of the probes' motion with the forces at by those of by, and with w^2
 * by dw2. */
void mhb_residual_terms_probe_change(const mhb_residual_terms *terms, int k, double w,
                                     mhb_structure_forces at, mhb_structure_forces by, double dw2,
                                     double complex *change);

/* motion[3 q] += the motion of the probes with given weights, without residual modes. */
void mhb_residual_terms_probe_by(const mhb_residual_terms *terms, int k, const modal_series *series,
                                 double scale, const double complex *p, double complex *motion);

#endif
