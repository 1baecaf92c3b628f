#include "mhb/variation/linearised_law.h"

#include <math.h>
#include <string.h>

#include "mhb/contact/slip.h"

/* Terms of slip by its direction; header for the symbols. */
typedef struct {
  double e[2], q[2], beta, beta_theta;
  double across[2]; /* (q - beta e)^T Ku */
  double Ke[2], eKe;
  double gamma, theta_rate, kappa;
} slip_terms;

static void times_ku(const double ku[3], const double x[2], double y[2]) {
  y[0] = ku[0] * x[0] + ku[1] * x[1];
  y[1] = ku[1] * x[0] + ku[2] * x[1];
}

static double dot2(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1];
}

static slip_terms terms_of(const mhb_contact_state *point) {
  const mhb_law *law = point->law;
  slip_terms     t   = {.e = {point->e[0], point->e[1]}, .q = {-point->e[1], point->e[0]}};
  double         x[2], Kq[2], n = law->kv * point->rate[0], limit = law->mu * point->n;
  times_ku(law->ku, t.e, t.Ke);
  times_ku(law->ku, t.q, Kq);
  times_ku(law->ku, point->rate + 1, x);
  t.eKe        = dot2(t.e, t.Ke);
  t.beta       = dot2(t.q, t.Ke) / t.eKe;
  t.beta_theta = (dot2(t.q, Kq) - t.eKe) / t.eKe - 2 * t.beta * t.beta;
  for (int i = 0; i < 2; i++) t.across[i] = Kq[i] - t.beta * t.Ke[i];
  t.gamma = dot2(t.e, x) - law->mu * n;
  if (limit > 0) {
    t.theta_rate = (dot2(t.q, x) - t.beta * t.gamma) / limit;
    t.kappa      = (t.gamma * (1 + t.beta_theta) + t.beta * dot2(t.q, x)) / limit;
  }
  return t;
}

static void stick_law(const mhb_law *law, mhb_linearised_law *r) {
  const double K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  for (int i = 0; i < 2; i++) {
    r->mean_y[1 + i][1 + i] = r->state_y[i][1 + i] = 1;
    for (int k = 0; k < 2; k++)
      r->mean_du[1 + i][1 + k] = r->df_du[1 + i][1 + k] = r->state_du[i][1 + k] = K[i][k];
  }
}

/* Midpoint rule: mean of tau = T.y + M.D/2, mean force = mu (mean dn) e + (mean tau) q. */
static void slip_law(const mhb_contact_state *point, double h, mhb_linearised_law *r) {
  const mhb_law *law   = point->law;
  slip_terms     t     = terms_of(point);
  double         mu_kv = law->mu * law->kv, angle = h * t.theta_rate;
  double         relaxation = 1 / (1 + 0.5 * fmax(h * t.kappa, -1.8));
  double         T[3]       = {-0.5 * relaxation * angle * mu_kv, relaxation, 0};
  double         M[3] = {relaxation * (t.beta - 0.5 * angle) * mu_kv, relaxation * t.across[0],
                         relaxation * t.across[1]};
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++) {
      double along = k == 0 ? mu_kv : 0, before = k == 1;
      r->mean_y[1 + i][k]  = along * t.e[i] + T[k] * t.q[i];
      r->mean_du[1 + i][k] = along * t.e[i] + M[k] * t.q[i];
      r->df_y[1 + i][k]    = (2 * (T[k] - before) + angle * along) * t.q[i] - angle * T[k] * t.e[i];
      r->df_du[1 + i][k] =
          (M[k] + 0.5 * angle * along) * t.q[i] + (along - 0.5 * angle * M[k]) * t.e[i];
    }
  }
  for (int k = 0; k < 3; k++) {
    r->state_y[0][k]  = 2 * T[k] - (k == 1);
    r->state_du[0][k] = M[k];
  }
}

void mhb_linearised_law_at(const mhb_contact_state *point, double h, mhb_linearised_law *r) {
  memset(r, 0, sizeof *r);
  if (point->state == MHB_SEPARATE) return;
  r->mean_y[0][0] = r->mean_du[0][0] = r->df_du[0][0] = point->law->kv;
  if (point->law->mu == 0) return;
  if (point->state == MHB_STICK) stick_law(point->law, r);
  if (point->state == MHB_SLIDE) slip_law(point, h, r);
}

static void jump_from_open(const mhb_contact_state *point, mhb_saltation *jump) {
  double x[2];
  times_ku(point->law->ku, point->rate + 1, x);
  for (int i = 0; i < 2; i++) jump->set[i][0] = x[i] / point->rate[0]; /* dn/n' = dv/v' */
}

static void jump_to_slip(const mhb_contact_state *point, mhb_saltation *jump) {
  slip_terms t    = terms_of(point);
  jump->set[0][0] = t.beta * point->law->mu * point->law->kv;
  for (int k = 0; k < 2; k++) jump->set[0][1 + k] = t.q[k] - t.beta * t.e[k];
}

static void jump_to_stick(const mhb_contact_state *point, mhb_saltation *jump) {
  const double *e = point->e, q[2] = {-e[1], e[0]};
  for (int i = 0; i < 2; i++) {
    jump->set[i][0] = point->law->mu * point->law->kv * e[i];
    jump->set[i][1] = q[i];
  }
}

void mhb_saltation_at(const mhb_contact_state *point, mhb_state to, mhb_saltation *jump) {
  memset(jump->set, 0, sizeof jump->set);
  if (to == MHB_SEPARATE || point->law->mu == 0) return;
  if (point->state == MHB_SEPARATE) {
    if (to == MHB_STICK) jump_from_open(point, jump);
  } else if (to == MHB_SLIDE) {
    jump_to_slip(point, jump);
  } else {
    jump_to_stick(point, jump);
  }
}

/* f' = Ku s' - Ku e (e.Ku s' - mu n')/(e.Ku e);  where n = 0 friction can only increase along e. */
static void slip_rate(const mhb_contact_state *point, double G[3][3]) {
  slip_terms    t  = terms_of(point);
  const double *ku = point->law->ku, K[2][2] = {{ku[0], ku[1]}, {ku[1], ku[2]}};
  double        mu_kv = point->law->mu * point->law->kv;
  for (int i = 0; i < 2; i++) {
    double share = point->n > 0 ? t.Ke[i] / t.eKe : t.e[i];
    G[1 + i][0]  = share * mu_kv;
    for (int k = 0; k < 2 && point->n > 0; k++) G[1 + i][1 + k] = K[i][k] - share * t.Ke[k];
  }
}

void mhb_linearised_law_rate(const mhb_contact_state *point, double G[3][3]) {
  memset(G, 0, sizeof(double) * 9);
  if (point->state == MHB_SEPARATE) return;
  const mhb_law *law = point->law;
  G[0][0]            = law->kv;
  if (law->mu == 0) return;
  if (point->state == MHB_SLIDE) slip_rate(point, G);
  if (point->state != MHB_STICK) return;
  const double K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++) G[1 + i][1 + k] = K[i][k];
}
