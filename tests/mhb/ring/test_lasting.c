#include "mesh/base/constants.h"
#include "mhb/ring/lasting.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"
int main(int argc, char **argv) {
  int blades = argc > 1 ? atoi(argv[1]) : 4;
  for (unsigned long long seed = 1; seed < 40; seed++)
    for (int q = 0; q < 3; q++) {
      double      zeta = .003, n0 = (double[]){.05, .15, .4}[q];
      modal_model model;
      random_model(1, WITH_LEFT, seed, &model);
      for (int i = 0; i < 6; i++) model.damping_ratio[i] = zeta;
      mhb_settings s  = random_settings(7);
      s.blades        = blades;
      s.tolerance     = 1e-8;
      s.n0[0]         = n0;
      s.frequency[0]  = .6 / SHB_TWO_PI;
      s.frequency[1]  = 1.5 / SHB_TWO_PI;
      s.stability     = MHB_STABILITY_ALWAYS;
      s.max_points    = 400;
      mhb_response *r = NULL;
      if (main_curve(&model, &s, 7, NULL, &r) == SHB_OK) {
        const mhb_branch *b = &r->branch[0];
        int               n = 0, best = -1;
        double            top = 0;
        for (int i = 0; i < b->n_points; i++)
          if (b->stable[i] == 0 && b->loss[i] > 1) {
            n++;
            double a = cabs(b->motion[(size_t)i * 3 * 8 + 8 + 1]);
            if (a > top) {
              top  = a;
              best = i;
            }
          }
        if (best >= 0) {
          mhb_wave    w = {SHB_TWO_PI * b->frequency[best], n0, b->n_harmonics,
                           b->force + (size_t)best * 3 * (size_t)(b->n_harmonics + 1)};
          mhb_lasting L;
          if (mhb_lasting_settle(&model, &s, &w, NULL, NULL, &L) == SHB_OK)
            printf(
                "seed %llu n0 %g: %d of %d; at %.5f rad/s slip %.2f open %.2f loss %d mult %.3f: "
                "kind %d mean %.4f worst %.4f err %.4f side %d %+.4f periods %d\n",
                seed, n0, n, b->n_points, w.omega, b->state[3 * best + 1], b->state[3 * best + 2],
                b->loss[best], 0., L.kind, L.mean, L.worst, L.error, L.diameter, L.offset,
                L.periods);
          fflush(stdout);
        }
      }
      mhb_response_destroy(r);
      modal_model_free(&model);
    }
}
