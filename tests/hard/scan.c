/* Run by hand: the number of curves of a blade that have a gap. Arguments: MODAL.h5 MU HARMONICS
 * [N0 ...]. The contact is that of cases/z_notch_blade: to the neighbour, 40 blades, engine order
 * 5, ku 0.5 MN/m, kv 0.8 MN/m, 90 to 270 Hz. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"

static const double PRELOADS[] = {-500, -100, -20, 0,   3,   10,  20,   30,   50,   75,
                                  100,  150,  200, 300, 500, 700, 1000, 1200, 1500, 1800};

static mhb_settings settings(int argc, char **argv) {
  mhb_settings s = {.engine_order = 5,
                    .blades       = 40,
                    .mu           = atof(argv[2]),
                    .kv           = 8e5,
                    .ku           = {5e5, 0, 5e5},
                    .frequency    = {90, 270},
                    .harmonics    = atoi(argv[3]),
                    .subharmonics = 1,
                    .scale        = 1,
                    .tolerance    = 1e-8,
                    .max_points   = 2000};
  if (argc > 4) {
    for (int i = 4; i < argc; i++) s.n0[s.n_preloads++] = atof(argv[i]);
  } else {
    s.n_preloads = (int)(sizeof PRELOADS / sizeof *PRELOADS);
    memcpy(s.n0, PRELOADS, sizeof PRELOADS);
  }
  return s;
}

int main(int argc, char **argv) {
  modal_model   model;
  mhb_response *response = NULL;
  if (argc < 4 || modal_model_read(argv[1], &model) != SHB_OK) {
    fprintf(stderr, "usage: hard_scan MODAL.h5 MU HARMONICS [N0 ...]\n%s\n", shb_message());
    return 2;
  }
  mhb_settings s       = settings(argc, argv);
  double       started = shb_seconds();
  mhb_forced_response(&model, &s, NULL, NULL, NULL, &response);
  if (!response) {
    fprintf(stderr, "%s\n", shb_message());
    return 3;
  }
  int gaps = 0, points = 0;
  for (int i = 2; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    points += b->n_points;
    gaps += !b->complete;
    if (!b->complete || argc > 4)
      printf("  n0 %g: %d points, %s\n", b->n0[0], b->n_points, b->reason);
  }
  printf("%s mu %g H %d: %d of %d curves with a gap, %d points, %.2f s\n", argv[1], s.mu,
         s.harmonics, gaps, s.n_preloads, points, shb_seconds() - started);
  mhb_response_destroy(response);
  modal_model_free(&model);
  return gaps > 0;
}
