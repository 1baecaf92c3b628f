#include "mhb/continuation/linear_resonances.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

/* In half widths: the window resolved around a resonance and the shortest step there; the distance
 * between places assumed between free and stuck. Resonances farther apart than FARTHEST need no
 * places between: the contact motion resolves that change. */
static const double WINDOW = 4, SHORTEST = 0.5, APART = 2, FARTHEST = 32;

/* Longest ratio of two frequencies with one R for the stuck modes of a limit. */
static const double SECTION = 4;

/* Samples of a run-up. A mode that follows the excitation is no wider than by this rate. */
enum { N_SAMPLES = 16 };
static const double LEAST_RATE = 0.1;

/* The eigenproblem of one harmonic. */
typedef struct {
  const mhb_balance *b;
  double             low, high;
  double complex    *R, *A, *X; /* [n][n], [n][n], [n][modes] */
  double complex    *M;         /* [modes][modes] */
  double            *square;    /* [modes] */
  int               *pivot;
} stuck_modes;

static void add(mhb_resonances *s, mhb_resonance place) {
  if (s->n == s->capacity) {
    s->capacity = 2 * s->capacity + 32;
    s->at       = shb_realloc(s->at, (size_t)s->capacity, sizeof *s->at);
  }
  s->at[s->n++] = place;
}

static void add_inside(const stuck_modes *w, mhb_resonances *s, mhb_resonance place) {
  bool inside = place.value > w->low && place.value < w->high;
  if (inside && place.half_width > 0) add(s, place);
}

/* The resonance of free mode i at harmonic k. */
static mhb_resonance free_one(const mhb_receptance *r, int k, int i) {
  const modal_model *model = mhb_receptance_model(r, k);
  double             omega = SHB_TWO_PI * model->frequency[i], turns = (double)r->nu / k;
  if (r->part && r->part->gyroscopic) { /* no single mode: always significant */
    const mhb_gyroscopic *g = mhb_modal_part_gyroscopic(r->part, k);
    if (!g) return (mhb_resonance){.k = k, .mode = -1}; /* nowhere */
    return (mhb_resonance){turns * g->omega[g->n + i], turns * g->decay[g->n + i], k, -1, false};
  }
  return (mhb_resonance){turns * omega, turns * omega * model->damping_ratio[i], k, i, false};
}

/* sum + S.u, u[3] with a stride. */
static double complex add_product(double complex sum, const double S[3], const double complex *u,
                                  int stride) {
  for (int j = 0; j < 3; j++) sum += S[j] * u[j * stride];
  return sum;
}

/* X = K B, by (I + S R) X = S B, column-major. 0: singular. */
static int stiffen(const stuck_modes *w, int k) {
  const mhb_balance    *b = w->b;
  const mhb_receptance *r = b->receptance;
  int                   n = r->n, m = r->n_modes;
  const double complex *B = r->B + (size_t)k * (size_t)n * (size_t)m;
  mhb_receptance_residual_terms(r, k, k * 0.5 * (w->low + w->high) / r->nu, w->R);
  for (int row = 0; row < n; row++) {
    const mhb_law *law     = &b->law[row / 3];
    double         slips   = law->mu == 0 ? 0 : 1;
    size_t         pair    = (size_t)(row - row % 3);
    double         S[3][3] = {{law->kv, 0, 0},
                              {0, slips * law->ku[0], slips * law->ku[1]},
                              {0, slips * law->ku[1], slips * law->ku[2]}};
    for (int c = 0; c < n + m; c++) {
      const double complex *u =
          c < n ? w->R + pair * (size_t)n + (size_t)c : B + pair * (size_t)m + (size_t)(c - n);
      double complex sum = add_product(c == row, S[row % 3], u, c < n ? n : m);
      if (c < n)
        w->A[(size_t)c * (size_t)n + (size_t)row] = sum;
      else
        w->X[(size_t)(c - n) * (size_t)n + (size_t)row] = sum - (c == row);
    }
  }
  return LAPACKE_zgesv(LAPACK_COL_MAJOR, n, m, w->A, n, w->pivot, w->X, n) == 0;
}

/* The same with Coriolis terms, from the stiffness in M: the modes of positive frequency, whose
 * vectors get the length 1. */
static int couple(const stuck_modes *w, int k) {
  const mhb_receptance *r = w->b->receptance;
  const size_t          m = (size_t)r->n_modes;
  const double complex *G = r->part->G + (size_t)k * m * m;
  double                loss[m];
  mhb_gyroscopic        g;
  memset(loss, 0, sizeof loss);
  for (size_t i = 0; i < m * m; i++) w->M[i] = conj(w->M[i]); /* by rows */
  const int found = mhb_gyroscopic_solve(r->n_modes, w->M, G, loss, &g) == SHB_OK;
  for (size_t j = 0; j < m && found; j++) {
    const double complex *x    = g.shape + (m + j) * m;
    double                size = 0;
    for (size_t i = 0; i < m; i++) size += pow(cabs(x[i]), 2);
    for (size_t i = 0; i < m; i++) w->M[j * m + i] = x[i] / sqrt(size);
    w->square[j] = pow(g.omega[m + j], 2);
  }
  mhb_gyroscopic_free(&g);
  return found;
}

/* Eigenvalues into square, vectors into M, column-major. 0: not found. */
static int solve(const stuck_modes *w, int k) {
  const mhb_receptance *r = w->b->receptance;
  int                   n = r->n, m = r->n_modes;
  const double complex *B = r->B + (size_t)k * (size_t)n * (size_t)m;
  if (!stiffen(w, k)) return 0;
  for (int j = 0; j < m; j++) {
    for (int i = 0; i < m; i++) {
      double         omega = SHB_TWO_PI * mhb_receptance_model(r, k)->frequency[i];
      double complex sum   = i == j ? omega * omega : 0;
      for (int row = 0; row < n; row++)
        sum += conj(B[(size_t)row * (size_t)m + (size_t)i]) *
               w->X[(size_t)j * (size_t)n + (size_t)row];
      w->M[(size_t)j * (size_t)m + (size_t)i] = sum;
    }
  }
  if (r->part->G) return couple(w, k);
  return LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', m, w->M, m, w->square) == 0;
}

/* The free mode with the largest share of a stuck one. */
static int closest_free_mode(int m, const double complex *q) {
  int mode = 0;
  for (int i = 1; i < m; i++)
    if (cabs(q[i]) > cabs(q[mode])) mode = i;
  return mode;
}

/* Places between a mode's free and its stuck resonance. */
static void add_between(const stuck_modes *w, mhb_resonances *s, mhb_resonance stuck,
                        mhb_resonance own) {
  double gap = stuck.value - own.value;
  if (fabs(gap) > FARTHEST * own.half_width) {
    add_inside(w, s, stuck);
    return;
  }
  stuck.mode = own.mode;
  int n      = (int)(fabs(gap) / (APART * own.half_width));
  for (int i = 1; i <= n; i++) {
    own.value += gap / (n + 1);
    add_inside(w, s, own);
  }
  if (!(fabs(gap) < SHORTEST * own.half_width)) add_inside(w, s, stuck);
}

/* The resonance of stuck mode j of harmonic k, as solved. */
static mhb_resonance stuck_one(const stuck_modes *w, int k, int j) {
  const mhb_receptance *r     = w->b->receptance;
  const double complex *q     = w->M + (size_t)j * (size_t)r->n_modes;
  const modal_model    *model = mhb_receptance_model(r, k);
  double                decay = 0, turns = (double)r->nu / k;
  for (int i = 0; i < r->n_modes; i++) {
    double size = cabs(q[i]);
    decay += size * size * model->damping_ratio[i] * SHB_TWO_PI * model->frequency[i];
  }
  double omega = sqrt(fmax(0, w->square[j]));
  return (mhb_resonance){turns * omega, turns * decay, k, -1, false};
}

static void add_stuck(const stuck_modes *w, mhb_resonances *s, int k) {
  const mhb_receptance *r = w->b->receptance;
  int                   m = r->n_modes;
  if (!solve(w, k)) return;
  for (int j = 0; j < m; j++)
    add_between(w, s, stuck_one(w, k, j),
                free_one(r, k, closest_free_mode(m, w->M + (size_t)j * (size_t)m)));
}

/* ---- run-up: places omega = nu w_i(omega)/k ---- */

/* Resonances of a mode with the structure at omega. */
typedef struct {
  mhb_resonance free, stuck,
      own; /* own: the free one nearest to the stuck one; half_width 0: not there */
} mode_at;

/* All harmonics and modes at omega, [k][mode]. */
static void sample_modes(const stuck_modes *w, double omega, mode_at *out) {
  mhb_receptance *r = w->b->receptance;
  int             m = r->n_modes;
  mhb_receptance_set_frequency(r, omega);
  for (int k = 1; k <= w->b->m; k++) {
    mode_at *of    = out + (size_t)k * (size_t)m;
    int      found = r->driven[k] && solve(w, k);
    for (int i = 0; i < m; i++) {
      of[i] = (mode_at){.free = free_one(r, k, i)};
      if (!found) continue;
      of[i].stuck = stuck_one(w, k, i);
      of[i].own   = free_one(r, k, closest_free_mode(m, w->M + (size_t)i * (size_t)m));
    }
  }
}

/* Whether value - omega changes its sign between two frequencies; squares are linear in Omega^2.
 * *rate <- how fast the excitation nears the resonance, per change of omega. */
static bool meets(const mhb_resonance *a, double low, const mhb_resonance *b, double high,
                  mhb_resonance *place, double *rate) {
  double x = low * low, y = high * high, f = a->value * a->value - x, g = b->value * b->value - y;
  if ((f > 0) == (g > 0)) return false;
  double part       = f / (f - g);
  *rate             = fmax(fabs(f - g) / (y - x), LEAST_RATE);
  *place            = part < 0.5 ? *a : *b;
  place->value      = sqrt(x + part * (y - x));
  place->half_width = ((1 - part) * a->half_width + part * b->half_width) / *rate;
  return true;
}

static void add_meetings(const stuck_modes *w, mhb_resonances *s, const mode_at *a, double low,
                         const mode_at *b, double high) {
  mhb_resonance place;
  double        rate;
  if (meets(&a->free, low, &b->free, high, &place, &rate)) add_inside(w, s, place);
  if (!(a->stuck.half_width > 0 && b->stuck.half_width > 0) ||
      !meets(&a->stuck, low, &b->stuck, high, &place, &rate))
    return;
  const bool    near = place.value - low < high - place.value;
  mhb_resonance own  = near ? a->own : b->own;
  own.value          = place.value + (own.value - (near ? a : b)->stuck.value) / rate;
  own.half_width /= rate;
  add_between(w, s, place, own);
}

static void add_run_up(const stuck_modes *w, mhb_resonances *s) {
  size_t   all = (size_t)(w->b->m + 1) * (size_t)w->b->receptance->n_modes;
  mode_at *at = shb_alloc_zeroed(2 * all, sizeof *at), *a = at, *b = at + all;
  double   low = w->low;
  sample_modes(w, low, a);
  for (int i = 1; i <= N_SAMPLES; i++) {
    double high = w->low + (w->high - w->low) * i / N_SAMPLES;
    sample_modes(w, high, b);
    for (size_t j = 0; j < all; j++)
      if (a[j].free.k > 0) add_meetings(w, s, &a[j], low, &b[j], high);
    mode_at *swap = a;
    a             = b;
    b             = swap;
    low           = high;
  }
  free(at);
}

static int by_value(const void *a, const void *b) {
  double x = ((const mhb_resonance *)a)->value, y = ((const mhb_resonance *)b)->value;
  return (x > y) - (x < y);
}

static void add_all(const stuck_modes *w, mhb_resonances *s) {
  const mhb_receptance *r = w->b->receptance;
  if (r->at) add_run_up(w, s);
  for (int k = 1; k <= w->b->m && !r->at; k++) {
    for (int i = 0; i < r->n_modes; i++) add_inside(w, s, free_one(r, k, i));
    if (r->driven[k]) add_stuck(w, s, k);
  }
  if (s->n > 0) qsort(s->at, (size_t)s->n, sizeof *s->at, by_value);
}

static void open_work(const mhb_balance *b, double low, double high, stuck_modes *w) {
  size_t n = (size_t)b->receptance->n, m = (size_t)b->receptance->n_modes;
  *w        = (stuck_modes){.b = b, .low = low, .high = high};
  w->R      = shb_alloc_zeroed(n * n, sizeof *w->R);
  w->A      = shb_alloc_zeroed(n * n, sizeof *w->A);
  w->X      = shb_alloc_zeroed(n * m, sizeof *w->X);
  w->M      = shb_alloc_zeroed(m * m, sizeof *w->M);
  w->square = shb_alloc_zeroed(m, sizeof *w->square);
  w->pivot  = shb_alloc_zeroed(n, sizeof *w->pivot);
}

static void close_work(stuck_modes *w) {
  free(w->R);
  free(w->A);
  free(w->X);
  free(w->M);
  free(w->square);
  free(w->pivot);
}

void mhb_resonances_create(const mhb_balance *b, double low, double high, mhb_resonances *out) {
  *out = (mhb_resonances){0};
  if (b->parameter != MHB_IN_FREQUENCY) return;
  stuck_modes w;
  open_work(b, low, high, &w);
  add_all(&w, out);
  close_work(&w);
}

/* ---- of one linear limit ---- */

/* The stuck resonances of harmonic k in sections of the range. R changes little over each. */
static void add_stuck_sections(stuck_modes *w, mhb_resonances *s, int k) {
  const mhb_receptance *r     = w->b->receptance;
  const double         *f     = mhb_receptance_model(r, k)->frequency;
  const double          turns = SHB_TWO_PI * r->nu / k, low = w->low, high = w->high;
  const double          first = fmax(low, 0.5 * turns * f[0]);
  const double          last  = fmin(high, 2 * turns * f[r->n_modes - 1]);
  for (double at = first; at < last; at = w->high) {
    w->low  = at;
    w->high = fmin(last, SECTION * at);
    if (!solve(w, k)) continue;
    for (int j = 0; j < r->n_modes; j++) add_inside(w, s, stuck_one(w, k, j));
  }
  w->low  = low;
  w->high = high;
}

static void add_limit(stuck_modes *w, bool stuck, mhb_resonances *s) {
  const mhb_receptance *r = w->b->receptance;
  for (int k = 1; k <= w->b->m; k++) {
    if (!r->driven[k]) continue;
    if (stuck) add_stuck_sections(w, s, k);
    for (int i = 0; i < r->n_modes && !stuck; i++) add_inside(w, s, free_one(r, k, i));
  }
  if (s->n > 0) qsort(s->at, (size_t)s->n, sizeof *s->at, by_value);
}

void mhb_resonances_of_limit(const mhb_balance *b, bool stuck, double low, double high,
                             mhb_resonances *out) {
  *out = (mhb_resonances){0};
  if (b->receptance->ring) return;
  if (b->parameter != MHB_IN_FREQUENCY || b->receptance->at) {
    mhb_resonances_create(b, low, high, out);
    return;
  }
  stuck_modes w;
  open_work(b, low, high, &w);
  add_limit(&w, stuck, out);
  close_work(&w);
}

/* ---- of one nodal diameter ---- */

/* Stuck mode j of harmonic 1 with R at its own frequency, rad/s; NAN: not found. */
static double settle(stuck_modes *w, int j) {
  enum { MOST_TURNS = 50 };
  double omega = SHB_TWO_PI * w->b->receptance->model->frequency[j];
  for (int i = 0; i < MOST_TURNS; i++) {
    const double before = omega;
    w->low = w->high = omega;
    if (!solve(w, 1)) return NAN;
    omega = sqrt(fmax(0, w->square[j]));
    if (fabs(omega - before) <= 1e-9 * omega) break;
  }
  return omega;
}

shb_status mhb_stuck_frequencies(const modal_model *model, const mhb_settings *settings,
                                 int diameter, int n, double *frequency) {
  mhb_settings one     = *settings;
  mhb_balance *balance = NULL;
  stuck_modes  w       = {0};
  one.engine_order     = diameter;
  one.turns_right      = false;
  one.harmonics = one.subharmonics = 1;
  one.motion_tolerance             = 0;
  one.run_up                       = NULL;
  one.disc_run_up                  = NULL;
  one.ring                         = NULL; /* equal blades */
  one.other_pairs                  = NULL;
  SHB_TRY(mhb_balance_create(model, &one, &balance));
  open_work(balance, 0, 0, &w);
  for (int j = 0; j < n; j++) frequency[j] = settle(&w, j) / SHB_TWO_PI;
  close_work(&w);
  mhb_balance_destroy(balance);
  return SHB_OK;
}

void mhb_resonances_destroy(mhb_resonances *s) {
  free(s->at);
  *s = (mhb_resonances){0};
}

double mhb_resonances_step_limit(const mhb_resonances *s, double value, int sense) {
  double way = INFINITY;
  for (int i = 0; i < s->n; i++) {
    if (!s->at[i].significant) continue;
    double half = s->at[i].half_width, ahead = sense * (s->at[i].value - value),
           edge = WINDOW * half;
    if (ahead > edge) way = fmin(way, fmax(ahead - edge, half));
    if (fabs(ahead) <= edge) way = fmin(way, fmax(SHORTEST * half, 0.5 * fabs(ahead)));
  }
  return way;
}
