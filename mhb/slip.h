/* Slip, integrated panel by panel (eqs. 9, 10).
 *
 * On the friction circle f = mu n e, e = (cos th, sin th), q = (-sin th, cos th); with beta = qKe/eKe and
 * gamma = e.x' - mu n' (the slip rate is gamma/(mu n eKe), so slip ends at gamma = 0, eq. 10), eq. 9 becomes
 *   th' = F(t, th) = [q.x' - beta gamma]/(mu n),
 *   F_th = -[e.x' + beta q.x' + gamma beta']/(mu n),   beta' = (qKq - eKe)/eKe - 2 beta^2.
 * For Ku = k I, beta = 0. Seven-point Gauss collocation (order 14 at the panel's end, A-stable, never evaluated at n = 0),
 * solved by Newton; the same nodes serve as the quadrature of the force. Panels shrink geometrically towards an
 * opening, where th has a singular point.
 *
 * Everything here is in units of one force scale; K enters by its shape alone. */
#ifndef MHB_SLIP_H
#define MHB_SLIP_H

#include "mhb/fourier.h"

enum { MHB_NODES = 7 };

/* Gauss points on [0, 1] and what collocation needs of them. */
typedef struct {
  double node[MHB_NODES], weight[MHB_NODES];
  double A[MHB_NODES][MHB_NODES];        /* int_0^{c_i} l_j */
  double lagrange[MHB_NODES][MHB_NODES]; /* l_j = sum_k lagrange[j][k] s^k */
  double tail[3][MHB_NODES]; /* weights of the Legendre coefficients of degree 1, 2 and 6 */
} mhb_collocation;

void mhb_collocation_create(mhb_collocation *rule);

/* What a slip run is about. */
typedef struct {
  const mhb_signals     *signals; /* (n, x_1, x_2) */
  const mhb_collocation *rule;
  double                 K[2][2];
  double                 mu;
  int                    harmonics; /* highest one the basis at the nodes is needed for */
  double                 longest;   /* panel, rad */
  double                 tolerance; /* bound on a panel's error, force units */
} mhb_slip;

/* One panel of slip. basis, slope: [node][2 harmonics + 1], the caller's memory. */
typedef struct {
  double  t0, h, theta0, theta1;
  double  t[MHB_NODES], theta[MHB_NODES], F[MHB_NODES], F_theta[MHB_NODES];
  double  y[MHB_NODES][3], dy[MHB_NODES][3];
  double  matrix[MHB_NODES][MHB_NODES]; /* LU of I - h A diag(F_theta) */
  int     pivot[MHB_NODES];
  double *basis, *slope;
  double  error; /* estimate for this panel, force units; see panel_error in slip.c */
} mhb_panel;

typedef enum { MHB_SLIP_ON, MHB_SLIP_ENDS, MHB_SLIP_AT_LIMIT, MHB_SLIP_LOST } mhb_slip_outcome;

/* Advance from (t, theta) by one panel, at most to limit. opening: n = 0 at limit. *suggested: panel length to try,
 * updated. ENDS: the slip rate is zero at the panel's end (panel->h may be 0: it ended at once). LOST: Newton failed
 * at the shortest panel. */
mhb_slip_outcome mhb_slip_panel(const mhb_slip *slip, double t, double theta, double limit,
                                int opening, double *suggested, mhb_panel *panel);

/* panel->matrix solved in place for one right-hand side. */
void mhb_panel_solve(const mhb_panel *panel, double rhs[MHB_NODES]);

/* Directional quantities at theta. */
typedef struct {
  double e[2], q[2], beta, beta_theta;
} mhb_direction;

mhb_direction mhb_slip_direction(const double (*K)[2], double theta);

/* gamma = e.x' - mu n' */
double mhb_slip_gamma(const mhb_slip *slip, const mhb_direction *d, const double dy[3]);

/* Unit vector d with (a I + lambda K) d = x for some lambda >= 0 (|x| >= |a|): the direction in which slip begins
 * when the contact closes (a = mu n', x = x'; eq. 15 for Ku = k I), or the return of x to the unit circle (a = 1). */
void mhb_slip_return(const double (*K)[2], double a, const double x[2], double d[2]);

#endif
