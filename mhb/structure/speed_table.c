#include "mhb/structure/speed_table.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
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

void mhb_speed_table_unrotated(const modal_model *m, const void *data[MHB_SPEED_TABLE_UNROTATED],
                               size_t count[MHB_SPEED_TABLE_UNROTATED]) {
  const size_t c = 3 * (size_t)m->n_pairs * (m->has_left ? 2 : 1), q = 3 * (size_t)m->n_probes;
  const size_t k = 2 * ((size_t)m->n_load + 1);
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

void mhb_speed_table_set_unrotated(modal_model *m, double *const data[MHB_SPEED_TABLE_UNROTATED]) {
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

static void lay_out(mhb_speed_table *r) {
  const modal_model *m = r->common;
  const void        *unused[MHB_SPEED_TABLE_UNROTATED];
  r->rows = 3 * m->n_pairs * (m->has_left ? 2 : 1) + 3 * m->n_probes + 2 * (m->n_load + 1);
  r->size = (2 * (size_t)r->n_modes + (size_t)r->rows) * (size_t)r->n_modes;
  r->size += r->size % 2; /* complex numbers follow */
  mhb_speed_table_unrotated(m, unused, r->count);
  for (int i = 0; i < MHB_SPEED_TABLE_UNROTATED; i++) {
    r->unrotated[i] = r->size;
    r->size += r->count[i];
  }
}

/* out[m][m] = V^T diag(value) V */
static void rotate_diagonal(int m, const double *V, const double *value, double *out) {
  for (int t = 0; t < m; t++)
    for (int u = 0; u < m; u++) {
      double sum = 0;
      for (int i = 0; i < m; i++) sum += V[i * m + t] * value[i] * V[i * m + u];
      out[t * m + u] = sum;
    }
}

/* out[m] = row[m] V, row of every stride-th value */
static void rotate_row(int m, const double *V, const double *row, int stride, double *out) {
  for (int t = 0; t < m; t++) {
    double sum = 0;
    for (int i = 0; i < m; i++) sum += row[i * stride] * V[i * m + t];
    out[t] = sum;
  }
}

static double *rotate_rows(int m, const double *V, const double *rows, int n, double *out) {
  for (int row = 0; row < n; row++, out += m) rotate_row(m, V, rows + (size_t)(row * m), 1, out);
  return out;
}

/* An entry from a speed's model and V[mode][place]. */
static void fill_entry(const mhb_speed_table *r, const modal_model *model, const double *V,
                       double *out, double *scratch) {
  const int   m = r->n_modes, side = 3 * model->n_pairs;
  const void *data[MHB_SPEED_TABLE_UNROTATED];
  size_t      count[MHB_SPEED_TABLE_UNROTATED];
  for (int i = 0; i < m; i++) scratch[i] = pow(SHB_TWO_PI * model->frequency[i], 2);
  rotate_diagonal(m, V, scratch, out);
  rotate_diagonal(m, V, model->damping_ratio, out + m * m);
  double *at = rotate_rows(m, V, model->right, side, out + 2 * m * m);
  if (model->has_left) at = rotate_rows(m, V, model->left, side, at);
  at = rotate_rows(m, V, model->probe, 3 * model->n_probes, at);
  for (int part = 0; part < 2; part++)
    for (int k = 0; k <= model->n_load; k++, at += m)
      rotate_row(m, V, (const double *)(model->modal_force + (size_t)(k * m)) + part, 2, at);
  mhb_speed_table_unrotated(model, data, count);
  for (int i = 0; i < MHB_SPEED_TABLE_UNROTATED; i++)
    if (count[i]) memcpy(out + r->unrotated[i], data[i], count[i] * sizeof *out);
}

/* ---- modes and basis ---- */

/* Leading m x m block of the overlap at a speed = A Sigma B^T; V[mode][place] <- B A^T unless NULL.
 * Returns the least Sigma; -1: not found. work: 5 m^2 + m. */
static double align(const modal_speeds *s, int speed, int m, double *work, double *V) {
  const size_t  square = (size_t)m * (size_t)m, all = (size_t)s->n_modes;
  const double *C = s->overlap + (size_t)speed * all * all;
  double       *X = work, *A = X + square, *B = A + square, *sigma = B + square;
  for (int i = 0; i < m; i++) memcpy(X + i * m, C + (size_t)i * all, (size_t)m * sizeof *X);
  if (LAPACKE_dgesdd(LAPACK_ROW_MAJOR, 'A', m, m, X, m, sigma, A, m, B, m) != 0) return -1;
  for (int mode = 0; V && mode < m; mode++)
    for (int t = 0; t < m; t++) {
      double sum = 0;
      for (int k = 0; k < m; k++) sum += B[k * m + mode] * A[t * m + k];
      V[mode * m + t] = sum;
    }
  return sigma[m - 1];
}

/* The least squared cosine between the lowest m modes of the first speed and those of speeds from
 * .. to. */
static double kept(const modal_speeds *s, int from, int to, int m, double *work) {
  double least = 1;
  for (int i = from; i <= to; i++) {
    double sigma = align(s, i, m, work, NULL);
    least        = fmin(least, sigma < 0 ? 0 : sigma * sigma);
  }
  return least;
}

static shb_status exchanged(const modal_speeds *s, const char *path, int from, int to) {
  SHB_FAIL(SHB_ERR_INPUT,
           "mhb.run_up: %s: whatever number of the %d modes is kept, some change places with the "
           "others between %.6g and %.6g rpm; give more modal.modes",
           path, s->model[from].n_modes, rpm(s->speed[from]), rpm(s->speed[to]));
}

static shb_status choose_space(const modal_speeds *s, const char *path, int from, int to,
                               double *work, int *modes) {
  double best = 0;
  int    at   = 0;
  for (int m = s->model[from].n_modes; 2 * m >= s->model[from].n_modes && best < STAYS; m--) {
    double part = kept(s, from, to, m, work);
    if (part <= best) continue;
    best = part;
    at   = m;
  }
  if (best < modal_speeds_mac_limit) return exchanged(s, path, from, to);
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
static shb_status choose_tracks(const modal_speeds *s, const char *path, int from, int to,
                                int *modes) {
  const int all = s->model[from].n_modes, least = (all + 1) / 2;
  int       i, t;
  for (int m = all; m >= least; m--) {
    if (!is_closed(s, from, to, m) || is_lost(s, from, to, m, &i, &t)) continue;
    *modes = m;
    return SHB_OK;
  }
  SHB_CHECK(!is_lost(s, from, to, least, &i, &t), SHB_ERR_INPUT,
            "mhb.run_up: %s: mode %d of %.6g rpm has a MAC of %.2g only with any of %.6g rpm; "
            "give more speeds between them, or /speeds/overlap",
            path, s->mode[i * s->n_modes + t] + 1, rpm(s->speed[i]), s->mac[i * s->n_modes + t],
            rpm(s->speed[i - 1]));
  return exchanged(s, path, from, to);
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
  const size_t m = (size_t)r->n_modes;
  double      *V = work, *square = calloc((size_t)r->n, sizeof *square);
  work += m * m;
  r->first_entry = calloc(r->size, sizeof *r->first_entry);
  r->entries     = calloc((size_t)r->n * r->size, sizeof *r->entries);
  if (!square || !r->first_entry || !r->entries) {
    free(square);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the modal models of %d speeds", r->n);
  }
  for (int i = 0; i < r->n; i++) {
    square[i] = pow(r->speeds.speed[from + i], 2);
    basis(r, from + i, work, V);
    fill_entry(r, &r->speeds.model[from + i], V, r->entries + (size_t)i * r->size, work);
  }
  memcpy(r->first_entry, r->entries, r->size * sizeof *r->first_entry);
  for (size_t i = 0; i < (size_t)r->n * r->size; i++) r->entries[i] -= r->first_entry[i % r->size];
  shb_status status = modal_spline_create(r->n, square, &r->spline);
  free(square);
  return status;
}

/* Residual modes cross and rotate with the speed: they are not interpolated, the three terms
 * are. */
static shb_status keep_terms(modal_model *model, int modes) {
  SHB_TRY(modal_model_reduce(model, modes, true));
  modal_model_drop_residual_modes(model);
  return SHB_OK;
}

static shb_status make(mhb_speed_table *r, const char *path) {
  modal_speeds *s    = &r->speeds;
  int           from = 0, to = s->n - 1;
  SHB_CHECK(r->engine_order >= 1, SHB_ERR_INPUT,
            "mhb.run_up: excitation.engine_order is %d; the speed follows the frequency only on "
            "engine order 1 or higher",
            r->engine_order);
  SHB_CHECK(s->n > 1, SHB_ERR_INPUT,
            "mhb.run_up: %s holds modes of one speed; several are wanted: rotor.speed as a list "
            "where the "
            "modal stage makes the file, /speeds in a file of your own",
            path);
  SHB_TRY(check_range(r, path));
  while (from + 1 < s->n && s->speed[from + 1] <= r->band[0] / r->engine_order) from++;
  while (to > 0 && s->speed[to - 1] >= r->band[1] / r->engine_order) to--;
  from         = from > BESIDE ? from - BESIDE : 0;
  to           = to + BESIDE < s->n ? to + BESIDE : s->n - 1;
  size_t  m    = (size_t)s->n_modes;
  double *work = calloc(6 * m * m + 2 * m, sizeof *work);
  SHB_CHECK(work, SHB_ERR_IO, "out of memory for %zu modes", m);
  shb_status status = s->overlap ? choose_space(s, path, from, to, work, &r->n_modes)
                                 : choose_tracks(s, path, from, to, &r->n_modes);
  r->n              = to - from + 1;
  r->n_dropped      = s->model[from].n_modes - r->n_modes;
  r->low            = s->speed[from];
  r->high           = s->speed[to];
  r->common         = &s->model[to];
  for (int i = from; i <= to && status == SHB_OK; i++)
    status = keep_terms(&s->model[i], r->n_modes);
  if (status == SHB_OK) {
    lay_out(r);
    status = fill(r, from, work);
  }
  free(work);
  return status;
}

shb_status mhb_speed_table_create(modal_speeds *speeds, const char *path, int engine_order,
                                  const double frequency[2], mhb_speed_table **out) {
  mhb_speed_table *r = calloc(1, sizeof *r);
  SHB_CHECK(r, SHB_ERR_IO, "out of memory");
  r->speeds         = *speeds;
  *speeds           = (modal_speeds){0};
  r->engine_order   = engine_order;
  r->band[0]        = SHB_TWO_PI * frequency[0];
  r->band[1]        = SHB_TWO_PI * frequency[1];
  shb_status status = make(r, path);
  if (status != SHB_OK) {
    mhb_speed_table_destroy(r);
    return status;
  }
  *out = r;
  return SHB_OK;
}

void mhb_speed_table_destroy(mhb_speed_table *r) {
  if (!r) return;
  modal_speeds_free(&r->speeds);
  modal_spline_free(&r->spline);
  free(r->first_entry);
  free(r->entries);
  free(r);
}
