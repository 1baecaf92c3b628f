/* The blade as the contact sees it: receptance between relative motions at the contact pairs (eqs. 19-27, 34-35).
 *
 * Harmonic k of the fundamental omega/nu. For pair a with axes T0 (columns v, u, w; eq. 2) and inter-blade phase
 * e_k = exp(-j k phi/nu), phi = 2 pi E/N + 2 pi l (eq. 16; l = 0 for nu = 1, else the least for which the wave of nu periods
 * closes around the ring; no left side to ground):
 *   B_k[3a + c][i] = T0^T (right - e_k left)                              relative motion of mode i
 *   L_i  = 1/(w_i^2 - (k w)^2 + 2 j zeta_i w_i k w)                       eq. 20; at most 1e8/w_i^2: without damping, at a
 *                                                                         resonance, it is that of 5e-9 beside
 *   R_k  = B L B^H + what the modes left out answer (mhb/structure/residual_terms.h)       eqs. 34, 35
 *   u_k  = B L F_k + the same of the load - R_k p_k                       eq. 33
 * and the probes by the same with their own shapes. Motions are [3 pairs] in the order pair, (v, u, w). Everything that does not depend on omega
 * is made once; in a run-up (settings->run_up), where the model does, anew at every omega that is moved to. */
#ifndef MHB_STRUCTURE_RECEPTANCE_H
#define MHB_STRUCTURE_RECEPTANCE_H

#include <complex.h>

#include "mesh/base/status.h"
#include "mhb/problem/settings.h"
#include "mhb/structure/residual_terms.h"
#include "mhb/structure/speed_model.h"

typedef struct mhb_receptance {
  const modal_model     *model; /* in a run-up the one at omega */
  mhb_speed_model       *at;    /* run-up: whose model that is; else NULL */
  struct mhb_receptance *rate;  /* run-up: B, F and residual terms of d model/d omega; else NULL */
  int                    n, n_modes, n_harmonics, nu; /* n = 3 pairs; harmonics 0..n_harmonics */
  double                *T0; /* [pair][3][3], columns v, u, w in (tangential, axial, radial) */
  double                 psi, phi;  /* rad, mean over the pairs (of the interface that leads) */
  double                *share;     /* [pair] area share, sums to 1 over each interface */
  int                   *interface; /* [pair] in the order of the settings */
  double complex        *B;         /* [k][n][modes] */
  double                 scale;     /* of the excitation */
  double complex        *F;         /* [k][modes] modal force at scale 1, as all loads below */
  double             *parts; /* [k][2 (re, im)][n + 1][modes] B, then F: for the loops over modes */
  double             *scratch; /* [4][modes] */
  double complex     *BL;      /* [n][modes] B L of one harmonic */
  mhb_residual_terms *left_out;
  double complex     *phase;       /* [k] e_k */
  int                *driven;      /* [k] whether the load has this harmonic */
  double              omega;       /* rad/s, of mhb_receptance_set_frequency */
  double             *made_at;     /* [k] rad/s for which the arrays below were made, NAN: never */
  double complex     *lambda;      /* [k][modes] */
  double complex     *R;           /* [k][n][n] */
  double complex     *free, *unit; /* [k][n] response without contact; the same at scale 1 */
} mhb_receptance;

/* Errors: SHB_ERR_INPUT psi, phi do not agree with the file's normals within a degree, load harmonic above n_harmonics
 * ignored, to neighbour without /contact/left, subharmonics
 * that do not close around the ring; SHB_ERR_IO no memory. The model must outlive the receptance. */
shb_status mhb_receptance_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_receptance **receptance);
void       mhb_receptance_destroy(mhb_receptance *receptance);

/* Go to the excitation frequency omega (rad/s). lambda, R and free of a harmonic are made when they are needed. */
void mhb_receptance_set_frequency(mhb_receptance *receptance, double omega);

/* lambda, R and free of harmonic k. Not for two threads at once. */
void mhb_receptance_update(mhb_receptance *receptance, int k);

/* Both, harmonics 0..top. */
void mhb_receptance_at(mhb_receptance *receptance, double omega, int top);

/* Another scale of the excitation, at the same omega. */
void mhb_receptance_scale(mhb_receptance *receptance, double scale);

/* What does not depend on omega, anew: the model's arrays have other values. */
void mhb_receptance_set(mhb_receptance *receptance);

/* What acts on mode i at harmonic k: load F - B^H p. */
double complex mhb_receptance_modal_load(const mhb_receptance *receptance, int k,
                                         const double complex *p, int i, double load);

/* motion[n] <- harmonic k of free - R p, without making R: what a single product costs. */
void mhb_receptance_motion(const mhb_receptance *receptance, int k, const double complex *p,
                           double complex *motion);

/* d/d omega of harmonic k of [free - R p] at fixed p[n]. */
void mhb_receptance_slope(const mhb_receptance *receptance, int k, const double complex *p,
                          double complex *slope);

/* R[n][n] <- the residual terms alone of harmonic k, at w rad/s of its own. */
void mhb_receptance_residual_terms(const mhb_receptance *receptance, int k, double w,
                                   double complex *R);

/* Motion of the probes [3 q] at harmonic k under contact force p[n] (both at the omega of the last call). */
void mhb_receptance_probe(const mhb_receptance *receptance, int k, const double complex *p,
                          double complex *motion);

/* Its change with p by dp, omega by d_omega and the scale by d_scale. */
void mhb_receptance_probe_change(const mhb_receptance *receptance, int k, const double complex *p,
                                 const double complex *dp, double d_omega, double d_scale,
                                 double complex *change);

#endif
