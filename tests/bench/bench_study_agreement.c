/* Studies against sweeps: random designs in wide ranges, gaps included.
 *
 *   bench_study_agreement FILE N [SEED]   a modal file, contact and excitation of
 *                                         cases/z_notch_blade, N designs
 *   bench_study_agreement --one FILE N0 MU KU KV SCALE DAMPING
 *   bench_study_agreement --quick         a small random ring, 2 designs with a gap
 *
 * A third of the preloads is even from -20 to 20 N. The others reach 600 N, even in the logarithm.
 * Friction is 0.05 to 0.6. Even in the logarithm are ku and kv, 0.1 to 10 MN/m, the scale, 0.1 to
 * 10, and the damping, 2e-4 to 2e-2.
 *
 * The reference is the highest peak with 31 harmonics, solved beside a sweep in outline with 15. A
 * sweep with 31 follows where it is in doubt, or not within three times the told error of the
 * design. A design that is done is
 *   agree   within three times its told error
 *   more    higher: its curve is one that the sweeps have not found
 *   WRONG   lower: a fault. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/peaks/exact_peak.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "tests/bench/studied_designs.h"

/* Peaks of different samples of one curve agree to this: a kink is taken by its bracket. */
static const double SAME = 1e-6;

typedef enum { AGREE, MORE, WRONG, NOT_CONVERGED, N_VERDICTS } verdict;

typedef struct {
  studied_peak study;
  swept_peak   sweep;
  double       peak, at; /* m, Hz: of the reference */
  bool         exact;    /* solved with 31 harmonics, none missed */
} row;

/* The reference grows to the highest peak with 31 harmonics beside a sweep. */
static shb_status add_reference(const case_model *model, int harmonics, row *out) {
  mhb_response *r        = NULL;
  mhb_settings  fixed    = model->settings;
  exact_peak    peak     = {0};
  fixed.motion_tolerance = 0;
  fixed.harmonics        = 31;
  SHB_TRY(swept_peak_find(model, harmonics, 1, true, &out->sweep, &r));
  const double     began  = shb_processor_seconds();
  const shb_status status = exact_peak_find(&model->model, &fixed, r, post_output_primary(r),
                                            (exact_peak_asked){.harmonics = harmonics}, &peak);
  out->sweep.cpu += shb_processor_seconds() - began;
  out->exact = peak.found && peak.exact && !peak.doubt && out->sweep.complete;
  if (peak.found && peak.amplitude > out->peak) {
    out->peak = peak.amplitude;
    out->at   = peak.frequency;
  }
  mhb_response_destroy(r);
  return status;
}

/* The told error, m. */
static double told(const row *r) {
  const double error = isfinite(r->study.error) ? r->study.error : 0;
  return fmax(error, SAME * r->study.peak / 3);
}

static bool within(const row *r) {
  return fabs(r->study.peak - r->peak) <= 3 * told(r);
}

static verdict judge(const row *r) {
  if (!r->study.done) return NOT_CONVERGED;
  return within(r) ? AGREE : r->study.peak > r->peak ? MORE : WRONG;
}

static shb_status compare(const case_model *model, row *out, verdict *v) {
  static const char *const name[] = {"agree", "more", "WRONG", "not converged"};
  const mhb_settings      *s      = &model->settings;
  *out                            = (row){0};
  SHB_TRY(studied_peak_find(model, &out->study));
  SHB_TRY(add_reference(model, 15, out));
  if (!out->exact || !within(out)) SHB_TRY(add_reference(model, 31, out));
  *v = judge(out);
  printf("%9.4f %6.4f %9.3e %9.3e %7.4f %8.2e %12.6g %8.2f %+9.1e %9.1e %8.3f %8.3f  %s%s\n",
         s->n0[0], s->mu, s->ku[0], s->kv, s->scale, model->model.damping_ratio[0], out->study.peak,
         out->study.at, out->study.peak / out->peak - 1, out->study.error / out->study.peak,
         out->study.cpu, out->sweep.cpu, name[*v], out->exact ? "" : ", reference in doubt");
  if (*v != AGREE)
    printf(
        "          reference %.6g m at %.2f Hz; %s\n          --one %.9g %.9g %.9g %.9g %.9g "
        "%.9g\n",
        out->peak, out->at, out->study.reason, s->n0[0], s->mu, s->ku[0], s->kv, s->scale,
        model->model.damping_ratio[0]);
  fflush(stdout);
  return SHB_OK;
}

/* ---------------------------------------------------------------- random designs */

static void set_contact(case_model *model, double n0, double mu, double ku, double kv, double scale,
                        double damping) {
  mhb_settings *s = &model->settings;
  s->n_preloads   = 1;
  s->n0[0]        = n0;
  s->mu           = mu;
  s->ku[0] = s->ku[2] = ku;
  s->kv               = kv;
  s->scale            = scale;
  for (int i = 0; i < model->model.n_modes; i++) model->model.damping_ratio[i] = damping;
}

static void randomise(case_model *model, unsigned long *seed) {
  const bool   near = next_random(seed) < 1. / 3;
  const double n0   = near ? -20 + 40 * next_random(seed) : random_between(20, 600, seed);
  const double mu = 0.05 + 0.55 * next_random(seed), ku = random_between(1e5, 1e7, seed);
  const double kv = random_between(1e5, 1e7, seed), scale = random_between(0.1, 10, seed);
  set_contact(model, n0, mu, ku, kv, scale, random_between(2e-4, 2e-2, seed));
}

/* Returns the number of faults; -1 after an error. */
static int random_designs(case_model *model, int n, unsigned long seed) {
  int    count[N_VERDICTS] = {0};
  double cpu = 0, sweeps = 0, worst = 0, worst_error = 0;
  printf("%9s %6s %9s %9s %7s %8s %12s %8s %9s %9s %8s %8s\n", "n0, N", "mu", "ku, N/m", "kv, N/m",
         "scale", "damping", "peak, m", "Hz", "error", "told", "s", "sweeps s");
  for (int i = 0; i < n; i++) {
    row     one;
    verdict v;
    randomise(model, &seed);
    if (compare(model, &one, &v) != SHB_OK) return -1;
    count[v]++;
    cpu += one.study.cpu;
    sweeps += one.sweep.cpu;
    if (v != AGREE) continue;
    worst       = fmax(worst, fabs(one.study.peak - one.peak) / told(&one));
    worst_error = fmax(worst_error, fabs(one.study.peak / one.peak - 1));
  }
  printf("%d designs: %d agree, %d more, %d wrong, %d not converged\n", n, count[AGREE],
         count[MORE], count[WRONG], count[NOT_CONVERGED]);
  printf("of those that agree: largest error %.1e, %.2f times the told one\n", worst_error, worst);
  printf("mean: %.3f s a design, %.3f s its sweeps\n", cpu / n, sweeps / n);
  return count[WRONG];
}

static int one_design(case_model *model, char **number) {
  double  x[6];
  row     one;
  verdict v;
  for (int i = 0; i < 6; i++) x[i] = strtod(number[i], NULL);
  set_contact(model, x[0], x[1], x[2], x[3], x[4], x[5]);
  return compare(model, &one, &v) == SHB_OK ? v == WRONG : -1;
}

static int quick_designs(case_model *model) {
  static const double n0[]   = {-0.05, 0.15};
  int                 faults = 0;
  model->settings.n_preloads = 1;
  for (int i = 0; i < 2; i++) {
    row     one;
    verdict v;
    model->settings.n0[0] = n0[i];
    if (compare(model, &one, &v) != SHB_OK) return -1;
    faults += v == WRONG;
  }
  return faults;
}

int main(int argc, char **argv) {
  const bool  quick = argc > 1 && !strcmp(argv[1], "--quick");
  const bool  one   = argc > 8 && !strcmp(argv[1], "--one");
  const char *file  = one ? argv[2] : argc > 2 ? argv[1] : NULL;
  case_model  model;
  if (!quick && !file) {
    fputs(
        "usage: bench_study_agreement FILE N [SEED], --one FILE N0 MU KU KV SCALE DAMPING or "
        "--quick\n",
        stderr);
    return 2;
  }
  int fault = studied_model(quick ? NULL : file, &model) == SHB_OK ? 0 : -1;
  if (file) {
    model.settings.frequency[0]     = 60;
    model.settings.frequency[1]     = 420;
    model.settings.motion_tolerance = 1e-3;
  }
  model.settings.search.starts = MHB_SEARCH_PEAKS; /* as of a case, like the next */
  model.settings.max_points    = 20000;
  const unsigned long seed     = !one && argc > 3 ? strtoul(argv[3], NULL, 10) : 1;
  if (fault == 0)
    fault = quick ? quick_designs(&model)
            : one ? one_design(&model, argv + 3)
                  : random_designs(&model, atoi(argv[2]), seed);
  if (fault < 0) fprintf(stderr, "%s\n", shb_message());
  printf("%s\n", fault ? "FAULTS" : "no peak is lower than its sweeps by three times its error");
  modal_model_free(&model.model);
  return fault != 0;
}
