/* The contact law over one step of given motion, second order in the step.
 *
 * Over a step the motion (v, u, w) of a contact is a straight line. While the contact slips, the
 * direction e of its friction obeys, with the limit L = mu n, x = Ku s and K = k I,
 *   L e' = x' - (e.x') e,
 * whatever n does. For straight x the flow of e is a Moebius map of the unit circle:
 *   e_1 = ((1 - T^2) e_0 + 2 (1 + T.e_0) T)/(1 + 2 T.e_0 + T^2),  T = tanh(|tau|) tau/|tau|,
 * tau = half the integral of x'/L. Radial return is its backward Euler step, of order one. Onset of
 * slip and closing are placed inside the step. For a general Ku the mean of its eigenvalues takes
 * the place of k. The rest of Ku enters x by the path of the slider, estimated at the middle.
 *
 * Source: Chen, Yang, Menq 1999, eqs. 4-15; the map is derived in docs/theory/lasting.md. */
#ifndef MHB_RING_SLIP_FLOW_H
#define MHB_RING_SLIP_FLOW_H

#include <math.h>
#include <stdbool.h>

#include "mhb/contact/law.h"
#include "mhb/numerics/simd.h"

/* The law of a pair as the step uses it. */
typedef struct {
  double mu, kv, ku[3], n0, offset; /* as in mhb_law; mu = 0: Ku = 0 */
  double mean, skew[2];             /* N/m: Ku = mean I + [skew_0 skew_1; skew_1 -skew_0] */
  bool   isotropic;                 /* skew = 0 */
} mhb_slip_law;

/* A contact between two steps: load n0 + kv v (negative: open), tangential motion, friction. */
typedef struct {
  double load, s[2], f[2]; /* N, m, N */
} mhb_slip_state;

mhb_slip_law mhb_slip_law_of(const mhb_law *law);

/* a where the condition holds, else b. Written with bits: GCC 12 turns ?: of such formulas into
 * jumps, and jumps keep loops from being vectorised. */
MHB_INLINE double mhb_pick(bool condition, double a, double b) {
  long long mask = -(long long)condition, x, y;
  memcpy(&x, &a, sizeof x);
  memcpy(&y, &b, sizeof y);
  x = (mask & x) | (~mask & y);
  memcpy(&a, &x, sizeof a);
  return a;
}

/* Direction of friction after slip along d (N, change of Ku s) while the limit goes from low to
 * high, not normalised. g: friction before, |g| = low. */
MHB_INLINE void mhb_slip_turn(double g0, double g1, double d0, double d1, double low, double high,
                              double *w0, double *w1) {
  double span = low + high, S = span * span, D = d0 * d0 + d1 * d1;
  /* tanh(x)/x by its continued fraction: 4e-6 of tanh at x = 2, 4e-4 at 3 */
  double num = (945 * S + 105 * D) * S + D * D;
  double den = span * ((945 * S + 420 * D) * S + 15 * D * D);
  /* T = num/den d; the map is multiplied by den^2, as only its direction counts */
  double keep = den * den - num * num * D;
  double turn = 2 * num * (low * den + num * (d0 * g0 + d1 * g1));
  bool   far  = D > 9 * S; /* the friction has turned along d */
  *w0         = mhb_pick(far, d0, keep * g0 + turn * d0);
  *w1         = mhb_pick(far, d1, keep * g1 + turn * d1);
}

/* The same for a general Ku, whose slider moves along Ku e: e is where its path is estimated. */
MHB_INLINE void mhb_skew_turn(const mhb_slip_law *c, double e0, double e1, double g0, double g1,
                              double d0, double d1, double low, double high, double *w0,
                              double *w1) {
  double A0 = c->skew[0] * e0 + c->skew[1] * e1, A1 = c->skew[1] * e0 - c->skew[0] * e1;
  double path = (e0 * d0 + e1 * d1 - (high - low)) / (c->mean + e0 * A0 + e1 * A1 + 1e-300);
  path        = mhb_pick(path > 0, path, 0);
  mhb_slip_turn(g0, g1, d0 - path * A0, d1 - path * A1, low, high, w0, w1);
}

/* One step to the motion (v, u, w), for one lane of a loop that is vectorised.
 *   isotropic, closed  in  constants, for the compiler; closed: all loads are positive
 *   state      in out  as above */
MHB_INLINE void mhb_slip_flow(const mhb_slip_law *c, bool isotropic, bool closed, double v,
                              double u, double w, double *load, double *s0, double *s1, double *f0,
                              double *f1) {
  double n0 = *load, n1 = c->n0 + c->kv * v, du = u - *s0, dw = w - *s1;
  bool   closes = !closed && n0 <= 0, opens = n1 <= 0;
  double part = mhb_pick(closes, n1 / (n1 - n0 + 1e-300), 1); /* of the step, in contact */
  double d0 = part * (c->ku[0] * du + c->ku[1] * dw), d1 = part * (c->ku[1] * du + c->ku[2] * dw);
  double g0 = mhb_pick(closes, 0, *f0), g1 = mhb_pick(closes, 0, *f1);
  double L0 = mhb_pick(closes, 0, c->mu * n0), L1 = mhb_pick(opens, 0, c->mu * n1), dL = L1 - L0;
  double t0 = g0 + d0, t1 = g1 + d1;
  /* slip begins at the part beta of the step: |g + beta d| = L0 + beta dL */
  double a = d0 * d0 + d1 * d1 - dL * dL, b = g0 * d0 + g1 * d1 - L0 * dL;
  double e = g0 * g0 + g1 * g1 - L0 * L0, root = b * b - a * e;
  double q    = sqrt(mhb_pick(root > 0, root, 0));
  double beta = mhb_pick(b > 0, -e, q - b) / (mhb_pick(b > 0, b + q, a) + 1e-300);
  beta        = mhb_pick(beta > 1e-9, beta, 1e-9); /* at closing the friction begins along d */
  beta        = mhb_pick(beta < 1, beta, 1);
  double rest = 1 - beta, y0 = g0 + beta * d0, y1 = g1 + beta * d1;
  double Lb = L0 + beta * dL, x0 = rest * d0, x1 = rest * d1, w0, w1;
  mhb_slip_turn(y0, y1, x0, x1, Lb, L1, &w0, &w1);
  if (!isotropic) { /* first by the path at the start, then by that at the middle */
    double k = 1 / sqrt(y0 * y0 + y1 * y1 + 1e-300), e0 = k * y0, e1 = k * y1;
    mhb_skew_turn(c, e0, e1, y0, y1, x0, x1, Lb, L1, &w0, &w1);
    double m = 1 / sqrt(w0 * w0 + w1 * w1 + 1e-300), h0 = e0 + w0 * m, h1 = e1 + w1 * m;
    double h = 1 / sqrt(h0 * h0 + h1 * h1 + 1e-300);
    mhb_skew_turn(c, h * h0, h * h1, y0, y1, x0, x1, Lb, L1, &w0, &w1);
  }
  double length = L1 / sqrt(w0 * w0 + w1 * w1 + 1e-300);
  bool   sticks = t0 * t0 + t1 * t1 <= L1 * L1;
  *f0           = mhb_pick(opens, 0, mhb_pick(sticks, t0, length * w0));
  *f1           = mhb_pick(opens, 0, mhb_pick(sticks, t1, length * w1));
  *load         = n1;
  *s0           = u;
  *s1           = w;
}

/* One step of one contact to the motion u[3] = (v, u, w), m. */
void mhb_slip_step(const mhb_slip_law *law, const double u[3], mhb_slip_state *state);

#endif
