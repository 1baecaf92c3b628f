#include "mhb/variation/variational.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/variation/propagator.h"

static int unknowns(const mhb_modal_structure *s) {
  return 3 * s->contacts;
}

/* Different ones. */
static int oscillators(const mhb_modal_structure *s) {
  return s->modes * (s->mistuned ? s->blades : 1);
}

/* [mode][PROPAGATOR] of a blade. */
static const double *propagator_of(const mhb_variational *v, int blade) {
  const mhb_modal_structure *s = v->structure;
  return v->propagator + (s->mistuned ? (size_t)(blade * s->modes) * PROPAGATOR : 0);
}

static int modal_rows(const mhb_modal_structure *s) {
  return s->blades * s->modes;
}

/* What a jump at a transition and the laws need in any case. */
static void take_laws(mhb_variational *v) {
  size_t contacts = (size_t)v->structure->contacts, n = 3 * contacts;
  v->linearised = shb_arena_take(&v->arena, contacts, sizeof *v->linearised);
  v->du         = shb_arena_take(&v->arena, n, sizeof(double));
  v->dsigma     = shb_arena_take(&v->arena, 2 * contacts, sizeof(double));
  v->dp         = shb_arena_take(&v->arena, n, sizeof(double));
}

static void take_band(mhb_variational *v) {
  const mhb_modal_structure *s      = v->structure;
  size_t                     n      = (size_t)unknowns(s);
  int                        groups = mhb_modal_structure_groups(s);
  size_t                     blocks = ((size_t)v->capacity + MHB_COLUMNS - 1) / MHB_COLUMNS;
  v->Y    = shb_arena_take(&v->arena, blocks * (size_t)v->rows, sizeof(mhb_columns));
  v->P    = shb_arena_take(&v->arena, blocks * n, sizeof(mhb_columns));
  v->work = shb_arena_take(&v->arena, 3 * n, sizeof(mhb_columns));
  if (!s->disc)
    v->propagator = shb_arena_take(&v->arena, (size_t)oscillators(s) * PROPAGATOR, sizeof(double));
  v->compliance = shb_arena_take(&v->arena, n * n, sizeof(double));
  v->neighbour  = shb_arena_take(&v->arena, (size_t)groups, sizeof *v->neighbour);
  mhb_ring_band_create(groups, unknowns(s) / groups, &v->band);
  if (s->disc) v->disc = mhb_disc_propagation_create(s->disc);
  for (int b = 0; b < groups; b++)
    v->n_neighbours = mhb_ring_band_neighbours(&v->band, b, v->neighbour[b]);
}

mhb_variational *mhb_variational_create(const mhb_modal_structure *s,
                                        const mhb_stuck_springs *springs, int capacity) {
  mhb_variational *v = shb_alloc_zeroed(1, sizeof *v);
  v->structure       = s;
  v->capacity        = capacity;
  v->rows            = 2 * modal_rows(s) + 5 * s->contacts;
  v->h               = -1;
  take_laws(v);
  if (springs)
    v->sliders = mhb_slider_propagation_create(springs, capacity);
  else
    take_band(v);
  return v;
}

void mhb_variational_destroy(mhb_variational *v) {
  if (!v) return;
  shb_arena_free(&v->arena);
  mhb_ring_band_destroy(&v->band);
  mhb_disc_propagation_destroy(v->disc);
  mhb_slider_propagation_destroy(v->sliders);
  free(v);
}

void mhb_variational_clear(mhb_variational *v, int columns) {
  if (v->sliders) {
    mhb_slider_propagation_clear(v->sliders, columns);
    return;
  }
  v->columns    = columns;
  v->blocks     = (columns + MHB_COLUMNS - 1) / MHB_COLUMNS;
  size_t blocks = (size_t)v->blocks;
  memset(v->Y, 0, blocks * (size_t)v->rows * sizeof *v->Y);
  memset(v->P, 0, blocks * (size_t)unknowns(v->structure) * sizeof *v->P);
}

static mhb_columns *block_rows(const mhb_variational *v, int k) {
  return v->Y + (long)k * v->rows;
}

void mhb_variational_begin(mhb_variational *v) {
  int rows = modal_rows(v->structure);
  for (int k = 0; v->disc && k < v->blocks; k++)
    mhb_disc_propagation_begin(v->disc, block_rows(v, k), block_rows(v, k) + rows);
}

/* ---- modes ---- */

/* C: change of du over h by unit mean forces. */
static void set_compliance(mhb_variational *v) {
  const mhb_modal_structure *s = v->structure;
  int                        n = unknowns(s), n3 = 3 * s->pairs;
  memset(v->compliance, 0, sizeof(double) * (size_t)n * (size_t)n);
  for (int k = 0; k < s->blades * s->sides * s->sides; k++) {
    int blade = k / (s->sides * s->sides), to = k / s->sides % s->sides, by = k % s->sides;
    const double *phi = s->shape + (size_t)to * (size_t)(s->modes * n3);
    const double *psi = s->shape + (size_t)by * (size_t)(s->modes * n3);
    double       *C   = v->compliance +
                (size_t)(3 * mhb_modal_structure_contact(s, blade, to)) * (size_t)n +
                3 * mhb_modal_structure_contact(s, blade, by);
    for (int i = 0; i < s->modes; i++) {
      double answer = propagator_of(v, blade)[i * PROPAGATOR + DQ_P];
      for (int r = 0; r < n3; r++)
        for (int c = 0; c < n3; c++)
          C[(size_t)r * (size_t)n + (size_t)c] += phi[i * n3 + r] * answer * psi[i * n3 + c];
    }
  }
}

/* q and v of all modes by the mean force P of the last sub-step. */
MHB_HOT static void apply_force(const mhb_variational *v, mhb_columns *Y, const mhb_columns *P) {
  const mhb_modal_structure *s  = v->structure;
  int                        n3 = 3 * s->pairs, m = s->modes;
  for (int k = 0; k < s->blades * s->sides; k++) {
    int                b = k / s->sides, side = k % s->sides;
    const double      *shape = s->shape + side * m * n3, *e = propagator_of(v, b);
    const mhb_columns *p = P + 3 * mhb_modal_structure_contact(s, b, side);
    for (int i = 0; i < m; i++) {
      mhb_columns force = {0};
      for (int r = 0; r < n3; r++) force += shape[i * n3 + r] * p[r];
      Y[b * m + i] -= e[i * PROPAGATOR + DQ_P] * force;
      Y[(s->blades + b) * m + i] -= e[i * PROPAGATOR + V_P] * force;
    }
  }
}

/* The last mean force takes effect on the modes. */
static void flush(mhb_variational *v) {
  int n = unknowns(v->structure), rows = modal_rows(v->structure);
  if (v->h < 0) return;
  for (int k = 0; k < v->blocks; k++) {
    mhb_columns *Y = block_rows(v, k), *P = v->P + (long)k * n;
    if (v->disc) {
      mhb_disc_propagation_apply(v->disc, Y, Y + rows, P);
    } else {
      apply_force(v, Y, P);
    }
    memset(P, 0, sizeof *P * (size_t)n);
  }
}

void mhb_variational_finish(mhb_variational *v) {
  int rows = modal_rows(v->structure);
  if (v->sliders) {
    mhb_slider_propagation_finish(v->sliders);
    return;
  }
  flush(v);
  for (int k = 0; v->disc && k < v->blocks; k++)
    mhb_disc_propagation_end(v->disc, block_rows(v, k), block_rows(v, k) + rows);
}

int mhb_variational_set_step(mhb_variational *v, double h) {
  const mhb_modal_structure *s = v->structure;
  if (v->sliders) return mhb_slider_propagation_set_step(v->sliders, h);
  if (h == v->h) return 1;
  flush(v);
  v->h = h;
  if (v->disc) {
    mhb_disc_propagation_set_step(v->disc, h, v->compliance);
    return 1;
  }
  for (int i = 0; i < oscillators(s); i++)
    propagator_set(s->omega[i], s->zeta[i % s->modes], h, v->propagator + i * PROPAGATOR);
  set_compliance(v);
  return 1;
}

void mhb_variational_forget(mhb_variational *v) {
  v->h = -1;
  if (v->sliders) v->sliders->h = -1;
}

/* ---- the contacts' system ---- */

/* Element of I + C mean_du/2 + R df_du. */
static double coupling(const mhb_variational *v, int row, int column) {
  const mhb_linearised_law *linearised = &v->linearised[column / 3];
  long                      first      = (long)row * v->band.n + column - column % 3;
  const double             *C = v->compliance + first, *R = v->structure->flexibility;
  double                    sum = row == column;
  for (int k = 0; k < 3; k++) {
    sum += 0.5 * C[k] * linearised->mean_du[k][column % 3];
    if (R) sum += R[first + k] * linearised->df_du[k][column % 3];
  }
  return sum;
}

int mhb_variational_factor(mhb_variational *v) {
  if (v->sliders) return mhb_slider_propagation_factor(v->sliders, v->linearised);
  int block = v->band.block;
  mhb_ring_band_clear(&v->band);
  for (int row = 0; row < v->band.n; row++)
    for (int i = 0; i < v->n_neighbours; i++) {
      int first = v->neighbour[row / block][i] * block;
      for (int column = first; column < first + block; column++)
        *mhb_ring_band_at(&v->band, row, column) = coupling(v, row, column);
    }
  return mhb_ring_band_factor(&v->band);
}

/* ---- one sub-step ---- */

/* Modes of one blade: apply the last mean force P, then propagate freely; W += B (change of q). */
MHB_INLINE void advance_blade(int sides, int n3, int modes, const double *propagator,
                              const double *const shape[2], mhb_columns *const y[2],
                              const mhb_columns *const P[2], mhb_columns *const W[2]) {
  mhb_columns *q = y[0], *v = y[1];
  for (int i = 0; i < modes; i++) {
    const double *e     = propagator + i * PROPAGATOR;
    mhb_columns   force = {0};
    for (int side = 0; side < sides; side++)
      for (int r = 0; r < n3; r++) force += shape[side][i * n3 + r] * P[side][r];
    mhb_columns q0 = q[i] - e[DQ_P] * force, v0 = v[i] - e[V_P] * force;
    mhb_columns dq = e[DQ_Q] * q0 + e[DQ_V] * v0;
    for (int side = 0; side < sides; side++)
      for (int r = 0; r < n3; r++) W[side][r] += shape[side][i * n3 + r] * dq;
    q[i] = q0 + dq;
    v[i] = e[V_Q] * q0 + e[V_V] * v0;
  }
}

/* y = (dv, sigma) of contact j */
MHB_INLINE void contact_rows(const mhb_columns *u, const mhb_columns *sigma, int j,
                             mhb_columns y[3]) {
  y[0] = u[3 * j];
  y[1] = sigma[2 * j];
  y[2] = sigma[2 * j + 1];
}

MHB_INLINE mhb_columns dot3(const double a[3], const mhb_columns *x) {
  return a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
}

/* D = W - M x; M [n][n] couples the contacts of neighbouring blades. */
MHB_INLINE void subtract_product(const mhb_variational *v, int n, int block, int n_neighbours,
                                 const double *M, const mhb_columns *x, const mhb_columns *W,
                                 mhb_columns *D) {
  for (int r = 0; r < n; r++) {
    const double *row = M + (long)r * n;
    mhb_columns   sum = W[r];
    for (int i = 0; i < n_neighbours; i++) {
      int first = n_neighbours > 1 ? v->neighbour[r / block][i] * block : 0;
      for (int c = first; c < first + block; c++) sum -= row[c] * x[c];
    }
    D[r] = sum;
  }
}

typedef struct {
  int blades, sides, pairs, neighbours;
} ring_size;

/* One block of columns over the sub-step: rows Y, mean force P; W [n] zero, D [n] and df [n] are
 * scratch. The size is an argument so that the common case, one contact, is compiled with
 * constants. */
MHB_INLINE void step_block(const mhb_variational *v, ring_size size, mhb_columns *Y, mhb_columns *P,
                           mhb_columns *W, mhb_columns *D, mhb_columns *df) {
  const mhb_modal_structure *s      = v->structure;
  const int                  blades = size.blades, sides = size.sides;
  const int                  n3 = 3 * size.pairs, n = blades * n3, m = s->modes;
  const int                  block = size.neighbours == 1 ? n : n3;
  mhb_columns               *u = Y + 2 * blades * m, *sigma = u + n, y[3];
  if (v->disc) mhb_disc_propagation_advance(v->disc, Y, Y + blades * m, P, W);
  for (int b = 0; b < blades && !v->disc; b++) { /* W, the modes propagating freely */
    int right = 3 * mhb_modal_structure_contact(s, b, 0);
    int left  = 3 * mhb_modal_structure_contact(s, b, sides - 1);
    advance_blade(sides, n3, m, propagator_of(v, b),
                  (const double *const[2]){s->shape, s->shape + (sides - 1) * m * n3},
                  (mhb_columns *const[2]){Y + b * m, Y + (blades + b) * m},
                  (const mhb_columns *const[2]){P + right, P + left},
                  (mhb_columns *const[2]){W + right, W + left});
  }
  for (int j = 0; j < n / 3; j++) { /* forces by y alone */
    const mhb_linearised_law *law = &v->linearised[j];
    contact_rows(u, sigma, j, y);
    for (int r = 0; r < 3; r++) {
      P[3 * j + r]  = dot3(law->mean_y[r], y);
      df[3 * j + r] = dot3(law->df_y[r], y);
    }
  }
  subtract_product(v, n, block, size.neighbours, v->compliance, P, W, D);
  if (s->flexibility) subtract_product(v, n, block, size.neighbours, s->flexibility, df, D, D);
  mhb_ring_band_solve(&v->band, D, df); /* D is the change of u; df serves as scratch */
  for (int j = 0; j < n / 3; j++) {
    const mhb_linearised_law *law = &v->linearised[j];
    contact_rows(u, sigma, j, y);
    for (int r = 0; r < 3; r++) P[3 * j + r] += 0.5 * dot3(law->mean_du[r], D + 3 * j);
    for (int i = 0; i < 2; i++)
      sigma[2 * j + i] = dot3(law->state_y[i], y) + dot3(law->state_du[i], D + 3 * j);
    for (int r = 0; r < 3; r++) u[3 * j + r] += D[3 * j + r];
  }
}

/* A blade on the ground with one contact. */
MHB_HOT static void step_one_contact(const mhb_variational *v, mhb_columns *Y, mhb_columns *P) {
  mhb_columns W[3] = {{0}}, D[3], df[3]; /* W stays in registers */
  step_block(v, (ring_size){1, 1, 1, 1}, Y, P, W, D, df);
}

/* A ring of blades with one contact each. */
MHB_HOT static void step_ring(const mhb_variational *v, mhb_columns *Y, mhb_columns *P,
                              mhb_columns *W) {
  int n = unknowns(v->structure);
  memset(W, 0, sizeof *W * (size_t)n);
  step_block(v, (ring_size){v->structure->blades, 2, 1, 3}, Y, P, W, W + n, W + 2 * n);
}

MHB_HOT static void step_any(const mhb_variational *v, mhb_columns *Y, mhb_columns *P,
                             mhb_columns *W) {
  const mhb_modal_structure *s = v->structure;
  int                        n = unknowns(s);
  memset(W, 0, sizeof *W * (size_t)n);
  const ring_size size = {s->blades, s->sides, s->pairs, v->n_neighbours};
  step_block(v, size, Y, P, W, W + n, W + 2 * n);
}

void mhb_variational_step(mhb_variational *v) {
  if (v->sliders) {
    mhb_slider_propagation_step(v->sliders, v->linearised);
    return;
  }
  const mhb_modal_structure *s = v->structure;
  int                        n = unknowns(s);
  for (int k = 0; k < v->blocks; k++) {
    mhb_columns *Y = block_rows(v, k), *P = v->P + (long)k * n;
    if (n == 3 && s->sides == 1 && !v->disc) {
      step_one_contact(v, Y, P);
    } else if (s->sides == 2 && s->pairs == 1 && v->n_neighbours == 3) {
      step_ring(v, Y, P, v->work);
    } else {
      step_any(v, Y, P, v->work);
    }
  }
}

/* ---- transitions ---- */

void mhb_variational_saltation(mhb_variational *v, const mhb_saltation *jump) {
  if (v->sliders) {
    mhb_slider_propagation_jump(v->sliders, jump, v->du, v->dsigma, v->dp);
    return;
  }
  const mhb_modal_structure *s = v->structure;
  int                        n = unknowns(s), j = jump->contact;
  for (int k = 0; k < v->blocks; k++) {
    mhb_columns *u = block_rows(v, k) + 2 * modal_rows(s), *sigma = u + n, y[3];
    contact_rows(u, sigma, j, y);
    for (int i = 0; i < 2; i++) sigma[2 * j + i] = dot3(jump->set[i], y);
    if (!s->flexibility) continue;
    mhb_columns alpha = dot3(jump->measure, y);
    for (int i = 0; i < n; i++) u[i] += v->du[i] * alpha;
    for (int i = 0; i < 2 * s->contacts; i++) sigma[i] += v->dsigma[i] * alpha;
  }
}
