/* cases/bladed_disc: forty blades on a disc that bends, beside the same blade with its root
 * clamped; the numbers of the README. */
#include "modal/model/nodal_diameters.h"
#include "tests/support/scene.h"

enum { CURVES = 5, RESONANCES = 3 };

/* Resonances: first on the disc, first with the root clamped, second on the disc. */
typedef struct {
  mhb_branch_kind kind;
  double          n0;                                    /* N */
  double          amplitude[RESONANCES], at[RESONANCES]; /* mm, Hz */
} row;

/* The table of the README, to its digits. */
static const row TABLE[CURVES] = {
    {MHB_BRANCH_OPEN, 0, {6.295, 5.881, .3279}, {115.06, 116.69, 234.39}},
    {MHB_BRANCH_NONLINEAR, 15, {.0807, .0683, .0891}, {141.39, 146.81, 238.42}},
    {MHB_BRANCH_NONLINEAR, 40, {.1366, .1252, .1858}, {154.96, 160.05, 237.64}},
    {MHB_BRANCH_NONLINEAR, 100, {.3010, .2837, .1858}, {158.50, 163.11, 237.64}},
    {MHB_BRANCH_STUCK, 0, {4.799, 4.372, .1858}, {159.97, 164.56, 237.64}}};

static char          folder[SCRATCH_PATH];
static mhb_response *disc, *clamped;

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "bladed_disc", &disc);
  scene_run(folder, SCENE, "clamped.yaml", "clamped_blade", &clamped);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(disc);
  mhb_response_destroy(clamped);
  scratch_remove(folder);
  return 0;
}

static void curves_are_sound(void **state) {
  (void)state;
  scene_is_sound(disc);
  scene_is_sound(clamped);
}

static void peaks_are_those_of_the_readme(void **state) {
  (void)state;
  for (int i = 0; i < CURVES; i++) {
    const row        *t                 = &TABLE[i];
    const mhb_branch *b                 = scene_branch(disc, t->kind, t->n0);
    const scene_peak  found[RESONANCES] = {
         scene_highest(disc, b, 91, 225),
         scene_highest(clamped, scene_branch(clamped, t->kind, t->n0), 91, 225),
         scene_highest(disc, b, 230, 269)};
    for (int r = 0; r < RESONANCES; r++) {
      print_message("%s at %g N, resonance %d: %.4f mm at %.2f Hz\n",
                    t->kind == MHB_BRANCH_NONLINEAR ? "curve" : "limit", t->n0, r,
                    1e3 * found[r].amplitude, found[r].frequency);
      assert_within(1e3 * found[r].amplitude, t->amplitude[r], 2e-3);
      assert_within(found[r].frequency, t->at[r], 2e-4);
    }
  }
}

static int verdict_at_peak(const mhb_response *response, double n0) {
  const mhb_branch *b = scene_branch(response, MHB_BRANCH_NONLINEAR, n0);
  return b->stable[scene_highest(response, b, 91, 269).point];
}

static void stability_is_that_of_the_readme(void **state) {
  (void)state;
  assert_int_equal(verdict_at_peak(disc, 15), 1);
  assert_int_equal(verdict_at_peak(disc, 40), 1);
  assert_int_equal(verdict_at_peak(disc, 100), 0);
  for (int i = 1; i <= 3; i++) assert_int_equal(verdict_at_peak(clamped, TABLE[i].n0), 0);
}

/* The clamped blade has no second resonance in the range. */
static void the_second_resonance_is_the_discs(void **state) {
  (void)state;
  const mhb_branch *b = scene_branch(clamped, MHB_BRANCH_OPEN, 0);
  for (int p = 1; p < b->n_points; p++)
    if (b->frequency[p] > 200)
      assert_true(scene_amplitude(clamped, b, p, 1) < scene_amplitude(clamped, b, p - 1, 1));
}

static void frequencies_over_the_nodal_diameter(void **state) {
  (void)state;
  enum { COLUMNS = 6 };
  const int    diameter[COLUMNS]  = {0, 2, 4, 6, 10, 20};
  const double first[COLUMNS + 1] = {115.45, 115.06, 116.38, 116.44, 116.49, 116.55, 116.69};
  const double then[COLUMNS + 1]  = {259.68, 234.39, 366.66, 372.32, 373.92, 374.43, 375.00};
  char         path[2 * SCRATCH_PATH];
  modal_nodal_diameters of;
  modal_model           blade;
  snprintf(path, sizeof path, "%s/bladed_disc.modal.h5", folder);
  assert_ok(modal_nodal_diameters_read(path, &of));
  snprintf(path, sizeof path, "%s/clamped_blade.modal.h5", folder);
  assert_ok(modal_model_read(path, &blade));
  assert_int_equal(of.blades, 40);
  for (int i = 0; i <= COLUMNS; i++) {
    const int at = i < COLUMNS ? modal_nodal_diameters_find(&of, diameter[i]) : 0;
    assert_true(at >= 0);
    const modal_model *m = i < COLUMNS ? &of.model[at] : &blade;
    assert_within(m->frequency[0], first[i], 1e-4);
    assert_within(m->frequency[1], then[i], 1e-4);
  }
  modal_nodal_diameters_free(&of);
  modal_model_free(&blade);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_are_sound),
      cmocka_unit_test(peaks_are_those_of_the_readme),
      cmocka_unit_test(stability_is_that_of_the_readme),
      cmocka_unit_test(the_second_resonance_is_the_discs),
      cmocka_unit_test(frequencies_over_the_nodal_diameter),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
