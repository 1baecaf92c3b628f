/* The ring, or the blade on the ground, as the fast time integrator steps it.
 *
 *   z_k'' + 2 zeta_k w_k z_k' + w_k^2 z_k = -(R_k . p_b + L_k . p_{b-1})   mode k of blade b
 *   u_b = u_free + sum_k (R_k z_k of blade b + L_k z_k of blade b + 1)
 * p_b is the contact force between blade b and its right neighbour b + 1, L negative. Strang
 * splitting gives the modes kicks h times the force once a step and their exact free motion in
 * between. Without the velocities that is the recurrence
 *   z(t + h) = trace z(t) - det z(t - h) + M_01 (h/w) force(t),
 * with M the exact map of (z, z'/w) over h. z is scaled such that the rows of the motion are also
 * those of the force. Rows hold the factor sqrt(s), by which the receptance is exact at the
 * frequency W of the excitation:
 *   s = sinc((w + W)h/2) sinc((w - W)h/2)/sinc(w h)
 *
 * Modes above LAST_MODE times W and the residual flexibility become at most 6 modes for each pair
 * (merged_modes.h). Modes faster than wh = FASTEST are slowed to that, with their receptance at W
 * kept. The step needs no implicit solution.
 *
 * In a mistuned ring w of mode k of blade b is f_kb times that of the tuned blade. Rows and scale
 * of z are those of the tuned blade. A mode and blade then has three numbers of its own: trace, det
 * and the gain of its kicks. The gain is its s M_01 h/w over that of the tuned blade.
 *
 * Lanes are blades, their number rounded up to eight. Copies of the ring may be stepped side by
 * side, each in its own state: lane c + copies b is blade b of copy c. Few blades then fill lanes.
 * Derivation: docs/theory/lasting.md. */
#ifndef MHB_RING_RING_MODEL_H
#define MHB_RING_RING_MODEL_H

#include "mhb/ring/slip_flow.h"
#include "mhb/structure/receptance.h"

/* Samples of the output a period of the excitation. */
enum { MHB_RING_SAMPLES = 64 };

/* Columns of a mode's coefficients, before its 6 pairs rows (R, L of each pair) and the output's 3
 * rows. */
enum { MHB_RING_TRACE, MHB_RING_DET, MHB_RING_ROWS };

/* Of a mode and blade of a mistuned ring: trace, det, gain. */
enum { MHB_RING_GAIN = MHB_RING_DET + 1, MHB_RING_LANE_SIZE };

/* Numbers of a mode's map: M by rows, w of the step, scale of z. */
enum { MHB_RING_MAP = 6 };

typedef struct {
  mhb_settings    settings;
  mhb_receptance *receptance;
  int             blades, copies, lanes, pairs, modes, order;
  int             probe; /* whose motion is the output; -1: that of pair 0 */
  int             kept;  /* modes that are the model's own */
  double         *w;     /* [mode] rad/s; INFINITY of a merged one without inertia */
  double         *zeta;
  double         *shape; /* [mode][side][3 pairs], divided by w: m/N^1/2 */
  double         *out;   /* [mode][3] of the output, divided by w */
  /* at one frequency and number of steps: */
  double  omega, h;    /* rad/s of the excitation, s */
  int     steps;       /* a period of the fundamental, 2 pi order/omega */
  int     stride;      /* of the coefficients */
  double *coefficient; /* [mode][stride] */
  double *map;         /* [mode][MHB_RING_MAP] */
  /* mistuned, else NULL: the ring's own receptance; f [mode][lanes]; [lanes/8][mode][trace, det,
   * gain][8]; map [mode][lanes][MHB_RING_MAP] */
  mhb_receptance *ring;
  double         *stretch, *own, *own_map;
  mhb_slip_law   *law;           /* [pair] */
  int             n_free;        /* harmonics of the motion without contact */
  int            *harmonic;      /* [n_free] of the fundamental */
  double         *free_motion;   /* [n_free][cos, sin][3 pairs][lanes] m */
  double         *free_output;   /* [n_free][cos, sin][3][lanes] m */
  double         *cosine, *sine; /* [steps] of the phase */
  shb_arena       arena, table;
} mhb_ring_model;

/* Structure and laws at a preload, of one ring; of the ring in settings->ring if there is one.
 *   n0      in  N, total of the leading interface
 *   lowest  in  rad/s, lowest frequency of the excitation that will be set
 * The modal model must outlive it.
 * Errors: SHB_ERR_INPUT as mhb_receptance_create, or residual flexibility without eigenvalues. */
shb_status mhb_ring_model_create(const modal_model *modal, const mhb_settings *settings, double n0,
                                 double lowest, mhb_ring_model **model);

/* The same for copies of the ring, 1 to MHB_LANES. */
shb_status mhb_ring_model_create_copies(const modal_model *modal, const mhb_settings *settings,
                                        double n0, double lowest, int copies,
                                        mhb_ring_model **model);
void       mhb_ring_model_destroy(mhb_ring_model *model);

/* Coefficients at a frequency of the excitation (rad/s) and a number of steps a period of the
 * fundamental, a multiple of the samples. */
void mhb_ring_model_set(mhb_ring_model *model, double omega, int steps);

/* Largest eigenvalue of K^1/2 G K^1/2 over all nodal diameters. K is the stiffness of stuck
 * contacts, G = sum_k B B^H h s tan(wh/2)/(2 w). The stuck ring is stable in time steps below 1;
 * accuracy asks for some distance. */
double mhb_ring_model_stiffness(const mhb_ring_model *model);

/* Phase by which a blade lags at harmonic k of the fundamental, rad. */
double mhb_ring_model_lag(const mhb_ring_model *model, int harmonic, int blade);

/* Floating-point operations a step, for an estimate of the cost. */
double mhb_ring_model_work(const mhb_ring_model *model);

/* First harmonic of the excitation of the output of every blade, first[3][blades] m, by the
 * receptance at the frequency set. force: as of mhb_ring_start, of a mistuned ring. */
void mhb_ring_model_first(const mhb_ring_model *model, int n_harmonics, const double complex *force,
                          double complex *first);

/* Lanes that bear blades. */
static inline int mhb_ring_model_used(const mhb_ring_model *m) {
  return m->blades * m->copies;
}

/* M of a mode of a blade, w and scale. */
static inline const double *mhb_ring_model_map(const mhb_ring_model *m, int mode, int lane) {
  return m->own_map ? m->own_map + (size_t)MHB_RING_MAP * (size_t)(mode * m->lanes + lane)
                    : m->map + (size_t)MHB_RING_MAP * (size_t)mode;
}

/* Number i of trace, det, gain of a mode of a blade of a mistuned ring. */
static inline double *mhb_ring_model_own(const mhb_ring_model *m, int mode, int lane, int i) {
  return m->own +
         ((size_t)(lane / MHB_LANES * m->modes + mode) * MHB_RING_LANE_SIZE + (size_t)i) *
             MHB_LANES +
         lane % MHB_LANES;
}

static inline const double *mhb_ring_model_shape(const mhb_ring_model *m, int mode, int side) {
  return m->shape + (size_t)(6 * mode + 3 * side) * (size_t)m->pairs;
}

#endif
