/* Modal models with random shapes, and their settings, for tests of identities. */
#ifndef TESTS_SUPPORT_RANDOM_MODEL_H
#define TESTS_SUPPORT_RANDOM_MODEL_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* Parts of a model. */
enum {
  WITH_LEFT     = 1,
  WITH_RESIDUAL = 2, /* flexibility, inertia, and those of load and probes; the term of w^4 */
  WITH_NORMALS  = 4, /* each pair some degrees off (35, 10) deg */
  WITH_AREAS    = 8,
  WITH_RESIDUAL_MODES =
      /* with WITH_RESIDUAL: three modes of 2.6 to 4 rad/s, and the terms of w^4 of load and
       * probes */
  64
};

/* Uniform in (-1, 1); advances the seed. */
double random_unit(unsigned long long *seed);

/* A model with 6 modes of 0.8 to 2.3 rad/s, damping ratios 0.01 to 0.03, 2 probes, and load
 * harmonics 0 (real), 1, 2. */
void random_model(int n_pairs, int parts, unsigned long long seed, modal_model *model);

/* Contribution of the modes left out to the receptance between contact dofs a and b, at w rad/s. */
double residual_by_hand(const modal_model *model, double w, int a, int b);

/* The same from the load, or to the probes: from its three terms, and from the shapes [n_residual]
 * at both ends (NULL without). The load is complex. */
double complex loaded_by_hand(const modal_model *model, double w, double complex still,
                              double complex inertia, double complex fourth, const double *to,
                              const double complex *by);

/* Settings: contact to the neighbour, 6 blades, engine order 1, mu 0.4, kv 0.8, skew ku, preload at
 * equilibrium, n0 0.3, no lasting motion. */
mhb_settings random_settings(int harmonics);

#endif
