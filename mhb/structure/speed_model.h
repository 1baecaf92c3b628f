/* The modal model at the speed that a frequency of a run-up goes with, and how it changes with the frequency. One a thread.
 *
 * With A = diag(w_i^2) - w^2 + j w N, N = diag(2 zeta_i w_i), in the modes at this speed,
 *   dA = (dK + j w dN) d omega + d(-w^2 + j w N),   dK = U^T K' U,  dN_ij = dK_ij (N_i - N_j)/(w_i^2 - w_j^2),
 *   dN_ii = 2 zeta_i' w_i + zeta_i dK_ii/w_i,  zeta_i' = (U^T Z' U)_ii + 2 sum_j (U^T Z U)_ij dK_ij/(w_i^2 - w_j^2):
 * as A^-1 is differentiated, not the modes, equal frequencies do no harm (but for dampings that differ). */
#ifndef MHB_STRUCTURE_SPEED_MODEL_H
#define MHB_STRUCTURE_SPEED_MODEL_H

#include "mhb/structure/speed_table.h"

typedef struct {
  const mhb_speed_table *run_up;
  double                 omega, slope_at; /* rad/s of model, of slope; NAN: never */
  double      least; /* of the eigenvalues of K; model has positive ones whatever it is */
  modal_model model; /* arrays are its own, or the run-up's */
  modal_model
          slope; /* d/d omega of Q U, U^T Q^T f and the residual terms, U held; not of frequency and damping_ratio */
  double *stiffness, *damping; /* [m][m] dK, dN */
  double *entry, *d_entry;     /* [size] interpolated */
  double *turned, *d_turned;   /* [rows][m] of them, times U */
  double *U;                   /* [mode][m] */
  double *weight, *d_weight;   /* [speeds] */
  double *work;                /* [4 m^2 + 40 m] */
} mhb_speed_model;

/* At no frequency yet. SHB_ERR_IO: no memory. */
shb_status mhb_speed_model_create(const mhb_speed_table *run_up, mhb_speed_model **at_speed);
void       mhb_speed_model_destroy(mhb_speed_model *at_speed);

/* model <- at an excitation frequency, rad/s. Beyond the speeds covered it is that of the last of them. */
void mhb_speed_model_set(mhb_speed_model *at_speed, double omega);

/* slope, stiffness, damping <- where go went. */
void mhb_speed_model_differentiate(mhb_speed_model *at_speed);

/* The stiffness stays positive definite between the speeds of the table.
 * SHB_ERR_INPUT: it does not; path of the modal file, for the message. SHB_ERR_IO: no memory. */
shb_status mhb_speed_model_check(const mhb_speed_table *table, const char *path);

#endif
