/* Run-up: the speed Omega of the rotor follows the excitation, omega = E Omega; and so does the blade's modal model.
 *
 * Modes are no good to interpolate: where two of them veer, shapes turn into each other within a few rpm. What is smooth is the space of
 * the m modes kept, and in a basis Q of it that turns as little as it can everything is a smooth function of s = Omega^2:
 *   C = Phi_0^T M Phi of the first speed's modes with this one's (/speeds/overlap) = A Sigma B^T,
 *   Q = Phi V, V = B A^T orthogonal: of all bases of span Phi that nearest to Phi_0 (Phi_0^T M Q is symmetric),
 *   K = V^T diag(w_i^2) V,  Z = V^T diag(zeta_i) V,  Q at contact and probes, Q^T f, and the residual terms
 * are interpolated by cubic splines, fourth order. The model at a speed: K = U diag(w_i^2) U^T, Phi = Q U, zeta_i = u_i^T Z u_i.
 * Without overlaps in the file V takes mode[t] to place t, the tracks: veering pairs then need a speed where both shapes are mixed.
 * Modes that change places with one left out are left out too: they answer statically (modal/model/reduce.h).
 * Derivation, orders: docs/theory/rotation.md. */
#ifndef MHB_STRUCTURE_SPEED_TABLE_H
#define MHB_STRUCTURE_SPEED_TABLE_H

#include "modal/model/speeds.h"
#include "modal/model/spline.h"

enum {
  MHB_SPEED_TABLE_UNROTATED = 14
}; /* arrays of a model that do not depend on which modes are kept apart */

/* Does not change once made: threads may share it. An entry: K [m][m], Z [m][m], rows [rows][m], plain. */
typedef struct mhb_speed_table {
  int                n, n_modes, engine_order; /* n: speeds used */
  int                n_dropped;    /* modes that the files has and that answer statically */
  double             low, high;    /* rad/s, speeds covered */
  double             band[2];      /* rad/s of the excitation, asked for */
  int                rows;         /* right, left, probe, load re, load im: of shapes, [rows][m] */
  size_t             size;         /* of an entry */
  modal_speeds       speeds;       /* its models, in part */
  const modal_model *given;        /* one of them: what does not change with the speed */
  modal_spline       spline;       /* over Omega^2 */
  double            *base, *table; /* [size] the first entry; [n][size] the others less that */
  size_t             plain[MHB_SPEED_TABLE_UNROTATED],
      count[MHB_SPEED_TABLE_UNROTATED]; /* where in an entry, and how many; 0: not there */
} mhb_speed_table;

/* speeds  in   taken over, and empty afterwards
 *   path  in   of the modal file, for messages
 *   frequency  in  Hz, range of the excitation (both alike: one frequency)
 * Errors: SHB_ERR_INPUT engine order below 1; one speed only; speeds needed beyond those there are; a mode that cannot be followed; SHB_ERR_IO no memory. */
shb_status mhb_speed_table_create(modal_speeds *speeds, const char *path, int engine_order,
                                  const double frequency[2], mhb_speed_table **run_up);
void       mhb_speed_table_destroy(mhb_speed_table *run_up);

/* Speed that goes with an excitation frequency, rad/s each; no less and no more than the speeds covered. */
double mhb_speed_table_speed(const mhb_speed_table *run_up, double omega);

/* The arrays [MHB_SPEED_TABLE_UNROTATED] of a model and their numbers of doubles; and a model's set to others. */
void mhb_speed_table_unrotated(const modal_model *model,
                               const void        *data[MHB_SPEED_TABLE_UNROTATED],
                               size_t             count[MHB_SPEED_TABLE_UNROTATED]);
void mhb_speed_table_set_unrotated(modal_model  *model,
                                   double *const data[MHB_SPEED_TABLE_UNROTATED]);

#endif
