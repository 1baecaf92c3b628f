#include "postproc/report/contact_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/problem/interfaces.h"

/* Floats of all points together: 0.8 MB of the page. */
enum { BUDGET = 150000, LAW = 6 };

static const double LEAST_HARMONIC = 1e-5; /* of the largest coefficient of its axis */

/* ---------------------------------------------------------------- contacts and points */

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

static const double complex *motion_of(const mhb_response *r, const mhb_branch *branch, int point,
                                       int pair, int axis) {
  size_t row = ((size_t)point * (size_t)r->n_pairs + (size_t)pair) * 3 + (size_t)axis;
  return branch->motion + row * (size_t)(branch->n_harmonics + 1);
}

/* Highest harmonic that matters at a point. */
static int highest(const mhb_response *r, const post_contact_plan *plan, const mhb_branch *branch,
                   int point) {
  int top = 1;
  for (int i = 0; i < 3 * plan->n; i++) {
    const double complex *x    = motion_of(r, branch, point, plan->pair[i / 3], i % 3);
    double                most = 0;
    for (int k = 1; k <= branch->n_harmonics; k++) most = fmax(most, cabs(x[k]));
    for (int k = branch->n_harmonics; k > top; k--)
      if (cabs(x[k]) > LEAST_HARMONIC * most) top = k;
  }
  return top > branch->n_harmonics ? branch->n_harmonics : top;
}

static int floats(const post_contact_plan *plan, int harmonics) {
  return plan->n * (LAW + 3 * (2 * harmonics + 1));
}

post_contact_plan post_contact_points(const post_analysis *analysis) {
  const mhb_response *r    = analysis->response;
  post_contact_plan   plan = {.stride = 1};
  double              all  = 0;
  if (!analysis->settings || r->n_pairs < 1) return plan;
  choose_pairs(r, &plan);
  for (int b = 0; b < r->n_branches; b++)
    for (int p = 0; r->branch[b].kind == MHB_BRANCH_NONLINEAR && p < r->branch[b].n_points; p++)
      all += floats(&plan, highest(r, &plan, &r->branch[b], p));
  plan.stride = 1 + (int)(all / BUDGET);
  return plan;
}

/* ---------------------------------------------------------------- law */

/* Place of the response's interface in the settings. */
static int interface_of(const post_analysis *analysis, int pair) {
  const mhb_response *r = analysis->response;
  const mhb_settings *s = analysis->settings;
  if (r->n_interfaces < 2 || !r->interface) return s->lead;
  for (int i = 0; i < s->n_interfaces; i++)
    if (strcmp(s->interface[i].name, r->interface_name[r->interface[pair]]) == 0) return i;
  return s->lead;
}

/* Share of a pair in its interface: by area, if the modal file has areas. */
static double share_of(const post_analysis *analysis, int pair) {
  const mhb_response *r     = analysis->response;
  const double       *area  = analysis->area;
  double              total = 0;
  for (int a = 0; a < r->n_pairs; a++)
    if (!r->interface || r->interface[a] == r->interface[pair]) total += area ? area[a] : 1;
  return (area ? area[pair] : 1) / total;
}

static mhb_law law_of(const post_analysis *analysis, const mhb_branch *branch, int point,
                      int pair) {
  const mhb_response *r     = analysis->response;
  const mhb_settings *s     = analysis->settings;
  mhb_operating_point at    = mhb_operating_point_of(s);
  const mhb_parameter moves = r->parameter;
  at.n0                     = branch->n0[point];
  if (moves != MHB_IN_FREQUENCY) mhb_parameter_set(&at, moves, branch->value[point]);
  mhb_operating_point own = mhb_interface_operating_point(&at, s, interface_of(analysis, pair));
  if (r->n_interfaces > 1 && r->interface)
    own.n0 =
        branch->interface_n0[(size_t)point * (size_t)r->n_interfaces + (size_t)r->interface[pair]];
  return mhb_operating_point_law(&own, s->preload, share_of(analysis, pair));
}

/* ---------------------------------------------------------------- writing */

static float *put_point(const post_analysis *analysis, const post_contact_plan *plan,
                        const mhb_branch *branch, int point, int harmonics, float *to) {
  for (int i = 0; i < plan->n; i++) {
    const mhb_law law      = law_of(analysis, branch, point, plan->pair[i]);
    const double  all[LAW] = {law.mu, law.n0, law.kv, law.ku[0], law.ku[1], law.ku[2]};
    for (int j = 0; j < LAW; j++) *to++ = (float)all[j];
    for (int axis = 0; axis < 3; axis++) {
      const double complex *x = motion_of(analysis->response, branch, point, plan->pair[i], axis);
      *to++                   = (float)creal(x[0]);
      for (int k = 1; k <= harmonics; k++) {
        *to++ = (float)creal(x[k]);
        *to++ = (float)-cimag(x[k]);
      }
    }
  }
  return to;
}

static bool is_taken(const mhb_branch *branch, const post_analysis *analysis, int b, int point,
                     int i, int stride) {
  if (i % stride == 0 || branch->special[point]) return true;
  for (int p = 0; p < analysis->curve[b].n_peaks; p++)
    if (analysis->curve[b].peak[p].point == point) return true;
  return false;
}

void post_put_contact_names(const post_analysis *analysis, const post_contact_plan *plan,
                            post_buffer *out) {
  post_put(out, "[");
  for (int i = 0; i < plan->n; i++) {
    char name[128];
    post_contact_name(analysis->response, plan->pair[i], " ", name);
    post_put(out, i ? "," : "");
    post_put_json(out, name);
  }
  post_put(out, "]");
}

void post_put_contact_points(const post_analysis *analysis, const post_contact_plan *plan, int b,
                             int n, const int *kept, post_buffer *out) {
  const mhb_branch *branch = &analysis->response->branch[b];
  if (plan->n == 0 || n == 0 || branch->kind != MHB_BRANCH_NONLINEAR) return;
  float *data = malloc((size_t)n * (size_t)floats(plan, branch->n_harmonics) * sizeof *data);
  int   *top  = calloc((size_t)n, sizeof *top);
  float *end  = data;
  if (!data || !top) out->failed = true;
  post_put(out, ",\"contact\":{\"at\":[");
  for (int i = 0, any = 0; data && top && i < n; i++) {
    if (!is_taken(branch, analysis, b, kept[i], i, plan->stride)) continue;
    top[i] = highest(analysis->response, plan, branch, kept[i]);
    end    = put_point(analysis, plan, branch, kept[i], top[i], end);
    post_put(out, "%s%d", any++ ? "," : "", i);
  }
  post_put(out, "],\"k\":[");
  for (int i = 0, any = 0; data && top && i < n; i++)
    if (top[i] > 0) post_put(out, "%s%d", any++ ? "," : "", top[i]);
  post_put(out, "],\"data\":\"");
  if (data) post_put_base64(out, (size_t)(end - data), data);
  post_put(out, "\"}");
  free(data);
  free(top);
}
