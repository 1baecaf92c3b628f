/* How an integration starts, and goes on at another frequency or from other numbers. */
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/problem/interfaces.h"

/* q_free and its rate at phase 0, times sign, to z. */
static void add_free_modes(mhb_integrator *g, double sign) {
  const mhb_receptance *r = g->receptance;
  for (int k = 0; k <= g->n_load; k += r->nu)
    for (int b = 0; b < g->blades; b++) {
      double complex turn = cexp(-I * k * mhb_integrator_lag(g, b)),
                     rate = I * (k * SHB_TWO_PI / g->period);
      for (int i = 0; i < g->modes; i++) {
        double complex a = r->lambda[k * g->modes + i] * r->F[k * g->modes + i] * turn;
        g->z[b * g->modes + i] += sign * creal(a);
        g->z[(g->blades + b) * g->modes + i] += sign * creal(rate * a);
      }
    }
}

/* u and p that belong to z; friction stays, but for its limit. */
static void settle(mhb_integrator *g) {
  const double *R = g->chain.s.flexibility;
  int           n = 3 * g->contacts, n3 = 3 * g->pairs, m = g->modes;
  double       *w = g->y; /* [n] motion without contact forces */
  memset(w, 0, sizeof(double) * (size_t)n);
  for (int b = 0; b < g->blades; b++) {
    mhb_integrator_free(g, b, 0, w + b * n3);
    for (int side = 0; side < g->chain.s.sides; side++) {
      const double *shape = g->chain.shape + side * n3 * m;
      double       *at    = w + 3 * mhb_modal_structure_contact(&g->chain.s, b, side);
      for (int k = 0; k < n3 * m; k++) at[k / m] += shape[k] * g->z[b * m + k % m];
    }
  }
  for (int round = 0; round < (R ? 400 : 2); round++)
    for (int j = 0; j < g->contacts; j++) {
      const mhb_law     *law = &g->law[j % g->pairs];
      mhb_contact_point *rub = &g->rub[j];
      for (int c = 0; c < 3; c++) {
        rub->u[c] = w[3 * j + c];
        for (int k = 0; R && k < n; k++)
          rub->u[c] -= R[(3 * j + c) * n + k] * g->rub[k / 3].p[k % 3];
      }
      double own  = R ? R[3 * j * n + 3 * j] : 0;
      double free = rub->u[0] + own * rub->p[0]; /* without its own normal force */
      double load =
          fmax(0, (law->n0 + law->kv * (free + own * law->mean_offset)) / (1 + law->kv * own));
      double limit = law->mu * load, friction = hypot(rub->p[1], rub->p[2]);
      rub->p[0] = load - law->mean_offset;
      rub->u[0] = free - own * rub->p[0];
      for (int c = 1; c < 3 && friction > limit; c++) rub->p[c] *= limit / friction;
    }
  for (int j = 0; j < g->contacts; j++) {
    const mhb_law     *law = &g->law[j % g->pairs];
    mhb_contact_point *rub = &g->rub[j];
    rub->state             = MHB_STICK;
    mhb_contact_step_change(law, rub->p[0] + law->mean_offset > 0 ? MHB_STICK : MHB_SEPARATE, 0,
                            rub);
    for (int c = 0; c < 3; c++) g->scale = fmax(g->scale, fabs(rub->p[c]));
    g->idle[j] = g->hush[j] = 0;
  }
}

static void set_laws(mhb_integrator *g, double n0) {
  const mhb_settings *s  = &g->settings;
  mhb_operating_point at = mhb_operating_point_of(s);
  at.n0 = g->n0 = n0;
  g->scale      = 0;
  for (int a = 0; a < g->pairs; a++) {
    mhb_operating_point own = mhb_interface_operating_point(&at, s, g->receptance->interface[a]);
    mhb_law             law = mhb_operating_point_law(&own, s->preload, g->receptance->share[a]);
    g->law[a]               = mhb_contact_step_law(&law);
    g->scale                = fmax(g->scale, fabs(law.n0));
  }
}

void mhb_integrator_set(mhb_integrator *g, double omega, double n0, int steps) {
  int known = g->period > 0;
  if (known) add_free_modes(g, 1);
  g->omega  = omega;
  g->period = SHB_TWO_PI * g->settings.subharmonics / omega;
  g->steps  = steps;
  g->t      = 0;
  set_laws(g, n0);
  mhb_receptance_at(g->receptance, omega, g->n_harmonics);
  mhb_modal_step_length(&g->chain, g->period / steps, &g->nominal);
  g->cut.h = NAN;
  if (!known) return;
  add_free_modes(g, -1);
  settle(g);
}

void mhb_integrator_rest(mhb_integrator *g) {
  memset(g->z, 0, sizeof(double) * 2 * (size_t)(g->blades * g->modes));
  for (int j = 0; j < g->contacts; j++) memset(&g->rub[j], 0, sizeof g->rub[j]);
  g->count = (mhb_integrator_count){0};
  add_free_modes(g, -1);
  settle(g);
}

void mhb_integrator_balance(mhb_integrator *g, int n_harmonics, const double complex *force) {
  const mhb_receptance *r = g->receptance;
  memset(g->z, 0, sizeof(double) * 2 * (size_t)(g->blades * g->modes));
  for (int j = 0; j < g->contacts; j++) memset(&g->rub[j], 0, sizeof g->rub[j]);
  g->count = (mhb_integrator_count){0};
  for (int k = 0; k <= n_harmonics && k <= g->n_harmonics; k++) {
    const double complex *p = force + (size_t)(k * r->n);
    for (int b = 0; b < g->blades; b++) {
      double complex turn = cexp(-I * k * mhb_integrator_lag(g, b)),
                     rate = I * (k * SHB_TWO_PI / g->period);
      for (int i = 0; i < g->modes; i++) {
        double complex a = 0;
        for (int row = 0; row < r->n; row++)
          a -= conj(r->B[(k * r->n + row) * g->modes + i]) * p[row];
        a *= r->lambda[k * g->modes + i] * turn;
        g->z[b * g->modes + i] += creal(a);
        g->z[(g->blades + b) * g->modes + i] += creal(rate * a);
      }
      for (int row = 0; row < r->n; row++)
        g->rub[b * g->pairs + row / 3].p[row % 3] += creal(p[row] * turn);
    }
  }
  settle(g);
}

/* ---- the state as numbers ---- */

int mhb_integrator_size(const mhb_integrator *g) {
  return 2 * g->blades * g->modes + 2 * g->contacts;
}

void mhb_integrator_get(const mhb_integrator *g, double *state) {
  int n = 2 * g->blades * g->modes;
  memcpy(state, g->z, sizeof(double) * (size_t)n);
  for (int k = 0; k < 2 * g->contacts; k++) state[n + k] = g->rub[k / 2].p[1 + k % 2];
}

void mhb_integrator_put(mhb_integrator *g, const double *state) {
  int n = 2 * g->blades * g->modes;
  memcpy(g->z, state, sizeof(double) * (size_t)n);
  for (int k = 0; k < 2 * g->contacts; k++) g->rub[k / 2].p[1 + k % 2] = state[n + k];
  g->t = 0;
  settle(g);
}
