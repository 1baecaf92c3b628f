#include "cases/peaks/design_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/peaks/exact_peak.h"
#include "cases/peaks/worst_blade.h"
#include "mhb/branches/forced_response.h"

/* Harmonics of the sweeps, tried in turn until the peak can be solved beside the curve. 0: those of
 * the case. On z_notch_blade the peaks of three harmonics are within 8 % of those of 31. Sweeps
 * with more than LAST_COARSE cover the places in doubt alone. With harmonics chosen at each point
 * one design with a gap took minutes. The sweep with 31 beside its doubtful places takes 25 s. */
static const int sweeps[] = {3, 7, 15, 31, 0};
enum { N_SWEEPS = sizeof sweeps / sizeof *sweeps, LAST_COARSE = 15, MANY = 1000 };

/* A point of the last coarse curve that could not be solved again, and is higher than the peak by
 * this, leaves a doubt. With 15 harmonics curves are within 1 % of those with 31. */
static const double HIGHER = 0.02;

/* Points of a curve in these sweeps. Ten random designs of z_notch_blade have 133 to 3751 with up
 * to 15 harmonics; the hardest has 6523 with 31. One that goes on beyond this is told as cut
 * short. */
enum { MOST_POINTS = 8000 };

/* Tolerance of the contact law on these curves; the peak itself is solved with that of the case.
 * On 200 contacts of z_notch_blade the sweeps cost 0.06 s each, with 1e-4 0.09 s. */
static const double OUTLINE = 1e-3;

typedef struct {
  const case_file    *file;
  const case_model   *model;
  int                 n;
  const study_output *output;
  study_design       *design;
  mhb_response       *response;
  peak_field         *field; /* NULL: not wanted */
  const solved_peak  *from;  /* of a neighbour; NULL: none */
  solved_peak        *found; /* NULL: not asked for */
} job;

static bool wants(const job *j, study_quantity quantity) {
  for (int i = 0; i < j->n; i++)
    if (j->output[i].quantity == quantity) return true;
  return false;
}

static void fail(study_design *design, const char *reason) {
  design->state = STUDY_FAILED;
  study_design_set_reason(design, reason);
}

/* A sweep with a number of harmonics, without multipliers; 0: with those of the case.
 *   range  in   Hz; NULL: that of the case
 *   out    out  in the place of the former one */
static shb_status sweep(const job *j, int harmonics, const double *range, mhb_response **out) {
  mhb_settings few = j->model->settings;
  few.stability    = MHB_STABILITY_NEVER;
  few.lasting      = MHB_LASTING_NEVER;
  few.flips        = false;
  few.resume       = false;
  few.save         = (mhb_save_settings){MHB_SAVE_LISTED, 0, {0}}; /* nothing */
  if (harmonics > 0) {
    few.motion_tolerance = 0;
    few.harmonics        = harmonics * few.subharmonics;
    few.outline          = true;
    few.max_points       = few.max_points < MOST_POINTS ? few.max_points : MOST_POINTS;
    few.tolerance        = fmax(few.tolerance, OUTLINE);
  }
  if (range) memcpy(few.frequency, range, sizeof few.frequency);
  mhb_response_destroy(*out);
  *out = NULL;
  return mhb_forced_response(&j->model->model, &few, NULL, NULL, NULL, out);
}

/* Whether a sweep with so few harmonics is less than what the case asks for. */
static bool is_coarse(const mhb_settings *s, int harmonics) {
  return s->motion_tolerance > 0 || s->harmonics > harmonics * s->subharmonics;
}

int design_run_harmonics(const mhb_settings *s) {
  return is_coarse(s, sweeps[0]) ? sweeps[0] * s->subharmonics : s->harmonics;
}

/* ---------------------------------------------------------------- outputs */

static void put(job *j, int i, double value, double error) {
  j->design->value[i] = value;
  j->design->error[i] = error;
}

/* The numbers at the highest peak of the first output. */
static void put_peak(job *j, const exact_peak *peak) {
  for (int i = 0; i < j->n; i++) switch (j->output[i].quantity) {
      case STUDY_PEAK:
        put(j, i, peak->amplitude, peak->amplitude_error);
        break;
      case STUDY_FREQUENCY:
        put(j, i, peak->frequency, peak->frequency_error);
        break;
      case STUDY_PEAK_TO_PEAK:
        put(j, i, peak->peak_to_peak, peak->peak_to_peak_error);
        break;
      case STUDY_RSS:
        put(j, i, peak->rss, peak->rss_error);
        break;
      case STUDY_DISSIPATION:
        put(j, i, peak->dissipation, peak->dissipation_error);
        break;
      case STUDY_STABLE:
        put(j, i, peak->stable < 0 ? NAN : peak->stable, NAN);
        break;
      case STUDY_STRESS:
      case STUDY_SAFETY:
      case STUDY_GAUGE:
        put(j, i, peak->field[i], peak->field_error[i]);
        break;
      default:
        break;
    }
}

static shb_status find_peak(const job *j, mhb_response *curves, post_output output,
                            exact_peak_asked asked, exact_peak *peak) {
  return exact_peak_find(&j->model->model, &j->model->settings, curves, output, asked, peak);
}

static void put_derivatives(job *j, const exact_peak *peak) {
  int n = study_derivatives(j->n, j->output);
  for (int i = 0; i < n && peak->by.kind != MHB_PEAK_UNJUDGED; i++)
    j->design->derivative[i] =
        peak->by.by[i] / (i == MHB_PEAK_BY_DAMPING ? study_damping(j->file) : 1);
}

/* The peaks of other probes than the first output. */
static shb_status put_probes(job *j, post_output first, int harmonics, const exact_peak *peak) {
  for (int i = 0; i < j->n; i++) {
    const study_output *o     = &j->output[i];
    post_output         probe = {POST_PLACE_PROBE, o->index, POST_WHOLE};
    exact_peak          own   = *peak;
    if (o->quantity != STUDY_PROBE || o->index >= j->response->n_probes) continue;
    if (first.place != probe.place || first.index != probe.index)
      SHB_TRY(find_peak(j, j->response, probe, (exact_peak_asked){.harmonics = harmonics}, &own));
    put(j, i, own.amplitude, own.amplitude_error);
  }
  return SHB_OK;
}

static void put_modes(job *j) {
  for (int i = 0; i < j->n; i++) {
    const study_output *o = &j->output[i];
    if (o->quantity == STUDY_MODE_FREQUENCY && o->index < j->response->n_modes)
      put(j, i, j->response->mode_frequency[o->index], NAN);
  }
}

/* ---------------------------------------------------------------- curve and reason */

/* Whether a point of a branch must stay when a curve is thinned: ends, peaks, folds. */
static bool stays(const mhb_branch *b, int i) {
  return i == 0 || i == b->n_points - 1 || b->special[i] == MHB_PEAK || b->special[i] == MHB_FOLD;
}

static bool is_kept(const mhb_branch *b, int i, int every) {
  return b->kind == MHB_BRANCH_NONLINEAR && (i % every == 0 || stays(b, i));
}

static int count_points(const mhb_response *r, int every) {
  int n = 0;
  for (int k = 0; k < r->n_branches; k++)
    for (int i = 0; i < r->branch[k].n_points; i++) n += is_kept(&r->branch[k], i, every);
  return n;
}

static shb_status thin_curves(job *j, post_output output) {
  const mhb_response *r     = j->response;
  study_curve        *curve = &j->design->curve;
  int                 every = 1, at = 0;
  while (every < 4096 && count_points(r, every) > STUDY_CURVE) every++;
  int n = count_points(r, every);
  SHB_TRY(study_curve_take(curve, n < STUDY_CURVE ? n : STUDY_CURVE));
  for (int k = 0; k < r->n_branches; k++)
    for (int i = 0; i < r->branch[k].n_points && at < curve->n; i++) {
      const mhb_branch *b = &r->branch[k];
      if (!is_kept(b, i, every)) continue;
      curve->branch[at]    = k;
      curve->frequency[at] = b->frequency[i];
      curve->amplitude[at] = r->ring ? worst_blade_amplitude(r, b, i)
                                     : post_amplitude(r, b, i, output, post_first_harmonic(b));
      curve->stable[at++]  = b->stable[i];
    }
  return SHB_OK;
}

/* Whether a peak was solved with enough harmonics. Of a case with a fixed number the error of these
 * is not known. */
static bool is_known(const job *j, const exact_peak *peak) {
  bool fixed = !(j->model->settings.motion_tolerance > 0);
  return peak->found && peak->exact && (fixed || isfinite(peak->amplitude_error));
}

/* The first main curve that does not cover the range; NULL: all do. */
static const mhb_branch *cut_short(const mhb_response *r) {
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    if (b->kind == MHB_BRANCH_NONLINEAR && b->main == k && !b->complete) return b;
  }
  return NULL;
}

/* A peak without friction has no bound if a mode has no damping. */
static bool is_of_grid(const job *j, const exact_peak *peak) {
  const modal_model *m    = &j->model->model;
  bool               none = false;
  for (int i = 0; i < m->n_modes; i++) none = none || m->damping_ratio[i] <= 0;
  return none && !peak->edge && peak->dissipation == 0;
}

/* Why the highest peak may be another one, or have another height. False: text stays. */
static bool put_doubt(const job *j, const exact_peak *peak, size_t size, char *text) {
  const double tolerance = j->model->settings.motion_tolerance;
  const double error     = peak->amplitude_error / peak->amplitude;
  if (is_of_grid(j, peak))
    snprintf(text, size,
             "a mode has no damping and nothing slips at the peak: its height is that of the grid");
  else if (peak->exact && peak->doubt)
    snprintf(text, size, "a part of the curve that may be higher could not be solved again");
  else if (!peak->exact)
    snprintf(text, size, "the peak could not be solved again with more harmonics");
  else if (!is_known(j, peak))
    snprintf(text, size, "the peak is another one with more harmonics");
  else if (tolerance > 0 && error > tolerance)
    snprintf(text, size, "the peak's estimated error of %.2g is above mhb.tolerance", error);
  else
    return false;
  return true;
}

/* State and reason: the peak's quality, and the first curve that did not cover the range. */
static void judge(job *j, const exact_peak *peak) {
  char              text[512] = "";
  const mhb_branch *cut       = cut_short(j->response);
  bool              doubtful  = cut && !(peak->walked && is_known(j, peak));
  if (cut)
    snprintf(text, sizeof text, "a curve does not cover mhb.frequency: %s",
             cut->reason ? cut->reason : "no reason is known");
  else if (peak->edge)
    snprintf(text, sizeof text,
             "the highest point is at an end of mhb.frequency; the peak may lie beyond");
  if (!doubtful) doubtful = put_doubt(j, peak, sizeof text, text);
  j->design->state = doubtful ? STUDY_NOT_CONVERGED : STUDY_DONE;
  study_design_set_reason(j->design, text);
}

/* Fill in all outputs from the response and the peak of its first output. */
static shb_status fill(job *j, post_output first, int harmonics, const exact_peak *peak) {
  if (!peak->found) {
    fail(j->design, "the balance has no solution in mhb.frequency");
    return SHB_OK;
  }
  put_peak(j, peak);
  put_derivatives(j, peak);
  put_modes(j);
  SHB_TRY(put_probes(j, first, harmonics, peak));
  SHB_TRY(thin_curves(j, first));
  judge(j, peak);
  return SHB_OK;
}

/* Whether the last sweep covers the range, or there was none. */
static bool is_covered(const job *j) {
  return !j->response || !cut_short(j->response);
}

/* Whether no sweep with more harmonics is needed. */
static bool is_settled(const job *j, const exact_peak *peak) {
  return is_known(j, peak) && !peak->doubt && (peak->walked || is_covered(j));
}

/* The search of sweep_for. */
typedef struct {
  exact_peak_asked asked;
  post_output      first;
  exact_peak       peak;   /* the best so far */
  solved_peak      latest; /* of the last sweep */
  solved_peak     *walked; /* the neighbour's peak, here */
  double           missed; /* m, by the last coarse curve */
} peak_search;

/* Whether a sweep is of use. The case's own takes too long where harmonics are chosen at each
 * point, unless its load has more than any other may have. */
static bool is_of_use(const job *j, int harmonics) {
  if (harmonics > LAST_COARSE || harmonics == 0) {
    if (!is_covered(j)) return false;
    if (harmonics == 0 && j->response && j->model->settings.motion_tolerance > 0) return false;
  }
  return harmonics == 0 || is_coarse(&j->model->settings, harmonics);
}

/* Whether each contact of a point sticks throughout, or is open. */
static bool is_linear(const mhb_response *r, const mhb_branch *b, int i) {
  for (int a = 0; a < r->n_pairs; a++) {
    const double *state = b->state + 3 * ((size_t)i * (size_t)r->n_pairs + (size_t)a);
    if (state[0] < 1 && state[2] < 1) return false;
  }
  return true;
}

/* The range of the places in doubt. It reaches to where the motion is linear on both sides: a
 * sweep finds its first solution there. */
static void range_in_doubt(const job *j, const exact_peak *peak, double range[2]) {
  const mhb_response *r    = j->response;
  const bool          own  = !is_known(j, peak) || peak->high[0] > peak->high[1];
  const double        low  = own ? fmin(peak->frequency, peak->high[0]) : peak->high[0];
  const double        high = own ? fmax(peak->frequency, peak->high[1]) : peak->high[1];
  memcpy(range, j->model->settings.frequency, 2 * sizeof *range);
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    for (int i = 0; i < b->n_points && b->kind == MHB_BRANCH_NONLINEAR; i++) {
      if (!is_linear(r, b, i)) continue;
      if (b->frequency[i] < low) range[0] = fmax(range[0], b->frequency[i]);
      if (b->frequency[i] > high) range[1] = fmin(range[1], b->frequency[i]);
    }
  }
}

/* Whether a peak is beside no end of the case's range. */
static bool is_inside(const job *j, const exact_peak *peak) {
  static const double at_end = 1e-9; /* relative */
  const double       *range  = j->model->settings.frequency;
  return peak->frequency > (1 + at_end) * range[0] && peak->frequency < (1 - at_end) * range[1];
}

/* A sweep of the places in doubt, and the highest peak there. */
static shb_status look_closer(const job *j, int harmonics, peak_search *s, exact_peak *peak) {
  mhb_response *curves = NULL;
  double        range[2];
  range_in_doubt(j, &s->peak, range);
  shb_status status = sweep(j, harmonics, range, &curves);
  if (status == SHB_NOT_CONVERGED) status = SHB_OK;
  if (status == SHB_OK) status = find_peak(j, curves, s->first, s->asked, peak);
  if (status == SHB_OK)
    peak->doubt = peak->doubt || (peak->edge && is_inside(j, peak)) || cut_short(curves);
  mhb_response_destroy(curves);
  return status;
}

/* A sweep of the range, and the highest peak there. */
static shb_status look(job *j, int harmonics, peak_search *s, exact_peak *peak) {
  shb_status status = sweep(j, harmonics, NULL, &j->response);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  s->first = post_output_primary(j->response);
  if (j->from && !s->asked.walked) {
    SHB_TRY(peak_walk(&j->model->model, &j->model->settings, s->first, j->from, s->walked));
    s->asked.walked = s->walked;
  }
  SHB_TRY(find_peak(j, j->response, s->first, s->asked, peak));
  if (harmonics == LAST_COARSE) s->missed = peak->missed;
  return SHB_OK;
}

/* The peak of the last sweep takes the place of that before, unless it is lower: a detached curve
 * may be lost. */
static void take(job *j, const exact_peak *peak, peak_search *s) {
  if (!peak->found || (is_known(j, &s->peak) && !(peak->amplitude > s->peak.amplitude))) {
    s->peak.doubt = peak->doubt || !peak->exact;
  } else {
    s->peak = *peak;
    if (j->found) {
      const solved_peak former = *j->found;
      *j->found                = s->latest;
      s->latest                = former;
    }
  }
  solved_peak_free(&s->latest);
}

/* Sweep with more and more harmonics until the peak is exact.
 *   walked  the neighbour's peak, here */
static shb_status sweep_for(job *j, solved_peak *walked) {
  peak_search s = {.walked = walked};
  s.asked       = (exact_peak_asked){.multipliers = wants(j, STUDY_STABLE),
                                     .derivatives = study_derivatives(j->n, j->output) > 0,
                                     .field       = j->field,
                                     .solution    = j->found ? &s.latest : NULL};
  int harmonics = 0; /* of the curves that are kept */
  for (int i = 0; i < N_SWEEPS && !is_settled(j, &s.peak); i++) {
    const bool closer = j->response && (sweeps[i] > LAST_COARSE || sweeps[i] == 0);
    exact_peak peak   = {0};
    if (!is_of_use(j, sweeps[i])) continue;
    s.asked.harmonics = sweeps[i] > 0 ? sweeps[i] : MANY;
    /* A better sweep follows. */
    s.asked.hasty = sweeps[i] > 0 && sweeps[i] < LAST_COARSE && !j->from;
    const shb_status status =
        closer ? look_closer(j, sweeps[i], &s, &peak) : look(j, sweeps[i], &s, &peak);
    if (status == SHB_ERR_INPUT && sweeps[i] > 0) continue; /* the load has more harmonics */
    SHB_TRY(status);
    if (!closer) harmonics = s.asked.harmonics;
    take(j, &peak, &s);
  }
  if (s.missed > (1 + HIGHER) * s.peak.amplitude) s.peak.doubt = true;
  return fill(j, s.first, harmonics, &s.peak);
}

/* A ring of different blades: its worst blade. */
static shb_status ring_work(job *j) {
  exact_peak peak;
  for (int i = 0; i < j->n; i++) {
    const study_quantity q = j->output[i].quantity;
    SHB_CHECK(q == STUDY_PEAK || q == STUDY_FREQUENCY || q == STUDY_MODE_FREQUENCY, SHB_ERR_INPUT,
              "%s: is not computed for a ring of different blades (rotor.mistuning); ask for peak, "
              "of its worst blade, frequency or modes[I].frequency",
              j->output[i].name);
  }
  SHB_TRY(worst_blade_peak(j->model, &j->response, &peak));
  return fill(j, (post_output){0}, 0, &peak);
}

static shb_status work(job *j) {
  if (j->model->ring) return ring_work(j);
  solved_peak walked = {0};
  shb_status  status = sweep_for(j, &walked);
  solved_peak_free(&walked);
  return status;
}

shb_status design_run_from(const case_file *file, const case_model *model, peak_field *field,
                           int n_outputs, const study_output *output, const solved_peak *from,
                           solved_peak *found, study_design *design) {
  job        j      = {file, model, n_outputs, output, design, NULL, field, from, found};
  shb_status status = field ? peak_field_use(field, file) : SHB_OK;
  if (status == SHB_OK) status = work(&j);
  if (status == SHB_ERR_INPUT) {
    fail(design, shb_message());
    status = SHB_OK;
  }
  mhb_response_destroy(j.response);
  return status;
}

shb_status design_run(const case_file *file, const case_model *model, peak_field *field,
                      int n_outputs, const study_output *output, study_design *design) {
  return design_run_from(file, model, field, n_outputs, output, NULL, NULL, design);
}
