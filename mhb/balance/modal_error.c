#include "mhb/balance/modal_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/balance/ring_condensation.h"
#include "mhb/numerics/lu.h"
#include "mhb/numerics/vector.h"

/* Most axes of linear pairs whose harmonics are solved one by one: 20 pairs. */
enum { MOST_SOLVED = 60 };

/* A change longer than this part of the vibration is checked for the curvature. Where a pair of
 * z_notch_blade begins to slip a length of 1.6e-2 falls to 5e-4 by that. */
static const double LONG = 2e-3;

/* The shape of what is missing: of the last residual term, or of the one before it. */
typedef enum { LAST, BEFORE, SHAPES } shape;

/* Rest of the residual series at w relative to its last term, by the estimated error of the worst
 * dof. Without an estimate: (w/w_m)^2, w_m the highest mode. */
static double series_ratio(const modal_model *model, double w) {
  const int    n     = 3 * model->n_pairs * (model->has_left ? 2 : 1);
  const double top   = SHB_TWO_PI * model->frequency[model->n_modes - 1];
  double       worst = 0, weight = modal_series_at(model, w).weight[2];
  for (int i = 0; i < n; i++) {
    double error = modal_series_error(model, w, i);
    if (error < 0) return top > 0 ? w * w / (top * top) : 1;
    double term = weight * modal_series_diagonal(model, 2, i);
    if (term > 0) worst = fmax(worst, error / term);
  }
  return worst;
}

/* Misfit up to which the modes kept have the damping of mass and stiffness (Rayleigh). */
static const double RAYLEIGH = 0.02;

/* Damping of the modes left out: 2 zeta_i w_i of each is alpha + beta w_i^2 or less. */
typedef struct {
  double alpha, beta;
} mass_and_stiffness;

/* Rayleigh's alpha and beta where the modes kept have that damping. Else the damping ratio is that
 * of the highest: 2 zeta w is concave in w^2 and below its tangent at w_e. */
static mass_and_stiffness damping_beyond(const modal_model *model, double w_e) {
  const int n    = model->n_modes;
  double    s[3] = {0}, t[2] = {0}, misfit = 0;
  bool      damped = n >= 3; /* any two have it */
  for (int i = 0; i < n; i++) {
    const double w = SHB_TWO_PI * model->frequency[i], d = 2 * model->damping_ratio[i] * w;
    damped = damped && d > 0;
    if (!damped) break;
    s[0] += 1 / (d * d);
    s[1] += w * w / (d * d);
    s[2] += w * w * w * w / (d * d);
    t[0] += 1 / d;
    t[1] += w * w / d;
  }
  const double det   = s[0] * s[2] - s[1] * s[1];
  const double alpha = (t[0] * s[2] - t[1] * s[1]) / det, beta = (s[0] * t[1] - s[1] * t[0]) / det;
  for (int i = 0; i < n && damped; i++) {
    const double w = SHB_TWO_PI * model->frequency[i], d = 2 * model->damping_ratio[i] * w;
    misfit = fmax(misfit, fabs((alpha + beta * w * w) / d - 1));
  }
  const double zeta = model->damping_ratio[n - 1];
  if (damped && misfit < RAYLEIGH) return (mass_and_stiffness){alpha, beta};
  return (mass_and_stiffness){zeta * w_e, w_e > 0 ? zeta / w_e : 0};
}

/* The residual terms are of modes without damping. With it a mode has 1/w_i^2 (1 - 2 j zeta_i w/w_i
 * + ...): the loss of all modes left out at w, by the first two terms. w_e: that of their first two
 * terms, or the last mode kept. */
static void set_missing_loss(const modal_model *model, double w, bool has_second, double loss[2]) {
  const int n      = 3 * model->n_pairs * (model->has_left ? 2 : 1);
  double    square = pow(SHB_TWO_PI * model->frequency[model->n_modes - 1], 2), most[2] = {0, 0};
  for (int i = 0; i < n && modal_series_has_fourth(model); i++)
    for (int t = 0; t < 2; t++) most[t] = fmax(most[t], modal_series_diagonal(model, t, i));
  if (most[1] > 0) square = fmax(square, most[0] / most[1]);
  const mass_and_stiffness by = damping_beyond(model, sqrt(square));
  loss[0]                     = w * by.beta;
  loss[1]                     = has_second ? w * by.alpha : 0;
  if (!has_second && square > 0) loss[0] += w * by.alpha / square;
}

/* Number of the last term that the model has. */
static int last_term(void *const term[MODAL_TERMS]) {
  int t = MODAL_TERMS - 1;
  while (t > 0 && !term[t]) t--;
  return t;
}

/* Terms t and t - 1 of a series without weights: the sum of the diagonal of one over that of the
 * other. 0: not known. */
static double rate_of_terms(const modal_model *model, int t) {
  const int n    = 3 * model->n_pairs * (model->has_left ? 2 : 1);
  double    last = 0, before = 0;
  if (t < 1 || !modal_series_has_fourth(model)) return 0;
  for (int i = 0; i < n; i++) {
    last += modal_series_diagonal(model, t, i);
    before += modal_series_diagonal(model, t - 1, i);
  }
  return before > 0 ? last / before : 0;
}

/* What is missing of the modes left out at one harmonic. */
typedef struct {
  double ratio;   /* by series_ratio, of their last term */
  double loss[2]; /* of their first two terms */
  double rate;    /* of the last term and the one before */
} missing;

/* to[n] <- what the motion of one structure lacks at harmonic k under its load and the forces p[n].
 * Both parts have the sign that their modes give them. */
static void missing_motion(const mhb_receptance *r, int k, const missing *of, shape as,
                           const double complex *p, double complex *to) {
  const mhb_residual_terms *terms = r->residual_terms;
  const modal_series        s = modal_series_at(mhb_receptance_model(r, k), k * r->omega / r->nu);
  const int                 t = last_term(terms->own[0] ? (void *const *)terms->own
                                                        : (void *const *)terms->contact),
            u                 = last_term((void *const *)terms->load);
  const int      back         = as == BEFORE && of->rate > 0 && t > 0 && u > 0;
  const double   size         = as == BEFORE ? of->ratio * (back ? of->rate : 0) : of->ratio;
  double complex lost[r->n];
  memset(to, 0, sizeof *to * (size_t)r->n);
  memset(lost, 0, sizeof lost);
  mhb_residual_terms_add_product(terms, t - back, k, -size * s.weight[t], p, to);
  for (int i = 0; i < 2 && i <= t; i++)
    mhb_residual_terms_add_product(terms, i, k, of->loss[i], p, lost);
  for (int i = 0; i < r->n && terms->load[u]; i++) {
    to[i] += size * s.load_weight[u] * r->scale * terms->load[u - back][k * r->n + i];
    for (int j = 0; j < 2 && j <= u; j++)
      lost[i] -= of->loss[j] * r->scale * terms->load[j][k * r->n + i];
  }
  for (int i = 0; i < r->n; i++) to[i] += CMPLX(-cimag(lost[i]), creal(lost[i])); /* j lost */
}

/* The same of all blades of a ring, to[n]. */
static void missing_in_ring(const mhb_ring_receptance *g, int k, const missing *of, shape as,
                            const double complex *p, double complex *to) {
  double complex force[2 * g->n], motion[2 * g->n];
  memset(to, 0, sizeof *to * (size_t)g->blades * (size_t)g->n);
  for (int i = 0; i < g->blades; i++) {
    missing_motion(g->blade[i], k, of, as, mhb_ring_forces_of_blade(g, i, p, force), motion);
    mhb_ring_add_blade(g, i, motion, to);
  }
}

/* e[k][n] of one shape; of[k]. */
static void set_missing_motion(const mhb_balance *b, const missing *of, shape as,
                               double complex *e) {
  const mhb_receptance *r = b->receptance;
  double complex        p[3 * b->n_pairs];
  for (int k = 1; k <= b->m; k++) {
    double complex *to = e + k * 3 * b->n_pairs;
    mhb_balance_contact_force(b, k, p);
    if (r->ring)
      missing_in_ring(r->ring, k, &of[k], as, p, to);
    else
      missing_motion(r, k, &of[k], as, p, to);
  }
}

static double norm_of(int n, const double complex *e) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += creal(e[i]) * creal(e[i]) + cimag(e[i]) * cimag(e[i]);
  return sqrt(sum);
}

/* du <- what the condensed balance with twice the harmonics answers to e[k][n]. Returns |du|; 0: it
 * failed. */
static double answer(const mhb_balance *b, mhb_truncation *t, const double complex *e, double *du) {
  const mhb_balance *larger = t->doubled;
  const int          n      = 3 * b->n_pairs;
  memset(du, 0, sizeof *du * (size_t)larger->n);
  for (int k = 1; k <= b->m; k++)
    for (int i = 0; i < n; i++) {
      du[(size_t)i * (size_t)larger->nb + (size_t)(2 * k - 1)] = creal(e[k * n + i]);
      du[(size_t)i * (size_t)larger->nb + (size_t)(2 * k)]     = cimag(e[k * n + i]);
    }
  return mhb_truncation_solve(t, du) ? mhb_norm(du, larger->n) : 0;
}

/* |du|. A long one is solved anew by the linearisation that shortens it. At a fold the balance of m
 * harmonics is singular, that of 2m is not. */
static double solve_by_system(const mhb_balance *b, mhb_truncation *t, double size,
                              const double complex *e) {
  double *du     = shb_alloc_zeroed((size_t)t->doubled->n, sizeof *du);
  double  length = answer(b, t, e, du);
  if (length > LONG * size && mhb_truncation_linearise(t)) length = answer(b, t, e, du);
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
  missing               of[b->m + 1];
  double                sum = 0;
  int                   pivot[n];
  if (!one->residual_terms->contact[0] && !one->residual_terms->own[0]) return -1;
  const int last =
      last_term(one->residual_terms->own[0] ? (void *const *)one->residual_terms->own
                                            : (void *const *)one->residual_terms->contact);
  double complex *e = shb_alloc_zeroed(
      2 * (size_t)all + (linear && !r->ring ? (size_t)n * (size_t)n : 0), sizeof *e);
  if (!(size > 0)) {
    free(e);
    return 0;
  }
  for (int k = 1; k <= b->m; k++) {
    const modal_model *model = mhb_receptance_model(one, k);
    const double       w     = k * r->omega / r->nu;
    of[k] = (missing){.ratio = series_ratio(model, w), .rate = rate_of_terms(model, last)};
    set_missing_loss(model, w, last > 0, of[k].loss);
  }
  for (shape as = LAST; as < SHAPES; as++) set_missing_motion(b, of, as, e + (int)as * all);
  for (int i = 0; i < all; i++) e[all + i] = e[i] - e[all + i];
  for (shape as = LAST; as < SHAPES; as++) {
    double complex *of_shape = e + (int)as * all;
    if (linear) solve_by_harmonic(b, e + 2 * all, pivot, of_shape);
    sum += t ? solve_by_system(b, t, size, of_shape) : norm_of(all, of_shape);
  }
  free(e);
  return sum / size;
}
