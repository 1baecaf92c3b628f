#include "mhb/mistuning/blade_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* One blade under construction. */
typedef struct {
  const modal_model *tuned;
  modal_model       *blade;
  double             factor; /* (1 + delta)^2 of all modes; 1 where they differ */
  double             lag;
} work;

/* A scaled copy of n numbers; NULL of NULL. */
static double *scaled(const double *from, size_t n, double factor) {
  double *to = from ? shb_alloc_zeroed(n, sizeof *to) : NULL;
  for (size_t i = 0; to && i < n; i++) to[i] = factor * from[i];
  return to;
}

/* -1 for a contact dof of the left face. */
static double sign_of(const work *w, size_t dof) {
  return dof < 3 * (size_t)w->tuned->n_pairs ? 1 : -1;
}

/* A scaled copy of rows x contact dofs, with the sign of each face; rows are dofs too if both. */
static double *of_dofs(const work *w, const double *from, size_t rows, int both, double factor) {
  const size_t n  = (size_t)modal_model_contact_dofs(w->tuned);
  double      *to = scaled(from, rows * n, factor);
  for (size_t i = 0; to && i < rows; i++)
    for (size_t j = 0; j < n; j++) to[i * n + j] *= sign_of(w, j) * (both ? sign_of(w, i) : 1);
  return to;
}

/* A copy of [K + 1][n] numbers of a load that lags; dofs: they are those of contact dofs. */
static double complex *of_load(const work *w, const double complex *from, size_t n, int dofs,
                               double factor) {
  const size_t    K  = (size_t)w->tuned->n_load + 1;
  double complex *to = from ? shb_alloc_zeroed(K * n, sizeof *to) : NULL;
  for (size_t k = 0; to && k < K; k++)
    for (size_t i = 0; i < n; i++)
      to[k * n + i] =
          factor * (dofs ? sign_of(w, i) : 1) * cexp(-I * (double)k * w->lag) * from[k * n + i];
  return to;
}

static void set_modes(const work *w, const double *deviation) {
  const modal_model *t = w->tuned;
  modal_model       *b = w->blade;
  const size_t       m = (size_t)t->n_modes, half = 3 * (size_t)t->n_pairs * m;
  b->frequency     = scaled(t->frequency, m, 1);
  b->damping_ratio = scaled(t->damping_ratio, m, 1);
  b->right         = shb_alloc_zeroed(2 * half, sizeof(double));
  b->modal_force   = of_load(w, t->modal_force, m, 0, 1);
  b->probe         = scaled(t->probe, 3 * (size_t)t->n_probes * m, 1);
  for (size_t i = 0; i < m; i++) b->frequency[i] *= 1 + deviation[i];
  for (size_t i = 0; i < half; i++) {
    b->right[i]        = t->right[i];
    b->right[half + i] = -t->left[i];
  }
}

static void set_terms(const work *w) {
  const modal_model *t = w->tuned;
  modal_model       *b = w->blade;
  const size_t       n = (size_t)modal_model_contact_dofs(t), q = 3 * (size_t)t->n_probes;
  const double       one = 1 / w->factor, two = one * one, three = two * one;
  b->residual_flexibility   = of_dofs(w, t->residual_flexibility, n, 1, one);
  b->residual_inertia       = of_dofs(w, t->residual_inertia, n, 1, two);
  b->residual_fourth        = of_dofs(w, t->residual_fourth, n, 1, three);
  b->load_residual          = of_load(w, t->load_residual, n, 1, one);
  b->load_inertia           = of_load(w, t->load_inertia, n, 1, two);
  b->load_fourth            = of_load(w, t->load_fourth, n, 1, three);
  b->probe_contact_residual = of_dofs(w, t->probe_contact_residual, q, 0, one);
  b->probe_contact_inertia  = of_dofs(w, t->probe_contact_inertia, q, 0, two);
  b->probe_contact_fourth   = of_dofs(w, t->probe_contact_fourth, q, 0, three);
  b->probe_load_residual    = of_load(w, t->probe_load_residual, q, 0, one);
  b->probe_load_inertia     = of_load(w, t->probe_load_inertia, q, 0, two);
  b->probe_load_fourth      = of_load(w, t->probe_load_fourth, q, 0, three);
}

/* The tail a s^r + b s^(r+1): its terms belong to 1/lambda^(r+1) and 1/lambda^(r+2). */
static double *tail(const work *w, const double *from, size_t rows) {
  double *to = scaled(from, 2 * rows, pow(w->factor, -w->tuned->tail_order - 1));
  for (size_t i = 0; to && i < rows; i++) to[2 * i + 1] /= w->factor;
  return to;
}

static void set_residual_modes(const work *w) {
  const modal_model *t = w->tuned;
  modal_model       *b = w->blade;
  const size_t       r = (size_t)t->n_residual, n = (size_t)modal_model_contact_dofs(t);
  b->contact_tail = tail(w, t->contact_tail, n);
  b->load_tail    = tail(w, t->load_tail, (size_t)t->n_load + 1);
  if (r == 0) return;
  b->residual_frequency = scaled(t->residual_frequency, r, sqrt(w->factor));
  b->residual_shape     = scaled(t->residual_shape, n * r, 1);
  b->residual_force     = of_load(w, t->residual_force, r, 0, 1);
  b->residual_probe     = scaled(t->residual_probe, 3 * (size_t)t->n_probes * r, 1);
  for (size_t i = 0; i < n * r; i++) b->residual_shape[i] *= sign_of(w, i / r);
}

/* n numbers, twice. */
static double *twice(const double *from, size_t n) {
  double *to = from ? shb_alloc_zeroed(2 * n, sizeof *to) : NULL;
  for (size_t i = 0; to && i < 2 * n; i++) to[i] = from[i % n];
  return to;
}

static void set_names(const work *w) {
  const modal_model *t = w->tuned;
  modal_model       *b = w->blade;
  const size_t       P = (size_t)t->n_pairs;
  b->normal            = twice(t->normal, 3 * P);
  b->area              = twice(t->area, P);
  b->probe_name        = shb_alloc_zeroed((size_t)t->n_probes, sizeof(char *));
  for (int i = 0; i < t->n_probes; i++) b->probe_name[i] = shb_text(t->probe_name[i]);
  if (t->n_interfaces < 1) return;
  b->interface_name = shb_alloc_zeroed((size_t)t->n_interfaces, sizeof(char *));
  for (int i = 0; i < t->n_interfaces; i++) b->interface_name[i] = shb_text(t->interface_name[i]);
  b->interface = t->interface ? shb_alloc_zeroed(2 * P, sizeof(int)) : NULL;
  for (size_t a = 0; b->interface && a < 2 * P; a++) b->interface[a] = t->interface[a % P];
}

void mhb_blade_model(const modal_model *tuned, const double *deviation, double lag,
                     modal_model *blade) {
  work w              = {.tuned = tuned, .blade = blade, .factor = 1, .lag = lag};
  int  same           = 1;
  *blade              = (modal_model){0};
  blade->n_modes      = tuned->n_modes;
  blade->n_pairs      = 2 * tuned->n_pairs;
  blade->n_probes     = tuned->n_probes;
  blade->n_load       = tuned->n_load;
  blade->n_interfaces = tuned->n_interfaces;
  blade->n_residual   = tuned->n_residual;
  blade->tail_order   = tuned->tail_order;
  for (int i = 1; i < tuned->n_modes; i++) same = same && deviation[i] == deviation[0];
  if (same) w.factor = (1 + deviation[0]) * (1 + deviation[0]);
  set_modes(&w, deviation);
  set_terms(&w);
  set_residual_modes(&w);
  set_names(&w);
}
