#include "mhb/contact/slider.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/contact/force_integrals.h"
#include "mhb/contact/sensitivity.h"

/* The state of the slider at phase t. */
typedef struct {
  mhb_state state;
  double    t, z[2], theta;
  double    onset; /* phase at which stick turned to slip; z is that of the stick before */
} slider;

/* Forces are in units of the largest in sight: squares neither overflow nor vanish. */
static double length_of(double a, double b) {
  return sqrt(a * a + b * b);
}

/* ---- pieces ---- */

static void add_stick(mhb_contact_evaluator *c, double t0, double t1, const double z[2]) {
  if (!c->record || t1 <= t0) return;
  mhb_dense_output_stick(&c->dense_output, t0, z);
  int sums = mhb_real_size(c->H + c->m);
  memset(c->basis_integrals, 0, sizeof(double) * (size_t)sums);
  mhb_basis_integral(c->H + (c->mode == MHB_ALL_COLUMNS ? c->m : c->signals.top), t0, t1,
                     c->basis_integrals);
  for (int i = 0; i < sums; i++) c->stick_integrals[i] += c->basis_integrals[i];
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < c->nf; i++) c->f[k * c->nf + i] -= z[k] * c->basis_integrals[i];
  mhb_sensitivity_stick(c);
  c->info->share[MHB_STICK] += (t1 - t0) / SHB_TWO_PI;
}

/* Energy of the tangential spring, f K^-1 f/2. */
static double spring_energy(const mhb_contact_evaluator *c, const double f[2]) {
  double det = c->K[0][0] * c->K[1][1] - c->K[0][1] * c->K[0][1];
  return .5 * (c->K[1][1] * f[0] * f[0] - 2 * c->K[0][1] * f[0] * f[1] + c->K[0][0] * f[1] * f[1]) /
         det;
}

/* The same for a contact that sticks. */
static double stored_energy(const mhb_contact_evaluator *c, const slider *s) {
  double y[3], dy[3];
  mhb_signals_at(&c->signals, s->t, y, dy, NULL);
  return spring_energy(c, (double[2]){y[1] - s->z[0], y[2] - s->z[1]});
}

/* Work of slip over the panel, in units of force scale times m. The power is lambda |f|^2 = gamma
 * mu n/eKe.
 *
 * The direction is held in the last stretch before an opening. The work there is that of the
 * motion, the integral of f.s', plus the spring's energy f K^-1 f/2 at its start. At its end f = 0.
 * If the contact has stuck until then, f is x - z, for mu n may be all rounding. */
static double panel_work(const mhb_contact_evaluator *c, const slider *s) {
  const mhb_panel *p      = &c->panel;
  mhb_lanes        weight = p->h * c->slip.mu * c->rule.weight * p->y[0];
  if (!p->frozen) return lanes_sum(weight * lanes_max(p->gamma, lanes_all(0)) / p->eKe);
  double y[3], dy[3], det = c->K[0][0] * c->K[1][1] - c->K[0][1] * c->K[0][1];
  mhb_signals_at(&c->signals, p->t0, y, dy, NULL);
  double    limit = c->slip.mu * y[0], f[2] = {limit * p->e[0][0], limit * p->e[1][0]};
  double    x[2]    = {y[1] - s->z[0], y[2] - s->z[1]};
  mhb_lanes rate[2] = {(c->K[1][1] * p->dy[1] - c->K[0][1] * p->dy[2]) / det,
                       (c->K[0][0] * p->dy[2] - c->K[0][1] * p->dy[1]) / det};
  return spring_energy(c, p->t0 == s->onset ? x : f) +
         lanes_sum(weight * (p->e[0] * rate[0] + p->e[1] * rate[1]));
}

static void add_slip(mhb_contact_evaluator *c, const slider *s) {
  const mhb_panel *p = &c->panel;
  if (p->h <= 0) return;
  mhb_sensitivity_panel(c);
  if (!c->record) return;
  mhb_dense_output_slip(&c->dense_output, p);
  c->info->slip_work += panel_work(c, s);
  c->info->share[MHB_SLIDE] += p->h / SHB_TWO_PI;
  c->squared_error += p->error * p->error;
}

enum { MAX_EVENTS = 400, MAX_PANELS = 5000 };

/* Stick until the friction limit is reached or the interval ends. */
static void run_stick(mhb_contact_evaluator *c, slider *s, double end) {
  double y[3], onset = mhb_slip_onset(&c->signals, c->slip.mu, s->z, s->t, end, y);
  int    slips = onset <= end;
  double until = slips ? onset : end;
  add_stick(c, s->t, until, s->z);
  s->t = until;
  if (!slips) return;
  s->theta = atan2(y[2] - s->z[1], y[1] - s->z[0]);
  s->state = MHB_SLIDE;
  s->onset = until;
  mhb_note_transition(c, until, MHB_SLIDE);
  mhb_sensitivity_stick_to_slip(c, until, s->theta, y[0]);
}

/* Slip until its rate is zero or the interval ends. 0: a panel was lost. */
static int run_slip(mhb_contact_evaluator *c, slider *s, double end, int opening) {
  double           suggested = c->slip.longest_panel;
  mhb_slip_outcome outcome   = MHB_SLIP_CONTINUES;
  for (int panels = 0; outcome == MHB_SLIP_CONTINUES; panels++) {
    if (panels == MAX_PANELS) return 0;
    outcome = mhb_slip_panel(&c->slip, s->t, s->theta, end, opening, &suggested, &c->panel);
    if (outcome == MHB_SLIP_FAILED) return 0;
    add_slip(c, s);
    s->t     = c->panel.t0 + c->panel.h;
    s->theta = c->panel.theta1;
  }
  if (outcome == MHB_SLIP_INTERVAL_ENDS) {
    s->t = end;
    return 1;
  }
  const double *y = c->panel.end, *e = c->panel.end_e, limit = c->slip.mu * y[0];
  s->z[0]  = y[1] - limit * e[0];
  s->z[1]  = y[2] - limit * e[1];
  s->state = MHB_STICK;
  mhb_note_transition(c, s->t, MHB_STICK);
  mhb_sensitivity_slip_to_stick(c, s->t, s->theta, y[0]);
  return 1;
}

static int run_closed(mhb_contact_evaluator *c, slider *s, double end, int opening) {
  c->panel.error = INFINITY; /* no panel before */
  for (int events = 0; s->t < end; events++) {
    if (events > MAX_EVENTS) return 0;
    if (s->state == MHB_STICK) {
      run_stick(c, s, end);
    } else if (!run_slip(c, s, end, opening)) {
      return 0;
    }
  }
  return 1;
}

/* Length and accuracy of the panels. A lap that is resolved as a recorded one has the highest
 * harmonic too: panel_error in slip.c. */
static void set_panels_of(mhb_contact_evaluator *c, double tolerance, int resolved) {
  double reach          = sqrt(sqrt(sqrt(sqrt(.2 * tolerance / 1.7e-23))));
  double wanted         = resolved ? c->H : 0;
  c->slip.top_harmonic  = wanted + .5 * c->mean_harmonic;
  c->slip.longest_panel = mhb_least(1.5, reach / (wanted + 2 * c->mean_harmonic + 1));
  c->slip.tolerance     = .2 * tolerance * c->force_level;
  c->slip.mild          = 4 * sqrt(sqrt(sqrt(400 * tolerance)));
  c->slip.newton_mild   = mhb_most(3, mhb_least(8, 3 * sqrt(sqrt(sqrt(3e7 * c->slip.tolerance)))));
}

static void set_panels(mhb_contact_evaluator *c, double tolerance) {
  set_panels_of(c, tolerance, c->record);
}

/* theta may be held over tau before an opening: the error in force is about mu |n'| tau^2/2. */
static void set_frozen_length(mhb_contact_evaluator *c, double opening) {
  double y[3], dy[3];
  mhb_signals_at(&c->signals, opening, y, dy, NULL);
  c->slip.frozen_length =
      mhb_least(.05, mhb_most(1e-10, sqrt(c->slip.tolerance / (c->slip.mu * fabs(dy[0])))));
}

/* ---- the contact opens: every closing is a fresh start (eqs. 13-15) ---- */

int mhb_slider_with_openings(mhb_contact_evaluator *c) {
  int    ok   = 1;
  double open = 1;
  mhb_sensitivity_clear(c);
  c->record      = 1;
  c->lap.slipped = 1; /* no slider is carried over from the start */
  set_panels(c, c->tolerance);
  for (int i = 0; i < c->intervals.n; i++) {
    slider s = {.t = c->intervals.closing[i], .onset = -1};
    double y[3], dy[3], d[2];
    mhb_signals_at(&c->signals, s.t, y, dy, NULL);
    double pull = length_of(dy[1], dy[2]), limit = c->slip.mu * dy[0];
    s.z[0]  = y[1];
    s.z[1]  = y[2];
    s.state = pull < limit ? MHB_STICK : MHB_SLIDE;
    if (s.state == MHB_SLIDE) {
      mhb_slip_return(c->K, limit, dy + 1, d);
      s.theta = atan2(d[1], d[0]);
    }
    mhb_sensitivity_closing(c, s.t, s.state, s.theta);
    mhb_note_transition(c, s.t, s.state);
    set_frozen_length(c, c->intervals.opening[i]);
    ok &= run_closed(c, &s, c->intervals.opening[i], 1);
    if (s.state == MHB_STICK || s.onset == s.t)
      c->info->slip_work +=
          stored_energy(c, &s); /* its slip before the opening is too short to resolve */
    mhb_note_transition(c, c->intervals.opening[i], MHB_SEPARATE);
    mhb_dense_output_open(&c->dense_output, c->intervals.opening[i]);
    open -= (c->intervals.opening[i] - c->intervals.closing[i]) / SHB_TWO_PI;
  }
  c->info->share[MHB_SEPARATE] = mhb_most(open, 0);
  return ok;
}

/* ---- always closed and slipping: the periodic slider ---- */

enum { MAX_LAPS = 100, MAX_RECORDS = 5 };

/* Error of the slider of the contact that sticks, in units of the friction. */
static const double FAR = .03;

static void signals_on_grid(const mhb_signals *signals, int i, double y[3], double dy[3]) {
  for (int k = 0; k < 3; k++) {
    y[k]  = signals->value[k][i];
    dy[k] = signals->slope[k][i];
  }
}

/* From slider z0 at a point of the grid to the end of the lap: P(z0) and, in the columns, its
 * derivative. 0: a panel failed. */
static int run_from(mhb_contact_evaluator *c, int start, const double z0[2], double P[2]) {
  double t0 = SHB_TWO_PI * start / c->signals.n_grid, y[3], dy[3];
  slider s  = {.state = MHB_STICK, .t = t0, .z = {z0[0], z0[1]}, .onset = -1};
  signals_on_grid(&c->signals, start, y, dy);
  double f[2] = {y[1] - z0[0], y[2] - z0[1]}, limit = c->slip.mu * y[0],
         size = length_of(f[0], f[1]);
  mhb_sensitivity_clear(c);
  if (size >= limit * (1 - 1e-9)) { /* begins on the friction circle: project, slip if gamma > 0 */
    double d[2], over[2] = {f[0] / limit, f[1] / limit};
    mhb_slip_return(c->K, 1, over, d);
    s.theta            = atan2(d[1], d[0]);
    mhb_direction at   = mhb_slip_direction(c->K, s.theta);
    int           pull = mhb_slip_gamma(&c->slip, &at, dy) > 0;
    if (pull || size > limit) mhb_sensitivity_stick_to_slip(c, t0, s.theta, y[0]);
    if (!pull && size > limit) mhb_sensitivity_slip_to_stick(c, t0, s.theta, y[0]);
    if (pull) s.state = MHB_SLIDE;
    if (!pull && size > limit)
      for (int k = 0; k < 2; k++) s.z[k] = y[1 + k] - limit * d[k];
  }
  mhb_state began = s.state;
  int       ok    = run_closed(c, &s, SHB_TWO_PI, 0);
  if (s.state != began) mhb_note_transition(c, 0, began);
  if (s.state == MHB_SLIDE) {
    signals_on_grid(&c->signals, 0, y, dy);
    limit = c->slip.mu * y[0];
    P[0]  = y[1] - limit * cos(s.theta);
    P[1]  = y[2] - limit * sin(s.theta);
    mhb_sensitivity_slip_to_stick(c, 0, s.theta, y[0]);
  } else {
    P[0] = s.z[0];
    P[1] = s.z[1];
  }
  return ok;
}

static int run_lap(mhb_contact_evaluator *c, const double z0[2], double P[2]) {
  return run_from(c, 0, z0, P);
}

/* Point of the grid where the force of a slider that rests at z is furthest beyond the friction
 * limit. The second half of the period has precedence if the force is half as far beyond there. */
MHB_HOT static int furthest_beyond(const mhb_signals *s, double mu, const double z[2]) {
  double most[2] = {-INFINITY, -INFINITY};
  int    at[2]   = {0, 0};
  for (int i = 0; i < s->n_grid; i += MHB_LANES) {
    mhb_lanes n = lanes_load(s->value[0] + i), a = lanes_load(s->value[1] + i) - z[0],
              b = lanes_load(s->value[2] + i) - z[1], over = a * a + b * b - mu * mu * n * n;
    double top  = lanes_top(over);
    int    half = 2 * i >= s->n_grid;
    if (!(top > most[half])) continue;
    most[half] = top;
    for (int l = 0; l < MHB_LANES; l++)
      if (over[l] == top) at[half] = i + l;
  }
  return at[most[1] > .5 * most[0]];
}

/* Progress of Newton's method on the periodic slider; lengths in units of the friction. */
typedef struct {
  double tolerance; /* accepted error after a step */
  double last_step; /* infinite before the first */
  double left;      /* expected error of z */
  int    linear;    /* convergence is linear: the error is of the size of the step */
  int    resolved;  /* laps have the panels of the recorded one */
} newton_progress;

/* Error after a step. Quadratic convergence: the step squared, times the contraction of the lap,
 * and no less than 1e-4 of the lap's accuracy. Linear convergence: the step times the ratio of
 * steps. */
static double remaining_error(const mhb_contact_evaluator *c, newton_progress *a, double length,
                              double accuracy) {
  double ratio = length / a->last_step;
  a->linear    = ratio > .1 && a->last_step < 1;
  a->last_step = length;
  if (a->linear) return length * mhb_least(1, ratio);
  return mhb_most(mhb_least(length * length, 4) * mhb_least(1, mhb_sensitivity_contraction(c)),
                  1e-4 * accuracy);
}

/* Newton's method on P(z) = z. 0: not reached. A plain iteration z <- P(z), which never expands,
 * replaces it where it does not gain. At a double root, where slip just begins, the step is
 * extrapolated. Each lap is as accurate as its step requires. After a recorded lap that Newton's
 * method had led to and that did not close, laps have its panels. Longer ones miss a reversal of
 * small harmonics, and close elsewhere. */
static int iterate_slider(mhb_contact_evaluator *c, newton_progress *a, double z[2]) {
  double before = INFINITY, left = a->last_step < 1 ? a->last_step : a->left, P[2], step[2];
  int    plain = 0, newton = 0;
  c->record = 0;
  c->mode   = MHB_SLIDER_COLUMN;
  for (; c->info->laps < MAX_LAPS; c->info->laps++) {
    double accuracy =
        a->resolved ? c->tolerance : mhb_most(a->tolerance, mhb_least(1e-2, .3 * left));
    set_panels_of(c, accuracy, a->resolved);
    if (!run_lap(c, z, P)) return 0;
    double r[2] = {P[0] - z[0], P[1] - z[1]}, size = length_of(r[0], r[1]);
    if (newton && size > .9 * before) plain = 2;
    before = size;
    newton = !plain;
    if (plain) {
      plain--;
      z[0] = P[0];
      z[1] = P[1];
      continue;
    }
    mhb_sensitivity_close(c, r, step);
    double length = length_of(step[0], step[1]) / c->friction_level, ratio = length / a->last_step;
    double stretch = ratio > .3 && ratio < .7 ? 1 / (1 - ratio) : 1;
    double beyond  = length_of(step[0] - r[0], step[1] - r[1]) / c->friction_level;
    double cut     = beyond > 1 ? 1 / beyond : 1; /* shortens the difference to a plain iteration */
    for (int k = 0; k < 2; k++) z[k] += stretch * (r[k] + cut * (step[k] - r[k]));
    left = remaining_error(c, a, length, accuracy);
    if (left < (a->linear ? .1 * c->tolerance : a->tolerance)) {
      c->info->laps++;
      return 1;
    }
  }
  return 0;
}

/* Carries z from where the contact surely slips to the end of the period: slip forgets. Returns the
 * error expected of it then, in units of the friction. */
static double approach(mhb_contact_evaluator *c, double z[2]) {
  double P[2], accuracy = .3 * FAR;
  c->record = 0;
  c->mode   = MHB_SLIDER_COLUMN;
  set_panels(c, accuracy);
  if (!run_from(c, furthest_beyond(&c->signals, c->slip.mu, z), z, P)) return FAR;
  z[0] = P[0];
  z[1] = P[1];
  return mhb_most(FAR * mhb_least(1, mhb_sensitivity_contraction(c)), 1e-4 * accuracy);
}

/* The lap that records the force, from z. The last Newton step is applied to the force, not by
 * another lap: f += (df/dz) dz, dz = (I - DP)^-1 (P(z) - z).
 *
 * Returns the change of the force by that step, in units of the friction; negative: a panel failed.
 * gap: |P(z) - z|; step: |dz|, in the same units. */
static double record_lap(mhb_contact_evaluator *c, mhb_sensitivity_mode columns, double z[2],
                         double *gap, double *step) {
  double P[2], dz[2], most = 0;
  c->record = 1;
  c->mode   = columns;
  mhb_force_integrals_clear(c);
  set_panels(c, c->tolerance);
  int ok = run_lap(c, z, P);
  mhb_sensitivity_close(c, (double[2]){P[0] - z[0], P[1] - z[1]}, dz);
  mhb_force_integrals_collect(c);
  *gap         = length_of(P[0] - z[0], P[1] - z[1]) / c->friction_level;
  *step        = length_of(dz[0], dz[1]) / c->friction_level;
  double along = c->lap.v[0] * dz[0] + c->lap.v[1] * dz[1], work = c->lap.work * along;
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < c->nf; i++) {
      double change = c->f_slider[k * c->nf + i] * along - c->first_stick[i] * dz[k];
      c->f[k * c->nf + i] += change;
      most = mhb_most(most, fabs(change));
    }
    z[k] += dz[k];
    work += c->lap.onset[k] * dz[k];
  }
  if (fabs(work) <= c->info->slip_work)
    c->info->slip_work += work; /* else the first order does not hold */
  return ok ? 2 / SHB_TWO_PI * most / c->friction_level : -1;
}

int mhb_slider_periodic(mhb_contact_evaluator *c, int near, double z[2]) {
  mhb_sensitivity_mode wanted = c->mode == MHB_ALL_COLUMNS ? MHB_ALL_COLUMNS : MHB_SLIDER_COLUMN;
  double               left = 0, gap = 0, step = 0, sharp = .1 * c->tolerance;
  newton_progress a = {.tolerance = wanted == MHB_ALL_COLUMNS ? sharp : .1 * sqrt(c->tolerance),
                       .last_step = INFINITY,
                       .left      = near ? 0 : FAR};
  int             reached = 0, close = 0;
  /* it seldom serves the force alone to a small tolerance: a whole lap of Newton's does */
  if (!near && (wanted == MHB_ALL_COLUMNS || a.tolerance > 1e-4)) a.left = approach(c, z);
  double accept = wanted == MHB_ALL_COLUMNS ? 30 * sharp : 3 * a.tolerance;
  /* The lap that it may end with. What is left of z is the square of its step. A larger one would
   * be seen by a Newton step with derivative, which another one would follow. */
  if (near && wanted == MHB_SLIDER_COLUMN) {
    left    = record_lap(c, wanted, z, &gap, &step);
    a.left  = mhb_least(step * step, FAR);
    reached = close = left >= 0 && left < accept && step * step < 1e-4 * c->tolerance;
  }
  for (int tries = 0; tries < MAX_RECORDS && !close && left >= 0; tries++) {
    reached     = (a.left > 0 && a.left < a.tolerance) || iterate_slider(c, &a, z);
    a.left      = FAR;
    double last = a.last_step;
    left        = record_lap(c, wanted, z, &gap, &step);
    a.last_step = left;
    a.linear    = left > .1 * last;
    close       = left < (a.linear ? 10 * sharp : accept) && step * step < c->tolerance;
    a.tolerance = sharp;
    a.resolved  = 1;
  }
  /* a time history shows the lap itself: it is repeated until it closes */
  for (int tries = 0; c->dense_output.enabled && gap > 1e-12 && tries < MAX_RECORDS; tries++)
    left = record_lap(c, wanted, z, &gap, &step);
  double miss = left < 0               ? SHB_TWO_PI * c->force_level / c->friction_level
                : reached && !a.linear ? mhb_most(left * left, step * step)
                                       : left;
  c->info->error += c->friction_level * (miss + mhb_sensitivity_roundoff(c));
  if (wanted == MHB_ALL_COLUMNS) mhb_sensitivity_eliminate_slider(c);
  return left >= 0 && left < sqrt(c->tolerance);
}
