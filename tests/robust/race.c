/* Two threads share an array: the thread sanitizer must tell of it. With an argument a barrier of
 * OpenMP orders them, and it must be silent: it then sees the synchronisation of OpenMP. */
#include <omp.h>
#include <stdio.h>

int main(int argc, char **argv) {
  double    shared[2] = {0, 0}, sum = 0;
  const int ordered = argc > 1;
  (void)argv;
#pragma omp parallel num_threads(2) shared(shared, sum)
  {
    const int me = omp_get_thread_num();
    shared[me]   = me + 2.385;
    if (ordered) {
#pragma omp barrier
    }
    if (me == 0) sum = shared[0] + shared[1];
  }
  printf("%g\n", sum);
  return 0;
}
