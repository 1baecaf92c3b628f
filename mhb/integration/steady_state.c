#include "mhb/integration/steady_state.h"
#include "mesh/base/arena.h"
#include "mesh/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

enum { S = MHB_STAGES, HISTORY = 2 * MHB_STEADY_STATE_MULTIPLE + 1, TREND = 8 };

/* Least distance, in tolerances, of the periods of a motion of higher order. */
static const double APART = 1e3;

struct mhb_steady_state {
  mhb_integrator         *g;
  mhb_steady_state_result result;
  double                 *history;      /* [HISTORY][size] states at the ends of the last periods */
  double                 *distance;     /* [TREND][multiple] the last distances */
  double complex         *force;        /* [k][3 contacts] of the period that is recorded */
  double                 *share, *work; /* [contact][3], [contact] */
  shb_arena               arena;
};

/* ---- distance ---- */

/* Mean square of the modes' motion without contact forces. */
static double free_size(const mhb_integrator *g) {
  const mhb_receptance *r    = g->receptance;
  const int             m    = g->modes;
  double                size = 0;
  double complex        a[m];
  for (int k = 0; k <= g->n_load; k++) {
    for (int i = 0; i < m; i++) a[i] = r->scale * r->F[k * m + i];
    mhb_receptance_respond(r, k, a);
    for (int i = 0; i < m; i++) size += g->blades * creal(a[i] * conj(a[i]));
  }
  return size;
}

/* Weight of a number of the state that gives it the unit of z. Each amplitude of (w z, z') stands
 * for a conjugate pair. */
static double weight_of(const mhb_integrator *g, int k) {
  const int i = k % g->modes;
  if (g->ring.amplitudes) return sqrt(2.) / cabs(g->ring.amplitudes->pole[i]);
  return k < g->blades * g->modes ? 1 : 1 / g->ring.s.omega[i];
}

double mhb_steady_state_distance(const mhb_integrator *g, const double *a, const double *b) {
  int    n     = 2 * g->blades * g->modes;
  double apart = 0, size = free_size(g), friction = 0, force = 0;
  for (int k = 0; k < n; k++) {
    const double weight = weight_of(g, k), d = weight * (a[k] - b[k]), z = weight * b[k];
    apart += d * d;
    size += z * z;
  }
  for (int k = n; k < n + 2 * g->contacts; k++) {
    friction = fmax(friction, fabs(a[k] - b[k]));
    force    = fmax(force, fabs(b[k]));
  }
  force = fmax(force, g->scale);
  return fmax(size > 0 ? sqrt(apart / size) : sqrt(apart), force > 0 ? friction / force : 0);
}

/* ---- recording ---- */

/* J[m] = int_0^1 tau^m/m! exp(-j x tau) */
static void fourier_moments(double x, double complex J[S]) {
  if (x < 2) {
    double complex term = 1;
    J[0] = J[1] = J[2] = 0;
    for (int n = 0; n < 30; n++) {
      J[0] += term / (n + 1);
      J[1] += term / (n + 2);
      J[2] += term / (2 * (n + 3));
      term *= -I * x / (n + 1);
    }
    return;
  }
  double complex end = cexp(-I * x), step = I * x;
  J[0] = (1 - end) / step;
  J[1] = (J[0] - end) / step;
  J[2] = (J[1] - end / 2) / step;
}

static void record(void *context, const mhb_integrator *g, double t0, double h) {
  mhb_steady_state *o = context;
  const mhb_radau  *r = &g->ring.rule;
  int               n = 3 * g->contacts;
  for (int k = 0; k <= o->result.n_harmonics; k++) {
    double         w = SHB_TWO_PI * k / g->period;
    double complex J[S], weight[S] = {0}, phase = cexp(-I * w * t0) * h * (k ? 2 : 1) / g->period;
    fourier_moments(w * h, J);
    for (int j = 0; j < S; j++)
      for (int m = 0; m < S; m++) weight[j] += phase * r->basis[j][m] * J[m];
    for (int i = 0; i < n; i++)
      for (int j = 0; j < S; j++)
        o->force[k * n + i] += weight[j] * g->step[i / 3].p[3 * j + i % 3];
  }
  for (int c = 0; c < g->contacts; c++) {
    double share[3], work;
    mhb_integrator_share(g, c, share, &work);
    for (int k = 0; k < 3; k++) o->share[3 * c + k] += share[k] * h / g->period;
    o->work[c] += work;
  }
}

/* Change of q and q' [modes] of a blade since z0. */
static void rise_of(const mhb_integrator *g, int blade, const double *z0, double *q, double *rate) {
  const int at = blade * g->modes, modal = g->blades * g->modes;
  for (int i = 0; i < g->modes; i++) {
    q[i]    = g->z[at + i] - z0[at + i];
    rate[i] = g->z[modal + at + i] - z0[modal + at + i];
  }
  if (g->ring.amplitudes) mhb_amplitudes_give(g->ring.amplitudes, q, rate);
}

/* z[modes] <- harmonic k of the modes of a blade. The equation of motion is integrated with
 * exp(-jkwt), which is exact even if the end differs from the start. */
static void mode_harmonics(const mhb_steady_state *o, int k, int blade, const double *z0,
                           double complex *z) {
  const mhb_integrator      *g = o->g;
  const mhb_modal_structure *s = &g->ring.s;
  const double              *G = g->receptance->model->coriolis;
  const int                  m = g->modes, n3 = 3 * g->pairs;
  const double               w = SHB_TWO_PI * k / g->period;
  double                     q[m], rate[m];
  rise_of(g, blade, z0, q, rate);
  for (int i = 0; i < m; i++) {
    double complex rise = rate[i] + CMPLX(2 * s->zeta[i] * s->omega[i], w) * q[i];
    for (int j = 0; G && j < m; j++) rise += G[(size_t)i * (size_t)m + (size_t)j] * q[j];
    z[i] = -(k ? 2 : 1) / g->period * rise;
  }
  for (int side = 0; side < s->sides; side++) {
    const double complex *p =
        o->force + k * 3 * g->contacts + 3 * mhb_modal_structure_contact(s, blade, side);
    for (int r = 0; r < n3; r++)
      for (int i = 0; i < m; i++) z[i] -= g->ring.shape[(side * n3 + r) * m + i] * p[r];
  }
  mhb_receptance_respond(g->receptance, k, z);
}

/* Motion of the contacts of blade 0's right side. */
static void set_motion(mhb_steady_state *o, int k, const double *z0) {
  const mhb_integrator *g = o->g;
  const mhb_receptance *r = g->receptance;
  int m = g->modes, n3 = 3 * g->pairs, n = 3 * g->contacts, K = o->result.n_harmonics + 1;
  double complex z[m];
  for (int row = 0; row < n3; row++) {
    double complex u = r->free[k * n3 + row];
    for (int c = 0; g->ring.s.flexibility && c < n; c++)
      u -= g->ring.s.flexibility[row * n + c] * o->force[k * n + c];
    o->result.motion[row * K + k] = u;
    o->result.force[row * K + k]  = o->force[k * n + row];
  }
  for (int side = 0; side < g->ring.s.sides; side++) {
    /* blade 1 to the right, its left side; one blade meets itself */
    mode_harmonics(o, k, side % g->blades, z0, z);
    for (int row = 0; row < n3; row++)
      for (int i = 0; i < m; i++)
        o->result.motion[row * K + k] += g->ring.shape[(side * n3 + row) * m + i] * z[i];
  }
}

/* Probes of blade 0: those of the wave with these forces, and the modes' difference from it. */
static void set_probes(mhb_steady_state *o, int k, const double *z0) {
  const mhb_integrator *g = o->g;
  const mhb_receptance *r = g->receptance;
  int                   m = g->modes, q = 3 * r->model->n_probes, K = o->result.n_harmonics + 1;
  double complex       *p = o->force + k * 3 * g->contacts, motion[q + 1], z[m], wave[m];
  mhb_receptance_probe(r, k, p, motion);
  mode_harmonics(o, k, 0, z0, z);
  memset(wave, 0, sizeof wave);
  for (int row = 0; row < r->n; row++)
    for (int i = 0; i < m; i++) wave[i] -= conj(r->B[(k * r->n + row) * m + i]) * p[row];
  mhb_receptance_respond(r, k, wave);
  for (int s = 0; s < q; s++)
    for (int i = 0; i < m; i++) motion[s] += r->model->probe[s * m + i] * (z[i] - wave[i]);
  for (int s = 0; s < q; s++) o->result.probe[s * K + k] = motion[s];
}

/* One more period, recorded. */
static int record_period(mhb_steady_state *o) {
  mhb_integrator *g  = o->g;
  double         *z0 = o->history; /* its states are no longer needed */
  size_t          n  = 3 * (size_t)g->contacts;
  memset(o->force, 0, sizeof *o->force * n * ((size_t)o->result.n_harmonics + 1));
  memset(o->share, 0, sizeof(double) * n);
  memset(o->work, 0, sizeof(double) * (size_t)g->contacts);
  memcpy(z0, g->z, sizeof(double) * 2 * (size_t)(g->blades * g->modes));
  g->watch   = record;
  g->context = o;
  int found  = mhb_integrator_period(g);
  g->watch   = NULL;
  if (!found) return 0;
  for (int k = 0; k <= o->result.n_harmonics; k++) {
    set_motion(o, k, z0);
    set_probes(o, k, z0);
  }
  memcpy(o->result.state, o->share, sizeof(double) * 3 * (size_t)g->pairs);
  memcpy(o->result.dissipation, o->work, sizeof(double) * (size_t)g->pairs);
  return 1;
}

/* ---- until it repeats ---- */

static double *state_at(const mhb_steady_state *o, int period) {
  return o->history + (size_t)(period % HISTORY) * (size_t)mhb_integrator_size(o->g);
}

/* Whether the motion repeats after `multiple` periods, with the distance to go below the
 * tolerance. */
static int repeats(mhb_steady_state *o, int period, int multiple, double tolerance) {
  if (period < multiple) return 0;
  double *trend = o->distance + (multiple - 1) * TREND;
  double  d = mhb_steady_state_distance(o->g, state_at(o, period), state_at(o, period - multiple));
  double  past          = trend[period % TREND];
  trend[period % TREND] = d;
  if (multiple == 1) o->result.distance = d;
  if (d < 1e-14) return 1;
  if (period < multiple + TREND || !(d < tolerance)) return 0;
  if (multiple > 1 && o->result.distance < APART * tolerance)
    return 0;                                            /* it converges to order one */
  double rate = pow(d / past, (double)multiple / TREND); /* over `multiple` periods */
  return rate < 1 && d / (1 - rate) < tolerance;
}

const mhb_steady_state_result *mhb_steady_state_run(mhb_steady_state                *o,
                                                    const mhb_steady_state_settings *settings,
                                                    int (*go_on)(void *), void *context) {
  mhb_integrator          *g = o->g;
  mhb_steady_state_result *r = &o->result;
  r->multiple = r->failed = r->periods = 0;
  r->distance                          = INFINITY;
  mhb_integrator_get(g, state_at(o, 0));
  while (!r->multiple && r->periods < settings->max_periods) {
    if (!mhb_integrator_period(g)) {
      r->failed = 1;
      return r;
    }
    r->periods++;
    mhb_integrator_get(g, state_at(o, r->periods));
    for (int k = 1; k <= MHB_STEADY_STATE_MULTIPLE && !r->multiple; k++)
      if (repeats(o, r->periods, k, settings->tolerance)) r->multiple = k;
    if (go_on && !go_on(context)) break;
  }
  if (r->multiple > 1) r->distance = o->distance[(r->multiple - 1) * TREND + r->periods % TREND];
  r->failed = !record_period(o);
  return r;
}

/* ---- life cycle ---- */

mhb_steady_state *mhb_steady_state_create(mhb_integrator *g) {
  mhb_steady_state        *o = shb_alloc_zeroed(1, sizeof *o);
  mhb_steady_state_result *r = &o->result;
  o->g                       = g;
  r->n_harmonics             = g->n_harmonics;
  r->n_pairs                 = g->pairs;
  r->n_probes                = g->receptance->model->n_probes;
  size_t K = (size_t)r->n_harmonics + 1, n3 = 3 * (size_t)g->pairs, n = 3 * (size_t)g->contacts;
  size_t q       = 3 * (size_t)r->n_probes;
  r->motion      = shb_arena_take(&o->arena, n3 * K, sizeof *r->motion);
  r->force       = shb_arena_take(&o->arena, n3 * K, sizeof *r->force);
  r->probe       = shb_arena_take(&o->arena, q * K, sizeof *r->probe);
  r->state       = shb_arena_take(&o->arena, n3, sizeof(double));
  r->dissipation = shb_arena_take(&o->arena, n3, sizeof(double));
  o->history  = shb_arena_take(&o->arena, HISTORY * (size_t)mhb_integrator_size(g), sizeof(double));
  o->distance = shb_arena_take(&o->arena, TREND * MHB_STEADY_STATE_MULTIPLE, sizeof(double));
  o->force    = shb_arena_take(&o->arena, n * K, sizeof *o->force);
  o->share    = shb_arena_take(&o->arena, n, sizeof(double));
  o->work     = shb_arena_take(&o->arena, n, sizeof(double));
  return o;
}

void mhb_steady_state_destroy(mhb_steady_state *o) {
  if (!o) return;
  shb_arena_free(&o->arena);
  free(o);
}
