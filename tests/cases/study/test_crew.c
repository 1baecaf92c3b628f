/* The manager without workers: it computes every job itself, in order, and stops at an error. */
#include "cases/study/crew.h"

#include <mpi.h>

#include "tests/support/check.h"

enum { JOBS = 5 };

/* Job k has the values k and k^2; its answer is their sum. */
typedef struct {
  int    next, ticks, computed, fails_at; /* fails_at: of compute; -1: never */
  double value[2], answer[JOBS];
  int    stop_tick; /* the tick that ends the work; -1: none */
} work;

static int next(void *context, const double **value) {
  work *w = context;
  if (w->next == JOBS) return -1;
  w->value[0] = w->next;
  w->value[1] = w->next * w->next;
  *value      = w->value;
  return w->next++;
}

static shb_status done(void *context, int job, const char *bytes, size_t size) {
  work *w = context;
  assert_int_equal(size, sizeof(double));
  memcpy(&w->answer[job], bytes, size);
  return SHB_OK;
}

static shb_status tick(void *context) {
  work *w = context;
  SHB_CHECK(w->ticks++ != w->stop_tick, SHB_INTERRUPTED, "stopped");
  return SHB_OK;
}

static shb_status compute(void *context, const double *value, char **bytes, size_t *size) {
  work        *w   = context;
  const double sum = value[0] + value[1];
  SHB_CHECK(w->computed++ != w->fails_at, SHB_ERR_IO, "no answer");
  *size  = sizeof sum;
  *bytes = malloc(sizeof sum);
  memcpy(*bytes, &sum, sizeof sum);
  return SHB_OK;
}

static shb_status manage(work *w) {
  const crew_work     all      = {w, next, done, tick};
  const crew_computer computer = {w, 2, compute};
  return crew_manage(&all, &computer);
}

static void every_job_is_computed_once(void **state) {
  (void)state;
  work w = {.fails_at = -1, .stop_tick = -1};
  assert_ok(manage(&w));
  assert_int_equal(w.computed, JOBS);
  assert_int_equal(w.ticks, JOBS);
  for (int k = 0; k < JOBS; k++) assert_near(w.answer[k], k + k * k, 0);
}

static void an_error_ends_the_work(void **state) {
  (void)state;
  work failed = {.fails_at = 2, .stop_tick = -1}, stopped = {.fails_at = -1, .stop_tick = 3};
  assert_refused(manage(&failed), SHB_ERR_IO, "no answer");
  assert_int_equal(failed.next, 3);
  assert_refused(manage(&stopped), SHB_INTERRUPTED, "stopped");
  assert_int_equal(stopped.computed, 4);
  assert_near(stopped.answer[3], 12, 0); /* what was computed is not lost */
}

static void one_process_computes(void **state) {
  (void)state;
  assert_int_equal(crew_workers(), 1);
  assert_int_equal(crew_sharing(), 1);
  crew_dismiss(); /* nobody is there */
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_job_is_computed_once),
      cmocka_unit_test(an_error_ends_the_work),
      cmocka_unit_test(one_process_computes),
  };
  MPI_Init(&argc, &argv);
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  MPI_Finalize();
  return failed;
}
