#include "mhb/numerics/fourier.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

void mhb_to_real(int m, const double complex *A, double *a) {
  a[0] = creal(A[0]);
  for (int k = 1; k <= m; k++) {
    a[2 * k - 1] = creal(A[k]);
    a[2 * k]     = cimag(A[k]);
  }
}

void mhb_basis(int m, double t, double *basis, double *slope) {
  double c1 = cos(t), s1 = sin(t), c = 1, s = 0;
  basis[0] = 1;
  if (slope) slope[0] = 0;
  for (int k = 1; k <= m; k++) {
    double next = c * c1 - s * s1;
    s           = s * c1 + c * s1;
    c           = next;

    basis[2 * k - 1] = c;
    basis[2 * k]     = -s;
    if (!slope) continue;
    slope[2 * k - 1] = -k * s;
    slope[2 * k]     = -k * c;
  }
}

void mhb_basis_integral(int n, double t0, double t1, double *integral) {
  /* integral of cos kt = (2/k) cos(k mid) sin(k half): no cancellation on short intervals */
  double mid = .5 * (t0 + t1), half = .5 * (t1 - t0);
  double c1 = cos(mid), s1 = sin(mid), c = 1, s = 0;
  double p1 = cos(half), q1 = sin(half), p = 1, q = 0;
  integral[0] += t1 - t0;
  for (int k = 1; k <= n; k++) {
    double next = c * c1 - s * s1;
    s           = s * c1 + c * s1;
    c           = next;
    next        = p * p1 - q * q1;
    q           = q * p1 + p * q1;
    p           = next;
    integral[2 * k - 1] += 2 * c * q / k;
    integral[2 * k] -= 2 * s * q / k;
  }
}

/* Integrals of cos kt and sin kt for any sign of k, from the integrals of the basis. */
static inline double cos_integral(const double *integral, int k) {
  return k == 0 ? integral[0] : integral[2 * abs(k) - 1];
}

static inline double sin_integral(const double *integral, int k) {
  return k == 0 ? 0 : k > 0 ? -integral[2 * k] : integral[-2 * k];
}

void mhb_basis_product(int p, int q, const double *integral, double *product, int ld) {
  for (int j = 0; j <= 2 * q; j++) product[j] = integral[j];
  for (int i = 1; i <= p; i++) {
    double *row_c = product + (size_t)(2 * i - 1) * (size_t)ld, *row_s = row_c + ld;
    row_c[0] = integral[2 * i - 1];
    row_s[0] = integral[2 * i];
    for (int k = 1; k <= q; k++) {
      double cd = cos_integral(integral, i - k), cs = cos_integral(integral, i + k);
      double sd = sin_integral(integral, i - k), ss = sin_integral(integral, i + k);
      row_c[2 * k - 1] = .5 * (cd + cs);  /* cos i cos k */
      row_c[2 * k]     = .5 * (sd - ss);  /* -cos i sin k */
      row_s[2 * k - 1] = -.5 * (sd + ss); /* -sin i cos k */
      row_s[2 * k]     = .5 * (cd - cs);  /* sin i sin k */
    }
  }
}

/* Index of the grid for m harmonics: at least 8 (m + 1) points. */
static int grid_of(int m) {
  int grid = 0;
  while (MHB_LEAST_GRID << grid < 8 * (m + 1)) grid++;
  return grid;
}

shb_status mhb_signals_create(int m, mhb_signals *signals) {
  memset(signals, 0, sizeof *signals);
  int grid = grid_of(m), most = MHB_LEAST_GRID << grid, half = most / 2 + 1,
      room = most + MHB_LANES;
  SHB_CHECK(grid < MHB_GRIDS, SHB_ERR_IO, "out of memory for %d harmonics", m);
  size_t     size = 3 * (size_t)mhb_real_size(m), whole = (size_t)mhb_whole_lanes(m);
  shb_arena *arena      = &signals->arena;
  signals->m            = m;
  signals->n_grid       = most;
  signals->largest_grid = most;
  signals->coefficient  = shb_arena_try(arena, size, sizeof(double));
  signals->derivative   = shb_arena_try(arena, size, sizeof(double));
  signals->by_harmonic  = shb_arena_try(arena, 2 * MHB_LANES * whole, sizeof(double));
  signals->spectrum     = shb_arena_try(arena, 6 * (size_t)half, sizeof(fftw_complex));
  signals->samples      = shb_arena_try(arena, 6 * (size_t)room, sizeof(double));
  signals->wave         = shb_arena_try(arena, 2 * MHB_TABLE * MHB_LEAST_GRID, sizeof(double));
  bool ok               = !arena->failed;
  for (int k = 0; k < MHB_TABLE && ok; k++)
    for (int i = 0; i < MHB_LEAST_GRID; i++) {
      double *wave = signals->wave + 2 * k * MHB_LEAST_GRID + i, t = SHB_TWO_PI * i;
      wave[0]              = cos((k + 1) * t / MHB_LEAST_GRID);
      wave[MHB_LEAST_GRID] = sin((k + 1) * t / MHB_LEAST_GRID);
    }
  for (int i = 1; i <= grid && ok; i++) {
    int n = MHB_LEAST_GRID << i;
#pragma omp critical(fftw_planner) /* FFTW's planner is not thread safe */
    signals->plan[i] =
        fftw_plan_many_dft_c2r(1, &n, 6, signals->spectrum, NULL, 1, half, signals->samples, NULL,
                               1, room, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    ok = signals->plan[i] != NULL;
  }
  for (int i = 0; i < 3; i++) {
    signals->value[i] = signals->samples + i * room;
    signals->slope[i] = signals->samples + (i + 3) * room;
  }
  if (ok) return SHB_OK;
  mhb_signals_destroy(signals);
  SHB_FAIL(SHB_ERR_IO, "out of memory for %d harmonics", m);
}

void mhb_signals_destroy(mhb_signals *signals) {
  if (!signals) return;
#pragma omp critical(fftw_planner)
  for (int i = 0; i < MHB_GRIDS; i++)
    if (signals->plan[i]) fftw_destroy_plan(signals->plan[i]);
  shb_arena_free(&signals->arena);
  memset(signals, 0, sizeof *signals);
}

static void set_bounds(mhb_signals *signals, int i, const double *a) {
  double *bound = signals->bound[i];
  bound[0]      = fabs(a[0]);
  for (int j = 1; j < 5; j++) bound[j] = 0;
  for (int k = 1; k <= signals->top; k++) {
    double size = sqrt(a[2 * k - 1] * a[2 * k - 1] + a[2 * k] * a[2 * k]);
    for (int j = 0; j < 5; j++, size *= k) bound[j] += size;
  }
}

static int highest_harmonic(int m, const double *const a[3]) {
  for (int k = m; k > 0; k--)
    for (int i = 0; i < 3; i++)
      if (a[i][2 * k - 1] != 0 || a[i][2 * k] != 0) return k;
  return 0;
}

/* Values and slopes on the least grid by the table. */
MHB_HOT static void sum_on_table(mhb_signals *signals) {
  for (int at = 0; at < MHB_LEAST_GRID; at += MHB_LANES) {
    const double *a = signals->coefficient, *b = signals->derivative;
    mhb_lanes     y[3], dy[3];
    for (int i = 0; i < 3; i++) {
      y[i]  = lanes_all(a[i]);
      dy[i] = lanes_all(0);
    }
    a += 3;
    b += 3;
    for (int k = 0; k < signals->top; k++, a += 6, b += 6) {
      const double *wave = signals->wave + 2 * k * MHB_LEAST_GRID + at;
      mhb_lanes     c = lanes_load(wave), s = lanes_load(wave + MHB_LEAST_GRID);
      for (int i = 0; i < 3; i++) {
        y[i] += a[i] * c - a[i + 3] * s;
        dy[i] -= b[i] * s + b[i + 3] * c;
      }
    }
    for (int i = 0; i < 3; i++) {
      lanes_store(signals->value[i] + at, y[i]);
      lanes_store(signals->slope[i] + at, dy[i]);
    }
  }
}

/* The same on a finer grid by FFT. */
static void transform(mhb_signals *signals, int grid, const double *const a[3]) {
  int half = signals->largest_grid / 2 + 1;
  for (int i = 0; i < 6; i++)
    memset(signals->spectrum + (size_t)i * (size_t)half, 0,
           sizeof(fftw_complex) * (size_t)(signals->n_grid / 2 + 1));
  for (int i = 0; i < 3; i++) {
    fftw_complex *X = signals->spectrum + (size_t)i * (size_t)half, *dX = X + 3 * (size_t)half;
    X[0] = a[i][0];
    for (int k = 1; k <= signals->top; k++) {
      X[k]  = CMPLX(.5 * a[i][2 * k - 1], .5 * a[i][2 * k]);
      dX[k] = CMPLX(-.5 * k * a[i][2 * k], .5 * k * a[i][2 * k - 1]);
    }
  }
  fftw_execute(signals->plan[grid]);
}

void mhb_signals_set(mhb_signals *signals, const double *const a[3]) {
  int top = highest_harmonic(signals->m, a), grid = grid_of(top), n = MHB_LEAST_GRID << grid;
  signals->top    = top;
  signals->n_grid = n;
  memset(signals->by_harmonic + 2 * MHB_LANES * top, 0,
         sizeof(double) * 2 * MHB_LANES * (size_t)(mhb_whole_lanes(top) - top));
  for (int i = 0; i < 3; i++) {
    double *coefficient = signals->coefficient + i, *rate = signals->derivative + i;
    coefficient[0] = a[i][0];
    double *at     = signals->by_harmonic + i;
    for (int k = 1; k <= top; k++, at += 2 * MHB_LANES) {
      double even = a[i][2 * k - 1], odd = a[i][2 * k];
      coefficient[6 * k - 3] = at[0] = even;
      coefficient[6 * k]             = odd;
      rate[6 * k - 3]                = k * even;
      rate[6 * k]                    = k * odd;
      at[4]                          = -k * odd;
      at[MHB_LANES]                  = -odd;
      at[MHB_LANES + 4]              = -k * even;
    }
    set_bounds(signals, i, a[i]);
  }
  if (grid == 0) {
    sum_on_table(signals);
  } else {
    transform(signals, grid, a);
  }
  for (int i = 0; i < 3; i++) {
    memcpy(signals->value[i] + n, signals->value[i], sizeof(double) * MHB_LANES);
    memcpy(signals->slope[i] + n, signals->slope[i], sizeof(double) * MHB_LANES);
  }
}

/* The phase nearest to zero that is the same. */
MHB_INLINE double least_phase(double t) {
  const double magic = 6755399441055744.0; /* 1.5 2^52: adding it rounds to an integer */
  const double turns = (t * (1 / SHB_TWO_PI) + magic) - magic;
  return (t - turns * 6.28318530717958623200) - turns * 2.44929359829470641435e-16;
}

MHB_HOT void mhb_signals_at(const mhb_signals *signals, double t, double y[3], double dy[3],
                            double ddy[3]) {
  mhb_lanes     order = {1, 2, 3, 4, 5, 6, 7, 8}, c, s, sum[2] = {{0}}, bent[2] = {{0}};
  const double  phase = least_phase(t);
  const double *a     = signals->by_harmonic;
  for (int k = 0; k < signals->top; k += MHB_LANES, order += MHB_LANES) {
    lanes_cos_sin(order * phase, &c, &s);
    mhb_lanes square = order * order;
#pragma GCC unroll 8
    for (int i = 0; i < MHB_LANES; i++, a += 2 * MHB_LANES) {
      mhb_lanes even = lanes_load(a) * lanes_pick(c, i);
      mhb_lanes odd  = lanes_load(a + MHB_LANES) * lanes_pick(s, i);
      sum[0] += even;
      sum[1] += odd;
      if (!ddy) continue;
      bent[0] += even * lanes_pick(square, i);
      bent[1] += odd * lanes_pick(square, i);
    }
  }
  sum[0] += sum[1];
  bent[0] += bent[1];
  for (int i = 0; i < 3; i++) {
    y[i]  = signals->coefficient[i] + sum[0][i];
    dy[i] = sum[0][4 + i];
    if (ddy) ddy[i] = -bent[0][i];
  }
}
