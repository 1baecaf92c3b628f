/* A run-up along an engine order. At three speeds its solutions are those of the blade at that
 * speed alone. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/response/response.h"
#include "tests/support/scratch.h"

enum { ORDER = 5, MAIN = 2 };

static char folder[SCRATCH_PATH];

static const char blade[] =
    "mesh:\n"
    "  blade:\n"
    "    root: {length: 68 mm, width: 35 mm, height: 18 mm}\n"
    "    sections:\n"
    "      - {radius: 250 mm, chord: 58 mm, thickness: 9.0 mm, camber: 11.0 mm, twist: -10 deg}\n"
    "      - {radius: 350 mm, chord: 50 mm, thickness: 6.2 mm, camber: 7.0 mm, twist: -28 deg}\n"
    "      - {radius: 445 mm, chord: 45 mm, thickness: 4.4 mm, camber: 4.2 mm, twist: -42 deg}\n"
    "    shroud: {length: 46 mm, thickness: 7 mm, contact: 24 mm}\n"
    "    elements: hex20\n"
    "    size: 20 mm\n"
    "    shroud_size: 10 mm\n"
    "material: {E: 210 GPa, nu: 0.3, rho: 7850}\n"
    "modal: {modes: 15, damping: 0.002}\n"
    "excitation: {engine_order: 5, pressure: 1 kPa, harmonics: {1: [1, 0 deg]}}\n"
    "probe: {tip: [0 mm, 0 mm, 452 mm]}\n";

static void run(const char *name, const char *stages, int expected) {
  char command[4 * SCRATCH_PATH];
  for (const char *stage = stages; *stage;) {
    int n = (int)strcspn(stage, " ");
    snprintf(command, sizeof command, "'%s' %.*s --quiet '%s/%s.yaml' > '%s/said' 2>&1", SHROUDHB,
             n, stage, folder, name, folder);
    int code = system(command);
    if (code != expected << 8) fail_msg("%s: %d, not %d", command, code, expected << 8);
    stage += n + (stage[n] == ' ');
  }
}

static void write_case(const char *name, const char *speed, const char *rest) {
  char text[4096], file[64];
  int  n = snprintf(text, sizeof text,
                    "name: %s\n%srotor: {blades: 40, speed: %s, axis: x}\n"
                     "contact: {to: neighbour, psi: 35 deg, phi: 0 deg, points: 1, mu: 0.3, "
                     "ku: 0.5 MN/m, kv: 0.8 MN/m, n0: 50 N}\n%s",
                    name, blade, speed, rest);
  snprintf(file, sizeof file, "%s.yaml", name);
  scratch_write(folder, file, text, (size_t)n);
}

static mhb_response *response_of(const char *name) {
  char          path[2 * SCRATCH_PATH];
  mhb_response *response;
  snprintf(path, sizeof path, "%s/%s.response.h5", folder, name);
  if (mhb_response_read(path, &response) != SHB_OK) fail_msg("%s", shb_message());
  return response;
}

static double apart(const double complex *a, const double complex *b, int n) {
  double sum = 0, size = 0;
  for (int i = 0; i < n; i++) {
    sum += pow(cabs(a[i] - b[i]), 2);
    size += pow(cabs(b[i]), 2);
  }
  return size > 0 ? sqrt(sum / size) : sqrt(sum);
}

/* Largest difference of the motions of contact and probe: at both ends of the preloads, on the
 * limits and on the curve. */
static double distance(const mhb_response *a, const mhb_response *b) {
  const int n3    = 3 * (a->n_harmonics + 1);
  double    worst = 0;
  for (int i = 0; i <= MAIN; i++)
    for (int end = 0; end < 2; end++) {
      const mhb_branch *p = &a->branch[i], *q = &b->branch[i];
      const int         j = end * (p->n_points - 1) * n3, k = end * (q->n_points - 1) * n3;
      worst = fmax(worst, apart(p->motion + j, q->motion + k, n3));
      worst = fmax(worst, apart(p->probe + j, q->probe + k, n3));
    }
  return worst;
}

/* At a fixed frequency, and thus speed, the preload is followed. */
static void at_speed(const char *name, const char *speed, double rpm, const char *run_up) {
  char rest[256];
  snprintf(rest, sizeof rest,
           "mhb: {frequency: %.17g Hz, vary: {n0: [20 N, 100 N]}, harmonics: 5, stability: "
           "never%s}\n",
           rpm * ORDER / 60, run_up);
  write_case(name, speed, rest);
}

static void solutions_are_those_of_each_speed(void **state) {
  (void)state;
  static const double rpm[] = {1500, 2250, 3000};
  static const struct {
    const char *name, *speed;
    double      bound[3]; /* 2250 rpm is one of seven speeds */
  } lists[] = {{"four", "{from: 900 rpm, to: 3600 rpm, points: 4}", {1e-4, 1e-4, 1e-4}},
               {"seven", "{from: 900 rpm, to: 3600 rpm, points: 7}", {2e-6, 1e-12, 2e-6}}};
  for (int i = 0; i < 3; i++) {
    char speed[64];
    snprintf(speed, sizeof speed, "%g rpm", rpm[i]);
    at_speed("alone", speed, rpm[i], "");
    run("alone", "mesh modal mhb", 0);
    mhb_response *alone = response_of("alone");
    assert_false(alone->run_up);
    for (int l = 0; l < 2; l++) {
      at_speed(lists[l].name, lists[l].speed, rpm[i], ", run_up: yes");
      run(lists[l].name, i == 0 ? "mesh modal mhb" : "mhb", 0);
      mhb_response *along = response_of(lists[l].name);
      double        off   = distance(along, alone);
      print_message("%g rpm, %s speeds: %.1e\n", rpm[i], lists[l].name, off);
      assert_true(along->run_up);
      if (!(off <= lists[l].bound[i])) fail_msg("%.1e, above %.1e", off, lists[l].bound[i]);
      mhb_response_destroy(along);
    }
    mhb_response_destroy(alone);
  }
}

static void a_sweep_covers_its_range(void **state) {
  (void)state;
  char path[2 * SCRATCH_PATH], command[4 * SCRATCH_PATH];
  write_case("seven", "{from: 900 rpm, to: 3600 rpm, points: 7}",
             "mhb: {frequency: [90 Hz, 290 Hz], harmonics: 3, run_up: yes}\n");
  run("seven", "mhb post", 0);
  mhb_response     *r = response_of("seven");
  const mhb_branch *b = &r->branch[MAIN];
  assert_true(b->complete);
  assert_true(b->frequency[0] == 90 && b->frequency[b->n_points - 1] == 290);
  mhb_response_destroy(r);
  snprintf(path, sizeof path, "%s/seven.html", folder);
  snprintf(command, sizeof command,
           "grep -q 'run-up: speed 1080 to 3480 rpm along E = 5' '%s' && grep -q ',speed_rpm,' "
           "'%s/seven.csv'",
           path, folder);
  assert_int_equal(system(command), 0);
}

static int make(void **state) {
  (void)state;
  scratch_create(folder);
  return 0;
}

static int clean(void **state) {
  (void)state;
  scratch_remove(folder);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(solutions_are_those_of_each_speed),
                                     cmocka_unit_test(a_sweep_covers_its_range)};
  return cmocka_run_group_tests(tests, make, clean);
}
