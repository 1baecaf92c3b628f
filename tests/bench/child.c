#include "child.h"

#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

shb_status bench_in_child(const char *name, bench_run run, const void *input, void *row,
                          size_t size, double *megabytes) {
  int           ends[2], state;
  struct rusage usage;
  SHB_CHECK(pipe(ends) == 0, SHB_ERR_IO, "no pipe");
  fflush(stdout);
  pid_t child = fork();
  SHB_CHECK(child >= 0, SHB_ERR_IO, "no process");
  if (child == 0) {
    close(ends[0]);
    shb_status status = run(input, row);
    if (status != SHB_OK) fprintf(stderr, "bench_response: %s\n", shb_message());
    if (status == SHB_OK && write(ends[1], row, size) != (ssize_t)size) status = SHB_ERR_IO;
    _exit(status);
  }
  close(ends[1]);
  ssize_t got = read(ends[0], row, size);
  close(ends[0]);
  wait4(child, &state, 0, &usage);
  *megabytes = (double)usage.ru_maxrss / 1024;
  SHB_CHECK(got == (ssize_t)size && state == 0, SHB_NOT_CONVERGED, "%s: no result", name);
  return SHB_OK;
}
