#include "mhb/contact/sensitivity.h"

#include <math.h>
#include <string.h>

void mhb_sensitivity_clear(mhb_contact_evaluator *c) {
  size_t size = sizeof(double) * (size_t)c->stride;
  memset(c->T, 0, size);
  memset(c->Z[0], 0, size);
  memset(c->Z[1], 0, size);
  memset(&c->lap, 0, sizeof c->lap);
}

/* out = sum_k keep[k] from[k] + value[kind] basis + slope[kind] basis', kinds v, u, w. */
static void combine(const mhb_contact_evaluator *c, double *out, int terms, const double *keep,
                    double *const *from, const double value[3], const double slope[3]) {
  int           begin = c->mode == MHB_ALL_COLUMNS ? 0 : c->slider_column, nb = c->nb;
  const double *b = c->event_basis, *db = b + nb;
  for (int j = begin; j <= c->slider_column; j++)
    out[j] = terms == 0   ? 0
             : terms == 1 ? keep[0] * from[0][j]
                          : keep[0] * from[0][j] + keep[1] * from[1][j];
  if (begin) return;
  for (int kind = 0; kind < 3; kind++, out += nb)
    for (int i = 0; i < nb; i++) out[i] += value[kind] * b[i] + (slope ? slope[kind] * db[i] : 0);
}

static void basis_at(mhb_contact_evaluator *c, double t) {
  if (c->mode == MHB_ALL_COLUMNS) mhb_basis(c->m, t, c->event_basis, c->event_basis + c->nb);
}

/* The change of f is projected obliquely onto the circle, free of the onset speed, so that nothing
 * diverges at grazing:
 *   df+ = df - Kf (f.df - mu^2 n dn)/(f.Kf),
 *   dtheta = [g.(dx - dz) + mu beta dn]/(mu n),  g = q - beta e. */
void mhb_sensitivity_stick_to_slip(mhb_contact_evaluator *c, double t, double theta, double n) {
  if (c->mode == MHB_NO_COLUMNS) return;
  mhb_direction d        = mhb_slip_direction(c->K, theta);
  double        limit    = c->slip.mu * n;
  double        g[2]     = {(d.q[0] - d.beta * d.e[0]) / limit, (d.q[1] - d.beta * d.e[1]) / limit};
  double        value[3] = {d.beta / n * c->kv, g[0] * c->K[0][0] + g[1] * c->K[1][0],
                            g[0] * c->K[0][1] + g[1] * c->K[1][1]};
  /* power at the onset gamma mu n/eKe; the onset is earlier by (e.df - mu dn)/gamma */
  double eKe =
      d.e[0] * (c->K[0][0] * d.e[0] + 2 * c->K[0][1] * d.e[1]) + c->K[1][1] * d.e[1] * d.e[1];
  double work  = -limit / eKe;
  double dz[2] = {c->Z[0][c->slider_column], c->Z[1][c->slider_column]};
  basis_at(c, t);
  combine(c, c->T, 2, (double[2]){-g[0], -g[1]}, c->Z, value, NULL);
  c->lap.work += work * (d.e[0] * dz[0] + d.e[1] * dz[1]);
  if (c->lap.slipped) return;
  c->lap = (mhb_slider_sensitivity){
      .slipped = 1, .v = {-g[0], -g[1]}, .onset = {work * d.e[0], work * d.e[1]}};
  c->T[c->slider_column] = 1;
}

/* The force is continuous: dz = dx - (mu dn e + mu n q dtheta). */
void mhb_sensitivity_slip_to_stick(mhb_contact_evaluator *c, double t, double theta, double n) {
  if (c->mode == MHB_NO_COLUMNS) return;
  double mu = c->slip.mu, e[2] = {cos(theta), sin(theta)}, q[2] = {-e[1], e[0]};
  basis_at(c, t);
  for (int k = 0; k < 2; k++) {
    double value[3] = {-mu * c->kv * e[k], c->K[k][0], c->K[k][1]}, keep = -mu * n * q[k];
    combine(c, c->Z[k], 1, &keep, &c->T, value, NULL);
  }
}

/* Stick: z = x(t), dz = dx + x' dt with dt = -dn/n'. Slip: the regular solution
 *   dtheta = [(q - beta e).dx' + mu beta dn' - mu theta' dn]/D with theta', D of slip.h. */
void mhb_sensitivity_closing(mhb_contact_evaluator *c, double t, mhb_state state, double theta) {
  if (c->mode == MHB_NO_COLUMNS) return;
  double y[3], dy[3], ddy[3], mu = c->slip.mu;
  basis_at(c, t);
  mhb_signals_at(&c->signals, t, y, dy, ddy);
  if (state == MHB_STICK) {
    for (int k = 0; k < 2; k++) {
      double value[3] = {-dy[1 + k] * c->kv / dy[0], c->K[k][0], c->K[k][1]};
      combine(c, c->Z[k], 0, NULL, NULL, value, NULL);
    }
    return;
  }
  double        D;
  mhb_direction d        = mhb_slip_direction(c->K, theta);
  double        rate     = mhb_slip_closing_rate(&c->slip, &d, dy, ddy, &D);
  double        g[2]     = {d.q[0] - d.beta * d.e[0], d.q[1] - d.beta * d.e[1]};
  double        value[3] = {-mu * rate * c->kv / D, 0, 0};
  double        slope[3] = {mu * d.beta * c->kv / D, (g[0] * c->K[0][0] + g[1] * c->K[1][0]) / D,
                            (g[0] * c->K[0][1] + g[1] * c->K[1][1]) / D};
  combine(c, c->T, 0, NULL, NULL, value, slope);
}

/* ---- a panel of slip ---- */

/* sum[i] += basis_i g over the panel's nodes, for n quantities g side by side. */
MHB_INLINE void add_to_sums(const mhb_panel *p, int harmonics, int n, int stride,
                            const mhb_lanes *g, mhb_lanes *sum) {
  mhb_lanes c = lanes_all(1), s = lanes_all(0);
  for (int q = 0; q < n; q++) sum[q] += g[q];
  for (int k = 1; k <= harmonics; k++) {
    mhb_lanes next = c * p->cosine - s * p->sine;
    s              = s * p->cosine + c * p->sine;
    c              = next;
    sum += stride;
    for (int q = 0; q < n; q++) sum[q] += c * g[q];
    sum += stride;
    for (int q = 0; q < n; q++) sum[q] -= s * g[q];
  }
}

/* The force of a panel, mu n e, weighted; with the slider column also mu n q dtheta. */
MHB_HOT static void add_force(mhb_contact_evaluator *c, double growth) {
  const mhb_panel *p      = &c->panel;
  mhb_lanes        weight = p->h * c->slip.mu * c->rule.weight * p->y[0];
  mhb_lanes        g[4]   = {weight * p->e[0], weight * p->e[1]};
  if (growth == 0) { /* the slider of the start has no influence */
    add_to_sums(p, c->H, 2, 4, g, c->slip_sums);
    return;
  }
  g[2] = -growth * p->transfer * g[1];
  g[3] = growth * p->transfer * g[0];
  add_to_sums(p, c->H, 4, 4, g, c->slip_sums);
  mhb_lanes across = p->e[0] * p->dy[2] - p->e[1] * p->dy[1];
  c->lap.work +=
      growth * lanes_sum(weight * p->transfer / p->eKe * (across - 2 * p->beta * p->gamma));
}

/* The basis at the nodes by lanes, [sums], and its first rows times mu n w q_k, [2][nf]. Two
 * recurrences, of odd and of even harmonics, do not wait for each other. */
MHB_INLINE void basis_lanes(const mhb_contact_evaluator *c) {
  const mhb_panel *p   = &c->panel;
  int              top = c->H + c->m;
  mhb_lanes       *b = c->node_basis, *row = b + mhb_real_size(top);
  mhb_lanes        c2 = p->cosine * p->cosine - p->sine * p->sine, s2 = 2 * p->sine * p->cosine;
  mhb_lanes        cs[2] = {p->cosine, c2}, sn[2] = {p->sine, s2};
  b[0] = lanes_all(1);
  for (int k = 1; k <= top; k += 2) {
    for (int i = 0; i < 2; i++) { /* one beyond top is the first row, set below */
      b[2 * (k + i) - 1] = cs[i];
      b[2 * (k + i)]     = -sn[i];
      mhb_lanes next     = cs[i] * c2 - sn[i] * s2;
      sn[i]              = sn[i] * c2 + cs[i] * s2;
      cs[i]              = next;
    }
  }
  mhb_lanes weight    = p->h * c->slip.mu * c->rule.weight * p->y[0];
  mhb_lanes across[2] = {-weight * p->e[1], weight * p->e[0]};
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < c->nf; i++) row[k * c->nf + i] = across[k] * b[i];
}

/* Integrals of mu kv e times the basis. */
MHB_INLINE void add_load(const mhb_contact_evaluator *c) {
  const mhb_panel *p      = &c->panel;
  mhb_lanes        weight = p->h * c->slip.mu * c->kv * c->rule.weight;
  mhb_lanes        g[2] = {weight * p->e[0], weight * p->e[1]}, *sum = c->load_sums;
  const mhb_lanes *b = c->node_basis, *end = b + mhb_real_size(c->H + c->m);
  for (; b < end; b++, sum += 2)
    for (int k = 0; k < 2; k++) sum[k] += g[k] * *b;
}

/* Right-hand side of the linearised slip equation, rows by node, for columns v_i, u_i, w_i:
 *   kv (beta/n b'_i - F/n b_i),  a_u b'_i,  a_w b'_i  with a = ((q - beta e) K)/(mu n).
 * Eight columns are written at once. Those beyond the last harmonic are overwritten by what
 * follows, or are the room behind a row. */
MHB_INLINE void fill_drive(const mhb_contact_evaluator *c) {
  const mhb_panel *p    = &c->panel;
  mhb_lanes        over = p->frozen ? lanes_all(0) : 1 / p->y[0], limit = over * (1 / c->slip.mu);
  mhb_lanes g0 = (-p->e[1] - p->beta * p->e[0]) * limit, g1 = (p->e[0] - p->beta * p->e[1]) * limit;
  mhb_lanes slope[3] = {c->kv * p->beta * over, g0 * c->K[0][0] + g1 * c->K[1][0],
                        g0 * c->K[0][1] + g1 * c->K[1][1]};
  mhb_lanes value    = -c->kv * p->F * over;
  int       nb = c->nb, row = c->stride + MHB_LANES;
  double   *rhs   = c->rhs;
  mhb_lanes order = {1, -1, 2, -2, 3, -3, 4, -4}, sign = {1, -1, 1, -1, 1, -1, 1, -1};
  for (int kind = 0; kind < 3; kind++) {
    mhb_lanes harmonic = order;
    for (int l = 0; l < MHB_NODES; l++) rhs[l * row + kind * nb] = kind == 0 ? value[l] : 0;
    for (int i = 1; i < nb; i += MHB_LANES, harmonic += 4 * sign) {
      mhb_lanes basis[MHB_NODES];
#pragma GCC unroll 8
      for (int k = 0; k < MHB_NODES; k++) basis[k] = c->node_basis[i + k];
      lanes_transpose(basis);
#pragma GCC unroll 8
      for (int l = 0; l < MHB_NODES; l++) {
        mhb_lanes r = slope[kind][l] * harmonic * lanes_swap(basis[l]);
        if (kind == 0) r += value[l] * basis[l];
        lanes_store(rhs + l * row + kind * nb + i, r);
      }
    }
  }
  for (int l = 0; l < MHB_NODES; l++)
    for (int j = c->slider_column; j < c->stride; j++) rhs[l * row + j] = 0;
}

/* T_nodes and T at the panel's end: the collocation equations linearised, with the same matrix. */
MHB_INLINE void columns_through(const mhb_contact_evaluator *c) {
  const mhb_panel *p = &c->panel;
  mhb_lanes        hA[MHB_NODES], end = p->h * c->rule.weight;
  mhb_lanes        last = p->stiff ? c->rule.end : end * p->F_theta;
  double           keep = p->stiff ? 0 : 1;
  if (p->stiff) end = lanes_all(0);
  double       *T_end = c->T, *T_nodes = c->T_nodes;
  const double *rhs    = c->rhs;
  const int     stride = c->stride, row = stride + MHB_LANES;
  mhb_slip_response(&c->slip, p, hA);
  for (int j = 0; j < stride; j += MHB_LANES) {
    mhb_lanes T = lanes_load(T_end + j), sum = keep * T, value[MHB_NODES];
#pragma GCC unroll 8
    for (int l = 0; l < MHB_NODES; l++) value[l] = p->transfer[l] * T;
#pragma GCC unroll 8
    for (int q = 0; q < MHB_NODES; q++) {
      mhb_lanes r = lanes_load(rhs + q * row + j);
      sum += end[q] * r;
#pragma GCC unroll 8
      for (int l = 0; l < MHB_NODES; l++) value[l] += hA[q][l] * r;
    }
#pragma GCC unroll 8
    for (int l = 0; l < MHB_NODES; l++) {
      lanes_store(T_nodes + l * stride + j, value[l]);
      sum += last[l] * value[l];
    }
    lanes_store(T_end + j, sum);
  }
}

/* J[row][j] += sum_l b[row][l] y[l][j] for a few rows and vectors at once. */
MHB_INLINE void add_block(int rows, int vectors, int stride, const mhb_lanes *b, const double *y,
                          double *J) {
  mhb_lanes sum[6][2];
  for (int r = 0; r < rows; r++)
    for (int v = 0; v < vectors; v++) sum[r][v] = lanes_load(J + r * stride + v * MHB_LANES);
#pragma GCC unroll 8
  for (int l = 0; l < MHB_NODES; l++) {
    mhb_lanes column[2];
    for (int v = 0; v < vectors; v++) column[v] = lanes_load(y + l * stride + v * MHB_LANES);
    for (int r = 0; r < rows; r++)
      for (int v = 0; v < vectors; v++) sum[r][v] += b[r][l] * column[v];
  }
  for (int r = 0; r < rows; r++)
    for (int v = 0; v < vectors; v++) lanes_store(J + r * stride + v * MHB_LANES, sum[r][v]);
}

MHB_INLINE void add_rows(int rows, int vectors, int columns, int stride, const mhb_lanes *b,
                         const double *y, double *J) {
  int j = 0;
  for (; j + vectors * MHB_LANES <= columns; j += vectors * MHB_LANES)
    add_block(rows, vectors, stride, b, y + j, J + j);
  for (; j < columns; j += MHB_LANES) add_block(rows, 1, stride, b, y + j, J + j);
}

/* The hot loop of the derivative. Six rows hide the latency of a multiplication; two and one make
 * up the rest. Two vectors at once load half as often, where the registers suffice. */
MHB_INLINE void add_outer(int vectors, int rows, int columns, int stride, const mhb_lanes *b,
                          const double *y, double *J) {
  int row = 0;
  for (; row + 6 <= rows; row += 6)
    add_rows(6, vectors, columns, stride, b + row, y, J + row * stride);
  for (; row + 2 <= rows; row += 2)
    add_rows(2, vectors, columns, stride, b + row, y, J + row * stride);
  for (; row < rows; row++) add_rows(1, vectors, columns, stride, b + row, y, J + row * stride);
}

MHB_HOT static void add_product(int rows, int columns, int stride, const mhb_lanes *b,
                                const double *y, double *J) {
  add_outer(1, rows, columns, stride, b, y, J);
}

#ifdef MHB_HAS_WIDE
MHB_WIDE static void add_product_wide(int rows, int columns, int stride, const mhb_lanes *b,
                                      const double *y, double *J) {
  add_outer(2, rows, columns, stride, b, y, J);
}
#else
#define add_product_wide add_product
#endif

MHB_HOT static void propagate_columns(const mhb_contact_evaluator *c) {
  basis_lanes(c);
  add_load(c);
  fill_drive(c);
  columns_through(c);
}

/* most[kind] <- largest |T| at the nodes in the columns of v, u, w. */
MHB_HOT static void largest_of_kinds(const mhb_contact_evaluator *c, double most[3]) {
  for (int kind = 0; kind < 3; kind++) {
    mhb_lanes top = lanes_all(0);
    const int end = (kind + 1) * c->nb;
    for (int l = 0; l < MHB_NODES; l++) {
      const double *T = c->T_nodes + l * c->stride;
      int           j = kind * c->nb;
      for (; j + MHB_LANES <= end; j += MHB_LANES)
        top = lanes_max(top, lanes_abs(lanes_load(T + j)));
      for (; j < end; j++) top[0] = mhb_most(top[0], fabs(T[j]));
    }
    most[kind] = lanes_top(top);
  }
}

/* Rows of the derivative from which on a look at its blocks costs less than a tenth of them. */
enum { WORTH_LOOKING = 16 };

/* Parts of the derivative below this, relative to the stiffness, are rounding. */
static const double ROUNDING = 1e-15;

/* J of the friction f_k += the panel's part, over the kinds of columns that turn it. Where the
 * motion keeps to a line nothing but w turns u, and nothing turns by u: five of six blocks are
 * zero. */
static void add_friction(const mhb_contact_evaluator *c, int k, const double most[3]) {
  const mhb_panel *p      = &c->panel;
  const mhb_lanes *rows   = c->node_basis + mhb_real_size(c->H + c->m) + k * c->nf;
  const double     across = c->slip.mu * lanes_top(lanes_abs(p->y[0] * p->e[1 - k]));
  const double     least  = ROUNDING * (fabs(c->K[0][0]) + fabs(c->K[1][1]));
  for (int kind = 0, end; kind < 3; kind = end + 1) {
    for (end = kind; end < 3 && across * most[end] > least;) end++;
    if (end == kind) continue;
    const int columns = mhb_whole_lanes((end - kind) * c->nb);
    const int from    = kind * c->nb < c->stride - columns ? kind * c->nb : c->stride - columns;
    double   *J       = c->J + (size_t)k * (size_t)c->nf * (size_t)c->stride + from;
    if (mhb_has_wide()) {
      add_product_wide(c->nf, columns, c->stride, rows, c->T_nodes + from, J);
    } else {
      add_product(c->nf, columns, c->stride, rows, c->T_nodes + from, J);
    }
  }
}

static void add_derivative(const mhb_contact_evaluator *c) {
  double most[3] = {INFINITY, INFINITY, INFINITY};
  propagate_columns(c);
  if (c->nf >= WORTH_LOOKING) largest_of_kinds(c, most);
  for (int k = 0; k < 2; k++) add_friction(c, k, most);
}

void mhb_sensitivity_panel(mhb_contact_evaluator *c) {
  double growth = c->T[c->slider_column], before = growth;
  growth *= c->panel.growth;
  if (c->record) add_force(c, before);
  if (c->mode == MHB_ALL_COLUMNS) add_derivative(c);
  c->T[c->slider_column] = growth;
}

/* ---- a piece of stick ---- */

MHB_HOT static void add_stick_derivative(const mhb_contact_evaluator *c) {
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < c->nf; i++) {
      double *row = c->J + (size_t)(k * c->nf + i) * (size_t)c->stride;
      for (int j = 0; j < c->stride; j += MHB_LANES)
        lanes_store(row + j, lanes_load(row + j) - c->basis_integrals[i] * lanes_load(c->Z[k] + j));
    }
  }
}

void mhb_sensitivity_stick(mhb_contact_evaluator *c) {
  if (c->mode == MHB_NO_COLUMNS) return;
  if (!c->lap.slipped) {
    for (int i = 0; i < c->nf; i++) c->first_stick[i] += c->basis_integrals[i];
  } else {
    for (int k = 0; k < 2; k++)
      for (int i = 0; i < c->nf; i++)
        c->f_slider[k * c->nf + i] -= c->basis_integrals[i] * c->Z[k][c->slider_column];
  }
  if (c->mode == MHB_ALL_COLUMNS) add_stick_derivative(c);
}

/* ---- the periodic slider ---- */

/* DP = d v^T: (I - DP)^-1 r = r + d v.r/(1 - v.d), the denominator held above a floor. For Newton
 * that is rounding; for the derivative it bounds the result where slip just begins. */
static double closure(const mhb_contact_evaluator *c, double floor) {
  double det =
      1 - c->lap.v[0] * c->Z[0][c->slider_column] - c->lap.v[1] * c->Z[1][c->slider_column];
  return fabs(det) < floor ? copysign(floor, det) : det;
}

double mhb_sensitivity_contraction(const mhb_contact_evaluator *c) {
  const double *v = c->lap.v;
  return c->lap.slipped
             ? hypot(v[0], v[1]) * hypot(c->Z[0][c->slider_column], c->Z[1][c->slider_column])
             : 1;
}

double mhb_sensitivity_roundoff(const mhb_contact_evaluator *c) {
  return c->lap.slipped ? fmin(4e-6, 4e-13 / fabs(closure(c, 1e-12))) : 0;
}

void mhb_sensitivity_close(const mhb_contact_evaluator *c, const double r[2], double dz[2]) {
  const mhb_slider_sensitivity *memory = &c->lap;
  double                        part =
      memory->slipped ? (memory->v[0] * r[0] + memory->v[1] * r[1]) / closure(c, 1e-12) : 0;
  for (int k = 0; k < 2; k++) dz[k] = r[k] + c->Z[k][c->slider_column] * part;
}

MHB_HOT static void eliminate(mhb_contact_evaluator *c) {
  const double *v = c->lap.v, det = closure(c, 1e-7);
  for (int j = 0; j < c->slider_column; j++) {
    double G[2] = {c->Z[0][j], c->Z[1][j]}, part = (v[0] * G[0] + v[1] * G[1]) / det;
    for (int k = 0; k < 2; k++) c->Z[k][j] = G[k] + c->Z[k][c->slider_column] * part;
    c->T[j] = part; /* v.dz: v.d part + v.G = part */
  }
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < c->nf; i++) {
      double *row = c->J + (size_t)(k * c->nf + i) * (size_t)c->stride;
      double  a = -c->first_stick[i], b = c->f_slider[k * c->nf + i];
      for (int j = 0; j < c->slider_column; j++) row[j] += a * c->Z[k][j] + b * c->T[j];
    }
  }
}

void mhb_sensitivity_eliminate_slider(mhb_contact_evaluator *c) {
  eliminate(c);
}
