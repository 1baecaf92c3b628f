/* Points by time integration beside the curves of the balance: starts, sweeps that jump, motion
 * that does not repeat, the file. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/integration/integration_sweep.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

static mhb_integration_settings asked(mhb_integration_start start, int n) {
  return (mhb_integration_settings){.n_frequencies = n,
                                    .start         = start,
                                    .direction     = MHB_SWEEP_BOTH,
                                    .steps         = 32,
                                    .tolerance     = 1e-6,
                                    .max_periods   = 3000};
}

static mhb_response *witness(const modal_model *model, const mhb_settings *s,
                             const mhb_integration_settings *a, const mhb_response *balance) {
  mhb_response *response;
  if (mhb_integration_sweep(model, s, a, balance, NULL, NULL, NULL, &response) != SHB_OK)
    fail_msg("%s", shb_message());
  return response;
}

static double first(const mhb_branch *b, int point, int component) {
  return cabs(b->motion[(point * 3 + component) * (b->n_harmonics + 1) + 1]);
}

static mhb_settings three_degree_settings(int harmonics) {
  mhb_settings s = ground_settings(.4, .8, .5, -.2, harmonics);
  s.n_preloads   = 3;
  s.n0[1]        = 0;
  s.n0[2]        = .3;
  s.frequency[0] = .8 / SHB_TWO_PI;
  s.frequency[1] = 1.6 / SHB_TWO_PI;
  return s;
}

/* Largest difference of the first harmonics of a point from the balance that Newton's method finds
 * from them, relative. */
static double off_balance(const modal_model *model, const mhb_settings *s, const mhb_branch *b,
                          int point) {
  int          K = b->n_harmonics + 1, nb = 2 * K - 1;
  double       x[3 * nb], away = 0, size = 0;
  mhb_settings one = *s;
  periodic     at;
  one.n_preloads = 1;
  one.n0[0]      = b->n0[point];
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < K; k++) {
      double complex a                = b->motion[(point * 3 + c) * K + k];
      x[c * nb + (k ? 2 * k - 1 : 0)] = creal(a);
      if (k) x[c * nb + 2 * k] = cimag(a);
    }
  periodic_create(model, &one, SHB_TWO_PI * b->frequency[point], x, &at);
  for (int c = 0; c < 3; c++) {
    double wanted = hypot(at.x[c * nb + 1], at.x[c * nb + 2]);
    away          = fmax(away, fabs(first(b, point, c) - wanted));
    size          = fmax(size, wanted);
  }
  periodic_destroy(&at);
  return away / size;
}

/* On every stable solution, where it is, of three degrees (open to stuck) and of the beam: against
 * the balance of 31 harmonics. */
static void on_the_balance(void **state) {
  (void)state;
  for (int scene = 0; scene < 2; scene++) {
    modal_model              model;
    mhb_settings             s = three_degree_settings(31);
    mhb_integration_settings a = asked(MHB_START_FROM_BALANCE, 9);
    mhb_response            *balance;
    double                   worst = 0;
    if (scene == 0) three_degree_model(&model);
    if (scene == 1) {
      tip_contact_beam_model(8, &model);
      s              = ground_settings(.3, 2e5, 2e5, 100, 31);
      s.frequency[0] = 240;
      s.frequency[1] = 280;
    }
    assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &balance), SHB_OK);
    mhb_response *r = witness(&model, &s, &a, balance);
    assert_int_equal(r->n_branches, s.n_preloads);
    assert_int_equal(r->n_harmonics, 31);
    for (int i = 0; i < r->n_branches; i++) {
      const mhb_branch *b = &r->branch[i];
      assert_int_equal(b->kind, MHB_BRANCH_INTEGRATION);
      assert_true(b->complete && b->n_points >= 9);
      for (int p = 0; p < b->n_points; p++) {
        assert_true(b->multiple[p] == 1 && b->stable[p] == 1 && b->periods[p] > 1);
        assert_true(b->error_sampling[p] >= 0 && b->error_sampling[p] < 1e-6);
        assert_true(b->distance[p] < 1e-6);
        assert_int_equal(b->mark[p], 0); /* a pair that sticks alone loads no other */
        worst = fmax(worst, off_balance(&model, &s, b, p));
      }
    }
    print_message("%s: worst difference %.1e\n", scene ? "beam" : "three degrees", worst);
    assert_true(worst < 1e-5);
    mhb_response_destroy(r);
    mhb_response_destroy(balance);
    modal_model_free(&model);
  }
}

/* One degree with a gap: up and down jump at different frequencies, near the folds 1.389887 and
 * 1.093215. */
static void sweeps_that_jump(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(.3, 9, 1, -4.5, 31);
  one_degree_model(.02, 0, .1, &model);
  s.frequency[0]             = 1.05 / SHB_TWO_PI;
  s.frequency[1]             = 1.45 / SHB_TWO_PI;
  mhb_integration_settings a = asked(MHB_START_FROM_STATE, 81); /* .005 rad/s */
  mhb_response            *r = witness(&model, &s, &a, NULL);
  assert_int_equal(r->n_branches, 2);
  double jump[2] = {0, 0};
  for (int i = 0; i < 2; i++) {
    const mhb_branch *b    = &r->branch[i];
    double            most = 0;
    assert_int_equal(b->n_points, 81);
    for (int p = 1; p < 81; p++) {
      double change = fabs(first(b, p, 0) - first(b, p - 1, 0));
      if (change < most) continue;
      most    = change;
      jump[i] = SHB_PI * (b->frequency[p] + b->frequency[p - 1]);
    }
  }
  print_message("jumps: up %.4f, down %.4f rad/s\n", jump[0], jump[1]);
  assert_true(fabs(jump[0] - 1.389887) < .006);
  assert_true(fabs(jump[1] - 1.093215) < .006);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* Not periodic is an answer, with its lines; and all of it is in the file. */
static void adrift(void **state) {
  (void)state;
  char          *path = strdup("/tmp/shroudhb_witness_XXXXXX");
  int            fd   = mkstemp(path);
  modal_model    model;
  mhb_settings   s    = ground_settings(.4, .8, .5, .1, 7);
  shb_provenance from = {"case.yaml", "text", "settings", "test"};
  three_degree_model(&model);
  s.frequency[0]             = .8 / SHB_TWO_PI;
  s.frequency[1]             = 1.6 / SHB_TWO_PI;
  mhb_integration_settings a = asked(MHB_START_FROM_REST, 2);
  mhb_response            *r, *read;
  assert_true(fd >= 0);
  close(fd);
  a.listed       = true;
  a.frequency[0] = 1.0 / SHB_TWO_PI;
  a.frequency[1] = 1.25 / SHB_TWO_PI;
  assert_int_equal(mhb_integration_sweep(&model, &s, &a, NULL, path, &from, NULL, &r), SHB_OK);
  assert_int_equal(mhb_response_read(path, &read), SHB_OK);
  const mhb_branch *b = &read->branch[0];
  assert_int_equal(b->n_points, 2);
  assert_int_equal(b->multiple[0], 1);
  assert_int_equal(b->multiple[1], 0);
  assert_int_equal(b->stable[1], -1);
  assert_true(b->distance[1] > 1e-3);
  assert_true(b->line_amplitude[0] == 0);
  const double *hz = b->line_frequency + read->n_lines, *lines = b->line_amplitude + read->n_lines;
  print_message("lines: %.5f Hz %.4f m, %.5f Hz %.4f m, %.5f Hz %.4f m\n", hz[0], lines[0], hz[1],
                lines[1], hz[2], lines[2]);
  assert_true(lines[0] > lines[1] && lines[1] > lines[2] && lines[2] > 0);
  assert_true(fabs(hz[0] - a.frequency[1]) <
              .002 * a.frequency[1]); /* the excitation's is the largest */
  for (int k = 0; k < 2; k++)
    assert_true(b->line_amplitude[read->n_lines + k] ==
                r->branch[0].line_amplitude[read->n_lines + k]);
  assert_memory_equal(b->motion, r->branch[0].motion, 2 * 3 * 8 * sizeof *b->motion);
  mhb_response_destroy(read);
  mhb_response_destroy(r);
  unlink(path);
  free(path);
  modal_model_free(&model);
}

/* Points go to a response of another number of harmonics. */
static void merged(void **state) {
  (void)state;
  modal_model              model;
  mhb_settings             s = three_degree_settings(5);
  mhb_integration_settings a = asked(MHB_START_FROM_REST, 2);
  mhb_response            *balance, *less, *other = mhb_response_create(2, 0, 5);
  three_degree_model(&model);
  assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &balance), SHB_OK);
  a.harmonics     = 3;
  mhb_response *r = witness(&model, &s, &a, NULL);
  a.harmonics     = 9;
  less            = witness(&model, &s, &a, NULL);
  int    n        = balance->n_branches;
  double wanted   = first(&r->branch[1], 1, 1);
  assert_int_equal(mhb_response_merge(balance, r), SHB_OK);
  assert_int_equal(mhb_response_merge(balance, less), SHB_OK);
  assert_int_equal(balance->n_branches, n + 6);
  assert_int_equal(r->n_branches, 0);
  assert_true(first(&balance->branch[n + 1], 1, 1) == wanted);
  assert_true(fabs(first(&balance->branch[n + 4], 1, 1) - wanted) < 1e-5 * wanted);
  assert_int_equal(balance->branch[n + 1].n_harmonics, 3);
  assert_int_equal(balance->branch[n + 4].main, n + 4);
  assert_int_equal(mhb_response_merge(other, balance), SHB_ERR_INPUT);
  mhb_response_destroy(balance);
  mhb_response_destroy(other);
  mhb_response_destroy(less);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static void faults(void **state) {
  (void)state;
  modal_model              model;
  mhb_settings             s = three_degree_settings(3);
  mhb_integration_settings a = asked(MHB_START_FROM_BALANCE, 3);
  mhb_response            *balance, *r;
  three_degree_model(&model);
  assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &balance), SHB_OK);
  s.n0[1] = .17;
  assert_int_equal(mhb_integration_sweep(&model, &s, &a, balance, NULL, NULL, NULL, &r),
                   SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "no curve at n0 = 0.17 N"));
  s.to_ground = false;
  a.start     = MHB_START_FROM_REST;
  assert_int_equal(mhb_integration_sweep(&model, &s, &a, NULL, NULL, NULL, NULL, &r),
                   SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "set it to ground"));
  mhb_response_destroy(balance);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(on_the_balance),
                                     cmocka_unit_test(sweeps_that_jump), cmocka_unit_test(adrift),
                                     cmocka_unit_test(merged), cmocka_unit_test(faults)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
