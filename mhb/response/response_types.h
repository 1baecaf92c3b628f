/* What a response holds: branches of points, and what they depend on. */
#ifndef MHB_RESPONSE_RESPONSE_TYPES_H
#define MHB_RESPONSE_RESPONSE_TYPES_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response_samples.h"
#include "mhb/response/trace_state.h"
#include "modal/model/contact_face.h"

/* Solutions of the balance, its linear limits, and single points by time integration. */
typedef enum {
  MHB_BRANCH_NONLINEAR,
  MHB_BRANCH_OPEN,
  MHB_BRANCH_STUCK,
  MHB_BRANCH_INTEGRATION,
  MHB_BRANCH_TRACKED, /* a peak, fold, flip or Neimark-Sacker point along a parameter */
  MHB_N_BRANCH_KINDS
} mhb_branch_kind;

/* Origin of a branch: where its trace began. */
typedef enum {
  MHB_FROM_END,      /* the low end of the range */
  MHB_FROM_SEARCH,   /* a solution found by search */
  MHB_FROM_FLIP,     /* a flip */
  MHB_FROM_DETACHED, /* met on the way of the main branch: closed, or leaves by the low end */
} mhb_origin;

/* special of mhb_branch. Flip and Neimark-Sacker: a multiplier crosses the unit circle at -1, or a
 * complex pair does. */
enum {
  MHB_ORDINARY,
  MHB_FOLD,
  MHB_PEAK,
  MHB_FLIP,
  MHB_NEIMARK_SACKER,
  MHB_OPTIMUM, /* of a tracked branch: its amplitude is stationary; of others than peaks the
                  frequency */
  MHB_N_SPECIALS
};

/* mark of mhb_branch, a sum: what a point is not worth. */
enum {
  MHB_ABOVE_TOLERANCE       = 1, /* error_truncation is above the tolerance: it is no result */
  MHB_TRACTION_UNDETERMINED = 2, /* a mean friction that loads others is (it sticks throughout) */
  MHB_ERROR_NOT_JUDGED      = 4,
  MHB_ALL_MARKS             = 7
};

/* judged of mhb_branch: the evidence for stable. */
enum {
  MHB_NOT_JUDGED,       /* none: stable is -1 */
  MHB_BY_MULTIPLIERS,   /* the multipliers: all inside the unit circle, or some well outside */
  MHB_JUDGED_MARGINAL,  /* the largest multiplier is at 1 within its accuracy */
  MHB_JUDGED_UNDECIDED, /* none were computed, or their error is larger than the distance from
                           the circle: stable is -1 unless folds tell */
  MHB_BY_NEIGHBOURS,    /* the multipliers of judged points on both sides */
  MHB_BY_FOLDS,         /* unstable, by the number of folds passed since a judged point */
  MHB_N_JUDGED
};

/* loss of mhb_branch: the cause of instability. Fold: a multiplier is beyond +1, whatever the
 * others do. Such a motion is never seen. Flip and Neimark-Sacker: none is, but others are outside
 * the unit circle. The motion is modulated. */
enum { MHB_NO_LOSS, MHB_LOSS_FOLD, MHB_LOSS_FLIP, MHB_LOSS_NEIMARK_SACKER, MHB_N_LOSSES };

/* Multipliers stored a point. */
enum { MHB_KEPT_MULTIPLIERS = 8 };

/* A search for other branches at one value of the parameter: random starts of the Newton method. */
typedef struct {
  double value;    /* as mhb_branch.value */
  int    order;    /* of the motions searched for */
  int    starts;   /* that were made */
  int    seed;     /* of their random numbers */
  int    found;    /* branches that they led to and that were not known */
  int    untraced; /* further motions that they led to, whose curves were not traced */
} mhb_search;

/* kind of lasting motion, lasting_kind of mhb_branch. */
enum {
  MHB_LASTING_UNKNOWN,   /* not computed */
  MHB_LASTING_WAVE,      /* the wave itself */
  MHB_LASTING_MILD,      /* mean within 5 % of the wave's, worst blade below 1.05 of it */
  MHB_LASTING_MODULATED, /* by few side waves */
  MHB_LASTING_IRREGULAR, /* by many */
  MHB_LASTING_SEVERAL,   /* different starts end differently, or on another wave */
  MHB_LASTING_KINDS
};

/* ring_kind of mhb_branch: the motion of a ring of single blades (mhb/search/ring_motion.h). */
typedef enum {
  MHB_RING_UNKNOWN,   /* at rest, or not known */
  MHB_RING_WAVE,      /* the wave that the load drives, to 1e-6 of the energy */
  MHB_RING_WAVES,     /* others beside it; half of the blades take part, or more */
  MHB_RING_STANDING,  /* the same, 0.9 of the energy in waves that meet an equal one */
  MHB_RING_LOCALISED, /* fewer than half of the blades take part */
  MHB_RING_KINDS
} mhb_ring_kind;

/* A slow sweep of the ring: running windows. */
typedef struct {
  int     n;
  double *frequency;    /* [n] Hz, middle of the window */
  double *mean, *worst; /* [n] m: a period's peak of the output, mean and 99.9 percentile */
} mhb_lasting_curve;

/* Modal amplitudes kept at some points of a branch. The displacement of any node is
 * u(t) = Re sum_k sum_i amplitude[k][i] shape_i exp(j k w t/nu), without the modes left out.
 * These add residual shapes times force, and times scale and the harmonics of the load. */
typedef struct {
  int             n, n_contact;
  int            *point;     /* [n] ascending */
  double complex *amplitude; /* [n][k = 0..m][mode] m kg^1/2 */
  double complex *force; /* [n][k = 0..m][contact dof] N, on the blade, tangential, axial, radial */
  double         *scale; /* [n] of the excitation */
} mhb_modal_motion;

/* What friction does at the contact pairs, at the peaks of a branch. Of a whole period of the
 * motion. */
typedef struct {
  int     n;
  int    *point;       /* [n] ascending */
  double *pressure;    /* [n][pair] Pa, mean */
  double *slip;        /* [n][pair] m, way */
  double *dissipation; /* [n][pair] J/m2 */
  double *state;       /* [n][pair][3] share of the period stuck, slipping, open */
} mhb_face_wear;

/* Where the highest tracked peak is least. */
typedef enum {
  MHB_OPTIMUM_NONE,     /* not looked for, or no branch */
  MHB_OPTIMUM_SMOOTH,   /* one peak is stationary */
  MHB_OPTIMUM_EXCHANGE, /* two peaks of equal height */
  MHB_OPTIMUM_END,      /* at an end of the range */
  MHB_OPTIMUM_JUMP,     /* at the end of a branch: the peak beyond was not followed */
  MHB_OPTIMUM_KINDS
} mhb_optimum_kind;

typedef struct {
  mhb_optimum_kind kind;
  double           value;        /* of the parameter */
  double           error;        /* bound of the bracket it was located in, same unit */
  double           frequency[2]; /* Hz; the second of an exchange, else 0 */
  double           amplitude;    /* m, of the output followed */
  bool             verified;     /* a sweep at the optimum has no higher peak */
} mhb_optimum;

/* What following peaks took; processor seconds of all threads. Not in the file. */
typedef struct {
  int    sweeps;  /* in outline, the first ones and further ones */
  double seeds;   /* s, the first sweeps */
  double further; /* s, sweeps beyond ends of branches and at the optimum */
} mhb_tracking_cost;

/* Of a main curve of a ring of different blades: peaks of its output and of the tuned ring's. */
typedef struct {
  double factor;          /* worst over tuned; 0: not computed */
  double worst, worst_at; /* m, Hz: the blade that swings highest */
  int    blade;           /* that blade, from 0 */
  double mean, mean_at;   /* m, Hz: mean over the blades */
  double tuned, tuned_at; /* m, Hz: the ring with equal blades */
} mhb_amplification;

/* A curve under way: what a later run needs to go on from its last point as if it had never
 * stopped. The curve consists of segments, in the order in which they were traced. Each has its
 * points and a state. mhb/branches/tracer knows the meaning of the numbers. */
typedef struct mhb_unfinished mhb_unfinished;

/* One curve. Array layouts:
 *   motion, force  [point][pair][3 (v, u, w)][k = 0..m]
 *   probe          [point][probe][3 (tangential, axial, radial)][k]
 *   state          [point][pair][3 (stuck, slipping, open)]
 * Signals are x(t) = Re sum_k A_k exp(j k w t/nu), with m and nu of the branch: the harmonic of the
 * excitation is k = nu. */
typedef struct {
  mhb_branch_kind kind;
  mhb_origin      origin;
  int             order, n_harmonics; /* nu, m; the response's unless set before the first point */
  int             main;               /* index of the main branch of the same preload */
  bool            searched;           /* main branch: the search beside it is done, if wanted */
  int             flips_untraced;     /* main branch: flips whose doubled curve was left out */
  int             n_searches;         /* main branch; 0: none was made */
  mhb_search     *search;             /* [n_searches] */
  char           *reason;     /* end of the branch: "end of range", or why it ended before */
  bool            complete;   /* the range was covered */
  mhb_unfinished *unfinished; /* main branch under way or interrupted; else NULL */
  int             n_points, capacity;
  double         *frequency;    /* [point] Hz, of the excitation's first harmonic */
  double         *n0;           /* [point] N, total of the interface, or of the leading one */
  double         *interface_n0; /* [point][n_interfaces] N */
  double         *value;        /* [point] of the parameter followed; Hz for the frequency */
  double complex *motion, *force, *probe;
  int            *stable; /* [point] 1 stable, 0 unstable, -1 not judged */
  int    *special;        /* [point] MHB_ORDINARY ...; a peak of the first harmonic of any output */
  double *state;
  double *dissipation;                     /* [point][pair] J a cycle */
  int    *iterations;                      /* [point] */
  double *seconds;                         /* [point] */
  double *error_newton, *error_truncation; /* [point] relative to the norm of the motion */
  double *error_sampling, *error_modal;    /* the same */
  int    *mark;                            /* [point] MHB_ABOVE_TOLERANCE + ..., 0: none */
  double complex *multiplier; /* [point] the one on the unit circle; tracks_multiplier only */
  /* nonlinear branches only */
  int            *judged;      /* [point] MHB_NOT_JUDGED ... */
  int            *loss;        /* [point] MHB_NO_LOSS ... */
  double complex *multipliers; /* [point][n_multipliers] the largest, by falling modulus; 0: none */
  double         *error_multiplier; /* [point] of the largest; -1: not known */
  int            *at_limit;         /* [point] pairs that stick and reach the friction limit */
  int            *harmonics;        /* [point] of the balance, at most n_harmonics; 0: not known */
  int            *truncation_kind;  /* [point] mhb_truncation_kind */
  double         *error_truncation_max; /* [point] largest error in the period; -1: not known */
  double         *error_spatial;        /* [point] by the number of contact pairs; -1: not judged */
  /* motion that lasts; 0: not computed */
  double *lasting_mean, *lasting_worst;   /* [point] a period's peak over the wave's */
  double *lasting_error;                  /* [point] standard error of the mean */
  double *lasting_offset;                 /* [point] of the strongest side wave */
  int    *lasting_side, *lasting_periods; /* [point] its nodal diameter, -1: none; integrated */
  int    *lasting_kind;                   /* [point] MHB_LASTING_UNKNOWN ... */
  int    *lasting_starts;                 /* [point] disturbed starts that were told apart */
  int    *lasting_reached;                /* [point] of them, this motion */
  double *lasting_least, *lasting_least_worst; /* [point] the smallest of several; else 0 */
  /* how the motion is spread over a ring of single blades; of such rings only */
  double *ring_energy;        /* [point][blade] J, mean kinetic energy */
  double *ring_wave;          /* [point][blade] share of the energy j diameters beside the load's */
  double *ring_standing;      /* [point] share of the energy in standing waves */
  double *ring_participation; /* [point] share of the blades that take part; 0: at rest */
  int    *ring_kind;          /* [point] MHB_RING_UNKNOWN ... */
  char   *lasting;            /* what was computed, or why not; NULL: not yet */
  mhb_lasting_curve lasting_curve;
  mhb_modal_motion  modal;
  mhb_face_wear     wear;
  mhb_amplification amplification;
  /* integration branches only */
  int    *multiple; /* [point] periods of the fundamental until the motion repeats; 0: never */
  int    *periods;  /* [point] periods of the fundamental that were integrated */
  double *distance; /* [point] of the return map, relative */
  double *line_frequency; /* [point][n_lines] Hz, spectrum of motion that does not repeat */
  double *line_amplitude; /* [point][n_lines] m, largest first */
} mhb_branch;

typedef struct {
  int           n_pairs, n_probes, n_harmonics, subharmonics, n_branches, capacity;
  char        **probe_name;
  mhb_branch   *branch;
  mhb_parameter parameter;      /* the one followed */
  int           n_multipliers;  /* kept a point; 0: none, set before the first point */
  int           n_interfaces;   /* 0: one, without a name; set before the first point */
  int           lead;           /* whose parameter is followed */
  char        **interface_name; /* [n_interfaces] */
  int          *interface;      /* [pair] which one; NULL without */
  int           n_lines;        /* of spectra of integrated points; 0: none, set likewise */
  /* copied from the modal model for the report */
  int     n_modes;
  double *mode_frequency, *mode_damping, *eigen_residual; /* [m]; eigen_residual may be NULL */
  int     engine_order, blades;
  bool    turns_right; /* the rotor; the wave is then that of N - E (mhb/problem/wave.h) */
  int     ring; /* number of different blades: pairs and probes of blade 0 come first; 0: a wave */
  bool    unfinished;      /* the run that makes it has more to do */
  bool    lacks_diameters; /* of its disc, without which stability cannot be judged */
  bool    run_up; /* the speed follows the frequency on the engine order; modes of the top speed */
  double  psi, phi;          /* rad, mean of the pairs */
  char   *track, *output;    /* with mhb.track: what is followed, of which output; else NULL */
  bool    tracks_multiplier; /* these are flips or Neimark-Sacker points */
  int     output_harmonic;   /* of the excitation: of the amplitude of outputs; 0, 1: the first */
  mhb_output_quantity       quantity; /* of the amplitude of outputs */
  mhb_optimum               optimum;
  mhb_tracking_cost         cost;    /* of mhb.track */
  mhb_samples              *samples; /* of a mistuned ring; NULL: none were drawn */
  const modal_contact_face *face;    /* that the maps are written on; NULL: no maps; not owned */
} mhb_response;

struct mhb_unfinished {
  mhb_response    *segments; /* a branch each */
  int              n;        /* states, a segment each; at most as many as segments */
  mhb_trace_state *state;    /* [n] */
};

#endif
