/* Completion of a branch: its reason, hairline folds, stability by folds, interruption. */
#include "mhb/branches/branch_completion.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/point_lists.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 1 };

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_balance  *balance;
  mhb_response *response;
  mhb_tracer   *tracer;
  quiet_monitor monitor;
  mhb_chain     chain;
} fixture;

/* A branch of one segment of n values, Hz, without stability by multipliers. */
static mhb_branch *set_up(fixture *f, int n, const double *value) {
  one_degree_model(0.02, 1, 0.1, &f->model);
  f->settings              = ground_settings(0.3, 1, 1, 1, H);
  f->settings.frequency[0] = 0.1;
  f->settings.frequency[1] = 0.3;
  f->settings.stability    = MHB_STABILITY_NEVER;
  f->monitor               = quiet_monitor_create(0);
  f->chain                 = (mhb_chain){0};
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  f->response = mhb_response_create(1, 1, H);
  assert_non_null(f->response);
  mhb_response_branch(f->response, MHB_BRANCH_NONLINEAR);
  assert_ok(mhb_tracer_create(f->balance, f->response, 0, false, &f->monitor.base, &f->tracer));
  int segment = add_point_list(f->tracer->store, n, value);
  mhb_chain_insert(&f->chain, 0, (mhb_link){.segment = segment});
  return &f->tracer->store->branch[segment];
}

static mhb_branch *complete(fixture *f, mhb_completion *c) {
  assert_ok(mhb_branch_complete(f->tracer, &f->chain, f->response, 0, c));
  return &f->response->branch[0];
}

static void tear_down(fixture *f) {
  mhb_chain_free(&f->chain);
  mhb_tracer_destroy(f->tracer);
  mhb_response_destroy(f->response);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static const double VALUES[] = {0.1, 0.15, 0.2, 0.25, 0.3};

static void the_reason_is_that_of_the_end(void **state) {
  (void)state;
  for (int end = MHB_END_HIGH; end < MHB_N_ENDS; end++) {
    fixture        f;
    mhb_completion c = {.end = (mhb_end)end};
    set_up(&f, 5, VALUES);
    const mhb_branch *branch = complete(&f, &c);
    assert_int_equal(branch->n_points, 5);
    assert_has(branch->reason, mhb_end_text((mhb_end)end));
    if (end == MHB_END_MAX_POINTS) assert_has(branch->reason, "5 points, the last at 0.3 Hz");
    assert_true(branch->complete == (end == MHB_END_HIGH || end == MHB_END_LOW ||
                                     end == MHB_END_CLOSED || end == MHB_END_JOINED));
    assert_true(c.interrupted == (end == MHB_END_INTERRUPTED));
    tear_down(&f);
  }
}

static void gaps_are_told(void **state) {
  (void)state;
  for (int n = 1; n < 3; n++) {
    fixture        f;
    mhb_completion c = {.end = MHB_END_HIGH, .n_gaps = n, .first_gap = "no step at 0.2 Hz"};
    set_up(&f, 5, VALUES);
    const mhb_branch *branch = complete(&f, &c);
    assert_string_equal(branch->reason, n == 1 ? "end of range, with 1 gap: no step at 0.2 Hz"
                                               : "end of range, with 2 gaps: no step at 0.2 Hz");
    assert_false(branch->complete);
    tear_down(&f);
  }
}

/* A reason of its own stands for that of the end, unless the tracing was interrupted. */
static void a_reason_of_its_own(void **state) {
  (void)state;
  for (int interrupted = 0; interrupted < 2; interrupted++) {
    fixture        f;
    mhb_completion c = {.end          = interrupted ? MHB_END_INTERRUPTED : MHB_END_LOW,
                        .other_reason = "nothing beyond"};
    set_up(&f, 5, VALUES);
    const mhb_branch *branch = complete(&f, &c);
    assert_string_equal(branch->reason, interrupted ? "interrupted" : "nothing beyond");
    assert_false(branch->complete);
    tear_down(&f);
  }
}

/* Two folds nearer than 1e-5 of the value are no jump that anyone could observe. */
static void hairline_folds_are_unmarked(void **state) {
  (void)state;
  static const double value[] = {0.1, 0.2, 0.2 - 1e-7, 0.22, 0.25, 0.24, 0.3};
  fixture             f;
  mhb_completion      c       = {.end = MHB_END_HIGH};
  mhb_branch         *segment = set_up(&f, 7, value);
  segment->special[1] = segment->special[2] = MHB_FOLD;
  segment->special[4] = segment->special[5] = MHB_FOLD;
  segment->special[3]                       = MHB_PEAK;
  const mhb_branch *branch                  = complete(&f, &c);
  static const int  wanted[]                = {0, 0, 0, MHB_PEAK, MHB_FOLD, MHB_FOLD, 0};
  for (int i = 0; i < 7; i++) assert_int_equal(branch->special[i], wanted[i]);
  tear_down(&f);
}

/* A hairline beside a third fold: the first two go. */
static void of_three_folds_one_is_left(void **state) {
  (void)state;
  static const double value[] = {0.2, 0.2 + 1e-7, 0.2 + 2e-7};
  fixture             f;
  mhb_completion      c       = {.end = MHB_END_HIGH};
  mhb_branch         *segment = set_up(&f, 3, value);
  for (int i = 0; i < 3; i++) segment->special[i] = MHB_FOLD;
  const mhb_branch *branch = complete(&f, &c);
  assert_int_equal(branch->special[0], MHB_ORDINARY);
  assert_int_equal(branch->special[1], MHB_ORDINARY);
  assert_int_equal(branch->special[2], MHB_FOLD);
  tear_down(&f);
}

/* Between a pair of folds the solutions are unstable; nothing else is claimed. */
static void stability_goes_by_folds(void **state) {
  (void)state;
  for (int by_folds = 0; by_folds < 2; by_folds++) {
    fixture        f;
    mhb_completion c       = {.end = MHB_END_HIGH, .by_folds = by_folds};
    mhb_branch    *segment = set_up(&f, 5, VALUES);
    segment->special[1] = segment->special[3] = MHB_FOLD;
    const mhb_branch *branch                  = complete(&f, &c);
    static const int  wanted[]                = {-1, -1, 0, -1, -1};
    for (int i = 0; i < 5; i++) assert_int_equal(branch->stable[i], by_folds ? wanted[i] : -1);
    tear_down(&f);
  }
}

/* A traced branch of a stable blade: every point is judged by its multipliers. The monitor may stop
 * the judging. */
static void traced_points_are_judged(void **state) {
  (void)state;
  for (int stopped = 0; stopped < 2; stopped++) {
    fixture f;
    set_up(&f, 0, NULL);
    f.settings.stability = MHB_STABILITY_ALWAYS;
    double         x[3 * (2 * H + 1)];
    int            segment;
    mhb_end        end;
    double         low = SHB_TWO_PI * 0.1;
    mhb_completion c   = {.by_folds = true};
    mhb_balance_set_preload(f.balance, 1);
    assert_ok(mhb_balance_linear_limit(f.balance, low, 1, x));
    mhb_segment_plan plan = {.seed = {.x = x, .value = low, .direction = 1}, .m = H};
    assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
    assert_int_equal(end, MHB_END_HIGH);
    mhb_chain_insert(&f.chain, f.chain.n, (mhb_link){.segment = segment});
    if (stopped) f.monitor.stop_at = f.monitor.n_points + 3;
    c.end                    = end;
    const mhb_branch *branch = complete(&f, &c);
    assert_true(c.interrupted == stopped && branch->complete != stopped);
    assert_string_equal(branch->reason, stopped ? "interrupted" : "end of range");
    for (int i = 0; i < branch->n_points; i++) {
      bool judged = branch->judged[i] == MHB_BY_MULTIPLIERS;
      assert_int_equal(branch->stable[i], judged ? 1 : -1);
      assert_true(judged == (!stopped || i < 3));
    }
    tear_down(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_reason_is_that_of_the_end),
                                     cmocka_unit_test(gaps_are_told),
                                     cmocka_unit_test(a_reason_of_its_own),
                                     cmocka_unit_test(hairline_folds_are_unmarked),
                                     cmocka_unit_test(of_three_folds_one_is_left),
                                     cmocka_unit_test(stability_goes_by_folds),
                                     cmocka_unit_test(traced_points_are_judged)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
