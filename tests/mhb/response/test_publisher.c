/* The publisher: when a file is due, and which failure of several threads is kept. */
#include "mhb/response/publisher.h"
#include "tests/support/check.h"

static void due(void **state) {
  (void)state;
  mhb_publisher p;
  mhb_publisher_start(&p, "never_written.h5", NULL);
  assert_false(mhb_publisher_is_due(&p, 1000));
  assert_true(mhb_publisher_is_due(&p, -1));
  assert_near(mhb_publisher_pause(&p, 10), 10, 1e-15);
  p.cost = 5; /* a large file is written less often */
  assert_near(mhb_publisher_pause(&p, 10), 100, 1e-15);
  assert_false(mhb_publisher_is_due(&p, -1));
  mhb_publisher_stop(&p);
  mhb_publisher_start(&p, NULL, NULL);
  assert_false(mhb_publisher_is_due(&p, -1));
  assert_ok(mhb_publisher_write(&p, NULL)); /* no file: nothing is written */
  mhb_publisher_stop(&p);
}

/* Each thread has its own message; the first failure is told on the thread that asks. */
static void first_failure(void **state) {
  (void)state;
  mhb_publisher p;
  mhb_publisher_start(&p, "never_written.h5", NULL);
  assert_ok(mhb_publisher_status(&p));
#pragma omp parallel num_threads(2)
  {
    shb_status status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "thread's failure");
    mhb_publisher_lock(&p, true);
    mhb_publisher_note(&p, SHB_OK);
    mhb_publisher_note(&p, status);
    mhb_publisher_lock(&p, false);
  }
  mhb_publisher_note(&p, shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "a later one"));
  assert_false(mhb_publisher_is_due(&p, -1));
  assert_refused(mhb_publisher_status(&p), SHB_ERR_INPUT, "thread's failure");
  mhb_publisher_stop(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(due),
      cmocka_unit_test(first_failure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
