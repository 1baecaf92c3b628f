/* State of a ring and its integration in time (ring_model.h).
 *
 * The state of a mode is its last two values. At the end of every period of the fundamental it can
 * be read and set as positions and velocities. */
#ifndef MHB_RING_RING_STEP_H
#define MHB_RING_RING_STEP_H

#include "mhb/ring/ring_model.h"

typedef struct {
  mhb_ring_model *model;
  size_t          row;    /* length of a row below: 8 + lanes + 8, blade b at place 8 + b */
  int             newest; /* 0 or 8: place of the present z */
  double         *z;      /* [lanes/8][mode][2][8] present and last value, scaled */
  double         *p;      /* [3 pairs][row] contact force, N; place 7 is the last blade */
  double   *right, *left; /* [3 pairs][row] motion by the modes of a blade on either side, m */
  double   *contact;      /* [pair][5][row] load n0 + kv v, N; tangential motion, m; friction, N */
  int       n_samples;    /* a period of the fundamental */
  double   *output;       /* [n_samples][3][lanes] m, of the last period; sample i ends at i + 1 */
  shb_arena arena;
} mhb_ring;

/* A state of one ring at the end of a period, as mhb_ring_save leaves it. */
typedef struct {
  double    omega;       /* rad/s of the excitation */
  double   *q, *v;       /* [mode][blades] as of mhb_ring_get, with the motion without contact */
  double   *p, *contact; /* [3 pairs][blades], [5 pairs][blades] */
  shb_arena arena;       /* shb_arena_free ends it */
} mhb_ring_state;

/* A ring at rest. The model must outlive it. */
void mhb_ring_create(mhb_ring_model *model, mhb_ring *ring);
void mhb_ring_destroy(mhb_ring *ring);

/* Integrate a period of the fundamental. */
void mhb_ring_period(mhb_ring *ring);

/* Start all copies on a wave at phase 0: the steady motion of the steps under its contact forces.
 *   force  in  [3 pairs][n_harmonics + 1] N of blade 0, harmonics of the fundamental; of a mistuned
 *              ring [blades][3 pairs][n_harmonics + 1] of all contacts */
void mhb_ring_start(mhb_ring *ring, int n_harmonics, const double complex *force);

/* Positions and velocities of the modes at the end of a period, times w of the model.
 *   q, v  [mode][lanes] m kg^1/2 rad/s, m kg^1/2 rad/s^2 */
void mhb_ring_get(const mhb_ring *ring, double *q, double *v);
void mhb_ring_put(mhb_ring *ring, const double *q, const double *v);

/* The same for the lanes of one copy. */
void mhb_ring_get_copy(const mhb_ring *ring, int copy, double *q, double *v);
void mhb_ring_put_copy(mhb_ring *ring, int copy, const double *q, const double *v);

/* Continue at another frequency of the excitation, rad/s. Positions and velocities of the blades
 * are kept, with their motion without contact. space: [2][mode][lanes]. */
void mhb_ring_move(mhb_ring *ring, double omega, double *space);

/* Keep the state of a copy, and continue one from a state, of a ring with the same modes. The
 * frequency and the steps may be others: the blades keep their positions and velocities. A state is
 * empty, or of such a ring. space: [2][mode][lanes]. */
void mhb_ring_save(const mhb_ring *ring, int copy, double *space, mhb_ring_state *state);
void mhb_ring_load(mhb_ring *ring, int copy, const mhb_ring_state *state, double *space);

#endif
