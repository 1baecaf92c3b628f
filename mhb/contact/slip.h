/* Slip, integrated panel by panel (eqs. 9, 10).
 *
 * On the friction circle f = mu n e, e = (cos th, sin th), q = (-sin th, cos th); with beta = qKe/eKe and
 * gamma = e.x' - mu n' (the slip rate is gamma/(mu n eKe), so slip ends at gamma = 0, eq. 10), eq. 9 becomes
 *   th' = F(t, th) = [q.x' - beta gamma]/(mu n),
 *   F_th = -[e.x' + beta q.x' + gamma beta']/(mu n),   beta' = (qKq - eKe)/eKe - 2 beta^2.
 * For Ku = k I, beta = 0. Eight-point Gauss collocation (order 16 at the panel's end, A-stable, never evaluated at n = 0),
 * solved by Newton; the same nodes serve as the quadrature of the force. Panels shrink geometrically towards an
 * opening, where th has a singular point.
 *
 * Everything here is in units of one force scale; K enters by its shape alone. The eight nodes are the eight lanes. */
#ifndef MHB_CONTACT_SLIP_H
#define MHB_CONTACT_SLIP_H

#include "mhb/numerics/fourier.h"
#include "mhb/numerics/simd.h"

enum { MHB_NODES = MHB_LANES };

/* Gauss points on [0, 1] and what collocation needs of them. Tables that multiply values at the nodes are stored by
 * columns: sum_j table[j] * value[j]. */
typedef struct {
  mhb_lanes node, weight;
  mhb_lanes A[MHB_NODES];         /* A[j][i] = int_0^{c_i} l_j */
  mhb_lanes monomial[MHB_NODES];  /* coefficients of 1, s, ... s^7 of the interpolant */
  mhb_lanes ahead[MHB_NODES];     /* coefficients of (s - 1)^k of the fit of degree 5 */
  mhb_lanes bernstein[MHB_NODES]; /* Bernstein coefficients of the interpolant, degree 7 */
  mhb_lanes end;                  /* weights of the interpolant's value at s = 1 */
  mhb_lanes legendre[MHB_NODES];  /* Legendre coefficients of the interpolant */
} mhb_collocation;

void mhb_collocation_create(mhb_collocation *rule);

/* What a slip run is about. */
typedef struct {
  const mhb_signals     *signals; /* (n, x_1, x_2) */
  const mhb_collocation *rule;
  double                 K[2][2];
  double                 mean, half, skew; /* K = mean I + [half skew; skew -half] */
  double                 mu;
  double                 peak;      /* largest n of the period */
  double                 harmonic;  /* highest one the panels' sums must resolve */
  double                 longest;   /* panel, rad; at most 1.5 */
  double                 tolerance; /* bound on a panel's error, force units */
  double                 sliver;    /* rad before an opening over which the direction is held */
  double                 begins; /* th' where slip begins: the prediction of a run's first panel */
  int linearized;                /* F_theta and inverse are wanted at the solution, not near it */
} mhb_slip;

/* One panel of slip. */
typedef struct {
  double    t0, h, theta0, theta1;
  int       stiff;        /* theta1 extrapolates the nodes: see collocate in slip.c */
  int       frozen;       /* the last sliver before an opening: theta is held */
  double    left;         /* of the interval in which the contact is closed, from t0 on */
  double    error;        /* estimate for this panel, force units; see panel_error in slip.c */
  mhb_lanes cosine, sine; /* of the phase at the nodes */
  mhb_lanes theta, e[2];  /* direction of the friction */
  mhb_lanes F, F_theta, gamma, eKe, beta;
  mhb_lanes y[3], dy[3];
  mhb_lanes inverse[MHB_NODES]; /* columns of (I - h A diag(F_theta))^-1 */
} mhb_panel;

typedef enum { MHB_SLIP_ON, MHB_SLIP_ENDS, MHB_SLIP_AT_LIMIT, MHB_SLIP_LOST } mhb_slip_outcome;

/* Advance from (t, theta) by one panel, at most to limit. opening: n = 0 at limit. *suggested: panel length to try,
 * updated. The panel that is overwritten serves as the prediction if it ends at t. ENDS: the slip rate is zero at the
 * panel's end (panel->h may be 0: it ended at once). LOST: Newton failed at the shortest panel. */
mhb_slip_outcome mhb_slip_panel(const mhb_slip *slip, double t, double theta, double limit,
                                int opening, double *suggested, mhb_panel *panel);

/* Directional quantities at theta. */
typedef struct {
  double e[2], q[2], beta, beta_theta;
} mhb_direction;

mhb_direction mhb_slip_direction(const double (*K)[2], double theta);

/* gamma = e.x' - mu n' */
double mhb_slip_gamma(const mhb_slip *slip, const mhb_direction *d, const double dy[3]);

/* th' = F */
double mhb_slip_rate(const mhb_slip *slip, double theta, const double y[3], const double dy[3]);

/* The same at a closing, n = 0 < n', where slip begins in direction d: the regular solution
 * th' = [q.x'' - beta (e.x'' - mu n'')]/(mu n' + D), D = e.x' + beta q.x' + gamma beta'. */
double mhb_slip_closing_rate(const mhb_slip *slip, const mhb_direction *d, const double dy[3],
                             const double ddy[3], double *D);

/* Unit vector d with (a I + lambda K) d = x for some lambda >= 0 (|x| >= |a|): the direction in which slip begins
 * when the contact closes (a = mu n', x = x'; eq. 15 for Ku = k I), or the return of x to the unit circle (a = 1). */
void mhb_slip_return(const double (*K)[2], double a, const double x[2], double d[2]);

#endif
