/* cases/paper_fig9: the first resonance against preload with three harmonics and with one; numbers
 * of its README. */
#include <complex.h>
#include <stdlib.h>

#include "cases/schema/case.h"
#include "mesh/base/constants.h"
#include "mhb/structure/receptance.h"
#include "postproc/analysis/response_analysis.h"
#include "tests/support/scene.h"

enum { PRELOADS = 11, HARMONICS = 3 };

static char          folder[SCRATCH_PATH];
static mhb_response *three, *one;

/* Preload, N; highest peak with three harmonics and with one, m. */
static const double track[PRELOADS][3] = {
    {0, 99.30e-6, 173.96e-6},  {5, 80.04e-6, 121.26e-6},     {10, 35.69e-6, 30.58e-6},
    {12, 34.38e-6, 30.74e-6},  {15, 34.13e-6, 33.36e-6},     {20, 37.77e-6, 39.38e-6},
    {30, 52.41e-6, 53.28e-6},  {50, 82.40e-6, 82.41e-6},     {100, 157.1e-6, 154.9e-6},
    {400, 586.7e-6, 579.4e-6}, {1600, 1.3528e-3, 1.3528e-3},
};

/* Optimum preload and its bracket, N; lowest peak, m. */
static const double optimum[2][4] = {{13.71, 12, 20, 33.92e-6}, {10.89, 5, 12, 30.07e-6}};

/* Internal resonances without preload. Harmonic k at a frequency (Hz) resonates in a mode of the
 * blade whose contact opens and sticks in turn. The bounds are 1/k of its frequencies in these two
 * limits, at nodal diameter 5 k. */
static const struct {
  int    k, mode;
  double frequency, open, stuck;
} internal[] = {
    {2, 1, 100.9, 57.85, 185.4}, {3, 2, 131.6, 122.4, 169.3}, {3, 3, 156.7, 144.4, 231.3},
    {2, 2, 204.3, 183.6, 224.4}, {2, 3, 241.0, 216.6, 391.8},
};

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "paper_fig9", &three);
  scene_run(folder, SCENE, "single.yaml", "paper_fig9_single", &one);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(three);
  mhb_response_destroy(one);
  scratch_remove(folder);
  return 0;
}

/* The tracking curves: the peak is lowest between two preloads, at a fortieth of the stuck peak. */
static void the_peak_has_an_optimum(void **state) {
  (void)state;
  const mhb_response *response[2] = {three, one};
  for (int j = 0; j < 2; j++) {
    post_analysis *study;
    assert_int_equal(post_analysis_create(response[j], &study), SHB_OK);
    const post_tracking *t = &study->tracking;
    assert_int_equal(t->n, PRELOADS);
    for (int i = 0; i < t->n; i++) {
      print_message("%d harmonics, n0 = %6g N: %.5g um at %.2f Hz\n", j ? 1 : 3, t->point[i].n0,
                    1e6 * t->point[i].amplitude, t->point[i].at);
      assert_true(!t->point[i].edge && t->point[i].n0 == track[i][0]);
      assert_within(t->point[i].amplitude, track[i][1 + j], .02);
    }
    print_message("optimum %.4g N, %.4g um\n", t->optimum_n0, 1e6 * t->optimum_amplitude);
    assert_within(t->optimum_n0, optimum[j][0], .05);
    assert_true(t->bracket[0] == optimum[j][1] && t->bracket[1] == optimum[j][2]);
    assert_within(t->optimum_amplitude, optimum[j][3], .02);
    post_analysis_destroy(study);
  }
}

/* Share of each mode in the motion of harmonic k at a point: q = lambda (F - B^H p). */
static void modal_shares(mhb_receptance *r, const mhb_branch *b, int point, int k, double *share) {
  double sum = 0;
  mhb_receptance_at(r, SHB_TWO_PI * b->frequency[point], HARMONICS);
  for (int i = 0; i < r->n_modes; i++) {
    double complex q = r->F[k * r->n_modes + i];
    for (int c = 0; c < 3; c++)
      q -= conj(r->B[(k * 3 + c) * r->n_modes + i]) *
           b->force[(point * 3 + c) * (HARMONICS + 1) + k];
    share[i] = pow(cabs(q * r->lambda[k * r->n_modes + i]), 2);
    sum += share[i];
  }
  for (int i = 0; i < r->n_modes; i++) share[i] /= sum;
}

/* |det(I + R_k K)| of the stuck contact. Between two resonances of the open blade it has its
 * minimum at one of the stuck blade. */
static double stuck_determinant(mhb_receptance *r, const mhb_settings *settings, int k,
                                double frequency) {
  const double   spring[3] = {settings->kv, settings->ku[0], settings->ku[2]};
  double complex a[3][3];
  mhb_receptance_at(r, SHB_TWO_PI * frequency, HARMONICS);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) a[i][j] = (i == j) + r->R[(k * 3 + i) * 3 + j] * spring[j];
  return cabs(a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
              a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
              a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]));
}

/* The maximum of harmonic k on the curve, nearest to a frequency. */
static int maximum_near(const mhb_branch *b, int k, double frequency) {
  int best = -1;
  for (int p = 1; p + 1 < b->n_points; p++) {
    double here = scene_amplitude(three, b, p, k);
    if (here < scene_amplitude(three, b, p - 1, k) || here < scene_amplitude(three, b, p + 1, k))
      continue;
    if (best < 0 || fabs(b->frequency[p] - frequency) < fabs(b->frequency[best] - frequency))
      best = p;
  }
  return best;
}

static void check_internal(mhb_receptance *r, const mhb_settings *settings, int n) {
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, 0);
  const int         k = internal[n].k, mode = internal[n].mode;
  int               p = maximum_near(b, k, internal[n].frequency);
  double share[20], stuck = internal[n].stuck, at = stuck_determinant(r, settings, k, stuck);
  assert_within(r->model->frequency[mode - 1] / k, internal[n].open, 2e-3);
  assert_true(at < stuck_determinant(r, settings, k, .99 * stuck));
  assert_true(at < stuck_determinant(r, settings, k, 1.01 * stuck));
  modal_shares(r, b, p, k, share);
  print_message("harmonic %d, %.2f Hz: %.1f um beside %.1f um, mode %d has %.0f %%\n", k,
                b->frequency[p], 1e6 * scene_amplitude(three, b, p, k),
                1e6 * scene_amplitude(three, b, p, 1), mode, 100 * share[mode - 1]);
  assert_within(b->frequency[p], internal[n].frequency, 5e-3);
  assert_true(b->frequency[p] > internal[n].open && b->frequency[p] < internal[n].stuck);
  assert_true(share[mode - 1] > .5);
  assert_true(scene_amplitude(three, b, p, k) > .15 * scene_amplitude(three, b, p, 1));
}

static void superharmonics_meet_higher_modes(void **state) {
  (void)state;
  char            path[SCRATCH_PATH + 64];
  case_file       file;
  modal_model     model;
  mhb_receptance *r;
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  assert_int_equal(case_read(path, CASE_MHB, stderr, &file), SHB_OK);
  snprintf(path, sizeof path, "%s/paper_fig9.modal.h5", folder);
  assert_int_equal(modal_model_read(path, &model), SHB_OK);
  assert_int_equal(mhb_receptance_create(&model, &file.mhb, HARMONICS, &r), SHB_OK);
  assert_true(r->n_modes == 20);
  for (size_t n = 0; n < sizeof internal / sizeof *internal; n++)
    check_internal(r, &file.mhb, (int)n);
  mhb_receptance_destroy(r);
  modal_model_free(&model);
  case_free(&file);
}

/* Without preload one harmonic gives a single resonance. Three give smaller peaks, each of which
 * belongs to a superharmonic. */
static void one_harmonic_has_one_peak(void **state) {
  (void)state;
  const mhb_response *response[2] = {one, three};
  int                 n[2];
  for (int j = 0; j < 2; j++) {
    post_analysis *study;
    assert_int_equal(post_analysis_create(response[j], &study), SHB_OK);
    for (int i = 0; i < response[j]->n_branches; i++)
      if (response[j]->branch[i].kind == MHB_BRANCH_NONLINEAR && response[j]->branch[i].n0[0] == 0)
        n[j] = study->curve[i].n_peaks;
    post_analysis_destroy(study);
  }
  print_message("peaks: %d with one harmonic, %d with three\n", n[0], n[1]);
  assert_int_equal(n[0], 1);
  assert_true(n[1] >= 4);
}

static void all_is_sound(void **state) {
  (void)state;
  scene_is_sound(three);
  scene_is_sound(one);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_peak_has_an_optimum),
      cmocka_unit_test(superharmonics_meet_higher_modes),
      cmocka_unit_test(one_harmonic_has_one_peak),
      cmocka_unit_test(all_is_sound),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
