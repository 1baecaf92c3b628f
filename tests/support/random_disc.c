#include "tests/support/random_disc.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/check.h"
#include "tests/support/random_model.h"

static double *list(size_t n, double size, unsigned long long *seed) {
  double *x = malloc((n ? n : 1) * sizeof *x);
  for (size_t i = 0; i < n; i++) x[i] = size * random_unit(seed);
  return x;
}

/* [n][n] a^T -+ a: skew with sign -1, symmetric with 1. */
static double *folded(int n, double sign, double size, unsigned long long *seed) {
  double *x = list((size_t)(n * n), size, seed);
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) {
      const double both = 0.5 * (x[i * n + j] + sign * x[j * n + i]);
      x[i * n + j]      = both;
      x[j * n + i]      = sign * both;
    }
  return x;
}

static void add_imaginary(const modal_model *re, modal_model *im, unsigned long long *seed) {
  const int    sides = re->has_left ? 2 : 1, nc = 3 * re->n_pairs * sides, q = 3 * re->n_probes;
  const size_t m = (size_t)re->n_modes, r = (size_t)re->n_residual, half = (size_t)(nc / sides);
  im->right = list(half * m, .3, seed);
  im->left  = re->has_left ? list(half * m, .3, seed) : NULL;
  im->probe = list((size_t)q * m, .5, seed);
  if (re->residual_flexibility) im->residual_flexibility = folded(nc, -1, .1, seed);
  if (re->residual_inertia) im->residual_inertia = folded(nc, -1, .01, seed);
  if (re->residual_fourth) im->residual_fourth = folded(nc, -1, .001, seed);
  if (re->residual_shape) im->residual_shape = list((size_t)nc * r, .2, seed);
  if (re->residual_probe) im->residual_probe = list((size_t)q * r, .2, seed);
  if (re->probe_contact_residual) im->probe_contact_residual = list((size_t)(q * nc), .05, seed);
  if (re->probe_contact_inertia) im->probe_contact_inertia = list((size_t)(q * nc), .005, seed);
  if (re->probe_contact_fourth) im->probe_contact_fourth = list((size_t)(q * nc), .0005, seed);
}

void random_disc(int n_pairs, int blades, int parts, bool coriolis, unsigned long long seed,
                 modal_nodal_diameters *d) {
  modal_nodal_diameters_create(blades, blades / 2 + 1, d);
  for (int i = 0; i < d->n; i++) {
    const bool is_real = i == 0 || 2 * i == blades;
    d->diameter[i]     = i;
    random_model(n_pairs, parts, seed + 10 * (unsigned long long)i, &d->model[i]);
    const int m = d->model[i].n_modes;
    if (!is_real) add_imaginary(&d->model[i], &d->imaginary[i], &seed);
    if (coriolis) d->model[i].coriolis = folded(m, -1, .2, &seed);
    if (coriolis && !is_real) d->imaginary[i].coriolis = folded(m, 1, .2, &seed);
  }
}

/* Rows of a pair's three axes, of three motions of the face: constant, linear, quadratic. */
static double motion_of(int row, int n, int motion) {
  const double y = 2. * (row / 3) / (n - 1) - 1;
  return (row % 3 == motion % 3 ? 1 : .3) * (motion == 0 ? 1 : motion == 1 ? y : y * y);
}

/* to += sum of C_ab g_a g_b^T over the motions of the face. */
static void add_smooth(int n, double sign, double size, unsigned long long *seed, double *to) {
  double *C = folded(3, sign, size, seed);
  for (int i = 0; i < 3 * n; i++)
    for (int j = 0; j < 3 * n; j++)
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
          to[i * 3 * n + j] += C[3 * a + b] * motion_of(i, n, a) * motion_of(j, n, b);
  free(C);
}

void face_disc(const modal_model *face, int blades, double coriolis, modal_nodal_diameters *d) {
  const int          n    = face->n_pairs;
  const size_t       rows = 3 * (size_t)n, m = (size_t)face->n_modes;
  unsigned long long seed = 4;
  modal_nodal_diameters_create(blades, blades / 2 + 1, d);
  for (int i = 0; i < d->n; i++) {
    modal_model *re = &d->model[i], *im = &d->imaginary[i];
    const double self = face->residual_flexibility[0], inertia = face->residual_inertia[0];
    d->diameter[i]           = i;
    *re                      = (modal_model){.n_modes = face->n_modes, .n_pairs = n};
    re->n_load               = face->n_load;
    re->n_probes             = face->n_probes;
    re->frequency            = malloc(m * sizeof(double));
    re->damping_ratio        = malloc(m * sizeof(double));
    re->right                = malloc(rows * m * sizeof(double));
    re->probe                = malloc(3 * (size_t)face->n_probes * m * sizeof(double));
    re->probe_name           = malloc((size_t)face->n_probes * sizeof(char *));
    re->modal_force          = malloc((size_t)(face->n_load + 1) * m * sizeof(double complex));
    re->residual_flexibility = malloc(rows * rows * sizeof(double));
    re->residual_inertia     = malloc(rows * rows * sizeof(double));
    for (size_t j = 0; j < m; j++) re->frequency[j] = (1 + .02 * i) * face->frequency[j];
    memcpy(re->damping_ratio, face->damping_ratio, m * sizeof(double));
    memcpy(re->right, face->right, rows * m * sizeof(double));
    memcpy(re->probe, face->probe, 3 * (size_t)face->n_probes * m * sizeof(double));
    for (int p = 0; p < face->n_probes; p++) re->probe_name[p] = strdup(face->probe_name[p]);
    memcpy(re->modal_force, face->modal_force,
           (size_t)(face->n_load + 1) * m * sizeof(double complex));
    memcpy(re->residual_flexibility, face->residual_flexibility, rows * rows * sizeof(double));
    memcpy(re->residual_inertia, face->residual_inertia, rows * rows * sizeof(double));
    if (face->position) {
      re->position = malloc(rows * sizeof(double));
      memcpy(re->position, face->position, rows * sizeof(double));
    }
    add_smooth(n, 1, .2 * self, &seed, re->residual_flexibility);
    add_smooth(n, 1, .2 * inertia, &seed, re->residual_inertia);
    if (coriolis > 0) re->coriolis = folded(face->n_modes, -1, coriolis, &seed);
    if (i == 0 || 2 * i == blades) continue;
    if (coriolis > 0) im->coriolis = folded(face->n_modes, 1, coriolis, &seed);
    im->right                = malloc(rows * m * sizeof(double));
    im->probe                = calloc(3 * (size_t)face->n_probes * m, sizeof(double));
    im->residual_flexibility = calloc(rows * rows, sizeof(double));
    im->residual_inertia     = calloc(rows * rows, sizeof(double));
    for (size_t j = 0; j < rows * m; j++) im->right[j] = .1 * re->right[j];
    add_smooth(n, -1, .2 * self, &seed, im->residual_flexibility);
    add_smooth(n, -1, .2 * inertia, &seed, im->residual_inertia);
  }
}
