/* The modal model at the speed of an excitation frequency in a run-up, and its derivative by the
 * frequency. One a thread.
 *
 * With A = diag(w_i^2) - w^2 + j w N, N = diag(2 zeta_i w_i), in the modes at this speed,
 *   dA    = (dK + j w dN) d omega + d(-w^2 + j w N),   dK = U^H K' U,
 *   dN_ij = dK_ij (N_i - N_j)/(w_i^2 - w_j^2),
 *   dN_ii = 2 zeta_i' w_i + zeta_i dK_ii/w_i,
 *   zeta_i' = (U^H Z' U)_ii + 2 Re sum_j (U^H Z U)_ij dK_ji/(w_i^2 - w_j^2).
 * With Coriolis terms, G = Omega U^H C U, A has j w G too. Then dG = U^H (Omega' C + Omega C') U.
 * A^-1 is differentiated, not the modes: equal frequencies do no harm, unless their dampings
 * differ. */
#ifndef MHB_RUN_UP_SPEED_MODEL_H
#define MHB_RUN_UP_SPEED_MODEL_H

#include "mesh/base/arena.h"
#include "mhb/run_up/speed_table.h"

typedef struct {
  const mhb_speed_table *table;
  double                 omega;            /* rad/s of model; NAN: none yet */
  double                 slope_omega;      /* rad/s of slope */
  double                 least_eigenvalue; /* of K; the model's are positive whatever it is */
  modal_model            model;            /* its arrays are this object's, or the table's */
  modal_model            slope; /* d/d omega of Q U, U^H Q^H f and the residual terms at fixed U */
  /* Of a travelling wave, as in modal/model/nodal_diameters.h; else zero. */
  modal_model imaginary, backward, slope_imaginary, slope_backward;
  double     *stiffness;      /* [m][m] dK, by columns; width doubles each */
  double     *damping;        /* [m][m] dN, by rows */
  double     *coriolis;       /* [m][m] dG, by columns; NULL: without Coriolis terms */
  double     *coefficients;   /* [size] an entry of the table, interpolated */
  double     *d_coefficients; /* its derivative */
  double     *rotated_shapes; /* [rows][m] the entry's rows times U */
  double     *d_rotated_shapes;
  double     *U;                 /* [mode][m] eigenvectors of K, width doubles each */
  double     *weight, *d_weight; /* [speeds] of the spline */
  double     *work;
  shb_arena   arena;
} mhb_speed_model;

/* At no frequency yet. The table must outlive it. */
mhb_speed_model *mhb_speed_model_create(const mhb_speed_table *table);
void             mhb_speed_model_destroy(mhb_speed_model *speed_model);

/* model <- at an excitation frequency, rad/s. Beyond the speeds covered: that of the last of
 * them. */
void mhb_speed_model_set(mhb_speed_model *speed_model, double omega);

/* slope, stiffness, damping <- at the frequency of the model. */
void mhb_speed_model_differentiate(mhb_speed_model *speed_model);

/* Entries of dK, dN and dG. */
double complex mhb_speed_model_stiffness(const mhb_speed_model *speed_model, int i, int j);
double complex mhb_speed_model_damping(const mhb_speed_model *speed_model, int i, int j);
double complex mhb_speed_model_coriolis(const mhb_speed_model *speed_model, int i, int j);

/* The stiffness stays positive definite between the speeds of the table.
 * SHB_ERR_INPUT: it does not; path of the modal file, for the message. */
shb_status mhb_speed_model_check(const mhb_speed_table *table, const char *path);

#endif
