#include "mhb/floquet/linearised_law.h"

#include <math.h>
#include <string.h>

#include "mhb/contact/slip.h"

/* What slip needs to know of its direction. */
typedef struct {
  double e[2], q[2], beta, beta_theta;
  double across[2]; /* (q - beta e)^T Ku */
  double Ke[2], eKe;
  double gamma, turn, kappa; /* turn: theta' */
} slip_terms;

static void times_ku(const double ku[3], const double x[2], double y[2]) {
  y[0] = ku[0] * x[0] + ku[1] * x[1];
  y[1] = ku[1] * x[0] + ku[2] * x[1];
}

static double dot2(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1];
}

static slip_terms terms_of(const mhb_contact_state *touch) {
  const mhb_law *law = touch->law;
  slip_terms     t   = {.e = {touch->e[0], touch->e[1]}, .q = {-touch->e[1], touch->e[0]}};
  double         x[2], Kq[2], n = law->kv * touch->rate[0], limit = law->mu * touch->n;
  times_ku(law->ku, t.e, t.Ke);
  times_ku(law->ku, t.q, Kq);
  times_ku(law->ku, touch->rate + 1, x);
  t.eKe        = dot2(t.e, t.Ke);
  t.beta       = dot2(t.q, t.Ke) / t.eKe;
  t.beta_theta = (dot2(t.q, Kq) - t.eKe) / t.eKe - 2 * t.beta * t.beta;
  for (int i = 0; i < 2; i++) t.across[i] = Kq[i] - t.beta * t.Ke[i];
  t.gamma = dot2(t.e, x) - law->mu * n;
  if (limit > 0) {
    t.turn  = (dot2(t.q, x) - t.beta * t.gamma) / limit;
    t.kappa = (t.gamma * (1 + t.beta_theta) + t.beta * dot2(t.q, x)) / limit;
  }
  return t;
}

static void stick_relation(const mhb_law *law, mhb_linearised_law *r) {
  const double K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  for (int i = 0; i < 2; i++) {
    r->a[1 + i][1 + i] = r->keep[i][1 + i] = 1;
    for (int k = 0; k < 2; k++)
      r->hold[1 + i][1 + k] = r->grow[1 + i][1 + k] = r->gain[i][1 + k] = K[i][k];
  }
}

/* Midpoint rule: tau mean = T.y + M.D/2,  mean force (along) mu n mean e + tau mean q. */
static void slip_relation(const mhb_contact_state *touch, double h, mhb_linearised_law *r) {
  const mhb_law *law   = touch->law;
  slip_terms     t     = terms_of(touch);
  double         mu_kv = law->mu * law->kv, turn = h * t.turn;
  double         ease = 1 / (1 + 0.5 * fmax(h * t.kappa, -1.8));
  double         T[3] = {-0.5 * ease * turn * mu_kv, ease, 0};
  double M[3] = {ease * (t.beta - 0.5 * turn) * mu_kv, ease * t.across[0], ease * t.across[1]};
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++) {
      double along = k == 0 ? mu_kv : 0, before = k == 1;
      r->a[1 + i][k]    = along * t.e[i] + T[k] * t.q[i];
      r->hold[1 + i][k] = along * t.e[i] + M[k] * t.q[i];
      r->b[1 + i][k]    = (2 * (T[k] - before) + turn * along) * t.q[i] - turn * T[k] * t.e[i];
      r->grow[1 + i][k] =
          (M[k] + 0.5 * turn * along) * t.q[i] + (along - 0.5 * turn * M[k]) * t.e[i];
    }
  }
  for (int k = 0; k < 3; k++) {
    r->keep[0][k] = 2 * T[k] - (k == 1);
    r->gain[0][k] = M[k];
  }
}

void mhb_linearised_law_at(const mhb_contact_state *touch, double h, mhb_linearised_law *r) {
  memset(r, 0, sizeof *r);
  if (touch->state == MHB_SEPARATE) return;
  r->a[0][0] = r->hold[0][0] = r->grow[0][0] = touch->law->kv;
  if (touch->law->mu == 0) return;
  if (touch->state == MHB_STICK) stick_relation(touch->law, r);
  if (touch->state == MHB_SLIDE) slip_relation(touch, h, r);
}

static void jump_from_open(const mhb_contact_state *touch, mhb_saltation *jump) {
  double x[2];
  times_ku(touch->law->ku, touch->rate + 1, x);
  for (int i = 0; i < 2; i++) jump->set[i][0] = x[i] / touch->rate[0]; /* dn/n' = dv/v' */
}

static void jump_to_slip(const mhb_contact_state *touch, mhb_saltation *jump) {
  slip_terms t    = terms_of(touch);
  jump->set[0][0] = t.beta * touch->law->mu * touch->law->kv;
  for (int k = 0; k < 2; k++) jump->set[0][1 + k] = t.q[k] - t.beta * t.e[k];
}

static void jump_to_stick(const mhb_contact_state *touch, mhb_saltation *jump) {
  const double *e = touch->e, q[2] = {-e[1], e[0]};
  for (int i = 0; i < 2; i++) {
    jump->set[i][0] = touch->law->mu * touch->law->kv * e[i];
    jump->set[i][1] = q[i];
  }
}

void mhb_saltation_at(const mhb_contact_state *touch, mhb_state to, mhb_saltation *jump) {
  memset(jump->set, 0, sizeof jump->set);
  if (to == MHB_SEPARATE || touch->law->mu == 0) return;
  if (touch->state == MHB_SEPARATE) {
    if (to == MHB_STICK) jump_from_open(touch, jump);
  } else if (to == MHB_SLIDE) {
    jump_to_slip(touch, jump);
  } else {
    jump_to_stick(touch, jump);
  }
}

/* f' = Ku s' - Ku e (e.Ku s' - mu n')/(e.Ku e);  where n = 0 the friction can only grow along e. */
static void slip_rate(const mhb_contact_state *touch, double G[3][3]) {
  slip_terms    t  = terms_of(touch);
  const double *ku = touch->law->ku, K[2][2] = {{ku[0], ku[1]}, {ku[1], ku[2]}};
  double        mu_kv = touch->law->mu * touch->law->kv;
  for (int i = 0; i < 2; i++) {
    double share = touch->n > 0 ? t.Ke[i] / t.eKe : t.e[i];
    G[1 + i][0]  = share * mu_kv;
    for (int k = 0; k < 2 && touch->n > 0; k++) G[1 + i][1 + k] = K[i][k] - share * t.Ke[k];
  }
}

void mhb_linearised_law_rate(const mhb_contact_state *touch, double G[3][3]) {
  memset(G, 0, sizeof(double) * 9);
  if (touch->state == MHB_SEPARATE) return;
  const mhb_law *law = touch->law;
  G[0][0]            = law->kv;
  if (law->mu == 0) return;
  if (touch->state == MHB_SLIDE) slip_rate(touch, G);
  if (touch->state != MHB_STICK) return;
  const double K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++) G[1 + i][1 + k] = K[i][k];
}
