/* Large arrays go back to the system when they are freed, or are counted as left. */
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

/* As the modal stage's session sets it: the heap keeps what is freed. */
static void memory_that_malloc_keeps_is_left(void **state) {
  (void)state;
#ifdef __SANITIZE_ADDRESS__
  skip(); /* another heap */
#endif
  const size_t size = 800000000;
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  const double before = shb_memory_available();
  char        *array = malloc(size), *above = malloc(100);
  assert_true(array && above);
  for (size_t i = 0; i < size; i += 4096) ((volatile char *)array)[i] = 1;
  const double during = shb_memory_available();
  free(array);
  const double after = shb_memory_available();
  print_message("%.2f GB, %.2f with the array, %.2f when it is freed\n", 1e-9 * before,
                1e-9 * during, 1e-9 * after);
  assert_true(during < before - 0.6 * size); /* others use memory meanwhile */
  assert_true(after > during + 0.6 * size);
  free(above);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(large_arrays_are_mapped),
                                     cmocka_unit_test(some_memory_is_left),
                                     cmocka_unit_test(memory_that_malloc_keeps_is_left)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
