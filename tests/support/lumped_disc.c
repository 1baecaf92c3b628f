#include "tests/support/lumped_disc.h"

#include <lapacke.h>

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = DISC_SECTORS, D = DISC_DOFS };

/* K += f^T f stiffness, f a row of the elongation over the dofs. */
static void add_spring(double K[D][D], const double f[D], double stiffness) {
  for (int i = 0; i < D; i++)
    for (int j = 0; j < D; j++) K[i][j] += stiffness * f[i] * f[j];
}

/* Three skew springs between two masses. */
static void join(double K[D][D], int a, int b, double stiffness) {
  static const double along[3][3] = {{1, 0.3, -0.2}, {-0.25, 1, 0.35}, {0.15, -0.3, 1}};
  for (int s = 0; s < 3; s++) {
    double f[D] = {0};
    for (int axis = 0; axis < 3; axis++) {
      f[a + axis] = along[s][axis];
      if (b >= 0) f[b + axis] = -along[(s + a) % 3][(axis + a) % 3];
    }
    add_spring(K, f, stiffness * (1 + 0.23 * s));
  }
}

lumped_disc lumped_disc_of(double coupling, double ground) {
  static const double to[3][3]   = {{1, 0.4, 0.1}, {-0.3, 0.9, 0.2}, {0.2, -0.1, 1.1}};
  static const double from[3][3] = {{0.9, -0.5, 0.3}, {0.6, 1, -0.1}, {-0.35, 0.25, 1}};
  static const double mass[4]    = {1.3, 0.8, 0.35, 0.42};
  lumped_disc         d          = {.damping = 0.02};
  unsigned long long  seed       = 11;
  join(d.own, 0, -1, ground);
  join(d.own, 0, 3, 1.4);
  join(d.own, 3, DISC_RIGHT, 1.1);
  join(d.own, 3, DISC_LEFT, 0.9);
  for (int s = 0; s < 3; s++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        d.own[i][j] += coupling * (to[s][i] * to[s][j] + from[s][i] * from[s][j]);
        d.next[i][j] -= coupling * to[s][i] * from[s][j];
      }
  for (int i = 0; i < D; i++) d.mass[i] = mass[i / 3];
  for (int h = 0; h < DISC_LOADS; h++)
    for (int i = 3; i < D; i++) {
      double re = 0.05 * random_unit(&seed), im = h ? 0.05 * random_unit(&seed) : 0;
      d.load[h][i] = CMPLX(re, im);
    }
  return d;
}

double lumped_disc_coriolis(const lumped_disc *d, int i, int j) {
  static const double cross[3][3] = {{0, 0, 1}, {0, 0, 0}, {-1, 0, 0}}; /* axial x */
  return i / 3 == j / 3 ? 2 * d->spin * d->mass[i] * cross[i % 3][j % 3] : 0;
}

/* ---- a sector at a phase ---- */

typedef struct {
  double         square[D];   /* rad2/s2 */
  double complex shape[D][D]; /* [dof][mode] */
} sector_modes;

static void solve_sector(const lumped_disc *d, double theta, sector_modes *out) {
  static double complex K[D * D]; /* column-major */
  const double complex  e = cexp(-I * theta);
  for (int i = 0; i < D; i++)
    for (int j = 0; j < D; j++)
      K[j * D + i] = (d->own[i][j] + e * d->next[i][j] + conj(e) * d->next[j][i]) /
                     sqrt(d->mass[i] * d->mass[j]);
  assert_int_equal(LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', D, K, D, out->square), 0);
  for (int m = 0; m < D; m++)
    for (int i = 0; i < D; i++) out->shape[i][m] = K[m * D + i] / sqrt(d->mass[i]);
}

static double *take(size_t n) {
  double *x = calloc(n, sizeof *x);
  assert_non_null(x);
  return x;
}

static double complex *take_complex(size_t n) {
  double complex *x = calloc(n, sizeof *x);
  assert_non_null(x);
  return x;
}

/* Dof of contact dof c: right, then left. */
static int contact_dof(int c) {
  return DISC_RIGHT + c;
}

/* phi^H G phi of the lowest modes; nothing without spin. */
static void set_coriolis(const lumped_disc *d, const sector_modes *s, int m, modal_model *re,
                         modal_model *im) {
  if (d->spin == 0) return;
  re->coriolis = take((size_t)(m * m));
  if (im) im->coriolis = take((size_t)(m * m));
  for (int i = 0; i < m; i++)
    for (int j = 0; j < m; j++) {
      double complex sum = 0;
      for (int a = 0; a < D; a++)
        for (int b = 0; b < D; b++)
          sum += conj(s->shape[a][i]) * lumped_disc_coriolis(d, a, b) * s->shape[b][j];
      re->coriolis[i * m + j] = creal(sum);
      if (im) im->coriolis[i * m + j] = cimag(sum);
    }
}

static void set_modes(const sector_modes *s, int m, modal_model *re, modal_model *im,
                      double damping) {
  const int C       = 6;
  re->n_modes       = m;
  re->n_pairs       = 1;
  re->has_left      = true;
  re->frequency     = take((size_t)m);
  re->damping_ratio = take((size_t)m);
  for (int i = 0; i < m; i++) {
    re->frequency[i]     = sqrt(s->square[i]) / SHB_TWO_PI;
    re->damping_ratio[i] = 0.5 * damping * sqrt(s->square[i]);
  }
  for (int part = 0; part < 2; part++) {
    modal_model *to = part ? im : re;
    if (!to) continue;
    to->right = take((size_t)(3 * m));
    to->left  = take((size_t)(3 * m));
    to->probe = take((size_t)(3 * m));
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < m; i++) {
        double complex x[3]  = {s->shape[DISC_RIGHT + a][i], s->shape[DISC_LEFT + a][i],
                                s->shape[DISC_BLADE + a][i]};
        to->right[a * m + i] = part ? cimag(x[0]) : creal(x[0]);
        to->left[a * m + i]  = part ? cimag(x[1]) : creal(x[1]);
        to->probe[a * m + i] = part ? cimag(x[2]) : creal(x[2]);
      }
    double **contact[] = {&to->residual_flexibility, &to->residual_inertia, &to->residual_fourth};
    double **probe[]   = {&to->probe_contact_residual, &to->probe_contact_inertia,
                          &to->probe_contact_fourth};
    for (int t = 0; t < 3 && m < D; t++) {
      *contact[t] = take((size_t)(C * C));
      *probe[t]   = take((size_t)(3 * C));
      for (int i = m; i < D; i++)
        for (int b = 0; b < C; b++) {
          double complex by = conj(s->shape[contact_dof(b)][i]) / pow(s->square[i], t + 1);
          for (int a = 0; a < C; a++) {
            double complex x = s->shape[contact_dof(a)][i] * by;
            (*contact[t])[a * C + b] += part ? cimag(x) : creal(x);
          }
          for (int a = 0; a < 3; a++) {
            double complex x = s->shape[DISC_BLADE + a][i] * by;
            (*probe[t])[a * C + b] += part ? cimag(x) : creal(x);
          }
        }
    }
  }
  re->n_probes      = 1;
  re->probe_name    = calloc(1, sizeof *re->probe_name);
  re->probe_name[0] = strdup("blade");
}

/* Response to the load, or (backward) what the conjugate shapes make of it. */
static void set_load(const lumped_disc *d, const sector_modes *s, int m, bool backward,
                     modal_model *to) {
  const int C     = 6;
  to->n_load      = DISC_LOADS - 1;
  to->modal_force = take_complex((size_t)(DISC_LOADS * m));
  if (m < D) {
    to->load_residual       = take_complex((size_t)(DISC_LOADS * C));
    to->load_inertia        = take_complex((size_t)(DISC_LOADS * C));
    to->load_fourth         = take_complex((size_t)(DISC_LOADS * C));
    to->probe_load_residual = take_complex((size_t)(DISC_LOADS * 3));
    to->probe_load_inertia  = take_complex((size_t)(DISC_LOADS * 3));
    to->probe_load_fourth   = take_complex((size_t)(DISC_LOADS * 3));
  }
  double complex *contact[] = {to->load_residual, to->load_inertia, to->load_fourth};
  double complex *probe[]   = {to->probe_load_residual, to->probe_load_inertia,
                               to->probe_load_fourth};
  for (int h = 0; h < DISC_LOADS; h++)
    for (int i = 0; i < D; i++) {
      double complex f = 0;
      for (int a = 0; a < D; a++)
        f += (backward ? s->shape[a][i] : conj(s->shape[a][i])) * d->load[h][a];
      if (i < m) to->modal_force[h * m + i] = f;
      for (int t = 0; t < 3 && i >= m; t++) {
        double complex by = f / pow(s->square[i], t + 1);
        for (int c = 0; c < C; c++) {
          double complex x = s->shape[contact_dof(c)][i];
          contact[t][h * C + c] += (backward ? conj(x) : x) * by;
        }
        for (int a = 0; a < 3; a++) {
          double complex x = s->shape[DISC_BLADE + a][i];
          probe[t][h * 3 + a] += (backward ? conj(x) : x) * by;
        }
      }
    }
}

lumped_disc lumped_disc_spinning(double speed, double coriolis) {
  const double s = speed * speed;
  lumped_disc  d = lumped_disc_of(0.8 + 0.2 * s, 1.7);
  join(d.own, 3, -1, 0.5 * s);
  join(d.own, DISC_RIGHT, -1, 0.3 * s + 0.1 * s * s);
  d.spin = coriolis * speed;
  return d;
}

/* overlap: phi_0^H M phi; imaginary: NULL of real shapes. */
static void set_overlap(const lumped_disc *d, const sector_modes *first, const sector_modes *s,
                        int modes, double *overlap, double *imaginary) {
  for (int i = 0; i < modes * modes; i++) {
    double complex sum = 0;
    for (int a = 0; a < D; a++)
      sum += conj(first->shape[a][i / modes]) * d->mass[a] * s->shape[a][i % modes];
    overlap[i] = creal(sum);
    if (imaginary) imaginary[i] = cimag(sum);
  }
}

static void set_speed(const lumped_disc *d, int i, int k, sector_modes *first,
                      modal_sector_speeds *out) {
  modal_speeds *to = &out->at[k];
  sector_modes  s;
  const size_t  square = (size_t)(to->n_modes * to->n_modes), at = (size_t)i * square;
  solve_sector(d, SHB_TWO_PI * k / N, &s);
  if (i == 0) *first = s;
  set_modes(&s, to->n_modes, &to->model[i], to->imaginary ? &to->imaginary[i] : NULL, d->damping);
  set_coriolis(d, &s, to->n_modes, &to->model[i], to->imaginary ? &to->imaginary[i] : NULL);
  set_load(d, &s, to->n_modes, false, &to->model[i]);
  if (to->imaginary) set_load(d, &s, to->n_modes, true, &to->backward[i]);
  set_overlap(d, first, &s, to->n_modes, to->overlap + at,
              to->imaginary ? to->overlap_imaginary + at : NULL);
  for (int t = 0; t < to->n_modes; t++) to->mode[i * to->n_modes + t] = t;
}

void lumped_disc_speeds(int n, double lowest, double coriolis, int modes,
                        modal_sector_speeds *out) {
  static sector_modes first[N / 2 + 1];
  modal_sector_speeds_create(N, N / 2 + 1, out);
  for (int k = 0; k <= N / 2; k++) {
    out->diameter[k] = k;
    modal_speeds_create(n, modes, &out->at[k]);
    out->at[k].overlap = take((size_t)(n * modes * modes));
    if (k > 0 && 2 * k < N) modal_speeds_make_complex(&out->at[k]);
    for (int i = 0; i < n; i++) {
      out->at[k].speed[i] = lowest + (1 - lowest) * i / (n - 1.);
      const lumped_disc d = lumped_disc_spinning(out->at[k].speed[i], coriolis);
      set_speed(&d, i, k, &first[k], out);
    }
  }
}

void lumped_disc_waves(const lumped_disc *d, int modes, modal_nodal_diameters *out) {
  modal_nodal_diameters_create(N, N / 2 + 1, out);
  for (int n = 0; n <= N / 2; n++) {
    sector_modes s;
    const bool   complex_too = n > 0 && 2 * n < N;
    solve_sector(d, SHB_TWO_PI * n / N, &s);
    out->diameter[n] = n;
    set_modes(&s, modes, &out->model[n], complex_too ? &out->imaginary[n] : NULL, d->damping);
    set_coriolis(d, &s, modes, &out->model[n], complex_too ? &out->imaginary[n] : NULL);
    set_load(d, &s, modes, false, &out->model[n]);
    if (complex_too) set_load(d, &s, modes, true, &out->backward[n]);
  }
}

void lumped_disc_blade(const lumped_disc *d, int modes, modal_model *out) {
  sector_modes s;
  lumped_disc  alone = *d;
  memset(alone.next, 0, sizeof alone.next);
  *out = (modal_model){0};
  solve_sector(&alone, 0, &s);
  set_modes(&s, modes, out, NULL, d->damping);
  set_coriolis(d, &s, modes, out, NULL);
  set_load(d, &s, modes, false, out);
}

/* ---- the explicit ring ---- */

static double ring_shape(const double *Q, int sector, int dof, int mode) {
  return Q[(size_t)mode * DISC_ALL + (size_t)(sector * D + dof)];
}

static void set_ring_coriolis(const lumped_disc *d, const double *Q, modal_model *out) {
  const int n = DISC_ALL;
  if (d->spin == 0) return;
  out->coriolis = take((size_t)(n * n));
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int b = 0; b < N; b++)
        for (int k = 0; k < D; k++)
          for (int l = k - k % 3; l < k - k % 3 + 3; l++)
            out->coriolis[i * n + j] +=
                ring_shape(Q, b, k, i) * lumped_disc_coriolis(d, k, l) * ring_shape(Q, b, l, j);
}

void lumped_disc_ring(const lumped_disc *d, int engine_order, modal_model *out) {
  const int n = DISC_ALL;
  double   *K = take((size_t)(n * n)), square[DISC_ALL];
  for (int b = 0; b < N; b++)
    for (int i = 0; i < D; i++)
      for (int j = 0; j < D; j++) {
        const int here = b * D, next = (b + 1) % N * D;
        K[(here + j) * n + here + i] += d->own[i][j];
        K[(next + j) * n + here + i] += d->next[i][j];
        K[(here + i) * n + next + j] += d->next[i][j];
      }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) K[j * n + i] /= sqrt(d->mass[i % D] * d->mass[j % D]);
  assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', n, K, n, square), 0);
  for (int m = 0; m < n; m++)
    for (int i = 0; i < n; i++) K[m * n + i] /= sqrt(d->mass[i % D]);
  *out               = (modal_model){.n_modes = n, .n_pairs = N, .n_probes = 1, .n_load = 2};
  out->frequency     = take((size_t)n);
  out->damping_ratio = take((size_t)n);
  out->right         = take((size_t)(3 * N * n));
  out->probe         = take((size_t)(3 * n));
  out->modal_force   = take_complex((size_t)(DISC_LOADS * n));
  out->probe_name    = calloc(1, sizeof *out->probe_name);
  out->probe_name[0] = strdup("blade");
  for (int m = 0; m < n; m++) {
    out->frequency[m]     = sqrt(square[m]) / SHB_TWO_PI;
    out->damping_ratio[m] = 0.5 * d->damping * sqrt(square[m]);
    for (int a = 0; a < 3; a++) {
      out->probe[a * n + m] = ring_shape(K, 0, DISC_BLADE + a, m);
      for (int b = 0; b < N; b++)
        out->right[(3 * b + a) * n + m] =
            ring_shape(K, b, DISC_RIGHT + a, m) - ring_shape(K, (b + 1) % N, DISC_LEFT + a, m);
    }
    for (int h = 0; h < DISC_LOADS; h++)
      for (int b = 0; b < N; b++)
        for (int i = 0; i < D; i++)
          out->modal_force[h * n + m] += ring_shape(K, b, i, m) * d->load[h][i] *
                                         cexp(-I * SHB_TWO_PI * h * engine_order * b / N);
  }
  set_ring_coriolis(d, K, out);
  free(K);
}

/* ---- settings ---- */

mhb_settings lumped_disc_settings(int engine_order, int harmonics) {
  mhb_settings s = random_settings(harmonics);
  s.blades       = N;
  s.engine_order = engine_order;
  return s;
}

mhb_settings lumped_disc_ring_settings(const mhb_settings *settings) {
  mhb_settings s    = *settings;
  s.to_ground       = true;
  s.blades          = 1;
  s.engine_order    = 0;
  s.nodal_diameters = NULL;
  s.kv *= N;
  for (int i = 0; i < 3; i++) s.ku[i] *= N;
  for (int i = 0; i < s.n_preloads; i++) s.n0[i] *= N;
  return s;
}
