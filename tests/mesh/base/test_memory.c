/* Large arrays go back to the system when they are freed. */
#include <malloc.h>

#include "mesh/base/memory.h"
#include "tests/support/check.h"

enum { LARGE = 8 << 20, COUNT = 5 };

/* By itself glibc takes such arrays from its heap once one of them was freed. */
static void large_arrays_are_mapped(void **state) {
  (void)state;
#ifdef __SANITIZE_ADDRESS__
  skip(); /* another heap */
#endif
  void        *array[COUNT];
  const size_t before = mallinfo2().hblks;
  shb_memory_map_large();
  for (int round = 0; round < 3; round++) {
    for (int i = 0; i < COUNT; i++) {
      array[i] = malloc(LARGE);
      assert_non_null(array[i]);
      memset(array[i], 1, LARGE);
    }
    assert_int_equal(mallinfo2().hblks, before + COUNT);
    for (int i = 0; i < COUNT; i++) free(array[i]);
    assert_int_equal(mallinfo2().hblks, before);
  }
}

/* There is some, and not without end where the system tells. */
static void some_memory_is_left(void **state) {
  (void)state;
  assert_true(shb_memory_available() > LARGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(large_arrays_are_mapped),
                                     cmocka_unit_test(some_memory_is_left)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
