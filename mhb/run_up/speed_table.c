#include "mhb/run_up/speed_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
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

/* Those of one of the models; sizes: the first of the parts. */
static void unrotated_of(const modal_model *sizes, const modal_model *m, const void **data,
                         size_t *count) {
  const size_t c = (size_t)modal_model_contact_dofs(sizes), q = 3 * (size_t)sizes->n_probes;
  const size_t k = 2 * ((size_t)sizes->n_load + 1);
  const struct {
    const void *data;
    size_t      count;
  } part[MHB_SPEED_TABLE_UNROTATED] = {{m->load_residual, k * c},
                                       {m->load_inertia, k * c},
                                       {m->load_fourth, k * c},
                                       {m->probe_load_residual, k * q},
                                       {m->probe_load_inertia, k * q},
                                       {m->probe_load_fourth, k * q},
                                       {m->residual_flexibility, c * c},
                                       {m->residual_inertia, c * c},
                                       {m->residual_fourth, c * c},
                                       {m->contact_tail, 2 * c},
                                       {m->load_tail, k},
                                       {m->probe_contact_residual, q * c},
                                       {m->probe_contact_inertia, q * c},
                                       {m->probe_contact_fourth, q * c}};
  for (int i = 0; i < MHB_SPEED_TABLE_UNROTATED; i++) {
    data[i]  = part[i].data;
    count[i] = part[i].data ? part[i].count : 0;
  }
}

static void unrotated(const mhb_speed_parts *parts, const void *data[MHB_SPEED_TABLE_ALL],
                      size_t count[MHB_SPEED_TABLE_ALL]) {
  static const modal_model none   = {0};
  const modal_model *const from[] = {parts->model, parts->imaginary, parts->backward};
  for (int i = 0; i < 3; i++)
    unrotated_of(parts->model, from[i] ? from[i] : &none, data + i * MHB_SPEED_TABLE_UNROTATED,
                 count + i * MHB_SPEED_TABLE_UNROTATED);
}

static void set_unrotated_of(modal_model *m, double *const *data) {
  m->load_residual          = (double complex *)data[0];
  m->load_inertia           = (double complex *)data[1];
  m->load_fourth            = (double complex *)data[2];
  m->probe_load_residual    = (double complex *)data[3];
  m->probe_load_inertia     = (double complex *)data[4];
  m->probe_load_fourth      = (double complex *)data[5];
  m->residual_flexibility   = data[6];
  m->residual_inertia       = data[7];
  m->residual_fourth        = data[8];
  m->contact_tail           = data[9];
  m->load_tail              = data[10];
  m->probe_contact_residual = data[11];
  m->probe_contact_inertia  = data[12];
  m->probe_contact_fourth   = data[13];
}

void mhb_speed_table_set_unrotated(const mhb_speed_parts *parts,
                                   double *const          data[MHB_SPEED_TABLE_ALL]) {
  modal_model *const to[] = {parts->model, parts->imaginary, parts->backward};
  for (int i = 0; i < 3; i++)
    if (to[i]) set_unrotated_of(to[i], data + i * MHB_SPEED_TABLE_UNROTATED);
}

static mhb_speed_parts parts_of(const modal_speeds *s, int i) {
  if (!s->imaginary) return (mhb_speed_parts){&s->model[i], NULL, NULL};
  return (mhb_speed_parts){&s->model[i], &s->imaginary[i], &s->backward[i]};
}

static void lay_out(mhb_speed_table *r, const mhb_speed_parts *common) {
  const modal_model *m = common->model;
  const void        *unused[MHB_SPEED_TABLE_ALL];
  const size_t       modes = (size_t)r->n_modes, width = (size_t)r->width;
  r->rows    = modal_model_contact_dofs(m) + 3 * m->n_probes + 2 * (m->n_load + 1);
  r->squares = m->coriolis ? 3 : 2;
  r->size    = width * ((size_t)r->squares * modes + (size_t)r->rows) * modes;
  r->size += r->size % 2; /* complex numbers follow */
  unrotated(common, unused, r->count);
  for (int i = 0; i < MHB_SPEED_TABLE_ALL; i++) {
    r->unrotated[i] = r->size;
    r->size += r->count[i];
    r->size += r->size % 2; /* as complex numbers of the next model do */
  }
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
  const void        *data[MHB_SPEED_TABLE_ALL];
  size_t             count[MHB_SPEED_TABLE_ALL];
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
  unrotated(p, data, count);
  for (int i = 0; i < MHB_SPEED_TABLE_ALL; i++)
    if (count[i]) memcpy(out + r->unrotated[i], data[i], count[i] * sizeof *out);
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
static shb_status fill(mhb_speed_table *r, int from, double *work) {
  const size_t    m      = (size_t)r->n_modes;
  double         *square = calloc((size_t)r->n, sizeof *square);
  double         *V      = calloc((size_t)r->width * m * m + m, sizeof *V);
  double complex *row    = calloc(m, sizeof *row);
  r->first_entry         = calloc(r->size, sizeof *r->first_entry);
  r->entries             = calloc((size_t)r->n * r->size, sizeof *r->entries);
  shb_status status      = SHB_OK;
  if (!square || !V || !row || !r->first_entry || !r->entries)
    status =
        shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for the models of %d speeds", r->n);
  for (int i = 0; status == SHB_OK && i < r->n; i++) {
    const mhb_speed_parts parts = parts_of(&r->speeds, from + i);
    square[i]                   = pow(r->speeds.speed[from + i], 2);
    basis(r, from + i, work, V);
    fill_entry(r, &parts, r->speeds.speed[from + i], V, r->entries + (size_t)i * r->size, row,
               V + (size_t)r->width * m * m);
  }
  if (status == SHB_OK) {
    memcpy(r->first_entry, r->entries, r->size * sizeof *r->first_entry);
    for (size_t i = 0; i < (size_t)r->n * r->size; i++)
      r->entries[i] -= r->first_entry[i % r->size];
    modal_spline_create(r->n, square, &r->spline);
  }
  free(square);
  free(V);
  free(row);
  return status;
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
  r->common       = &s->model[to];
  for (int i = from; i <= to; i++) {
    const mhb_speed_parts parts = parts_of(s, i);
    SHB_TRY(keep_terms(&parts, modes));
  }
  const mhb_speed_parts common = parts_of(s, to);
  lay_out(r, &common);
  return fill(r, from, work);
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
  double *work = calloc(mhb_unitary_align_work(2, first->n_modes), sizeof *work);
  SHB_CHECK(work, SHB_ERR_IO, "out of memory for %d modes", first->n_modes);
  shb_status status = first->overlap ? choose_space(f, work, &modes) : choose_tracks(f, &modes);
  for (int i = 0; i < n && status == SHB_OK; i++)
    status = make(table[i], f->from, f->to, modes, work);
  free(work);
  return status;
}

/* A table that has taken over its speeds. */
static mhb_speed_table *begin(modal_speeds *speeds, int engine_order, const double frequency[2]) {
  mhb_speed_table *r = calloc(1, sizeof *r);
  if (!r) return NULL;
  r->speeds       = *speeds;
  *speeds         = (modal_speeds){0};
  r->engine_order = engine_order;
  r->band[0]      = SHB_TWO_PI * frequency[0];
  r->band[1]      = SHB_TWO_PI * frequency[1];
  return r;
}

shb_status mhb_speed_tables_create(int n, modal_speeds *speeds, const char *path, int engine_order,
                                   const double frequency[2], mhb_speed_table **out) {
  modal_speeds *borrowed = calloc((size_t)n, sizeof *borrowed);
  family        f        = {.n = n, .speeds = borrowed, .path = path};
  bool          begun    = borrowed;
  for (int i = 0; i < n; i++) out[i] = NULL;
  for (int i = 0; i < n && begun; i++) {
    borrowed[i] = speeds[i];
    out[i]      = begin(&speeds[i], engine_order, frequency);
    begun       = out[i];
  }
  shb_status status =
      begun ? make_all(n, out, &f) : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
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
