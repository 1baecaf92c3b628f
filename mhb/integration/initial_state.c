/* Initial states of an integration, and its change to another frequency or preload. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/problem/interfaces.h"

/* Most rounds over the contacts that residual flexibility couples; without it two are enough. */
enum { MAX_ROUNDS = 400, UNCOUPLED_ROUNDS = 2 };

/* The scale of the forces before any motion. */
static void set_scale(mhb_integrator *g) {
  g->scale = 0;
  for (int a = 0; a < g->pairs; a++) g->scale = fmax(g->scale, fabs(g->law[a].n0));
}

/* Nothing remains of the motion before, so a point of a sweep does not depend on the others. */
static void clear_state(mhb_integrator *g) {
  set_scale(g);
  memset(g->z, 0, sizeof(double) * 2 * (size_t)(g->blades * g->modes));
  for (int j = 0; j < g->contacts; j++) memset(&g->point[j], 0, sizeof g->point[j]);
  g->count = (mhb_integrator_count){0};
}

/* q, q' [2][modes] += harmonic k at phase 0 of all modes of a blade, amplitudes a. */
static void add_harmonic(const mhb_integrator *g, int k, const double complex *a, double *q) {
  const double complex rate = I * (k * SHB_TWO_PI / g->period);
  for (int i = 0; i < g->modes; i++) {
    q[i] += creal(a[i]);
    q[g->modes + i] += creal(rate * a[i]);
  }
}

/* The state of a blade += sign times that of q, q' [2][modes]. */
static void add_state(mhb_integrator *g, int blade, double sign, double *q) {
  const int m = g->modes;
  if (g->ring.amplitudes) mhb_amplitudes_take(g->ring.amplitudes, q, q + m);
  for (int i = 0; i < 2 * m; i++) g->z[(i / m * g->blades + blade) * m + i % m] += sign * q[i];
}

/* z, z' += sign times the steady response without contact forces. */
static void add_free_response(mhb_integrator *g, double sign) {
  const mhb_receptance *r = g->receptance;
  const int             m = g->modes;
  double complex        a[m];
  double                q[2 * m];
  for (int b = 0; b < g->blades; b++) {
    memset(q, 0, sizeof q);
    for (int k = 0; k <= g->n_load; k += r->nu) {
      const double complex load = r->scale * cexp(-I * k * mhb_integrator_lag(g, b));
      for (int i = 0; i < m; i++) a[i] = load * r->F[k * m + i];
      mhb_receptance_respond(r, k, a);
      add_harmonic(g, k, a, q);
    }
    add_state(g, b, sign, q);
  }
}

/* w[3 contacts] <- motion at z without contact forces. */
static void set_unloaded_motion(const mhb_integrator *g, double *w) {
  int n3 = 3 * g->pairs, m = g->modes, lines = g->ring.lines;
  memset(w, 0, sizeof(double) * 3 * (size_t)g->contacts);
  for (int b = 0; b < g->blades; b++) {
    mhb_integrator_free(g, b, 0, w + b * n3);
    for (int side = 0; side < g->ring.s.sides; side++) {
      const double *motion = g->ring.motion + side * n3 * lines;
      double       *at     = w + 3 * mhb_modal_structure_contact(&g->ring.s, b, side);
      for (int k = 0; k < n3 * lines; k++) {
        const int i = k % lines;
        at[k / lines] += motion[k] * g->z[(i / m * g->blades + b) * m + i % m];
      }
    }
  }
}

/* Contact j with the forces of the others as they are. The normal law is solved with the contact's
 * own flexibility R_vv; friction is cut down to its limit. Returns whether anything changed. */
static bool settle_contact(mhb_integrator *g, int j, const double *w) {
  const mhb_law     *law    = &g->law[j % g->pairs];
  const double      *R      = g->ring.s.flexibility;
  int                n      = 3 * g->contacts;
  mhb_contact_point *point  = &g->point[j];
  mhb_contact_point  before = *point;
  for (int c = 0; c < 3; c++) {
    point->u[c] = w[3 * j + c];
    for (int k = 0; R && k < n; k++)
      point->u[c] -= R[(3 * j + c) * n + k] * g->point[k / 3].p[k % 3];
  }
  double R_vv = R ? R[3 * j * n + 3 * j] : 0;
  double free = point->u[0] + R_vv * point->p[0]; /* without its own normal force */
  double load =
      fmax(0, (law->n0 + law->kv * (free + R_vv * law->mean_offset)) / (1 + law->kv * R_vv));
  double limit = law->mu * load, friction = hypot(point->p[1], point->p[2]);
  point->p[0] = load - law->mean_offset;
  point->u[0] = free - R_vv * point->p[0];
  for (int c = 1; c < 3 && friction > limit; c++) point->p[c] *= limit / friction;
  for (int c = 0; c < 3; c++)
    if (point->u[c] != before.u[c] || point->p[c] != before.p[c]) return true;
  return false;
}

/* Motion, forces and states of the contacts at z: Gauss-Seidel rounds over the contacts until
 * nothing changes. Every closed contact begins stuck. */
static void settle_contacts(mhb_integrator *g) {
  double *w       = g->y;
  int     rounds  = g->ring.s.flexibility ? MAX_ROUNDS : UNCOUPLED_ROUNDS;
  bool    changed = true;
  set_unloaded_motion(g, w);
  for (int round = 0; round < rounds && changed; round++) {
    changed = false;
    for (int j = 0; j < g->contacts; j++)
      if (settle_contact(g, j, w)) changed = true;
  }
  for (int j = 0; j < g->contacts; j++) {
    const mhb_law     *law   = &g->law[j % g->pairs];
    mhb_contact_point *point = &g->point[j];
    bool               open  = !(point->p[0] + law->mean_offset > 0);
    point->state             = MHB_STICK;
    mhb_contact_step_change(law, open ? MHB_SEPARATE : MHB_STICK, 0, point);
    for (int c = 0; c < 3; c++) g->scale = fmax(g->scale, fabs(point->p[c]));
    g->n_stalled[j] = g->suppressed[j] = 0;
  }
}

static void set_laws(mhb_integrator *g, double n0) {
  const mhb_settings *s  = &g->settings;
  mhb_operating_point at = mhb_operating_point_of(s);
  at.n0 = g->n0 = n0;
  for (int a = 0; a < g->pairs; a++) {
    mhb_operating_point own = mhb_interface_operating_point(&at, s, g->receptance->interface[a]);
    mhb_law             law = mhb_operating_point_law(&own, s->preload, g->receptance->share[a]);
    g->law[a]               = mhb_contact_step_law(&law);
  }
  set_scale(g);
}

void mhb_integrator_set(mhb_integrator *g, double omega, double n0, int steps) {
  bool has_state = g->period > 0;
  if (has_state) add_free_response(g, 1);
  g->omega  = omega;
  g->period = SHB_TWO_PI * g->settings.subharmonics / omega;
  g->steps  = steps;
  g->t      = 0;
  set_laws(g, n0);
  mhb_receptance_at(g->receptance, omega, g->n_harmonics);
  if (g->joint) {
    mhb_modal_step_modes(&g->ring, g->period / steps, &g->nominal);
    mhb_joint_step_set(g->joint, &g->nominal, g->law);
  } else {
    mhb_modal_step_length(&g->ring, g->period / steps, &g->nominal);
  }
  g->cut.h = NAN;
  if (!has_state) return;
  add_free_response(g, -1);
  settle_contacts(g);
}

void mhb_integrator_rest(mhb_integrator *g) {
  clear_state(g);
  add_free_response(g, -1);
  settle_contacts(g);
}

/* a[modes] <- response of a wave to contact forces p at harmonic k. */
static void respond_to(const mhb_integrator *g, int k, const double complex *p, double complex *a) {
  const mhb_receptance *r = g->receptance;
  for (int i = 0; i < g->modes; i++) {
    a[i] = 0;
    for (int row = 0; row < r->n; row++)
      a[i] -= conj(r->B[(k * r->n + row) * g->modes + i]) * p[row];
  }
  mhb_receptance_respond(r, k, a);
}

void mhb_integrator_balance(mhb_integrator *g, int n_harmonics, const double complex *force) {
  const int      n = g->receptance->n, m = g->modes, last = n_harmonics;
  double complex a[m], turned[m];
  double         q[2 * m];
  clear_state(g);
  for (int b = 0; b < g->blades; b++) {
    memset(q, 0, sizeof q);
    for (int k = 0; k <= last && k <= g->n_harmonics; k++) {
      const double complex *p    = force + (size_t)(k * n),
                           phase = cexp(-I * k * mhb_integrator_lag(g, b));
      respond_to(g, k, p, a);
      for (int i = 0; i < m; i++) turned[i] = phase * a[i];
      add_harmonic(g, k, turned, q);
      for (int row = 0; row < n; row++)
        g->point[b * g->pairs + row / 3].p[row % 3] += creal(p[row] * phase);
    }
    add_state(g, b, 1, q);
  }
  settle_contacts(g);
}

/* ---- the state as numbers ---- */

int mhb_integrator_size(const mhb_integrator *g) {
  return 2 * g->blades * g->modes + 2 * g->contacts;
}

void mhb_integrator_get(const mhb_integrator *g, double *state) {
  int n = 2 * g->blades * g->modes;
  memcpy(state, g->z, sizeof(double) * (size_t)n);
  for (int k = 0; k < 2 * g->contacts; k++) state[n + k] = g->point[k / 2].p[1 + k % 2];
}
