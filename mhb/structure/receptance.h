/* The blade as the contact sees it: receptance between the relative motions at the contact pairs
 * (eqs. 19-27, 34-35).
 *
 * Harmonic k of the fundamental omega/nu, w = k omega/nu. The inter-blade phase is e_k = exp(-j k
 * phi/nu), phi = 2 pi E/N + 2 pi l (eq. 16). l is 0 for nu = 1, else the least for which a wave of
 * nu periods closes around the ring. With B_k and F_k of modal_part.h:
 *   L_i = 1/(w_i^2 - w^2 + 2 j zeta_i w_i w)                          eq. 20
 *   R_k = B L B^H + residual terms (residual_terms.h)                 eqs. 34, 35
 *   u_k = B L F_k + residual terms of the load - R_k p_k              eq. 33
 * and the probes by the same with their own shapes. |L_i| is at most 1e8/w_i^2: without damping, at
 * a resonance, it is that of a frequency 5e-9 beside it.
 *
 * A mode may be at 0 Hz. A spring of (1e-3 w)^2 then holds its mean, w the lowest frequency asked
 * for. A steady load along it needs a contact that carries it.
 *
 * Coriolis terms (modes/coriolis of the model) couple the modes:
 *   L = (diag(w_i^2 - w^2 + 2 j zeta_i w_i w) + j w G_k)^-1,   [modes][modes]
 * It is not formed: a factor of its inverse is kept for each harmonic.
 *
 * With a flexible disc (settings->nodal_diameters) harmonic k is that of nodal diameter k (E + N
 * l)/nu modulo N: its shapes, frequencies and residual terms. phi_i phi_i^H is then complex.
 *
 * Motions are [3 pairs] in the order pair, (v, u, w). The modal part is made once; in a run-up
 * (settings->run_up), where the model depends on omega, anew at every frequency. */
#ifndef MHB_STRUCTURE_RECEPTANCE_H
#define MHB_STRUCTURE_RECEPTANCE_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/problem/settings.h"
#include "mhb/run_up/disc_speeds.h"
#include "mhb/structure/modal_part.h"
#include "mhb/structure/ring_receptance.h"
#include "mhb/structure/speed_derivative.h"

typedef struct mhb_receptance {
  const modal_model    *model;            /* in a run-up the one at omega; of a disc that of 0 */
  mhb_speed_model      *at;               /* run-up: whose model that is; else NULL */
  mhb_disc_speeds      *disc;             /* run-up of a disc: owns at; else NULL */
  mhb_speed_model     **speeds;           /* run-up: [k] that of each harmonic */
  mhb_speed_derivative *speed_derivative; /* run-up: d model/d omega; else NULL */
  mhb_ring_receptance  *ring; /* different blades: pairs, modes and probes are those of the whole
                               * ring; part, B, F, residual_terms, lambda and R are NULL */
  int                   n, n_modes, n_harmonics, nu; /* n = 3 pairs; harmonics 0..n_harmonics */
  double               *T0;       /* [pair][3][3], columns v, u, w in (tangential, axial, radial) */
  double                psi, phi; /* rad, mean over the pairs (of the leading interface) */
  double         *share;     /* [pair] area share, sums to 1 over an interface between two blades */
  int            *interface; /* [pair] in the order of the settings */
  double complex *phase;     /* [k] e_k */
  mhb_modal_part *part;      /* of model; the next four are its own */
  const double complex *B;   /* [k][n][modes] */
  const double complex *F;   /* [k][modes] modal force at scale 1 */
  const int            *driven; /* [k] whether the load has this harmonic */
  mhb_residual_terms   *residual_terms;
  double                scale;      /* of the excitation */
  double                hold;       /* rad/s: lowest frequency of a mode at k = 0 */
  double                omega;      /* rad/s, of mhb_receptance_set_frequency */
  double               *updated_at; /* [k] rad/s of the arrays below, NAN: never */
  double               *load_at;    /* [k] the same of lambda and free */
  double complex       *lambda;     /* [k][modes] L; not set with Coriolis terms */
  double complex *factor; /* [k][modes][modes] with Coriolis terms: L^-1, factored, else NULL */
  int            *pivot;  /* [k][modes] its row exchanges */
  double complex *R;      /* [k][n][n] m/N; memory is touched when R_k is made */
  double complex *free;   /* [k][n] m, response without contact */
  double complex *free_response_unit; /* the same at scale 1 */
  double         *scratch;            /* [4][modes] */
  double complex *BL;                 /* [n][modes] B L of one harmonic */
  shb_arena       arena;
} mhb_receptance;

/* Modal model of harmonic k: that of its nodal diameter, or the only one. */
static inline const modal_model *mhb_receptance_model(const mhb_receptance *r, int k) {
  return r->part->wave[k].model;
}

/* A[modes][modes] <- L^-1 of harmonic k at w rad/s, by columns. */
void mhb_receptance_dynamic_stiffness(const mhb_receptance *receptance, int k, double w,
                                      double complex *A);

/* The modal file has the nodal diameters of harmonics 0 to top. SHB_ERR_INPUT: it lacks one, or has
 * another number of blades. */
shb_status mhb_receptance_check(const mhb_settings *settings, int top);

/* Load harmonics above n_harmonics are ignored. The model must outlive the receptance; with
 * settings->ring it is not looked at. Errors:
 *
 *   SHB_ERR_INPUT  psi or phi differs from the file's normals by more than a degree; neighbour
 *                  without /contact/left; subharmonics that do not close around the ring */
shb_status mhb_receptance_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_receptance **receptance);

/* The same of the model of another receptance, with settings that differ in harmonics only. It uses
 * that one's residual matrices, which must outlive it, but in a run-up and of a ring. */
shb_status mhb_receptance_create_beside(const mhb_receptance *other, const mhb_settings *settings,
                                        int n_harmonics, mhb_receptance **receptance);
void       mhb_receptance_destroy(mhb_receptance *receptance);

/* Go to the excitation frequency omega (rad/s). lambda, R and free are made when they are
 * needed. */
void mhb_receptance_set_frequency(mhb_receptance *receptance, double omega);

/* lambda, R and free of harmonic k. Not for two threads at once. */
void mhb_receptance_update(mhb_receptance *receptance, int k);

/* lambda and free alone: R is not made. Not for two threads at once. */
void mhb_receptance_update_load(mhb_receptance *receptance, int k);

/* Both, harmonics 0..top. */
void mhb_receptance_at(mhb_receptance *receptance, double omega, int top);

/* Another scale of the excitation, at the same omega. */
void mhb_receptance_scale(mhb_receptance *receptance, double scale);

/* Element (i, i) of R_k, which is up to date. */
double complex mhb_receptance_diagonal(const mhb_receptance *receptance, int k, int i);

/* motion[n] += R_k p; R_k is up to date. */
void mhb_receptance_product_of(const mhb_receptance *receptance, int k, const double complex *p,
                               double complex *motion);

/* motion[n] <- harmonic k of free - R p, without making R: the cost is that of one product. */
void mhb_receptance_motion(const mhb_receptance *receptance, int k, const double complex *p,
                           double complex *motion);

/* amplitude[modes] <- of every mode kept at harmonic k under contact force p[n], m kg^1/2:
 * L (scale F - B^H p). The motion of the modes left out is not in it. */
void mhb_receptance_amplitudes(const mhb_receptance *receptance, int k, const double complex *p,
                               double complex *amplitude);

/* x[modes] <- L x of harmonic k, whose lambda or factor is up to date. */
void mhb_receptance_respond(const mhb_receptance *receptance, int k, double complex *x);

/* x[modes] <- L x and dL/d omega x of modes that Coriolis terms couple. */
void mhb_receptance_coupled(const mhb_receptance *receptance, int k, double complex *x);
void mhb_receptance_coupled_slope(const mhb_receptance *receptance, int k, double complex *x);

/* slope[n] <- d/d omega of harmonic k of free - R p, at fixed p[n]; p NULL: of free. */
void mhb_receptance_slope(const mhb_receptance *receptance, int k, const double complex *p,
                          double complex *slope);

/* R[n][n] <- the residual terms alone of harmonic k, at w rad/s (k omega/nu for any other
 * omega). */
void mhb_receptance_residual_terms(const mhb_receptance *receptance, int k, double w,
                                   double complex *R);

/* motion[3 q] <- motion of the probes at harmonic k under contact force p[n]. */
void mhb_receptance_probe(const mhb_receptance *receptance, int k, const double complex *p,
                          double complex *motion);

/* change[3 q] <- its change with p by dp, omega by d_omega and the scale by d_scale. */
void mhb_receptance_probe_change(const mhb_receptance *receptance, int k, const double complex *p,
                                 const double complex *dp, double d_omega, double d_scale,
                                 double complex *change);

/* Derivatives of harmonic k under contact force p[n] by ln zeta, common to all damping ratios.
 * They are those of the relative motion free - R p, and of the probes.
 *   motion  out  [n] m
 *   probe   out  [3 q] m */
void mhb_receptance_by_damping(const mhb_receptance *receptance, int k, const double complex *p,
                               double complex *motion, double complex *probe);

#endif
