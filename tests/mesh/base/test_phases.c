/* Phases of a stage: time, sums, and peak of memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "mesh/base/clock.h"
#include "mesh/base/phases.h"
#include "mesh/base/progress.h"

/* Use the processor, then wait, until both times have passed. */
static void spend(double busy, double idle) {
  shb_phases watch;
  shb_phase  taken = {0};
  shb_phases_start(&watch);
  while (taken.cpu < busy) {
    shb_phases copy = watch;
    taken           = shb_phases_lap(&copy, "");
  }
  for (double end = shb_seconds() + idle; shb_seconds() < end;) {
    struct timespec nap = {0, 1000000};
    nanosleep(&nap, NULL);
  }
}

/* Processor and wall-clock time are separate; a phase begins where the last ended. */
static void laps_follow_each_other(void **state) {
  (void)state;
  shb_phases phases;
  double     began = shb_seconds();
  shb_phases_start(&phases);
  spend(.02, 0);
  shb_phase busy = shb_phases_lap(&phases, "busy");
  spend(0, .05);
  shb_phase idle  = shb_phases_lap(&phases, "idle");
  double    whole = shb_seconds() - began;
  assert_true(busy.cpu >= .02 && busy.seconds >= .02);
  assert_true(idle.seconds >= .05 && idle.cpu < .04);
  assert_true(busy.seconds + idle.seconds <= whole);
  assert_true(phases.n == 0); /* a lap alone keeps nothing */
}

/* Touching 48 MB raises the peak by as much; the peak stays after they are freed. */
static void peak_is_of_this_program(void **state) {
  (void)state;
  const size_t size   = 48 << 20;
  const double before = shb_memory_peak();
  char        *block  = malloc(size);
  assert_non_null(block);
  memset(block, 1, size);
  assert_true(block[size / 2] == 1);
  const double during = shb_memory_peak();
  free(block);
  assert_true(during - before > .9 * (double)size);
  assert_true(during < 4e8);                     /* not the peak of the parent process */
  assert_true(shb_memory_peak() > during - 1e6); /* the kernel counts pages in batches */
}

static void same_names_count_together(void **state) {
  (void)state;
  shb_phases phases = {0};
  shb_phases_add(&phases, &(shb_phase){"factor", 1.5, 2.5, 300, 200});
  shb_phases_add(&phases, &(shb_phase){"modes", 4, 5, 700, 400});
  shb_phases_add(&phases, &(shb_phase){"factor", .25, .125, 800, 100});
  assert_int_equal(phases.n, 2);
  assert_string_equal(phases.phase[1].name, "modes");
  assert_true(phases.phase[0].seconds == 1.75 && phases.phase[0].cpu == 2.625);
  assert_true(phases.phase[0].memory == 800 && phases.phase[0].greatest == 200);
}

/* More names than fit are left out without harm. */
static void room_is_kept(void **state) {
  (void)state;
  static const char names[] = "abcdefghijklmnopqrstuvwxyz";
  shb_phases        phases  = {0};
  for (int i = 0; i < 26; i++) shb_phases_add(&phases, &(shb_phase){names + i, 1, 1, 1, 1});
  assert_int_equal(phases.n, SHB_MAX_PHASES);
  shb_phases_add(&phases, &(shb_phase){names, 1, 1, 1, 1});
  assert_true(phases.phase[0].seconds == 2);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(laps_follow_each_other), cmocka_unit_test(peak_is_of_this_program),
      cmocka_unit_test(same_names_count_together), cmocka_unit_test(room_is_kept)};
  return cmocka_run_group_tests_name("mesh.phases", tests, NULL, NULL);
}
