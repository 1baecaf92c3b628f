#include "mesh/kernel.h"

#include <ctype.h>
#include <gmshc.h>
#include <stdio.h>
#include <string.h>

static const int kept[MESH_KERNEL_SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGFPE, SIGSEGV};

static void keep_handlers(mesh_kernel *kernel) {
  for (int i = 0; i < MESH_KERNEL_SIGNALS; i++) sigaction(kept[i], NULL, &kernel->handler[i]);
}

static void restore_handlers(const mesh_kernel *kernel) {
  for (int i = 0; i < MESH_KERNEL_SIGNALS; i++) sigaction(kept[i], &kernel->handler[i], NULL);
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
  return SHB_OK;
}

void mesh_kernel_close(mesh_kernel *kernel) {
  int ierr = 0;
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

void mesh_kernel_listen(void) {
  int ierr = 0;
  gmshLoggerStart(&ierr);
}

shb_status mesh_kernel_heard(const char *what) {
  char     **line   = NULL;
  size_t     n      = 0;
  int        ierr   = 0;
  shb_status status = SHB_OK;
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
