#include "mhb/ring/ring_step.h"

#include <string.h>

/* What a step of the modes reads and writes. */
typedef struct {
  int           modes, pairs, newest, oldest;
  size_t        lanes, row, stride, copies;
  const double *coefficient, *own, *p;  /* own: NULL of equal blades */
  double       *z, *right, *left, *out; /* out: NULL where it is not sampled */
} mhb_ring_modes;

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__clang__)
#define MHB_RING_SETS
#define TARGET "arch=x86-64-v4"
#define WIDTH 8
#define NAME(x) x##_8
#include "mhb/ring/ring_kernel.h"
#undef TARGET
#undef WIDTH
#undef NAME
#define TARGET "arch=x86-64-v3"
#define WIDTH 4
#define NAME(x) x##_4
#include "mhb/ring/ring_kernel.h"
#undef TARGET
#undef WIDTH
#undef NAME
#define TARGET "sse2"
#else
#define TARGET "default"
#define target(x) unused
#endif
#define WIDTH 2
#define NAME(x) x##_2
#include "mhb/ring/ring_kernel.h"

static void step_modes(const mhb_ring_modes *a) {
#ifdef MHB_RING_SETS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
    step_modes_8(a);
    return;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    step_modes_4(a);
    return;
  }
#endif
  step_modes_2(a);
}

/* ---- contacts ---- */

/* u[3][row] of a pair += the motion without contact, at a step of the period. */
MHB_HOT static void add_free(const mhb_ring_model *m, int pair, int step, size_t row, double *u) {
  size_t lanes = (size_t)m->lanes, side = 3 * lanes * (size_t)m->pairs;
  for (int j = 0; j < m->n_free; j++) {
    int           phase = (int)((long)m->harmonic[j] * step % m->steps);
    double        c = m->cosine[phase], s = m->sine[phase];
    const double *C = m->free_motion + (size_t)j * 2 * side + (size_t)pair * 3 * lanes,
                 *S = C + side;
    for (size_t i = 0; i < 3; i++)
      for (size_t l = 0; l < lanes; l++)
        u[i * row + l] += c * C[i * lanes + l] + s * S[i * lanes + l];
  }
}

/* All blades of a pair: the law over the step to the motion u[3][row], forces to p[3][row]. */
MHB_INLINE void flow_lanes(const mhb_slip_law *law, bool isotropic, bool closed, int lanes,
                           size_t row, const double *restrict u, double *restrict contact,
                           double *restrict p) {
  double *load = contact, *s0 = load + row, *s1 = s0 + row, *f0 = s1 + row, *f1 = f0 + row;
#pragma GCC ivdep
  for (int l = 0; l < lanes; l++) {
    mhb_slip_flow(law, isotropic, closed, u[l], u[row + (size_t)l], u[2 * row + (size_t)l],
                  &load[l], &s0[l], &s1[l], &f0[l], &f1[l]);
    p[l]                   = mhb_pick(load[l] > 0, load[l], 0) - law->offset;
    p[row + (size_t)l]     = f0[l];
    p[2 * row + (size_t)l] = f1[l];
  }
}

MHB_HOT static void flow(const mhb_slip_law *law, int lanes, size_t row, const double *u,
                         double *contact, double *p) {
  int n_open = 0;
  for (int l = 0; l < lanes; l++) n_open += contact[l] <= 0;
  if (!law->isotropic)
    flow_lanes(law, false, false, lanes, row, u, contact, p);
  else if (n_open)
    flow_lanes(law, true, false, lanes, row, u, contact, p);
  else
    flow_lanes(law, true, true, lanes, row, u, contact, p);
}

/* Blades that are not there bear nothing; the last blade is the left neighbour of the first. */
static void close_ring(const mhb_ring *ring) {
  const mhb_ring_model *m    = ring->model;
  const int             used = mhb_ring_model_used(m);
  for (int i = 0; i < 3 * m->pairs; i++) {
    double *p = ring->p + (size_t)i * ring->row + MHB_LANES;
    for (int l = used; l < m->lanes; l++) p[l] = 0;
    for (int c = 1; c <= m->copies; c++) p[-c] = p[used - c];
  }
}

/* u[3][row] <- motion of a pair at a step, from the sums of the modes. */
MHB_HOT static void add_sides(const mhb_ring *ring, int pair, double *u) {
  const mhb_ring_model *m = ring->model;
  for (size_t i = 0; i < 3; i++) {
    size_t        at    = ((size_t)(3 * pair) + i) * ring->row + MHB_LANES;
    const double *right = ring->right + at;
    double       *left  = ring->left + at;
    for (int c = 0; c < m->copies; c++) left[mhb_ring_model_used(m) + c] = left[c];
    for (int l = 0; l < m->lanes; l++)
      u[i * ring->row + (size_t)l] = right[l] + left[l + m->copies];
  }
}

static void step_contacts(mhb_ring *ring, int step, double *sample) {
  const mhb_ring_model *m   = ring->model;
  size_t                row = ring->row;
  double                u[3 * row];
  for (int pair = 0; pair < m->pairs; pair++) {
    add_sides(ring, pair, u);
    add_free(m, pair, step, row, u);
    flow(&m->law[pair], m->lanes, row, u, ring->contact + (size_t)(5 * pair) * row + MHB_LANES,
         ring->p + (size_t)(3 * pair) * row + MHB_LANES);
    for (size_t i = 0; i < 3 && sample && m->probe < 0 && pair == 0; i++)
      memcpy(sample + i * (size_t)m->lanes, u + i * row, sizeof *u * (size_t)m->lanes);
  }
  close_ring(ring);
}

/* ---- a period ---- */

MHB_HOT static void add_free_output(const mhb_ring_model *m, int step, double *sample) {
  size_t n = 3 * (size_t)m->lanes;
  for (int j = 0; j < m->n_free; j++) {
    int           phase = (int)((long)m->harmonic[j] * step % m->steps);
    double        c = m->cosine[phase], s = m->sine[phase];
    const double *C = m->free_output + (size_t)j * 2 * n, *S = C + n;
    for (size_t i = 0; i < n; i++) sample[i] += c * C[i] + s * S[i];
  }
}

void mhb_ring_period(mhb_ring *ring) {
  const mhb_ring_model *m     = ring->model;
  mhb_ring_modes        a     = {.modes       = m->modes,
                                 .pairs       = m->pairs,
                                 .lanes       = (size_t)m->lanes,
                                 .row         = ring->row,
                                 .stride      = (size_t)m->stride,
                                 .copies      = (size_t)m->copies,
                                 .coefficient = m->coefficient,
                                 .own         = m->own,
                                 .p           = ring->p,
                                 .z           = ring->z,
                                 .right       = ring->right,
                                 .left        = ring->left};
  int                   every = m->steps / ring->n_samples;
  for (int step = 1; step <= m->steps; step++) {
    int     at     = step / every - 1;
    double *sample = step % every ? NULL : ring->output + (size_t)at * 3 * a.lanes;
    a.newest       = ring->newest;
    a.oldest       = MHB_LANES - a.newest;
    a.out          = m->probe < 0 ? NULL : sample;
    step_modes(&a);
    ring->newest = a.oldest;
    if (a.out) add_free_output(m, step % m->steps, sample);
    step_contacts(ring, step % m->steps, sample);
  }
}

/* ---- the state as positions and velocities ---- */

static double *place(const mhb_ring *ring, int mode, int lane) {
  return ring->z +
         ((size_t)(lane / MHB_LANES) * (size_t)ring->model->modes + (size_t)mode) * 2 * MHB_LANES +
         lane % MHB_LANES;
}

/* Kick of the present forces on a mode of a blade, as it enters the recurrence. */
static double kick(const mhb_ring *ring, int mode, int lane) {
  const mhb_ring_model *m   = ring->model;
  const double         *row = m->coefficient + (size_t)mode * (size_t)m->stride + MHB_RING_ROWS;
  double                sum = 0;
  for (int i = 0; i < 3 * m->pairs; i++) {
    const double *p = ring->p + (size_t)i * ring->row + MHB_LANES + lane;
    const double *r = row + 6 * (i / 3) + i % 3;
    sum -= r[0] * p[0] + r[3] * p[-m->copies];
  }
  return m->own ? sum * *mhb_ring_model_own(m, mode, lane, MHB_RING_GAIN) : sum;
}

/* Lanes `first`, first + next, ... below the last used one. */
static void get(const mhb_ring *ring, int first, int next, double *q, double *v) {
  const mhb_ring_model *m = ring->model;
  for (int k = 0; k < m->modes; k++)
    for (int l = first; l < mhb_ring_model_used(m); l += next) {
      const double *z = place(ring, k, l), *M = mhb_ring_model_map(m, k, l);
      double        now = z[ring->newest], last = z[MHB_LANES - ring->newest];
      double        y = M[2] * last + M[3] * (now - M[0] * last) / M[1]; /* before the kick */
      y += 0.5 * kick(ring, k, l) / M[1];
      q[(size_t)(k * m->lanes + l)] = M[5] * now;
      v[(size_t)(k * m->lanes + l)] = M[5] * M[4] * y;
    }
}

static void put(const mhb_ring *ring, int first, int next, const double *q, const double *v) {
  const mhb_ring_model *m = ring->model;
  for (int k = 0; k < m->modes; k++)
    for (int l = first; l < mhb_ring_model_used(m); l += next) {
      const double *M = mhb_ring_model_map(m, k, l);
      double       *z = place(ring, k, l), det = M[0] * M[3] - M[1] * M[2];
      double        now = q[k * m->lanes + l] / M[5];
      double        y   = v[k * m->lanes + l] / (M[5] * M[4]) - 0.5 * kick(ring, k, l) / M[1];
      z[ring->newest]   = now;
      z[MHB_LANES - ring->newest] = (M[3] * now - M[1] * y) / det;
    }
}

void mhb_ring_get(const mhb_ring *ring, double *q, double *v) {
  get(ring, 0, 1, q, v);
}

void mhb_ring_put(mhb_ring *ring, const double *q, const double *v) {
  put(ring, 0, 1, q, v);
}

void mhb_ring_get_copy(const mhb_ring *ring, int copy, double *q, double *v) {
  get(ring, copy, ring->model->copies, q, v);
}

void mhb_ring_put_copy(mhb_ring *ring, int copy, const double *q, const double *v) {
  put(ring, copy, ring->model->copies, q, v);
}

/* q, v += sign times the motion of the model's own modes without contact, at phase 0, in the lanes
 * `first`, first + next, ... */
static void add_free_modes(const mhb_ring_model *m, double sign, int first, int next, double *q,
                           double *v) {
  for (int j = 0; j < m->n_free; j++)
    for (int l = first; l < mhb_ring_model_used(m); l += next) {
      int                   k = m->harmonic[j], b = l / m->copies;
      const mhb_receptance *r    = m->ring ? m->ring->ring->blade[b] : m->receptance;
      double complex        turn = m->ring ? 1 : cexp(-I * mhb_ring_model_lag(m, k, b));
      for (int i = 0; i < m->kept; i++) {
        double complex a =
            m->w[i] * r->scale * r->lambda[k * r->n_modes + i] * r->F[k * r->n_modes + i] * turn;
        q[i * m->lanes + l] += sign * creal(a);
        v[i * m->lanes + l] += sign * creal(I * (k * m->omega / m->order) * a);
      }
    }
}

void mhb_ring_move(mhb_ring *ring, double omega, double *space) {
  mhb_ring_model *m = ring->model;
  double         *q = space, *v = space + (size_t)m->modes * (size_t)m->lanes;
  mhb_ring_get(ring, q, v);
  add_free_modes(m, 1, 0, 1, q, v);
  mhb_ring_model_set(m, omega, m->steps);
  add_free_modes(m, -1, 0, 1, q, v);
  mhb_ring_put(ring, q, v);
}

/* packed[n][blades] <- rows [n][row] of the lanes of a copy, and back. */
static void pack(const mhb_ring_model *m, int copy, int n, size_t row, const double *rows,
                 double *packed) {
  for (int i = 0; i < n; i++)
    for (int b = 0; b < m->blades; b++)
      packed[i * m->blades + b] = rows[(size_t)i * row + (size_t)(b * m->copies + copy)];
}

static void unpack(const mhb_ring_model *m, int copy, int n, size_t row, const double *packed,
                   double *rows) {
  for (int i = 0; i < n; i++)
    for (int b = 0; b < m->blades; b++)
      rows[(size_t)i * row + (size_t)(b * m->copies + copy)] = packed[i * m->blades + b];
}

/* Arrays of a state, unless it has them. */
static void prepare_state(const mhb_ring_model *m, mhb_ring_state *state) {
  const size_t blades = (size_t)m->blades, n = (size_t)m->modes * blades;
  if (state->q) return;
  state->q       = shb_arena_take(&state->arena, n, sizeof(double));
  state->v       = shb_arena_take(&state->arena, n, sizeof(double));
  state->p       = shb_arena_take(&state->arena, 3 * (size_t)m->pairs * blades, sizeof(double));
  state->contact = shb_arena_take(&state->arena, 5 * (size_t)m->pairs * blades, sizeof(double));
}

void mhb_ring_save(const mhb_ring *ring, int copy, double *space, mhb_ring_state *state) {
  const mhb_ring_model *m    = ring->model;
  double               *half = space + (size_t)m->modes * (size_t)m->lanes;
  prepare_state(m, state);
  state->omega = m->omega;
  mhb_ring_get_copy(ring, copy, space, half);
  add_free_modes(m, 1, copy, m->copies, space, half);
  pack(m, copy, m->modes, (size_t)m->lanes, space, state->q);
  pack(m, copy, m->modes, (size_t)m->lanes, half, state->v);
  pack(m, copy, 3 * m->pairs, ring->row, ring->p + MHB_LANES, state->p);
  pack(m, copy, 5 * m->pairs, ring->row, ring->contact + MHB_LANES, state->contact);
}

void mhb_ring_load(mhb_ring *ring, int copy, const mhb_ring_state *state, double *space) {
  const mhb_ring_model *m    = ring->model;
  double               *half = space + (size_t)m->modes * (size_t)m->lanes;
  unpack(m, copy, m->modes, (size_t)m->lanes, state->q, space);
  unpack(m, copy, m->modes, (size_t)m->lanes, state->v, half);
  unpack(m, copy, 3 * m->pairs, ring->row, state->p, ring->p + MHB_LANES);
  unpack(m, copy, 5 * m->pairs, ring->row, state->contact, ring->contact + MHB_LANES);
  close_ring(ring);
  add_free_modes(m, -1, copy, m->copies, space, half);
  mhb_ring_put_copy(ring, copy, space, half);
}

/* ---- the start ---- */

/* Harmonic k of all modes in steady motion of the steps under force p[3 pairs]. */
static void add_harmonic(mhb_ring *ring, int k, const double complex *p) {
  const mhb_ring_model *m     = ring->model;
  double complex        phase = cexp(-I * mhb_ring_model_lag(m, k, 1));
  double complex        turn  = cexp(I * (k * m->omega / m->order) * m->h);
  for (int i = 0; i < m->modes; i++) {
    const double  *c   = m->coefficient + (size_t)i * (size_t)m->stride;
    double complex sum = 0;
    for (int row = 0; row < 3 * m->pairs; row++) {
      const double *r = c + MHB_RING_ROWS + 6 * (row / 3) + row % 3;
      sum -= (r[0] + conj(phase) * r[3]) * p[row];
    }
    sum /= turn - c[MHB_RING_TRACE] + c[MHB_RING_DET] / turn;
    for (int l = 0; l < mhb_ring_model_used(m); l++) {
      double complex a = sum * cexp(-I * mhb_ring_model_lag(m, k, l / m->copies));
      double        *z = place(ring, i, l);
      z[ring->newest] += creal(a);
      z[MHB_LANES - ring->newest] += creal(a / turn);
    }
  }
}

/* The same of a mistuned ring, p[blades][3 pairs]. */
static void add_own_harmonic(mhb_ring *ring, int k, const double complex *p) {
  const mhb_ring_model *m    = ring->model;
  const int             n3   = 3 * m->pairs;
  const double complex  turn = cexp(I * (k * m->omega / m->order) * m->h);
  const int             used = mhb_ring_model_used(m);
  for (int i = 0; i < m->modes * used; i++) {
    const int             mode = i / used, lane = i % used, b = lane / m->copies;
    const double         *c     = m->coefficient + (size_t)mode * (size_t)m->stride + MHB_RING_ROWS;
    const double complex *right = p + b * n3, *left = p + (b > 0 ? b - 1 : m->blades - 1) * n3;
    double complex        sum = 0;
    for (int row = 0; row < n3; row++) {
      const double *r = c + 6 * (row / 3) + row % 3;
      sum -= r[0] * right[row] + r[3] * left[row];
    }
    sum *= *mhb_ring_model_own(m, mode, lane, MHB_RING_GAIN) /
           (turn - *mhb_ring_model_own(m, mode, lane, MHB_RING_TRACE) +
            *mhb_ring_model_own(m, mode, lane, MHB_RING_DET) / turn);
    double *z = place(ring, mode, lane);
    z[ring->newest] += creal(sum);
    z[MHB_LANES - ring->newest] += creal(sum / turn);
  }
}

/* Motion at phase 0 and the state of the contacts; friction within its limit. */
static void settle_contacts(mhb_ring *ring) {
  const mhb_ring_model *m    = ring->model;
  const int             used = mhb_ring_model_used(m);
  double                u[3 * ring->row];
  for (int i = 0; i < 3 * m->pairs; i++)
    for (int l = 0; l < used; l++) {
      size_t at       = (size_t)i * ring->row + MHB_LANES + (size_t)l;
      ring->right[at] = ring->left[at] = 0;
      for (int k = 0; k < m->modes; k++) {
        const double *r =
            m->coefficient + (size_t)k * (size_t)m->stride + MHB_RING_ROWS + 6 * (i / 3) + i % 3;
        ring->right[at] += r[0] * place(ring, k, l)[ring->newest];
        ring->left[at] += r[3] * place(ring, k, l)[ring->newest];
      }
    }
  for (int pair = 0; pair < m->pairs; pair++) {
    const mhb_slip_law *law = &m->law[pair];
    add_sides(ring, pair, u);
    add_free(m, pair, 0, ring->row, u);
    for (size_t l = 0; l < (size_t)used; l++) {
      size_t  row     = ring->row;
      double *p       = ring->p + (size_t)(3 * pair) * row + MHB_LANES + l;
      double *contact = ring->contact + (size_t)(5 * pair) * row + MHB_LANES + l;
      double  n = law->n0 + law->kv * u[l], limit = n > 0 ? law->mu * n : 0;
      double  size = hypot(p[row], p[2 * row]), part = size > limit ? limit / size : 1;
      contact[0]       = n;
      contact[row]     = u[row + l];
      contact[2 * row] = u[2 * row + l];
      contact[3 * row] = p[row] = part * p[row];
      contact[4 * row] = p[2 * row] = part * p[2 * row];
      p[0]                          = (n > 0 ? n : 0) - law->offset;
    }
  }
  close_ring(ring);
}

void mhb_ring_start(mhb_ring *ring, int n_harmonics, const double complex *force) {
  const mhb_ring_model *m  = ring->model;
  int                   n3 = 3 * m->pairs, n = m->ring ? m->blades * n3 : n3;
  double complex        p[n];
  memset(ring->z, 0, sizeof(double) * 2 * (size_t)m->modes * (size_t)m->lanes);
  memset(ring->p, 0, sizeof(double) * (size_t)n3 * ring->row);
  for (int k = 0; k <= n_harmonics; k++) {
    for (int i = 0; i < n; i++) p[i] = force[(size_t)i * ((size_t)n_harmonics + 1) + (size_t)k];
    if (m->ring)
      add_own_harmonic(ring, k, p);
    else
      add_harmonic(ring, k, p);
    for (int l = 0; l < mhb_ring_model_used(m); l++)
      for (int i = 0, b = l / m->copies; i < n3; i++)
        ring->p[(size_t)i * ring->row + MHB_LANES + (size_t)l] +=
            creal(m->ring ? p[b * n3 + i] : p[i] * cexp(-I * mhb_ring_model_lag(m, k, b)));
  }
  settle_contacts(ring);
}

/* ---- life cycle ---- */

void mhb_ring_create(mhb_ring_model *model, mhb_ring *ring) {
  size_t pairs = (size_t)model->pairs, lanes = (size_t)model->lanes;
  *ring = (mhb_ring){
      .model = model, .row = lanes + 2 * MHB_LANES, .n_samples = MHB_RING_SAMPLES * model->order};
  shb_arena *a  = &ring->arena;
  ring->z       = shb_arena_take(a, 2 * (size_t)model->modes * lanes, sizeof(double));
  ring->p       = shb_arena_take(a, 3 * pairs * ring->row, sizeof(double));
  ring->right   = shb_arena_take(a, 3 * pairs * ring->row, sizeof(double));
  ring->left    = shb_arena_take(a, 3 * pairs * ring->row, sizeof(double));
  ring->contact = shb_arena_take(a, 5 * pairs * ring->row, sizeof(double));
  ring->output  = shb_arena_take(a, (size_t)ring->n_samples * 3 * lanes, sizeof(double));
}

void mhb_ring_destroy(mhb_ring *ring) {
  shb_arena_free(&ring->arena);
  *ring = (mhb_ring){0};
}
