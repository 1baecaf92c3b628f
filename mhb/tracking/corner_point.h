/* A peak at the corner between stuck and slipping, or on the stuck side, at one value of the
 * parameter q (docs/theory/tracking.md).
 *
 * The pairs J touch the friction limit: they have their stuck law, with the mean friction c(x) of
 * two phases that touch (mhb/contact/slip_onset). All others have their own law; they may stick,
 * slip or open. With r~ the balance so changed,
 *
 *   r~(x, omega, q) = 0,   h(x, q) = 0                a corner
 *   r~(x, omega, q) = 0,   dA/domega = 0, h < 0       a stuck peak: nothing slips
 *
 * J is one pair, or several that a symmetry makes alike. At fixed q the point is a root in omega.
 * All derivatives follow from one factor of r~_x:
 *
 *   x_omega = -r~_x^-1 r~_omega,   dA/domega = A_omega + A_x x_omega,   dh/domega = h_x x_omega
 *   x_q     = -r~_x^-1 r~_q,       dA/dq along corners = dA/dq - dA/domega (dh/dq)/(dh/domega)
 *
 * h_q at fixed x is a central difference of fourth order of a closed form, good to 1e-11. */
#ifndef MHB_TRACKING_CORNER_POINT_H
#define MHB_TRACKING_CORNER_POINT_H

#include "mhb/balance/newton.h"
#include "mhb/tracking/tracked_curve.h"

typedef struct {
  mhb_balance        *balance;
  const mhb_tracking *tracking;
  bool                stuck;    /* a stuck peak; else a corner */
  double             *x;        /* [n] in, a motion near by; out, that of the last evaluation */
  bool               *touching; /* [pairs] J */
  bool               *closed;   /* [pairs] all of a stuck peak that are not open throughout */
  mhb_newton         *newton;
  double             *jacobian;            /* [n][n] column-major, factored */
  double             *r, *kept;            /* [n] */
  double             *by_omega, *by_value; /* [n] r~_omega, r~_q; then x_omega, x_q */
  double             *by_x, *onset_by_x;   /* [n] A_x, h_x */
  double complex     *weight;              /* [m + 1][3 pairs] */
  int                *pivot;               /* [n] */
  shb_arena           arena;
} mhb_corner;

/* At one (omega, q), with the motion that solves the balance there. */
typedef struct {
  double amplitude, onset;         /* A, m; h, N: the largest of J */
  double by_omega, onset_by_omega; /* derivatives of both at fixed q */
  double by_value, onset_by_value; /* and at fixed omega */
} mhb_corner_state;

/* The balance must outlive it. */
mhb_corner *mhb_corner_create(mhb_balance *balance, const mhb_tracking *tracking);
void        mhb_corner_destroy(mhb_corner *corner);

/* The pairs by which a motion x[n] at a value may be near a corner, the nearest first. Their |h| is
 * a part of the friction limit. Pairs that a symmetry makes alike count as one, by their first.
 *   share  in   of the limit
 *   pair   out  [pairs]
 * Returns how many. */
int mhb_corner_candidates(const mhb_corner *corner, double value, const double *x, double share,
                          int *pair);

/* Take a corner of one of these candidates, or (pair < 0) the stuck peak, near the motion x[n]. */
void mhb_corner_take(mhb_corner *corner, int pair, double value, const double *x);

/* The root at a value.
 *   sense  in     sign of the condition's derivative by omega; 0: either
 *   omega  inout  rad/s: a guess, within 2 % of which the root is sought; the root
 * The motion follows. False: there is none. */
bool mhb_corner_solve(mhb_corner *corner, double value, int sense, double *omega);

/* Solve the balance at (omega, q), J touching. amplitude and onset only; NAN: not solved. */
mhb_corner_state mhb_corner_evaluate(mhb_corner *corner, double omega, double value);

/* The same with derivatives. */
mhb_corner_state mhb_corner_linearise(mhb_corner *corner, double omega, double value);

/* Whether stuck motions go on beyond a corner, into the slipping side. The law's mean friction is
 * the least admissible one. It moves the normal load otherwise than the touching one does, and
 * may keep the pair stuck a little longer. The response curve then turns back at the corner, and
 * the highest amplitude is where those motions end.
 *   sense  in   1: the slipping side is above omega
 *   x      out  [n] the last such motion, which was evaluated last
 *   end    out  rad/s, its frequency; to 1e-10
 * The corner's own motion stays. */
bool mhb_corner_overhangs(mhb_corner *corner, double omega, double value, int sense, double *x,
                          double *end);

/* dA/dq along corners or stuck peaks, at a solution that was linearised. q is a parameter of the
 * operating point, or (damping) a common relative change of all damping ratios. */
double mhb_corner_derivative(mhb_corner *corner, const mhb_corner_state *state, double omega,
                             mhb_parameter parameter, bool damping);

#endif
