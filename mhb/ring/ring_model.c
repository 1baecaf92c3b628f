#include "mhb/ring/ring_model.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/interfaces.h"
#include "mhb/ring/merged_modes.h"

/* Modes above this multiple of the lowest frequency of the excitation are merged. Measured on
 * cases/z_notch_blade, see docs/theory/lasting.md. */
static const double LAST_MODE = 16;

/* Largest w h of a mode; the kicks resonate at pi. */
static const double FASTEST = 1.5;

double mhb_ring_model_lag(const mhb_ring_model *m, int harmonic, int blade) {
  return m->blades > 1 ? -carg(m->receptance->phase[1]) * harmonic * blade : 0;
}

double mhb_ring_model_work(const mhb_ring_model *m) {
  return m->lanes * (m->modes * (24. * m->pairs + 4) + 120. * m->pairs);
}

/* ---- the frequency ---- */

static double sinc(double x) {
  return fabs(x) < 1e-4 ? 1 - x * x / 6 : sin(x) / x;
}

/* The factor s of ring_model.h. */
static double exactness(double w, double W, double h) {
  return sinc(0.5 * (w + W) * h) * sinc(0.5 * (w - W) * h) / sinc(w * h);
}

/* M [MHB_RING_MAP] and trace and det of mode i with stretch times its frequency. Its rows are times
 * 1/stretch, as they are divided by w. */
static void set_map(const mhb_ring_model *m, int i, double stretch, double *M, double *trace,
                    double *det) {
  double W = m->omega, h = m->h, w = m->w[i] * stretch, zeta = m->zeta[i], gain = w;
  if (!(w * h <= FASTEST)) {
    double ratio = W / w; /* 0 of a mode without inertia */
    w            = FASTEST / h;
    gain         = sqrt((w * w - W * W) / (1 - ratio * ratio));
  }
  double a = zeta * w, wd = w * sqrt(1 - zeta * zeta), e = exp(-a * h), x = e * cos(wd * h),
         y = e * sin(wd * h);
  M[0]     = x + y * a / wd;
  M[1]     = y * w / wd;
  M[2]     = -y * w / wd;
  M[3]     = x - y * a / wd;
  M[4]     = w;
  double s = exactness(w, W, h);
  M[5]     = gain / stretch * sqrt(s * M[1] * h / w); /* of the rows, with that of z */
  *trace   = 2 * x;
  *det     = e * e;
}

/* The mode of every blade: z has the scale of the tuned one. */
static void set_own(mhb_ring_model *m, int i) {
  const double scale = m->map[MHB_RING_MAP * i + 5];
  for (int l = 0; l < m->lanes; l++) {
    double *M = (double *)mhb_ring_model_map(m, i, l);
    set_map(m, i, m->stretch[i * m->lanes + l], M, mhb_ring_model_own(m, i, l, MHB_RING_TRACE),
            mhb_ring_model_own(m, i, l, MHB_RING_DET));
    *mhb_ring_model_own(m, i, l, MHB_RING_GAIN) = (M[5] / scale) * (M[5] / scale);
    M[5]                                        = scale;
  }
}

static void set_mode(mhb_ring_model *m, int i) {
  double *c = m->coefficient + (size_t)i * (size_t)m->stride;
  set_map(m, i, 1, m->map + MHB_RING_MAP * (size_t)i, &c[MHB_RING_TRACE], &c[MHB_RING_DET]);
  if (m->own) set_own(m, i);
  const double scale = m->map[MHB_RING_MAP * i + 5];
  for (int row = 0; row < 6 * m->pairs; row++) {
    int pair = row / 6, side = row / 3 % 2, axis = row % 3;
    c[MHB_RING_ROWS + row] = scale * mhb_ring_model_shape(m, i, side)[3 * pair + axis];
  }
  for (int axis = 0; axis < 3; axis++)
    c[MHB_RING_ROWS + 6 * m->pairs + axis] = scale * m->out[3 * i + axis];
}

/* Motion without contact: harmonic k as amplitudes of cos and sin a lane. next: from a blade to the
 * next one in a; 0: equal blades, a is that of blade 0. */
static void set_lanes(const mhb_ring_model *m, int k, const double complex *a, int next,
                      double *out) {
  size_t half = 3 * (size_t)m->lanes;
  for (int b = 0; b < m->blades; b++, a += next) {
    double complex turn = next ? 1 : cexp(-I * mhb_ring_model_lag(m, k, b));
    for (int i = 0; i < 3 * m->copies; i++) {
      const int axis = i / m->copies, at = axis * m->lanes + b * m->copies + i % m->copies;
      out[at]                = creal(a[axis] * turn);
      out[half + (size_t)at] = k ? -cimag(a[axis] * turn) : 0;
    }
  }
}

static void set_free(mhb_ring_model *m) {
  mhb_receptance *r = m->ring ? m->ring : m->receptance;
  int             n = r->n, q = 3 * r->model->n_probes;
  const int       of = m->ring ? 3 * m->pairs : 0, probes = m->ring ? q / m->blades : 0;
  size_t          lanes = (size_t)m->lanes, block = 3 * lanes;
  double complex  none[n], probe[q + 1];
  memset(none, 0, sizeof none);
  mhb_receptance_at(r, m->omega, r->n_harmonics);
  for (int j = 0; j < m->n_free; j++) {
    int     k  = m->harmonic[j];
    double *to = m->free_motion + (size_t)j * 2 * block * (size_t)m->pairs;
    for (int pair = 0; pair < m->pairs; pair++) {
      double each[2 * block];
      memset(each, 0, sizeof each);
      set_lanes(m, k, r->free + k * n + 3 * pair, of, each);
      for (size_t part = 0; part < 2; part++)
        memcpy(to + (part * (size_t)m->pairs + (size_t)pair) * block, each + part * block,
               block * sizeof *to);
    }
    if (m->probe < 0) continue;
    mhb_receptance_probe(r, k, none, probe);
    set_lanes(m, k, probe + 3 * m->probe, probes, m->free_output + (size_t)j * 2 * block);
  }
}

void mhb_ring_model_set(mhb_ring_model *m, double omega, int steps) {
  if (steps != m->steps) {
    shb_arena_free(&m->table);
    m->cosine = shb_arena_take(&m->table, (size_t)steps, sizeof(double));
    m->sine   = shb_arena_take(&m->table, (size_t)steps, sizeof(double));
    for (int i = 0; i < steps; i++) {
      m->cosine[i] = cos(SHB_TWO_PI * i / steps);
      m->sine[i]   = sin(SHB_TWO_PI * i / steps);
    }
  }
  m->omega = omega;
  m->steps = steps;
  m->h     = SHB_TWO_PI * m->order / (omega * steps);
  for (int i = 0; i < m->modes; i++) set_mode(m, i);
  set_free(m);
}

void mhb_ring_model_first(const mhb_ring_model *m, int n_harmonics, const double complex *force,
                          double complex *first) {
  const mhb_receptance *r = m->ring;
  const int             n = r->n, q = 3 * r->model->n_probes, k = m->order;
  const int             next = m->probe < 0 ? 3 * m->pairs : q / m->blades;
  double complex        p[n], motion[n + q];
  for (int i = 0; i < n; i++)
    p[i] = k <= n_harmonics ? force[(size_t)i * ((size_t)n_harmonics + 1) + (size_t)k] : 0;
  if (m->probe < 0)
    mhb_receptance_motion(r, k, p, motion);
  else
    mhb_receptance_probe(r, k, p, motion);
  for (int b = 0; b < m->blades; b++)
    for (int axis = 0; axis < 3; axis++)
      first[axis * m->blades + b] = motion[b * next + (m->probe < 0 ? 0 : 3 * m->probe) + axis];
}

/* ---- stability of the steps ---- */

/* Root of the stiffness of a stuck pair: block diagonal kv, Ku^1/2. */
static void root_stiffness(const mhb_slip_law *law, double K[3][3]) {
  double half = 0.5 * (law->ku[0] - law->ku[2]), radius = hypot(half, law->ku[1]);
  double low = fmax(law->mean - radius, 0), high = law->mean + radius, sum = sqrt(low) + sqrt(high);
  memset(K, 0, 9 * sizeof(double));
  K[0][0] = sqrt(law->kv);
  if (!(sum > 0)) return;
  K[1][1] = (law->ku[0] + sqrt(low * high)) / sum;
  K[2][2] = (law->ku[2] + sqrt(low * high)) / sum;
  K[1][2] = K[2][1] = law->ku[1] / sum;
}

/* x[3 pairs] <- K^1/2 B of a mode at a nodal diameter, times the root of its share of G. */
static void weighted_row(const mhb_ring_model *m, int mode, double complex phase,
                         double complex *x) {
  const double *c      = m->coefficient + (size_t)mode * (size_t)m->stride;
  double        square = 1 / (1 + c[MHB_RING_TRACE] + c[MHB_RING_DET]);
  for (int l = 0; l < m->lanes && m->own; l++) /* the largest share of any blade */
    square = fmax(square, *mhb_ring_model_own(m, mode, l, MHB_RING_GAIN) /
                              (1 + *mhb_ring_model_own(m, mode, l, MHB_RING_TRACE) +
                               *mhb_ring_model_own(m, mode, l, MHB_RING_DET)));
  double share = sqrt(square);
  for (int pair = 0; pair < m->pairs; pair++) {
    double         K[3][3];
    double complex u[3];
    const double  *row = c + MHB_RING_ROWS + 6 * pair;
    root_stiffness(&m->law[pair], K);
    for (int i = 0; i < 3; i++) u[i] = share * (row[i] + phase * row[3 + i]);
    for (int i = 0; i < 3; i++) {
      x[3 * pair + i] = 0;
      for (int j = 0; j < 3; j++) x[3 * pair + i] += K[i][j] * u[j];
    }
  }
}

double mhb_ring_model_stiffness(const mhb_ring_model *m) {
  int             n     = 3 * m->pairs;
  double complex *G     = shb_alloc((size_t)n * (size_t)(n + 1), sizeof *G);
  double         *value = shb_alloc((size_t)n, sizeof *value), largest = 0;
  for (int d = 0; d <= m->blades / 2; d++) {
    double complex *x = G + n * n;
    memset(G, 0, sizeof *G * (size_t)(n * n));
    for (int k = 0; k < m->modes; k++) {
      weighted_row(m, k, cexp(-I * SHB_TWO_PI * d / m->blades), x);
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) G[i * n + j] += x[i] * conj(x[j]);
    }
    bool found = LAPACKE_zheev(LAPACK_COL_MAJOR, 'N', 'U', n, G, n, value) == 0;
    largest    = fmax(largest, found ? value[n - 1] : INFINITY);
  }
  free(G);
  free(value);
  return largest;
}

/* ---- life cycle ---- */

static void set_laws(mhb_ring_model *m, double n0) {
  mhb_operating_point at = mhb_operating_point_of(&m->settings);
  at.n0                  = n0;
  for (int a = 0; a < m->pairs; a++) {
    mhb_operating_point own =
        mhb_interface_operating_point(&at, &m->settings, m->receptance->interface[a]);
    mhb_law law = mhb_operating_point_law(&own, m->settings.preload, m->receptance->share[a]);
    m->law[a]   = mhb_slip_law_of(&law);
  }
}

/* T0^T x of a pair in a mode of the blade; the left side negative, 0 to ground. */
static double shape_of(const mhb_ring_model *m, int side, int row, int mode) {
  const mhb_receptance *r   = m->receptance;
  const double         *x   = side ? r->model->left : r->model->right;
  double                sum = 0;
  if (side && m->settings.to_ground) return 0;
  for (int axis = 0; axis < 3; axis++)
    sum += r->T0[(row / 3) * 9 + axis * 3 + row % 3] * x[(row / 3 * 3 + axis) * r->n_modes + mode];
  return side ? -sum : sum;
}

static void set_own_modes(mhb_ring_model *m) {
  const modal_model *modal = m->receptance->model;
  for (int i = 0; i < m->kept; i++) {
    double *shape = m->shape + (size_t)(6 * i) * (size_t)m->pairs;
    m->w[i]       = fmax(SHB_TWO_PI * modal->frequency[i], m->receptance->hold);
    m->zeta[i]    = modal->damping_ratio[i];
    for (int k = 0; k < 6 * m->pairs; k++)
      shape[k] = shape_of(m, k / (3 * m->pairs), k % (3 * m->pairs), i) / m->w[i];
    for (int axis = 0; axis < 3 && m->probe >= 0; axis++)
      m->out[3 * i + axis] =
          modal->probe[(size_t)(3 * m->probe + axis) * (size_t)modal->n_modes + (size_t)i] /
          m->w[i];
  }
}

static shb_status set_merged_modes(mhb_ring_model *m) {
  mhb_merged_modes   merged;
  const modal_model *modal = m->receptance->model;
  SHB_TRY(mhb_merged_modes_create(m->receptance, &m->settings, m->kept, m->probe, &merged));
  for (int i = 0; i < merged.n; i++, m->modes++) {
    m->w[m->modes]    = merged.w[i];
    m->zeta[m->modes] = modal->damping_ratio[modal->n_modes - 1];
    memcpy(m->shape + (size_t)(6 * m->modes) * (size_t)m->pairs,
           merged.shape + (size_t)(6 * i) * (size_t)m->pairs,
           sizeof(double) * 6 * (size_t)m->pairs);
    memcpy(m->out + 3 * m->modes, merged.out + 3 * i, 3 * sizeof(double));
  }
  mhb_merged_modes_destroy(&merged);
  return SHB_OK;
}

static void allocate(mhb_ring_model *m) {
  shb_arena *a    = &m->arena;
  size_t     most = (size_t)m->kept + 6 * (size_t)m->pairs, pairs = (size_t)m->pairs;
  size_t     frees = (size_t)m->n_free * 6 * (size_t)m->lanes;
  m->stride        = MHB_RING_ROWS + 6 * m->pairs + 3;
  m->w             = shb_arena_take(a, most, sizeof(double));
  m->zeta          = shb_arena_take(a, most, sizeof(double));
  m->shape         = shb_arena_take(a, 6 * most * pairs, sizeof(double));
  m->out           = shb_arena_take(a, 3 * most, sizeof(double));
  m->coefficient   = shb_arena_take(a, most * (size_t)m->stride, sizeof(double));
  m->map           = shb_arena_take(a, MHB_RING_MAP * most, sizeof(double));
  m->law           = shb_arena_take(a, pairs, sizeof *m->law);
  m->harmonic      = shb_arena_take(a, (size_t)m->n_free, sizeof(int));
  m->free_motion   = shb_arena_take(a, frees * pairs, sizeof(double));
  m->free_output   = shb_arena_take(a, frees, sizeof(double));
  if (m->ring) {
    size_t all = most * (size_t)m->lanes;
    m->stretch = shb_arena_take(a, all, sizeof(double));
    m->own     = shb_arena_take(a, MHB_RING_LANE_SIZE * all, sizeof(double));
    m->own_map = shb_arena_take(a, MHB_RING_MAP * all, sizeof(double));
  }
}

static int harmonics_of_load(const mhb_receptance *r, int *harmonic) {
  int n = 0;
  for (int k = 0; k <= r->n_harmonics; k++) {
    if (!r->driven[k]) continue;
    if (harmonic) harmonic[n] = k;
    n++;
  }
  return n;
}

/* Whether all modes of each blade have one deviation. The merged modes follow it then. */
static bool is_uniform(const mhb_mistuned_ring *ring) {
  for (int i = 0; i < ring->blades * ring->n_modes; i++)
    if (ring->deviation[i] != ring->deviation[i / ring->n_modes * ring->n_modes]) return false;
  return true;
}

/* Merged modes stand for modes left out. With deviations mode by mode these are the tuned ones, and
 * all modes of the model are kept. */
static void set_stretch(mhb_ring_model *m, const mhb_mistuned_ring *ring) {
  const bool uniform = is_uniform(ring);
  for (int i = 0; i < m->modes; i++)
    for (int l = 0; l < m->lanes; l++) {
      const bool    used           = l < mhb_ring_model_used(m);
      const int     blade          = used ? l / m->copies : 0;
      const double *of             = ring->deviation + (size_t)blade * (size_t)ring->n_modes;
      const double  deviation      = i < m->kept ? of[i] : uniform ? of[0] : 0;
      m->stretch[i * m->lanes + l] = 1 + (used ? deviation : 0);
    }
}

static shb_status make(mhb_ring_model *m, const modal_model *modal, double n0, double lowest) {
  const mhb_mistuned_ring *ring = m->settings.ring;
  if (ring) modal = ring->tuned;
  int nu = m->settings.subharmonics, top = modal->n_load > 0 ? modal->n_load : 1;
  if (ring) SHB_TRY(mhb_receptance_create(&ring->whole, &m->settings, nu * top, &m->ring));
  m->settings.ring = NULL;
  SHB_TRY(mhb_receptance_create(modal, &m->settings, nu * top, &m->receptance));
  m->blades = m->settings.to_ground ? 1 : m->settings.blades;
  m->lanes  = mhb_whole_lanes(mhb_ring_model_used(m));
  m->pairs  = modal->n_pairs;
  m->order  = nu;
  m->probe  = modal->n_probes > 0 ? 0 : -1;
  m->n_free = harmonics_of_load(m->receptance, NULL);
  while (m->kept < modal->n_modes &&
         (m->kept == 0 || SHB_TWO_PI * modal->frequency[m->kept] <= LAST_MODE * lowest ||
          (ring && !is_uniform(ring))))
    m->kept++;
  allocate(m);
  harmonics_of_load(m->receptance, m->harmonic);
  set_laws(m, n0);
  set_own_modes(m);
  m->modes = m->kept;
  SHB_TRY(set_merged_modes(m));
  if (ring) set_stretch(m, ring);
  return SHB_OK;
}

shb_status mhb_ring_model_create(const modal_model *modal, const mhb_settings *settings, double n0,
                                 double lowest, mhb_ring_model **out) {
  return mhb_ring_model_create_copies(modal, settings, n0, lowest, 1, out);
}

shb_status mhb_ring_model_create_copies(const modal_model *modal, const mhb_settings *settings,
                                        double n0, double lowest, int copies,
                                        mhb_ring_model **out) {
  mhb_ring_model *m = shb_alloc_zeroed(1, sizeof *m);
  m->copies         = copies;
  m->settings       = *settings;
  shb_status status = make(m, modal, n0, lowest);
  if (status != SHB_OK) {
    mhb_ring_model_destroy(m);
    return status;
  }
  *out = m;
  return SHB_OK;
}

void mhb_ring_model_destroy(mhb_ring_model *m) {
  if (!m) return;
  mhb_receptance_destroy(m->receptance);
  mhb_receptance_destroy(m->ring);
  shb_arena_free(&m->arena);
  shb_arena_free(&m->table);
  free(m);
}
