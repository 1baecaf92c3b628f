#include "tests/support/shroud_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/three_degree.h"

static const double STIFFNESS = 2e5;

static double edges(double y) {
  return .3 + pow(y, 8) + .02 * y;
}

static double smooth(double y) {
  return .6 + .5 * y + .3 * y * y;
}

static double place_of(int n, int a) {
  return n > 1 ? 2. * a / (n - 1) - 1 : 0;
}

/* Motion of patch a and axis c by mode i, from that of the tip. */
static void spread_shapes(int n, double (*field)(double), modal_model *model) {
  int     m    = model->n_modes;
  double *face = calloc(3 * (size_t)n * (size_t)m, sizeof(double));
  for (int a = 0; a < n; a++) {
    double rocking = field(place_of(n, a));
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < m; i++) face[(3 * a + c) * m + i] = rocking * model->right[c * m + i];
  }
  free(model->right);
  model->right = face;
}

/* Local compliance of a patch: a fifth of what its contact springs give. */
static double *local_matrix(int n, double size) {
  size_t  n3     = 3 * (size_t)n;
  double *matrix = calloc(n3 * n3, sizeof(double));
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      for (int c = 0; c < 3; c++)
        matrix[(size_t)(3 * a + c) * n3 + (size_t)(3 * b + c)] = size * pow(3, -abs(a - b));
  return matrix;
}

static void face_model(int n, double force, double (*field)(double), modal_model *model) {
  tip_contact_beam_model(force, model);
  spread_shapes(n, field, model);
  model->n_pairs              = n;
  double local                = .2 * n / STIFFNESS;
  model->residual_flexibility = local_matrix(n, local);
  model->residual_inertia     = local_matrix(n, local / pow(2e5, 2));
}

void shroud_face_model(int n, double force, modal_model *model) {
  face_model(n, force, edges, model);
}

void smooth_face_model(int n, double force, modal_model *model) {
  face_model(n, force, smooth, model);
  model->position = calloc(3 * (size_t)n, sizeof *model->position);
  for (int a = 0; a < n; a++) model->position[3 * a + 1] = place_of(n, a);
}

mhb_settings shroud_face_settings(int harmonics) {
  return (mhb_settings){.to_ground    = true,
                        .blades       = 1,
                        .mu           = .3,
                        .kv           = STIFFNESS,
                        .ku           = {STIFFNESS, 0, STIFFNESS},
                        .n_preloads   = 1,
                        .n0           = {400},
                        .frequency    = {215, 320},
                        .harmonics    = harmonics,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = 2000};
}
