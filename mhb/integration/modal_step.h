/* One step of the linear modes, exact under a contact force that is quadratic over the step.
 *
 *   z'' + 2 zeta w z' + w^2 z = f(t),   t = h tau,   f = sum_j f_j l_j(tau)
 * with l_j Lagrange's polynomials at the Radau points c_1..c_3 = 1.
 *
 * The contact does not see w(c_i), w = B z, at the stages, but the values w_i of a cubic
 * polynomial. It agrees with w at the ends of the step, and its derivative is the least-squares fit
 * of w' by degree two. Then
 *   int f . w' dt = sum_i b_i f_i . w_i'   (Radau's weights, exact to degree four):
 * a spring takes at least the energy it stores, and friction at least what it dissipates. No step
 * length makes a passive contact active. The error at the ends of the steps is of order five.
 * With Coriolis terms amplitudes a' = pole a + in . f take the place of the modes (amplitudes.h).
 * Derivation: docs/theory/time_integration.md. */
#ifndef MHB_INTEGRATION_MODAL_STEP_H
#define MHB_INTEGRATION_MODAL_STEP_H

#include "mesh/base/arena.h"
#include "mhb/integration/amplitudes.h"
#include "mhb/structure/modal_structure.h"

enum { MHB_STAGES = 3, MHB_STAGE_FORCES = 3 * MHB_STAGES };

/* Radau IIA with three stages, and its polynomials. */
typedef struct {
  double c[MHB_STAGES], A[MHB_STAGES][MHB_STAGES], inverse[MHB_STAGES][MHB_STAGES]; /* of A */
  double basis[MHB_STAGES][MHB_STAGES]; /* [j][m] l_j = sum_m basis tau^m/m! */
  double kernel[MHB_STAGES]
               [MHB_STAGES]; /* [i][l] w_i = w_0 + int k_i w', k_i = sum_l kernel (1 - tau)^l/l! */
  double dense[MHB_STAGES + 1]
              [MHB_STAGES + 1]; /* [power][0, c_1, c_2, c_3] of the cubic through them */
} mhb_radau;

void mhb_radau_create(mhb_radau *radau);
/* l_j at tau. */
void mhb_radau_lagrange(const mhb_radau *radau, double tau, double l[MHB_STAGES]);

/* Coefficients of the modes for one step, rows of [modes]. Of amplitudes those by z and by f for z
 * are real parts, those by z' and by f for z' imaginary parts. */
typedef enum {
  MHB_STAGE_Z, /* [stage] w_i by z and by z' */
  MHB_STAGE_V = MHB_STAGE_Z + MHB_STAGES,
  MHB_END_Z   = MHB_STAGE_V + MHB_STAGES, /* z at the end by z, z', f_j */
  MHB_END_V,
  MHB_END_F,
  MHB_RATE_Z = MHB_END_F + MHB_STAGES, /* z' at the end */
  MHB_RATE_V,
  MHB_RATE_F,
  MHB_MOMENT           = MHB_RATE_F + MHB_STAGES, /* [5] h^2 G_1..5, see modal_step.c */
  MHB_MOMENT_IMAGINARY = MHB_MOMENT + 5,          /* of amplitudes */
  MHB_MODAL_STEP_ROWS  = MHB_MOMENT_IMAGINARY + 5
} mhb_modal_step_row;

/* The structure in the layout of the steps. */
typedef struct {
  mhb_radau           rule;
  mhb_modal_structure s;
  double             *shape;      /* [side][3 pairs][modes] */
  mhb_amplitudes     *amplitudes; /* with Coriolis terms, else NULL */
  int                 lines;      /* numbers of a blade that move its contacts: modes, or twice */
  const double *motion, *force;   /* [side][3 pairs][lines] contact motion by them, force on them */
  int       n_neighbours; /* sectors coupled to a sector: itself, previous, next. A sector is the
 contacts on the right side of a blade */
  double   *moment;       /* [neighbour][3 pairs][3 pairs][5] scratch */
  shb_arena arena;
} mhb_ring_step;

/* Errors: SHB_ERR_INPUT as mhb_modal_structure_create and mhb_amplitudes_create. */
shb_status mhb_ring_step_create(const mhb_receptance *receptance, const mhb_settings *settings,
                                mhb_ring_step *ring);
void       mhb_ring_step_destroy(mhb_ring_step *ring);

/* Number of a neighbour of a sector. */
static inline int mhb_ring_step_sector(const mhb_ring_step *c, int sector, int neighbour) {
  int n = c->s.blades;
  return neighbour == 0 ? sector : neighbour == 1 ? (sector + n - 1) % n : (sector + 1) % n;
}

/* R between a row of sector 0 and one of its neighbour, m/N. */
double mhb_ring_step_flexibility(const mhb_ring_step *ring, int neighbour, int row, int column);

/* The factored matrix of a stuck contact over a step. */
typedef struct {
  double matrix[MHB_STAGE_FORCES * MHB_STAGE_FORCES];
  int    pivot[MHB_STAGE_FORCES]; /* pivot[0] < 0: not factored yet */
} mhb_stuck_factor;

typedef struct {
  double  h;    /* s */
  double *mode; /* [MHB_MODAL_STEP_ROWS][modes] */
  /* [neighbour][pair][pair by][9 (stage, axis)][9 by]: w_i - R p_i by p, m/N */
  double           *compliance;
  mhb_stuck_factor *stuck; /* [pair] */
  shb_arena         arena;
} mhb_modal_step;

/* contacts: with their compliances; else for the modes alone. */
void mhb_modal_step_create(const mhb_ring_step *ring, bool contacts, mhb_modal_step *step);
void mhb_modal_step_destroy(mhb_modal_step *step);
/* Set all coefficients for a step of h seconds; or those of the modes alone. */
void mhb_modal_step_length(const mhb_ring_step *ring, double h, mhb_modal_step *step);
void mhb_modal_step_modes(const mhb_ring_step *ring, double h, mhb_modal_step *step);

/* What the modes add to w_i by a force at stage j: response[i][j][modes], m/N kg. */
void mhb_modal_step_response(const mhb_ring_step *ring, const mhb_modal_step *step,
                             double *response);

#endif
