/* Modal models with random shapes, and settings to go with them: what an identity must hold for. */
#ifndef TESTS_SUPPORT_RANDOM_MODEL_H
#define TESTS_SUPPORT_RANDOM_MODEL_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* Parts of a model that are there. */
enum {
  WITH_LEFT     = 1,
  WITH_RESIDUAL = 2, /* flexibility, inertia, and those of load and probes; the term of w^4 */
  WITH_NORMALS  = 4, /* each pair a few degrees off (35, 10) deg */
  WITH_AREAS    = 8,
  WITH_RESIDUAL_MODES =
      64 /* beside WITH_RESIDUAL: three of 2.6 to 4 rad/s, and the terms of w^4 of load and probes */
};

/* Uniform in (-1, 1) from a seed that it moves on. */
double random_unit(unsigned long long *seed);

/* 6 modes of .8 to 2.3 rad/s, damping ratio .01 to .03; 2 probes; load harmonics 0 (real), 1, 2. */
void random_model(int n_pairs, int parts, unsigned long long seed, modal_model *model);

/* What the modes left out add to the receptance between contact dofs a and b, w in rad/s. */
double residual_by_hand(const modal_model *model, double w, int a, int b);

/* The same of a way from the load or to the probes, by its three terms and the shapes [n_residual]
 * at both ends (NULL without); load: complex. */
double complex loaded_by_hand(const modal_model *model, double w, double complex still,
                              double complex inertia, double complex fourth, const double *to,
                              const double complex *by);

/* Neighbour, 6 blades, engine order 1, mu .4, kv .8, skew ku, preload at equilibrium, n0 .3. */
mhb_settings random_settings(int harmonics);

#endif
