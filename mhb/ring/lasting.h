/* The motion that lasts near a wave: the ring is integrated from disturbed starts, each until it is
 * told apart.
 *
 * The positions and velocities of every blade of the wave are disturbed by 3 to 10 %. A start goes
 * on in coarse steps until it has reached a motion that is known, or has settled at another
 * (exploration.h). Each motion is then measured in fine steps, from the ends of its starts. There
 * are 17: the chance that all miss a motion that one start in six reaches is (5/6)^17 = 4.5 %.
 * A start may also come from the state of a neighbour, whose motion is larger.
 *
 * Of a mistuned ring the wave is the motion of the balance: a_b is over that of the balance, and is
 * weighed by its size. mean is over the mean of the blades, worst over the blade that swings
 * highest there. Rules and how they were found: docs/theory/lasting.md. */
#ifndef MHB_RING_LASTING_H
#define MHB_RING_LASTING_H

#include <complex.h>

#include "mhb/response/response_types.h"
#include "mhb/ring/exploration.h"

/* A wave to start on. */
typedef struct {
  double                omega; /* rad/s of the excitation */
  double                n0;    /* N, total of the leading interface */
  int                   n_harmonics;
  const double complex *force;  /* [3 pairs][n_harmonics + 1] N, of the fundamental */
  double                lowest; /* rad/s, lowest of the waves that share states; 0: omega */
} mhb_wave;

typedef struct {
  mhb_go_on             go_on; /* NULL: to the end */
  void                 *context;
  int                   most_periods; /* of all starts: none begins after them; 0: any */
  const mhb_ring_state *from;         /* start from here alone, and add to the result; or NULL */
  mhb_ring_state       *state;        /* <- that of the largest motion, if it is new; or NULL */
} mhb_lasting_run;

typedef struct {
  int        kind;     /* MHB_LASTING_UNKNOWN ... of mhb/response */
  double     mean;     /* of a period's peak over blades and time, over the wave's */
  double     worst;    /* 99.9 percentile of it over blades and periods, over the wave's */
  double     error;    /* standard error of mean; above 0.01: not settled */
  int        diameter; /* of the strongest side wave; -1: none */
  double     offset;   /* its frequency over the excitation's, less 1 */
  int        periods;  /* integrated, of the fundamental, all starts */
  int        starts;   /* disturbed ones that were told apart */
  int        reached;  /* of them, this motion; 0: a neighbour's state alone led to it */
  double     least, least_worst; /* mean and worst of the smallest motion, if several; else 0 */
  double     size;               /* m: of the blade that swings furthest */
  int        n_motions;
  mhb_motion motion[MHB_LASTING_MOTIONS]; /* [n_motions] in the order in which they were found */
} mhb_lasting;

/* Steps a period of the fundamental: at least `least` a period of the excitation, twice as many
 * until stuck contacts are stable in them. 0: more than 4096 are needed. The model is set to the
 * frequency. */
int mhb_ring_steps(mhb_ring_model *model, double omega, int least);

/* Bytes that mhb_lasting_settle takes. modes: of a blade; mistuned: each blade has its own. */
double mhb_lasting_bytes(int blades, int pairs, int modes, bool mistuned);

/* Settle beside a wave. how may be NULL. kind MHB_LASTING_UNKNOWN: the contact is too stiff for the
 * steps, or stopped. With a state to start from, result is that of the call without. It is not
 * changed where the state leads to a known motion, or if stopped.
 * Errors: as mhb_ring_model_create. */
shb_status mhb_lasting_settle(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, const mhb_lasting_run *how,
                              mhb_lasting *result);

/* Kind from the number of motions, the largest of them, and its share of five lines. */
int mhb_lasting_kind_of(int n, const mhb_motion *largest, double share);

#endif
