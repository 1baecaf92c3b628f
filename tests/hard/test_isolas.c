/* Hard case 11: subharmonic branches of order 2 and 3 that nothing connects to the main one, found by search. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mhb/path.h"
#include "mhb/search.h"
#include "tests/hard/verdict.h"
#include "tests/mhb/periodic.h"
#include "tests/mhb/three_degree.h"

static double turning(const mhb_path *path, const mhb_path_point *point, void *context) {
  (void)context;
  return point->tangent[path->n];
}

/* Lowest and highest frequency of the closed curve through x: folds on the way, both directions. */
static void extent(mhb_residual *b, const double *x, double w, double ends[2]) {
  ends[0] = INFINITY;
  ends[1] = -INFINITY;
  for (int way = -1; way <= 1; way += 2) {
    mhb_path *path;
    double    at;
    assert_int_equal(mhb_path_create(b, .5 * w, 2 * w, &path), SHB_OK);
    assert_int_equal(mhb_path_start(path, x, w, way), MHB_CONVERGED);
    for (int i = 0, folds = 0; i < 400 && folds < 2; i++) {
      if (mhb_path_step(path) != MHB_PATH_ON) break;
      double a = path->now.tangent[path->n], c = path->next.tangent[path->n];
      if (a * c < 0 && mhb_path_locate(path, turning, NULL, a, c, &at)) {
        ends[0] = fmin(ends[0], path->probe.value);
        ends[1] = fmax(ends[1], path->probe.value);
        folds++;
      }
      mhb_path_advance(path);
    }
    mhb_path_destroy(path);
  }
}

static void isolas(void **state) {
  (void)state;
  static const struct {
    int    order, harmonics;
    double w, ends[2], amplitude[2];
  } rows[] = {{2, 16, 2.5, {2.071793, 2.825990}, {.984855, .734821}},
              {3, 21, 3.6, {3.274102, 3.864229}, {.770513, .719994}}};
  modal_model model;
  one_degree_model(.02, 0, .5, &model);
  for (int i = 0; i < 2; i++) {
    mhb_settings s = ground_settings(0, 9, 1, -4.5, rows[i].harmonics);
    mhb_newton  *newton;
    periodic     p;
    mhb_found    found  = {0};
    double       far[2] = {INFINITY, INFINITY}, ends[2] = {0, 0};
    int          judged = 0;
    s.subharmonics      = rows[i].order;
    periodic_create(&model, &s, rows[i].w, NULL, &p);
    assert_int_equal(mhb_newton_create(p.residual->n, &newton), SHB_OK);
    assert_int_equal(mhb_found_add(&found, p.residual->n, p.x), SHB_OK);
    assert_int_equal(mhb_search(newton, p.residual, rows[i].w, 1, 60, 7, &found), SHB_OK);
    print_message("  order %d: %d solutions\n", rows[i].order, found.n_found);
    for (int f = 1; f < found.n_found; f++) {
      const double  *x = found.x + (size_t)(f * found.n);
      double         a = hypot(x[1], x[2]);
      double complex mu[16];
      for (int k = 0; k < 2; k++) {
        if (fabs(a - rows[i].amplitude[k]) > 1e-3) continue;
        far[k] = fmin(far[k], fabs(a - rows[i].amplitude[k]));
        periodic q;
        periodic_create(&model, &s, rows[i].w, x, &q);
        if (periodic_multipliers(&q, 1024, mu).verdict == (k ? MHB_UNSTABLE : MHB_STABLE))
          judged |= 1 << k;
        periodic_destroy(&q);
        if (k == 0) extent(p.residual, x, rows[i].w, ends);
      }
    }
    verdict(far[0], 1e-5, "11 order %d: stable one found, amplitude", rows[i].order);
    verdict(far[1], 1e-5, "11 order %d: unstable one found, amplitude", rows[i].order);
    verdict_count(judged, 3, "11 order %d: stable, unstable (bits)", rows[i].order);
    for (int k = 0; k < 2; k++)
      verdict(fabs(ends[k] / rows[i].ends[k] - 1), 1e-5, "11 order %d: %s end", rows[i].order,
              k ? "upper" : "lower");
    mhb_found_free(&found);
    mhb_newton_destroy(newton);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(isolas)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
