/* The motion that lasts near a wave: the ring is integrated from two disturbed starts until its
 * statistics are settled.
 *
 * Every blade of the wave is disturbed by 3 % and by 10 %. Blocks have 25 periods; the first half
 * is discarded. A start is settled by mhb_block_mean_is_settled; both agree if their means are
 * within 1 % or three standard errors and their percentiles within 3 %. The spread of a block is
 *   D^2 = mean over blades and periods of |a_b - mean|^2/|mean|^2,
 * a_b the first harmonic of the output with the lag of the wave undone.
 *
 * Of a mistuned ring the wave is the motion of the balance: a_b is over that of the balance, and is
 * weighed by its size. mean is over the mean of the blades, worst over the blade that swings
 * highest there. Rules and how they were found: docs/theory/lasting.md. */
#ifndef MHB_RING_LASTING_H
#define MHB_RING_LASTING_H

#include <complex.h>

#include "mhb/response/response_types.h"
#include "mhb/ring/ring_model.h"

/* A wave to start on. */
typedef struct {
  double                omega; /* rad/s of the excitation */
  double                n0;    /* N, total of the leading interface */
  int                   n_harmonics;
  const double complex *force; /* [3 pairs][n_harmonics + 1] N, of the fundamental */
} mhb_wave;

typedef struct {
  int    kind;     /* MHB_LASTING_UNKNOWN ... of mhb/response */
  double mean;     /* of a period's peak over blades and time, over the wave's */
  double worst;    /* 99.9 percentile of it over blades and periods, over the wave's */
  double error;    /* standard error of mean; above 0.01: not settled */
  int    diameter; /* of the strongest side wave; -1: none */
  double offset;   /* its frequency over the excitation's, less 1 */
  int    periods;  /* integrated, of the fundamental, all starts */
} mhb_lasting;

/* Called after every period; false: stop. May be NULL. */
typedef bool (*mhb_go_on)(void *context);

/* Steps a period of the fundamental: at least `least` a period of the excitation, twice as many
 * until stuck contacts are stable in them. 0: more than 4096 are needed. The model is set to the
 * frequency. SHB_ERR_IO: no memory. */
shb_status mhb_ring_steps(mhb_ring_model *model, double omega, int least, int *steps);

/* Bytes that mhb_lasting_settle takes. modes: of a blade; mistuned: each blade has its own. */
double mhb_lasting_bytes(int blades, int pairs, int modes, bool mistuned);

/* Settle beside a wave. kind MHB_LASTING_UNKNOWN: the contact is too stiff for the steps, or
 * stopped.
 * Errors: as mhb_ring_model_create. */
shb_status mhb_lasting_settle(const modal_model *modal, const mhb_settings *settings,
                              const mhb_wave *wave, mhb_go_on go_on, void *context,
                              mhb_lasting *result);

/* ---- the decision, from the series of both starts ---- */

/* One start: mean of the peaks and spread of each block [blocks], over the wave's, and the peaks
 * [n_peaks] of the half that counts. The call sorts them. */
typedef struct {
  int           blocks, n_peaks;
  const double *mean, *spread;
  double       *peak;
  bool          mistuned; /* steps err differently in every blade: a spread of 1 % is none */
} mhb_lasting_series;

typedef struct {
  bool   decided; /* else more blocks are wanted */
  bool   wave;    /* both starts are on a wave; else statistics hold */
  bool   several;
  int    leader; /* start with the larger mean */
  double mean, worst, error;
} mhb_lasting_verdict;

/* last: no more blocks can be had. */
mhb_lasting_verdict mhb_lasting_judge(mhb_lasting_series series[2], bool last);

/* Kind from a verdict and the share of five lines. */
int mhb_lasting_kind_of(const mhb_lasting_verdict *verdict, double share);

#endif
