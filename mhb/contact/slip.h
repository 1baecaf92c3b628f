/* Slip, integrated panel by panel (eqs. 9, 10).
 *
 * On the friction circle f = mu n e, e = (cos th, sin th), q = (-sin th, cos th). With beta =
 * qKe/eKe and gamma = e.x' - mu n', eq. 9 becomes
 *   th' = F(t, th) = [q.x' - beta gamma]/(mu n),
 *   F_th = -[e.x' + beta q.x' + gamma beta']/(mu n),   beta' = (qKq - eKe)/eKe - 2 beta^2.
 * For Ku = k I, beta = 0. The slip rate is gamma/(mu n eKe): slip ends at gamma = 0 (eq. 10).
 *
 * A panel is a step of eight-point Gauss collocation, solved by Newton's method. It has order 16,
 * is A-stable, and is never evaluated at n = 0. Its nodes serve as the quadrature of the force, and
 * are the eight lanes of a vector. Panels shrink geometrically towards an opening, a singular point
 * of th.
 *
 * Everything is in units of one force scale; K enters by its shape alone. */
#ifndef MHB_CONTACT_SLIP_H
#define MHB_CONTACT_SLIP_H

#include "mesh/base/status.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/simd.h"

enum { MHB_NODES = MHB_LANES };

/* Gauss points on [0, 1] and the tables of collocation, stored by columns: sum_j table[j] *
 * value[j], value at the nodes. */
typedef struct {
  mhb_lanes node, weight;
  mhb_lanes A[MHB_NODES];         /* A[j][i] = int_0^{c_i} l_j */
  mhb_lanes between[MHB_NODES];   /* the same from the node before, or from 0 */
  mhb_lanes stretch, commutator;  /* its length; factor of b_i x b_i-1, see flow in slip.c */
  mhb_lanes monomial[MHB_NODES];  /* coefficients of 1, s, ... s^7 of the interpolant */
  mhb_lanes bernstein[MHB_NODES]; /* Bernstein coefficients of the interpolant, degree 7 */
  mhb_lanes end;                  /* weights of the interpolant's value at s = 1 */
  mhb_lanes legendre[MHB_NODES];  /* Legendre coefficients of the interpolant */
  /* the eigenvectors V of A in real form, two lanes a conjugate pair: V, V^-1, V^-1 1 */
  mhb_lanes from_modes[MHB_NODES], to_modes[MHB_NODES], one_in_modes;
  mhb_lanes real, imag, modulus2; /* of the eigenvalues; imag with both signs of a pair */
} mhb_collocation;

/* SHB_ERR_IO: no memory. */
shb_status mhb_collocation_create(mhb_collocation *rule);

/* The slip problem of one lap. */
typedef struct {
  const mhb_signals     *signals; /* (n, x_1, x_2) */
  const mhb_collocation *rule;
  double                 K[2][2];
  double                 mean, half, skew; /* K = mean I + [half skew; skew -half] */
  double                 mu;
  double                 peak_load;     /* largest n of the period */
  double                 top_harmonic;  /* the highest that the panels' sums resolve */
  double                 longest_panel; /* rad; at most 1.5 */
  double                 tolerance;     /* bound on a panel's error, force units */
  double                 frozen_length; /* rad before an opening over which theta is held */
  /* exponents of a panel up to which Newton's steps, and T, need no inverse: see slip.c */
  double newton_mild, mild;
  int    linearized; /* F_theta and inverse are wanted at the solution itself */
} mhb_slip;

/* One panel of slip. */
typedef struct {
  double    t0, h, theta0, theta1;
  int       stiff;            /* theta1 extrapolates the nodes: see collocate in slip.c */
  int       frozen;           /* the last stretch before an opening: theta is held */
  double    remaining;        /* length of the closed interval from t0 on, rad */
  double    error;            /* estimate for this panel, force units; see panel_error in slip.c */
  double    end[3], end_e[2]; /* where slip ends: signals, direction of the friction */
  mhb_lanes cosine, sine;     /* of the phase at the nodes */
  mhb_lanes theta, e[2];      /* direction of the friction */
  mhb_lanes F, F_theta, gamma, eKe, beta;
  mhb_lanes y[3], dy[3]; /* signals and their slopes */
  /* the panel linearised, see linearise in slip.c */
  int       dense;              /* the matrix was inverted; else the next three stand for it */
  mhb_lanes inverse[MHB_NODES]; /* dense: columns of (I - h A diag(F_theta))^-1 */
  double    mean;               /* of F_theta over the panel */
  double    apart;              /* largest h |F_theta - mean| */
  mhb_lanes swing, weight;      /* exp int (F_theta - mean); F_theta/swing */
  mhb_lanes even, odd;          /* h A (I - h mean A)^-1 in the eigenvectors of A */
  mhb_lanes transfer;           /* dtheta at the nodes by dtheta at the start */
  double    growth;             /* the same at the end */
} mhb_panel;

/* Slip goes on; its rate is zero at the panel's end; the interval ends with the panel; Newton
 * failed at the shortest panel. */
typedef enum {
  MHB_SLIP_CONTINUES,
  MHB_SLIP_ENDS,
  MHB_SLIP_INTERVAL_ENDS,
  MHB_SLIP_FAILED
} mhb_slip_outcome;

/* Advance from (t, theta) by one panel, at most to limit.
 *   opening    in      n = 0 at limit
 *   suggested  in out  panel length to try, rad
 *   panel      in out  the one before, whose error tells how near to an opening the next may go
 * At MHB_SLIP_ENDS panel->h may be 0: slip ended at once. */
mhb_slip_outcome mhb_slip_panel(const mhb_slip *slip, double t, double theta, double limit,
                                int opening, double *suggested, mhb_panel *panel);

/* dtheta at the nodes, response[q], for a unit drive of dtheta' at node q of a solved panel. */
void mhb_slip_response(const mhb_slip *slip, const mhb_panel *panel, mhb_lanes response[MHB_NODES]);

/* Directional quantities at theta. */
typedef struct {
  double e[2], q[2], beta, beta_theta;
} mhb_direction;

mhb_direction mhb_slip_direction(const double (*K)[2], double theta);

/* gamma = e.x' - mu n' */
double mhb_slip_gamma(const mhb_slip *slip, const mhb_direction *d, const double dy[3]);

/* th' at a closing, n = 0 < n', where slip begins in direction d. The regular solution is
 * th' = [q.x'' - beta (e.x'' - mu n'')]/(mu n' + D), D = e.x' + beta q.x' + gamma beta'. */
double mhb_slip_closing_rate(const mhb_slip *slip, const mhb_direction *d, const double dy[3],
                             const double ddy[3], double *D);

/* Unit vector d with (a I + lambda K) d = x for some lambda >= 0, |x| >= |a|.
 * With a = mu n', x = x': the direction in which slip begins when the contact closes (eq. 15 for
 * Ku = k I). With a = 1: the return of x to the unit circle. */
void mhb_slip_return(const double (*K)[2], double a, const double x[2], double d[2]);

#endif
