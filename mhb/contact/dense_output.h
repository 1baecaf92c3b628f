/* The contact over one period as a list of smooth pieces, kept only when asked for
 * (time_history.h).
 *
 * Each piece holds until the next begins; the last ends one period after the first begins. In units
 * of the force scale:
 *   stick  f = x - z
 *   slip   f = mu n (cos th, sin th), th a collocation polynomial
 *   open   f = 0 */
#ifndef MHB_CONTACT_DENSE_OUTPUT_H
#define MHB_CONTACT_DENSE_OUTPUT_H

#include "mesh/base/status.h"
#include "mhb/contact/law.h"
#include "mhb/contact/slip.h"
#include "mhb/numerics/fourier.h"

enum { MHB_MAX_PIECES = 8192 };

typedef struct {
  mhb_state state;
  double    t0, h;                /* start; length of a slip panel */
  double    z[2];                 /* stick: the slider */
  double    theta[1 + MHB_NODES]; /* slip: at the start and at the panel's nodes */
} mhb_dense_piece;

typedef struct {
  int                enabled; /* pieces are wanted */
  int                full;    /* some pieces had no room */
  int                n;
  mhb_dense_piece   *piece;                 /* [MHB_MAX_PIECES] */
  double             node[1 + MHB_NODES];   /* 0 and the nodes on [0, 1] */
  double             weight[1 + MHB_NODES]; /* barycentric */
  const mhb_signals *signals;               /* (n, x_1, x_2) */
  double             mu, scale;             /* force scale, N */
} mhb_dense_output;

/* SHB_ERR_IO: no memory. */
shb_status mhb_dense_output_create(const mhb_collocation *rule, mhb_dense_output *output);
void       mhb_dense_output_destroy(mhb_dense_output *output);

/* Adds a piece that begins at phase t0 or with the panel. No effect unless output->enabled. */
void mhb_dense_output_stick(mhb_dense_output *output, double t0, const double z[2]);
void mhb_dense_output_slip(mhb_dense_output *output, const mhb_panel *panel);
void mhb_dense_output_open(mhb_dense_output *output, double t0);
void mhb_dense_output_frictionless(mhb_dense_output *output, double t0);

/* State and force (n, fu, fw) in units of the force scale at t in [0, 2 pi]. */
mhb_state mhb_dense_output_at(const mhb_dense_output *output, double t, double force[3]);

#endif
