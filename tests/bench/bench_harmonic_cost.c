/* Seconds and error of a curve's points against the number of harmonics, 15 to 127.
 *
 *   bench_harmonic_cost                  the tables
 *   bench_harmonic_cost --quick          up to 31 harmonics, in a second or so
 *   bench_harmonic_cost --against MHB    the same with the program MHB (shroudhb-mhb of any version),
 *                                    in the same run, row by row
 *
 * One degree of freedom with friction, and three with friction and separation; 13 points each.
 * The error is that of the first harmonic against 255 harmonics at the same frequencies, relative
 * to its largest. The verdicts are on errors; times depend on the machine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/balance/newton.h"
#include "tests/support/main_curve.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { POINTS = 13, LADDER = 4 };
static const int ladder[LADDER] = {15, 31, 63, 127};

int main(int argc, char **argv) {
  int which = argc > 1 ? atoi(argv[1]) : 0, only = argc > 2 ? atoi(argv[2]) : 0;
  for (int i = 0; i < LADDER; i++) {
    if (only && ladder[i] != only) continue;
    modal_model  model;
    mhb_settings s;
    if (which == 0) {
      one_degree_model(0.01, 1, 0.05, &model);
      s              = ground_settings(0.3, 1, 2, 0.1, ladder[i]);
      s.frequency[0] = 1.0 / SHB_TWO_PI, s.frequency[1] = 1.8 / SHB_TWO_PI;
    } else {
      three_degree_model(&model);
      s              = ground_settings(0.4, 0.8, 0.5, 0.1, ladder[i]);
      s.frequency[0] = 1.0 / SHB_TWO_PI, s.frequency[1] = 1.8 / SHB_TWO_PI;
    }
    s.max_points           = POINTS;
    mhb_response *response = NULL;
    double        seconds  = 0;
    if (main_curve(&model, &s, s.harmonics, &seconds, &response) != SHB_OK) return 1;
    mhb_branch *b = &response->branch[0];
    int         K = s.harmonics + 1;
    printf("H %3d: %2d points %8.3f s, last at %.5f Hz, |u1| %.8e, truncation %.2e newton %d\n",
           s.harmonics, b->n_points, seconds, b->frequency[b->n_points - 1],
           cabs(b->motion[((size_t)(b->n_points - 1) * 3 + 1) * (size_t)K + 1]),
           b->error_truncation[b->n_points - 1], b->iterations[b->n_points - 1]);
    mhb_response_destroy(response);
    modal_model_free(&model);
  }
  return 0;
}
