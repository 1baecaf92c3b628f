#include "mhb/contact/slip.h"

#include <float.h>
#include <lapacke.h>

#include "mesh/base/constants.h"

/* ---- the collocation rule ---- */

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

static double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; i++) b *= (double)(n - k + i) / i;
  return b;
}

/* Column j of the tables, of the values one at node j and zero at the others. */
static void table_column(mhb_collocation *rule, const double *node, const double *weight, int j) {
  double c[MHB_NODES], x = 2 * node[j] - 1;
  lagrange_monomials(node, j, c);
  rule->end[j] = 0;
  for (int i = 0; i < MHB_NODES; i++) {
    rule->A[j][i]        = lagrange_integral(c, node[i]);
    rule->between[j][i]  = rule->A[j][i] - (i > 0 ? rule->A[j][i - 1] : 0);
    rule->monomial[j][i] = c[i];
    rule->end[j] += c[i];
    /* s^k = sum_i C(i,k)/C(7,k) B_i */
    double bernstein = 0;
    for (int k = 0; k <= i; k++) bernstein += binomial(i, k) / binomial(MHB_NODES - 1, k) * c[k];
    rule->bernstein[j][i] = bernstein;
  }
  for (int k = 0; k < MHB_NODES; k++)
    rule->legendre[j][k] = (2 * k + 1) * weight[j] * legendre(k, x, NULL);
}

/* Eigenvectors and eigenvalues of A: four conjugate pairs. */
static shb_status take_modes(mhb_collocation *rule) {
  double matrix[MHB_NODES * MHB_NODES], vectors[MHB_NODES * MHB_NODES], left[1];
  double inverse[MHB_NODES * MHB_NODES] = {0}, real[MHB_NODES], imag[MHB_NODES], two[MHB_NODES];
  int    pivots[MHB_NODES];
  for (int j = 0; j < MHB_NODES; j++) lanes_store(matrix + j * MHB_NODES, rule->A[j]);
  for (int j = 0; j < MHB_NODES; j++) inverse[j * (MHB_NODES + 1)] = 1;
  int info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', MHB_NODES, matrix, MHB_NODES, real, imag,
                           left, 1, vectors, MHB_NODES);
  for (int j = 0; j < MHB_NODES; j++) {
    rule->from_modes[j] = lanes_load(vectors + j * MHB_NODES);
    two[j]              = real[j] * real[j] + imag[j] * imag[j];
  }
  if (info == 0)
    info = LAPACKE_dgesv(LAPACK_COL_MAJOR, MHB_NODES, MHB_NODES, vectors, MHB_NODES, pivots,
                         inverse, MHB_NODES);
  SHB_CHECK(info == 0, SHB_ERR_IO, "out of memory");
  rule->one_in_modes = lanes_all(0);
  for (int j = 0; j < MHB_NODES; j++) {
    rule->to_modes[j] = lanes_load(inverse + j * MHB_NODES);
    rule->one_in_modes += rule->to_modes[j];
  }
  rule->real     = lanes_load(real);
  rule->imag     = lanes_load(imag);
  rule->modulus2 = lanes_load(two);
  return SHB_OK;
}

shb_status mhb_collocation_create(mhb_collocation *rule) {
  double node[MHB_NODES], weight[MHB_NODES];
  for (int i = 0; i < MHB_NODES; i++) {
    double x = -cos(SHB_PI * (i + .75) / (MHB_NODES + .5)), slope = 1;
    for (int k = 0; k < 20; k++) x -= legendre(MHB_NODES, x, &slope) / slope;
    legendre(MHB_NODES, x, &slope);
    node[i]   = .5 * (1 + x);
    weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  rule->node   = lanes_load(node);
  rule->weight = lanes_load(weight);
  for (int j = 0; j < MHB_NODES; j++) table_column(rule, node, weight, j);
  for (int i = 0; i < MHB_NODES; i++) {
    double length = node[i] - (i > 0 ? node[i - 1] : 0);
    /* before the first node b is the straight line through the first two */
    rule->stretch[i]    = length;
    rule->commutator[i] = length * length / 24 * (i > 0 ? 1 : node[0] / (node[1] - node[0]));
  }
  return take_modes(rule);
}

/* ---- the differential equation ---- */

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

/* F, F_theta, gamma, eKe, beta at the nodes from theta; over = 1/(mu n). */
MHB_INLINE void rate(const mhb_slip *slip, mhb_lanes over, mhb_panel *p) {
  mhb_lanes c, s;
  lanes_cos_sin(p->theta, &c, &s);
  mhb_lanes along = c * p->dy[1] + s * p->dy[2], across = c * p->dy[2] - s * p->dy[1];
  p->e[0]  = c;
  p->e[1]  = s;
  p->gamma = along - slip->mu * p->dy[0];
  if (slip->half == 0 && slip->skew == 0) {
    p->F       = across * over;
    p->F_theta = -along * over;
    p->beta    = lanes_all(0);
    p->eKe     = lanes_all(slip->mean);
    return;
  }
  mhb_lanes c2 = c * c - s * s, s2 = 2 * c * s, rotate = slip->half * c2 + slip->skew * s2;
  p->eKe               = slip->mean + rotate;
  p->beta              = (slip->skew * c2 - slip->half * s2) / p->eKe;
  mhb_lanes beta_theta = -2 * rotate / p->eKe - 2 * p->beta * p->beta;
  p->F                 = (across - p->beta * p->gamma) * over;
  p->F_theta           = -(along + p->beta * across + p->gamma * beta_theta) * over;
}

/* sum_j table[j] x[j] */
MHB_INLINE mhb_lanes apply(const mhb_lanes table[MHB_NODES], mhb_lanes x) {
  mhb_lanes even = table[0] * lanes_pick(x, 0), odd = table[1] * lanes_pick(x, 1);
#pragma GCC unroll 8
  for (int j = 2; j < MHB_NODES; j += 2) {
    even += table[j] * lanes_pick(x, j);
    odd += table[j + 1] * lanes_pick(x, j + 1);
  }
  return even + odd;
}

static const mhb_lanes UNIT[MHB_NODES] = {{1, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0},
                                          {0, 0, 1, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0},
                                          {0, 0, 0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1, 0, 0},
                                          {0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 0, 0, 1}};

/* The inverse of M = I - h A diag(F_theta), by columns. Gauss-Jordan in place on the transpose,
 * whose rows are the columns that it wants. Pivoting is not needed: the diagonal of Gauss' matrix
 * rule->A is positive, and F_theta <= 0 where slip is stiff. Returns 0 if a pivot vanishes. */
MHB_HOT static int invert(const mhb_collocation *rule, mhb_panel *p) {
  mhb_lanes M[MHB_NODES], scale = -p->h * p->F_theta, pivots = lanes_all(0);
#pragma GCC unroll 8
  for (int j = 0; j < MHB_NODES; j++) M[j] = UNIT[j] + rule->A[j] * lanes_pick(scale, j);
#pragma GCC unroll 8
  for (int k = 0; k < MHB_NODES; k++) {
    mhb_lanes pivot = lanes_pick(M[k], k);
    M[k]            = (M[k] + UNIT[k] * (1 - pivot)) / pivot;
    pivots += UNIT[k] * pivot;
    mhb_lanes row = M[k] + UNIT[k];
#pragma GCC unroll 8
    for (int i = 0; i < MHB_NODES; i++)
      if (i != k) M[i] -= row * lanes_pick(M[i], k);
  }
#pragma GCC unroll 8
  for (int j = 0; j < MHB_NODES; j++) p->inverse[j] = M[j];
  return lanes_bottom(lanes_abs(pivots)) > .02;
}

/* Exponent of a panel up to which Newton's steps and T need no inverse, and what a step errs by
 * there. Beyond it that grows like the eighth power. Below 2 it falls like the fourth: fewer steps
 * on the motions of tests/support/motion_suite, with the same errors. */
static const double MILD = 3, ROUGH = 1e-4;

MHB_INLINE void place_nodes(const mhb_slip *slip, double t, double h, mhb_panel *p) {
  p->t0     = t;
  p->h      = h;
  p->frozen = p->stiff = 0;
  lanes_cos_sin(t + h * slip->rule->node, &p->cosine, &p->sine);
  mhb_signals_at_lanes(slip->signals, p->cosine, p->sine, p->y, p->dy);
}

static double power16(double x) {
  x *= x;
  x *= x;
  x *= x;
  return x * x;
}

/* Error of a panel, as an integral of force: of the direction and of the quadrature.
 *
 * Direction, from the Legendre coefficients a_k of th'. Where they fall as r^k, the superconvergent
 * values (the end, the integrals) err by about a_6 r^10, at most a_6 (a_6/a_2)^2. Pairs of
 * coefficients stand for one, since one may vanish. Where they fall slowly, towards an opening, the
 * ratio tends to 1 and the estimate to a_6. The rounding of th' is subtracted.
 *
 * Where th' is stiff, its polynomial shows the transient from the start, which is no error of the
 * panel. There the a_k are those of theta at the nodes. The end errs by a_6 (a_6/a_2), over at most
 * h/20.
 *
 * The error of the end acts over one radian, or over the remainder of the interval. While n grows
 * it counts by the largest n of the period.
 *
 * Quadrature: Gauss's of exp(jkt) errs by h (8!)^4/(17 (16!)^3) (k h)^16, k the highest harmonic
 * wanted plus that of the force. */
MHB_INLINE double panel_error(const mhb_slip *slip, const mhb_panel *p) {
  mhb_lanes values = p->stiff ? (p->theta - p->theta0) / p->h : p->F;
  mhb_lanes a      = lanes_abs(apply(slip->rule->legendre, values));
  double    high = a[6] + a[7], low = a[1] + a[2], ratio = high < low ? high / low : 1;
  double    n = lanes_top(p->y[0]), scale = p->h * slip->mu;
  double    carried = p->dy[0][MHB_NODES - 1] > 0 && !p->stiff ? slip->peak_load : n;
  if (p->remaining < 1) carried *= p->remaining;
  double wave   = (slip->top_harmonic + lanes_top(lanes_abs(values))) * p->h;
  double sums   = scale * 1.7e-23 * power16(wave) * n;
  double turned = high * ratio * (p->stiff ? p->h : ratio) * scale * carried;
  if (p->stiff || turned < .01 * slip->tolerance) return turned + sums;
  mhb_lanes pull = (lanes_abs(p->dy[1]) + lanes_abs(p->dy[2])) * (1 + lanes_abs(p->beta));
  high           = mhb_most(0, high - 1e-15 * lanes_top(pull / (slip->mu * p->y[0])));
  ratio          = high < low ? high / low : 1;
  return high * ratio * ratio * scale * carried + sums;
}

/* F, F_theta, e after a step of theta for K = k I. F_theta is then the quarter turn of F. The end
 * of `collocate` sets gamma. */
MHB_INLINE void turn(mhb_panel *p, mhb_lanes step, double size) {
  mhb_lanes c, s, F = p->F, e0 = p->e[0];
  if (size < .78) {
    lanes_cos_sin_small(step, &c, &s);
  } else {
    lanes_cos_sin(step, &c, &s);
  }
  p->F       = c * F + s * p->F_theta;
  p->F_theta = c * p->F_theta - s * F;
  p->e[0]    = c * e0 - s * p->e[1];
  p->e[1]    = c * p->e[1] + s * e0;
}

/* f(A) x in the eigenvectors, f(lambda) = even + j odd */
MHB_INLINE mhb_lanes in_modes(mhb_lanes even, mhb_lanes odd, mhb_lanes x) {
  return even * x + odd * lanes_swap(x);
}

/* The linearised panel, T' = F_theta T + r. Let m be the mean of F_theta. Let
 * s = exp int (F_theta - m). Then y = T/s obeys y' = m y + r/s, of constant coefficients.
 * Its collocation matrix is a function of Gauss' matrix. The rule integrates r/s, not the
 * product of T and F_theta. Values at the nodes err like the eighth power of z, the largest
 * h |F_theta - m|. The end and the integrals err far less. Where z is above `mildest` the
 * collocation matrix itself is inverted. Returns 0 if it has no inverse. */
MHB_INLINE int linearise(const mhb_slip *slip, double mildest, mhb_panel *p) {
  const mhb_collocation *rule = slip->rule;
  p->mean                     = lanes_sum(rule->weight * p->F_theta);
  mhb_lanes apart             = p->h * (p->F_theta - p->mean);
  p->apart                    = lanes_top(lanes_abs(apart));
  p->dense                    = !(p->apart < mildest);
  if (p->dense) return invert(rule, p);
  double    hm   = p->h * p->mean;
  mhb_lanes over = 1 / (1 - 2 * hm * rule->real + hm * hm * rule->modulus2);
  mhb_lanes less;
  p->swing  = lanes_exp(p->h * apply(rule->A, p->F_theta) - hm * rule->node, &less);
  p->weight = p->F_theta * less;
  p->even   = p->h * over * (rule->real - hm * rule->modulus2);
  p->odd    = p->h * over * rule->imag;
  return 1;
}

/* exp of a symmetric matrix of trace 0 plus a rotation, up to a factor: rows (a, b), (c, d). */
typedef struct {
  mhb_lanes a, b, c, d;
} mobius;

/* x after the lanes n below it, as far as there are any */
MHB_INLINE mobius compose(mobius x, int n) {
  mhb_lanes zero = lanes_all(0), one = lanes_all(1);
  mobius    y = {lanes_rise(one, x.a, n), lanes_rise(zero, x.b, n), lanes_rise(zero, x.c, n),
                 lanes_rise(one, x.d, n)};
  return (mobius){x.a * y.a + x.b * y.c, x.a * y.b + x.b * y.d, x.c * y.a + x.d * y.c,
                  x.c * y.b + x.d * y.d};
}

/* Square of a stretch's exponent above which its flow is held to end at its last b. */
static const double FAR = 12;

/* theta - theta0 at the nodes where th' = b.(-sin, cos)(theta - theta0), to some 1e-4.
 *
 * u = (cos, sin) of half of it obeys u' = (1/2) [b_1 b_2; b_2 -b_1] u, up to its length. Each
 * stretch between nodes is Magnus' exponential of fourth order; products of them are the flow.
 * tanh(r)/r is Pade's. Next to n = 0 b is no polynomial: there it is held over each stretch.
 *
 * e: its cosine and sine. Returns the tangent of a quarter of it. */
MHB_INLINE mhb_lanes flow(const mhb_collocation *rule, double h, mhb_lanes b1, mhb_lanes b2,
                          mhb_lanes e[2]) {
  mhb_lanes turned = b1 * lanes_rise(b2, b2, 1) - b2 * lanes_rise(b1, b1, 1);
  turned[0]        = turned[1];
  mhb_lanes p = .5 * h * apply(rule->between, b1), q = .5 * h * apply(rule->between, b2);
  mhb_lanes r = h * h * rule->commutator * turned, s = p * p + q * q - r * r;
  int       far = lanes_top(s) > FAR;
  if (far) {
    p = .5 * h * rule->stretch * b1;
    q = .5 * h * rule->stretch * b2;
    r = lanes_all(0);
    s = p * p + q * q;
  }
  mhb_lanes tanh = (105 + 10 * s) / (105 + s * (45 + s));
  if (far) tanh = lanes_where(s > FAR, .99 / lanes_sqrt(s), tanh);
  mobius    step = {1 + tanh * p, tanh * (q + r), tanh * (q - r), 1 - tanh * p};
  mobius    all  = compose(compose(compose(step, 1), 2), 4);
  mhb_lanes aa = all.a * all.a, cc = all.c * all.c, one = 1 / (aa + cc), size = lanes_sqrt(aa + cc);
  e[0] = one * (aa - cc);
  e[1] = 2 * one * all.a * all.c;
  return all.c / (size + all.a);
}

/* The angle by the tangent of a quarter. It is cut where it is half a turn and more. */
MHB_INLINE mhb_lanes rough_angle(mhb_lanes tan) {
  return 4 * lanes_atan_rough(lanes_max(lanes_min(tan, lanes_all(1)), lanes_all(-1)));
}

/* theta, F, F_theta at the nodes, and the panel linearised there. F and F_theta at theta0 give the
 * flow. For K = k I it is th' itself, and gives F_theta before theta is known. Else F and F_theta
 * at the flow's theta give the next one, which is Newton's step for that flow. There is none where
 * theta does not turn. Returns 0 if the panel has no inverse. */
MHB_INLINE int predict(const mhb_slip *slip, mhb_lanes over, mhb_panel *p) {
  mhb_lanes e[2];
  p->theta = lanes_all(p->theta0);
  rate(slip, over, p);
  if (p->h * lanes_top(lanes_abs(p->F)) < 1e-5 * slip->tolerance)
    return linearise(slip, slip->newton_mild, p);
  mhb_lanes e0 = p->e[0], e1 = p->e[1], b1 = -p->F_theta, b2 = p->F;
  mhb_lanes tan = flow(slip->rule, p->h, b1, b2, e);
  if (slip->half == 0 && slip->skew == 0) {
    p->F_theta = -b1 * e[0] - b2 * e[1];
    if (!linearise(slip, slip->newton_mild, p)) return 0;
    if (lanes_top(lanes_abs(tan)) < MHB_ATAN_REACH) {
      p->F    = b2 * e[0] - b1 * e[1];
      p->e[0] = e0 * e[0] - e1 * e[1];
      p->e[1] = e1 * e[0] + e0 * e[1];
      p->theta += 4 * lanes_atan(tan);
    } else {
      p->theta += rough_angle(tan);
      rate(slip, over, p);
    }
    return 1;
  }
  p->theta += rough_angle(tan);
  rate(slip, over, p);
  mhb_lanes c = e0 * p->e[0] + e1 * p->e[1], s = e0 * p->e[1] - e1 * p->e[0];
  tan      = flow(slip->rule, p->h, -c * p->F_theta - s * p->F, c * p->F - s * p->F_theta, e);
  p->theta = p->theta0 + rough_angle(tan);
  rate(slip, over, p);
  return linearise(slip, slip->newton_mild, p);
}

/* What Newton's step errs by, of its size. */
MHB_INLINE double rough(const mhb_panel *p) {
  double low = .5 * p->apart, high = p->apart / MILD;
  if (p->dense) return 0;
  if (high < 1) return ROUGH * mhb_least(1, low * low * low * low);
  high *= high;
  high *= high;
  return ROUGH * high * high;
}

/* (I - h A diag(F_theta))^-1 r = r + s (I - h m A)^-1 h A (F_theta/s r) */
MHB_INLINE mhb_lanes newton_step(const mhb_slip *slip, const mhb_panel *p, mhb_lanes r) {
  const mhb_collocation *rule = slip->rule;
  if (p->dense) return apply(p->inverse, r);
  return r + p->swing * apply(rule->from_modes,
                              in_modes(p->even, p->odd, apply(rule->to_modes, p->weight * r)));
}

/* T at the nodes and the end for T = 1 at the start: s (I - h m A)^-1 1. */
MHB_INLINE void set_transfer(const mhb_slip *slip, mhb_panel *p) {
  const mhb_collocation *rule = slip->rule;
  if (p->dense) {
    p->transfer = p->inverse[0];
    for (int j = 1; j < MHB_NODES; j++) p->transfer += p->inverse[j];
  } else { /* 1/(1 - h m lambda) = 1 + m (h lambda/(1 - h m lambda)) */
    p->transfer = p->swing * (1 + p->mean * apply(rule->from_modes,
                                                  in_modes(p->even, p->odd, rule->one_in_modes)));
    if (p->apart > MILD)
      p->transfer +=
          newton_step(slip, p, 1 + p->h * apply(rule->A, p->F_theta * p->transfer) - p->transfer);
  }
  p->growth = p->stiff ? lanes_sum(rule->end * p->transfer)
                       : 1 + p->h * lanes_sum(rule->weight * p->F_theta * p->transfer);
}

MHB_HOT void mhb_slip_response(const mhb_slip *slip, const mhb_panel *p,
                               mhb_lanes response[MHB_NODES]) {
  const mhb_collocation *rule = slip->rule;
  mhb_lanes              over = 1 / p->swing;
  for (int q = 0; q < MHB_NODES; q++) {
    if (p->dense) {
      mhb_lanes sum = p->inverse[0] * rule->A[q][0];
      for (int j = 1; j < MHB_NODES; j++) sum += p->inverse[j] * rule->A[q][j];
      response[q] = p->h * sum;
    } else {
      response[q] = p->swing * over[q] *
                    apply(rule->from_modes, in_modes(p->even, p->odd, rule->to_modes[q]));
    }
  }
}

/* What theta lacks to the collocation equations. */
MHB_INLINE mhb_lanes residual(const mhb_slip *slip, const mhb_panel *p) {
  return p->theta0 + p->h * apply(slip->rule->A, p->F) - p->theta;
}

/* Newton's method on the collocation equations from theta, F, F_theta, their residual r and the
 * linearised panel. The matrix is kept while it converges well. over = 1/(mu n). 1: converged.
 *
 * Gauss collocation carries an error of the start to the end undamped where h F_theta -> -infinity,
 * though it hardly shows at the nodes. There the end is extrapolated from the nodes. */
MHB_INLINE int collocate(const mhb_slip *slip, mhb_lanes over, mhb_lanes r, mhb_panel *p) {
  const mhb_collocation *rule   = slip->rule;
  double                 before = 1, enough = .3 * slip->tolerance, left = INFINITY;
  int                    fresh = 1, isotropic = slip->half == 0 && slip->skew == 0;
  if (lanes_top(lanes_abs(r)) < .01 * enough) left = 0;
  for (int i = 0; left > enough; i++) {
    if (i == 16) return 0;
    if (!fresh && !linearise(slip, slip->newton_mild, p)) return 0;
    mhb_lanes step    = newton_step(slip, p, r);
    double    size    = lanes_top(lanes_abs(step));
    int       stalled = i > 1 && size > .5 * before && size < 1e-7; /* at the rounding of F */
    if (!(size < 4) || (i > 5 && size > .5 * before && size > 1e-7)) return 0;
    p->theta += step;
    /* the error is quadratic in the last step, or its product with the one before; or that of the
     * matrix */
    left   = size * mhb_most(mhb_least(1, fresh && i > 0 ? size / before : size), rough(p));
    fresh  = size < .05 && (size < .1 * before || i == 0); /* as good a matrix as any */
    before = size;
    if (isotropic) {
      turn(p, step, size);
    } else {
      rate(slip, over, p);
    }
    if (size < 1e-14 || stalled) break;
    if (left > enough) r = residual(slip, p);
  }
  if (isotropic) p->gamma = -p->F_theta / over - slip->mu * p->dy[0];
  if (slip->linearized && !linearise(slip, slip->mild, p)) return 0;
  p->stiff  = p->h * lanes_top(p->F_theta) < -20;
  p->theta1 = p->stiff ? lanes_sum(rule->end * p->theta)
                       : p->theta0 + p->h * lanes_sum(rule->weight * p->F);
  set_transfer(slip, p);
  p->error = panel_error(slip, p);
  return isfinite(p->theta1);
}

/* ---- prediction and end of a panel ---- */

/* theta at the nodes of the panel's first fraction, from the interpolant of th'. */
MHB_INLINE void shorten_theta(const mhb_slip *slip, double fraction, mhb_panel *p) {
  mhb_lanes c = apply(slip->rule->monomial, p->F), x = fraction * slip->rule->node;
  mhb_lanes sum = lanes_all(0);
  for (int k = MHB_NODES - 1; k >= 0; k--) sum = sum * x + c[k] / (k + 1);
  p->theta = p->theta0 + p->h * sum * x;
}

/* A panel of length h from (t, theta). 1 if Newton converged. */
MHB_HOT static int solve_panel(const mhb_slip *slip, double t, double h, double theta,
                               mhb_panel *p) {
  p->theta0 = theta;
  place_nodes(slip, t, h, p);
  mhb_lanes over = 1 / (slip->mu * p->y[0]);
  return predict(slip, over, p) && collocate(slip, over, residual(slip, p), p);
}

/* The first fraction of a panel that is solved. */
MHB_HOT static int solve_part(const mhb_slip *slip, double fraction, mhb_panel *p) {
  shorten_theta(slip, fraction, p);
  place_nodes(slip, p->t0, fraction * p->h, p);
  mhb_lanes over = 1 / (slip->mu * p->y[0]);
  rate(slip, over, p);
  return linearise(slip, slip->newton_mild, p) && collocate(slip, over, residual(slip, p), p);
}

/* c <- gamma over the panel, in powers of the fraction. */
MHB_HOT static void gamma_powers(const mhb_slip *slip, const mhb_panel *p, double *c) {
  lanes_store(c, apply(slip->rule->monomial, p->gamma));
}

/* b <- its Bernstein coefficients, slack <- a bound on their rounding. 0: gamma stays positive. */
MHB_HOT static int gamma_falls(const mhb_slip *slip, const mhb_panel *p, double *b, double *slack) {
  mhb_lanes hull = apply(slip->rule->bernstein, p->gamma);
  *slack         = 1e-13 * lanes_top(lanes_abs(hull));
  lanes_store(b, hull);
  return lanes_bottom(hull) < -*slack;
}

static double polynomial(const double *c, double x, double *slope) {
  double y = 0, dy = 0;
  for (int k = MHB_NODES - 1; k >= 0; k--) {
    dy = dy * x + y;
    y  = y * x + c[k];
  }
  *slope = dy;
  return y;
}

/* Root in [lo, hi] of the polynomial c, which falls through zero there: safeguarded Newton from
 * x. */
static double falling_root(const double *c, double lo, double hi, double x) {
  double slope;
  for (int i = 0; i < 60; i++) {
    double y = polynomial(c, x, &slope);
    if (y > 0) {
      lo = x;
    } else {
      hi = x;
    }
    double next = x - y / slope;
    if (!(next > lo && next < hi)) next = .5 * (lo + hi);
    double moved = fabs(next - x);
    x            = next;
    if (moved < 1e-9) break; /* its square is below rounding */
  }
  return x;
}

/* De Casteljau: the Bernstein coefficients b on the parts before and after fraction s. */
static void split(const double *b, double s, double *left, double *right) {
  memcpy(right, b, sizeof(double) * MHB_NODES);
  for (int k = 0; k < MHB_NODES; k++) {
    left[k] = right[0];
    for (int i = 0; i + k + 1 < MHB_NODES; i++) right[i] += s * (right[i + 1] - right[i]);
  }
}

/* First root in (lo, hi) of the polynomial c, from above; 2: none. b are its Bernstein coefficients
 * on [lo, hi]. It lies in their hull and has no more roots than they change sign. */
static double first_fall(const double *c, const double *b, double lo, double hi, double slack,
                         int depth) {
  int    changes = 0, sign = 1, low = 0;
  double cross = .5; /* of the control polygon */
  for (int i = 0; i < MHB_NODES; i++) {
    int now = b[i] < -slack ? -1 : b[i] > slack ? 1 : sign;
    if (now < 0 && !low && i > 0) cross = (i - b[i] / (b[i] - b[i - 1])) / (MHB_NODES - 1);
    low |= now < 0;
    changes += now != sign;
    sign = now;
  }
  if (!low) return 2;
  if (changes == 1) return falling_root(c, lo, hi, lo + cross * (hi - lo));
  if (depth == 30) return b[MHB_NODES - 1] < 0 ? hi : 2;
  double left[MHB_NODES], right[MHB_NODES];
  split(b, .5, left, right);
  double middle = .5 * (lo + hi), root = first_fall(c, left, lo, middle, slack, depth + 1);
  return root <= 1 ? root : first_fall(c, right, middle, hi, slack, depth + 1);
}

/* An end of the panel: gamma itself, not its interpolant, and the size of its terms. */
typedef struct {
  double gamma, size, y[3], e[2];
} panel_end;

static panel_end end_at(const mhb_slip *slip, double t, double theta) {
  panel_end at;
  double    dy[3];
  mhb_signals_at(slip->signals, t, at.y, dy, NULL);
  at.e[0]  = cos(theta);
  at.e[1]  = sin(theta);
  at.gamma = at.e[0] * dy[1] + at.e[1] * dy[2] - slip->mu * dy[0];
  at.size  = fabs(dy[1]) + fabs(dy[2]) + slip->mu * fabs(dy[0]);
  return at;
}

/* Fraction of the panel at which gamma first turns negative; > 1 if it does not. The interpolant is
 * used between the nodes only. Before the first node gamma is interpolated from the panel's
 * start. */
static double slip_end(const mhb_slip *slip, const mhb_panel *p) {
  double c[MHB_NODES], hull[MHB_NODES], left[MHB_NODES], right[MHB_NODES], slack;
  if (!gamma_falls(slip, p, hull, &slack)) return 2;
  double first = slip->rule->node[0];
  if (p->gamma[0] < 0) {
    double start = end_at(slip, p->t0, p->theta0).gamma;
    return start <= 0 ? 0 : first * start / (start - p->gamma[0]);
  }
  gamma_powers(slip, p, c);
  split(hull, first, left, right);
  right[0] = p->gamma[0];
  return first_fall(c, right, first, 1, slack, 0);
}

/* Shorten the panel until gamma = 0 at its end. If gamma only comes near zero, slip goes on. */
static mhb_slip_outcome find_end(const mhb_slip *slip, double fraction, mhb_panel *p) {
  double    close = mhb_most(1e-12, .01 * slip->tolerance), whole = p->h;
  panel_end at;
  for (int i = 0; i < 8; i++) {
    double c[MHB_NODES], slope;
    if (fraction * p->h < 1e-12) {
      p->h      = 0;
      p->theta1 = p->theta0;
      at        = end_at(slip, p->t0, p->theta0);
      break;
    }
    if (!solve_part(slip, fraction, p)) return MHB_SLIP_FAILED;
    gamma_powers(slip, p, c);
    polynomial(c, 1, &slope);
    at          = end_at(slip, p->t0 + p->h, p->theta1);
    double step = -at.gamma / slope;
    if (fabs(step * p->h) <= close) break;
    if (!(fabs(step) <= .5)) {
      if (at.gamma > 1e-10 * at.size) return MHB_SLIP_CONTINUES;
      break;
    }
    fraction = mhb_least(1 + step, whole / p->h);
  }
  for (int k = 0; k < 3; k++) p->end[k] = at.y[k];
  for (int k = 0; k < 2; k++) p->end_e[k] = at.e[k];
  return MHB_SLIP_ENDS;
}

/* The last stretch before an opening: theta is held. Its force is of second order in its length. */
MHB_HOT static void freeze(const mhb_slip *slip, double t, double h, double theta, mhb_panel *p) {
  place_nodes(slip, t, h, p);
  p->theta = lanes_all(theta);
  rate(slip, 1 / (slip->mu * p->y[0]), p);
  double change = mhb_least(1, fabs(p->F[0]) * h); /* of theta, neglected, over half of the force */
  p->error      = .25 * slip->mu * p->y[0][0] * h * change;
  p->F = p->F_theta = lanes_all(0);
  p->theta0 = p->theta1 = theta;
  p->swing = p->transfer = lanes_all(1);
  p->even                = h * slip->rule->real;
  p->odd                 = h * slip->rule->imag;
  p->growth              = 1;
  p->dense               = 0;
  p->frozen              = 1;
}

static const double SHORTEST = 1e-13;

mhb_slip_outcome mhb_slip_panel(const mhb_slip *slip, double t, double theta, double limit,
                                int opening, double *suggested, mhb_panel *panel) {
  double left = limit - t;
  if (opening && left < slip->frozen_length) {
    freeze(slip, t, left, theta, panel);
    return MHB_SLIP_INTERVAL_ENDS;
  }
  panel->remaining = opening ? left : 1;
  double share     = panel->error < 1e-6 * slip->tolerance ? .95 : .8;
  double h = opening ? mhb_least(*suggested, share * left) : left / ceil(left / *suggested - 1e-9);
  for (;;) {
    double shrink = .5;
    if (solve_panel(slip, t, h, theta, panel)) {
      if (panel->error < slip->tolerance || h < 1e-4 * panel->remaining) break;
      shrink = mhb_most(.9 * sqrt(sqrt(sqrt(sqrt(slip->tolerance / panel->error)))), .25);
    }
    h *= shrink;
    if (h < SHORTEST) return MHB_SLIP_FAILED;
  }
  int at_limit = !opening && h >= left * (1 - 1e-15);
  *suggested   = h;
  if (__builtin_expect(panel->error < .01 * slip->tolerance, 1))
    *suggested = mhb_least(slip->longest_panel, 1.5 * h);
  double end = slip_end(slip, panel);
  if (end <= 1) return find_end(slip, end, panel);
  return at_limit ? MHB_SLIP_INTERVAL_ENDS : MHB_SLIP_CONTINUES;
}

double mhb_slip_closing_rate(const mhb_slip *slip, const mhb_direction *d, const double dy[3],
                             const double ddy[3], double *D) {
  double g[2]   = {d->q[0] - d->beta * d->e[0], d->q[1] - d->beta * d->e[1]};
  double across = d->q[0] * dy[1] + d->q[1] * dy[2], along = d->e[0] * dy[1] + d->e[1] * dy[2];
  *D            = along + d->beta * across + mhb_slip_gamma(slip, d, dy) * d->beta_theta;
  double rotate = g[0] * ddy[1] + g[1] * ddy[2] + d->beta * slip->mu * ddy[0];
  return rotate / (slip->mu * dy[0] + *D);
}

/* In the eigenbasis of K: sum_i (x_i/(a + lambda k_i))^2 = 1, lambda >= 0. The sum is decreasing
 * and convex in lambda, so that Newton's method from below is monotone. */
void mhb_slip_return(const double (*K)[2], double a, const double x[2], double d[2]) {
  if (K[0][0] == K[1][1] && K[0][1] == 0) {
    double size = hypot(x[0], x[1]);
    d[0]        = size > 0 ? x[0] / size : 1;
    d[1]        = size > 0 ? x[1] / size : 0;
    return;
  }
  double mean = .5 * (K[0][0] + K[1][1]), half = .5 * (K[0][0] - K[1][1]);
  double radius = hypot(half, K[0][1]), angle = .5 * atan2(K[0][1], half);
  double c = cos(angle), s = sin(angle), k[2] = {mean + radius, mean - radius};
  double xi[2] = {c * x[0] + s * x[1], -s * x[0] + c * x[1]}, size = hypot(xi[0], xi[1]);
  double low = mhb_most(0, (size - a) / k[0]), high = mhb_most(low, (size - a) / k[1]),
         lambda = low;
  double di[2]  = {0, 0};
  for (int i = 0; i < 100; i++) {
    double sum = 0, slope = 0;
    for (int j = 0; j < 2; j++) {
      di[j] = xi[j] / (a + lambda * k[j]);
      sum += di[j] * di[j];
      slope -= 2 * di[j] * di[j] * k[j] / (a + lambda * k[j]);
    }
    if (fabs(1 - sum) < 1e-15) break;
    double next = mhb_least(high, mhb_most(low, lambda + (1 - sum) / slope));
    if (!(fabs(next - lambda) > 1e-16 * high)) break;
    lambda = next;
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
