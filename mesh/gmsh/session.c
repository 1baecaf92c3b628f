#include "mesh/gmsh/session.h"

#include <ctype.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/gmsh/api.h"

static const int saved_signals[MESH_SESSION_SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGFPE, SIGSEGV};

static void save_handlers(mesh_session *session) {
  for (int i = 0; i < MESH_SESSION_SIGNALS; i++)
    sigaction(saved_signals[i], NULL, &session->handler[i]);
}

static void restore_handlers(const mesh_session *session) {
  for (int i = 0; i < MESH_SESSION_SIGNALS; i++)
    sigaction(saved_signals[i], &session->handler[i], NULL);
}

/* OpenCASCADE prints errors on standard output. gmsh's logger holds them as well. */
static int saved_stdout = -1;

static void mute_stdout(void) {
  int null = open("/dev/null", O_WRONLY);
  fflush(stdout);
  saved_stdout = null >= 0 ? dup(STDOUT_FILENO) : -1;
  if (saved_stdout >= 0) dup2(null, STDOUT_FILENO);
  if (null >= 0) close(null);
}

static void unmute_stdout(void) {
  fflush(stdout);
  if (saved_stdout < 0) return;
  dup2(saved_stdout, STDOUT_FILENO);
  close(saved_stdout);
  saved_stdout = -1;
}

/* The file that gmsh reads, "" without a session. A global, as exit handlers have no arguments. */
static char reading[512];

/* "Exit" in a script makes gmsh call exit(0), which would report success. */
static void refuse_exit(void) {
  if (!reading[0]) return;
  fprintf(stderr,
          "shroudhb: error: %s: ends the program while it is read; leave out Exit in the script\n",
          reading);
  _exit(SHB_ERR_INPUT);
}

static void guard_exit(const char *what) {
  static int registered;
  if (!registered) registered = atexit(refuse_exit) == 0;
  snprintf(reading, sizeof reading, "%s", what);
}

shb_status mesh_session_open(mesh_session *session) {
  static const char *const option[] = {"General.Terminal", "General.AbortOnError",
                                       "General.SaveSession", "General.SaveOptions"};
  char                     name[]   = "shroudhb";
  char                    *argv[]   = {name, NULL};
  int                      ierr     = 0;
  SHB_TRY(mesh_gmsh_load());
  save_handlers(session);
  gmshInitialize(1, argv, 0, &ierr);
  restore_handlers(session);
  SHB_CHECK(ierr == 0, SHB_ERR_IO, "gmsh cannot be started");
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    gmshOptionSetNumber(option[i], 0, &ierr);
  gmshOptionSetNumber("General.NumThreads", 1, &ierr);
  gmshOptionSetNumber("General.ExpertMode", 1, &ierr); /* no questions on the terminal */
  guard_exit("gmsh");
  return SHB_OK;
}

void mesh_session_close(mesh_session *session) {
  int ierr = 0;
  unmute_stdout();
  reading[0] = '\0';
  gmshFinalize(&ierr);
  restore_handlers(session);
}

shb_status mesh_session_fail(shb_status code, const char *file, int line, const char *what) {
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

void mesh_session_log_start(const char *what) {
  int ierr = 0;
  guard_exit(what);
  mute_stdout();
  gmshLoggerStart(&ierr);
}

shb_status mesh_session_log_check(const char *what) {
  char     **line   = NULL;
  size_t     n      = 0;
  int        ierr   = 0;
  shb_status status = SHB_OK;
  unmute_stdout();
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

/* The text of an error in the log, without blanks at its end; NULL: the line is none. */
static const char *error_of(char *line) {
  static const char head[] = "Error: ";
  if (strncmp(line, head, strlen(head)) != 0) return NULL;
  size_t n = strlen(line);
  while (n > strlen(head) && isspace((unsigned char)line[n - 1])) line[--n] = '\0';
  return n > strlen(head) ? line + strlen(head) : NULL;
}

void mesh_session_log_errors(char *text, size_t size) {
  char **line = NULL;
  size_t n = 0, used = 0;
  int    ierr = 0;
  unmute_stdout();
  gmshLoggerGet(&line, &n, &ierr);
  gmshLoggerStop(&ierr);
  *text = '\0';
  for (size_t i = 0; i < n; i++) {
    const char *said = error_of(line[i]);
    if (said && !strstr(text, said) && used + strlen(said) + 3 < size)
      used += (size_t)snprintf(text + used, size - used, "%s%s", used ? "; " : "", said);
    gmshFree(line[i]);
  }
  gmshFree(line);
  for (char *c = text; *c; c++)
    if (iscntrl((unsigned char)*c)) *c = ' ';
}
