/* No curve over the preload, the scale, mu, ku or kv has a gap: 24 frequencies across the
 * resonances, from a gap to stuck. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/problem/parameter.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

enum { FREQUENCIES = 24, PRELOADS = 4 };

typedef struct {
  mhb_settings settings;
  double       from, to; /* rad/s */
  double       n0[PRELOADS], range[MHB_N_PARAMETERS][2];
} scene;

/* Curves that do not cover the range; each is told. */
static int gaps(const modal_model *model, const scene *c, mhb_parameter parameter, int *folds) {
  int lost = 0;
  for (int i = 0; i < FREQUENCIES; i++) {
    mhb_settings  s        = c->settings;
    mhb_response *response = NULL;
    s.harmonics            = 5 + 2 * (i % 2);
    s.n0[0]                = c->n0[i % PRELOADS];
    s.parameter            = parameter;
    s.frequency[0]         = s.frequency[1] =
        (c->from + (i + .5) * (c->to - c->from) / FREQUENCIES) / SHB_TWO_PI;
    memcpy(s.range, c->range[parameter], sizeof s.range);
    mhb_forced_response(model, &s, NULL, NULL, NULL, &response);
    if (!response) fail_msg("%s", shb_message());
    const mhb_branch *b = &response->branch[2];
    *folds += count_special(b, MHB_FOLD);
    lost += !b->complete;
    if (!b->complete) print_message("  %g Hz, n0 %g: %s\n", s.frequency[0], s.n0[0], b->reason);
    mhb_response_destroy(response);
  }
  return lost;
}

static void scan(const char *name, const modal_model *model, const scene *c) {
  for (int p = MHB_IN_FREQUENCY + 1; p < MHB_N_PARAMETERS; p++) {
    int folds = 0, lost = gaps(model, c, (mhb_parameter)p, &folds);
    verdict_count(lost, 0, "%s, %s: gaps in %d curves with %d folds", name,
                  mhb_parameter_name((mhb_parameter)p), FREQUENCIES, folds);
  }
}

static void three_degrees(void **state) {
  (void)state;
  modal_model model;
  scene       c = {.settings = ground_settings(.4, .8, .5, 0, 5),
                   .from     = .9,
                   .to       = 1.55,
                   .n0       = {-.1, 0, .2, .5},
                   .range    = {[MHB_IN_N0]    = {-.5, 1.5},
                                [MHB_IN_SCALE] = {.01, 5},
                                [MHB_IN_MU]    = {0, 3},
                                [MHB_IN_KU]    = {.01, 10},
                                [MHB_IN_KV]    = {.01, 10}}};
  three_degree_model(&model);
  scan("three degrees", &model, &c);
  modal_model_free(&model);
  verdict_all();
}

static void beam(void **state) {
  (void)state;
  modal_model model;
  scene       c = {.settings = ground_settings(.3, 2e5, 2e5, 0, 5),
                   .from     = SHB_TWO_PI * 215,
                   .to       = SHB_TWO_PI * 320,
                   .n0       = {-20, 0, 50, 150},
                   .range    = {[MHB_IN_N0]    = {-200, 500},
                                [MHB_IN_SCALE] = {.01, 10},
                                [MHB_IN_MU]    = {0, 3},
                                [MHB_IN_KU]    = {2e3, 5e6},
                                [MHB_IN_KV]    = {2e3, 5e6}}};
  tip_contact_beam_model(10, &model);
  scan("tip-contact beam", &model, &c);
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(three_degrees), cmocka_unit_test(beam)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
