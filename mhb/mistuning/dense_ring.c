#include "mhb/mistuning/dense_ring.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

typedef struct {
  const mhb_mistuned_ring *ring;
  const modal_model       *whole;
  modal_model             *model;
  size_t                   N, n, q; /* blades; 3 pairs of a contact; 3 probes of a blade */
  size_t *mode, *residual;          /* [blade][mode] number of each mode by ascending frequency */
} work;

/* Contact dof of the whole model for dof d of blade b: right faces, then left faces of the contact
 * before. The sign of left dofs is that of blade_model.h. */
static size_t place(const work *w, size_t b, size_t d, double *sign) {
  *sign = d < w->n ? 1 : -1;
  return d < w->n ? b * w->n + d : w->N * w->n + (b + w->N - 1) % w->N * w->n + d - w->n;
}

/* Frequencies ascend in a modal model.
 *   rank  out  [n] place of each number in ascending order */
static void rank_of(size_t n, const double *value, size_t *rank) {
  for (size_t i = 0; i < n; i++) {
    rank[i] = 0;
    for (size_t j = 0; j < n; j++)
      rank[i] += value[j] < value[i] || (value[j] == value[i] && j < i);
  }
}

/* to[place[i]] <- from[i] */
static double *placed(const double *from, const size_t *place_of, size_t n) {
  double *to = shb_alloc_zeroed(n, sizeof *to);
  for (size_t i = 0; i < n; i++) to[place_of[i]] = from[i];
  return to;
}

static double *numbers(const double *from, size_t n) {
  double *to = from ? shb_alloc_zeroed(n, sizeof *to) : NULL;
  if (to) memcpy(to, from, n * sizeof *to);
  return to;
}

static void set_shapes(const work *w) {
  modal_model *out = w->model;
  const size_t m = (size_t)w->ring->n_modes, all = w->N * m;
  out->right = shb_alloc_zeroed(w->N * w->n * all, sizeof(double));
  out->left  = shb_alloc_zeroed(w->N * w->n * all, sizeof(double));
  out->probe = shb_alloc_zeroed(w->N * w->q * all, sizeof(double));
  for (size_t b = 0; b < w->N; b++) {
    const modal_model *blade = &w->ring->blade[b];
    for (size_t d = 0; d < 2 * w->n; d++)
      for (size_t i = 0; i < m; i++) {
        double       sign;
        const size_t row = place(w, b, d, &sign), half = w->N * w->n;
        double      *to = row < half ? out->right + row * all : out->left + (row - half) * all;
        to[w->mode[b * m + i]] = sign * blade->right[d * m + i];
      }
    for (size_t s = 0; s < w->q; s++)
      for (size_t i = 0; i < m; i++)
        out->probe[(b * w->q + s) * all + w->mode[b * m + i]] = blade->probe[s * m + i];
  }
}

/* The member of a model at an offset: const double * or const double complex *. */
static const void *member(const modal_model *model, size_t offset) {
  const void *p;
  memcpy(&p, (const char *)model + offset, sizeof p);
  return p;
}

/* Blocks of contact dofs by contact dofs. */
static double *by_contact(const work *w, size_t offset) {
  const size_t C = 2 * w->n, all = w->N * C;
  double      *to = member(w->ring->blade, offset) ? shb_alloc_zeroed(all * all, sizeof *to) : NULL;
  for (size_t b = 0; to && b < w->N; b++) {
    const double *from = member(&w->ring->blade[b], offset);
    for (size_t i = 0; i < C; i++)
      for (size_t j = 0; j < C; j++) {
        double       si, sj;
        const size_t row = place(w, b, i, &si), column = place(w, b, j, &sj);
        to[row * all + column] += si * sj * from[i * C + j];
      }
  }
  return to;
}

/* Probe dofs by contact dofs. */
static double *probe_contact(const work *w, size_t offset) {
  const size_t C = 2 * w->n, all = w->N * C;
  double      *to =
      member(w->ring->blade, offset) ? shb_alloc_zeroed(w->N * w->q * all, sizeof *to) : NULL;
  for (size_t b = 0; to && b < w->N; b++) {
    const double *from = member(&w->ring->blade[b], offset);
    for (size_t s = 0; s < w->q; s++)
      for (size_t j = 0; j < C; j++) {
        double       sign;
        const size_t column = place(w, b, j, &sign);
        to[(b * w->q + s) * all + column] += sign * from[s * C + j];
      }
  }
  return to;
}

/* [K + 1][contact dofs] */
static double complex *load_contact(const work *w, size_t offset) {
  const size_t    C = 2 * w->n, all = w->N * C, K = (size_t)w->whole->n_load + 1;
  double complex *to =
      member(w->ring->blade, offset) ? shb_alloc_zeroed(K * all, sizeof *to) : NULL;
  for (size_t b = 0; to && b < w->N; b++) {
    const double complex *from = member(&w->ring->blade[b], offset);
    for (size_t k = 0; k < K; k++)
      for (size_t j = 0; j < C; j++) {
        double       sign;
        const size_t column = place(w, b, j, &sign);
        to[k * all + column] += sign * from[k * C + j];
      }
  }
  return to;
}

/* [K + 1][probe dofs] */
static double complex *load_probe(const work *w, size_t offset) {
  const size_t    all = w->N * w->q, K = (size_t)w->whole->n_load + 1;
  double complex *to =
      member(w->ring->blade, offset) ? shb_alloc_zeroed(K * all, sizeof *to) : NULL;
  for (size_t b = 0; to && b < w->N; b++) {
    const double complex *from = member(&w->ring->blade[b], offset);
    for (size_t k = 0; k < K; k++)
      for (size_t s = 0; s < w->q; s++) to[k * all + b * w->q + s] = from[k * w->q + s];
  }
  return to;
}

#define AT(name) offsetof(modal_model, name)
static void set_terms(const work *w) {
  modal_model *out            = w->model;
  out->residual_flexibility   = by_contact(w, AT(residual_flexibility));
  out->residual_inertia       = by_contact(w, AT(residual_inertia));
  out->residual_fourth        = by_contact(w, AT(residual_fourth));
  out->probe_contact_residual = probe_contact(w, AT(probe_contact_residual));
  out->probe_contact_inertia  = probe_contact(w, AT(probe_contact_inertia));
  out->probe_contact_fourth   = probe_contact(w, AT(probe_contact_fourth));
  out->load_residual          = load_contact(w, AT(load_residual));
  out->load_inertia           = load_contact(w, AT(load_inertia));
  out->load_fourth            = load_contact(w, AT(load_fourth));
  out->probe_load_residual    = load_probe(w, AT(probe_load_residual));
  out->probe_load_inertia     = load_probe(w, AT(probe_load_inertia));
  out->probe_load_fourth      = load_probe(w, AT(probe_load_fourth));
}

static void set_residual_modes(const work *w) {
  modal_model *out = w->model;
  const size_t r = (size_t)w->ring->blade->n_residual, R = w->N * r, C = 2 * w->n;
  const size_t K  = (size_t)w->whole->n_load + 1;
  out->n_residual = (int)R;
  out->tail_order = w->ring->blade->tail_order;
  if (r == 0) return;
  out->residual_frequency = shb_alloc_zeroed(R, sizeof(double));
  out->residual_shape     = shb_alloc_zeroed(w->N * C * R, sizeof(double));
  out->residual_force     = shb_alloc_zeroed(K * R, sizeof(double complex));
  out->residual_probe     = shb_alloc_zeroed(w->N * w->q * R, sizeof(double));
  for (size_t i = 0; i < R; i++)
    out->residual_frequency[i] = w->ring->blade[i / r].residual_frequency[i % r];
  rank_of(R, out->residual_frequency, w->residual);
  for (size_t b = 0; b < w->N; b++) {
    const modal_model *blade = &w->ring->blade[b];
    for (size_t i = 0; i < r; i++) {
      const size_t at             = w->residual[b * r + i];
      out->residual_frequency[at] = blade->residual_frequency[i];
      for (size_t d = 0; d < C; d++) {
        double       sign;
        const size_t row                  = place(w, b, d, &sign);
        out->residual_shape[row * R + at] = sign * blade->residual_shape[d * r + i];
      }
      for (size_t k = 0; k < K; k++)
        out->residual_force[k * R + at] = blade->residual_force[k * r + i];
      for (size_t s = 0; s < w->q; s++)
        out->residual_probe[(b * w->q + s) * R + at] = blade->residual_probe[s * r + i];
    }
  }
}

static void set_names(const work *w) {
  const modal_model *whole = w->whole;
  modal_model       *out   = w->model;
  const size_t       Q = (size_t)whole->n_probes, sides = (size_t)whole->n_interfaces;
  out->probe_name     = shb_alloc_zeroed(Q + 1, sizeof(char *));
  out->interface_name = sides ? shb_alloc_zeroed(sides, sizeof(char *)) : NULL;
  for (size_t i = 0; i < Q + sides; i++) {
    char **to = i < Q ? &out->probe_name[i] : &out->interface_name[i - Q];
    *to       = shb_text(i < Q ? whole->probe_name[i] : whole->interface_name[i - Q]);
  }
  if (!whole->interface) return;
  out->interface = shb_alloc_zeroed((size_t)whole->n_pairs, sizeof(int));
  memcpy(out->interface, whole->interface, sizeof(int) * (size_t)whole->n_pairs);
}

void mhb_dense_ring(const mhb_mistuned_ring *ring, modal_model *model) {
  const modal_model *whole = &ring->whole;
  work               w     = {.ring  = ring,
                              .whole = whole,
                              .model = model,
                              .N     = (size_t)ring->blades,
                              .n     = 3 * (size_t)ring->n_pairs,
                              .q     = 3 * (size_t)ring->n_probes};
  const size_t       all = (size_t)whole->n_modes, P = (size_t)whole->n_pairs;
  const size_t       residuals = w.N * (size_t)ring->blade->n_residual;
  w.mode                       = shb_alloc_zeroed(all, sizeof(size_t));
  w.residual                   = shb_alloc_zeroed(residuals, sizeof(size_t));
  *model                       = (modal_model){0};
  model->n_modes               = whole->n_modes;
  model->n_pairs               = whole->n_pairs;
  model->n_probes              = whole->n_probes;
  model->n_load                = whole->n_load;
  model->n_interfaces          = whole->n_interfaces;
  model->has_left              = true;
  rank_of(all, whole->frequency, w.mode);
  model->frequency     = placed(whole->frequency, w.mode, all);
  model->damping_ratio = placed(whole->damping_ratio, w.mode, all);
  model->normal        = numbers(whole->normal, 3 * P);
  model->area          = numbers(whole->area, P);
  model->modal_force = shb_alloc_zeroed(((size_t)whole->n_load + 1) * all, sizeof(double complex));
  for (size_t i = 0; i < ((size_t)whole->n_load + 1) * all; i++)
    model->modal_force[i / all * all + w.mode[i % all]] = whole->modal_force[i];
  set_names(&w);
  set_shapes(&w);
  set_terms(&w);
  set_residual_modes(&w);
  free(w.mode);
  free(w.residual);
}

void mhb_dense_ring_settings(const mhb_settings *settings, mhb_settings *own) {
  *own              = *settings;
  own->ring         = NULL;
  own->contacts     = settings->blades;
  own->blades       = 1;
  own->engine_order = 0;
  own->turns_right  = false;
}
