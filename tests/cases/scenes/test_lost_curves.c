/* Light damping, weak preload, large motion: cases of the blade of cases/paper_fig8 with
 * tetrahedra. Their curves are hard to trace. Where slip ends in two directions at once, the mean
 * friction varies with the square root of the distance. The first solution at the low end may lie
 * on a closed curve, or on one that turns back before the high end. */
#include "tests/support/scene.h"

#include <stdlib.h>

typedef struct {
  const char *what, *psi, *ku, *kv, *n0, *range;
  const char *aside; /* end of the curve at which the range begins; NULL: it is the main one */
} lost;

static char folder[SCRATCH_PATH], source[SCRATCH_PATH];

static int prepare(void **state) {
  (void)state;
  scratch_create(folder);
  scratch_create(source);
  return 0;
}

static int clean(void **state) {
  (void)state;
  scratch_remove(folder);
  scratch_remove(source);
  return 0;
}

/* Writes the example with changed keys. */
static void write_case(const lost *l) {
  char line[8 * SCRATCH_PATH];
  snprintf(line, sizeof line,
           "sed -e 's/^name: .*/name: lost/' -e 's/damping: 0.005/damping: 0.002/'"
           " -e 's/engine_order: 8/engine_order: 10/' -e 's/\\[10 N, 0 N, 0 N\\]/[1 N, 1 N, 0 N]/'"
           " -e 's/psi: 35 deg/psi: %s deg/' -e 's/ku: 2 /ku: %s /' -e 's/kv: 3 /kv: %s /'"
           " -e 's/n0: .*/n0: %s N/' -e 's/^    size: .*/    size: 11 mm\\n    shroud_size: 6 "
           "mm\\n    elements: tet10/'"
           " -e 's/frequency: .*/frequency: %s/' '%s/case.yaml' > "
           "'%s/lost.yaml'",
           l->psi, l->ku, l->kv, l->n0, l->range, SCENE, source);
  if (system(line) != 0) fail_msg("failed: %s", line);
}

/* Every frequency of the range has a point near it on the branch that reaches both ends. */
static void covers(const mhb_branch *b, double low, double high) {
  assert_true(b->complete);
  assert_string_equal(b->reason, "end of range");
  assert_within(b->frequency[0], low, 1e-12);
  assert_within(b->frequency[b->n_points - 1], high, 1e-12);
  for (int i = 1; i < b->n_points; i++)
    assert_true(fabs(b->frequency[i] - b->frequency[i - 1]) <= .11 * (high - low));
}

static void no_curve_is_lost(void **state) {
  (void)state;
  static const lost scene[] = {
      {"slip ends in two directions", "0", "2", "3", "30", "[323.1 Hz, 473.88 Hz]", NULL},
      {"it turns back", "20", "2", "3", "0.3", "[322.5 Hz, 473 Hz]",
       "turned back to the start of the range"},
      {"it is closed", "35", "2", "3", "0.3", "[828.375 Hz, 1214.95 Hz]", "closed curve"},
      {"a closed one beside it", "35", "5", "8", "0.3", "[684.225 Hz, 1003.53 Hz]", NULL},
  };
  for (int i = 0; i < 4; i++) {
    mhb_response *r;
    double        low, high;
    write_case(&scene[i]);
    scene_run(folder, source, "lost.yaml", "lost", &r);
    scene_is_sound(r);
    assert_int_equal(sscanf(scene[i].range, "[%lf Hz, %lf", &low, &high), 2);
    covers(&r->branch[2], low, high);
    print_message("%s: %d points, %d curves beside\n", scene[i].what, r->branch[2].n_points,
                  r->n_branches - 3);
    assert_int_equal(r->n_branches, scene[i].aside ? 4 : 3);
    if (scene[i].aside) {
      const mhb_branch *b = &r->branch[3];
      assert_true(b->origin == MHB_FROM_DETACHED && b->main == 2 && b->complete);
      assert_string_equal(b->reason, scene[i].aside);
      assert_within(b->frequency[0], low, 1e-12);
      assert_within(b->frequency[b->n_points - 1], low, 1e-12);
    }
    mhb_response_destroy(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_curve_is_lost)};
  return cmocka_run_group_tests(tests, prepare, clean);
}
