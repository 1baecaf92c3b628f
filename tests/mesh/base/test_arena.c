/* Arrays of an arena are zeroed, aligned and disjoint. A failure of a try is kept until all is
 * freed. */
#include "mesh/base/arena.h"
#include "tests/support/check.h"

static void arrays_are_zero_aligned_and_apart(void **state) {
  (void)state;
  const size_t size[] = {0, 1, 63, 64, 65, 1000, 100003};
  char        *array[7];
  shb_arena    arena = {0};
  for (int i = 0; i < 7; i++) {
    array[i] = shb_arena_take(&arena, size[i], 1);
    assert_non_null(array[i]);
    assert_int_equal((uintptr_t)array[i] % 64, 0);
    for (size_t k = 0; k < size[i]; k++) assert_int_equal(array[i][k], 0);
    memset(array[i], 1 + i, size[i]);
  }
  for (int i = 0; i < 7; i++)
    for (size_t k = 0; k < size[i]; k++) assert_int_equal(array[i][k], 1 + i);
  assert_false(arena.failed);
  shb_arena_free(&arena);
  assert_null(arena.newest);
}

static void nothing_is_an_array_too(void **state) {
  (void)state;
  shb_arena arena = {0};
  assert_non_null(shb_arena_take(&arena, 0, 8));
  assert_non_null(shb_arena_take(&arena, 8, 0));
  assert_false(arena.failed);
  shb_arena_free(&arena);
}

/* Too many bytes, and a product beyond size_t: both fail, and later arrays do not hide it. */
static void failure_is_kept(void **state) {
  (void)state;
  const size_t count[] = {(size_t)PTRDIFF_MAX, SIZE_MAX / 4}, size[] = {1, 16};
  for (int i = 0; i < 2; i++) {
    shb_arena arena = {0};
    assert_non_null(shb_arena_take(&arena, 3, 8));
    assert_null(shb_arena_try(&arena, count[i], size[i]));
    assert_true(arena.failed);
    assert_non_null(shb_arena_try(&arena, 3, 8));
    assert_true(arena.failed);
    shb_arena_free(&arena);
    assert_false(arena.failed);
  }
}

static void free_twice_is_harmless(void **state) {
  (void)state;
  shb_arena arena = {0};
  shb_arena_free(&arena);
  assert_non_null(shb_arena_take(&arena, 5, 8));
  shb_arena_free(&arena);
  shb_arena_free(&arena);
  assert_non_null(shb_arena_take(&arena, 5, 8));
  shb_arena_free(&arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arrays_are_zero_aligned_and_apart),
      cmocka_unit_test(nothing_is_an_array_too),
      cmocka_unit_test(failure_is_kept),
      cmocka_unit_test(free_twice_is_harmless),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
