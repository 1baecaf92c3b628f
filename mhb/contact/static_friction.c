#include "mhb/contact/static_friction.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

/* |c + f| <= r at time t */
typedef struct {
  double f[2], r, t;
} disc;

enum { EXTRA = 48 };

typedef struct {
  const mhb_signals *signals;
  double             mu, scale;
  disc               extra[EXTRA]; /* refined times */
  int                n_extra;
} discs;

static disc disc_of(const discs *set, double t, const double v[3]) {
  const double *mean = set->signals->coefficient;
  disc          d    = {.f = {v[1] - mean[1], v[2] - mean[2]}, .r = set->mu * v[0], .t = t};
  return d;
}

static disc disc_at(const discs *set, int i) {
  int n = set->signals->n_grid;
  if (i >= n) return set->extra[i - n];
  double *const *value = set->signals->value;
  return disc_of(set, SHB_TWO_PI * i / n, (double[3]){value[0][i], value[1][i], value[2][i]});
}

/* Forces are in units of the largest in sight: squares neither overflow nor vanish. */
static double length_of(double a, double b) {
  return sqrt(a * a + b * b);
}

static double violation(const disc *d, const double c[2]) {
  return length_of(c[0] + d->f[0], c[1] + d->f[1]) - d->r;
}

/* Nearest point to the origin in one disc. */
static void nearest_in(const disc *d, double c[2]) {
  double size = length_of(d->f[0], d->f[1]);
  double move = size > d->r ? 1 - d->r / size : 0;
  c[0]        = -d->f[0] * move;
  c[1]        = -d->f[1] * move;
}

/* Nearest point to the origin on both circles. 0: the circles do not meet. */
static int on_both(const disc *a, const disc *b, double c[2]) {
  double dx = a->f[0] - b->f[0], dy = a->f[1] - b->f[1], d = length_of(dx, dy);
  if (d == 0 || d > a->r + b->r) return 0;
  double along = (d * d + a->r * a->r - b->r * b->r) / (2 * d), h2 = a->r * a->r - along * along;
  if (h2 < 0) return 0; /* one inside the other */
  double h = sqrt(h2), ex = dx / d, ey = dy / d;
  double px = -a->f[0] + along * ex, py = -a->f[1] + along * ey; /* from centre -f_a towards -f_b */
  double sign = (-ey * px + ex * py) > 0 ? -1 : 1;
  c[0]        = px - sign * h * ey;
  c[1]        = py + sign * h * ex;
  return 1;
}

/* Smallest c in the intersection of up to three discs; basis <- the active ones. 0: it is empty. */
static int smallest_in(const disc d[3], int n, double slack, double c[2], int basis[2], int *size) {
  for (int i = 0; i < n; i++) {
    nearest_in(&d[i], c);
    int inside = 1;
    for (int j = 0; j < n; j++) inside &= j == i || violation(&d[j], c) <= slack;
    if (!inside) continue;
    basis[0] = i;
    *size    = 1;
    return 1;
  }
  double best = INFINITY, trial[2];
  for (int i = 0; i < n; i++) {
    for (int j = i + 1; j < n; j++) {
      int other = 3 - i - j;
      if (!on_both(&d[i], &d[j], trial)) continue;
      if (n == 3 && violation(&d[other], trial) > slack) continue;
      double norm = length_of(trial[0], trial[1]);
      if (norm >= best) continue;
      best     = norm;
      c[0]     = trial[0];
      c[1]     = trial[1];
      basis[0] = i;
      basis[1] = j;
      *size    = 2;
    }
  }
  return best < INFINITY;
}

/* Grid point of the largest violation, to a factor of sqrt 2: |c + f| - r = (|c + f|^2 - r^2)/(|c +
 * f| + r), with the 1-norm in the denominator. *size_of: that violation, nearer to zero than the
 * true one. */
MHB_HOT static int worst_on_grid(const discs *set, const double c[2], double *size_of) {
  const mhb_signals *s = set->signals;
  double a0 = c[0] - s->coefficient[1], b0 = c[1] - s->coefficient[2], mu2 = set->mu * set->mu;
  double worst = -INFINITY;
  int    at    = 0;
  for (int i = 0; i < s->n_grid; i += MHB_LANES) {
    mhb_lanes n = lanes_load(s->value[0] + i), a = lanes_load(s->value[1] + i) + a0,
              b    = lanes_load(s->value[2] + i) + b0;
    mhb_lanes size = lanes_abs(a) + lanes_abs(b) + lanes_abs(n) * set->mu + DBL_MIN;
    mhb_lanes v    = (a * a + b * b - mu2 * n * n) / size;
    double    top  = lanes_top(v);
    if (!(top > worst)) continue;
    worst = top;
    for (int l = 0; l < MHB_LANES; l++)
      if (v[l] == top) at = i + l;
  }
  *size_of = worst;
  return at;
}

/* How far |c + f| - mu n can rise above its values at both ends of a cell. Along a straight line
 * |c + f| is convex. The second derivatives times h^2/8 bound the distance of f and n from the
 * straight lines between the ends. */
static double rise_in_cell(const discs *set) {
  const mhb_signals *s = set->signals;
  double             h = SHB_TWO_PI / s->n_grid;
  return h * h / 8 * (length_of(s->bound[1][2], s->bound[2][2]) + set->mu * s->bound[0][2]);
}

/* Index and violation of the worst disc of the grid and of the refined times. */
static int worst_disc(const discs *set, const double c[2], double *worst) {
  double about;
  int    n = set->signals->n_grid, at = worst_on_grid(set, c, &about);
  disc   d = disc_at(set, at);
  *worst   = violation(&d, c);
  for (int i = n; i < n + set->n_extra; i++) {
    double v = violation(&set->extra[i - n], c);
    if (v <= *worst) continue;
    *worst = v;
    at     = i;
  }
  return at;
}

/* Over the discs known so far: add the worst violated one until none is. |c| grows at every
 * step. */
static int solve_known(const discs *set, mhb_static_friction *stuck, disc active[3],
                       int *n_active) {
  double slack = 1e-13 * set->scale, worst;
  for (int i = 0; i < 400; i++) {
    int at = worst_disc(set, stuck->c, &worst);
    if (worst <= slack) return 1;
    active[*n_active] = disc_at(set, at);
    int basis[2], size;
    if (!smallest_in(active, *n_active + 1, slack, stuck->c, basis, &size)) return 0;
    disc kept[2] = {active[basis[0]], active[size == 2 ? basis[1] : basis[0]]};
    active[0]    = kept[0];
    active[1]    = kept[1];
    *n_active    = size;
  }
  return 1;
}

/* Local maximum of |c + f|^2 - r^2 near t by Newton on its slope. */
static double refine(const discs *set, const double c[2], double t, double width) {
  double start = t, mu2 = set->mu * set->mu;
  for (int i = 0; i < 30; i++) {
    double v[3], dv[3], ddv[3];
    mhb_signals_at(set->signals, t, v, dv, ddv);
    disc   d = disc_of(set, t, v);
    double a = c[0] + d.f[0], b = c[1] + d.f[1];
    double slope  = a * dv[1] + b * dv[2] - mu2 * v[0] * dv[0];
    double second = a * ddv[1] + b * ddv[2] + dv[1] * dv[1] + dv[2] * dv[2] -
                    mu2 * (v[0] * ddv[0] + dv[0] * dv[0]);
    double step = second < 0 ? -slope / second : copysign(.25 * width, slope);
    step        = fmax(-width, fmin(width, step));
    t           = fmax(start - width, fmin(start + width, t + step));
    if (fabs(step) < 1e-14) break;
  }
  return t;
}

/* The best of some points about a local maximum of the grid. Where n nearly touches zero the
 * maximum is narrower than a cell. */
MHB_HOT static double scan(const discs *set, const double c[2], double t, double width) {
  const mhb_lanes place = {-3, -2, -1, 0, 1, 2, 3, 0}; /* in quarters of the width */
  const double   *mean  = set->signals->coefficient;
  mhb_lanes       here  = t + .25 * width * place, cosine, sine, y[3], dy[3];
  lanes_cos_sin(here, &cosine, &sine);
  mhb_signals_at_lanes(set->signals, cosine, sine, y, dy);
  mhb_lanes a = y[1] + (c[0] - mean[1]), b = y[2] + (c[1] - mean[2]), square = a * a + b * b, over;
  for (int l = 0; l < MHB_LANES; l++) over[l] = sqrt(square[l]);
  over -= set->mu * y[0];
  double best = lanes_top(over);
  for (int l = 0; l < MHB_LANES; l++)
    if (over[l] == best) return here[l];
  return t;
}

/* over[n_grid + 2] <- violations on the grid, from the last point before it to the first beyond. */
MHB_HOT static void violations_on_grid(const discs *set, const double c[2], double *over) {
  const mhb_signals *s  = set->signals;
  double             a0 = c[0] - s->coefficient[1], b0 = c[1] - s->coefficient[2];
  int                n = s->n_grid;
  for (int i = 0; i < n; i += MHB_LANES) {
    mhb_lanes a = lanes_load(s->value[1] + i) + a0, b = lanes_load(s->value[2] + i) + b0;
    mhb_lanes square = a * a + b * b, size;
    for (int l = 0; l < MHB_LANES; l++) size[l] = sqrt(square[l]);
    lanes_store(over + 1 + i, size - set->mu * lanes_load(s->value[0] + i));
  }
  over[0]     = over[n];
  over[n + 1] = over[1];
}

/* Adds refined times of local maxima that violate. Returns their number. */
static int add_violated(discs *set, const double c[2]) {
  int    n = set->signals->n_grid, added = 0;
  double width = SHB_TWO_PI / n, enough = -rise_in_cell(set), most, over[n + 2];
  worst_on_grid(set, c, &most);
  if (most < enough) return 0;
  violations_on_grid(set, c, over);
  for (int i = 0; i < n && set->n_extra < EXTRA; i++) {
    double here = over[i + 1];
    if (here < enough || here < over[i] || here < over[i + 2]) continue;
    double v[3], dv[3], t = refine(set, c, scan(set, c, width * i, width), .5 * width);
    mhb_signals_at(set->signals, t, v, dv, NULL);
    disc d = disc_of(set, t, v);
    if (violation(&d, c) <= 2e-13 * set->scale) continue;
    set->extra[set->n_extra++] = d;
    added++;
  }
  return added;
}

/* The one-disc solution in time: the slope g of |f| - r, its own slope, and q.f'. */
typedef struct {
  double e[2], size, r, slope, bending, across;
} summit;

static summit summit_at(const discs *set, double t) {
  double v[3], dv[3], ddv[3], mu = set->mu;
  mhb_signals_at(set->signals, t, v, dv, ddv);
  disc   d  = disc_of(set, t, v);
  summit s  = {.size = length_of(d.f[0], d.f[1]), .r = d.r};
  s.e[0]    = d.f[0] / s.size;
  s.e[1]    = d.f[1] / s.size;
  s.across  = s.e[0] * dv[2] - s.e[1] * dv[1];
  s.slope   = s.e[0] * dv[1] + s.e[1] * dv[2] - mu * dv[0];
  s.bending = s.e[0] * ddv[1] + s.e[1] * ddv[2] - mu * ddv[0] + s.across * s.across / s.size;
  return s;
}

/* |c| is stationary in the time of one active disc, its direction is not: Newton's method on g. */
static void sharpen(const discs *set, mhb_static_friction *stuck) {
  summit s = summit_at(set, stuck->time[0]);
  for (int i = 0; i < 6 && s.bending < 0; i++) {
    double step = -s.slope / s.bending;
    if (fabs(step) > 1e-3) return;
    stuck->time[0] += step;
    s = summit_at(set, stuck->time[0]);
    if (fabs(step) < 1e-15) break;
  }
  for (int k = 0; k < 2; k++) stuck->c[k] = -s.e[k] * fmax(0, s.size - s.r);
}

/* Whether no c is admissible, by two necessary conditions on the grid.
 *
 * The mean over time of |f + c| <= mu n, f of zero mean, is |c| <= mu mean n: |f| <= mu (n + mean
 * n). Along a direction e, e.(f + c) <= mu n and -e.(f + c) <= mu n: the largest e.f - mu n and the
 * largest -e.f - mu n have a sum below zero. e is that of the largest f. */
MHB_HOT static int inadmissible(const mhb_signals *s, double mu) {
  const double *mean    = s->coefficient;
  mhb_lanes     most    = lanes_all(-INFINITY);
  double        largest = 0, e[2] = {0}, scale = mu * s->bound[0][0];
  for (int i = 0; i < s->n_grid; i += MHB_LANES) {
    mhb_lanes a = lanes_load(s->value[1] + i) - mean[1], b = lanes_load(s->value[2] + i) - mean[2];
    mhb_lanes r = mu * (lanes_load(s->value[0] + i) + mean[0]), size = a * a + b * b;
    double    top = lanes_top(size);
    most          = lanes_max(most, size - 1.0001 * r * r);
    if (!(top > largest)) continue;
    largest = top;
    for (int l = 0; l < MHB_LANES; l++) {
      if (size[l] != top) continue;
      e[0] = a[l];
      e[1] = b[l];
    }
  }
  if (lanes_top(most) > 0) return 1;
  if (largest == 0) return 0;
  mhb_lanes ahead = lanes_all(-INFINITY), behind = ahead;
  for (int k = 0; k < 2; k++) e[k] /= sqrt(largest);
  for (int i = 0; i < s->n_grid; i += MHB_LANES) {
    mhb_lanes along = (lanes_load(s->value[1] + i) - mean[1]) * e[0] +
                      (lanes_load(s->value[2] + i) - mean[2]) * e[1],
              r = mu * lanes_load(s->value[0] + i);
    ahead       = lanes_max(ahead, along - r);
    behind      = lanes_max(behind, -along - r);
  }
  return lanes_top(ahead) + lanes_top(behind) > 1e-10 * (scale + sqrt(largest));
}

void mhb_static_friction_solve(const mhb_signals *signals, double mu, mhb_static_friction *stuck) {
  *stuck = (mhb_static_friction){0};
  if (inadmissible(signals, mu)) return;
  discs set       = {.signals = signals, .mu = mu};
  set.scale       = signals->bound[1][0] + signals->bound[2][0] + DBL_MIN;
  disc active[3]  = {{{0}, 0, 0}};
  int  n_active   = 0;
  stuck->feasible = solve_known(&set, stuck, active, &n_active);
  for (int i = 0; i < 12 && stuck->feasible; i++) {
    if (!add_violated(&set, stuck->c)) break;
    stuck->feasible = solve_known(&set, stuck, active, &n_active);
  }
  stuck->n_active = n_active;
  for (int i = 0; i < n_active; i++) stuck->time[i] = active[i].t;
  int merge = n_active == 2 && fabs(remainder(active[0].t - active[1].t, SHB_TWO_PI)) < 1e-4;
  if (merge) stuck->n_active = 1; /* two cuts at one summit */
  if (stuck->feasible && stuck->n_active == 1) sharpen(&set, stuck);
}

/* One active disc, c = -e (|f| - r) with e = f/|f| at the time of the largest |f| - r, which moves
 * by dt:
 *   g = e.f' - mu n' = 0,   g' dt = -(e.df' - mu dn' + (q.df)(q.f')/|f|),
 *   g' = e.f'' - mu n'' + (q.f')^2/|f| < 0,
 *   dc = -e (e.df - mu dn) - q (1 - r/|f|) (q.df + q.f' dt). */
static void one_disc(const discs *set, double t, double weight[2][2][6]) {
  summit s  = summit_at(set, t);
  double mu = set->mu, q[2] = {-s.e[1], s.e[0]}, left = 1 - s.r / s.size;
  double late = s.bending < 0 ? left * s.across / s.bending : 0; /* of -q dt */
  for (int k = 0; k < 2; k++) {
    double aside = q[k] * (late * s.across / s.size - left), *w = weight[k][0];
    w[0] = mu * s.e[k];
    w[3] = -mu * q[k] * late;
    for (int i = 0; i < 2; i++) {
      w[1 + i] = -s.e[k] * s.e[i] + aside * q[i];
      w[4 + i] = q[k] * late * s.e[i];
    }
  }
}

/* Two active discs: (c + f_i).dc = r_i dr_i - (c + f_i).df_i. The times have no influence, for each
 * constraint is stationary at its own. */
static void two_discs(const discs *set, const mhb_static_friction *stuck, double weight[2][2][6]) {
  double row[2][2], limit[2], v[3], dv[3];
  for (int i = 0; i < 2; i++) {
    mhb_signals_at(set->signals, stuck->time[i], v, dv, NULL);
    disc d = disc_of(set, stuck->time[i], v);
    for (int k = 0; k < 2; k++) row[i][k] = stuck->c[k] + d.f[k];
    limit[i] = d.r * set->mu;
  }
  double det   = row[0][0] * row[1][1] - row[0][1] * row[1][0];
  double small = 1e-7 * (length_of(row[0][0], row[0][1]) * length_of(row[1][0], row[1][1]));
  if (fabs(det) < small) det = copysign(small, det); /* tangent discs: the derivative is capped */
  double inverse[2][2] = {{row[1][1] / det, -row[0][1] / det}, {-row[1][0] / det, row[0][0] / det}};
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++) {
      double *w = weight[k][i];
      w[0]      = inverse[k][i] * limit[i];
      w[1]      = -inverse[k][i] * row[i][0];
      w[2]      = -inverse[k][i] * row[i][1];
    }
}

void mhb_static_friction_gradient(const mhb_signals *signals, double mu,
                                  const mhb_static_friction *stuck, double weight[2][2][6]) {
  discs set = {.signals = signals, .mu = mu};
  memset(weight, 0, sizeof(double) * 24);
  if (stuck->n_active == 1) one_disc(&set, stuck->time[0], weight);
  if (stuck->n_active == 2) two_discs(&set, stuck, weight);
}
