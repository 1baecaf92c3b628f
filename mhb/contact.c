#include "mhb/contact.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/events.h"
#include "mhb/fourier.h"
#include "mhb/pieces.h"
#include "mhb/slip.h"
#include "mhb/stuck.h"

static const double TWO_PI = 6.283185307179586476925;

/* Compiled for wide vectors too, chosen at run time. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__)
#define HOT __attribute__((target_clones("arch=haswell", "default")))
#else
#define HOT
#endif

/* Columns of the derivative: v, u, w coefficients, then the two components of the slider at the start of the lap. */
enum { SLIDER = 2 };

struct mhb_contact {
  int               m, H, nb, nf, columns; /* nb = 2m+1, nf = 2H+1, columns = 3 nb + 2 */
  double            tolerance;
  mhb_signals       signals;
  mhb_collocation   rule;
  mhb_panel         panel;
  mhb_slip          slip;
  mhb_closed        closed;
  double            scale;       /* force scale, N */
  double            K[2][2];     /* Ku/scale */
  double            kv;          /* kv/scale */
  double           *scaled;      /* [3][nb] coefficients of (n, x_1, x_2) */
  double           *f;           /* [2][nf] integrals of friction times basis */
  double           *J;           /* [2][nf][columns] */
  double           *Z;           /* [2][columns] derivative of the slider while stuck */
  double           *T;           /* [columns] derivative of theta while slipping */
  double           *node_T;      /* [MHB_NODES][columns] */
  double           *node_f;      /* [MHB_NODES][columns] */
  double           *stick;       /* [2(H+m)+1] integrals of the basis over stick pieces */
  double           *piece;       /* the same, one piece */
  double           *product;     /* [nf][nb] */
  double           *basis0;      /* [2][nb] basis and slope at an event */
  int               first, last; /* columns in use: [first, last) */
  int               record;      /* this lap's force is wanted */
  mhb_contact_info *info;
  mhb_pieces        pieces; /* of the recorded lap, for a trace */
  double           *traced; /* [3][nf] force of a trace */
};

/* The slider at a time of the lap. */
typedef struct {
  mhb_state state;
  double    t, z[2], theta;
} slider;

shb_status mhb_contact_create(int m, int H, double tolerance, mhb_contact **out) {
  mhb_contact *c = calloc(1, sizeof *c);
  SHB_CHECK(c, SHB_ERR_IO, "out of memory");
  c->m         = m;
  c->H         = H;
  c->nb        = mhb_real_size(m);
  c->nf        = mhb_real_size(H);
  c->columns   = 3 * c->nb + SLIDER;
  c->tolerance = tolerance;
  size_t nb = (size_t)c->nb, nf = (size_t)c->nf, columns = (size_t)c->columns;
  size_t sums = (size_t)mhb_real_size(H + m);
  struct {
    double **array;
    size_t   size;
  } wanted[] = {{&c->scaled, 3 * nb},
                {&c->f, 2 * nf},
                {&c->J, 2 * nf * columns},
                {&c->Z, 2 * columns},
                {&c->T, columns},
                {&c->node_T, MHB_NODES * columns},
                {&c->node_f, MHB_NODES * columns},
                {&c->stick, sums},
                {&c->piece, sums},
                {&c->product, nf * nb},
                {&c->basis0, 2 * nb},
                {&c->traced, 3 * nf},
                {&c->panel.basis, MHB_NODES * nf},
                {&c->panel.slope, MHB_NODES * nf}};
  int ok     = mhb_signals_create(m, &c->signals) == SHB_OK;
  for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++)
    ok &= (*wanted[i].array = calloc(wanted[i].size, sizeof(double))) != NULL;
  mhb_collocation_create(&c->rule);
  ok &= mhb_pieces_create(&c->rule, &c->pieces) == SHB_OK;
  if (!ok) {
    mhb_contact_destroy(c);
    SHB_FAIL(SHB_ERR_IO, "out of memory for a contact of %d harmonics", m);
  }
  c->pieces.signals = &c->signals;
  *out              = c;
  return SHB_OK;
}

void mhb_contact_destroy(mhb_contact *c) {
  if (!c) return;
  double *arrays[] = {c->scaled, c->f,      c->J,           c->Z,          c->T,
                      c->node_T, c->node_f, c->stick,       c->piece,      c->product,
                      c->basis0, c->traced, c->panel.basis, c->panel.slope};
  for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) free(arrays[i]);
  mhb_pieces_destroy(&c->pieces);
  mhb_signals_destroy(&c->signals);
  free(c);
}

/* ---- scaling ---- */

/* Divide by the largest force in sight, so that tolerances are relative and units do not matter. 0: no force at all. */
static int set_signals(mhb_contact *c, const mhb_law *law, const double *motion) {
  const double *v = motion, *u = v + c->nb, *w = u + c->nb;
  double        load = fabs(law->n0), friction = 0;
  for (int i = 0; i < c->nb; i++) {
    load += law->kv * fabs(v[i]);
    friction += hypot(law->ku[0] * u[i] + law->ku[1] * w[i], law->ku[1] * u[i] + law->ku[2] * w[i]);
  }
  c->scale = load + friction < INFINITY ? fmax(load, friction) : NAN;
  if (!(c->scale > 1e-290)) return 0; /* its inverse would overflow */
  double one = 1 / c->scale, *n = c->scaled, *x1 = n + c->nb, *x2 = x1 + c->nb;
  c->kv      = law->kv * one;
  c->K[0][0] = law->ku[0] * one;
  c->K[0][1] = c->K[1][0] = law->ku[1] * one;
  c->K[1][1]              = law->ku[2] * one;
  for (int i = 0; i < c->nb; i++) {
    n[i]  = c->kv * v[i];
    x1[i] = c->K[0][0] * u[i] + c->K[0][1] * w[i];
    x2[i] = c->K[1][0] * u[i] + c->K[1][1] * w[i];
  }
  n[0] += law->n0 * one;
  mhb_signals_set(&c->signals, (const double *const[3]){n, x1, x2});
  return 1;
}

/* Panels: seven nodes resolve (H + m) h <= 6 to 1e-8 of the force; the error falls with h^14. */
static void set_slip(mhb_contact *c, const mhb_law *law) {
  double stretch = pow(c->tolerance / 1e-8, 1. / 14);
  c->slip        = (mhb_slip){.signals   = &c->signals,
                              .rule      = &c->rule,
                              .mu        = law->mu,
                              .harmonics = c->H,
                              .longest   = fmin(1, fmin(.42, 6. / (c->H + c->m)) * stretch),
                              .tolerance = .1 * c->tolerance};
  memcpy(c->slip.K, c->K, sizeof c->K);
}

static double quadrature_scale(int i) {
  return i == 0 ? 1 / TWO_PI : 2 / TWO_PI;
}

static void note_transition(mhb_contact *c, double t, mhb_state state) {
  mhb_contact_info *info = c->info;
  if (!c->record || info->n_transitions == MHB_MAX_TRANSITIONS) return;
  double phase = t / TWO_PI;
  info->transition[info->n_transitions++] =
      (mhb_transition){.phase = phase - floor(phase), .state = (int)state};
}

/* ---- derivative columns ---- */

/* delta x_1, delta x_2, delta n of column j when the basis (or its slope) at the time is b. */
static void column_change(const mhb_contact *c, const double *b, int j, double dx[2], double *dn) {
  int nb = c->nb, kind = j / nb, i = j - kind * nb;
  dx[0] = dx[1] = *dn = 0;
  if (kind == 0) {
    *dn = c->kv * b[i];
  } else if (kind < 3) {
    dx[0] = c->K[0][kind - 1] * b[i];
    dx[1] = c->K[1][kind - 1] * b[i];
  }
}

/* Stick to slip at f, |f| = mu n: delta f is projected obliquely onto the circle (free of the onset speed, so that
 * nothing blows up at grazing):  df+ = df - Kf (f.df - mu^2 n dn)/(f.Kf). Z -> T. */
static void columns_stick_to_slip(mhb_contact *c, double t, double theta, double n) {
  mhb_direction d     = mhb_slip_direction(c->K, theta);
  double        limit = c->slip.mu * n;
  mhb_basis(c->m, t, c->basis0, NULL);
  for (int j = c->first; j < c->last; j++) {
    double dx[2], dn;
    column_change(c, c->basis0, j, dx, &dn);
    double df[2]  = {dx[0] - c->Z[j], dx[1] - c->Z[c->columns + j]};
    double radial = d.e[0] * df[0] + d.e[1] * df[1] - c->slip.mu * dn;
    c->T[j]       = (d.q[0] * df[0] + d.q[1] * df[1] - d.beta * radial) / limit;
  }
}

/* Slip to stick: df does not jump. dz = dx - (mu dn e + mu n q dtheta). T -> Z. */
static void columns_slip_to_stick(mhb_contact *c, double t, double theta, double n) {
  double mu = c->slip.mu, e[2] = {cos(theta), sin(theta)};
  mhb_basis(c->m, t, c->basis0, NULL);
  for (int j = c->first; j < c->last; j++) {
    double dx[2], dn;
    column_change(c, c->basis0, j, dx, &dn);
    c->Z[j]              = dx[0] - mu * (dn * e[0] - n * e[1] * c->T[j]);
    c->Z[c->columns + j] = dx[1] - mu * (dn * e[1] + n * e[0] * c->T[j]);
  }
}

/* Closing at t (n = 0, n' > 0). Stick: z = x(t), dz = dx + x' dt with dt = -dn/n'. Slip: the regular solution
 *   dtheta = [(q - beta e).dx' + mu beta dn' - mu theta' dn]/D,   D = e.x' + beta q.x' + gamma beta',
 *   theta' = [q.x'' - beta (e.x'' - mu n'')]/(mu n' + D). */
static void columns_closing(mhb_contact *c, const slider *s) {
  double  y[3], dy[3], ddy[3], mu = c->slip.mu;
  double *b = c->basis0, *b_slope = b + c->nb;
  mhb_basis(c->m, s->t, b, b_slope);
  mhb_signals_at(&c->signals, s->t, y, dy, ddy);
  mhb_direction d      = mhb_slip_direction(c->K, s->theta);
  double        gamma  = mhb_slip_gamma(&c->slip, &d, dy);
  double        across = d.q[0] * dy[1] + d.q[1] * dy[2], along = d.e[0] * dy[1] + d.e[1] * dy[2];
  double        D    = along + d.beta * across + gamma * d.beta_theta;
  double        turn = d.q[0] * ddy[1] + d.q[1] * ddy[2] -
                d.beta * (d.e[0] * ddy[1] + d.e[1] * ddy[2] - mu * ddy[0]);
  double rate = turn / (mu * dy[0] + D);
  for (int j = c->first; j < c->last; j++) {
    double dx[2], dn, ddx[2], ddn;
    column_change(c, b, j, dx, &dn);
    column_change(c, b_slope, j, ddx, &ddn);
    if (s->state == MHB_STICK) {
      c->Z[j]              = dx[0] - dy[1] * dn / dy[0];
      c->Z[c->columns + j] = dx[1] - dy[2] * dn / dy[0];
    } else {
      double drive = (d.q[0] - d.beta * d.e[0]) * ddx[0] + (d.q[1] - d.beta * d.e[1]) * ddx[1];
      c->T[j]      = (drive + mu * d.beta * ddn - mu * rate * dn) / D;
    }
  }
}

/* Right-hand side of the linearised slip equation at the nodes: for columns v_i, u_i, w_i
 *   r = kv (beta/n b'_i - F/n b_i),  a_u b'_i,  a_w b'_i  with a = ((q - beta e) K)/(mu n). */
static void node_factors(mhb_contact *c, double r_slope[3][MHB_NODES], double r_value[MHB_NODES]) {
  const mhb_panel *p = &c->panel;
  for (int l = 0; l < MHB_NODES; l++) {
    mhb_direction d     = mhb_slip_direction(c->K, p->theta[l]);
    double        g[2]  = {d.q[0] - d.beta * d.e[0], d.q[1] - d.beta * d.e[1]};
    double        limit = c->slip.mu * p->y[l][0];
    r_slope[0][l]       = c->kv * d.beta / p->y[l][0];
    r_slope[1][l]       = (g[0] * c->K[0][0] + g[1] * c->K[1][0]) / limit;
    r_slope[2][l]       = (g[0] * c->K[0][1] + g[1] * c->K[1][1]) / limit;
    r_value[l]          = -c->kv * p->F[l] / p->y[l][0];
    if (p->F[l] == 0 && p->F_theta[l] == 0) /* frozen sliver */
      r_slope[0][l] = r_slope[1][l] = r_slope[2][l] = r_value[l] = 0;
  }
}

/* delta theta at the nodes (node_T) and at the panel's end (T): the collocation equations linearised, same matrix. */
static void columns_through_panel(mhb_contact *c) {
  const mhb_panel *p = &c->panel;
  double           inverse_A[MHB_NODES][MHB_NODES], ones[MHB_NODES], column[MHB_NODES];
  double           r_slope[3][MHB_NODES], r_value[MHB_NODES];
  for (int l = 0; l < MHB_NODES; l++) {
    for (int i = 0; i < MHB_NODES; i++) column[i] = p->h * c->rule.A[i][l];
    mhb_panel_solve(p, column);
    for (int i = 0; i < MHB_NODES; i++) inverse_A[i][l] = column[i];
    ones[l] = 1;
  }
  mhb_panel_solve(p, ones);
  node_factors(c, r_slope, r_value);
  double end[MHB_NODES], r[MHB_NODES];
  for (int l = 0; l < MHB_NODES; l++) end[l] = p->h * c->rule.weight[l];
  for (int j = c->first; j < c->last; j++) {
    int    kind = j / c->nb, i = j - kind * c->nb;
    double sum = c->T[j];
    for (int l = 0; l < MHB_NODES; l++) {
      r[l] = 0;
      if (kind < 3) r[l] = r_slope[kind][l] * p->slope[l * c->nf + i];
      if (kind == 0) r[l] += r_value[l] * p->basis[l * c->nf + i];
    }
    for (int l = 0; l < MHB_NODES; l++) {
      double value = ones[l] * c->T[j];
      for (int q = 0; q < MHB_NODES; q++) value += inverse_A[l][q] * r[q];
      c->node_T[l * c->columns + j] = value;
      sum += end[l] * (p->F_theta[l] * value + r[l]);
    }
    c->T[j] = sum;
  }
}

/* ---- accumulation over pieces ---- */

static void add_stick(mhb_contact *c, double t0, double t1, const double z[2], int derivative) {
  if (!c->record || t1 <= t0) return;
  mhb_pieces_stick(&c->pieces, t0, z);
  int sums = mhb_real_size(c->H + c->m);
  memset(c->piece, 0, sizeof(double) * (size_t)sums);
  mhb_basis_integral(c->H + c->m, t0, t1, c->piece);
  for (int i = 0; i < sums; i++) c->stick[i] += c->piece[i];
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < c->nf; i++) {
      c->f[k * c->nf + i] -= z[k] * c->piece[i];
      if (!derivative) continue;
      double       *row = c->J + (size_t)(k * c->nf + i) * (size_t)c->columns;
      const double *Zk = c->Z + k * c->columns, factor = c->piece[i];
      for (int j = c->first; j < c->last; j++) row[j] -= factor * Zk[j];
    }
  }
  c->info->share[MHB_STICK] += (t1 - t0) / TWO_PI;
}

/* J[i][j] += sum_l b[l][i] y[l][j] over the nodes of a panel: the hot loop of the derivative. */
HOT static void add_outer(int rows, int first, int last, int stride, const double *b,
                          const double *y, double *J) {
  for (int i = 0; i < rows; i++) {
    double *row = J + (size_t)i * (size_t)stride, f[MHB_NODES];
    for (int l = 0; l < MHB_NODES; l++) f[l] = b[l * rows + i];
    for (int j = first; j < last; j++) {
      double sum = row[j];
      for (int l = 0; l < MHB_NODES; l++) sum += f[l] * y[l * stride + j];
      row[j] = sum;
    }
  }
}

/* delta f = mu (dn e + n q dtheta) at the nodes of a panel, weighted, added to the derivative of the integrals. */
static void add_panel_derivative(mhb_contact *c) {
  const mhb_panel *p     = &c->panel;
  double           mu    = c->slip.mu;
  int              v_end = c->last < c->nb ? c->last : c->nb;
  for (int k = 0; k < 2; k++) {
    for (int l = 0; l < MHB_NODES; l++) {
      double weight = p->h * c->rule.weight[l] * mu, co = cos(p->theta[l]), si = sin(p->theta[l]);
      double across = weight * p->y[l][0] * (k ? co : -si), along = weight * c->kv * (k ? si : co);
      const double *theta = c->node_T + (size_t)l * (size_t)c->columns;
      const double *basis = p->basis + (size_t)l * (size_t)c->nf;
      double       *row   = c->node_f + (size_t)l * (size_t)c->columns;
      for (int j = c->first; j < c->last; j++) row[j] = across * theta[j];
      for (int j = c->first; j < v_end; j++) row[j] += along * basis[j];
    }
    add_outer(c->nf, c->first, c->last, c->columns, p->basis, c->node_f,
              c->J + (size_t)(k * c->nf) * (size_t)c->columns);
  }
}

static void add_slip(mhb_contact *c, int derivative) {
  const mhb_panel *p = &c->panel;
  if (!c->record || p->h <= 0) return;
  mhb_pieces_slip(&c->pieces, p);
  double mu = c->slip.mu;
  for (int l = 0; l < MHB_NODES; l++) {
    double        weight = p->h * c->rule.weight[l], limit = mu * p->y[l][0];
    double        f[2]  = {weight * limit * cos(p->theta[l]), weight * limit * sin(p->theta[l])};
    const double *basis = p->basis + (size_t)l * (size_t)c->nf;
    for (int k = 0; k < 2; k++)
      for (int i = 0; i < c->nf; i++) c->f[k * c->nf + i] += f[k] * basis[i];
    mhb_direction d   = mhb_slip_direction(c->K, p->theta[l]);
    double        eKe = c->K[0][0] * d.e[0] * d.e[0] + 2 * c->K[0][1] * d.e[0] * d.e[1] +
                 c->K[1][1] * d.e[1] * d.e[1];
    /* lambda |f|^2 = gamma mu n/eKe */
    c->info->slip_work += weight * mhb_slip_gamma(&c->slip, &d, p->dy[l]) * limit / eKe;
  }
  if (derivative) add_panel_derivative(c);
  c->info->share[MHB_SLIDE] += p->h / TWO_PI;
  c->info->error += p->error;
}

/* ---- one closed interval ---- */

enum { MAX_EVENTS = 400, MAX_PANELS = 5000 };

/* Stick until the friction limit is reached or the interval ends. */
static void run_stick(mhb_contact *c, slider *s, double end, int derivative) {
  double onset = mhb_slip_onset(&c->signals, c->slip.mu, s->z, s->t, end);
  int    slips = onset <= end;
  double until = slips ? onset : end;
  add_stick(c, s->t, until, s->z, derivative);
  s->t = until;
  if (!slips) return;
  double y[3], dy[3];
  mhb_signals_at(&c->signals, until, y, dy, NULL);
  s->theta = atan2(y[2] - s->z[1], y[1] - s->z[0]);
  s->state = MHB_SLIDE;
  note_transition(c, until, MHB_SLIDE);
  if (derivative) columns_stick_to_slip(c, until, s->theta, y[0]);
}

/* Slip until its rate is zero or the interval ends. 0: a panel was lost. */
static int run_slip(mhb_contact *c, slider *s, double end, int opening, int derivative) {
  double           suggested = c->slip.longest;
  mhb_slip_outcome outcome   = MHB_SLIP_ON;
  for (int panels = 0; outcome == MHB_SLIP_ON; panels++) {
    if (panels == MAX_PANELS) return 0;
    outcome = mhb_slip_panel(&c->slip, s->t, s->theta, end, opening, &suggested, &c->panel);
    if (outcome == MHB_SLIP_LOST) return 0;
    if (derivative && c->panel.h > 0) columns_through_panel(c);
    add_slip(c, derivative);
    s->t += c->panel.h;
    s->theta = c->panel.theta1;
  }
  if (outcome == MHB_SLIP_AT_LIMIT) {
    s->t = end;
    return 1;
  }
  double y[3], dy[3];
  mhb_signals_at(&c->signals, s->t, y, dy, NULL);
  double limit = c->slip.mu * y[0];
  s->z[0]      = y[1] - limit * cos(s->theta);
  s->z[1]      = y[2] - limit * sin(s->theta);
  s->state     = MHB_STICK;
  note_transition(c, s->t, MHB_STICK);
  if (derivative) columns_slip_to_stick(c, s->t, s->theta, y[0]);
  return 1;
}

static int run_closed(mhb_contact *c, slider *s, double end, int opening, int derivative) {
  for (int events = 0; s->t < end; events++) {
    if (events > MAX_EVENTS) return 0;
    if (s->state == MHB_STICK) {
      run_stick(c, s, end, derivative);
    } else if (!run_slip(c, s, end, opening, derivative)) {
      return 0;
    }
  }
  return 1;
}

/* ---- the contact opens: every closing is a fresh start (eqs. 13-15) ---- */

static int run_openings(mhb_contact *c, int derivative) {
  int    ok   = 1;
  double open = 1;
  for (int i = 0; i < c->closed.n; i++) {
    slider s = {.t = c->closed.closing[i]};
    double y[3], dy[3], d[2];
    mhb_signals_at(&c->signals, s.t, y, dy, NULL);
    double pull = hypot(dy[1], dy[2]), limit = c->slip.mu * dy[0];
    s.z[0]  = y[1];
    s.z[1]  = y[2];
    s.state = pull < limit ? MHB_STICK : MHB_SLIDE;
    if (s.state == MHB_SLIDE) {
      mhb_slip_return(c->K, limit, dy + 1, d);
      s.theta = atan2(d[1], d[0]);
    }
    if (derivative) columns_closing(c, &s);
    note_transition(c, s.t, s.state);
    ok &= run_closed(c, &s, c->closed.opening[i], 1, derivative);
    note_transition(c, c->closed.opening[i], MHB_SEPARATE);
    mhb_pieces_open(&c->pieces, c->closed.opening[i]);
    open -= (c->closed.opening[i] - c->closed.closing[i]) / TWO_PI;
  }
  c->info->share[MHB_SEPARATE] = fmax(0, open);
  return ok;
}

/* ---- always closed and slipping: periodic slider ---- */

static const double CLOSE = 1e-5;
enum { MAX_LAPS = 100 };

/* One lap from slider z0; P(z0) and, in columns, its derivative. Slider columns start as the identity. */
static int run_lap(mhb_contact *c, const double z0[2], double P[2], int derivative) {
  slider s = {.state = MHB_STICK, .t = 0, .z = {z0[0], z0[1]}};
  double y[3], dy[3];
  mhb_signals_at(&c->signals, 0, y, dy, NULL);
  double f[2] = {y[1] - z0[0], y[2] - z0[1]}, limit = c->slip.mu * y[0], size = hypot(f[0], f[1]);
  int    z = 3 * c->nb;
  if (derivative) {
    memset(c->Z, 0, sizeof(double) * 2 * (size_t)c->columns);
    c->Z[z] = c->Z[c->columns + z + 1] = 1;
  }
  if (size >= limit * (1 - 1e-12)) { /* begins on the circle: project, slip if it pulls outwards */
    double d[2], over[2] = {f[0] / limit, f[1] / limit};
    mhb_slip_return(c->K, 1, over, d);
    s.theta            = atan2(d[1], d[0]);
    mhb_direction at   = mhb_slip_direction(c->K, s.theta);
    int           pull = mhb_slip_gamma(&c->slip, &at, dy) > 0;
    if (derivative && (pull || size > limit)) columns_stick_to_slip(c, 0, s.theta, y[0]);
    if (derivative && !pull && size > limit) columns_slip_to_stick(c, 0, s.theta, y[0]);
    if (pull) s.state = MHB_SLIDE;
    if (!pull && size > limit)
      for (int k = 0; k < 2; k++) s.z[k] = y[1 + k] - limit * d[k];
  }
  mhb_state began = s.state;
  int       ok    = run_closed(c, &s, TWO_PI, 0, derivative);
  if (s.state != began) note_transition(c, 0, began);
  if (s.state == MHB_SLIDE) {
    P[0] = y[1] - limit * cos(s.theta);
    P[1] = y[2] - limit * sin(s.theta);
    if (derivative) columns_slip_to_stick(c, 0, s.theta, y[0]);
  } else {
    P[0] = s.z[0];
    P[1] = s.z[1];
  }
  return ok;
}

/* (I - DP)^-1, its determinant held away from zero. */
static void closure_inverse(const mhb_contact *c, double inverse[2][2]) {
  int    z = 3 * c->nb;
  double a = 1 - c->Z[z], b = -c->Z[z + 1], d = 1 - c->Z[c->columns + z + 1],
         e   = -c->Z[c->columns + z];
  double det = a * d - b * e;
  if (fabs(det) < 1e-7) det = det < 0 ? -1e-7 : 1e-7;
  inverse[0][0] = d / det;
  inverse[0][1] = -b / det;
  inverse[1][0] = -e / det;
  inverse[1][1] = a / det;
}

/* Newton on P(z) = z; a plain lap, which never expands, where Newton does not gain. Ends when the step is below
 * CLOSE: what is left is of its square. 0: not reached. */
static int close_slider(mhb_contact *c, double z[2]) {
  double before = INFINITY, inverse[2][2], P[2];
  int    plain = 0, newton = 0;
  for (; c->info->laps < MAX_LAPS; c->info->laps++) {
    if (!run_lap(c, z, P, 1)) return 0;
    double r[2] = {P[0] - z[0], P[1] - z[1]}, size = hypot(r[0], r[1]);
    if (newton && size > .9 * before) plain = 2;
    before = size;
    newton = !plain;
    if (plain) {
      plain--;
      z[0] = P[0];
      z[1] = P[1];
      continue;
    }
    closure_inverse(c, inverse);
    double step[2] = {inverse[0][0] * r[0] + inverse[0][1] * r[1],
                      inverse[1][0] * r[0] + inverse[1][1] * r[1]};
    double length = hypot(step[0], step[1]), cut = length > 2 ? 2 / length : 1;
    z[0] += cut * step[0];
    z[1] += cut * step[1];
    if (length < CLOSE) {
      c->info->laps++;
      return 1;
    }
  }
  return 0;
}

/* Eliminate the slider columns: dz0 = (I - DP)^-1 G, J += J_z dz0. */
static void eliminate_slider(mhb_contact *c) {
  double inverse[2][2];
  int    z = 3 * c->nb;
  closure_inverse(c, inverse);
  for (int j = 0; j < z; j++) {
    double G[2] = {c->Z[j], c->Z[c->columns + j]};
    for (int k = 0; k < 2; k++)
      c->Z[k * c->columns + j] = inverse[k][0] * G[0] + inverse[k][1] * G[1];
  }
  for (int i = 0; i < 2 * c->nf; i++) {
    double *row = c->J + (size_t)i * (size_t)c->columns;
    double  a = row[z], b = row[z + 1];
    for (int j = 0; j < z; j++) row[j] += a * c->Z[j] + b * c->Z[c->columns + j];
  }
}

/* The lap whose force is wanted, from z. The last Newton step is taken on the force, not by another lap:
 * f += J_z dz, dz = (I - DP)^-1 (P(z) - z). Returns |dz|; negative: the lap was lost. */
static double record_lap(mhb_contact *c, double z[2], int derivative) {
  double inverse[2][2], P[2];
  int    at = 3 * c->nb;
  memset(c->f, 0, sizeof(double) * 2 * (size_t)c->nf);
  memset(c->J, 0, sizeof(double) * 2 * (size_t)c->nf * (size_t)c->columns);
  memset(c->stick, 0, sizeof(double) * (size_t)mhb_real_size(c->H + c->m));
  memset(c->info->share, 0, sizeof c->info->share);
  c->info->slip_work = c->info->error = c->info->n_transitions = 0;
  c->pieces.n                                                  = 0;
  c->record                                                    = 1;
  c->first                                                     = derivative ? 0 : at;
  int ok                                                       = run_lap(c, z, P, 1);
  c->record                                                    = 0;
  c->first                                                     = at;
  closure_inverse(c, inverse);
  double r[2]  = {P[0] - z[0], P[1] - z[1]};
  double dz[2] = {inverse[0][0] * r[0] + inverse[0][1] * r[1],
                  inverse[1][0] * r[0] + inverse[1][1] * r[1]};
  for (int i = 0; i < 2 * c->nf; i++) {
    const double *row = c->J + (size_t)i * (size_t)c->columns + at;
    c->f[i] += row[0] * dz[0] + row[1] * dz[1];
  }
  for (int k = 0; k < 2; k++) z[k] += dz[k];
  return ok ? hypot(dz[0], dz[1]) : -1;
}

static int run_closed_slipping(mhb_contact *c, const mhb_stuck *stuck, int derivative) {
  double z[2] = {c->scaled[c->nb] - stuck->c[0], c->scaled[2 * c->nb] - stuck->c[1]}, left = -1;
  int    reached = 1;
  c->record      = 0;
  c->first       = 3 * c->nb;
  c->last        = c->columns;
  for (int tries = 0; tries < 4 && reached; tries++) {
    reached = close_slider(c, z);
    left    = record_lap(c, z, derivative);
    if (left >= 0 && left < CLOSE) break;
  }
  /* a trace shows the lap itself: repeat it until it needs no correction */
  for (int tries = 0; c->pieces.on && left > 1e-12 && tries < 8; tries++)
    left = record_lap(c, z, derivative);
  if (derivative) eliminate_slider(c);
  c->info->error += left < 0 ? 1 : reached ? left * left : left;
  return left >= 0 && left < 1e-6;
}

/* ---- assembly ---- */

/* f += Ku s over the stick pieces; scale to Fourier coefficients. */
static void finish_friction(mhb_contact *c, int derivative) {
  int nb = c->nb, nf = c->nf;
  mhb_basis_product(c->H, c->m, c->stick, c->product, nb);
  for (int i = 0; i < nf; i++) {
    const double *S = c->product + (size_t)i * (size_t)nb;
    double        q = quadrature_scale(i);
    for (int k = 0; k < 2; k++) {
      double *f = &c->f[k * nf + i], *row = c->J + (size_t)(k * nf + i) * (size_t)c->columns;
      for (int j = 0; j < nb; j++) *f += S[j] * c->scaled[(1 + k) * nb + j];
      *f *= q;
      if (!derivative) continue;
      for (int j = 0; j < nb; j++) {
        row[nb + j] += c->K[k][0] * S[j];
        row[2 * nb + j] += c->K[k][1] * S[j];
      }
      for (int j = 0; j < 3 * nb; j++) row[j] *= q;
    }
  }
}

/* Stuck throughout: f = Ku (s - mean s) + c. */
static void finish_stuck(mhb_contact *c, const mhb_stuck *stuck, int derivative) {
  int nb = c->nb, nf = c->nf;
  c->info->share[MHB_STICK] = 1;
  c->info->undetermined     = 1;
  mhb_pieces_stick(&c->pieces, 0,
                   (double[2]){c->scaled[nb] - stuck->c[0], c->scaled[2 * nb] - stuck->c[1]});
  for (int k = 0; k < 2; k++) {
    for (int i = 1; i < nb; i++) {
      c->f[k * nf + i] = c->scaled[(1 + k) * nb + i];
      if (!derivative) continue;
      double *row     = c->J + (size_t)(k * nf + i) * (size_t)c->columns;
      row[nb + i]     = c->K[k][0];
      row[2 * nb + i] = c->K[k][1];
    }
    c->f[k * nf] = stuck->c[k];
  }
  if (!derivative || stuck->n_active == 0) return;
  double basis[2][mhb_real_size(c->m)], rate[2][mhb_real_size(c->m)];
  for (int a = 0; a < stuck->n_active; a++) mhb_basis(c->m, stuck->time[a], basis[a], rate[a]);
  for (int j = 0; j < 3 * nb; j++) {
    double value[2][3] = {{0}}, slope[2][3] = {{0}}, dc[2];
    for (int a = 0; a < stuck->n_active; a++) {
      if (j == nb || j == 2 * nb) break; /* the mean of s does not enter */
      column_change(c, basis[a], j, &value[a][1], &value[a][0]);
      column_change(c, rate[a], j, &slope[a][1], &slope[a][0]);
    }
    mhb_stuck_derivative(&c->signals, c->slip.mu, stuck, (const double(*)[3])value,
                         (const double(*)[3])slope, dc);
    c->J[j]                                           = dc[0];
    c->J[(size_t)nf * (size_t)c->columns + (size_t)j] = dc[1];
  }
}

/* Always closed: n is linear in v, and a huge preload must not drown it. */
static void normal_force_closed(const mhb_contact *c, const mhb_law *law, const double *v,
                                double *force, double *jacobian) {
  for (int i = 0; i < c->nb; i++) {
    force[i] = law->kv * v[i];
    if (jacobian) jacobian[(size_t)i * 3 * (size_t)c->nb + (size_t)i] = law->kv;
  }
  force[0] += law->n0 - law->balance;
}

/* Normal load: the harmonics of n over the closed intervals. */
static void normal_force(mhb_contact *c, const mhb_law *law, double *force, double *jacobian) {
  int nb = c->nb, nf = c->nf, sums = mhb_real_size(c->H + c->m);
  memset(c->piece, 0, sizeof(double) * (size_t)sums);
  for (int i = 0; i < c->closed.n; i++)
    mhb_basis_integral(c->H + c->m, c->closed.closing[i], c->closed.opening[i], c->piece);
  mhb_basis_product(c->H, c->m, c->piece, c->product, nb);
  for (int i = 0; i < nf; i++) {
    const double *S = c->product + (size_t)i * (size_t)nb;
    double        q = quadrature_scale(i), sum = 0;
    for (int j = 0; j < nb; j++) sum += S[j] * c->scaled[j];
    force[i] = c->scale * q * sum;
    if (!jacobian) continue;
    double *row = jacobian + (size_t)i * 3 * (size_t)nb;
    for (int j = 0; j < nb; j++) row[j] = c->scale * c->kv * q * S[j];
  }
  force[0] -= law->balance;
}

/* Loop integral of f.s' dt: pi sum_k k (Im F_k Re S_k - Re F_k Im S_k) for x = Re X_k exp(jkt). */
static double loop_work(const mhb_contact *c, const double *motion, const double *force) {
  double sum = 0;
  for (int i = 1; i < 3; i++) {
    const double *s = motion + i * c->nb, *f = force + i * c->nf;
    for (int k = 1; k <= c->m; k++) sum += k * (f[2 * k] * s[2 * k - 1] - f[2 * k - 1] * s[2 * k]);
  }
  return .5 * TWO_PI * sum;
}

/* mu = 0: slip wherever it is closed. */
static void without_friction(mhb_contact *c) {
  double closed = c->closed.always_closed;
  if (closed > 0) mhb_pieces_frictionless(&c->pieces, 0);
  for (int i = 0; i < c->closed.n; i++) {
    closed += (c->closed.opening[i] - c->closed.closing[i]) / TWO_PI;
    note_transition(c, c->closed.closing[i], MHB_SLIDE);
    mhb_pieces_frictionless(&c->pieces, c->closed.closing[i]);
    note_transition(c, c->closed.opening[i], MHB_SEPARATE);
    mhb_pieces_open(&c->pieces, c->closed.opening[i]);
  }
  c->info->share[MHB_SLIDE]    = closed;
  c->info->share[MHB_SEPARATE] = 1 - closed;
}

static void friction_force(mhb_contact *c, int derivative) {
  mhb_stuck stuck = {0};
  c->record       = 1;
  c->first        = 0;
  c->last         = 3 * c->nb;
  if (c->closed.always_open) {
    c->info->share[MHB_SEPARATE] = 1;
    return;
  }
  if (c->slip.mu == 0) {
    without_friction(c);
    return;
  }
  int ok;
  if (c->closed.always_closed) {
    mhb_stuck_solve(&c->signals, c->slip.mu, &stuck);
    if (stuck.feasible) {
      finish_stuck(c, &stuck, derivative);
      return;
    }
    ok = run_closed_slipping(c, &stuck, derivative);
  } else {
    ok = run_openings(c, derivative);
  }
  finish_friction(c, derivative);
  c->info->lost = !ok;
}

void mhb_contact_force(mhb_contact *c, const mhb_law *law, const double *motion, double *force,
                       double *jacobian, mhb_contact_info *info) {
  int    nb = c->nb, nf = c->nf;
  size_t size = (size_t)nf * 3;
  memset(info, 0, offsetof(mhb_contact_info, transition));
  memset(force, 0, sizeof(double) * size);
  if (jacobian) memset(jacobian, 0, sizeof(double) * size * 3 * (size_t)nb);
  c->info = info;
  if (!set_signals(c, law, motion)) { /* at rest, without preload; or not a number */
    info->share[MHB_SEPARATE] = 1;
    info->lost                = isnan(c->scale);
    for (size_t i = 0; info->lost && i < size; i++) force[i] = NAN;
    return;
  }
  set_slip(c, law);
  mhb_closed_intervals(&c->signals, &c->closed);
  memset(c->f, 0, sizeof(double) * 2 * (size_t)nf);
  memset(c->stick, 0, sizeof(double) * (size_t)mhb_real_size(c->H + c->m));
  if (jacobian) memset(c->J, 0, sizeof(double) * 2 * (size_t)nf * (size_t)c->columns);
  friction_force(c, jacobian != NULL);
  for (int i = 0; i < 2 * nf; i++) {
    force[nf + i] = c->scale * c->f[i];
    if (!jacobian) continue;
    const double *from = c->J + (size_t)i * (size_t)c->columns;
    double       *row  = jacobian + (size_t)(nf + i) * 3 * (size_t)nb;
    for (int j = 0; j < 3 * nb; j++) row[j] = c->scale * from[j];
  }
  if (c->closed.always_closed) {
    normal_force_closed(c, law, motion, force, jacobian);
  } else {
    normal_force(c, law, force, jacobian);
  }
  info->slip_work *= c->scale;
  info->dissipation = loop_work(c, motion, force);
}

const mhb_pieces *mhb_contact_pieces(mhb_contact *c, const mhb_law *law, const double *motion,
                                     mhb_contact_info *info) {
  c->pieces.n = c->pieces.full = 0;
  c->pieces.on                 = 1;
  mhb_contact_force(c, law, motion, c->traced, NULL, info);
  c->pieces.on    = 0;
  c->pieces.mu    = law->mu;
  c->pieces.scale = c->scale;
  info->lost |= c->pieces.full;
  return &c->pieces;
}
