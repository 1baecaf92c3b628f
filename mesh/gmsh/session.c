#include "mesh/gmsh/session.h"

#include <ctype.h>
#include <fcntl.h>
#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const int kept[MESH_KERNEL_SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGFPE, SIGSEGV};

static void keep_handlers(mesh_kernel *kernel) {
  for (int i = 0; i < MESH_KERNEL_SIGNALS; i++) sigaction(kept[i], NULL, &kernel->handler[i]);
}

static void restore_handlers(const mesh_kernel *kernel) {
  for (int i = 0; i < MESH_KERNEL_SIGNALS; i++) sigaction(kept[i], &kernel->handler[i], NULL);
}

/* OpenCASCADE tells its faults on standard output, in colours; gmsh's logger has them too. */
static int silenced = -1;

static void silence(void) {
  int null = open("/dev/null", O_WRONLY);
  fflush(stdout);
  silenced = null >= 0 ? dup(STDOUT_FILENO) : -1;
  if (silenced >= 0) dup2(null, STDOUT_FILENO);
  if (null >= 0) close(null);
}

static void speak(void) {
  fflush(stdout);
  if (silenced < 0) return;
  dup2(silenced, STDOUT_FILENO);
  close(silenced);
  silenced = -1;
}

/* gmsh is up, and what it reads: exit handlers have no arguments. */
static char at_work[512];

/* "Exit" in a script makes gmsh call exit(0), as if all were done. */
static void on_exit_at_work(void) {
  if (!at_work[0]) return;
  fprintf(stderr,
          "shroudhb: error: %s: ends the program while it is read; leave out Exit in the script\n",
          at_work);
  _exit(SHB_ERR_INPUT);
}

static void guard(const char *what) {
  static int guarded;
  if (!guarded) guarded = atexit(on_exit_at_work) == 0;
  snprintf(at_work, sizeof at_work, "%s", what);
}

shb_status mesh_kernel_open(mesh_kernel *kernel) {
  static const char *const option[] = {"General.Terminal", "General.AbortOnError",
                                       "General.SaveSession", "General.SaveOptions"};
  char                     name[]   = "shroudhb";
  char                    *argv[]   = {name, NULL};
  int                      ierr     = 0;
  keep_handlers(kernel);
  gmshInitialize(1, argv, 0, &ierr);
  restore_handlers(kernel);
  SHB_CHECK(ierr == 0, SHB_ERR_IO, "gmsh cannot be started");
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    gmshOptionSetNumber(option[i], 0, &ierr);
  gmshOptionSetNumber("General.NumThreads", 1, &ierr);
  gmshOptionSetNumber("General.ExpertMode", 1, &ierr); /* asks nothing on the terminal */
  guard("gmsh");
  return SHB_OK;
}

void mesh_kernel_close(mesh_kernel *kernel) {
  int ierr = 0;
  speak();
  at_work[0] = '\0';
  gmshFinalize(&ierr);
  restore_handlers(kernel);
}

shb_status mesh_kernel_fail(shb_status code, const char *file, int line, const char *what) {
  char *text = NULL;
  int   ierr = 0;
  gmshLoggerGetLastError(&text, &ierr);
  if (ierr || !text || !*text) {
    gmshFree(text);
    return shb_fail(code, file, line, "%s: gmsh gave no reason", what);
  }
  for (char *c = text; *c; c++)
    if (iscntrl((unsigned char)*c)) *c = ' ';
  shb_fail(code, file, line, "%s: gmsh: %s", what, text);
  gmshFree(text);
  return code;
}

void mesh_kernel_listen(const char *what) {
  int ierr = 0;
  guard(what);
  silence();
  gmshLoggerStart(&ierr);
}

shb_status mesh_kernel_heard(const char *what) {
  char     **line   = NULL;
  size_t     n      = 0;
  int        ierr   = 0;
  shb_status status = SHB_OK;
  speak();
  gmshLoggerGet(&line, &n, &ierr);
  gmshLoggerStop(&ierr);
  for (size_t i = 0; i < n; i++) {
    if (status == SHB_OK && strncmp(line[i], "Error: ", 7) == 0)
      status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s: gmsh: %s", what, line[i] + 7);
    gmshFree(line[i]);
  }
  gmshFree(line);
  return status;
}
