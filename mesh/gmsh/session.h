/* A quiet gmsh session: started and ended around each use, leaving signals and user files alone. */
#ifndef MESH_GMSH_SESSION_H
#define MESH_GMSH_SESSION_H

#include <signal.h>

#include "mesh/base/status.h"

enum { MESH_SESSION_SIGNALS = 5 };

/* The caller's signal handling while gmsh is up, put back at once after start and at the end. */
typedef struct {
  struct sigaction handler[MESH_SESSION_SIGNALS];
} mesh_session;

/* Start gmsh: no terminal output, no ~/.gmshrc, one thread. Only one session at a time. A script that ends the program (Exit)
 * while gmsh is up ends it with code SHB_ERR_INPUT and a line that says so. SHB_ERR_IO. */
shb_status mesh_session_open(mesh_session *session);
void       mesh_session_close(mesh_session *session);

/* Record "what: gmsh: last error of gmsh" on one line; returns code. */
shb_status mesh_session_fail(shb_status code, const char *file, int line, const char *what);

/* gmsh reads on after some faults of a file. Listen before a call (what: see above, also for a script's Exit); heard then fails with the first error it told, on one line:
 * "what: gmsh: error". SHB_ERR_INPUT. */
void       mesh_session_log_start(const char *what);
shb_status mesh_session_log_check(const char *what);

/* Make a gmsh call whose last argument is &ierr. */
#define GMSH_TRY(what, ...)                                                        \
  do {                                                                             \
    int ierr = 0;                                                                  \
    __VA_ARGS__;                                                                   \
    if (ierr) return mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, (what)); \
  } while (0)

#endif
