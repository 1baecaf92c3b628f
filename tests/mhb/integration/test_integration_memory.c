/* The memory that time integration is foreseen to take, against that of runs, and what is
 * refused. */
#include "mhb/integration/integration_memory.h"

#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/memory.h"
#include "mhb/integration/integration_sweep.h"
#include "tests/support/check.h"
#include "tests/support/little_memory.h"
#include "tests/support/random_model.h"

enum { LEAST_MB = 8 };

typedef struct {
  const char *name;
  int         pairs, blades, harmonics, points; /* blades 1: on the ground */
  bool        residual, coriolis;
} scene;

static mhb_settings make(const scene *c, modal_model *model) {
  mhb_settings s = random_settings(c->harmonics);
  random_model(c->pairs, (c->blades > 1 ? WITH_LEFT : 0) | (c->residual ? WITH_RESIDUAL : 0), 5,
               model);
  free(model->residual_fourth); /* three random terms are no sums over modes */
  model->residual_fourth = NULL;
  if (c->coriolis) {
    const int m     = model->n_modes;
    model->coriolis = calloc((size_t)(m * m), sizeof *model->coriolis);
    for (int i = 1; i < m; i++)
      model->coriolis[i] = -(model->coriolis[i * m] = 0.1 * i); /* of mode 0 with the others */
  }
  s.blades       = c->blades;
  s.to_ground    = c->blades == 1;
  s.frequency[0] = 0.10;
  s.frequency[1] = 0.11;
  return s;
}

/* Most memory of a process of its own, bytes. */
static double peak_of(const scene *c) {
  int         status;
  const pid_t child = fork();
  if (child == 0) {
    const mhb_integration_settings few = {.n_frequencies = c->points,
                                          .start         = MHB_START_FROM_REST,
                                          .steps         = 2,
                                          .tolerance     = 1e-2,
                                          .max_periods   = 2};
    modal_model                    model;
    mhb_response                  *response;
    const mhb_settings             s = make(c, &model);
    if (mhb_integration_sweep(&model, &s, &few, NULL, NULL, NULL, NULL, &response) != SHB_OK) {
      fprintf(stderr, "%s\n", shb_message());
      _exit(1);
    }
    _exit(0);
  }
  struct rusage used;
  assert_int_equal(wait4(child, &status, 0, &used), child);
  assert_int_equal(status, 0);
  return 1024. * (double)used.ru_maxrss;
}

/* Bytes above those of a small run; told and measured agree within the band. */
static void memory_is_that_of_runs(void **state) {
  (void)state;
  static const scene rows[] = {
      {"one blade, 90 contact points", 90, 1, 9, 1, false, false},
      {"50 with residual terms", 50, 1, 9, 1, true, false},
      {"the same with Coriolis terms", 50, 1, 9, 1, true, true},
      {"one blade, 200 harmonics", 30, 1, 200, 1, false, false},
      {"one blade, 3000 points", 1, 1, 40, 3000, false, false},
      {"ring of 4 blades, 50 each", 50, 4, 9, 1, false, false},
      {"60 each with residual terms", 60, 4, 9, 1, true, false},
  };
  static const scene least   = {"", 1, 1, 1, 1, false, false};
  const double       base    = peak_of(&least);
  int                outside = 0; /* of the band */
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    modal_model                model;
    const mhb_settings         s = make(&rows[i], &model);
    const mhb_integration_size size =
        mhb_integration_size_of(&model, &s, rows[i].harmonics, rows[i].points);
    const double told     = 1e-6 * mhb_integration_bytes(&size);
    const double measured = 1e-6 * (peak_of(&rows[i]) - base);
    printf("%-30s told %6.1f MB, measured %6.1f MB, ratio %.2f\n", rows[i].name, told, measured,
           told / measured);
    assert_true(measured > LEAST_MB);
    outside += !(told > 0.8 * measured && told < 1.5 * measured);
    modal_model_free(&model);
  }
  assert_int_equal(outside, 0);
}

/* Bytes rise with every size. */
static void more_takes_more(void **state) {
  (void)state;
  static const mhb_integration_size size = {
      .pairs = 9, .blades = 12, .both = true, .modes = 6, .probes = 1, .harmonics = 7, .points = 5};
  for (int i = 0; i < 10; i++) {
    mhb_integration_size more = size;
    if (i == 0) more.pairs++;
    if (i == 1) more.blades++;
    if (i == 2) more.dense = true;
    if (i == 3) more.inertia = true;
    if (i == 4) more.modes++;
    if (i == 5) more.probes++;
    if (i == 6) more.harmonics++;
    if (i == 7) more.points++;
    if (i == 8) more.residual = true;
    if (i == 9) more.coriolis = true;
    assert_true(mhb_integration_bytes(&more) > mhb_integration_bytes(&size));
  }
}

/* In a process with little address space: what does not fit is refused, with the largest that does;
 * no more threads run than fit. */
static void too_large_is_refused(void) {
  static const char *const key[] = {
      "contact.points: ", "integrate.harmonics: ", "rotor.blades: ", " or points: "};
  const scene          ring = {"", 60, 50, 60, 9000, true, false};
  modal_model          model;
  int                  threads;
  const mhb_settings   s    = make(&ring, &model);
  mhb_integration_size size = mhb_integration_size_of(&model, &s, 60, 9000);
  double               left = little_memory_limit(0.5e9);
  assert_int_equal(mhb_integration_threads(&size, &threads), SHB_ERR_INPUT);
  puts(shb_message());
  assert_null(strchr(shb_message(), '\n'));
  assert_non_null(
      strstr(shb_message(), "50 blades, 60 contact points, 60 harmonics and 9000 points"));
  mhb_integration_size less      = size;
  int *const           members[] = {&less.pairs, &less.harmonics, &less.blades, &less.points};
  for (int i = 0; i < 4; i++) {
    less = size;
    if (!strstr(shb_message(), key[i])) { /* not even the least fits */
      *members[i] = i == 2 ? 2 : 1;
      assert_true(mhb_integration_bytes(&less) > left - 2e6);
      continue;
    }
    *members[i] = little_memory_number(key[i]);
    assert_true(mhb_integration_bytes(&less) <= left + 2e6);
    ++*members[i];
    assert_true(mhb_integration_bytes(&less) > left - 2e6);
  }
  size.points  = 1;
  size.threads = 1000;
  size.pairs   = 10;
  assert_int_equal(mhb_integration_threads(&size, &threads), SHB_OK);
  printf("%d of 1000 threads\n", threads);
  assert_true(threads > 1 && threads < 1000);
  modal_model_free(&model);
}

static void what_does_not_fit_is_refused(void **state) {
  (void)state;
  little_memory_run(too_large_is_refused);
}

int main(void) {
  omp_set_num_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_that_of_runs),
      cmocka_unit_test(more_takes_more),
      cmocka_unit_test(what_does_not_fit_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
