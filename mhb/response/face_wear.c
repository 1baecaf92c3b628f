#include "mhb/response/face_wear.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/fourier.h"
#include "mhb/response/pair_law.h"

enum { SAMPLES = 512 };

/* ---------------------------------------------------------------- slip */

static int by_phase(const void *a, const void *b) {
  double x = ((const mhb_contact_sample *)a)->phase, y = ((const mhb_contact_sample *)b)->phase;
  return (x > y) - (x < y);
}

static void tangential(const double *motion, int m, double phase, double s[2]) {
  const int nb = mhb_real_size(m);
  for (int d = 0; d < 2; d++) {
    const double *x = motion + (d + 1) * nb;
    s[d]            = x[0];
    for (int k = 1; k <= m; k++) {
      double t = SHB_TWO_PI * fmod(k * phase, 1);
      s[d] += x[2 * k - 1] * cos(t) - x[2 * k] * sin(t);
    }
  }
}

/* way and work of the chords between samples that slip. */
static void add_chords(const mhb_law *law, const double *motion, int m, int n,
                       const mhb_contact_sample *sample, double *way, double *work) {
  const double *ku = law->ku, det = ku[0] * ku[2] - ku[1] * ku[1];
  double        s[2], before[2];
  tangential(motion, m, sample[0].phase, before);
  for (int i = 1; i < n; i++) {
    tangential(motion, m, sample[i].phase, s);
    const double *f = sample[i - 1].f, *g = sample[i].f;
    const double  df[2]   = {g[0] - f[0], g[1] - f[1]};
    const double  step[2] = {s[0] - before[0] - (ku[2] * df[0] - ku[1] * df[1]) / det,
                             s[1] - before[1] - (ku[0] * df[1] - ku[1] * df[0]) / det};
    if (sample[i - 1].state == MHB_SLIDE) {
      *way += hypot(step[0], step[1]);
      *work += (f[0] + g[0]) / 2 * step[0] + (f[1] + g[1]) / 2 * step[1];
    }
    memcpy(before, s, sizeof before);
  }
}

void mhb_slip_way(mhb_contact_evaluator *contact, const mhb_law *law, const double *motion, int m,
                  int samples, double *way, double *work) {
  mhb_contact_info   *info = shb_alloc(1, sizeof *info);
  mhb_contact_sample *sample =
      shb_alloc_zeroed((size_t)samples + MHB_MAX_TRANSITIONS + 1, sizeof *sample);
  int n = 0;
  *way = *work = 0;
  mhb_contact_time_history(contact, law, motion, 1, sample, info); /* for its transitions */
  for (int i = 0; i <= samples; i++) sample[n++].phase = (double)i / samples;
  for (int i = 0; i < info->n_transitions; i++) sample[n++].phase = info->transition[i].phase;
  qsort(sample, (size_t)n, sizeof *sample, by_phase);
  mhb_contact_time_history(contact, law, motion, n, sample, info);
  add_chords(law, motion, m, n, sample, way, work);
  free(info);
  free(sample);
}

/* ---------------------------------------------------------------- branches */

void mhb_face_wear_free(mhb_face_wear *wear) {
  free(wear->point);
  free(wear->pressure);
  free(wear->slip);
  free(wear->dissipation);
  free(wear->state);
  *wear = (mhb_face_wear){0};
}

static void allocate(mhb_face_wear *w, int n, int pairs) {
  const size_t size = (size_t)n * (size_t)pairs;
  mhb_face_wear_free(w);
  w->point       = shb_alloc_zeroed((size_t)n, sizeof *w->point);
  w->pressure    = shb_alloc_zeroed(size, sizeof *w->pressure);
  w->slip        = shb_alloc_zeroed(size, sizeof *w->slip);
  w->dissipation = shb_alloc_zeroed(size, sizeof *w->dissipation);
  w->state       = shb_alloc_zeroed(3 * size, sizeof *w->state);
  w->n           = n;
}

/* Row `row` of the wear: a point of the branch. */
static void fill_row(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                     mhb_contact_evaluator *contact, mhb_branch *b, int row) {
  const size_t n = (size_t)model->n_pairs, K = (size_t)b->n_harmonics + 1;
  const int    point = b->wear.point[row];
  double       share[n], work, x[3 * mhb_real_size(b->n_harmonics)];
  mhb_recorded_shares(r, model->area, share);
  for (size_t a = 0; a < n; a++) {
    const size_t  from = (size_t)point * n + a, to = (size_t)row * n + a;
    const mhb_law law = mhb_recorded_law(s, r, b, point, (int)a, share[a]);
    mhb_recorded_pair_motion(r, b, point, (int)a, x);
    b->wear.pressure[to]    = (creal(b->force[3 * from * K]) + law.mean_offset) / model->area[a];
    b->wear.dissipation[to] = b->dissipation[from] / model->area[a];
    memcpy(b->wear.state + 3 * to, b->state + 3 * from, 3 * sizeof *b->wear.state);
    mhb_slip_way(contact, &law, x, b->n_harmonics, SAMPLES, &b->wear.slip[to], &work);
  }
}

static shb_status keep(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                       mhb_branch *b) {
  mhb_contact_evaluator *contact = NULL;
  int                    n = 0, row = 0;
  for (int i = 0; i < b->n_points; i++) n += b->special[i] == MHB_PEAK;
  mhb_face_wear_free(&b->wear);
  if (n == 0) return SHB_OK;
  SHB_TRY(mhb_contact_evaluator_create(b->n_harmonics, b->n_harmonics, s->tolerance, &contact));
  allocate(&b->wear, n, model->n_pairs);
  for (int i = 0; i < b->n_points; i++)
    if (b->special[i] == MHB_PEAK) {
      b->wear.point[row] = i;
      fill_row(model, s, r, contact, b, row++);
    }
  mhb_contact_evaluator_destroy(contact);
  return SHB_OK;
}

shb_status mhb_face_wear_keep(const modal_model *model, const mhb_settings *s,
                              mhb_response *response) {
  if (s->run_up || s->ring || !model->area || model->n_interfaces > 1) return SHB_OK;
  for (int i = 0; i < response->n_branches; i++)
    if (response->branch[i].kind == MHB_BRANCH_NONLINEAR)
      SHB_TRY(keep(model, s, response, &response->branch[i]));
  return SHB_OK;
}

/* ---------------------------------------------------------------- file */

shb_status mhb_contact_face_write(hid_t file, const modal_contact_face *f) {
  const hsize_t n = (hsize_t)f->n_nodes, e = (hsize_t)f->n_elements, c = (hsize_t)f->corners;
  SHB_TRY(h5_write_double(file, "/contact_face/nodes", H5_SHAPE(n, 3), f->node, "m",
                          "nodes of the right contact face, mesh axes"));
  SHB_TRY(h5_write_double(file, "/contact_face/area", H5_SHAPE(n), f->area, "m^2",
                          "area of each node; its sum is that of the face"));
  const bool triangles = f->corners == 3 || f->corners == 6;
  return h5_write_int(file, triangles ? "/contact_face/triangles" : "/contact_face/quadrangles",
                      H5_SHAPE(e, c), f->element, "-",
                      "nodes of each element of the face, from 0: corners, then mid-sides");
}

/* A dataset of the nodes from values of the pairs, [n][pairs][rows]. */
static shb_status write_map(hid_t group, const modal_contact_face *f, int n_pairs, int n,
                            const double *of_pair, int rows, const char *const text[3]) {
  const size_t size = (size_t)f->n_nodes * (size_t)rows;
  double      *map  = shb_alloc_zeroed((size_t)n * size, sizeof *map);
  for (int i = 0; i < n; i++)
    modal_contact_face_spread(f, of_pair + (size_t)i * (size_t)(n_pairs * rows), rows,
                              map + (size_t)i * size);
  h5_shape shape = H5_SHAPE((hsize_t)n, (hsize_t)f->n_nodes);
  if (rows > 1) shape = H5_SHAPE((hsize_t)n, (hsize_t)f->n_nodes, (hsize_t)rows);
  shb_status status = h5_write_double(group, text[0], shape, map, text[1], text[2]);
  free(map);
  return status;
}

shb_status mhb_face_wear_write(hid_t group, const modal_contact_face *f, int n_pairs,
                               const mhb_face_wear *w) {
  static const char *const pressure[3] = {"face/pressure", "Pa", "mean pressure over the period"};
  static const char *const slip[3]     = {"face/slip", "m", "way slipped in a period, both senses"};
  static const char *const dissipation[3] = {"face/dissipation", "J m^-2",
                                             "energy lost by friction in a period, by area"};
  static const char *const state[3]       = {"face/state", "-",
                                             "share of the period stuck, slipping, open"};
  if (w->n == 0) return SHB_OK;
  SHB_TRY(h5_write_int(group, "face/point", H5_SHAPE((hsize_t)w->n), w->point, "-",
                       "points of the branch, from 0, that the maps belong to: its peaks"));
  SHB_TRY(write_map(group, f, n_pairs, w->n, w->pressure, 1, pressure));
  SHB_TRY(write_map(group, f, n_pairs, w->n, w->slip, 1, slip));
  SHB_TRY(write_map(group, f, n_pairs, w->n, w->dissipation, 1, dissipation));
  return write_map(group, f, n_pairs, w->n, w->state, 3, state);
}
