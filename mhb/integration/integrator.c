#include "mhb/integration/integrator.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, MAX_SWEEPS = 400, MAX_CUTS = 8, MAX_STALLED = 4 };

/* Tolerances relative to the force scale: change of the forces in the last sweep; event
 * function. */
static const double SOLVED = 1e-12, OVERSTEP = 1e-10;

/* Tolerances relative to a nominal step: time of an event; shortest step that counts as
 * progress. */
static const double ON_EVENT = 1e-11, NO_PROGRESS = 1e-9;

/* ---- the motion without contact forces ---- */

double mhb_integrator_lag(const mhb_integrator *g, int blade) {
  return SHB_TWO_PI * g->ring.s.wave * blade / g->blades;
}

void mhb_integrator_free(const mhb_integrator *g, int sector, double t, double *u) {
  const mhb_receptance *r     = g->receptance;
  double                angle = SHB_TWO_PI * t / g->period - mhb_integrator_lag(g, sector);
  for (int k = 0; k <= g->n_load; k += r->nu) {
    double c = cos(k * angle), s = sin(k * angle);
    for (int row = 0; row < r->n; row++) {
      double complex a = r->free[k * r->n + row];
      u[row] += creal(a) * c - cimag(a) * s;
    }
  }
}

/* ---- one step of given length ---- */

MHB_HOT static void set_stage_modes(int m, const double *coefficient, const double *z,
                                    const double *v, double *stage) {
  for (int k = 0; k < S; k++) {
    const double *a = coefficient + (MHB_STAGE_Z + k) * m, *b = coefficient + (MHB_STAGE_V + k) * m;
    for (int i = 0; i < m; i++) stage[k * m + i] = a[i] * z[i] + b[i] * v[i];
  }
}

MHB_HOT static void set_stage_amplitudes(int m, const double *coefficient, const double *re,
                                         const double *im, double *stage) {
  for (int k = 0; k < S; k++) {
    const double *a = coefficient + (MHB_STAGE_Z + k) * m, *b = coefficient + (MHB_STAGE_V + k) * m;
    double       *x = stage + 2 * k * m, *y = x + m;
    for (int i = 0; i < m; i++) {
      x[i] = a[i] * re[i] - b[i] * im[i];
      y[i] = a[i] * im[i] + b[i] * re[i];
    }
  }
}

MHB_HOT static void add_stage_motion(int n3, int m, const double *shape, const double *stage,
                                     double *y) {
  for (int r = 0; r < n3; r++)
    for (int k = 0; k < S; k++) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (int i = 0; i < m; i++) sum += shape[r * m + i] * stage[k * m + i];
      y[r / 3 * F + 3 * k + r % 3] += sum;
    }
}

/* y: motion of all contacts at the stages without contact forces of the step. */
static void set_motion(mhb_integrator *g, const mhb_modal_step *modal) {
  int m = g->modes, lines = g->ring.lines, n3 = 3 * g->pairs;
  memset(g->y, 0, sizeof(double) * F * (size_t)g->contacts);
  for (int b = 0; b < g->blades; b++) {
    (g->ring.amplitudes ? set_stage_amplitudes : set_stage_modes)(
        m, modal->mode, g->z + b * m, g->z + (g->blades + b) * m, g->stage);
    for (int side = 0; side < g->ring.s.sides; side++)
      add_stage_motion(n3, lines, g->ring.motion + side * n3 * lines, g->stage,
                       g->y + mhb_modal_structure_contact(&g->ring.s, b, side) * F);
    for (int k = 0; k < S; k++) {
      double u[n3];
      memset(u, 0, sizeof u);
      mhb_integrator_free(g, b, g->t + g->ring.rule.c[k] * modal->h, u);
      for (int r = 0; r < n3; r++) g->y[(b * g->pairs + r / 3) * F + 3 * k + r % 3] += u[r];
    }
  }
}

MHB_HOT static void subtract(const double *S_, const double *p, double *y) {
  for (int i = 0; i < F; i++) {
    double sum = 0;
    for (int k = 0; k < F; k++) sum += S_[i * F + k] * p[k];
    y[i] -= sum;
  }
}

/* One contact with the forces of the others as they are. Returns the change of its force, N;
 * negative if none was found. */
static double solve_contact(mhb_integrator *g, mhb_modal_step *modal, int contact) {
  int    sector = contact / g->pairs, pair = contact % g->pairs;
  double y[F], before[F], change = 0;
  memcpy(y, g->y + contact * F, sizeof y);
  for (int neighbour = 0; neighbour < g->ring.n_neighbours; neighbour++) {
    const double *S_ =
        modal->compliance + (size_t)((neighbour * g->pairs + pair) * g->pairs) * F * F;
    int by = mhb_ring_step_sector(&g->ring, sector, neighbour) * g->pairs;
    for (int b = 0; b < g->pairs; b++)
      if (by + b != contact) subtract(S_ + b * F * F, g->step[by + b].p, y);
  }
  mhb_contact_step *step = &g->step[contact];
  memcpy(before, step->p, sizeof before);
  if (!mhb_contact_step_solve(&g->ring.rule, &g->law[pair], &g->point[contact],
                              modal->compliance + (size_t)(pair * g->pairs + pair) * F * F,
                              &modal->stuck[pair], y, g->scale, step))
    return -1;
  for (int i = 0; i < F; i++) change = fmax(change, fabs(step->p[i] - before[i]));
  return change;
}

/* All contacts, block Gauss-Seidel until the forces are constant. Returns 0 if they do not
 * settle. */
static int solve(mhb_integrator *g, mhb_modal_step *modal) {
  set_motion(g, modal);
  for (int j = 0; j < g->contacts; j++)
    mhb_contact_step_guess(&g->law[j % g->pairs], &g->point[j], modal->h, &g->step[j]);
  for (int k = 0; k < MAX_SWEEPS; k++) {
    double worst = 0;
    for (int j = 0; j < g->contacts; j++) {
      double change = solve_contact(g, modal, j);
      if (change < 0) return 0;
      worst = fmax(worst, change);
    }
    if (g->contacts == 1 || worst <= SOLVED * g->scale) return 1;
  }
  return 0;
}

/* force -= shape^T p of a side */
MHB_HOT static void add_modal_force(int n3, int m, const double *shape,
                                    const mhb_contact_step *step, double *force) {
  for (int r = 0; r < n3; r++)
    for (int k = 0; k < S; k++) {
      double p = step[r / 3].p[3 * k + r % 3];
      for (int i = 0; i < m; i++) force[k * m + i] -= shape[r * m + i] * p;
    }
}

MHB_HOT static void end_modes(int m, const double *a, const double *force, double *z, double *v) {
  for (int i = 0; i < m; i++) {
    double z0 = z[i], v0 = v[i];
    double z1 = a[MHB_END_Z * m + i] * z0 + a[MHB_END_V * m + i] * v0;
    double v1 = a[MHB_RATE_Z * m + i] * z0 + a[MHB_RATE_V * m + i] * v0;
    for (int k = 0; k < S; k++) {
      z1 += a[(MHB_END_F + k) * m + i] * force[k * m + i];
      v1 += a[(MHB_RATE_F + k) * m + i] * force[k * m + i];
    }
    z[i] = z1;
    v[i] = v1;
  }
}

MHB_HOT static void end_amplitudes(int m, const double *a, const double *force, double *re,
                                   double *im) {
  for (int i = 0; i < m; i++) {
    const double er = a[MHB_END_Z * m + i], ei = a[MHB_END_V * m + i];
    double       x = er * re[i] - ei * im[i], y = er * im[i] + ei * re[i];
    for (int k = 0; k < S; k++) {
      const double  fr = a[(MHB_END_F + k) * m + i], fi = a[(MHB_RATE_F + k) * m + i];
      const double *f = force + 2 * k * m + i;
      x += fr * f[0] - fi * f[m];
      y += fr * f[m] + fi * f[0];
    }
    re[i] = x;
    im[i] = y;
  }
}

/* Modes to the end of the step, under the forces at its stages. */
static void end_step(mhb_integrator *g, const mhb_modal_step *modal) {
  int m = g->modes, lines = g->ring.lines, n3 = 3 * g->pairs;
  if (g->watch) g->watch(g->context, g, g->t, modal->h);
  for (int b = 0; b < g->blades; b++) {
    memset(g->stage, 0, sizeof(double) * S * (size_t)lines);
    for (int side = 0; side < g->ring.s.sides; side++)
      add_modal_force(n3, lines, g->ring.force + side * n3 * lines,
                      g->step + mhb_modal_structure_contact(&g->ring.s, b, side), g->stage);
    (g->ring.amplitudes ? end_amplitudes : end_modes)(m, modal->mode, g->stage, g->z + b * m,
                                                      g->z + (g->blades + b) * m);
  }
  g->t += modal->h;
  g->count.steps++;
}

static void note_scale(mhb_integrator *g, int contact) {
  for (int c = 0; c < 3; c++) g->scale = fmax(g->scale, fabs(g->point[contact].p[c]));
}

static void accept(mhb_integrator *g, const mhb_modal_step *modal) {
  end_step(g, modal);
  int progress = modal->h > NO_PROGRESS * g->nominal.h;
  for (int j = 0; j < g->contacts; j++) {
    mhb_contact_step_advance(&g->law[j % g->pairs], &g->step[j], modal->h, &g->point[j]);
    note_scale(g, j);
    if (progress) g->n_stalled[j] = g->suppressed[j] = 0;
  }
}

void mhb_integrator_share(const mhb_integrator *g, int contact, double share[3], double *work) {
  const mhb_contact_point *point = &g->point[contact];
  const mhb_contact_step  *step  = &g->step[contact];
  if (g->joint) {
    memcpy(share, g->joint->path[contact].share, 3 * sizeof *share);
    *work = g->joint->path[contact].work;
    return;
  }
  for (int k = 0; k < 3; k++) share[k] = k == (int)point->state;
  *work = 0;
  for (int j = 0; j < S && point->state == MHB_SLIDE; j++)
    *work += g->ring.rule.A[S - 1][j] * step->kappa[j] * g->law[contact % g->pairs].mu * step->n[j];
}

/* ---- steps of many contacts ---- */

/* One step of nominal length. Returns 0 if it failed. */
static int joint_step(mhb_integrator *g) {
  set_motion(g, &g->nominal);
  if (!mhb_joint_step_solve(g->joint, g->point, g->y, g->scale)) return 0;
  for (int j = 0; j < g->contacts; j++)
    memcpy(g->step[j].p, g->joint->path[j].p, sizeof g->step[j].p);
  end_step(g, &g->nominal);
  for (int j = 0; j < g->contacts; j++) {
    const mhb_contact_path *path = &g->joint->path[j];
    g->point[j]                  = path->end;
    note_scale(g, j);
    g->count.events += path->events;
    g->count.forced += path->forced;
  }
  return 1;
}

/* ---- steps that end at events ---- */

typedef struct {
  int               contact;
  mhb_contact_event kind;
  double            tau; /* in the step; 2: none */
} step_event;

static step_event first_event(const mhb_integrator *g) {
  step_event first = {.tau = 2};
  for (int j = 0; j < g->contacts; j++) {
    mhb_contact_event kind;
    if (g->suppressed[j]) continue;
    double tau = mhb_contact_step_first(&g->ring.rule, &g->law[j % g->pairs], &g->point[j],
                                        &g->step[j], OVERSTEP * g->scale, &kind);
    if (tau < first.tau) first = (step_event){j, kind, tau};
  }
  return first;
}

static double excess(const mhb_integrator *g, const step_event *o, double tau) {
  int j = o->contact;
  return mhb_contact_step_excess(&g->ring.rule, &g->law[j % g->pairs], &g->point[j], &g->step[j],
                                 o->kind, tau);
}

static mhb_modal_step *modal_step_of(mhb_integrator *g, double h) {
  if (fabs(h - g->nominal.h) < 1e-12 * g->nominal.h) return &g->nominal;
  if (h != g->cut.h) mhb_modal_step_length(&g->ring, h, &g->cut);
  return &g->cut;
}

/* A closing contact sticks if the friction of sticking increases more slowly than its limit (eq.
 * 13). */
static void close_contact(mhb_integrator *g, int contact) {
  const mhb_law     *law   = &g->law[contact % g->pairs];
  mhb_contact_point *point = &g->point[contact];
  double             direction;
  mhb_contact_step_change(law, MHB_STICK, 0, point);
  if (!(law->mu > 0) || !solve(g, modal_step_of(g, 0.01 * g->nominal.h))) return;
  if (mhb_contact_step_closing(&g->ring.rule, law, point, &g->step[contact], &direction) > 0)
    mhb_contact_step_change(law, MHB_SLIDE, direction, point);
}

static void apply_event(mhb_integrator *g, const step_event *o) {
  const mhb_law     *law   = &g->law[o->contact % g->pairs];
  mhb_contact_point *point = &g->point[o->contact];
  g->count.events++;
  if (++g->n_stalled[o->contact] > MAX_STALLED) {
    g->suppressed[o->contact] = 1;
    g->count.forced++;
  }
  if (o->kind == MHB_CONTACT_CLOSES)
    close_contact(g, o->contact);
  else
    mhb_contact_step_after(law, o->kind, point);
}

/* Relative change of the step's length that moves its end to the event. */
static double correction(const mhb_integrator *g, const step_event *o) {
  double at = excess(g, o, 1), slope = (at - excess(g, o, 0.99)) / 0.01;
  return slope > 0 ? -at / slope : 0;
}

/* One step that ends at the event, or at an earlier one; longest in s. Returns 0 if it failed. */
static int step_to_event(mhb_integrator *g, step_event o, double h, double longest) {
  for (int k = 0; k < MAX_CUTS; k++) {
    h                     = fmin(h, longest);
    mhb_modal_step *modal = modal_step_of(g, h);
    if (!solve(g, modal)) return 0;
    step_event earlier = first_event(g);
    if (earlier.tau < 0.999) {
      o = earlier;
      h *= fmax(o.tau, 1e-3);
      continue;
    }
    double part = correction(g, &o);
    if (fabs(part) * h <= ON_EVENT * g->nominal.h || k == MAX_CUTS - 1) {
      accept(g, modal);
      apply_event(g, &o);
      return 1;
    }
    h *= 1 + fmin(fmax(part, -0.5), 0.5);
  }
  return 0;
}

/* One step of at most `longest` seconds. Returns 0 if it failed. */
static int advance(mhb_integrator *g, double longest) {
  double h = longest;
  for (int k = 0; k < 40; k++, h /= 2) {
    mhb_modal_step *modal = modal_step_of(g, h);
    if (!solve(g, modal)) continue;
    step_event o = first_event(g);
    if (o.tau > 1) {
      accept(g, modal);
      return 1;
    }
    if (o.tau * h < NO_PROGRESS * g->nominal.h) {
      apply_event(g, &o);
      return 1;
    }
    if (mhb_contact_step_turns(&g->point[o.contact], &g->step[o.contact], o.kind) &&
        o.tau * h > 1e-3 * g->nominal.h) {
      modal = modal_step_of(g, 0.7 * o.tau * h);
      if (!solve(g, modal)) continue;
      if (first_event(g).tau > 1) {
        accept(g, modal);
        return 1;
      }
    }
    if (step_to_event(g, o, o.tau * h, longest)) return 1;
  }
  return 0;
}

int mhb_integrator_period(mhb_integrator *g) {
  g->t = 0;
  for (int i = 0; i < g->steps && g->joint; i++)
    if (!joint_step(g)) return 0;
  for (int i = 0; i < g->steps && !g->joint; i++) {
    double end = (i + 1) * (g->period / g->steps), rest;
    while ((rest = end - g->t) > NO_PROGRESS * g->nominal.h) {
      int hushed = 0;
      for (int j = 0; j < g->contacts; j++) hushed |= g->suppressed[j];
      if (!advance(g, hushed ? fmin(rest, g->nominal.h / 32) : rest)) return 0;
    }
    g->t = end;
  }
  return 1;
}

/* ---- life cycle ---- */

static void allocate(mhb_integrator *g) {
  size_t modal = (size_t)g->blades * (size_t)g->modes, contacts = (size_t)g->contacts;
  g->law        = shb_arena_take(&g->arena, (size_t)g->pairs, sizeof *g->law);
  g->z          = shb_arena_take(&g->arena, 2 * modal, sizeof(double));
  g->point      = shb_arena_take(&g->arena, contacts, sizeof *g->point);
  g->step       = shb_arena_take(&g->arena, contacts, sizeof *g->step);
  g->n_stalled  = shb_arena_take(&g->arena, contacts, sizeof(int));
  g->suppressed = shb_arena_take(&g->arena, contacts, sizeof(int));
  g->y          = shb_arena_take(&g->arena, contacts * F, sizeof(double));
  g->stage      = shb_arena_take(&g->arena, S * (size_t)g->ring.lines, sizeof(double));
}

shb_status mhb_integrator_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_integrator **out) {
  return mhb_integrator_create_as(model, settings, n_harmonics,
                                  model->n_pairs >= MHB_JOINT_PAIRS && !model->coriolis, out);
}

shb_status mhb_integrator_create_as(const modal_model *model, const mhb_settings *settings,
                                    int n_harmonics, bool joint, mhb_integrator **out) {
  mhb_integrator *g  = shb_alloc_zeroed(1, sizeof *g);
  int             nu = settings->subharmonics;
  g->settings        = *settings;
  g->n_load          = nu * model->n_load;
  g->n_harmonics     = n_harmonics > g->n_load ? n_harmonics : g->n_load;
  shb_status status  = SHB_OK;
  if (model->residual_inertia) {
    status = mhb_inertia_modes(model, &g->model);
    model  = &g->model;
  }
  if (status == SHB_OK)
    status = mhb_receptance_create(model, &g->settings, g->n_harmonics, &g->receptance);
  if (status == SHB_OK) status = mhb_ring_step_create(g->receptance, &g->settings, &g->ring);
  if (status == SHB_OK) {
    g->blades   = g->ring.s.blades;
    g->modes    = g->ring.s.modes;
    g->pairs    = g->ring.s.pairs;
    g->contacts = g->ring.s.contacts;
    allocate(g);
    mhb_modal_step_create(&g->ring, !joint, &g->nominal);
    if (!joint) mhb_modal_step_create(&g->ring, true, &g->cut);
    if (joint) g->joint = mhb_joint_step_create(&g->ring);
  }
  if (status != SHB_OK) {
    mhb_integrator_destroy(g);
    return status;
  }
  *out = g;
  return SHB_OK;
}

void mhb_integrator_destroy(mhb_integrator *g) {
  if (!g) return;
  mhb_modal_step_destroy(&g->nominal);
  mhb_modal_step_destroy(&g->cut);
  mhb_joint_step_destroy(g->joint);
  mhb_ring_step_destroy(&g->ring);
  mhb_receptance_destroy(g->receptance);
  mhb_inertia_free(&g->model);
  shb_arena_free(&g->arena);
  free(g);
}
