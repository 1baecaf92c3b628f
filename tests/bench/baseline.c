#include "baseline.h"
#include "mesh/base/constants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double vec __attribute__((vector_size(32)));

enum { LONGEST_BLOCK = 64, MAX_LAPS = 200 };

static int larger(int a, int b) {
  return a > b ? a : b;
}

static void tabulate(baseline *b) {
  int K = larger(b->m, b->H);
  for (int s = 0; s < b->block; s++) {
    b->table[s] = 1;
    for (int k = 1; k <= K; k++) {
      double angle                         = SHB_TWO_PI * k * s / b->N;
      b->table[(2 * k - 1) * b->block + s] = cos(angle);
      b->table[2 * k * b->block + s]       = -sin(angle);
    }
  }
  for (int i = 0; i < b->N / b->block; i++)
    for (int k = 0; k <= K; k++) {
      double angle = SHB_TWO_PI * k * i * b->block / b->N, *turn = b->turn + 2 * (i * (K + 1) + k);
      turn[0] = cos(angle);
      turn[1] = sin(angle);
    }
}

shb_status baseline_create(baseline_kind kind, int N, int m, int H, baseline *b) {
  int K = larger(m, H), block = N < LONGEST_BLOCK ? N : LONGEST_BLOCK;
  *b            = (baseline){.kind = kind, .N = N, .m = m, .H = H, .block = block};
  size_t length = (size_t)N + 8, /* keeps every array aligned */
      table     = (size_t)(2 * K + 1) * (size_t)block;
  size_t turn = 2 * (size_t)(N / block) * (size_t)(K + 1), all = table + turn + 11 * length;
  b->memory = aligned_alloc(64, (all * sizeof(double) + 63) / 64 * 64);
  SHB_CHECK(b->memory, SHB_ERR_IO, "no memory for %d samples", N);
  memset(b->memory, 0, all * sizeof(double));
  double  *next    = b->memory;
  double **array[] = {&b->n,      &b->x[0], &b->x[1], &b->f[0], &b->f[1], &b->limit,
                      &b->length, &b->d[0], &b->d[1], &b->z,    &b->decay};
  for (size_t i = 0; i < sizeof array / sizeof *array; i++, next += length) *array[i] = next;
  b->table = next;
  b->turn  = next + table;
  tabulate(b);
  return SHB_OK;
}

void baseline_destroy(baseline *b) {
  free(b->memory);
  b->memory = NULL;
}

/* Samples of three signals over one block, from their harmonics a[3][2m+1] about the start of the
 * block. */
static inline __attribute__((always_inline)) void sample_block(const baseline *b, const double *a,
                                                               int first) {
  int size = 2 * b->m + 1;
  for (int s = 0; s < b->block; s += 8) {
    vec sum[3][2] = {{{0}}};
    for (int j = 0; j < size; j++) {
      const vec *basis = (const vec *)(b->table + j * b->block + s);
      for (int i = 0; i < 3; i++) {
        sum[i][0] += a[i * size + j] * basis[0];
        sum[i][1] += a[i * size + j] * basis[1];
      }
    }
    memcpy(b->n + first + s, sum[0], sizeof sum[0]);
    memcpy(b->x[0] + first + s, sum[1], sizeof sum[1]);
    memcpy(b->x[1] + first + s, sum[2], sizeof sum[2]);
  }
}

BASELINE_HOT static void sample(const baseline *b, const double *a, double mu) {
  int K = larger(b->m, b->H), size = 2 * b->m + 1;
  for (int i = 0; i < b->N / b->block; i++) {
    const double *turn = b->turn + 2 * i * (K + 1);
    double        there[3 * size];
    for (int y = 0; y < 3; y++) {
      const double *from = a + y * size;
      double       *to   = there + y * size;
      to[0]              = from[0];
      for (int k = 1; k <= b->m; k++) {
        to[2 * k - 1] = from[2 * k - 1] * turn[2 * k] - from[2 * k] * turn[2 * k + 1];
        to[2 * k]     = from[2 * k - 1] * turn[2 * k + 1] + from[2 * k] * turn[2 * k];
      }
    }
    sample_block(b, there, i * b->block);
  }
  b->n[b->N]    = b->n[0];
  b->x[0][b->N] = b->x[0][0];
  b->x[1][b->N] = b->x[1][0];
  for (int i = 0; i <= b->N; i++) b->limit[i] = mu * (b->n[i] > 0 ? b->n[i] : 0);
}

/* Sums over one block of signal times basis functions j and j + 1. */
static inline __attribute__((always_inline)) void sums(const baseline *b, const double *const y[3],
                                                       int j, double sum[3][2]) {
  const double *basis[2]   = {b->table + j * b->block, b->table + (j + 1) * b->block};
  vec           part[3][2] = {{{0}}};
  for (int s = 0; s < b->block; s += 4)
    for (int i = 0; i < 3; i++) {
      vec value = *(const vec *)(y[i] + s);
      part[i][0] += value * *(const vec *)(basis[0] + s);
      part[i][1] += value * *(const vec *)(basis[1] + s);
    }
  for (int i = 0; i < 3; i++)
    for (int l = 0; l < 2; l++)
      sum[i][l] = part[i][l][0] + part[i][l][1] + part[i][l][2] + part[i][l][3];
}

/* Harmonics 0..H of (max(n, 0), f_1, f_2): the trapezoidal rule. */
BASELINE_HOT static void project(const baseline *b, double *force) {
  int K = larger(b->m, b->H), size = 2 * b->H + 1;
  for (int i = 0; i < b->N; i++) b->n[i] = b->n[i] > 0 ? b->n[i] : 0;
  memset(force, 0, 3 * (size_t)size * sizeof *force);
  for (int i = 0; i < b->N / b->block; i++) {
    const double *turn = b->turn + 2 * i * (K + 1);
    const double *y[3] = {b->n + i * b->block, b->f[0] + i * b->block, b->f[1] + i * b->block};
    for (int l = 0; l < 3; l++) {
      vec part = {0};
      for (int s = 0; s < b->block; s += 4) part += *(const vec *)(y[l] + s);
      force[l * size] += (part[0] + part[1] + part[2] + part[3]) / b->N;
    }
    for (int k = 1; k <= b->H; k++) {
      double sum[3][2];
      sums(b, y, 2 * k - 1, sum);
      for (int l = 0; l < 3; l++) {
        double *F = force + l * size + 2 * k;
        F[-1] += 2. / b->N * (turn[2 * k] * sum[l][0] + turn[2 * k + 1] * sum[l][1]);
        F[0] += 2. / b->N * (turn[2 * k] * sum[l][1] - turn[2 * k + 1] * sum[l][0]);
      }
    }
  }
}

void baseline_return(const double k[2], const double g[2], double limit, double f[2]) {
  double lambda = 0, size = 0;
  for (int i = 0; i < 30; i++) {
    double a[2] = {1 / (1 + lambda * k[0]), 1 / (1 + lambda * k[1])};
    for (int j = 0; j < 2; j++) f[j] = g[j] * a[j];
    double square = f[0] * f[0] + f[1] * f[1];
    size          = sqrt(square);
    if (!(size > limit * (1 + 1e-9))) break;
    /* Newton on 1/|f|, which is nearly linear in lambda and bent so that no step goes too far */
    double slope = f[0] * f[0] * k[0] * a[0] + f[1] * f[1] * k[1] * a[1];
    if (!(limit > 0)) break;
    lambda += square / slope * (size / limit - 1);
  }
  for (int j = 0; j < 2; j++) f[j] = size > 0 ? f[j] * (limit / size) : 0;
}

/* Axes of Ku: column 1 is (c, s), column 2 (-s, c). */
static baseline_law axes_of(const mhb_law *law, double axis[2]) {
  double       angle = .5 * atan2(2 * law->ku[1], law->ku[0] - law->ku[2]);
  baseline_law out   = {.mu = law->mu, .isotropic = law->ku[1] == 0 && law->ku[0] == law->ku[2]};
  double       mean  = .5 * (law->ku[0] + law->ku[2]);
  double       half  = hypot(.5 * (law->ku[0] - law->ku[2]), law->ku[1]);
  axis[0]            = out.isotropic ? 1 : cos(angle);
  axis[1]            = out.isotropic ? 0 : sin(angle);
  out.k[0]           = mean + half;
  out.k[1]           = mean - half;
  return out;
}

static void lap(const baseline *b, const baseline_law *law, int start, int *sliding) {
  for (int part = 0; part < 2; part++) {
    int from = part ? 0 : start, to = part ? start : b->N;
    if (from == to) continue;
    if (b->kind == BASELINE_RETURN)
      baseline_march_return(b, law, from, to);
    else
      baseline_march_closed(b, law, from, to, sliding);
    if (to == b->N)
      for (int i = 0; i < 2; i++) b->f[i][0] = b->f[i][b->N];
  }
}

/* Laps until the slider has settled. The change of a lap is taken to go on falling as it does. */
static int march(const baseline *b, const baseline_law *law, const double mean[2]) {
  int    start = -1, sliding = 0, laps = 0;
  double top = 0, before = 0;
  for (int i = 0; i < b->N; i++) {
    if (b->n[i] <= 0 && b->n[i + 1] > 0) start = i;
    if (b->limit[i] > top) top = b->limit[i];
  }
  if (start >= 0 || !(top > 0)) {
    if (start < 0) start = 0;
    b->f[0][start] = b->f[1][start] = 0;
    lap(b, law, start, &sliding);
    return 1;
  }
  double g[2] = {b->x[0][0] - mean[0], b->x[1][0] - mean[1]}, f[2] = {g[0], g[1]};
  double tolerance = b->kind == BASELINE_RETURN ? .05 / b->N : .3 / ((double)b->N * b->N);
  if (hypot(g[0], g[1]) > b->limit[0]) baseline_return(law->k, g, b->limit[0], f);
  for (int i = 0; i < 2; i++) b->f[i][0] = f[i];
  for (double left = INFINITY; left > tolerance * top / law->mu && laps < MAX_LAPS; laps++) {
    double old[2] = {b->f[0][0], b->f[1][0]};
    lap(b, law, 0, &sliding);
    double change = hypot(b->f[0][0] - old[0], b->f[1][0] - old[1]);
    double ratio  = laps ? fmin(change / before, .99) : .6;
    left          = change > 0 ? change * ratio / (1 - ratio) : 0;
    before        = change;
  }
  return laps;
}

int baseline_force(baseline *b, const mhb_law *law, const double *motion, double *force) {
  double       axis[2], a[3][2 * b->m + 1];
  baseline_law own  = axes_of(law, axis);
  int          size = 2 * b->m + 1, out = 2 * b->H + 1;
  for (int j = 0; j < size; j++) {
    double u = motion[size + j], w = motion[2 * size + j];
    a[0][j] = law->kv * motion[j] + (j ? 0 : law->n0);
    a[1][j] = own.k[0] * (axis[0] * u + axis[1] * w);
    a[2][j] = own.k[1] * (axis[0] * w - axis[1] * u);
  }
  sample(b, a[0], own.mu);
  if (b->kind == BASELINE_CLOSED) baseline_prepare_closed(b, &own);
  int laps = march(b, &own, (double[2]){a[1][0], a[2][0]});
  project(b, force);
  for (int j = 0; j < out; j++) {
    double f[2]        = {force[out + j], force[2 * out + j]};
    force[out + j]     = axis[0] * f[0] - axis[1] * f[1];
    force[2 * out + j] = axis[1] * f[0] + axis[0] * f[1];
  }
  force[0] -= law->mean_offset;
  return laps;
}
