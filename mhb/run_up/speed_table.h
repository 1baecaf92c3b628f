/* Run-up: the speed Omega of the rotor follows the excitation, omega = E Omega. With it goes the
 * modal model of the blade, or of a nodal diameter of a disc.
 *
 * Mode shapes veer within a few rpm and cannot be interpolated. The subspace of the m modes kept
 * can, in the basis Q closest to that of the first speed (orthogonal Procrustes; Amsallem and
 * Farhat 2008). In that basis everything is a smooth function of Omega^2:
 *   C = Phi_0^H M Phi of the first speed's modes with this one's (/speeds/overlap) = A Sigma B^H,
 *   Q = Phi V,  V = B A^H unitary,  Phi_0^H M Q Hermitian,
 *   K = V^H diag(w_i^2) V,  Z = V^H diag(zeta_i) V,  C = V^H G V/Omega with Coriolis terms.
 * K, Z, C, Q at contact and probes, Q^H f and the residual terms are interpolated by cubic splines.
 * The model at a speed is K = U diag(w_i^2) U^H, Phi = Q U, zeta_i = u_i^H Z u_i. All is real but
 * for the travelling waves of a disc. Rows of the load hold conj(Q^H f), and Q^T f of the backward
 * wave: both turn as shapes do.
 *
 * Without overlaps in the file V takes mode[t] to place t, the tracks. Veering pairs then need a
 * speed at which both shapes are mixed. Modes that change places with one left out are left out
 * too: they answer statically (modal/model/reduce.h). Derivation, orders:
 * docs/theory/rotation.md. */
#ifndef MHB_RUN_UP_SPEED_TABLE_H
#define MHB_RUN_UP_SPEED_TABLE_H

#include "modal/model/speeds.h"
#include "modal/model/spline.h"

/* A model, and of a travelling wave its imaginary parts and the load of the backward wave; NULL of
 * a real one. */
typedef struct {
  modal_model *model, *imaginary, *backward;
} mhb_speed_parts;

/* An entry: K, Z and, with Coriolis terms, C [m][m], rows [rows][m], of width doubles each
 * (unitary.h). Then terms and tails, which do not depend on the modes. Threads may share a
 * table. */
typedef struct mhb_speed_table {
  int                width;                    /* 1: real; 2: complex */
  int                n, n_modes, engine_order; /* n: speeds used */
  int                n_dropped;                /* modes of the file that answer statically */
  double             low, high;                /* rad/s, speeds covered */
  double             band[2];                  /* rad/s of the excitation, asked for */
  int                squares;                  /* matrices: 2, with Coriolis terms 3 */
  int                rows;        /* right, left, probe, then load: re, im or forward, backward */
  size_t             fixed, size; /* of an entry, doubles: before its terms; whole */
  modal_speeds       speeds;      /* its models, in part */
  mhb_speed_parts    last;        /* those of the last speed */
  const modal_model *common;      /* the first of these, for all that is the same at every speed */
  modal_spline       spline;      /* over Omega^2 */
  double            *first_entry; /* [size] */
  double            *entries;     /* [n][size] less the first entry */
} mhb_speed_table;

/* speeds  in   taken over, and empty afterwards
 *   path  in   of the modal file, for messages
 *   frequency  in  Hz, range of the excitation (both equal: one frequency)
 * Errors: SHB_ERR_INPUT engine order below 1; one speed only; speeds outside those of the file are
 * needed; modes that cannot be followed. Coriolis terms at rest are refused too.
 * Whether the blade is stable between the speeds: mhb_speed_model_check. */
shb_status mhb_speed_table_create(modal_speeds *speeds, const char *path, int engine_order,
                                  const double frequency[2], mhb_speed_table **table);

/* The same of n nodal diameters, with as many modes at each; speeds have overlaps if n > 1.
 *   table  out  [n]; all are NULL after an error */
shb_status mhb_speed_tables_create(int n, modal_speeds *speeds, const char *path, int engine_order,
                                   const double frequency[2], mhb_speed_table **table);
void       mhb_speed_table_destroy(mhb_speed_table *table);

/* Speed at an excitation frequency, rad/s each, within the speeds covered. */
double mhb_speed_table_speed(const mhb_speed_table *table, double omega);

/* The terms and tails of the models <- their places in an entry; others are as before. */
void mhb_speed_table_place(const mhb_speed_table *table, double *entry,
                           const mhb_speed_parts *parts);

#endif
