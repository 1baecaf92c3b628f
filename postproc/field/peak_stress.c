#include "postproc/field/peak_stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

static const double APART = 0.05; /* of the greatest dimension */
/* Of a harmonic, relative to the largest of the node: left out; without samples of its own. */
static const double NEGLIGIBLE = 1e-6, SMALL = 1e-3;

enum { SAMPLES = 24, LEAST_SAMPLES = 64, REFINEMENTS = 24 };

/* The form whose square root is the von Mises stress. */
static double mises_product(const double a[POST_STRESSES], const double b[POST_STRESSES]) {
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    int next = (i + 1) % 3;
    sum += (a[i] - a[next]) * (b[i] - b[next]) / 2 + 3 * a[3 + i] * b[3 + i];
  }
  return sum;
}

static double square_of_mises(const double s[POST_STRESSES]) {
  return mises_product(s, s);
}

/* The principal stress of greatest modulus, with its sign: the deviator's eigenvalues are
 * 2 r cos(angle + 2 pi i/3) with the invariants of Smith 1961. */
static double leading_principal(const double s[POST_STRESSES]) {
  const double mean = (s[0] + s[1] + s[2]) / 3, r = sqrt(square_of_mises(s)) / 3;
  const double d[3] = {s[0] - mean, s[1] - mean, s[2] - mean};
  if (r == 0) return mean;
  double det = d[0] * (d[1] * d[2] - s[4] * s[4]) - s[3] * (s[3] * d[2] - s[4] * s[5]) +
               s[5] * (s[3] * s[4] - d[1] * s[5]);
  double angle = acos(fmax(-1, fmin(1, det / (2 * r * r * r)))) / 3;
  double high = mean + 2 * r * cos(angle), low = mean + 2 * r * cos(angle + SHB_TWO_PI / 3);
  return fabs(high) >= fabs(low) ? high : low;
}

double post_signed_mises(const double stress[POST_STRESSES]) {
  return copysign(sqrt(square_of_mises(stress)), leading_principal(stress));
}

double post_greatest_principal(const double stress[POST_STRESSES]) {
  return fabs(leading_principal(stress));
}

/* Harmonics of the stress at one node. */
typedef struct {
  const double *first;  /* of the node, harmonic 0, real */
  size_t        stride; /* from a real to an imaginary part, and on to the next harmonic */
  int           n;      /* harmonics that count */
  const int    *order;  /* [n] ascending */
  int           top;    /* the highest that matters for the number of samples */
} history;

static const double *real_part(const double *first, size_t stride, int k) {
  return first + 2 * (size_t)k * stride;
}

/* s += harmonic k at the instant of this cosine and sine. */
static void add_harmonic(const history *h, int k, double cosine, double sine,
                         double s[POST_STRESSES]) {
  const double *re = real_part(h->first, h->stride, k), *im = re + h->stride;
  for (int i = 0; i < POST_STRESSES; i++) s[i] += re[i] * cosine - im[i] * sine;
}

static void stress_at(const history *h, double t, double s[POST_STRESSES]) {
  memset(s, 0, POST_STRESSES * sizeof *s);
  for (int j = 0; j < h->n; j++) {
    double angle = SHB_TWO_PI * h->order[j] * t;
    add_harmonic(h, h->order[j], cos(angle), sin(angle), s);
  }
}

/* What is sought over the period: largest, smallest signed von Mises stress; largest principal. */
typedef enum { GREATEST, LEAST, PRINCIPAL, SOUGHT } quantity;

static double value_at(const history *h, quantity what, double t) {
  double s[POST_STRESSES];
  stress_at(h, t, s);
  if (what == PRINCIPAL) return post_greatest_principal(s);
  return what == GREATEST ? post_signed_mises(s) : -post_signed_mises(s);
}

/* Golden section for the maximum in (t - step, t + step). */
static double refine(const history *h, quantity what, double t, double step, double found) {
  const double golden = (sqrt(5) - 1) / 2;
  double       low = t - step, high = t + step;
  double       a = high - golden * (high - low), b = low + golden * (high - low);
  double       at_a = value_at(h, what, a), at_b = value_at(h, what, b);
  for (int i = 0; i < REFINEMENTS; i++) {
    found = fmax(found, fmax(at_a, at_b));
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a;
      a    = high - golden * (high - low);
      at_a = value_at(h, what, a);
    } else {
      low = a, a = b, at_a = at_b;
      b    = low + golden * (high - low);
      at_b = value_at(h, what, b);
    }
  }
  return found;
}

static void search_period(const history *h, double found[SOUGHT]) {
  const int    n          = SAMPLES * h->top > LEAST_SAMPLES ? SAMPLES * h->top : LEAST_SAMPLES;
  const double step       = 1. / n;
  double       at[SOUGHT] = {0}, cosine[n], sine[n];
  for (int i = 0; i < n; i++) {
    cosine[i] = cos(SHB_TWO_PI * i * step);
    sine[i]   = sin(SHB_TWO_PI * i * step);
  }
  for (int q = 0; q < SOUGHT; q++) found[q] = -INFINITY;
  for (int i = 0; i < n; i++) {
    double s[POST_STRESSES] = {0};
    for (int j = 0; j < h->n; j++) {
      int place = (int)((long)i * h->order[j] % n);
      add_harmonic(h, h->order[j], cosine[place], sine[place], s);
    }
    const double mises         = post_signed_mises(s),
                 value[SOUGHT] = {mises, -mises, post_greatest_principal(s)};
    for (int q = 0; q < SOUGHT; q++)
      if (value[q] > found[q]) found[q] = value[q], at[q] = i * step;
  }
  for (int q = 0; q < SOUGHT; q++) found[q] = refine(h, (quantity)q, at[q], step, found[q]);
}

/* A node with what it bears at most, or bears. */
typedef struct {
  int    node;
  double load; /* weight (amplitude + ratio max(mean, 0)), Pa; at first a bound of it */
} candidate;

static int descending(const void *a, const void *b) {
  const candidate *p = a, *q = b;
  return p->load != q->load ? (p->load < q->load ? 1 : -1)
                            : (p->node > q->node) - (p->node < q->node);
}

static double mean_of(const post_blade_field *f, const double *stress, int node) {
  double s[POST_STRESSES];
  for (int c = 0; c < POST_STRESSES; c++)
    s[c] = stress[POST_STRESSES * node + c] +
           (f->static_stress ? f->static_stress[POST_STRESSES * node + c] : 0);
  return post_signed_mises(s);
}

/* Greatest von Mises stress of a cos - b sin over a period: the square root of the larger
 * eigenvalue of the products of a and b. The von Mises stress is a norm, so a sum of harmonics
 * stays below the sum of theirs. */
static double bound_of(const double *a, size_t stride) {
  const double *b = a + stride, aa = square_of_mises(a), bb = square_of_mises(b);
  return sqrt((aa + bb) / 2 + hypot((aa - bb) / 2, mises_product(a, b)));
}

typedef struct {
  const post_blade_field *field;
  const double           *stress;
  int                     n_harmonics;
  const post_fatigue     *fatigue;
  double                  reference; /* Pa, the greatest endurance; 0 without fatigue */
  double                  apart;     /* m */
} search;

bool post_fatigue_given(const post_fatigue *fatigue) {
  for (int i = 0; fatigue->region && i < fatigue->n_regions; i++)
    if (fatigue->of[i].endurance > 0) return true;
  return !fatigue->region && fatigue->endurance > 0;
}

static double greatest_endurance(const post_fatigue *fatigue) {
  double most = 0;
  if (!fatigue->region) return fatigue->endurance;
  for (int i = 0; i < fatigue->n_regions; i++) most = fmax(most, fatigue->of[i].endurance);
  return most;
}

static post_goodman line_of(const search *s, int node) {
  const post_fatigue *f = s->fatigue;
  return f->region ? f->of[f->region[node]] : (post_goodman){f->endurance, f->ultimate};
}

/* Load of a node in terms of the reference: reference/load is its safety. A node without a line
 * bears none; without any line the load is the amplitude. */
static double load_from(const search *s, int node, double amplitude, double mean) {
  const post_goodman line = line_of(s, node);
  if (s->reference == 0) return amplitude;
  if (line.endurance == 0) return 0;
  return s->reference / line.endurance *
         (amplitude + line.endurance / line.ultimate * fmax(mean, 0));
}

static double bound_of_node(const search *s, int node) {
  const size_t stride = POST_STRESSES * (size_t)s->field->n_nodes;
  double       sum    = 0;
  for (int k = 1; k <= s->n_harmonics; k++)
    sum += bound_of(real_part(s->stress + POST_STRESSES * (size_t)node, stride, k), stride);
  return sum;
}

/* Largest amplitude of a component. */
static double size_of(const double *re, size_t stride) {
  double most = 0;
  for (int c = 0; c < POST_STRESSES; c++) most = fmax(most, hypot(re[c], re[stride + (size_t)c]));
  return most;
}

static post_worst_place evaluate(const search *s, int node) {
  const size_t stride = POST_STRESSES * (size_t)s->field->n_nodes;
  int          order[s->n_harmonics + 1];
  history      h = {s->stress + POST_STRESSES * (size_t)node, stride, 0, order, 1};
  double       found[SOUGHT], most = 0;
  for (int k = 1; k <= s->n_harmonics; k++)
    most = fmax(most, size_of(real_part(h.first, stride, k), stride));
  for (int k = 1; k <= s->n_harmonics; k++) {
    double size = size_of(real_part(h.first, stride, k), stride);
    if (size > NEGLIGIBLE * most) order[h.n++] = k;
    if (size > SMALL * most) h.top = k;
  }
  search_period(&h, found);
  return (post_worst_place){.node      = node,
                            .amplitude = (found[GREATEST] + found[LEAST]) / 2,
                            .principal = found[PRINCIPAL],
                            .mean      = mean_of(s->field, s->stress, node)};
}

static double load_of(const search *s, const post_worst_place *place) {
  return load_from(s, place->node, place->amplitude, place->mean);
}

static bool is_apart(const search *s, int a, int b) {
  const double *x = s->field->nodes + 3 * (size_t)a, *y = s->field->nodes + 3 * (size_t)b;
  return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]) >= s->apart;
}

static bool is_free(const search *s, int node, int n, const post_worst_place *place) {
  for (int i = 0; i < n; i++)
    if (!is_apart(s, node, place[i].node)) return false;
  return true;
}

/* Best first: the next bound and the nodes evaluated compete. A node that comes first with its load
 * is the worst of all that are left, so it is a place. Returns the number of places. */
static int find(const search *s, const candidate *bound, candidate *pending,
                post_worst_place place[POST_PLACES]) {
  int next = 0, waiting = 0, found = 0;
  while (found < POST_PLACES && (next < s->field->n_nodes || waiting > 0)) {
    int first = 0;
    for (int i = 1; i < waiting; i++)
      if (descending(&pending[i], &pending[first]) < 0) first = i;
    if (next < s->field->n_nodes && (waiting == 0 || bound[next].load > pending[first].load)) {
      const int node = bound[next++].node;
      if (!is_free(s, node, found, place)) continue;
      post_worst_place at = evaluate(s, node);
      pending[waiting++]  = (candidate){node, load_of(s, &at)};
      continue;
    }
    const int node = pending[first].node;
    pending[first] = pending[--waiting];
    if (is_free(s, node, found, place)) place[found++] = evaluate(s, node);
  }
  return found;
}

static double greatest_dimension(const post_blade_field *f) {
  double most = 0;
  for (int d = 0; d < 3; d++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < f->n_nodes; i++) {
      low  = fmin(low, f->nodes[3 * i + d]);
      high = fmax(high, f->nodes[3 * i + d]);
    }
    most = fmax(most, high - low);
  }
  return most;
}

shb_status post_peak_stress(const post_blade_field *field, int n_harmonics, const double *stress,
                            const post_fatigue *fatigue, post_worst_place place[POST_PLACES],
                            int *n) {
  const search s       = {field,
                          stress,
                          n_harmonics,
                          fatigue,
                          greatest_endurance(fatigue),
                          APART * greatest_dimension(field)};
  const size_t nodes   = (size_t)field->n_nodes;
  candidate   *bound   = malloc(nodes * sizeof *bound + 1);
  candidate   *pending = malloc(nodes * sizeof *pending + 1);
  if (!bound || !pending) {
    free(bound);
    free(pending);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the worst places of %zu nodes", nodes);
  }
  for (int i = 0; i < field->n_nodes; i++)
    bound[i] = (candidate){i, load_from(&s, i, bound_of_node(&s, i), mean_of(field, stress, i))};
  qsort(bound, nodes, sizeof *bound, descending);
  *n = find(&s, bound, pending, place);
  for (int i = 0; i < *n; i++)
    place[i].safety =
        line_of(&s, place[i].node).endurance > 0 ? s.reference / load_of(&s, &place[i]) : NAN;
  free(bound);
  free(pending);
  return SHB_OK;
}

shb_status post_worst_places(const post_blade_field *field, const mhb_branch *branch, int kept,
                             const post_fatigue *fatigue, post_worst_place place[POST_PLACES],
                             int *n) {
  const size_t rows   = 2 * ((size_t)branch->n_harmonics + 1);
  double      *stress = malloc(rows * POST_STRESSES * (size_t)field->n_nodes * sizeof *stress + 1);
  SHB_CHECK(stress, SHB_ERR_IO, "out of memory for the stress of %d nodes", field->n_nodes);
  shb_status status = post_blade_stress(field, branch, kept, stress);
  if (status == SHB_OK)
    status = post_peak_stress(field, post_blade_harmonics(branch, field->n_modes, kept), stress,
                              fatigue, place, n);
  free(stress);
  return status;
}
