/* Chains of segments: order, reversal, joins and what is dropped at them. */
#include "mhb/branches/chain.h"

#include "tests/support/check.h"
#include "tests/support/point_lists.h"

/* Segments 0: 1 2 3, 1: 4 5, 2: none, 3: 6 7 8 9. */
static mhb_response *segments(void) {
  static const double value[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  mhb_response       *store   = mhb_response_create(1, 0, 1);
  assert_non_null(store);
  add_point_list(store, 3, value);
  add_point_list(store, 2, value + 3);
  add_point_list(store, 0, NULL);
  add_point_list(store, 4, value + 5);
  return store;
}

/* A chain of n links, appended in order. */
static mhb_chain chain_of(int n, const mhb_link *link) {
  mhb_chain chain = {0};
  for (int i = 0; i < n; i++) mhb_chain_insert(&chain, chain.n, link[i]);
  assert_int_equal(chain.n, n);
  return chain;
}

/* The joined chain is wanted[n], and begins at begins[n_begins]. */
static void assert_joined(const mhb_chain *chain, int n, const double *wanted, int n_begins,
                          const int *begins) {
  mhb_response *store = segments(), *response = mhb_response_create(1, 0, 1);
  int           at[16], n_at;
  double        before = 77;
  assert_non_null(response);
  add_point_list(response, 1, &before); /* it is replaced */
  assert_int_equal(mhb_chain_points(chain, store), n);
  mhb_chain_join(chain, store, response, 0, at, &n_at);
  const mhb_branch *branch = &response->branch[0];
  assert_int_equal(branch->n_points, n);
  for (int i = 0; i < n; i++) assert_true(branch->value[i] == wanted[i]);
  assert_int_equal(n_at, n_begins);
  for (int i = 0; i < n_begins; i++) assert_int_equal(at[i], begins[i]);
  int segment, point;
  for (int end = -1; end < 2 && n > 0; end += 2) {
    mhb_chain_end(chain, store, end, &segment, &point);
    assert_true(store->branch[segment].value[point] == wanted[end < 0 ? 0 : n - 1]);
  }
  mhb_response_destroy(store);
  mhb_response_destroy(response);
}

static void links_follow_each_other(void **state) {
  (void)state;
  const mhb_link link[]   = {{.segment = 1}, {.segment = 0, .joins = true}, {.segment = 3}};
  const double   wanted[] = {4, 5, 1, 2, 3, 6, 7, 8, 9};
  const int      begins[] = {0, 5};
  mhb_chain      chain    = chain_of(3, link);
  assert_joined(&chain, 9, wanted, 2, begins);
  mhb_chain_free(&chain);
  assert_int_equal(chain.n, 0);
  assert_null(chain.link);
}

static void links_are_inserted_anywhere(void **state) {
  (void)state;
  const double wanted[] = {6, 7, 8, 9, 1, 2, 3, 4, 5};
  const int    begins[] = {0, 4, 7};
  mhb_chain    chain    = {0};
  mhb_chain_insert(&chain, 0, (mhb_link){.segment = 1});
  mhb_chain_insert(&chain, 0, (mhb_link){.segment = 3});
  mhb_chain_insert(&chain, 1, (mhb_link){.segment = 0});
  assert_joined(&chain, 9, wanted, 3, begins);
  mhb_chain_free(&chain);
}

/* A reversed link runs backwards; at a join its first points are in the other link already. */
static void links_may_be_reversed_and_cut(void **state) {
  (void)state;
  const mhb_link link[]   = {{.segment = 3, .reversed = true},
                             {.segment = 0, .joins = true, .drop = 1},
                             {.segment = 1, .reversed = true, .joins = true, .drop = 1}};
  const double   wanted[] = {9, 8, 7, 6, 2, 3, 4};
  const int      begins[] = {0};
  mhb_chain      chain    = chain_of(3, link);
  assert_joined(&chain, 7, wanted, 1, begins);
  mhb_chain_free(&chain);
}

/* Segments without points, or with fewer than are dropped, do not count: no curve begins there. */
static void empty_links_do_not_count(void **state) {
  (void)state;
  const mhb_link link[]   = {{.segment = 2},
                             {.segment = 1, .joins = true, .drop = 5},
                             {.segment = 0, .joins = true},
                             {.segment = 2, .reversed = true}};
  const double   wanted[] = {1, 2, 3};
  const int      begins[] = {0};
  mhb_chain      chain    = chain_of(4, link);
  assert_joined(&chain, 3, wanted, 1, begins);
  mhb_chain_free(&chain);
}

/* The same curve the other way: places of joins stay between the same links. */
static void reversal_keeps_joins_and_drops(void **state) {
  (void)state;
  const mhb_link link[] = {
      {.segment = 0}, {.segment = 3, .joins = true, .reversed = true, .drop = 1}, {.segment = 1}};
  const double forward[] = {1, 2, 3, 8, 7, 6, 4, 5};
  const int    begins[]  = {0, 6};
  mhb_chain    chain     = chain_of(3, link);
  assert_joined(&chain, 8, forward, 2, begins);
  mhb_chain_reverse(&chain, 0);
  assert_int_equal(chain.link[0].segment, 1);
  assert_false(chain.link[0].joins);
  assert_false(chain.link[1].joins);
  assert_true(chain.link[2].joins);
  assert_int_equal(chain.link[2].drop, 1);
  assert_true(chain.link[0].reversed && !chain.link[1].reversed && chain.link[2].reversed);
  /* one point is dropped at the join, now that of the link behind it */
  const double backward[]    = {5, 4, 6, 7, 8, 9, 2, 1};
  const int    begins_back[] = {0, 2};
  assert_joined(&chain, 8, backward, 2, begins_back);
  mhb_chain_reverse(&chain, 0);
  assert_joined(&chain, 8, forward, 2, begins);
  mhb_chain_free(&chain);
}

static void only_the_tail_is_reversed(void **state) {
  (void)state;
  const mhb_link link[]   = {{.segment = 1}, {.segment = 0}, {.segment = 3, .joins = true}};
  const double   wanted[] = {4, 5, 9, 8, 7, 6, 3, 2, 1};
  const int      begins[] = {0, 2};
  mhb_chain      chain    = chain_of(3, link);
  mhb_chain_reverse(&chain, 1);
  assert_joined(&chain, 9, wanted, 2, begins);
  mhb_chain_free(&chain);
}

static void an_empty_chain_has_no_end(void **state) {
  (void)state;
  mhb_response *store = segments();
  mhb_chain     chain = {0};
  int           segment, point;
  mhb_chain_end(&chain, store, 1, &segment, &point);
  assert_int_equal(segment, -1);
  assert_joined(&chain, 0, NULL, 0, NULL);
  mhb_chain_insert(&chain, 0, (mhb_link){.segment = 2});
  mhb_chain_end(&chain, store, -1, &segment, &point);
  assert_int_equal(segment, -1);
  mhb_chain_free(&chain);
  mhb_response_destroy(store);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(links_follow_each_other),
                                     cmocka_unit_test(links_are_inserted_anywhere),
                                     cmocka_unit_test(links_may_be_reversed_and_cut),
                                     cmocka_unit_test(empty_links_do_not_count),
                                     cmocka_unit_test(reversal_keeps_joins_and_drops),
                                     cmocka_unit_test(only_the_tail_is_reversed),
                                     cmocka_unit_test(an_empty_chain_has_no_end)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
