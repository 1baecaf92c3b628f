/* A gmsh session without output: opened and closed around each use. Signal handlers and user files
 * stay as they were. */
#ifndef MESH_GMSH_SESSION_H
#define MESH_GMSH_SESSION_H

#include <signal.h>
#include <stddef.h>

#include "mesh/base/status.h"

enum { MESH_SESSION_SIGNALS = 5 };

/* Signal handlers of the caller, restored after gmsh has started and at the end. */
typedef struct {
  struct sigaction handler[MESH_SESSION_SIGNALS];
} mesh_session;

/* Start gmsh without terminal output, without ~/.gmshrc, on one thread. Only one session may be
 * open. If a script ends the program (Exit) while gmsh runs, the exit code is SHB_ERR_INPUT and a
 * message is printed. SHB_ERR_IO. */
shb_status mesh_session_open(mesh_session *session);
void       mesh_session_close(mesh_session *session);

/* Record "what: gmsh: last error of gmsh" on one line. Returns code. */
shb_status mesh_session_fail(shb_status code, const char *file, int line, const char *what);

/* gmsh continues after some errors in a file, such as those of a script, or an element that lacks
 * nodes. Call log_start before reading and log_check after it. log_check ends the log and fails
 * with the first error in it, "what: gmsh: error" on one line. SHB_ERR_INPUT.
 *   what  in  heads the message, also that about Exit in a script */
void       mesh_session_log_start(const char *what);
shb_status mesh_session_log_check(const char *what);

/* End the log; text <- its errors on one line, each once, as many as fit. */
void mesh_session_log_errors(char *text, size_t size);

/* Call gmsh with &ierr as its last argument; return the error. */
#define GMSH_TRY(what, ...)                                                        \
  do {                                                                             \
    int ierr = 0;                                                                  \
    __VA_ARGS__;                                                                   \
    if (ierr) return mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, (what)); \
  } while (0)

#endif
