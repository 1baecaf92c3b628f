#include "mhb/balance/modal_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/balance/ring_condensation.h"
#include "mhb/numerics/lu.h"
#include "mhb/numerics/vector.h"

/* Most axes of linear pairs whose harmonics are solved one by one: 20 pairs. */
enum { MOST_SOLVED = 60 };

/* A change longer than this part of the vibration is checked for the curvature. */
static const double LONG = 0.02;

/* The two parts of e_k, added as if orthogonal. */
typedef enum { BY_LOAD, BY_CONTACT, PARTS } part;

/* Rest of the residual series at w relative to its last term, by the estimated error of the worst
 * dof. Without an estimate: (w/w_m)^2, w_m the highest mode. */
static double series_ratio(const modal_model *model, double w) {
  const int    n     = 3 * model->n_pairs * (model->has_left ? 2 : 1);
  const double top   = SHB_TWO_PI * model->frequency[model->n_modes - 1];
  double       worst = 0, weight = modal_series_at(model, w).weight[2];
  for (int i = 0; i < n; i++) {
    double error = modal_series_error(model, w, i);
    if (error < 0) return w * w / (top * top);
    double term = weight * modal_series_diagonal(model, 2, i);
    if (term > 0) worst = fmax(worst, error / term);
  }
  return worst;
}

/* Number of the last term that the model has. */
static int last_term(void *const term[MODAL_TERMS]) {
  int t = MODAL_TERMS - 1;
  while (t > 0 && !term[t]) t--;
  return t;
}

/* to[n] <- what the motion of one structure lacks at harmonic k, by the forces p[n]; NULL: by its
 * load. */
static void missing_motion(const mhb_receptance *r, int k, double ratio, const double complex *p,
                           double complex *to) {
  const mhb_residual_terms *terms = r->residual_terms;
  const modal_series        s = modal_series_at(mhb_receptance_model(r, k), k * r->omega / r->nu);
  const int                 t = last_term(terms->own[0] ? (void *const *)terms->own
                                                        : (void *const *)terms->contact),
            u                 = last_term((void *const *)terms->load);
  memset(to, 0, sizeof *to * (size_t)r->n);
  if (p) mhb_residual_terms_add_product(terms, t, k, -ratio * s.weight[t], p, to);
  for (int i = 0; i < r->n && !p && terms->load[u]; i++)
    to[i] = ratio * s.load_weight[u] * r->scale * terms->load[u][k * r->n + i];
}

/* The same of all blades of a ring, to[n]. */
static void missing_in_ring(const mhb_ring_receptance *g, int k, double ratio,
                            const double complex *p, double complex *to) {
  double complex force[2 * g->n], motion[2 * g->n];
  memset(to, 0, sizeof *to * (size_t)g->blades * (size_t)g->n);
  for (int i = 0; i < g->blades; i++) {
    missing_motion(g->blade[i], k, ratio, mhb_ring_forces_of_blade(g, i, p, force), motion);
    mhb_ring_add_blade(g, i, motion, to);
  }
}

/* One part of e[k][n]; ratio[k] by series_ratio. */
static void set_missing_motion(const mhb_balance *b, const double *ratio, part by,
                               double complex *e) {
  const mhb_receptance *r = b->receptance;
  double complex        p[3 * b->n_pairs];
  for (int k = 1; k <= b->m; k++) {
    const double complex *on = by == BY_CONTACT ? p : NULL;
    double complex       *to = e + k * 3 * b->n_pairs;
    if (on) mhb_balance_contact_force(b, k, p);
    if (r->ring)
      missing_in_ring(r->ring, k, ratio[k], on, to);
    else
      missing_motion(r, k, ratio[k], on, to);
  }
}

static double norm_of(int n, const double complex *e) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += creal(e[i]) * creal(e[i]) + cimag(e[i]) * cimag(e[i]);
  return sqrt(sum);
}

/* |du| by the condensed balance with twice the harmonics, for e[k][n]. */
static double solve_by_system(const mhb_balance *b, mhb_truncation *t, double size,
                              const double complex *e) {
  const mhb_balance *larger = t->doubled;
  const int          n      = 3 * b->n_pairs;
  double            *du     = calloc((size_t)larger->n, sizeof *du);
  double             length = 0;
  for (int k = 1; du && k <= b->m; k++)
    for (int i = 0; i < n; i++) {
      du[(size_t)i * (size_t)larger->nb + (size_t)(2 * k - 1)] = creal(e[k * n + i]);
      du[(size_t)i * (size_t)larger->nb + (size_t)(2 * k)]     = cimag(e[k * n + i]);
    }
  if (du && mhb_truncation_solve(t, du)) length = mhb_norm(du, larger->n);
  if (length > LONG * size) length *= fmin(1, mhb_truncation_part(t, du));
  free(du);
  return length;
}

/* e[k][n] <- du where all pairs are linear, harmonic by harmonic. */
static void solve_by_harmonic(const mhb_balance *b, double complex *A, int *pivot,
                              double complex *e) {
  const int     n = 3 * b->n_pairs;
  mhb_pair_kind kind[b->n_pairs];
  for (int a = 0; a < b->n_pairs; a++)
    kind[a] = b->eval->info[a].share[MHB_STICK] >= 1 ? MHB_PAIR_STUCK : MHB_PAIR_OPEN;
  for (int k = 1; k <= b->m; k++) {
    if (!(norm_of(n, e + k * n) > 0)) continue;
    mhb_receptance_update(b->receptance, k);
    if (b->receptance->ring) {
      if (mhb_ring_linear_limit(b->receptance->ring, b->law, k, kind, e + k * n) != SHB_OK) return;
      continue;
    }
    mhb_stick_matrix(b->n_pairs, b->law, kind, k,
                     b->receptance->R + (size_t)k * (size_t)n * (size_t)n, A);
    if (mhb_factor_complex(n, A, pivot)) mhb_solve_complex(n, A, pivot, 1, e + k * n);
  }
}

double mhb_modal_error(const mhb_balance *b, const double *x, mhb_truncation *t) {
  const mhb_receptance *r   = b->receptance;
  const mhb_receptance *one = r->ring ? r->ring->blade[0] : r; /* what residual terms are of */
  const int             n = r->n, all = (b->m + 1) * n;
  const bool            linear = !t && (r->ring || n <= MOST_SOLVED) && mhb_balance_is_linear(b);
  const double          size   = mhb_balance_vibration(b, x);
  double                ratio[b->m + 1], sum = 0;
  int                   pivot[n];
  if (!one->residual_terms->contact[0] && !one->residual_terms->own[0]) return -1;
  double complex *e =
      calloc((size_t)all + (linear && !r->ring ? (size_t)n * (size_t)n : 0), sizeof *e);
  if (!e || !(size > 0)) {
    free(e);
    return e ? 0 : -1;
  }
  for (int k = 1; k <= b->m; k++)
    ratio[k] = series_ratio(mhb_receptance_model(one, k), k * r->omega / r->nu);
  for (part by = 0; by < PARTS; by++) {
    set_missing_motion(b, ratio, by, e);
    if (linear) solve_by_harmonic(b, e + all, pivot, e);
    sum = hypot(sum, t ? solve_by_system(b, t, size, e) : norm_of(all, e));
  }
  free(e);
  return sum / size;
}
