#include "mhb/structure/dense_disc.h"

#include <complex.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/wave.h"

typedef struct {
  const modal_nodal_diameters *from;
  const modal_model           *first; /* of nodal diameter 0: all sizes */
  modal_model                 *to;
  int                          N, order;
  size_t  n, c, q, m, K; /* 3 pairs, contact dofs, 3 probes, modes, harmonics of the load */
  size_t *rank;          /* place of each standing wave in ascending order of frequency */
} work;

/* The member of a model at an offset: const double * or const double complex *. */
static const void *member(const modal_model *model, size_t offset) {
  const void *p;
  memcpy(&p, (const char *)model + offset, sizeof p);
  return p;
}
#define AT(name) offsetof(modal_model, name)

/* Complex value of an array of nodal diameter k. */
static double complex value(const work *w, int k, size_t offset, size_t i) {
  const double *re = member(&w->from->model[k], offset);
  const double *im = member(&w->from->imaginary[k], offset);
  return CMPLX(re[i], im ? im[i] : 0);
}

/* e^(-j n theta b) */
static double complex turn(const work *w, int n, int b) {
  const long at = (long)n * b % w->N;
  return cexp(-I * SHB_TWO_PI * (double)at / w->N);
}

/* Standing waves of a nodal diameter: 1 or 2. */
static int waves(const work *w, int n) {
  return n == 0 || 2 * n == w->N ? 1 : 2;
}

/* Motion of sector b in standing wave `part` of nodal diameter n, by the complex shape x. */
static double standing(const work *w, int n, int part, int b, double complex x) {
  const double complex at = x * turn(w, n, b);
  if (waves(w, n) == 1) return creal(at) / sqrt(w->N);
  return sqrt(2. / w->N) * (part ? -cimag(at) : creal(at));
}

/* Row of the dense model for contact dof i of sector b: right faces, then the left faces of the
 * contact before. */
static size_t place(const work *w, int b, size_t i) {
  const size_t N = (size_t)w->N, before = (size_t)((b + w->N - 1) % w->N);
  return i < w->n ? (size_t)b * w->n + i : N * w->n + before * w->n + i - w->n;
}

/* ---- modes ---- */

/* Place of standing wave `part` of mode i of nodal diameter n. */
static size_t column_of(const work *w, int n, int part, size_t i) {
  const size_t first = n == 0 ? 0 : 2 * (size_t)n - 1;
  return w->rank[(first + (size_t)part) * w->m + i];
}

/* Ascending order of all frequencies; equal ones stay in the order of their standing waves. */
static void sort(work *w) {
  const size_t all = (size_t)w->N * w->m;
  double      *f   = shb_alloc_zeroed(all, sizeof *f);
  for (int k = 0; k < w->from->n; k++)
    for (int part = 0; part < waves(w, k); part++)
      memcpy(f + (size_t)(k == 0 ? 0 : 2 * k - 1 + part) * w->m, w->from->model[k].frequency,
             w->m * sizeof *f);
  for (size_t i = 0; i < all; i++) {
    w->rank[i] = 0;
    for (size_t j = 0; j < all; j++) w->rank[i] += f[j] < f[i] || (f[j] == f[i] && j < i);
  }
  free(f);
}

/* Complex amplitude of the force on standing wave `part` of mode i by harmonic h. */
static double complex force_on(const work *w, int n, int part, size_t h, size_t i) {
  const long            wave    = (long)h * w->order % w->N;
  const bool            forward = wave == n, backward = (wave + n) % w->N == 0;
  const double complex *own  = w->from->model[n].modal_force + h * w->m;
  const double complex *back = w->from->backward[n].modal_force;
  if (!forward && !backward) return 0;
  if (waves(w, n) == 1) return sqrt(w->N) * own[i];
  if (forward) return sqrt(0.5 * w->N) * own[i] * (part ? -I : 1);
  return sqrt(0.5 * w->N) * (back ? back[h * w->m + i] : conj(own[i])) * (part ? I : 1);
}

static void set_mode(work *w, int k, int part, size_t i) {
  modal_model *to  = w->to;
  const size_t all = (size_t)w->N * w->m, at = column_of(w, k, part, i);
  to->frequency[at]     = w->from->model[k].frequency[i];
  to->damping_ratio[at] = w->from->model[k].damping_ratio[i];
  for (int b = 0; b < w->N; b++)
    for (size_t d = 0; d < w->n; d++) {
      const size_t before = (size_t)((b + w->N - 1) % w->N), j = d * w->m + i;
      to->right[((size_t)b * w->n + d) * all + at] =
          standing(w, k, part, b, value(w, k, AT(right), j));
      if (to->left)
        to->left[(before * w->n + d) * all + at] =
            standing(w, k, part, b, value(w, k, AT(left), j));
    }
  for (size_t s = 0; s < w->q; s++)
    to->probe[s * all + at] = standing(w, k, part, 0, value(w, k, AT(probe), s * w->m + i));
  for (size_t h = 0; h < w->K; h++) to->modal_force[h * all + at] = force_on(w, k, part, h, i);
}

/* Of a pair of standing waves q0, q1 the sum q0 + j q1 is a complex coordinate of the nodal
 * diameter: the real matrix is [Re G, -Im G; Im G, Re G]. */
static void make_coriolis(work *w) {
  const size_t all = (size_t)w->N * w->m;
  w->to->coriolis  = shb_alloc_zeroed(all * all, sizeof(double));
  for (int k = 0; k < w->from->n; k++)
    for (int part = 0; part < waves(w, k) * waves(w, k); part++) {
      const int to = part / waves(w, k), by = part % waves(w, k);
      for (size_t i = 0; i < w->m * w->m; i++) {
        const double complex G  = value(w, k, AT(coriolis), i);
        const size_t         at = column_of(w, k, to, i / w->m) * all;
        w->to->coriolis[at + column_of(w, k, by, i % w->m)] =
            to == by ? creal(G) : (to ? 1 : -1) * cimag(G);
      }
    }
}

static void make_modes(work *w) {
  modal_model *to  = w->to;
  const size_t all = (size_t)w->N * w->m, side = (size_t)w->N * w->n * all;
  to->frequency     = shb_alloc_zeroed(all, sizeof(double));
  to->damping_ratio = shb_alloc_zeroed(all, sizeof(double));
  to->probe         = shb_alloc_zeroed(w->q * all, sizeof(double));
  to->modal_force   = shb_alloc_zeroed(w->K * all, sizeof(double complex));
  to->right         = shb_alloc_zeroed(side, sizeof(double));
  if (to->has_left) to->left = shb_alloc_zeroed(side, sizeof(double));
  sort(w);
  for (int k = 0; k < w->from->n; k++)
    for (int part = 0; part < waves(w, k); part++)
      for (size_t i = 0; i < w->m; i++) set_mode(w, k, part, i);
  if (w->first->coriolis) make_coriolis(w);
}

/* ---- residual terms ---- */

/* Element of a block-circulant map: motion of a sector by forces on the one `lag` sectors before
 * it. At each nodal diameter the map is the array at an offset. */
static double circulant(const work *w, size_t offset, size_t i, int lag) {
  double sum = 0;
  for (int k = 0; k < w->from->n; k++)
    sum += waves(w, k) * creal(value(w, k, offset, i) * turn(w, k, lag));
  return sum / w->N;
}

/* Contact dofs by contact dofs. */
static double *by_contact(work *w, size_t offset) {
  const size_t all = (size_t)w->N * w->c;
  double      *to  = member(w->first, offset) ? shb_alloc_zeroed(all * all, sizeof *to) : NULL;
  for (int lag = 0; to && lag < w->N; lag++)
    for (size_t i = 0; i < w->c * w->c; i++) {
      const double x = circulant(w, offset, i, lag);
      for (int b = 0; b < w->N; b++)
        to[place(w, (b + lag) % w->N, i / w->c) * all + place(w, b, i % w->c)] = x;
    }
  return to;
}

/* Probe dofs of sector 0 by contact dofs. */
static double *probe_contact(work *w, size_t offset) {
  const size_t all = (size_t)w->N * w->c;
  double      *to  = member(w->first, offset) ? shb_alloc_zeroed(w->q * all, sizeof *to) : NULL;
  for (int b = 0; to && b < w->N; b++)
    for (size_t i = 0; i < w->q * w->c; i++)
      to[i / w->c * all + place(w, b, i % w->c)] = circulant(w, offset, i, (w->N - b) % w->N);
  return to;
}

/* Response of sector 0 to harmonic h of the load: that of its travelling wave. */
static double complex load_response(const work *w, size_t offset, size_t h, size_t each, size_t i) {
  const int  wave = (int)((long)h * w->order % w->N), n = modal_nodal_diameter(wave, w->N);
  modal_wave of;
  int        missing;
  if (!modal_nodal_diameters_wave(w->from, wave, &of, &missing)) return 0;
  const double complex *x = member(of.loads, offset);
  return x && n >= 0 ? x[h * each + i] : 0;
}

/* [K][contact dofs], or [K][probe dofs] of sector 0 */
static double complex *by_load(work *w, size_t offset, bool probe) {
  const size_t    each = probe ? w->q : w->c, all = probe ? w->q : (size_t)w->N * w->c;
  double complex *to = member(w->first, offset) ? shb_alloc_zeroed(w->K * all, sizeof *to) : NULL;
  for (size_t h = 0; to && h < w->K; h++)
    for (int b = 0; b < (probe ? 1 : w->N); b++)
      for (size_t i = 0; i < each; i++)
        to[h * all + (probe ? i : place(w, b, i))] =
            load_response(w, offset, h, each, i) * turn(w, (int)((long)h * w->order % w->N), b);
  return to;
}

static void make_terms(work *w) {
  modal_model *to            = w->to;
  to->residual_flexibility   = by_contact(w, AT(residual_flexibility));
  to->residual_inertia       = by_contact(w, AT(residual_inertia));
  to->residual_fourth        = by_contact(w, AT(residual_fourth));
  to->probe_contact_residual = probe_contact(w, AT(probe_contact_residual));
  to->probe_contact_inertia  = probe_contact(w, AT(probe_contact_inertia));
  to->probe_contact_fourth   = probe_contact(w, AT(probe_contact_fourth));
  to->load_residual          = by_load(w, AT(load_residual), false);
  to->load_inertia           = by_load(w, AT(load_inertia), false);
  to->load_fourth            = by_load(w, AT(load_fourth), false);
  to->probe_load_residual    = by_load(w, AT(probe_load_residual), true);
  to->probe_load_inertia     = by_load(w, AT(probe_load_inertia), true);
  to->probe_load_fourth      = by_load(w, AT(probe_load_fourth), true);
}

/* ---- names and faces ---- */

/* [N][size of each] copies of an array of one sector, or NULL. */
static double *repeated(work *w, const double *from, size_t each) {
  double *to = from ? shb_alloc_zeroed((size_t)w->N * each, sizeof *to) : NULL;
  for (int b = 0; to && b < w->N; b++) memcpy(to + (size_t)b * each, from, each * sizeof *to);
  return to;
}

static void make_names(work *w) {
  const modal_model *one = w->first;
  modal_model       *to  = w->to;
  const size_t       Q = (size_t)one->n_probes, sides = (size_t)one->n_interfaces;
  const size_t       P = (size_t)one->n_pairs;
  to->probe_name       = shb_alloc_zeroed(Q + 1, sizeof(char *));
  to->interface_name   = sides ? shb_alloc_zeroed(sides, sizeof(char *)) : NULL;
  for (size_t i = 0; i < Q + sides; i++) {
    char **name = i < Q ? &to->probe_name[i] : &to->interface_name[i - Q];
    *name       = shb_text(i < Q ? one->probe_name[i] : one->interface_name[i - Q]);
  }
  to->normal = repeated(w, one->normal, 3 * P);
  to->area   = repeated(w, one->area, P);
  if (!one->interface) return;
  to->interface = shb_alloc_zeroed((size_t)w->N * P, sizeof(int));
  for (size_t i = 0; i < (size_t)w->N * P; i++) to->interface[i] = one->interface[i % P];
}

shb_status mhb_dense_disc(const mhb_settings *s, modal_model *model) {
  const modal_nodal_diameters *d   = s->nodal_diameters;
  const modal_model           *one = &d->model[0];
  const size_t                 N = (size_t)d->blades, n = 3 * (size_t)one->n_pairs;
  *model = (modal_model){0};
  SHB_CHECK(d->n == d->blades / 2 + 1, SHB_ERR_INPUT,
            "time integration of a disc needs all nodal diameters, 0 to %d; the modal file has %d "
            "of %d; add them by modal.nodal_diameters: all",
            d->blades / 2, d->n, d->blades / 2 + 1);
  *model = (modal_model){.n_modes      = d->blades * one->n_modes,
                         .n_pairs      = d->blades * one->n_pairs,
                         .n_probes     = one->n_probes,
                         .n_load       = one->n_load,
                         .n_interfaces = one->n_interfaces,
                         .has_left     = one->has_left};
  work w = {.from  = d,
            .first = one,
            .to    = model,
            .N     = d->blades,
            .order = mhb_driven_wave_order(
                mhb_driven_wave_of(s->engine_order, s->turns_right, d->blades, 1)),
            .n = n,
            .c = one->has_left ? 2 * n : n,
            .q = 3 * (size_t)one->n_probes,
            .m = (size_t)one->n_modes,
            .K = (size_t)one->n_load + 1};
  w.rank = shb_alloc_zeroed(N * w.m, sizeof *w.rank);
  make_names(&w);
  make_modes(&w);
  make_terms(&w);
  free(w.rank);
  return SHB_OK;
}

void mhb_dense_disc_settings(const mhb_settings *settings, mhb_settings *own) {
  *own                 = *settings;
  own->contacts        = settings->nodal_diameters->blades;
  own->nodal_diameters = NULL;
  own->blades          = 1;
  own->engine_order    = 0;
  own->turns_right     = false;
}
