#include "mhb/run_up/speed_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/run_up/unitary.h"
#include "modal/model/reduce.h"

static const double HAIR = 1e-9;

/* Speeds used beyond the range on each side, for the splines. */
enum { BESIDE = 2 };

/* Least part of the mass of a mode in the space of the modes kept: a squared cosine. */
static const double STAYS = 0.8;

static double rpm(double speed) {
  return speed * 60 / SHB_TWO_PI;
}

double mhb_speed_table_speed(const mhb_speed_table *r, double omega) {
  return fmin(fmax(omega / r->engine_order, r->low), r->high);
}

/* ---- entries ---- */

static mhb_speed_parts parts_of(const modal_speeds *s, int i) {
  if (!s->imaginary) return (mhb_speed_parts){&s->model[i], NULL, NULL};
  return (mhb_speed_parts){&s->model[i], &s->imaginary[i], &s->backward[i]};
}

/* Doubles of an array in an entry, an even number as complex ones follow; 0: it is not there. */
static size_t doubles_of(const mhb_speed_table *r, const modal_dataset *row, const modal_model *m) {
  if (!m || !modal_dataset_is_residual(row) || !modal_dataset_get(row, m)) return 0;
  const size_t n = modal_dataset_count(row, r->common) * modal_dataset_width(row) / sizeof(double);
  return n + n % 2;
}

/* Complex arrays of a model come first. */
void mhb_speed_table_place(const mhb_speed_table *r, double *entry, const mhb_speed_parts *parts) {
  const modal_model *const have[] = {r->last.model, r->last.imaginary, r->last.backward};
  modal_model *const       to[]   = {parts->model, parts->imaginary, parts->backward};
  double                  *at     = entry + r->fixed;
  for (int i = 0; i < 6; i++)
    for (const modal_dataset *row = modal_datasets; row->path; row++) {
      const size_t n = doubles_of(r, row, have[i / 2]);
      if (n == 0 || (row->kind == MODAL_LOAD) != (i % 2 == 0)) continue;
      modal_dataset_set(row, to[i / 2], at);
      at += n;
    }
}

/* The arrays of a model that has a place for them. */
static void copy_residuals(const modal_model *sizes, const modal_model *from,
                           const modal_model *to) {
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    if (modal_dataset_is_residual(row) && modal_dataset_get(row, to))
      memcpy(modal_dataset_get(row, to), modal_dataset_get(row, from),
             modal_dataset_count(row, sizes) * modal_dataset_width(row));
}

static void lay_out(mhb_speed_table *r) {
  const modal_model *m     = r->common;
  const size_t       modes = (size_t)r->n_modes, width = (size_t)r->width;
  r->rows    = modal_model_contact_dofs(m) + 3 * m->n_probes + 2 * (m->n_load + 1);
  r->squares = m->coriolis ? 3 : 2;
  r->fixed   = width * ((size_t)r->squares * modes + (size_t)r->rows) * modes;
  r->fixed += r->fixed % 2; /* complex numbers follow */
  r->size = r->fixed;
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    r->size += doubles_of(r, row, m) + doubles_of(r, row, r->last.imaginary) +
               doubles_of(r, row, r->last.backward);
}

/* Rows of real and imaginary parts times V; row: scratch [m]. Returns the end of out. */
static double *rotate_rows(const mhb_speed_table *r, const double *V, const double *re,
                           const double *im, int n, double complex *row, double *out) {
  const int m = r->n_modes;
  for (int k = 0; k < n; k++, out += r->width * m) {
    for (int i = 0; i < m; i++) row[i] = CMPLX(re[k * m + i], im ? im[k * m + i] : 0);
    mhb_unitary_row(r->width, m, V, row, out);
  }
  return out;
}

/* Rows of the load: of a real model its real, then its imaginary parts. */
static void rotate_load(const mhb_speed_table *r, const mhb_speed_parts *p, const double *V,
                        double complex *row, double *out) {
  const int m = r->n_modes, count = p->model->n_load + 1;
  for (int k = 0; k < 2 * count; k++, out += r->width * m) {
    const bool            second = k >= count;
    const double complex *f      = p->model->modal_force + (size_t)((k % count) * m);
    if (p->backward && second) f = p->backward->modal_force + (size_t)((k % count) * m);
    for (int i = 0; i < m; i++) {
      if (r->width == 1) row[i] = second ? cimag(f[i]) : creal(f[i]);
      if (r->width == 2) row[i] = second ? f[i] : conj(f[i]);
    }
    mhb_unitary_row(r->width, m, V, row, out);
  }
}

/* An entry from a speed's model and V[mode][place]; row, square: scratch [m]. */
static void fill_entry(const mhb_speed_table *r, const mhb_speed_parts *p, double speed,
                       const double *V, double *out, double complex *row, double *square) {
  const modal_model *model = p->model, *im = p->imaginary;
  const int          m = r->n_modes, side = 3 * model->n_pairs, probes = 3 * model->n_probes;
  modal_model        place[3] = {{0}};
  for (int i = 0; i < m; i++) square[i] = pow(SHB_TWO_PI * model->frequency[i], 2);
  mhb_unitary_diagonal(r->width, m, V, square, out);
  mhb_unitary_diagonal(r->width, m, V, model->damping_ratio, out + r->width * m * m);
  if (r->squares == 3)
    mhb_unitary_form(r->width, m, V, model->coriolis, im ? im->coriolis : NULL, 1 / speed,
                     out + 2 * r->width * m * m);
  double *at = out + r->squares * r->width * m * m;
  at         = rotate_rows(r, V, model->right, im ? im->right : NULL, side, row, at);
  if (model->has_left) at = rotate_rows(r, V, model->left, im ? im->left : NULL, side, row, at);
  at = rotate_rows(r, V, model->probe, im ? im->probe : NULL, probes, row, at);
  rotate_load(r, p, V, row, at);
  mhb_speed_table_place(r, out, &(mhb_speed_parts){place, place + 1, place + 2});
  copy_residuals(model, model, &place[0]);
  if (im) copy_residuals(model, im, &place[1]);
  if (p->backward) copy_residuals(model, p->backward, &place[2]);
}

/* ---- modes and basis ---- */

static int width_of(const modal_speeds *s) {
  return s->imaginary ? 2 : 1;
}

/* The lowest m modes at a speed: least singular value of their overlap, and V. */
static double align(const modal_speeds *s, int speed, int m, double *work, double *V) {
  const size_t  at = (size_t)speed * (size_t)s->n_modes * (size_t)s->n_modes;
  const double *im = s->overlap_imaginary;
  return mhb_unitary_align(width_of(s), m, s->n_modes, s->overlap + at, im ? im + at : NULL, work,
                           V);
}

/* The speeds of one or of several nodal diameters, of which from .. to are used. */
typedef struct {
  int                 n, from, to;
  const modal_speeds *speeds; /* [n] */
  const char         *path;
} family;

/* The least squared cosine between the lowest m modes of the first speed and those of the speeds
 * used. */
static double kept(const family *f, int m, double *work) {
  double least = 1;
  for (int d = 0; d < f->n; d++)
    for (int i = f->from; i <= f->to; i++) {
      double sigma = align(&f->speeds[d], i, m, work, NULL);
      least        = fmin(least, sigma < 0 ? 0 : sigma * sigma);
    }
  return least;
}

static shb_status exchanged(const family *f) {
  const modal_speeds *s = f->speeds;
  SHB_FAIL(SHB_ERR_INPUT,
           "mhb.run_up: %s: whatever number of the %d modes is kept, some change places with the "
           "others between %.6g and %.6g rpm; give more modal.modes",
           f->path, s->model[f->from].n_modes, rpm(s->speed[f->from]), rpm(s->speed[f->to]));
}

static shb_status choose_space(const family *f, double *work, int *modes) {
  const int all  = f->speeds[0].model[f->from].n_modes;
  double    best = 0;
  int       at   = 0;
  for (int m = all; 2 * m >= all && best < STAYS; m--) {
    double part = kept(f, m, work);
    if (part <= best) continue;
    best = part;
    at   = m;
  }
  if (best < modal_speeds_mac_limit) return exchanged(f);
  *modes = at;
  return SHB_OK;
}

/* Tracks below m are the lowest m modes at every speed. */
static bool is_closed(const modal_speeds *s, int from, int to, int m) {
  for (int i = from; i <= to; i++)
    for (int t = 0; t < m; t++)
      if (s->mode[i * s->n_modes + t] >= m) return false;
  return true;
}

/* The first speed and track below m that is lost there; false: none. */
static bool is_lost(const modal_speeds *s, int from, int to, int m, int *speed, int *track) {
  for (*speed = from + 1; *speed <= to; ++*speed)
    for (*track = 0; *track < m; ++*track)
      if (s->mac[*speed * s->n_modes + *track] < modal_speeds_mac_limit) return true;
  return false;
}

/* Without overlaps: tracks that are not lost. */
static shb_status choose_tracks(const family *f, int *modes) {
  const modal_speeds *s   = f->speeds;
  const int           all = s->model[f->from].n_modes, least = (all + 1) / 2;
  int                 i, t;
  for (int m = all; m >= least; m--) {
    if (!is_closed(s, f->from, f->to, m) || is_lost(s, f->from, f->to, m, &i, &t)) continue;
    *modes = m;
    return SHB_OK;
  }
  SHB_CHECK(!is_lost(s, f->from, f->to, least, &i, &t), SHB_ERR_INPUT,
            "mhb.run_up: %s: mode %d of %.6g rpm has a MAC of %.2g only with any of %.6g rpm; "
            "give more speeds between them, or /speeds/overlap",
            f->path, s->mode[i * s->n_modes + t] + 1, rpm(s->speed[i]), s->mac[i * s->n_modes + t],
            rpm(s->speed[i - 1]));
  return exchanged(f);
}

/* V[mode][place] of a speed. */
static void basis(const mhb_speed_table *r, int speed, double *work, double *V) {
  const modal_speeds *s = &r->speeds;
  const int           m = r->n_modes;
  if (s->overlap) {
    align(s, speed, m, work, V);
    return;
  }
  memset(V, 0, (size_t)m * (size_t)m * sizeof *V);
  for (int t = 0; t < m; t++) V[s->mode[speed * s->n_modes + t] * m + t] = 1;
}

/* ---- life cycle ---- */

static shb_status check_range(const mhb_speed_table *r, const char *path) {
  const modal_speeds *s = &r->speeds;
  const double        E = r->engine_order, first = s->speed[0], last = s->speed[s->n - 1];
  SHB_CHECK(r->band[0] / E >= first * (1 - HAIR) && r->band[1] / E <= last * (1 + HAIR),
            SHB_ERR_INPUT,
            "mhb.run_up: %.6g to %.6g Hz on engine order %d is a rotor of %.6g to %.6g rpm, but "
            "%s has speeds from %.6g to %.6g rpm, which cover %.6g to %.6g Hz",
            r->band[0] / SHB_TWO_PI, r->band[1] / SHB_TWO_PI, r->engine_order, rpm(r->band[0] / E),
            rpm(r->band[1] / E), path, rpm(first), rpm(last), E * first / SHB_TWO_PI,
            E * last / SHB_TWO_PI);
  return SHB_OK;
}

/* The entries of speeds from .. to. */
static void fill(mhb_speed_table *r, int from, double *work) {
  const size_t    m      = (size_t)r->n_modes;
  double         *square = shb_alloc_zeroed((size_t)r->n, sizeof *square);
  double         *V      = shb_alloc_zeroed((size_t)r->width * m * m + m, sizeof *V);
  double complex *row    = shb_alloc_zeroed(m, sizeof *row);
  r->first_entry         = shb_alloc_zeroed(r->size, sizeof *r->first_entry);
  r->entries             = shb_alloc_zeroed((size_t)r->n * r->size, sizeof *r->entries);
  for (int i = 0; i < r->n; i++) {
    const mhb_speed_parts parts = parts_of(&r->speeds, from + i);
    square[i]                   = pow(r->speeds.speed[from + i], 2);
    basis(r, from + i, work, V);
    fill_entry(r, &parts, r->speeds.speed[from + i], V, r->entries + (size_t)i * r->size, row,
               V + (size_t)r->width * m * m);
  }
  memcpy(r->first_entry, r->entries, r->size * sizeof *r->first_entry);
  for (size_t i = 0; i < (size_t)r->n * r->size; i++) r->entries[i] -= r->first_entry[i % r->size];
  modal_spline_create(r->n, square, &r->spline);
  free(square);
  free(V);
  free(row);
}

/* Residual modes cross and rotate with the speed: they are not interpolated, the three terms
 * are. */
static shb_status keep_terms(const mhb_speed_parts *p, int modes) {
  SHB_TRY(modal_wave_reduce(p->model, p->imaginary, p->backward, modes, true));
  modal_wave_drop_residual_modes(p->model, p->imaginary, p->backward);
  return SHB_OK;
}

/* Those modes of speeds from .. to. */
static shb_status make(mhb_speed_table *r, int from, int to, int modes, double *work) {
  modal_speeds *s = &r->speeds;
  r->width        = width_of(s);
  r->n            = to - from + 1;
  r->n_modes      = modes;
  r->n_dropped    = s->model[from].n_modes - modes;
  r->low          = s->speed[from];
  r->high         = s->speed[to];
  r->last         = parts_of(s, to);
  r->common       = r->last.model;
  for (int i = from; i <= to; i++) {
    const mhb_speed_parts parts = parts_of(s, i);
    SHB_TRY(keep_terms(&parts, modes));
  }
  lay_out(r);
  fill(r, from, work);
  return SHB_OK;
}

/* The speeds that the range needs, with some beside it. */
static shb_status choose_speeds(const mhb_speed_table *r, family *f) {
  const modal_speeds *s = &r->speeds;
  SHB_CHECK(r->engine_order >= 1, SHB_ERR_INPUT,
            "mhb.run_up: excitation.engine_order is %d; the speed follows the frequency only on "
            "engine order 1 or higher",
            r->engine_order);
  SHB_CHECK(s->n > 1, SHB_ERR_INPUT,
            "mhb.run_up: %s holds modes of one speed; several are wanted: rotor.speed as a list "
            "where the "
            "modal stage makes the file, /speeds in a file of your own",
            f->path);
  for (int i = 0; i < s->n; i++)
    SHB_CHECK(
        !s->model[i].coriolis == !s->model[0].coriolis &&
            (s->speed[i] > 0 || !s->model[i].coriolis),
        SHB_ERR_INPUT,
        "mhb.run_up: %s: modes/coriolis at %.6g rpm: Coriolis terms are needed at every speed "
        "or at none, and no speed may be 0",
        f->path, rpm(s->speed[i]));
  SHB_TRY(check_range(r, f->path));
  int from = 0, to = s->n - 1;
  while (from + 1 < s->n && s->speed[from + 1] <= r->band[0] / r->engine_order) from++;
  while (to > 0 && s->speed[to - 1] >= r->band[1] / r->engine_order) to--;
  f->from = from > BESIDE ? from - BESIDE : 0;
  f->to   = to + BESIDE < s->n ? to + BESIDE : s->n - 1;
  return SHB_OK;
}

static shb_status make_all(int n, mhb_speed_table *const *table, family *f) {
  const modal_speeds *first = &table[0]->speeds;
  int                 modes = 0;
  SHB_TRY(choose_speeds(table[0], f));
  double    *work   = shb_alloc_zeroed(mhb_unitary_align_work(2, first->n_modes), sizeof *work);
  shb_status status = first->overlap ? choose_space(f, work, &modes) : choose_tracks(f, &modes);
  for (int i = 0; i < n && status == SHB_OK; i++)
    status = make(table[i], f->from, f->to, modes, work);
  free(work);
  return status;
}

/* A table that has taken over its speeds. */
static mhb_speed_table *begin(modal_speeds *speeds, int engine_order, const double frequency[2]) {
  mhb_speed_table *r = shb_alloc_zeroed(1, sizeof *r);
  r->speeds          = *speeds;
  *speeds            = (modal_speeds){0};
  r->engine_order    = engine_order;
  r->band[0]         = SHB_TWO_PI * frequency[0];
  r->band[1]         = SHB_TWO_PI * frequency[1];
  return r;
}

shb_status mhb_speed_tables_create(int n, modal_speeds *speeds, const char *path, int engine_order,
                                   const double frequency[2], mhb_speed_table **out) {
  modal_speeds *borrowed = shb_alloc_zeroed((size_t)n, sizeof *borrowed);
  family        f        = {.n = n, .speeds = borrowed, .path = path};
  for (int i = 0; i < n; i++) {
    borrowed[i] = speeds[i];
    out[i]      = begin(&speeds[i], engine_order, frequency);
  }
  const shb_status status = make_all(n, out, &f);
  free(borrowed);
  for (int i = 0; i < n && status != SHB_OK; i++) {
    mhb_speed_table_destroy(out[i]);
    out[i] = NULL;
  }
  return status;
}

shb_status mhb_speed_table_create(modal_speeds *speeds, const char *path, int engine_order,
                                  const double frequency[2], mhb_speed_table **out) {
  return mhb_speed_tables_create(1, speeds, path, engine_order, frequency, out);
}

void mhb_speed_table_destroy(mhb_speed_table *r) {
  if (!r) return;
  modal_speeds_free(&r->speeds);
  modal_spline_free(&r->spline);
  free(r->first_entry);
  free(r->entries);
  free(r);
}
