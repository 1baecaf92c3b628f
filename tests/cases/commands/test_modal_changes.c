/* Which changes of a case keep the modes of its modal file. */
#include "cases/commands/modal_changes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/support/check.h"

static const char earlier[] =
    "material.E = 210000000000\n"
    "modal.damping = 0.002\n"
    "excitation.traction = 1 -2 4\n"
    "excitation.harmonics.1 = 1 0\n"
    "excitation.harmonics.3 = 0.5 0.5\n"
    "mesh.fingerprint = 7e9bb00d60d5ed27\n";

/* The earlier settings with one text replaced by another. */
static bool kept(const char *from, const char *to, modal_revision *out) {
  char        text[512];
  const char *at = strstr(earlier, from);
  assert_non_null(at);
  snprintf(text, sizeof text, "%.*s%s%s", (int)(at - earlier), earlier, to, at + strlen(from));
  return modal_changes_find(earlier, text, out);
}

static void damping_and_amplitude_keep_the_modes(void **state) {
  (void)state;
  modal_revision r;
  assert_true(kept("0.002", "rayleigh 3 1e-6", &r));
  assert_true(r.ratio[0] == 1 && r.ratio[1] == 1 && r.ratio[64] == 1);
  assert_true(kept("1 -2 4", "-0.5 1 -2", &r));
  assert_true(r.ratio[0] == -0.5 && r.ratio[1] == -0.5 && r.ratio[3] == -0.5);
  assert_true(kept("harmonics.3 = 0.5 0.5", "harmonics.3 = 0 1", &r));
  assert_true(r.ratio[1] == 1 && cabs(r.ratio[3] - CMPLX(1, 1)) < 1e-15);
}

static void other_changes_do_not(void **state) {
  (void)state;
  modal_revision r;
  assert_false(kept("210000000000", "200000000000", &r));
  assert_false(kept("7e9b", "7e9c", &r));
  assert_false(kept("1 -2 4", "1 -2 5", &r)); /* not parallel */
  assert_false(kept("1 -2 4", "0 0 0", &r));  /* the way back would divide by zero */
  assert_false(kept("1 -2 4", "2 -4", &r));   /* another kind */
  assert_false(kept("0.5 0.5", "0 0", &r));
  assert_false(kept("harmonics.3", "harmonics.4", &r));
  assert_false(kept("excitation.harmonics.3 = 0.5 0.5\n", "", &r));
  assert_false(kept("mesh.fin", "probe.tip = 0 0 1\nmesh.fin", &r));
  assert_false(modal_changes_find(earlier, "", &r));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damping_and_amplitude_keep_the_modes),
      cmocka_unit_test(other_changes_do_not),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
