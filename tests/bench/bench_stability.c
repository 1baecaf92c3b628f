/* Stability along curves: seconds of auto and always, and what auto claims.
 *
 *   bench_stability FILE   a modal file: contact and excitation of cases/z_notch_blade
 *   bench_stability        a ring of 24 blades with random shapes
 *   bench_stability --quick   the same ring, a shorter range
 *
 * A row gives processor seconds without verdicts, with auto, and with always. Then follow the
 * slipping points and how many of them have opposite verdicts, are not judged, are judged by
 * multipliers. The last figure is the largest difference of a multiplier. Goals: opposite below
 * 1 %, not judged at most a third, multipliers within 5e-3. The exit code depends on these, not on
 * seconds.
 */
#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"
#include "modal/model/model.h"
#include "tests/support/random_model.h"
#include "tests/support/z_notch_settings.h"

typedef struct {
  double seconds[3]; /* never, auto, always */
  int    points, slipping, opposite, unknown, computed;
  double worst;
} row;

static mhb_settings random_ring(int quick) {
  mhb_settings s = random_settings(3);
  s.blades       = 24;
  s.engine_order = 4;
  s.n0[0]        = 0.1;
  s.tolerance    = 1e-8;
  s.frequency[0] = 0.9 / SHB_TWO_PI;
  s.frequency[1] = (quick ? 1.2 : 2) / SHB_TWO_PI;
  return s;
}

static shb_status timed(const modal_model *model, mhb_settings s, mhb_stability_when when,
                        double *seconds, mhb_response **response) {
  double started    = shb_processor_seconds();
  s.stability       = when;
  shb_status status = mhb_forced_response(model, &s, NULL, NULL, NULL, response);
  *seconds          = shb_processor_seconds() - started;
  return status == SHB_NOT_CONVERGED ? SHB_OK : status;
}

static double largest(const mhb_response *r, const mhb_branch *b, int point) {
  return cabs(b->multipliers[(size_t)point * (size_t)r->n_multipliers]);
}

static bool slips(const mhb_branch *b, int point) {
  return b->state[3 * (size_t)point] < 1 && b->state[3 * (size_t)point + 2] < 1;
}

/* Points of the same curve; located bifurcations are left out. */
static void compare(const mhb_response *r[2], int branch, row *out) {
  const mhb_branch *a = &r[0]->branch[branch], *b = &r[1]->branch[branch];
  for (int p = 0, q = 0; p < a->n_points && q < b->n_points; p++, q++) {
    while (p < a->n_points && a->special[p] >= MHB_FLIP) p++;
    while (q < b->n_points && b->special[q] >= MHB_FLIP) q++;
    if (p == a->n_points || q == b->n_points) break;
    out->points++;
    if (!slips(a, p)) continue;
    out->slipping++;
    out->unknown += a->stable[p] < 0;
    out->opposite += a->stable[p] >= 0 && b->stable[q] >= 0 && a->stable[p] != b->stable[q];
    if (a->judged[p] != MHB_BY_MULTIPLIERS) continue;
    out->computed++;
    out->worst = fmax(out->worst, fabs(largest(r[0], a, p) - largest(r[1], b, q)));
  }
}

static shb_status run(const modal_model *model, const mhb_settings *s, row *out) {
  mhb_response *r[3] = {NULL, NULL, NULL};
  SHB_TRY(timed(model, *s, MHB_STABILITY_NEVER, &out->seconds[0], &r[0]));
  SHB_TRY(timed(model, *s, MHB_STABILITY_AUTO, &out->seconds[1], &r[1]));
  SHB_TRY(timed(model, *s, MHB_STABILITY_ALWAYS, &out->seconds[2], &r[2]));
  for (int i = 2; i < 2 + s->n_preloads; i++)
    compare((const mhb_response *[2]){r[1], r[2]}, i, out);
  for (int i = 0; i < 3; i++) mhb_response_destroy(r[i]);
  return SHB_OK;
}

static int print(const char *name, const row *t) {
  int good = 100 * t->opposite < t->slipping && 3 * t->unknown <= t->slipping && t->worst < 5e-3;
  printf(
      "case              never s  auto s  always s  points  slipping  opposite  not judged  "
      "multipliers  worst\n");
  printf("%-17s %7.2f %7.2f %9.2f %7d %9d %9d %11d %12d  %.1e  %s\n", name, t->seconds[0],
         t->seconds[1], t->seconds[2], t->points, t->slipping, t->opposite, t->unknown, t->computed,
         t->worst, good ? "good" : "BAD");
  return !good;
}

int main(int argc, char **argv) {
  int          quick = argc > 1 && !strcmp(argv[1], "--quick"), from_file = argc > 1 && !quick;
  modal_model  model;
  mhb_settings s      = from_file ? z_notch_settings() : random_ring(quick);
  row          result = {0};
  shb_status   status = SHB_OK;
  omp_set_num_threads(1);
  openblas_set_num_threads(1); /* as shroudhb-mhb: threads of small products only wait */
  if (from_file) {
    status = modal_model_read(argv[1], &model);
  } else {
    random_model(1, WITH_LEFT, 3, &model);
  }
  if (status == SHB_OK) status = run(&model, &s, &result);
  if (status != SHB_OK) {
    fprintf(stderr, "bench_stability: %s\n", shb_message());
    return 1;
  }
  modal_model_free(&model);
  return print(from_file ? "z_notch_blade" : "ring of 24", &result);
}
