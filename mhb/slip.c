#include "mhb/slip.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Legendre polynomial of degree n and its derivative at x. */
static double legendre(int n, double x, double *slope) {
  double p0 = 1, p1 = x;
  for (int k = 2; k <= n; k++) {
    double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
    p0        = p1;
    p1        = p2;
  }
  if (slope) *slope = n * (x * p1 - p0) / (x * x - 1);
  return n == 0 ? 1 : p1;
}

/* Monomial coefficients of the Lagrange polynomial that is 1 at node j. */
static void lagrange_monomials(const double *node, int j, double *c) {
  memset(c, 0, sizeof(double) * MHB_NODES);
  c[0]       = 1;
  int degree = 0;
  for (int i = 0; i < MHB_NODES; i++) {
    if (i == j) continue;
    double scale = 1 / (node[j] - node[i]);
    for (int k = ++degree; k > 0; k--) c[k] = (c[k - 1] - node[i] * c[k]) * scale;
    c[0] *= -node[i] * scale;
  }
}

/* int_0^s l_j */
static double lagrange_integral(const double *c, double s) {
  double sum = 0;
  for (int k = MHB_NODES - 1; k >= 0; k--) sum = sum * s + c[k] / (k + 1);
  return sum * s;
}

void mhb_collocation_create(mhb_collocation *rule) {
  const double pi = 3.141592653589793238463;
  for (int i = 0; i < MHB_NODES; i++) {
    double x = -cos(pi * (i + .75) / (MHB_NODES + .5)), slope = 1;
    for (int k = 0; k < 20; k++) x -= legendre(MHB_NODES, x, &slope) / slope;
    legendre(MHB_NODES, x, &slope);
    rule->node[i]   = .5 * (1 + x);
    rule->weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  for (int j = 0; j < MHB_NODES; j++) {
    lagrange_monomials(rule->node, j, rule->lagrange[j]);
    for (int i = 0; i < MHB_NODES; i++)
      rule->A[i][j] = lagrange_integral(rule->lagrange[j], rule->node[i]);
    const int degree[3] = {1, 2, MHB_NODES - 1};
    for (int k = 0; k < 3; k++)
      rule->tail[k][j] =
          (2 * degree[k] + 1) * rule->weight[j] * legendre(degree[k], 2 * rule->node[j] - 1, NULL);
  }
}

mhb_direction mhb_slip_direction(const double (*K)[2], double theta) {
  mhb_direction d;
  double        c = cos(theta), s = sin(theta);
  d.e[0]       = c;
  d.e[1]       = s;
  d.q[0]       = -s;
  d.q[1]       = c;
  double eKe   = K[0][0] * c * c + 2 * K[0][1] * c * s + K[1][1] * s * s;
  double qKq   = K[0][0] * s * s - 2 * K[0][1] * c * s + K[1][1] * c * c;
  double qKe   = (K[1][1] - K[0][0]) * c * s + K[0][1] * (c * c - s * s);
  d.beta       = qKe / eKe;
  d.beta_theta = (qKq - eKe) / eKe - 2 * d.beta * d.beta;
  return d;
}

double mhb_slip_gamma(const mhb_slip *slip, const mhb_direction *d, const double dy[3]) {
  return d->e[0] * dy[1] + d->e[1] * dy[2] - slip->mu * dy[0];
}

/* F and F_theta */
static void rate(const mhb_slip *slip, double theta, const double y[3], const double dy[3],
                 double *F, double *F_theta) {
  mhb_direction d     = mhb_slip_direction(slip->K, theta);
  double        gamma = mhb_slip_gamma(slip, &d, dy), limit = slip->mu * y[0];
  double        along = d.e[0] * dy[1] + d.e[1] * dy[2], across = d.q[0] * dy[1] + d.q[1] * dy[2];
  *F       = (across - d.beta * gamma) / limit;
  *F_theta = -(along + d.beta * across + gamma * d.beta_theta) / limit;
}

static int factorize(mhb_panel *panel) {
  double(*M)[MHB_NODES] = panel->matrix;
  for (int k = 0; k < MHB_NODES; k++) {
    int p = k;
    for (int i = k + 1; i < MHB_NODES; i++)
      if (fabs(M[i][k]) > fabs(M[p][k])) p = i;
    panel->pivot[k] = p;
    if (!(fabs(M[p][k]) > 1e-300)) return 0;
    for (int j = 0; p != k && j < MHB_NODES; j++) {
      double swap = M[k][j];
      M[k][j]     = M[p][j];
      M[p][j]     = swap;
    }
    double inverse = 1 / M[k][k];
    for (int i = k + 1; i < MHB_NODES; i++) {
      double l = M[i][k] *= inverse;
      for (int j = k + 1; j < MHB_NODES; j++) M[i][j] -= l * M[k][j];
    }
  }
  return 1;
}

void mhb_panel_solve(const mhb_panel *panel, double rhs[MHB_NODES]) {
  const double(*M)[MHB_NODES] = panel->matrix;
  for (int k = 0; k < MHB_NODES; k++) {
    double swap          = rhs[panel->pivot[k]];
    rhs[panel->pivot[k]] = rhs[k];
    rhs[k]               = swap;
  }
  for (int i = 0; i < MHB_NODES; i++)
    for (int j = 0; j < i; j++) rhs[i] -= M[i][j] * rhs[j];
  for (int i = MHB_NODES - 1; i >= 0; i--) {
    for (int j = i + 1; j < MHB_NODES; j++) rhs[i] -= M[i][j] * rhs[j];
    rhs[i] /= M[i][i];
  }
}

static void place_nodes(const mhb_slip *slip, double t, double h, mhb_panel *panel) {
  size_t stride = (size_t)mhb_real_size(slip->harmonics);
  panel->t0     = t;
  panel->h      = h;
  for (int i = 0; i < MHB_NODES; i++) {
    double *basis = panel->basis + (size_t)i * stride, *slope = panel->slope + (size_t)i * stride;
    panel->t[i] = t + h * slip->rule->node[i];
    mhb_basis(slip->harmonics, panel->t[i], basis, slope);
    mhb_signals_with(slip->signals, basis, slope, panel->y[i], panel->dy[i]);
  }
}

/* Accuracy of a panel from the Legendre coefficients a_k of th'. Where they fall as r^k, the superconvergent values (the
 * end, the integrals of the force) err by about a_6 r^8; with r^4 = a_6/a_2 that is a_6 (a_6/a_2)^2. Where they fall
 * slowly (the singular end at an opening) the ratio is near one and the estimate is a_6 itself. Exponent 1.5: caution. */
static double panel_error(const mhb_slip *slip, const mhb_panel *panel) {
  double a[3] = {0, 0, 0}, load = 0;
  for (int i = 0; i < MHB_NODES; i++) {
    for (int k = 0; k < 3; k++) a[k] += slip->rule->tail[k][i] * panel->F[i];
    load = fmax(load, panel->y[i][0]);
  }
  double high = fabs(a[2]), low = fabs(a[0]) + fabs(a[1]);
  double ratio = high < low ? high / low : 1;
  return high * ratio * sqrt(ratio) * panel->h * slip->mu * load;
}

/* Start from the slope at the end of the panel before, if there is one. */
static void predict(const mhb_slip *slip, double slope, mhb_panel *panel) {
  for (int i = 0; i < MHB_NODES; i++)
    panel->theta[i] = panel->theta0 + slope * panel->h * slip->rule->node[i];
}

/* I - h A diag(F_theta), and the residual of the collocation equations. */
static void linearize(const mhb_collocation *rule, mhb_panel *panel, double rhs[MHB_NODES]) {
  double h = panel->h;
  for (int i = 0; i < MHB_NODES; i++) {
    double sum = 0;
    for (int j = 0; j < MHB_NODES; j++) {
      sum += rule->A[i][j] * panel->F[j];
      panel->matrix[i][j] = (i == j) - h * rule->A[i][j] * panel->F_theta[j];
    }
    rhs[i] = panel->theta0 + h * sum - panel->theta[i];
  }
}

/* Newton on the collocation equations from theta; 1 if converged. The factors left are those of the last step. */
static int collocate(const mhb_slip *slip, mhb_panel *panel) {
  double change = INFINITY, before = INFINITY;
  for (int iteration = 0; change > 1e-7; iteration++) {
    double rhs[MHB_NODES];
    for (int i = 0; i < MHB_NODES; i++)
      rate(slip, panel->theta[i], panel->y[i], panel->dy[i], &panel->F[i], &panel->F_theta[i]);
    linearize(slip->rule, panel, rhs);
    if (iteration == 14 || !factorize(panel)) return 0;
    mhb_panel_solve(panel, rhs);
    change = 0;
    for (int i = 0; i < MHB_NODES; i++) {
      panel->theta[i] += rhs[i];
      panel->F[i] += panel->F_theta[i] * rhs[i]; /* what is left is quadratic in the last step */
      change = fmax(change, fabs(rhs[i]));
    }
    if (!(change < 4) || (iteration > 4 && change > .5 * before && change > 1e-7)) return 0;
    before = change;
  }
  panel->theta1 = panel->theta0;
  for (int i = 0; i < MHB_NODES; i++)
    panel->theta1 += panel->h * slip->rule->weight[i] * panel->F[i];
  panel->error = panel_error(slip, panel);
  return isfinite(panel->theta1);
}

/* gamma on the collocation polynomial at fraction s of the panel. */
static double gamma_at(const mhb_slip *slip, const mhb_panel *panel, double s) {
  double theta = panel->theta0, y[3], dy[3];
  for (int j = 0; j < MHB_NODES; j++)
    theta += panel->h * panel->F[j] * lagrange_integral(slip->rule->lagrange[j], s);
  mhb_signals_at(slip->signals, panel->t0 + panel->h * s, y, dy, NULL);
  mhb_direction d = mhb_slip_direction(slip->K, theta);
  return mhb_slip_gamma(slip, &d, dy);
}

/* gamma and its total derivative at the panel's end. */
static double gamma_end(const mhb_slip *slip, const mhb_panel *panel, double *slope) {
  double y[3], dy[3], ddy[3], F, F_theta;
  mhb_signals_at(slip->signals, panel->t0 + panel->h, y, dy, ddy);
  mhb_direction d = mhb_slip_direction(slip->K, panel->theta1);
  rate(slip, panel->theta1, y, dy, &F, &F_theta);
  *slope =
      d.e[0] * ddy[1] + d.e[1] * ddy[2] - slip->mu * ddy[0] + F * (d.q[0] * dy[1] + d.q[1] * dy[2]);
  return mhb_slip_gamma(slip, &d, dy);
}

/* gamma at the nodes and at the panel's end. */
static void gamma_at_nodes(const mhb_slip *slip, const mhb_panel *panel, double *s, double *g) {
  double unused;
  for (int i = 0; i < MHB_NODES; i++) {
    mhb_direction d = mhb_slip_direction(slip->K, panel->theta[i]);
    g[i]            = mhb_slip_gamma(slip, &d, panel->dy[i]);
    s[i]            = slip->rule->node[i];
  }
  g[MHB_NODES] = gamma_end(slip, panel, &unused);
  s[MHB_NODES] = 1;
}

/* A short stick between two nodes: the lowest point of gamma about node i, if it is below zero there. */
static int dips(const mhb_slip *slip, const mhb_panel *panel, const double *s, const double *g,
                int i, double *at, double *value) {
  if (!(g[i] < g[i - 1] && g[i] <= g[i + 1])) return 0;
  double left  = (g[i] - g[i - 1]) / (s[i] - s[i - 1]),
         right = (g[i + 1] - g[i]) / (s[i + 1] - s[i]);
  double bend  = (right - left) / (s[i + 1] - s[i - 1]);
  double there = left + bend * (s[i] - s[i - 1]); /* slope at node i of the parabola */
  if (g[i] - .25 * there * there / bend > .5 * g[i]) return 0;
  *at    = s[i] - .5 * there / bend;
  *value = gamma_at(slip, panel, *at);
  return *value < 0;
}

/* Fraction of the panel at which gamma first turns negative; > 1 if it does not. */
static double slip_end(const mhb_slip *slip, const mhb_panel *panel) {
  double lo = 0, glo = 0, hi = 2, ghi = 0, s[MHB_NODES + 1], g[MHB_NODES + 1];
  gamma_at_nodes(slip, panel, s, g);
  for (int i = 0; i <= MHB_NODES && hi > 1; i++) {
    double at, value;
    if (g[i] >= 0 && i > 0 && i < MHB_NODES && dips(slip, panel, s, g, i, &at, &value)) {
      hi  = at;
      ghi = value;
      if (at < s[i]) continue; /* from the node before */
    } else if (g[i] < 0) {
      hi  = s[i];
      ghi = g[i];
      continue;
    }
    lo  = s[i];
    glo = g[i];
  }
  if (hi > 1) return hi;
  if (lo == 0) glo = gamma_at(slip, panel, 0);
  if (glo <= 0) return 0;
  for (int i = 0; i < 60 && hi - lo > 1e-9; i++) { /* Illinois */
    double at = (lo * ghi - hi * glo) / (ghi - glo);
    if (!(at > lo && at < hi)) at = .5 * (lo + hi);
    double value = gamma_at(slip, panel, at);
    if (value < 0) {
      hi  = at;
      ghi = value;
      glo *= i ? .5 : 1;
    } else {
      lo  = at;
      glo = value;
      ghi *= i ? .5 : 1;
    }
    if (fabs(value) < 1e-15) break;
  }
  return .5 * (lo + hi);
}

/* Shorten the panel until gamma = 0 at its very end. */
static mhb_slip_outcome settle_end(const mhb_slip *slip, double fraction, mhb_panel *panel) {
  double whole = panel->h, h = fraction * whole;
  for (int i = 0; i < 8; i++) {
    if (h < 1e-12) {
      panel->h      = 0;
      panel->theta1 = panel->theta0;
      return MHB_SLIP_ENDS;
    }
    double slope = panel->F[0];
    place_nodes(slip, panel->t0, h, panel);
    predict(slip, slope, panel);
    if (!collocate(slip, panel)) return MHB_SLIP_LOST;
    double change, gamma = gamma_end(slip, panel, &change), step = -gamma / change;
    if (!isfinite(step) || fabs(step) < 2e-14 * (1 + panel->t0) || fabs(step) > .5 * h) break;
    if (i > 0 && fabs(step) < 1e-11) break; /* Newton: quadratically below rounding now */
    h = fmin(whole, h + step);
  }
  return MHB_SLIP_ENDS;
}

/* The last sliver before an opening: the direction is held, the force there is of second order in its length. */
static void freeze(const mhb_slip *slip, double t, double h, double theta, mhb_panel *panel) {
  place_nodes(slip, t, h, panel);
  memset(panel->matrix, 0, sizeof panel->matrix);
  for (int i = 0; i < MHB_NODES; i++) {
    panel->theta[i]     = theta;
    panel->F[i]         = 0;
    panel->F_theta[i]   = 0;
    panel->matrix[i][i] = 1;
    panel->pivot[i]     = i;
  }
  panel->theta0 = panel->theta1 = theta;
  panel->error                  = 0;
}

static const double SLIVER = 1e-7, SHORTEST = 1e-9;

mhb_slip_outcome mhb_slip_panel(const mhb_slip *slip, double t, double theta, double limit,
                                int opening, double *suggested, mhb_panel *panel) {
  double left = limit - t, slope = panel->t0 + panel->h == t ? panel->F[MHB_NODES - 1] : 0;
  if (opening && left < SLIVER) {
    freeze(slip, t, left, theta, panel);
    return MHB_SLIP_AT_LIMIT;
  }
  double h  = fmin(*suggested, opening ? .8 * left : left);
  int    ok = 0;
  while (!ok) {
    panel->theta0 = theta;
    place_nodes(slip, t, h, panel);
    predict(slip, slope, panel);
    ok = collocate(slip, panel) && (panel->error < slip->tolerance || h < 1e-4);
    if (ok) break;
    h *= .5;
    slope = 0;
    if (h < SHORTEST) return MHB_SLIP_LOST;
  }
  int at_limit = !opening && h >= left * (1 - 1e-15);
  *suggested   = fmin(slip->longest, 2 * h);
  double end   = slip_end(slip, panel);
  if (end <= 1) return settle_end(slip, end, panel);
  return at_limit ? MHB_SLIP_AT_LIMIT : MHB_SLIP_ON;
}

/* In the eigenbasis of K: sum_i (x_i/(a + lambda k_i))^2 = 1, lambda >= 0; decreasing and convex in lambda, so Newton
 * from below is monotone. */
void mhb_slip_return(const double (*K)[2], double a, const double x[2], double d[2]) {
  double mean = .5 * (K[0][0] + K[1][1]), half = .5 * (K[0][0] - K[1][1]);
  double radius = hypot(half, K[0][1]), angle = .5 * atan2(K[0][1], half);
  double c = cos(angle), s = sin(angle), k[2] = {mean + radius, mean - radius};
  double xi[2] = {c * x[0] + s * x[1], -s * x[0] + c * x[1]}, size = hypot(xi[0], xi[1]);
  double low = fmax(0, (size - a) / k[0]), high = fmax(low, (size - a) / k[1]), lambda = low;
  double di[2] = {0, 0};
  for (int i = 0; i < 100; i++) {
    double sum = 0, slope = 0;
    for (int j = 0; j < 2; j++) {
      di[j] = xi[j] / (a + lambda * k[j]);
      sum += di[j] * di[j];
      slope -= 2 * di[j] * di[j] * k[j] / (a + lambda * k[j]);
    }
    double step = (1 - sum) / slope; /* Newton on the sum */
    if (!(fabs(step) > 1e-16 * high)) break;
    lambda = fmin(high, fmax(low, lambda + step));
    if (fabs(step) < 1e-15 * lambda) break;
  }
  double norm = hypot(di[0], di[1]);
  if (!(norm > 0)) {
    d[0] = 1;
    d[1] = 0;
    return;
  }
  d[0] = (c * di[0] - s * di[1]) / norm;
  d[1] = (s * di[0] + c * di[1]) / norm;
}
