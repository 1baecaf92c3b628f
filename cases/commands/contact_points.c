#include "cases/commands/contact_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/balance/spatial_error.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/record.h"

/* Points sampled of each curve, and the share of them that must keep the tolerance. */
enum { SAMPLES = 12 };
static const double KEPT = 0.9;

/* The error falls at least as 1/n. Where it is above so many tolerances the next number of patches
 * but one is tried. */
static const double FAR = 8;

/* Harmonics and accuracy of curves in outline. */
enum { HARMONICS = 5 };
static const double ACCURACY = 1e-6;

void contact_points_free(contact_points *p) {
  if (!p) return;
  if (p->disc.n > 0)
    modal_nodal_diameters_free(&p->disc);
  else
    modal_model_free(&p->other);
  modal_joining_free(&p->joining);
  free(p);
}

static shb_status create(contact_points **out) {
  contact_points *p = *out = calloc(1, sizeof *p);
  SHB_CHECK(p, SHB_ERR_IO, "out of memory");
  p->pairs    = (mhb_other_pairs){.model = &p->other, .joining = &p->joining};
  p->estimate = NAN;
  return SHB_OK;
}

/* The other model is that of a disc. */
static void take_disc(contact_points *p, modal_nodal_diameters disc) {
  p->disc                  = disc;
  p->other                 = p->disc.model[0];
  p->pairs.nodal_diameters = &p->disc;
}

shb_status contact_points_join(modal_model *model, modal_nodal_diameters *disc, int patches,
                               contact_points **out) {
  modal_model           joined;
  modal_nodal_diameters joined_disc;
  *out = NULL;
  if (patches == model->n_pairs) return SHB_OK;
  SHB_TRY(create(out));
  shb_status status = modal_joining_create(model, patches, &(*out)->joining);
  if (status != SHB_OK) {
    contact_points_free(*out);
    *out = NULL;
    return status;
  }
  (*out)->pairs.finer = true;
  if (disc) {
    modal_join_diameters(disc, &(*out)->joining, &joined_disc);
    take_disc(*out, *disc);
    *disc  = joined_disc;
    *model = disc->model[0];
    return SHB_OK;
  }
  modal_join(model, &(*out)->joining, &joined);
  (*out)->other = *model;
  *model        = joined;
  return SHB_OK;
}

shb_status contact_points_halve(const modal_model *model, const modal_nodal_diameters *disc,
                                contact_points **out) {
  const int             interfaces = model->n_interfaces > 1 ? model->n_interfaces : 1;
  modal_nodal_diameters joined;
  *out = NULL;
  if (modal_joinable(model) < 2 * interfaces) return SHB_OK;
  SHB_TRY(create(out));
  shb_status status = modal_joining_create(model, model->n_pairs / 2, &(*out)->joining);
  if (status != SHB_OK) {
    contact_points_free(*out);
    *out = NULL;
    return status;
  }
  if (disc) {
    modal_join_diameters(disc, &(*out)->joining, &joined);
    take_disc(*out, joined);
  } else {
    modal_join(model, &(*out)->joining, &(*out)->other);
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- choice */

/* Curves in outline: few harmonics, neither stability nor searches. */
static mhb_settings outline_of(const mhb_settings *asked) {
  mhb_settings s     = *asked;
  s.stability        = MHB_STABILITY_NEVER;
  s.lasting          = MHB_LASTING_NEVER;
  s.search.starts    = 0;
  s.flips            = false;
  s.resume           = false;
  s.outline          = true;
  s.motion_tolerance = 0;
  s.tolerance        = fmax(s.tolerance, ACCURACY);
  if (asked->harmonics == 0 || asked->motion_tolerance > 0)
    s.harmonics = HARMONICS * s.subharmonics;
  return s;
}

/* The estimates of all curves. */
typedef struct {
  mhb_balance       *balance;
  mhb_spatial_error *error;
  double            *x, *r; /* [balance->n] */
  double            *estimate;
  int                n;
} sampler;

static bool moves(const mhb_response *r, const mhb_branch *b, int point) {
  for (int a = 0; a < r->n_pairs; a++) {
    const double *share = b->state + 3 * ((size_t)point * (size_t)r->n_pairs + (size_t)a);
    if (share[MHB_STICK] < 1 && share[MHB_SEPARATE] < 1) return true;
  }
  return false;
}

/* The balance at a recorded point, whose spatial error is added to the estimates. */
static void sample(sampler *s, const mhb_settings *settings, const mhb_branch *branch, int point) {
  mhb_balance        *b  = s->balance;
  mhb_operating_point at = mhb_operating_point_of(settings);
  at.omega               = SHB_TWO_PI * branch->frequency[point];
  at.n0                  = branch->n0[point];
  if (settings->parameter != MHB_IN_FREQUENCY)
    mhb_parameter_set(&at, settings->parameter,
                      mhb_parameter_value(settings->parameter, branch->value[point]));
  mhb_balance_set_operating_point(b, &at);
  mhb_recorded_motion(branch, point, b, s->x);
  mhb_balance_evaluate(b, s->x, at.omega, s->r, NULL, NULL);
  double error = mhb_spatial_error_at(s->error, s->x);
  if (error >= 0) s->estimate[s->n++] = error;
}

static void sample_branch(sampler *s, const mhb_settings *settings, const mhb_response *r,
                          const mhb_branch *branch) {
  int found = 0, seen = 0, taken = 0;
  for (int p = 0; p < branch->n_points; p++) found += moves(r, branch, p);
  for (int p = 0; p < branch->n_points; p++) {
    if (!moves(r, branch, p)) continue;
    bool due = (long)(2 * seen++ + 1) * SAMPLES >= (long)(2 * taken + 1) * found;
    if (!due || taken == SAMPLES) continue;
    taken++;
    sample(s, settings, branch, p);
  }
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* *error <- what nine of ten estimates keep; 0 without any: nothing moves. */
static shb_status estimate_all(sampler *s, const mhb_settings *settings, const mhb_response *r,
                               double *error) {
  s->x        = calloc((size_t)s->balance->n, sizeof *s->x);
  s->r        = calloc((size_t)s->balance->n, sizeof *s->r);
  s->estimate = calloc((size_t)r->n_branches * SAMPLES + 1, sizeof *s->estimate);
  SHB_CHECK(s->x && s->r && s->estimate, SHB_ERR_IO, "out of memory");
  for (int b = 0; b < r->n_branches; b++)
    if (r->branch[b].kind == MHB_BRANCH_NONLINEAR) sample_branch(s, settings, r, &r->branch[b]);
  qsort(s->estimate, (size_t)s->n, sizeof *s->estimate, ascending);
  *error = s->n > 0 ? s->estimate[(int)floor(KEPT * (s->n - 1))] : 0;
  return SHB_OK;
}

/* *error <- spatial error of a joined model; settings name its pairs. */
static shb_status judge(const modal_model *model, const mhb_settings *settings, double *error) {
  shb_progress  quiet    = shb_progress_start("mhb", true, false);
  mhb_response *response = NULL;
  sampler       s        = {0};
  shb_status    status   = mhb_forced_response(model, settings, NULL, NULL, &quiet, &response);
  if (status == SHB_NOT_CONVERGED && response) status = SHB_OK; /* a gap does no harm here */
  if (status == SHB_OK) status = mhb_balance_create(model, settings, &s.balance);
  if (status == SHB_OK) status = mhb_spatial_error_create(s.balance, &s.error);
  if (status == SHB_OK) status = estimate_all(&s, settings, response, error);
  mhb_spatial_error_destroy(s.error);
  mhb_balance_destroy(s.balance);
  mhb_response_destroy(response);
  free(s.x);
  free(s.r);
  free(s.estimate);
  return status;
}

/* Back to all pairs. */
static void undo(modal_model *model, modal_nodal_diameters *disc, contact_points *points) {
  if (disc) {
    modal_nodal_diameters_free(disc);
    *disc        = points->disc;
    *model       = disc->model[0];
    points->disc = (modal_nodal_diameters){0};
  } else {
    modal_model_free(model);
    *model = points->other;
  }
  points->other = (modal_model){0};
  contact_points_free(points);
}

shb_status contact_points_choose(modal_model *model, modal_nodal_diameters *disc,
                                 const mhb_settings *asked, double tolerance,
                                 contact_points **out) {
  mhb_settings s   = outline_of(asked);
  const int    all = model->n_pairs, faces = model->n_interfaces > 1 ? model->n_interfaces : 1;
  s.nodal_diameters = disc;
  *out              = NULL;
  for (int patches = faces; patches < all;) {
    double error = 0;
    SHB_TRY(contact_points_join(model, disc, patches, out));
    const bool flat = (*out)->joining.spread <= MODAL_FLAT;
    s.other_pairs   = &(*out)->pairs;
    if (flat) SHB_TRY(judge(model, &s, &error));
    (*out)->estimate = error;
    if (flat && error <= tolerance) return SHB_OK;
    undo(model, disc, *out);
    *out = NULL;
    patches *= error > FAR * tolerance ? 4 : 2;
  }
  return SHB_OK;
}
