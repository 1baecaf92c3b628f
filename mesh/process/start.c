/* What must be in order before the program runs. Standard descriptors, address space and how
 * threads wait are settled before the start of every library. This is done by system calls only: a
 * sanitizer, which replaces functions, may not be there yet. The locale and the environment of MPI
 * are set after it. */
#define _GNU_SOURCE /* syscall */
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "mesh/base/status.h"
#include "mesh/process/report.h"

/* Measured with a balance of three degrees of freedom: 220 MB with one thread, 370 with two. Other
 * work needs more, and says so when it gets none. */
enum { FIRST_THREAD = 240, FURTHER_THREAD = 140, MEGABYTE = 1 << 20 };

/* OpenBLAS starts a thread a core unless this variable says fewer. */
static const char variable[] = "OPENBLAS_NUM_THREADS=";

static long threads_of(char **environment) {
  long cores = sysconf(_SC_NPROCESSORS_ONLN), wanted = 0;
  for (char **text = environment; *text; text++) {
    if (strncmp(*text, variable, sizeof variable - 1) != 0) continue;
    for (const char *c = *text + sizeof variable - 1; *c >= '0' && *c <= '9' && wanted < cores; c++)
      wanted = 10 * wanted + (*c - '0');
  }
  return wanted > 0 && wanted < cores ? wanted : cores;
}

static void say(const char *text) {
  if (write(STDERR_FILENO, text, strlen(text)) < 0) _exit(SHB_ERR_IO);
}

static void say_number(rlim_t number) {
  char digits[24], *at = digits + sizeof digits - 1;
  *at = '\0';
  do {
    *--at = (char)('0' + number % 10);
    number /= 10;
  } while (number > 0);
  say(at);
}

/* Where standard input, output or error is closed, the first file opened would take its number:
 * messages would be written into a result. Closed ones become /dev/null. It is open for reading
 * only, so a write still fails as on a closed one. */
static void fill_descriptors(void) {
  long taken;
  do {
    taken = syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDONLY);
  } while (taken >= 0 && taken <= STDERR_FILENO);
  if (taken >= 0)
    (void)syscall(SYS_close, taken);
  else if (syscall(SYS_fcntl, STDERR_FILENO, F_GETFD) < 0)
    _exit(SHB_ERR_IO); /* a result could be damaged, and nobody can be told */
}

/* A limit of the address space (ulimit -v) below what OpenBLAS takes at its start makes it try for
 * ever. */
static void check_address_space(char **environment) {
  struct rlimit limit;
  const long    threads = threads_of(environment);
  const rlim_t  needed  = FIRST_THREAD + (rlim_t)(threads - 1) * FURTHER_THREAD;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
      limit.rlim_cur / MEGABYTE >= needed)
    return;
  say("shroudhb: error: the address space is limited to ");
  say_number(limit.rlim_cur / MEGABYTE);
  say(" MB; ");
  say_number((rlim_t)threads);
  say(threads == 1 ? " thread needs " : " threads of OpenBLAS need ");
  say_number(needed);
  say(threads == 1 ? " MB: raise ulimit -v\n"
                   : " MB: raise ulimit -v, or set OPENBLAS_NUM_THREADS=1\n");
  _exit(SHB_ERR_IO);
}

/* With fewer open files a library waits for ever, or says something else. `run` needs 19, the modal
 * stage 12, a study 6 and two for each core, all else 10 at most (tests/bench/bench_open_files.sh).
 * The rest is for plugins of MPI, which differ. */
static void check_open_files(void) {
  enum { LEAST_FILES = 24, EACH_CORE = 2 };
  struct rlimit limit;
  const long    cores  = sysconf(_SC_NPROCESSORS_ONLN);
  const rlim_t  needed = LEAST_FILES + EACH_CORE * (rlim_t)(cores > 0 ? cores : 1);
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
      limit.rlim_cur >= needed)
    return;
  say("shroudhb: error: the number of open files is limited to ");
  say_number(limit.rlim_cur);
  say("; ");
  say_number(needed);
  say(" are asked for: raise ulimit -n\n");
  _exit(SHB_ERR_IO);
}

#ifndef SHB_FRONT
static bool starts_with(const char *text, const char *start) {
  return strncmp(text, start, strlen(start)) == 0;
}

/* A thread that waits for others sleeps. OpenMP's threads spin for milliseconds otherwise, and on a
 * busy machine that time is another program's. OpenMP reads its environment once, as its library
 * starts, so the program is started again with the variable. A user's choice is kept. The front
 * command has no such threads; it sets the variable for the programs that it starts. */
static void let_waiting_threads_sleep(char **argv, char **environment) {
  int n = 0;
  for (; environment[n]; n++)
    if (starts_with(environment[n], "OMP_WAIT_POLICY=") ||
        starts_with(environment[n], "GOMP_SPINCOUNT="))
      return;
  const char *program = (const char *)getauxval(AT_EXECFN); /* 0 where the system tells none */
  char       *more[n + 2];
  char        passive[] = "OMP_WAIT_POLICY=passive";
  memcpy(more, environment, (size_t)n * sizeof *more);
  more[n]     = passive;
  more[n + 1] = NULL;
  if (program) (void)syscall(SYS_execve, program, argv, more); /* where it fails, threads spin */
}
#else
static void let_waiting_threads_sleep(char **argv, char **environment) {
  (void)argv;
  (void)environment;
}

__attribute__((constructor)) static void let_threads_of_others_sleep(void) {
  if (!getenv("GOMP_SPINCOUNT")) setenv("OMP_WAIT_POLICY", "passive", 0);
}
#endif

static void start(int argc, char **argv, char **environment) {
  (void)argc;
  fill_descriptors();
  check_open_files();
  check_address_space(environment);
  let_waiting_threads_sleep(argv, environment);
}

__attribute__((section(".preinit_array"),
               used)) static void (*const before_libraries)(int, char **, char **) = start;

/* Numbers have a decimal point, also where a library has taken the locale of the user. */
__attribute__((constructor)) static void set_locale(void) {
  setlocale(LC_ALL, "C");
}

/* A file over the limit of sizes (ulimit -f) fails the write, which is told. */
__attribute__((constructor)) static void keep_size_limit(void) {
  signal(SIGXFSZ, SIG_IGN);
}

/* Without mpiexec Open MPI starts a daemon for processes that the program may add. There are none.
 * The daemon costs a third of a second, and outlives a program that is killed. */
__attribute__((constructor)) static void start_no_daemon(void) {
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
}

/* What ends the program at once is told to the one that started it. */
__attribute__((constructor)) static void join_report(void) {
  shb_report_join();
}
