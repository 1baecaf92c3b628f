#include "tests/support/random_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

double random_unit(unsigned long long *seed) {
  *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*seed >> 11) / 4503599627370496. - 1;
}

static double *list(size_t n, double size, unsigned long long *seed) {
  double *x = malloc(n * sizeof *x);
  for (size_t i = 0; i < n; i++) x[i] = size * random_unit(seed);
  return x;
}

static double complex *complex_list(size_t n, double size, unsigned long long *seed) {
  double complex *x = malloc(n * sizeof *x);
  for (size_t i = 0; i < n; i++) {
    double re = random_unit(seed), im = random_unit(seed);
    x[i] = size * CMPLX(re, im);
  }
  return x;
}

/* Positive semidefinite. */
static double *symmetric(int n, double size, unsigned long long *seed) {
  double *a = list((size_t)(n * n), 1, seed), *s = calloc((size_t)(n * n), sizeof *s);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++) s[i * n + j] += size / n * a[i * n + k] * a[j * n + k];
  free(a);
  return s;
}

static void add_normals(modal_model *model, unsigned long long *seed) {
  model->normal = malloc(sizeof(double) * 3 * (size_t)model->n_pairs);
  for (int a = 0; a < model->n_pairs; a++) {
    double psi = (35 + 3 * random_unit(seed)) * SHB_PI / 180,
           phi = (10 + 3 * random_unit(seed)) * SHB_PI / 180, *v = model->normal + 3 * a;
    v[0] = cos(psi) * cos(phi);
    v[1] = sin(psi) * cos(phi);
    v[2] = -sin(phi);
  }
}

/* Inertia of load and probes, the term of w^4. Its seed is its own, so the normals that follow do
 * not depend on it. */
static void add_inertia(modal_model *model, unsigned long long seed) {
  int    nc = 3 * model->n_pairs * (model->has_left ? 2 : 1), q = 3 * model->n_probes;
  size_t loads                 = (size_t)model->n_load + 1;
  model->load_inertia          = complex_list(loads * (size_t)nc, .005, &seed);
  model->probe_contact_inertia = list((size_t)(q * nc), .01, &seed);
  model->probe_load_inertia    = complex_list(loads * (size_t)q, .005, &seed);
  model->residual_fourth       = symmetric(nc, .002, &seed);
}

static void add_residual_modes(modal_model *model, unsigned long long seed) {
  int    nc = 3 * model->n_pairs * (model->has_left ? 2 : 1), q = 3 * model->n_probes;
  size_t loads = (size_t)model->n_load + 1, r = 3;
  model->n_residual           = (int)r;
  model->residual_frequency   = malloc(r * sizeof(double));
  model->residual_shape       = list((size_t)nc * r, .5, &seed);
  model->residual_force       = complex_list(loads * r, .05, &seed);
  model->residual_probe       = list((size_t)q * r, .7, &seed);
  model->load_fourth          = complex_list(loads * (size_t)nc, .0005, &seed);
  model->probe_contact_fourth = list((size_t)(q * nc), .001, &seed);
  model->probe_load_fourth    = complex_list(loads * (size_t)q, .0005, &seed);
  for (size_t i = 0; i < r; i++)
    model->residual_frequency[i] = (2.8 + .6 * (double)i + .2 * random_unit(&seed)) / SHB_TWO_PI;
}

/* s = w^2, bounded so that the residual modes stay bounded. */
static double bounded(const modal_model *model, double w) {
  if (model->n_residual == 0) return w * w;
  double c = .9 * pow(SHB_TWO_PI * model->residual_frequency[0], 2);
  return w * w / pow(1 + pow(w * w / c, 32), 1. / 32);
}

/* 1/(theta - x) without the terms that the model holds itself. */
static double rest(const modal_model *model, int i, double x) {
  double theta = pow(SHB_TWO_PI * model->residual_frequency[i], 2);
  return 1 / (theta - x) - 1 / theta - x / (theta * theta) - x * x / (theta * theta * theta);
}

double complex loaded_by_hand(const modal_model *model, double w, double complex still,
                              double complex inertia, double complex fourth, const double *to,
                              const double complex *by) {
  double         x   = bounded(model, w);
  double complex sum = still + x * inertia + x * x * fourth;
  for (int i = 0; i < model->n_residual; i++) sum += to[i] * by[i] * rest(model, i, x);
  return sum;
}

double residual_by_hand(const modal_model *model, double w, int a, int b) {
  double top = 4 * SHB_PI * model->frequency[model->n_modes - 1], x = w * w / (top * top + w * w);
  int    at = a * 3 * model->n_pairs * (model->has_left ? 2 : 1) + b, r = model->n_residual;
  if (r > 0) {
    double sum = model->residual_flexibility[at];
    x          = bounded(model, w);
    sum += x * model->residual_inertia[at] + x * x * model->residual_fourth[at];
    for (int i = 0; i < r; i++)
      sum +=
          model->residual_shape[a * r + i] * model->residual_shape[b * r + i] * rest(model, i, x);
    return sum;
  }
  if (!model->residual_fourth)
    return model->residual_flexibility[at] + w * w * model->residual_inertia[at];
  return model->residual_flexibility[at] + top * top * x * (1 + x) * model->residual_inertia[at] +
         pow(top, 4) * x * x * model->residual_fourth[at];
}

static void add_residuals(modal_model *model, unsigned long long *seed) {
  int    nc = 3 * model->n_pairs * (model->has_left ? 2 : 1), q = 3 * model->n_probes;
  size_t loads                  = (size_t)model->n_load + 1;
  model->residual_flexibility   = symmetric(nc, .2, seed);
  model->residual_inertia       = symmetric(nc, .02, seed);
  model->load_residual          = complex_list(loads * (size_t)nc, .05, seed);
  model->probe_contact_residual = list((size_t)(q * nc), .1, seed);
  model->probe_load_residual    = complex_list(loads * (size_t)q, .05, seed);
  for (int c = 0; c < nc; c++) model->load_residual[c] = creal(model->load_residual[c]);
  for (int s = 0; s < q; s++) model->probe_load_residual[s] = creal(model->probe_load_residual[s]);
  add_inertia(model, *seed);
}

void random_model(int n_pairs, int parts, unsigned long long seed, modal_model *model) {
  size_t m = 6, pairs = (size_t)n_pairs;
  memset(model, 0, sizeof *model);
  model->n_modes       = (int)m;
  model->n_pairs       = n_pairs;
  model->n_probes      = 2;
  model->n_load        = 2;
  model->has_left      = parts & WITH_LEFT;
  model->frequency     = malloc(sizeof(double) * m);
  model->damping_ratio = malloc(sizeof(double) * m);
  for (int i = 0; i < 6; i++) {
    model->frequency[i]     = (.8 + .3 * i + .05 * random_unit(&seed)) / SHB_TWO_PI;
    model->damping_ratio[i] = .02 + .01 * random_unit(&seed);
  }
  model->right       = list(3 * pairs * m, .7, &seed);
  model->left        = model->has_left ? list(3 * pairs * m, .7, &seed) : NULL;
  model->probe       = list(6 * m, 1, &seed);
  model->modal_force = complex_list(3 * m, .05, &seed);
  for (size_t i = 0; i < m; i++) {
    model->modal_force[i] = creal(model->modal_force[i]);
    model->modal_force[2 * m + i] *= .3;
  }
  model->probe_name = malloc(2 * sizeof(char *));
  for (int i = 0; i < 2; i++) model->probe_name[i] = strdup(i ? "b" : "a");
  if (parts & WITH_RESIDUAL) add_residuals(model, &seed);
  if (parts & WITH_RESIDUAL_MODES) add_residual_modes(model, seed);
  if (parts & WITH_NORMALS) add_normals(model, &seed);
  if (parts & WITH_AREAS) {
    model->area = malloc(sizeof(double) * pairs);
    for (int a = 0; a < n_pairs; a++) model->area[a] = 2 + random_unit(&seed);
  }
}

mhb_settings random_settings(int harmonics) {
  mhb_settings s = {.blades       = 6,
                    .engine_order = 1,
                    .mu           = .4,
                    .kv           = .8,
                    .ku           = {.5, .1, .35},
                    .n_preloads   = 1,
                    .n0           = {.3},
                    .harmonics    = harmonics,
                    .subharmonics = 1,
                    .scale        = 1,
                    .tolerance    = 1e-12, /* differences amplify the error of Newton's method */
                    .max_points   = 2000,
                    .lasting      = MHB_LASTING_NEVER};
  return s;
}
