/* Floquet multipliers of a periodic solution: is it stable?
 *
 * The variational equation is integrated over one period of the fundamental (monodromy.h). The
 * multipliers are the eigenvalues of the resulting map. Left out are - the two multipliers 1 of a
 * contact that sticks for the whole period: a family of static frictions,
 *   not an infloquet;
 * - the exact zeros of friction states that slip or opening makes meaningless. If no contact slips,
 * opens or closes, the exponents are those of a linear structure and reused from call to call
 * (linear_exponents.h).
 *
 * For a wave around the ring any disturbance of any blade is followed, whether or not it has the
 * form of the wave. Integrated is g/N of a period, after which the blades are renamed
 * (transition_schedule.h). In a mistuned ring the whole period is integrated, and nothing repeats.
 * There are 2 modes + 2 contacts states a blade. If these exceed max_states the lowest modes keep
 * their dynamics and the others respond statically. A ring of g cells has g^1/2 times as many
 * states where modes within five times the highest frequency need them. Derivation:
 * docs/theory/stability.md. */
#ifndef MHB_FLOQUET_FLOQUET_H
#define MHB_FLOQUET_FLOQUET_H

#include <complex.h>
#include <stdbool.h>

#include "mhb/floquet/monodromy.h"

typedef enum { MHB_STABLE, MHB_MARGINAL, MHB_UNSTABLE, MHB_UNDECIDED } mhb_verdict;

/* Place where the largest multiplier leaves the unit circle: fold, flip, Neimark-Sacker. */
typedef enum { MHB_THROUGH_PLUS_ONE, MHB_THROUGH_MINUS_ONE, MHB_THROUGH_PAIR } mhb_crossing;

typedef struct {
  mhb_verdict  verdict;
  mhb_crossing crossing; /* of the largest multiplier, stable or not */
  int          n;        /* multipliers computed */
  /* [n] by falling modulus, conjugates side by side; valid until the next call */
  const double complex *multiplier;
  int                   n_stuck;    /* multipliers 1 left out */
  int                   n_zero;     /* exact zeros left out */
  int                   n_unstable; /* modulus above the margin */
  int                   n_fold; /* of these: positive, with the symmetry of the wave (bloch.h) */
  int                   modes; /* with dynamics; fewer than the model's if max_states was reached */
  double                largest; /* modulus of the first */
  double                change;  /* of largest by the last halving of the sub-steps; -1: none */
  double                error;   /* of largest by the harmonics left out; -1 before it is judged */
  const char           *reason;  /* why there are no multipliers, else NULL */
} mhb_multipliers;

typedef struct mhb_floquet mhb_floquet; /* workspace; one a thread */

/* For the harmonics of settings.
 *   substeps    in  of a period of the fundamental, to begin with
 *   max_states  in  0: 600. In a mistuned ring it bounds the states of linear motions too
 * The receptance must outlive it.
 * Errors: SHB_ERR_INPUT substeps < 1; SHB_ERR_IO no memory for a contact evaluator. */
shb_status mhb_floquet_create(const mhb_receptance *receptance, const mhb_settings *settings,
                              int substeps, int max_states, mhb_floquet **floquet);
void       mhb_floquet_destroy(mhb_floquet *floquet);

/* Bytes that multipliers take: the matrices of contacts and states, at most those of one cell. The
 * samples of slip are those of four times the first sub-steps, 128 a period.
 *   blades    in  1: on the ground
 *   mistuned  in  a ring of different blades */
double mhb_floquet_bytes(int blades, int pairs, int modes, bool mistuned, int max_states);

/* Take the structure anew from a receptance whose speed has changed in a run-up. */
void mhb_floquet_move(mhb_floquet *floquet, const mhb_receptance *receptance);

/* Number of equal cells of the ring, gcd(E, N); the work is proportional to 1/cells^2. 1 for a
 * blade on the ground. */
int mhb_floquet_cells(const mhb_floquet *floquet);

/* States that are integrated where contacts slip; 0: none, max_states is too small. */
int mhb_floquet_states(const mhb_floquet *floquet);

/* Multipliers of a solution. No allocation.
 *   MHB_UNSTABLE   largest > 1 + max(1e-3, change)
 *   MHB_MARGINAL   largest above 1 within that margin
 *   MHB_UNDECIDED  the contact law failed at the solution, 16 times the sub-steps do not decide, or
 *                  a mode within three times the excitation has no dynamics */
void mhb_floquet_evaluate(mhb_floquet *floquet, const mhb_solution *solution,
                          mhb_multipliers *multipliers);

/* Distance of the largest modulus from that above which a solution is unstable. */
double mhb_floquet_distance(const mhb_multipliers *multipliers);

/* The error of `largest` by the harmonics left out, from a better solution of more harmonics:
 * |largest_better - largest|/(1 - remaining). The verdict is MHB_UNDECIDED within the error.
 *   multipliers  inout  of the last evaluation
 *   remaining    in     the error of the better solution over that of the first */
void mhb_floquet_judge_error(mhb_floquet *floquet, const mhb_solution *better, double remaining,
                             mhb_multipliers *multipliers);

/* Set the error. The verdict is MHB_UNDECIDED within it. */
void mhb_floquet_set_error(double error, mhb_multipliers *multipliers);

/* The same multipliers at fixed sub-steps, one Bloch problem at a time (followed_multiplier.h). */

/* How often the last evaluation refined the sub-steps; 0: no contact slips, opens or closes. */
int mhb_floquet_refinement(const mhb_floquet *floquet);

/* Set the map of disturbances, of fourth order, for a solution and a refinement.
 *   keep  in  the number of sub-steps between transitions is that of the last call, where there are
 *             as many transitions: the map is then a smooth function of a solution nearby
 * Returns NULL, or the reason of a failure. */
const char *mhb_floquet_set_map(mhb_floquet *floquet, const mhb_solution *solution, int refinement,
                                bool keep);

/* Bloch problems of a ring; 1 for a blade on the ground. Whether that of a wave is real. */
int  mhb_floquet_waves(const mhb_floquet *floquet);
bool mhb_floquet_is_real(const mhb_floquet *floquet, int wave);

/* Segments of a period: the multiplier's modulus is the eigenvalue's to this power. */
int mhb_floquet_segments(const mhb_floquet *floquet);

/* [n] eigenvalues of the map for a wave, valid until the next call; NULL: the solver failed. */
const double complex *mhb_floquet_eigenvalues(mhb_floquet *floquet, int wave, int *n);

/* The multiplier that belongs to an eigenvalue. */
double complex mhb_floquet_multiplier(const mhb_floquet *floquet, int wave, double complex lambda);

#endif
