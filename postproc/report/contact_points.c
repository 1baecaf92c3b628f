#include "postproc/report/contact_points.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/contact/time_history.h"
#include "mhb/numerics/fourier.h"
#include "mhb/response/pair_law.h"

enum {
  BUDGET     = 50000, /* samples of all points together: 0.9 MB of the page */
  LEAST      = 240,   /* steps of a period before thinning */
  A_HARMONIC = 24,    /* the same, of the highest harmonic that matters */
  CURVES     = 5,     /* u, w, fu, fw, load */
  ROWS       = CURVES + 2,
  FULL       = 32767
};

static const double LEAST_HARMONIC = 1e-5; /* of the largest coefficient of its axis */
static const double FLAT           = 2e-3; /* of what a signal spans: half a pixel of a chart */
static const double SMALL = 1e-3; /* of the friction along one axis: what the other is drawn to */
static const double FORCE_TOLERANCE = 1e-3; /* of the largest force: less than a line is wide */

/* One period of a contact; scratch of a branch. */
typedef struct {
  int                    m, room, n; /* harmonics; samples that have room, samples */
  mhb_contact_evaluator *contact;
  mhb_contact_info      *info;
  mhb_contact_sample    *sample; /* [2 room] samples and middles between them, in turn */
  double                *motion; /* [3][2m+1] */
  double                *curve;  /* [room][CURVES] */
  int                   *corner; /* [room] samples that are kept */
  int                    corners;
} loop;

/* What is written of a branch. */
typedef struct {
  post_buffer at, loops;
  int16_t    *data;
  size_t      n, capacity;
} sheet;

/* ---------------------------------------------------------------- contacts */

static double dissipated(const mhb_response *r, int pair) {
  double sum = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int p = 0; p < r->branch[b].n_points; p++)
      sum += r->branch[b].dissipation[(size_t)p * (size_t)r->n_pairs + (size_t)pair];
  return sum;
}

static int ascending(const void *a, const void *b) {
  return *(const int *)a - *(const int *)b;
}

static void choose_pairs(const mhb_response *r, post_contact_plan *plan) {
  double last = INFINITY;
  int    at   = -1; /* the pair chosen before: equal work is taken in order */
  plan->n     = r->n_pairs < POST_SHOWN_CONTACTS ? r->n_pairs : POST_SHOWN_CONTACTS;
  for (int i = 0; i < plan->n; i++) {
    double most = -1;
    int    best = 0;
    for (int a = 0; a < r->n_pairs; a++) {
      double work = dissipated(r, a);
      bool   left = work < last || (work == last && a > at);
      if (left && work > most) {
        most = work;
        best = a;
      }
    }
    plan->pair[i] = at = best;
    last               = most;
  }
  qsort(plan->pair, (size_t)plan->n, sizeof *plan->pair, ascending);
}

/* ---------------------------------------------------------------- one period */

static void loop_free(loop *l) {
  mhb_contact_evaluator_destroy(l->contact);
  free(l->info);
  free(l->sample);
  free(l->motion);
  free(l->curve);
  free(l->corner);
}

static shb_status loop_create(int m, double tolerance, loop *l) {
  const int steps = A_HARMONIC * m > LEAST ? A_HARMONIC * m : LEAST;
  *l              = (loop){.m = m, .room = steps + 1 + MHB_MAX_TRANSITIONS};
  size_t room     = (size_t)l->room;
  l->info         = calloc(1, sizeof *l->info);
  l->sample       = calloc(2 * room, sizeof *l->sample);
  l->motion       = calloc(3 * (size_t)mhb_real_size(m), sizeof *l->motion);
  l->curve        = calloc(room * CURVES, sizeof *l->curve);
  l->corner       = calloc(room, sizeof *l->corner);
  shb_status status =
      l->info && l->sample && l->motion && l->curve && l->corner
          ? mhb_contact_evaluator_create(m, m, tolerance, &l->contact)
          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "not enough memory for the report");
  if (status != SHB_OK) loop_free(l);
  return status;
}

/* Highest harmonic that matters. */
static int highest(const loop *l) {
  int top = 1;
  for (int axis = 0; axis < 3; axis++) {
    const double *x    = l->motion + axis * mhb_real_size(l->m);
    double        most = 0;
    for (int k = 1; k <= l->m; k++) most = fmax(most, hypot(x[2 * k - 1], x[2 * k]));
    for (int k = l->m; k > top; k--)
      if (hypot(x[2 * k - 1], x[2 * k]) > LEAST_HARMONIC * most) top = k;
  }
  return top;
}

static int by_phase(const void *a, const void *b) {
  double x = ((const mhb_contact_sample *)a)->phase, y = ((const mhb_contact_sample *)b)->phase;
  return (x > y) - (x < y);
}

/* Samples at equal steps and at the transitions, and the middles between them: at a transition
 * round-off would decide the state. */
static void place(loop *l, const mhb_law *law) {
  mhb_contact_sample *s = l->sample;
  mhb_contact_time_history(l->contact, law, l->motion, 1, s, l->info); /* for its transitions */
  const int top = highest(l), steps = A_HARMONIC * top > LEAST ? A_HARMONIC * top : LEAST;
  int       n = 0;
  for (int i = 0; i <= steps; i++) s[n++].phase = (double)i / steps;
  for (int i = 0; i < l->info->n_transitions; i++) s[n++].phase = l->info->transition[i].phase;
  qsort(s, (size_t)n, sizeof *s, by_phase);
  l->n = 1;
  for (int i = 1; i < n; i++)
    if (s[i].phase > s[l->n - 1].phase) s[l->n++].phase = s[i].phase;
  for (int i = l->n - 1; i > 0; i--) s[2 * i].phase = s[i].phase;
  for (int i = 1; i < l->n; i++) s[2 * i - 1].phase = .5 * (s[2 * i - 2].phase + s[2 * i].phase);
}

/* State from sample i - 1 to i. */
static mhb_state state_before(const loop *l, int i) {
  return l->sample[i > 0 ? 2 * i - 1 : 1].state;
}

/* Coefficient k of a force (load, fu, fw), by Simpson's rule: forces are smooth between samples. */
static double complex harmonic(const loop *l, int axis, int k) {
  double complex sum = 0;
  for (int i = 1; i < 2 * l->n - 1; i += 2)
    for (int j = i - 1; j <= i + 1; j++) {
      const mhb_contact_sample *s      = &l->sample[j];
      const double              length = l->sample[i + 1].phase - l->sample[i - 1].phase;
      sum += (j == i ? 4 : 1) * length / 6 * (axis ? s->f[axis - 1] : s->n) *
             cexp(-I * SHB_TWO_PI * k * s->phase);
    }
  return k ? 2 * sum : sum;
}

/* Where a contact sticks throughout, its mean friction is that of the balance. */
static void take_mean(const double complex *const force[3], loop *l) {
  if (!l->info->undetermined) return;
  for (int k = 0; k < 2; k++) {
    const double off = creal(force[1 + k][0] - harmonic(l, 1 + k, 0));
    for (int i = 0; i < 2 * l->n - 1; i++) l->sample[i].f[k] += off;
  }
}

static void fill(loop *l) {
  const int nb = mhb_real_size(l->m);
  double    basis[nb];
  for (int i = 0; i < l->n; i++) {
    const mhb_contact_sample *s = &l->sample[2 * i];
    double                   *x = l->curve + (size_t)i * CURVES;
    mhb_basis(l->m, SHB_TWO_PI * s->phase, basis, NULL);
    for (int a = 0; a < 2; a++) {
      x[a] = 0;
      for (int j = 0; j < nb; j++) x[a] += l->motion[(1 + a) * nb + j] * basis[j];
      x[2 + a] = s->f[a];
    }
    x[4] = s->n;
  }
}

/* Do means and first harmonics agree with the forces of the file? */
static bool is_of_file(const loop *l, const double complex *const force[3], const mhb_law *law,
                       int first) {
  double most = 0, off = 0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k <= first; k += first) {
      double complex stored = force[i][k] + (i == 0 && k == 0 ? law->mean_offset : 0);
      most                  = fmax(most, cabs(stored));
      off                   = fmax(off, cabs(harmonic(l, i, k) - stored));
    }
  return off <= FORCE_TOLERANCE * most;
}

static double span(const loop *l, int c, double *size) {
  double lo = INFINITY, hi = -INFINITY;
  for (int i = 0; i < l->n; i++) {
    lo = fmin(lo, l->curve[i * CURVES + c]);
    hi = fmax(hi, l->curve[i * CURVES + c]);
  }
  *size = fmax(fabs(lo), fabs(hi));
  return hi - lo;
}

/* Is the curve straight from sample i to j? */
static bool is_straight(const loop *l, const double flat[CURVES], int i, int j) {
  const double  t = l->sample[2 * i].phase, length = l->sample[2 * j].phase - t;
  const double *a = l->curve + (size_t)i * CURVES, *b = l->curve + (size_t)j * CURVES;
  for (int k = i + 1; k < j; k++) {
    const double *x = l->curve + (size_t)k * CURVES, part = (l->sample[2 * k].phase - t) / length;
    for (int c = 0; c < CURVES; c++)
      if (fabs(x[c] - a[c] - part * (b[c] - a[c])) > flat[c]) return false;
  }
  return true;
}

/* Keep the corners of a polygon, among them every change of state. */
static void thin(loop *l, const double flat[CURVES]) {
  l->corners   = 1;
  l->corner[0] = 0;
  for (int j = 2; j < l->n; j++) {
    const int i = l->corner[l->corners - 1];
    if (state_before(l, j) != state_before(l, j - 1) || !is_straight(l, flat, i, j))
      l->corner[l->corners++] = j - 1;
  }
  l->corner[l->corners++] = l->n - 1;
}

/* The period of a pair at a point; no corners where it is not that of the file. */
static mhb_law follow(const post_analysis *analysis, const mhb_branch *b, int point, int pair,
                      double share, loop *l) {
  const mhb_response   *r  = analysis->response;
  const size_t          K  = (size_t)b->n_harmonics + 1;
  const double complex *at = b->force + ((size_t)point * (size_t)r->n_pairs + (size_t)pair) * 3 * K;
  const double complex *force[3] = {at, at + K, at + 2 * K};
  const mhb_law         law      = mhb_recorded_law(analysis->settings, r, b, point, pair, share);
  double                flat[CURVES], size[CURVES];
  mhb_recorded_pair_motion(r, b, point, pair, l->motion);
  place(l, &law);
  mhb_contact_time_history(l->contact, &law, l->motion, 2 * l->n - 1, l->sample, l->info);
  take_mean(force, l);
  fill(l);
  for (int c = 0; c < CURVES; c++) flat[c] = FLAT * span(l, c, &size[c]);
  const double friction = fmax(flat[2], flat[3]);
  for (int c = 2; c < 4; c++) flat[c] = fmax(flat[c], SMALL * friction);
  flat[4]    = FLAT * size[4]; /* drawn from 0 on */
  l->corners = 0;
  if (is_of_file(l, force, &law, post_first_harmonic(b))) thin(l, flat);
  return law;
}

/* ---------------------------------------------------------------- plan */

static int highest_point(const post_analysis *analysis, int b) {
  const double *a    = analysis->curve[b].amplitude;
  int           best = 0;
  for (int i = 1; i < analysis->response->branch[b].n_points; i++)
    if (a[i] > a[best]) best = i;
  return best;
}

/* Samples of all loops, by those at the highest point of every curve. */
static shb_status estimate(const post_analysis *analysis, const post_contact_plan *plan,
                           double *samples) {
  const mhb_response *r = analysis->response;
  *samples              = 0;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    loop              l;
    if (branch->kind != MHB_BRANCH_NONLINEAR || branch->n_points == 0) continue;
    SHB_TRY(loop_create(branch->n_harmonics, analysis->settings->tolerance, &l));
    for (int i = 0; i < plan->n; i++) {
      const int pair = plan->pair[i];
      follow(analysis, branch, highest_point(analysis, b), pair, plan->share[pair], &l);
      *samples += (double)l.corners * branch->n_points;
    }
    loop_free(&l);
  }
  return SHB_OK;
}

shb_status post_contact_points(const post_analysis *analysis, post_contact_plan *plan) {
  const mhb_response *r = analysis->response;
  double              samples;
  *plan = (post_contact_plan){.stride = 1};
  if (!analysis->settings || r->n_pairs < 1) return SHB_OK;
  plan->share = malloc((size_t)r->n_pairs * sizeof *plan->share);
  SHB_CHECK(plan->share, SHB_ERR_IO, "not enough memory for the report");
  mhb_recorded_shares(r, analysis->area, plan->share);
  choose_pairs(r, plan);
  SHB_TRY(estimate(analysis, plan, &samples));
  plan->stride = 1 + (int)(samples / BUDGET);
  return SHB_OK;
}

void post_contact_plan_free(post_contact_plan *plan) {
  free(plan->share);
  *plan = (post_contact_plan){0};
}

/* ---------------------------------------------------------------- writing */

void post_put_contacts(const post_analysis *analysis, const post_contact_plan *plan,
                       post_buffer *out) {
  post_put(out, "{\"all\":%d,\"names\":[", analysis->response->n_pairs);
  for (int i = 0; i < plan->n; i++) {
    char name[128];
    post_contact_name(analysis->response, plan->pair[i], " ", name);
    post_put(out, i ? "," : "");
    post_put_json(out, name);
  }
  post_put(out,
           "],\"full\":%d,\"signals\":[\"phase\",\"u\",\"w\",\"fu\",\"fw\",\"load\",\"state\"],"
           "\"loop\":[\"n\",\"u\",\"w\",\"fu\",\"fw\",\"load\",\"limit\",\"stuck\",\"slipping\","
           "\"open\",\"dissipation\"]}",
           FULL);
}

static int16_t part_of(double value, double scale) {
  return scale > 0 ? (int16_t)lround(FULL * value / scale) : 0;
}

/* Append the samples of a loop. */
static shb_status add_samples(const loop *l, const double scale[CURVES], sheet *s) {
  const size_t n = (size_t)l->corners;
  if (s->n + ROWS * n + 1 > s->capacity) { /* 1: to whole floats */
    const size_t capacity = 2 * s->capacity + ROWS * n + 1;
    int16_t     *data     = realloc(s->data, capacity * sizeof *data);
    SHB_CHECK(data, SHB_ERR_IO, "not enough memory for the report");
    s->data     = data;
    s->capacity = capacity;
  }
  int16_t *to = s->data + s->n;
  for (size_t i = 0; i < n; i++) {
    const int at           = l->corner[i];
    to[i]                  = part_of(l->sample[2 * at].phase, 1);
    to[(ROWS - 1) * n + i] = (int16_t)state_before(l, at);
    for (size_t c = 0; c < CURVES; c++)
      to[(c + 1) * n + i] = part_of(l->curve[(size_t)at * CURVES + c], scale[c]);
  }
  s->n += ROWS * n;
  return SHB_OK;
}

static shb_status add_loop(const post_analysis *analysis, const mhb_branch *b, int point, int pair,
                           const mhb_law *law, const loop *l, sheet *s) {
  const size_t  at    = (size_t)point * (size_t)analysis->response->n_pairs + (size_t)pair;
  const double *state = b->state + 3 * at;
  double        scale[CURVES];
  for (int c = 0; c < CURVES; c++) span(l, c, &scale[c]);
  post_put(&s->loops, "%s[%d", s->loops.length ? "," : "", l->corners);
  for (int c = 0; c < CURVES; c++) post_put(&s->loops, ",%.7g", scale[c]);
  post_put(&s->loops, ",%.7g,%.7g,%.7g,%.7g,%.7g]", law->mu * scale[4], state[0], state[1],
           state[2], state[1] > 0 ? b->dissipation[at] : 0);
  return add_samples(l, scale, s);
}

static bool is_taken(const mhb_branch *branch, const post_analysis *analysis, int b, int point,
                     int i, int stride) {
  if (i % stride == 0 || branch->special[point]) return true;
  for (int p = 0; p < analysis->curve[b].n_peaks; p++)
    if (analysis->curve[b].peak[p].point == point) return true;
  return false;
}

static shb_status add_points(const post_analysis *analysis, const post_contact_plan *plan, int b,
                             int n, const int *kept, loop *l, sheet *s) {
  const mhb_branch *branch = &analysis->response->branch[b];
  for (int i = 0; i < n; i++) {
    if (!is_taken(branch, analysis, b, kept[i], i, plan->stride)) continue;
    post_put(&s->at, "%s%d", s->at.length ? "," : "", i);
    for (int c = 0; c < plan->n; c++) {
      const int     pair = plan->pair[c];
      const mhb_law law  = follow(analysis, branch, kept[i], pair, plan->share[pair], l);
      SHB_TRY(add_loop(analysis, branch, kept[i], pair, &law, l, s));
    }
  }
  return SHB_OK;
}

shb_status post_put_contact_points(const post_analysis *analysis, const post_contact_plan *plan,
                                   int b, int n, const int *kept, post_buffer *out) {
  const mhb_branch *branch = &analysis->response->branch[b];
  loop              l;
  sheet             s = {0};
  if (plan->n == 0 || n == 0 || branch->kind != MHB_BRANCH_NONLINEAR) return SHB_OK;
  SHB_TRY(loop_create(branch->n_harmonics, analysis->settings->tolerance, &l));
  shb_status status = add_points(analysis, plan, b, n, kept, &l, &s);
  loop_free(&l);
  out->failed |= s.at.failed || s.loops.failed;
  if (status == SHB_OK && !out->failed) {
    post_put(out, ",\"contact\":{\"at\":[%s],\"loops\":[%s],\"data\":\"", s.at.text, s.loops.text);
    if (s.n % 2) s.data[s.n] = 0;
    post_put_base64(out, (s.n + 1) / 2, (const float *)(const void *)s.data);
    post_put(out, "\"}");
  }
  post_buffer_free(&s.at);
  post_buffer_free(&s.loops);
  free(s.data);
  return status;
}
