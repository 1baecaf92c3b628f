#include "mhb/integration/contact_step.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/lu.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, SAMPLES = 8, ITERATIONS = 20 };

mhb_law mhb_contact_step_law(const mhb_law *law) {
  mhb_law out = *law;
  if (!(law->mu > 0)) out.mu = out.ku[0] = out.ku[1] = out.ku[2] = 0;
  return out;
}

/* Ku s */
static void times_ku(const mhb_law *law, const double *s, double x[2]) {
  x[0] = law->ku[0] * s[0] + law->ku[1] * s[1];
  x[1] = law->ku[1] * s[0] + law->ku[2] * s[1];
}

/* u = y - S p */
static void set_motion(const double *matrix, const double *y, mhb_contact_step *step) {
  for (int i = 0; i < F; i++) {
    double sum = y[i];
    for (int k = 0; k < F; k++) sum -= matrix[i * F + k] * step->p[k];
    step->u[i] = sum;
  }
}

/* ---- stick: (I + K S) p = K y + offset ---- */

static void factor_stick(const mhb_law *law, const double *matrix, mhb_stuck_factor *stuck) {
  for (int i = 0; i < S; i++)
    for (int k = 0; k < F; k++) {
      double column[3];
      for (int c = 0; c < 3; c++) column[c] = matrix[(3 * i + c) * F + k];
      double *row = stuck->matrix + 3 * i * F + k, x[2];
      times_ku(law, column + 1, x);
      row[0]     = law->kv * column[0];
      row[F]     = x[0];
      row[2 * F] = x[1];
    }
  for (int i = 0; i < F; i++) stuck->matrix[i * F + i] += 1;
  mhb_factor_real(F, stuck->matrix, stuck->pivot);
}

static void solve_stick(const mhb_law *law, const mhb_contact_point *point, const double *matrix,
                        mhb_stuck_factor *stuck, const double *y, mhb_contact_step *step) {
  if (stuck->pivot[0] < 0) factor_stick(law, matrix, stuck);
  for (int i = 0; i < S; i++) {
    const double *at = y + 3 * i;
    double        x[2];
    times_ku(law, at + 1, x);
    step->p[3 * i]     = law->kv * at[0] + law->n0 - law->mean_offset;
    step->p[3 * i + 1] = x[0] - point->zeta[0];
    step->p[3 * i + 2] = x[1] - point->zeta[1];
  }
  mhb_solve_real(F, stuck->matrix, stuck->pivot, step->p);
  set_motion(matrix, y, step);
}

/* ---- slip: Newton's method for n_i, theta_i, kappa_i ---- */

typedef struct {
  double e[S][2], Ke[S][2], Kq[S][2];
} slip_directions;

/* Directions of slip at the stages, and the forces p by n and theta. */
static void set_forces(const mhb_law *law, mhb_contact_step *step, slip_directions *d) {
  for (int i = 0; i < S; i++) {
    double c = cos(step->theta[i]), s = sin(step->theta[i]), q[2] = {-s, c};
    d->e[i][0] = c;
    d->e[i][1] = s;
    times_ku(law, d->e[i], d->Ke[i]);
    times_ku(law, q, d->Kq[i]);
    step->p[3 * i]     = step->n[i] - law->mean_offset;
    step->p[3 * i + 1] = law->mu * step->n[i] * c;
    step->p[3 * i + 2] = law->mu * step->n[i] * s;
  }
}

/* r[9] of the slip equations. Returns its largest element less the rounding it may contain. */
static double slip_residual(const mhb_radau *rule, const mhb_law *law,
                            const mhb_contact_point *point, const mhb_contact_step *step,
                            const slip_directions *d, double r[F]) {
  double worst = 0;
  for (int i = 0; i < S; i++) {
    const double *u = step->u + 3 * i;
    double        x[2], sum[2];
    times_ku(law, u + 1, x);
    r[3 * i] = step->n[i] - law->n0 - law->kv * u[0];
    for (int c = 0; c < 2; c++) {
      sum[c] = step->p[3 * i + 1 + c] - x[c] + point->zeta[c];
      for (int j = 0; j < S; j++) sum[c] += rule->A[i][j] * step->kappa[j] * d->Ke[j][c];
      r[3 * i + 1 + c] = sum[c];
    }
    double rounding = 4e-16 * (fabs(law->kv * u[0]) + fabs(x[0]) + fabs(x[1]));
    for (int c = 0; c < 3; c++) worst = fmax(worst, fabs(r[3 * i + c]) - rounding);
  }
  return worst;
}

static void slip_jacobian(const mhb_radau *rule, const mhb_law *law, const double *matrix,
                          const mhb_contact_step *step, const slip_directions *d, double J[F * F]) {
  for (int j = 0; j < S; j++) {
    double c = d->e[j][0], s = d->e[j][1], mn = law->mu * step->n[j];
    double by_n[3] = {1, law->mu * c, law->mu * s}, by_theta[3] = {0, -mn * s, mn * c};
    for (int i = 0; i < S; i++) {
      double sn[3], st[3], x[2], *row = J + 3 * i * F + 3 * j;
      for (int k = 0; k < 3; k++) {
        const double *m = matrix + (3 * i + k) * F + 3 * j;
        sn[k]           = m[0] + m[1] * by_n[1] + m[2] * by_n[2];
        st[k]           = m[1] * by_theta[1] + m[2] * by_theta[2];
      }
      double a = rule->A[i][j];
      row[0]   = law->kv * sn[0] + (i == j);
      row[1]   = law->kv * st[0];
      row[2]   = 0;
      times_ku(law, sn + 1, x);
      for (int k = 0; k < 2; k++) {
        row[(k + 1) * F]     = x[k] + (i == j ? by_n[k + 1] : 0);
        row[(k + 1) * F + 2] = a * d->Ke[j][k];
      }
      times_ku(law, st + 1, x);
      for (int k = 0; k < 2; k++)
        row[(k + 1) * F + 1] =
            x[k] + (i == j ? by_theta[k + 1] : 0) + a * step->kappa[j] * d->Kq[j][k];
    }
  }
}

/* n, theta, kappa -= r, no angle by more than 1 rad. Returns 0 if r is not finite. */
static int slip_update(const double r[F], mhb_contact_step *step) {
  double largest = 0;
  for (int i = 0; i < F; i++)
    if (!isfinite(r[i])) return 0;
  for (int i = 0; i < S; i++) largest = fmax(largest, fabs(r[3 * i + 1]));
  double part = largest > 1 ? 1 / largest : 1;
  for (int i = 0; i < S; i++) {
    step->n[i] -= part * r[3 * i];
    step->theta[i] -= part * r[3 * i + 1];
    step->kappa[i] -= part * r[3 * i + 2];
  }
  return 1;
}

/* Guess at an onset of slip: normal load and slider path for a friction of constant direction. */
static void begin_slip(const mhb_radau *rule, const mhb_law *law, const mhb_contact_point *point,
                       const double *matrix, const double *y, double scale,
                       mhb_contact_step *step) {
  slip_directions d;
  double          rest[S];
  for (int round = 0; round < 3; round++) {
    set_forces(law, step, &d);
    set_motion(matrix, y, step);
    for (int i = 0; i < S && round < 2; i++)
      step->n[i] = fmax(law->n0 + law->kv * step->u[3 * i], 1e-9 * scale);
  }
  for (int i = 0; i < S; i++) {
    double x[2];
    times_ku(law, step->u + 3 * i + 1, x);
    rest[i] = -law->mu * step->n[i];
    for (int c = 0; c < 2; c++) rest[i] += d.e[i][c] * (x[c] - point->zeta[c]);
  }
  for (int i = 0; i < S; i++) {
    double sum = 0, eKe = d.e[i][0] * d.Ke[i][0] + d.e[i][1] * d.Ke[i][1];
    for (int j = 0; j < S; j++) sum += rule->inverse[i][j] * rest[j];
    step->kappa[i] = sum / eKe;
  }
}

/* Newton's method. Returns 0 if it does not converge. */
static int solve_slip(const mhb_radau *rule, const mhb_law *law, const mhb_contact_point *point,
                      const double *matrix, const double *y, double scale, mhb_contact_step *step) {
  slip_directions d;
  double          r[F], J[F * F], last = INFINITY;
  int             pivot[F];
  if (point->lambda == 0) begin_slip(rule, law, point, matrix, y, scale, step);
  for (int k = 0; k < ITERATIONS; k++) {
    set_forces(law, step, &d);
    set_motion(matrix, y, step);
    double size = slip_residual(rule, law, point, step, &d, r);
    if (size <= 1e-13 * scale || (size <= 1e-11 * scale && size > 0.1 * last)) return 1;
    last = size;
    slip_jacobian(rule, law, matrix, step, &d, J);
    if (!mhb_factor_real(F, J, pivot)) return 0;
    mhb_solve_real(F, J, pivot, r);
    if (!slip_update(r, step)) return 0;
  }
  return 0;
}

/* ---- a step ---- */

void mhb_contact_step_guess(const mhb_law *law, const mhb_contact_point *point, double h,
                            mhb_contact_step *step) {
  for (int i = 0; i < S; i++) {
    memcpy(step->p + 3 * i, point->p, sizeof point->p);
    memcpy(step->u + 3 * i, point->u, sizeof point->u);
    step->n[i]     = point->p[0] + law->mean_offset;
    step->theta[i] = point->theta;
    step->kappa[i] = point->lambda * h;
  }
}

int mhb_contact_step_solve(const mhb_radau *rule, const mhb_law *law,
                           const mhb_contact_point *point, const double *S_,
                           mhb_stuck_factor *stuck, const double *y, double scale,
                           mhb_contact_step *step) {
  switch (point->state) {
    case MHB_STICK:
      solve_stick(law, point, S_, stuck, y, step);
      return 1;
    case MHB_SLIDE:
      return solve_slip(rule, law, point, S_, y, scale, step);
    default:
      memset(step->p, 0, sizeof step->p);
      for (int i = 0; i < S; i++) step->p[3 * i] = -law->mean_offset;
      set_motion(S_, y, step);
      return 1;
  }
}

/* ---- events ---- */

/* Value at tau of the cubic through the start and the stages. */
static double cubic(const mhb_radau *rule, double start, const double *stage, int stride,
                    double tau) {
  double value = 0;
  for (int k = S; k >= 0; k--) {
    double c = rule->dense[k][0] * start;
    for (int i = 0; i < S; i++) c += rule->dense[k][i + 1] * stage[i * stride];
    value = value * tau + c;
  }
  return value;
}

/* Speed of the slider times h, at tau. */
static double slider_speed(const mhb_radau *rule, const double kappa[S], double tau) {
  double value = 0, weight = 1;
  for (int m = 0; m < S; m++) {
    for (int j = 0; j < S; j++) value += rule->basis[j][m] * kappa[j] * weight;
    weight *= tau / (m + 1);
  }
  return value;
}

double mhb_contact_step_excess(const mhb_radau *rule, const mhb_law *law,
                               const mhb_contact_point *point, const mhb_contact_step *step,
                               mhb_contact_event event, double tau) {
  if (event == MHB_SLIP_TO_STICK)
    return -0.5 * (law->ku[0] + law->ku[2]) * slider_speed(rule, step->kappa, tau);
  double n = law->n0 + law->kv * cubic(rule, point->u[0], step->u, 3, tau);
  if (event == MHB_CONTACT_CLOSES) return n;
  if (event == MHB_CONTACT_OPENS) return -n;
  double fu = cubic(rule, point->p[1], step->p + 1, 3, tau);
  double fw = cubic(rule, point->p[2], step->p + 2, 3, tau);
  return hypot(fu, fw) - law->mu * n;
}

/* Root of the event function between a (negative) and b (positive), by the Illinois method. */
static double root_of(const mhb_radau *rule, const mhb_law *law, const mhb_contact_point *point,
                      const mhb_contact_step *step, mhb_contact_event event, double a, double b) {
  double fa = mhb_contact_step_excess(rule, law, point, step, event, a);
  double fb = mhb_contact_step_excess(rule, law, point, step, event, b);
  if (fa >= 0) return a;
  for (int k = 0, side = 0; k < 60 && b - a > 1e-14; k++) {
    double c = (fb * a - fa * b) / (fb - fa);
    double f = mhb_contact_step_excess(rule, law, point, step, event, c);
    if (f == 0) return c;
    if (f > 0) {
      b  = c;
      fb = f;
      if (side > 0) fa /= 2;
      side = 1;
    } else {
      a  = c;
      fa = f;
      if (side < 0) fb /= 2;
      side = -1;
    }
  }
  return b;
}

/* First place where the event function exceeds the tolerance; 2: none. */
static double first_excess(const mhb_radau *rule, const mhb_law *law,
                           const mhb_contact_point *point, const mhb_contact_step *step,
                           double tolerance, mhb_contact_event event) {
  for (int k = 1; k <= SAMPLES; k++) {
    double tau = (double)k / SAMPLES;
    if (mhb_contact_step_excess(rule, law, point, step, event, tau) > tolerance)
      return root_of(rule, law, point, step, event, (double)(k - 1) / SAMPLES, tau);
  }
  return 2;
}

double mhb_contact_step_first(const mhb_radau *rule, const mhb_law *law,
                              const mhb_contact_point *point, const mhb_contact_step *step,
                              double tolerance, mhb_contact_event *event) {
  if (point->state == MHB_SEPARATE) {
    *event = MHB_CONTACT_CLOSES;
    return first_excess(rule, law, point, step, tolerance, MHB_CONTACT_CLOSES);
  }
  mhb_contact_event other = point->state == MHB_STICK ? MHB_STICK_TO_SLIP : MHB_SLIP_TO_STICK;
  double opens = first_excess(rule, law, point, step, tolerance, MHB_CONTACT_OPENS), ends = 2;
  if (law->mu > 0) ends = first_excess(rule, law, point, step, tolerance, other);
  *event = ends <= opens ? other : MHB_CONTACT_OPENS;
  return ends <= opens ? ends : opens;
}

bool mhb_contact_step_turns(const mhb_contact_point *point, const mhb_contact_step *step,
                            mhb_contact_event event) {
  return event == MHB_CONTACT_OPENS && point->state == MHB_SLIDE &&
         fabs(remainder(step->theta[S - 1] - point->theta, SHB_PI)) > 1e-9;
}

/* ---- between steps ---- */

void mhb_contact_step_advance(const mhb_law *law, const mhb_contact_step *step, double h,
                              mhb_contact_point *point) {
  const int end = 3 * (S - 1);
  memcpy(point->u, step->u + end, sizeof point->u);
  memcpy(point->p, step->p + end, sizeof point->p);
  if (point->state != MHB_SLIDE) return;
  double x[2];
  times_ku(law, point->u + 1, x);
  for (int c = 0; c < 2; c++) point->zeta[c] = x[c] - point->p[1 + c];
  point->theta  = remainder(step->theta[S - 1], SHB_TWO_PI);
  point->lambda = step->kappa[S - 1] / h;
}

void mhb_contact_step_change(const mhb_law *law, mhb_state state, double direction,
                             mhb_contact_point *point) {
  double x[2];
  times_ku(law, point->u + 1, x);
  if (state == MHB_SEPARATE || point->state == MHB_SEPARATE) {
    point->p[0] = -law->mean_offset;
    point->p[1] = point->p[2] = 0;
  }
  for (int c = 0; c < 2; c++) point->zeta[c] = x[c] - point->p[1 + c];
  if (state == MHB_SLIDE) {
    point->lambda = 0;
    point->theta  = direction;
  }
  point->state = state;
}

void mhb_contact_step_after(const mhb_law *law, mhb_contact_event event, mhb_contact_point *point) {
  if (event == MHB_CONTACT_OPENS) mhb_contact_step_change(law, MHB_SEPARATE, 0, point);
  if (event == MHB_STICK_TO_SLIP)
    mhb_contact_step_change(law, MHB_SLIDE, atan2(point->p[2], point->p[1]), point);
  if (event == MHB_SLIP_TO_STICK) mhb_contact_step_change(law, MHB_STICK, 0, point);
}

double mhb_contact_step_closing(const mhb_radau *rule, const mhb_law *law,
                                const mhb_contact_point *point, const mhb_contact_step *step,
                                double *direction) {
  double rate[3]; /* of the cubic at 0 */
  for (int c = 0; c < 3; c++) {
    rate[c] = rule->dense[1][0] * point->p[c];
    for (int i = 0; i < S; i++) rate[c] += rule->dense[1][i + 1] * step->p[3 * i + c];
  }
  *direction = atan2(rate[2], rate[1]);
  return hypot(rate[1], rate[2]) - law->mu * rate[0];
}
