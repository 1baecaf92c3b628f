#include "mhb/integration/contact_path.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mhb/numerics/lu.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, MAX_TRIALS = 60, MAX_PIECES = 200, MAX_STALLED = 4 };

/* Shares of a step. An event's place is known to ON_EVENT. A piece below NO_PROGRESS is none. Where
 * states alternate without progress, a piece of HUSHED ignores events. Before an opening the
 * direction of slip may turn in pieces below TURNING. */
static const double ON_EVENT = 1e-12, NO_PROGRESS = 1e-10, HUSHED = 1. / 32, TURNING = 1e-3;

/* Relative to the force scale: event function. */
static const double OVERSTEP = 1e-10;

/* ---- the spring ---- */

static void times_stiffness(const mhb_law *law, const double *u, double *x) {
  x[0] = law->kv * u[0];
  x[1] = law->ku[0] * u[1] + law->ku[1] * u[2];
  x[2] = law->ku[1] * u[1] + law->ku[2] * u[2];
}

void mhb_contact_spring_set(const mhb_law *law, const double R[3][3], mhb_contact_spring *spring) {
  *spring = (mhb_contact_spring){.law = *law};
  memcpy(spring->R, R, sizeof spring->R);
  double matrix[3][3], x[3];
  int    pivot[3];
  for (int k = 0; k < 3; k++) {
    const double column[3] = {R[0][k], R[1][k], R[2][k]};
    times_stiffness(law, column, x);
    for (int i = 0; i < 3; i++) matrix[i][k] = x[i] + (i == k);
  }
  mhb_factor_real(3, *matrix, pivot);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++) x[i] = i == k;
    mhb_solve_real(3, *matrix, pivot, x);
    for (int i = 0; i < 3; i++) spring->stuck[i][k] = x[i];
  }
  for (int i = 0; i < F; i++)
    for (int k = 0; k < 3; k++) spring->square[i * F + i / 3 * 3 + k] = R[i % 3][k];
}

/* ---- one piece ---- */

/* A contact on its way through a step. */
typedef struct {
  const mhb_radau          *rule;
  const mhb_contact_spring *spring;
  double                    cubic[S + 1][3]; /* powers of tau of w */
  double                    h, scale;
  mhb_contact_point         at; /* at tau */
  double                    tau;
  mhb_contact_step          piece;
  double                    length;     /* of the piece, in tau */
  mhb_contact_event         kind;       /* of the event it ends with */
  bool                      ends, deaf; /* it ends with an event; it ignores events */
} march;

static void motion_at(const march *o, double tau, double *w) {
  for (int c = 0; c < 3; c++)
    w[c] = o->cubic[0][c] + tau * (o->cubic[1][c] + tau * (o->cubic[2][c] + tau * o->cubic[3][c]));
}

/* p and u of a state that is linear in the motion: stuck or open. */
static void solve_linear(march *o, const double *w) {
  const mhb_contact_spring *k     = o->spring;
  bool                      stuck = o->at.state == MHB_STICK;
  for (int i = 0; i < S; i++) {
    double *p = o->piece.p + 3 * i, *u = o->piece.u + 3 * i, x[3];
    times_stiffness(&k->law, w + 3 * i, x);
    x[0] += k->law.n0 - k->law.mean_offset;
    x[1] -= o->at.zeta[0];
    x[2] -= o->at.zeta[1];
    for (int c = 0; c < 3; c++) {
      p[c] = k->stuck[c][0] * x[0] + k->stuck[c][1] * x[1] + k->stuck[c][2] * x[2];
      if (!stuck) p[c] = c ? 0 : -k->law.mean_offset;
    }
    for (int c = 0; c < 3; c++)
      u[c] = w[3 * i + c] - k->R[c][0] * p[0] - k->R[c][1] * p[1] - k->R[c][2] * p[2];
  }
}

/* The state as it is, over a length. Returns 0 if no forces were found. */
static int solve_piece(march *o, double length) {
  double w[F];
  o->length = length;
  for (int i = 0; i < S; i++) motion_at(o, o->tau + o->rule->c[i] * length, w + 3 * i);
  if (o->at.state != MHB_SLIDE) {
    solve_linear(o, w);
    return 1;
  }
  mhb_contact_step_guess(&o->spring->law, &o->at, length * o->h, &o->piece);
  return mhb_contact_step_solve(o->rule, &o->spring->law, &o->at, o->spring->square, NULL, w,
                                o->scale, &o->piece);
}

static double excess(const march *o, double tau) {
  return mhb_contact_step_excess(o->rule, &o->spring->law, &o->at, &o->piece, o->kind, tau);
}

/* Relative change of the length that moves its end to the event. */
static double correction(const march *o) {
  double at = excess(o, 1), slope = (at - excess(o, 0.99)) / 0.01;
  return slope > 0 ? fmin(fmax(-at / slope, -0.5), 0.5) : 0;
}

/* Place in the piece of the first event, 2: none. */
static double first_event(const march *o, mhb_contact_event *kind) {
  return o->deaf ? 2
                 : mhb_contact_step_first(o->rule, &o->spring->law, &o->at, &o->piece,
                                          OVERSTEP * o->scale, kind);
}

/* The longest piece in the present state: to the end of the step, or to an event. Returns 0 if no
 * forces were found. */
static int find_piece(march *o) {
  double rest = 1 - o->tau, length = o->deaf ? fmin(rest, HUSHED) : rest;
  o->ends = false;
  for (int k = 0; k < MAX_TRIALS; k++) {
    if (!solve_piece(o, length)) {
      o->ends = false;
      length /= 2;
      continue;
    }
    mhb_contact_event kind;
    double            at = first_event(o, &kind);
    if (!o->ends && at > 1) return 1;
    if (o->ends && at > 0.999) {
      double change = correction(o);
      if (fabs(change) * length <= ON_EVENT || k == MAX_TRIALS / 2) return 1;
      length = fmin(length * (1 + change), rest);
      if (length == rest && change > 0) o->ends = false;
      continue;
    }
    if (at * length < NO_PROGRESS) {
      o->kind   = kind;
      o->ends   = true;
      o->length = 0;
      return 1;
    }
    o->kind = kind;
    o->ends = !(mhb_contact_step_turns(&o->at, &o->piece, o->kind) && at * length > TURNING);
    length *= o->ends ? fmax(at, 1e-3) : 0.7 * at;
  }
  return 0;
}

/* ---- the pieces ---- */

/* What the piece adds to the forces that the modes see, to shares and work. */
static void add_piece(const march *o, mhb_contact_path *path) {
  const double *b = o->rule->A[S - 1], length = o->length;
  for (int i = 0; i < S; i++) {
    double l[S];
    mhb_radau_lagrange(o->rule, o->tau + o->rule->c[i] * length, l);
    for (int j = 0; j < S; j++)
      for (int c = 0; c < 3; c++)
        path->p[3 * j + c] += length * b[i] * l[j] / b[j] * o->piece.p[3 * i + c];
    if (o->at.state == MHB_SLIDE)
      path->work += b[i] * o->piece.kappa[i] * o->spring->law.mu * o->piece.n[i];
  }
  path->share[(int)o->at.state] += length;
}

/* A closing contact sticks if the friction of sticking increases more slowly than its limit (eq.
 * 13). */
static void close_contact(march *o) {
  double direction;
  mhb_contact_step_change(&o->spring->law, MHB_STICK, 0, &o->at);
  if (!(o->spring->law.mu > 0)) return;
  solve_piece(o, fmin(0.01, 1 - o->tau));
  if (mhb_contact_step_closing(o->rule, &o->spring->law, &o->at, &o->piece, &direction) > 0)
    mhb_contact_step_change(&o->spring->law, MHB_SLIDE, direction, &o->at);
}

static void apply_event(march *o) {
  if (o->kind == MHB_CONTACT_CLOSES)
    close_contact(o);
  else
    mhb_contact_step_after(&o->spring->law, o->kind, &o->at);
}

int mhb_contact_path_follow(const mhb_radau *rule, const mhb_contact_spring *spring, double h,
                            const mhb_contact_point *point, const double *start, const double *w,
                            double scale, mhb_contact_path *path) {
  march o       = {.rule = rule, .spring = spring, .h = h, .scale = scale, .at = *point};
  int   stalled = 0;
  for (int k = 0; k <= S; k++)
    for (int c = 0; c < 3; c++) {
      o.cubic[k][c] = rule->dense[k][0] * start[c];
      for (int i = 0; i < S; i++) o.cubic[k][c] += rule->dense[k][i + 1] * w[3 * i + c];
    }
  *path = (mhb_contact_path){.events = 0};
  for (int k = 0; k < MAX_PIECES && 1 - o.tau > NO_PROGRESS; k++) {
    o.deaf = stalled > MAX_STALLED || k > MAX_PIECES - 1 / HUSHED - 2;
    if (!find_piece(&o)) return 0;
    if (o.length > 0) {
      add_piece(&o, path);
      mhb_contact_step_advance(&spring->law, &o.piece, o.length * h, &o.at);
      o.tau += o.length;
    }
    stalled = o.length > NO_PROGRESS ? 0 : stalled + 1;
    path->forced += o.deaf;
    if (!o.ends) continue;
    path->events++;
    apply_event(&o);
  }
  path->end = o.at;
  return 1;
}
