#include "tests/support/fixture.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

const char fixture_hostile[] =
    "name: <b>\"hostile\" & 'quoted'</b>\n# </script><script>alert(1)</script> <!-- ]]>\n"
    "# µm, ω², 叶片, \xf0\x9f\x94\xa7\n# not UTF-8: \xff\xfe\xc3(\n\tn0: 100 N\r\n# \x01\x1b[31m\n";

double fixture_frequency(const fixture_curve *c, double theta) {
  double a = c->top * sin(theta);
  return c->centre + c->bend * a * a - c->width / tan(theta);
}

double fixture_amplitude(const fixture_curve *c, double theta) {
  return c->top * sin(theta);
}

static double slope(const fixture_curve *c, double theta) {
  return 2 * c->bend * c->top * c->top * pow(sin(theta), 3) * cos(theta) + c->width;
}

double fixture_fold(const fixture_curve *c, double lo, double hi) {
  bool rising = slope(c, lo) < 0;
  for (int i = 0; i < 200; i++) {
    double mid = (lo + hi) / 2;
    if ((slope(c, mid) < 0) == rising)
      lo = mid;
    else
      hi = mid;
  }
  return (lo + hi) / 2;
}

/* Stiffness and friction damping between open (x = -inf) and stuck (x = inf), with x = ln(n0 / 100
 * N). */
static fixture_curve curve_at(double x, double scale) {
  double share = 1 / (1 + exp(-1.3 * x)), friction = 5.5 * share * (1 - share);
  double width = 0.35 + 1.9 * friction;
  double top   = 4.4e-4 * scale / width * (1 - 0.25 * share);
  double bend  = top > 0 ? -(3.2 * friction + 1.1 * share * (1 - share)) / (top * top) * 1.35 : 0;
  return (fixture_curve){top, 104 + 22 * share, bend, width};
}

static void fill_point(const mhb_response *r, mhb_branch *b, int p, double a, double theta) {
  size_t m1 = (size_t)r->n_harmonics + 1, i = (size_t)p;
  for (int place = 0; place < r->n_probes + r->n_pairs; place++) {
    bool   probe         = place < r->n_probes;
    size_t n             = (size_t)(probe ? r->n_probes : r->n_pairs),
           at            = (size_t)(probe ? place : place - r->n_probes);
    double complex *x    = (probe ? b->probe : b->motion) + (i * n + at) * 3 * m1;
    double          size = a * (probe ? 1.0 - 0.35 * (double)at : 0.6 / (1 + 0.2 * (double)at));
    for (int axis = 0; axis < 3; axis++)
      for (size_t k = 0; k < m1; k++) {
        double share             = k == 1 ? 1
                                          : (k == 0 ? 0.02 : 0.12 / (double)(k * k * k)) *
                                    (b->kind == MHB_BRANCH_NONLINEAR);
        double turn              = -(double)k * theta + 0.4 * axis;
        x[(size_t)axis * m1 + k] = size * share *
                                   (axis == 0   ? 0.9
                                    : axis == 1 ? 0.4
                                                : 0.17) *
                                   (cos(turn) + I * (k ? sin(turn) : 0));
      }
  }
}

static void fill_contact(const mhb_response *r, mhb_branch *b, int p, double level, double a) {
  size_t n = (size_t)r->n_pairs, i = (size_t)p;
  for (size_t c = 0; c < n; c++) {
    double *state = b->state + (i * n + c) * 3;
    double  slip  = b->kind == MHB_BRANCH_NONLINEAR ? level * level / (1 + level * level) : 0;
    double  open  = b->kind == MHB_BRANCH_OPEN ? 1 : slip * 0.35 * level / (2 + level);
    state[1]      = slip - open * (b->kind == MHB_BRANCH_NONLINEAR);
    state[2]      = open;
    state[0]      = 1 - state[1] - state[2];
    b->dissipation[i * n + c] = state[1] * 40 * a;
  }
}

const double fixture_range[MHB_N_PARAMETERS][2] = {{92, 138}, {-250, 1000}, {.05, 10},
                                                   {0, .6},   {5e4, 5e6},   {1e5, 2e6}};

/* Maps the place on the curve to the range of the continuation parameter. A limit that does not
 * depend on the parameter is constant. */
static void place_point(const fixture_options *o, mhb_branch *b, int p, double top, double *a) {
  const double *range = fixture_range[o->parameter];
  bool          limit = b->kind != MHB_BRANCH_NONLINEAR;
  double        share = fmin(fmax((b->frequency[p] - 92) / (138 - 92), 0), 1);
  b->value[p]         = b->frequency[p];
  if (o->parameter == MHB_IN_FREQUENCY) return;
  b->value[p]     = range[0] + share * (range[1] - range[0]);
  b->frequency[p] = 240;
  if (o->parameter == MHB_IN_N0) b->n0[p] = b->value[p];
  if (limit && (o->parameter == MHB_IN_N0 || o->parameter == MHB_IN_MU)) *a = top / 2;
}

static shb_status add_branch(mhb_response *r, mhb_branch_kind kind, double n0,
                             const fixture_options *o, int n) {
  const int at = mhb_response_branch(r, kind);
  double x = kind == MHB_BRANCH_OPEN ? -40 : kind == MHB_BRANCH_STUCK ? 40 : log(fmax(n0, 1) / 100);
  fixture_curve c = curve_at(x, o->scale);
  if (kind != MHB_BRANCH_NONLINEAR) c.bend = 0;
  double from = atan2(c.width, c.centre - 92), to = SHB_PI - atan2(c.width, 138 - c.centre);
  for (int i = 0; i < n; i++) {
    double theta =
        n > 1 && o->n_points > 1 ? from + (to - from) * i / (o->n_points - 1) : SHB_PI / 2;
    const int   p    = mhb_response_point(r, at);
    mhb_branch *b    = &r->branch[at];
    double      a    = fixture_amplitude(&c, theta);
    b->frequency[p]  = fixture_frequency(&c, theta);
    b->n0[p]         = kind == MHB_BRANCH_NONLINEAR ? n0 : 0;
    b->stable[p]     = kind != MHB_BRANCH_NONLINEAR || slope(&c, theta) > 0;
    b->iterations[p] = kind == MHB_BRANCH_NONLINEAR ? 3 + i % 3 : 0;
    b->seconds[p]    = 0.0017;
    place_point(o, b, p, c.top, &a);
    fill_point(r, b, p, a, theta);
    fill_contact(r, b, p, 2.2 * a / (1e-5 + 1.1e-6 * fmax(n0, 0)), a);
    if (kind != MHB_BRANCH_NONLINEAR) continue;
    b->error_newton[p]     = 2e-12;
    b->error_truncation[p] = 3e-4 * (1 + sin(3 * theta)) * (n0 > 500 ? 8 : 1);
    b->error_sampling[p]   = 4e-9;
    b->error_modal[p]      = 6e-6;
  }
  r->branch[at].complete = n == o->n_points;
  r->branch[at].reason   = strdup(
        n == o->n_points ? "end of range" : "no convergence: step below 1e-6 <after 12 halvings>");
  return SHB_OK;
}

static shb_status fill_modes(mhb_response *r) {
  r->n_modes        = 8;
  r->mode_frequency = calloc(8, sizeof(double));
  r->mode_damping   = calloc(8, sizeof(double));
  r->eigen_residual = calloc(8, sizeof(double));
  SHB_CHECK(r->mode_frequency && r->mode_damping && r->eigen_residual, SHB_ERR_IO, "no memory");
  for (int i = 0; i < 8; i++) {
    r->mode_frequency[i] = 103.62 * (1 + 1.9 * i + 0.21 * i * i);
    r->mode_damping[i]   = 0.002;
    r->eigen_residual[i] = 3e-13 * (i + 1);
  }
  return SHB_OK;
}

static shb_status fill_all(mhb_response *r, const fixture_options *o) {
  static const char *const name[] = {"tip", "shroud <edge> & \"co\"", "mid", "root"};
  for (int q = 0; q < r->n_probes; q++) r->probe_name[q] = strdup(name[q % 4]);
  r->engine_order = 5;
  r->blades       = 40;
  r->psi          = 35 * SHB_PI / 180;
  SHB_TRY(fill_modes(r));
  if (o->limits) SHB_TRY(add_branch(r, MHB_BRANCH_OPEN, 0, o, o->n_points));
  if (o->limits) SHB_TRY(add_branch(r, MHB_BRANCH_STUCK, 0, o, o->n_points));
  for (int i = 0; i < o->n_preloads; i++) {
    bool cut = o->incomplete && i == o->n_preloads - 1;
    SHB_TRY(add_branch(r, MHB_BRANCH_NONLINEAR, o->n0[i], o, cut ? o->n_points / 2 : o->n_points));
  }
  return SHB_OK;
}

mhb_response *fixture_response(const fixture_options *o) {
  mhb_response *r = mhb_response_create(o->n_pairs, o->n_probes, o->n_harmonics);
  if (r) r->parameter = o->parameter;
  if (r && fill_all(r, o) == SHB_OK) return r;
  mhb_response_destroy(r);
  return NULL;
}

fixture_options fixture_usual(void) {
  static const double n0[] = {10, 25, 50, 100, 200, 500, 1000};
  return (fixture_options){7, 240, n0, 2, 1, 3, true, true, 1, MHB_IN_FREQUENCY};
}
