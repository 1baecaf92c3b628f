#include "mhb/integration/integrator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/simd.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, SWEEPS = 400, CUTS = 8, IDLE = 4 };

/* Of the force scale: what contacts are solved to, and what a state may be overstepped by. Of a nominal step: how exactly
 * events are met, and what counts as no progress. */
static const double SOLVED = 1e-12, OVERSTEP = 1e-10, ON_EVENT = 1e-11, NO_PROGRESS = 1e-9;

/* ---- the motion without contact forces ---- */

double mhb_integrator_lag(const mhb_integrator *g, int blade) {
  return SHB_TWO_PI * g->chain.s.wave * blade / g->blades;
}

void mhb_integrator_free(const mhb_integrator *g, int group, double t, double *u) {
  const mhb_receptance *r     = g->receptance;
  double                angle = SHB_TWO_PI * t / g->period - mhb_integrator_lag(g, group);
  for (int k = 0; k <= g->n_load; k += r->nu) {
    double c = cos(k * angle), s = sin(k * angle);
    for (int row = 0; row < r->n; row++) {
      double complex a = r->free[k * r->n + row];
      u[row] += creal(a) * c - cimag(a) * s;
    }
  }
}

/* ---- one step of given length ---- */

MHB_HOT static void stage_modes(int m, const double *coefficient, const double *z, const double *v,
                                double *stage) {
  for (int k = 0; k < S; k++) {
    const double *a = coefficient + (MHB_STAGE_Z + k) * m, *b = coefficient + (MHB_STAGE_V + k) * m;
    for (int i = 0; i < m; i++) stage[k * m + i] = a[i] * z[i] + b[i] * v[i];
  }
}

MHB_HOT static void stage_contacts(int n3, int m, const double *shape, const double *stage,
                                   double *y) {
  for (int r = 0; r < n3; r++)
    for (int k = 0; k < S; k++) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (int i = 0; i < m; i++) sum += shape[r * m + i] * stage[k * m + i];
      y[r / 3 * F + 3 * k + r % 3] += sum;
    }
}

/* y without contact forces. */
static void set_motion(mhb_integrator *g, const mhb_modal_step *span) {
  int m = g->modes, n3 = 3 * g->pairs;
  memset(g->y, 0, sizeof(double) * F * (size_t)g->contacts);
  for (int b = 0; b < g->blades; b++) {
    stage_modes(m, span->mode, g->z + b * m, g->z + (g->blades + b) * m, g->stage);
    for (int side = 0; side < g->chain.s.sides; side++)
      stage_contacts(n3, m, g->chain.shape + side * n3 * m, g->stage,
                     g->y + mhb_modal_structure_contact(&g->chain.s, b, side) * F);
    for (int k = 0; k < S; k++) {
      double u[n3];
      memset(u, 0, sizeof u);
      mhb_integrator_free(g, b, g->t + g->chain.rule.c[k] * span->h, u);
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

/* One contact, given the others. Returns the change of its force, N; < 0: none was found. */
static double relax(mhb_integrator *g, mhb_modal_step *span, int contact) {
  int    group = contact / g->pairs, pair = contact % g->pairs;
  double y[F], before[F], change = 0;
  memcpy(y, g->y + contact * F, sizeof y);
  for (int slot = 0; slot < g->chain.slots; slot++) {
    const double *S_ = span->compliance + (size_t)((slot * g->pairs + pair) * g->pairs) * F * F;
    int           by = mhb_ring_step_sector(&g->chain, group, slot) * g->pairs;
    for (int b = 0; b < g->pairs; b++)
      if (by + b != contact) subtract(S_ + b * F * F, g->step[by + b].p, y);
  }
  mhb_contact_step *step = &g->step[contact];
  memcpy(before, step->p, sizeof before);
  if (!mhb_contact_step_solve(&g->chain.rule, &g->law[pair], &g->rub[contact],
                              span->compliance + (size_t)(pair * g->pairs + pair) * F * F,
                              span->stick + pair * F * F, span->pivot + pair * F, y, g->scale,
                              step))
    return -1;
  for (int i = 0; i < F; i++) change = fmax(change, fabs(step->p[i] - before[i]));
  return change;
}

/* All contacts, block by block until nothing changes. 0: not found. */
static int solve(mhb_integrator *g, mhb_modal_step *span) {
  set_motion(g, span);
  for (int j = 0; j < g->contacts; j++)
    mhb_contact_step_guess(&g->law[j % g->pairs], &g->rub[j], span->h, &g->step[j]);
  for (int k = 0; k < SWEEPS; k++) {
    double worst = 0;
    for (int j = 0; j < g->contacts; j++) {
      double change = relax(g, span, j);
      if (change < 0) return 0;
      worst = fmax(worst, change);
    }
    if (g->contacts == 1 || worst <= SOLVED * g->scale) return 1;
  }
  return 0;
}

/* force += shape^T p of a side */
MHB_HOT static void gather(int n3, int m, const double *shape, const mhb_contact_step *step,
                           double *force) {
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

static void accept(mhb_integrator *g, const mhb_modal_step *span) {
  int m = g->modes, n3 = 3 * g->pairs;
  if (g->watch) g->watch(g->context, g, g->t, span->h);
  for (int b = 0; b < g->blades; b++) {
    memset(g->stage, 0, sizeof(double) * S * (size_t)m);
    for (int side = 0; side < g->chain.s.sides; side++)
      gather(n3, m, g->chain.shape + side * n3 * m,
             g->step + mhb_modal_structure_contact(&g->chain.s, b, side), g->stage);
    end_modes(m, span->mode, g->stage, g->z + b * m, g->z + (g->blades + b) * m);
  }
  int progress = span->h > NO_PROGRESS * g->nominal.h;
  for (int j = 0; j < g->contacts; j++) {
    mhb_contact_step_advance(&g->law[j % g->pairs], &g->step[j], span->h, &g->rub[j]);
    for (int c = 0; c < 3; c++) g->scale = fmax(g->scale, fabs(g->rub[j].p[c]));
    if (progress) g->idle[j] = g->hush[j] = 0;
  }
  g->t += span->h;
  g->count.steps++;
}

/* ---- steps that end where a contact changes its state ---- */

typedef struct {
  int               contact;
  mhb_contact_event kind;
  double            tau; /* in the step; 2: none */
} occasion;

static occasion first_occasion(const mhb_integrator *g) {
  occasion first = {.tau = 2};
  for (int j = 0; j < g->contacts; j++) {
    mhb_contact_event kind;
    if (g->hush[j]) continue;
    double tau = mhb_contact_step_first(&g->chain.rule, &g->law[j % g->pairs], &g->rub[j],
                                        &g->step[j], OVERSTEP * g->scale, &kind);
    if (tau < first.tau) first = (occasion){j, kind, tau};
  }
  return first;
}

static double excess(const mhb_integrator *g, const occasion *o, double tau) {
  int j = o->contact;
  return mhb_contact_step_excess(&g->chain.rule, &g->law[j % g->pairs], &g->rub[j], &g->step[j],
                                 o->kind, tau);
}

static mhb_modal_step *span_of(mhb_integrator *g, double h) {
  if (fabs(h - g->nominal.h) < 1e-12 * g->nominal.h) return &g->nominal;
  if (h != g->cut.h) mhb_modal_step_length(&g->chain, h, &g->cut);
  return &g->cut;
}

/* A contact that closes sticks if the friction it would then have grows more slowly than its limit (eq. 13). */
static void close_contact(mhb_integrator *g, int contact) {
  const mhb_law     *law = &g->law[contact % g->pairs];
  mhb_contact_point *rub = &g->rub[contact];
  double             direction;
  mhb_contact_step_change(law, MHB_STICK, 0, rub);
  if (!(law->mu > 0) || !solve(g, span_of(g, .01 * g->nominal.h))) return;
  if (mhb_contact_step_closing(&g->chain.rule, law, rub, &g->step[contact], &direction) > 0)
    mhb_contact_step_change(law, MHB_SLIDE, direction, rub);
}

static void take_occasion(mhb_integrator *g, const occasion *o) {
  const mhb_law     *law = &g->law[o->contact % g->pairs];
  mhb_contact_point *rub = &g->rub[o->contact];
  g->count.events++;
  if (++g->idle[o->contact] > IDLE) {
    g->hush[o->contact] = 1;
    g->count.forced++;
  }
  switch (o->kind) {
    case MHB_CONTACT_CLOSES:
      close_contact(g, o->contact);
      break;
    case MHB_CONTACT_OPENS:
      mhb_contact_step_change(law, MHB_SEPARATE, 0, rub);
      break;
    case MHB_STICK_TO_SLIP:
      mhb_contact_step_change(law, MHB_SLIDE, atan2(rub->p[2], rub->p[1]), rub);
      break;
    case MHB_SLIP_TO_STICK:
      mhb_contact_step_change(law, MHB_STICK, 0, rub);
      break;
  }
}

/* The step of length h was solved and holds an occasion at its end: by how much of h the end should move. */
static double correction(const mhb_integrator *g, const occasion *o) {
  double at = excess(g, o, 1), slope = (at - excess(g, o, .99)) / .01;
  return slope > 0 ? -at / slope : 0;
}

/* Towards an opening the direction of slip may turn like a power of the time that is left: steps shrink with it. */
static int turns(const mhb_integrator *g, const occasion *o) {
  const mhb_contact_point *rub  = &g->rub[o->contact];
  const mhb_contact_step  *step = &g->step[o->contact];
  return o->kind == MHB_CONTACT_OPENS && rub->state == MHB_SLIDE &&
         fabs(remainder(step->theta[S - 1] - rub->theta, SHB_PI)) > 1e-9;
}

/* A step that ends at the occasion, or before it. want: longest. 0: failed. */
static int approach(mhb_integrator *g, occasion o, double h, double want) {
  for (int k = 0; k < CUTS; k++) {
    h                    = fmin(h, want);
    mhb_modal_step *span = span_of(g, h);
    if (!solve(g, span)) return 0;
    occasion earlier = first_occasion(g);
    if (earlier.tau < .999) {
      o = earlier;
      h *= fmax(o.tau, 1e-3);
      continue;
    }
    double part = correction(g, &o);
    if (fabs(part) * h <= ON_EVENT * g->nominal.h || k == CUTS - 1) {
      accept(g, span);
      take_occasion(g, &o);
      return 1;
    }
    h *= 1 + fmin(fmax(part, -.5), .5);
  }
  return 0;
}

/* One step of at most want seconds. 0: failed. */
static int take(mhb_integrator *g, double want) {
  double h = want;
  for (int k = 0; k < 40; k++, h /= 2) {
    mhb_modal_step *span = span_of(g, h);
    if (!solve(g, span)) continue;
    occasion o = first_occasion(g);
    if (o.tau > 1) {
      accept(g, span);
      return 1;
    }
    if (o.tau * h < NO_PROGRESS * g->nominal.h) {
      take_occasion(g, &o);
      return 1;
    }
    if (turns(g, &o) && o.tau * h > 1e-3 * g->nominal.h) {
      span = span_of(g, .7 * o.tau * h);
      if (!solve(g, span)) continue;
      if (first_occasion(g).tau > 1) {
        accept(g, span);
        return 1;
      }
    }
    if (approach(g, o, o.tau * h, want)) return 1;
  }
  return 0;
}

int mhb_integrator_period(mhb_integrator *g) {
  g->t = 0;
  for (int i = 0; i < g->steps; i++) {
    double end = (i + 1) * (g->period / g->steps), rest;
    while ((rest = end - g->t) > NO_PROGRESS * g->nominal.h) {
      int hushed = 0;
      for (int j = 0; j < g->contacts; j++) hushed |= g->hush[j];
      if (!take(g, hushed ? fmin(rest, g->nominal.h / 32) : rest)) return 0;
    }
    g->t = end;
  }
  return 1;
}

/* ---- life cycle ---- */

static int allocate(mhb_integrator *g) {
  size_t modal = (size_t)(g->blades * g->modes), contacts = (size_t)g->contacts;
  g->law   = calloc((size_t)g->pairs, sizeof *g->law);
  g->z     = calloc(2 * modal, sizeof(double));
  g->rub   = calloc(contacts, sizeof *g->rub);
  g->step  = calloc(contacts, sizeof *g->step);
  g->idle  = calloc(contacts, sizeof(int));
  g->hush  = calloc(contacts, sizeof(int));
  g->y     = calloc(contacts * F, sizeof(double));
  g->stage = calloc(S * (size_t)g->modes, sizeof(double));
  return g->law && g->z && g->rub && g->step && g->idle && g->hush && g->y && g->stage;
}

shb_status mhb_integrator_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_integrator **out) {
  mhb_integrator *g = calloc(1, sizeof *g);
  SHB_CHECK(g, SHB_ERR_IO, "out of memory");
  int nu            = settings->subharmonics;
  g->settings       = *settings;
  g->n_load         = nu * model->n_load;
  g->n_harmonics    = n_harmonics > g->n_load ? n_harmonics : g->n_load;
  shb_status status = SHB_OK;
  if (model->residual_inertia) {
    status = mhb_inertia_modes(model, &g->model);
    model  = &g->model;
  }
  if (status == SHB_OK)
    status = mhb_receptance_create(model, &g->settings, g->n_harmonics, &g->receptance);
  if (status == SHB_OK) status = mhb_ring_step_create(g->receptance, &g->settings, &g->chain);
  if (status == SHB_OK) {
    g->blades   = g->chain.s.blades;
    g->modes    = g->chain.s.modes;
    g->pairs    = g->chain.s.pairs;
    g->contacts = g->chain.s.contacts;
    if (!allocate(g)) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  if (status == SHB_OK) status = mhb_modal_step_create(&g->chain, &g->nominal);
  if (status == SHB_OK) status = mhb_modal_step_create(&g->chain, &g->cut);
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
  mhb_ring_step_destroy(&g->chain);
  mhb_receptance_destroy(g->receptance);
  mhb_inertia_free(&g->model);
  free(g->law);
  free(g->z);
  free(g->rub);
  free(g->step);
  free(g->idle);
  free(g->hush);
  free(g->y);
  free(g->stage);
  free(g);
}
