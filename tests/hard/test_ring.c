/* Hard case 8: the condensed sector against all blades of a ring of six; engine orders 0, N/2, N/2
 * +- 1. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/numerics/fourier.h"
#include "tests/hard/verdict.h"
#include "tests/support/complex_form.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { BLADES = 6, M = 5 };

/* All blades as one structure. Contact b joins the right of blade b to the left of blade b + 1;
 * blade b lags by b phi. */
static void unfold(const modal_model *sector, int engine_order, modal_model *ring) {
  int    m = sector->n_modes, all = BLADES * m, nc = 2 * 3 * BLADES;
  size_t modes = (size_t)all;
  *ring =
      (modal_model){.n_modes = all, .n_pairs = BLADES, .n_load = sector->n_load, .has_left = true};
  ring->frequency            = calloc(modes, sizeof(double));
  ring->damping_ratio        = calloc(modes, sizeof(double));
  ring->right                = calloc(3 * BLADES * modes, sizeof(double));
  ring->left                 = calloc(3 * BLADES * modes, sizeof(double));
  ring->normal               = calloc(3 * BLADES, sizeof(double));
  ring->modal_force          = calloc((size_t)(ring->n_load + 1) * modes, sizeof(double complex));
  ring->load_residual        = calloc((size_t)((ring->n_load + 1) * nc), sizeof(double complex));
  ring->load_inertia         = calloc((size_t)((ring->n_load + 1) * nc), sizeof(double complex));
  ring->residual_flexibility = calloc((size_t)(nc * nc), sizeof(double));
  ring->residual_inertia     = calloc((size_t)(nc * nc), sizeof(double));
  ring->residual_fourth      = calloc((size_t)(nc * nc), sizeof(double));
  for (int b = 0; b < BLADES; b++) {
    int at[2] = {3 * b, 3 * (BLADES + (b + BLADES - 1) % BLADES)}; /* dofs of its right and left */
    for (int i = 0; i < m; i++) {
      ring->frequency[b * m + i]     = sector->frequency[i];
      ring->damping_ratio[b * m + i] = sector->damping_ratio[i];
    }
    for (int c = 0; c < 3; c++) {
      memcpy(ring->right + (3 * b + c) * all + b * m, sector->right + c * m,
             sizeof(double) * (size_t)m);
      memcpy(ring->left + (at[1] - 3 * BLADES + c) * all + b * m, sector->left + c * m,
             sizeof(double) * (size_t)m);
      ring->normal[3 * b + c] = sector->normal[c];
    }
    for (int i = 0; i < 6; i++)
      for (int j = 0; j < 6; j++) {
        int to                         = (at[i / 3] + i % 3) * nc + at[j / 3] + j % 3;
        ring->residual_flexibility[to] = sector->residual_flexibility[6 * i + j];
        ring->residual_inertia[to]     = sector->residual_inertia[6 * i + j];
        ring->residual_fourth[to]      = sector->residual_fourth[6 * i + j];
      }
    for (int k = 0; k <= ring->n_load; k++) {
      double complex lag = cexp(-SHB_TWO_PI * I * k * b * engine_order / BLADES);
      for (int i = 0; i < m; i++)
        ring->modal_force[k * all + b * m + i] = lag * sector->modal_force[k * m + i];
      for (int i = 0; i < 6; i++) {
        int to                  = k * nc + at[i / 3] + i % 3;
        ring->load_residual[to] = lag * sector->load_residual[6 * k + i];
        ring->load_inertia[to]  = lag * sector->load_inertia[6 * k + i];
      }
    }
  }
}

/* The sector's solution on all contacts. */
static void spread(const double *x, int engine_order, double *all) {
  int            nb = mhb_real_size(M);
  double complex A[M + 1];
  for (int b = 0; b < BLADES; b++)
    for (int c = 0; c < 3; c++) {
      to_complex(M, x + c * nb, A);
      for (int k = 0; k <= M; k++) A[k] *= cexp(-SHB_TWO_PI * I * k * b * engine_order / BLADES);
      mhb_to_real(M, A, all + (3 * b + c) * nb);
    }
}

static void compare(const modal_model *sector, int engine_order, double n0, double w) {
  modal_model  ring;
  mhb_settings s = random_settings(M), one;
  periodic     p, q;
  int          n = 3 * BLADES * mhb_real_size(M);
  double       wanted[n], worst = 0;
  s.tolerance    = 1e-11;
  s.engine_order = engine_order;
  s.n0[0]        = n0;
  one            = s;
  one.blades = 1, one.engine_order = 0;  /* the blades are all in the model */
  one.kv *= BLADES, one.n0[0] *= BLADES; /* totals, shared by the contacts */
  for (int i = 0; i < 3; i++) one.ku[i] *= BLADES;
  unfold(sector, engine_order, &ring);
  periodic_create(sector, &s, w, NULL, &p);
  periodic_create(&ring, &one, w, NULL, &q);
  spread(p.x, engine_order, wanted);
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(q.x[i] - wanted[i]));
  const double *share = p.residual->eval->info[0].share;
  verdict(worst / mhb_norm(wanted, n), 1e-8, "8 E %d n0 %5.2f W %.1f (slip %.2f open %.2f)",
          engine_order, n0, w, share[MHB_SLIDE], share[MHB_SEPARATE]);
  periodic_destroy(&p);
  periodic_destroy(&q);
  modal_model_free(&ring);
}

static void sector_and_ring(void **state) {
  (void)state;
  static const int    order[] = {0, BLADES / 2, BLADES / 2 - 1, BLADES / 2 + 1};
  static const double n0[]    = {.3, .03, -.02};
  modal_model         sector;
  random_model(1, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 4, &sector);
  for (int i = 0; i < 12; i++) compare(&sector, order[i / 3], n0[i % 3], 1.1 + .1 * (i % 2));
  modal_model_free(&sector);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sector_and_ring)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
