/* Run-up: the speed Omega of the rotor follows the excitation, omega = E Omega, and with it the
 * blade's modal model.
 *
 * Mode shapes veer within a few rpm and cannot be interpolated. The subspace of the m modes kept
 * can, in the basis Q closest to that of the first speed (orthogonal Procrustes; Amsallem and
 * Farhat 2008). In that basis everything is a smooth function of Omega^2:
 *   C = Phi_0^T M Phi of the first speed's modes with this one's (/speeds/overlap) = A Sigma B^T,
 *   Q = Phi V,  V = B A^T orthogonal,  Phi_0^T M Q symmetric,
 *   K = V^T diag(w_i^2) V,  Z = V^T diag(zeta_i) V.
 * K, Z, Q at contact and probes, Q^T f and the residual terms are interpolated by cubic splines.
 * The model at a speed is K = U diag(w_i^2) U^T, Phi = Q U, zeta_i = u_i^T Z u_i.
 *
 * Without overlaps in the file V takes mode[t] to place t, the tracks. Veering pairs then need a
 * speed at which both shapes are mixed. Modes that change places with one left out are left out
 * too: they answer statically (modal/model/reduce.h). Derivation, orders:
 * docs/theory/rotation.md. */
#ifndef MHB_STRUCTURE_SPEED_TABLE_H
#define MHB_STRUCTURE_SPEED_TABLE_H

#include "modal/model/speeds.h"
#include "modal/model/spline.h"

/* Arrays of a model that do not depend on the modes. */
enum { MHB_SPEED_TABLE_UNROTATED = 14 };

/* An entry: K [m][m], Z [m][m], rows [rows][m], unrotated arrays. Threads may share a table. */
typedef struct mhb_speed_table {
  int                n, n_modes, engine_order; /* n: speeds used */
  int                n_dropped;                /* modes of the file that answer statically */
  double             low, high;                /* rad/s, speeds covered */
  double             band[2];                  /* rad/s of the excitation, asked for */
  int                rows;                     /* right, left, probe, load re, load im: [rows][m] */
  size_t             size;                     /* of an entry, doubles */
  modal_speeds       speeds;                   /* its models, in part */
  const modal_model *common;      /* one of them, for all that is the same at every speed */
  modal_spline       spline;      /* over Omega^2 */
  double            *first_entry; /* [size] */
  double            *entries;     /* [n][size] less the first entry */
  size_t             unrotated[MHB_SPEED_TABLE_UNROTATED]; /* offset in an entry */
  size_t             count[MHB_SPEED_TABLE_UNROTATED];     /* doubles; 0: the model has none */
} mhb_speed_table;

/* speeds  in   taken over, and empty afterwards
 *   path  in   of the modal file, for messages
 *   frequency  in  Hz, range of the excitation (both equal: one frequency)
 * Errors: SHB_ERR_INPUT engine order below 1; one speed only; speeds outside those of the file are
 * needed; modes that cannot be followed. SHB_ERR_IO no memory. Whether the blade is stable between
 * the speeds: mhb_speed_model_check. */
shb_status mhb_speed_table_create(modal_speeds *speeds, const char *path, int engine_order,
                                  const double frequency[2], mhb_speed_table **table);
void       mhb_speed_table_destroy(mhb_speed_table *table);

/* Speed at an excitation frequency, rad/s each, within the speeds covered. */
double mhb_speed_table_speed(const mhb_speed_table *table, double omega);

/* The unrotated arrays of a model and their numbers of doubles, in the order of set_unrotated. */
void mhb_speed_table_unrotated(const modal_model *model,
                               const void        *data[MHB_SPEED_TABLE_UNROTATED],
                               size_t             count[MHB_SPEED_TABLE_UNROTATED]);
/* The unrotated arrays of the model <- data; NULL: none. */
void mhb_speed_table_set_unrotated(modal_model  *model,
                                   double *const data[MHB_SPEED_TABLE_UNROTATED]);

#endif
