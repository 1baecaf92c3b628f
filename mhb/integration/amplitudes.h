/* Modes of a blade that Coriolis terms couple, as amplitudes that do not meet.
 *
 * Of the poles of (W q, q') (mhb/structure/gyroscopic.h) one of each conjugate pair is kept:
 *   (q, q') = 2 Re(V a),   a' = pole a + V^-1 (0, f)
 * with the modal force f. Modes that the Coriolis matrix does not join are groups of their own.
 * On a disc those of a nodal diameter are one. */
#ifndef MHB_INTEGRATION_AMPLITUDES_H
#define MHB_INTEGRATION_AMPLITUDES_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mhb/structure/modal_structure.h"

/* Responses to powers of tau, of MHB_POWERS orders. */
enum { MHB_POWERS = 7 };

typedef struct {
  int             modes;            /* of a blade; as many amplitudes */
  double complex *pole;             /* [modes] 1/s */
  int             n_groups, *first; /* [n_groups + 1] place of the first mode in member */
  int            *member;           /* [modes] */
  double complex *to_state;         /* of each group [2 size][size], 2 V; its real part counts */
  double complex *to_amplitude;     /* of each group [size][2 size], V^-1 */
  double         *motion, *force;   /* [side][3 pairs][2 modes], real and imaginary parts last:
                                        * contact motion by an amplitude; its rate by B^T f */
  shb_arena       arena;
} mhb_amplitudes;

/* Of a model with Coriolis terms.
 *   shape  in  [side][3 pairs][modes] of the structure
 * SHB_ERR_INPUT: a mode does not oscillate. */
shb_status mhb_amplitudes_create(const modal_model *model, const mhb_modal_structure *structure,
                                 const double *shape, mhb_amplitudes **amplitudes);
void       mhb_amplitudes_destroy(mhb_amplitudes *amplitudes);

/* z, v [modes]: from q and q' to real and imaginary parts of the amplitudes, and back. */
void mhb_amplitudes_take(const mhb_amplitudes *amplitudes, double *z, double *v);
void mhb_amplitudes_give(const mhb_amplitudes *amplitudes, double *z, double *v);

/* response[k] <- sum_n x^n/(n + k)!: at tau = 1 the answer of a' = x a + tau^(k-1)/(k-1)! from 0;
 * response[0] = e^x. */
void mhb_amplitudes_responses(double complex x, double complex response[MHB_POWERS]);

#endif
