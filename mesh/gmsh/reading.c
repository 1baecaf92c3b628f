#include "mesh/gmsh/reading.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/core/file_format.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/script_files.h"

static const char ending[] = ".opt";

enum { LENGTH = 4096 };

bool mesh_reading_has_options(const char *path, char *beside, size_t size) {
  snprintf(beside, size, "%s%s", path, ending);
  return access(beside, F_OK) == 0;
}

/* "Info: Reading 'NAME.opt'...": does a line say so? */
static bool names_options(const char *line) {
  const char *end = strstr(line, "Reading '") ? strrchr(line, '\'') : NULL;
  return end && end - line > (long)strlen(ending) &&
         strncmp(end - strlen(ending), ending, strlen(ending)) == 0;
}

/* SHB_ERR_INPUT if gmsh read a file of options, beside a file that the script merges. */
static shb_status check_log(const char *path) {
  char     **line   = NULL;
  size_t     n      = 0;
  shb_status status = SHB_OK;
  GMSH_TRY(path, gmshLoggerGet(&line, &n, &ierr));
  for (size_t i = 0; i < n; i++) {
    if (status == SHB_OK && names_options(line[i]))
      status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                        "%s: gmsh ran a file of options beside a file that the script merges (%s); "
                        "put what it sets into the script, and remove it",
                        path, line[i]);
    gmshFree(line[i]);
  }
  gmshFree(line);
  return status;
}

static shb_status refuse_options(const char *script, const char *path) {
  char beside[LENGTH + sizeof ending];
  SHB_CHECK(!mesh_reading_has_options(path, beside, sizeof beside), SHB_ERR_INPUT,
            "%s: gmsh would run this file with %s, and the mesh would not be made again when it "
            "changes; put what it sets into the script, and remove it",
            beside, script);
  return SHB_OK;
}

/* Each file that the script reads, at any depth. */
static shb_status check_script(const char *path) {
  mesh_file_list list   = {0};
  shb_status     status = mesh_script_files(path, &list);
  for (int i = 0; i < list.n && status == SHB_OK; i++) status = refuse_options(path, list.path[i]);
  mesh_files_free(&list);
  return status;
}

/* gmsh finds what a script includes beside the script, so the script is read where it is. Names
 * that the script computes are found in the log, afterwards. */
static shb_status read_script(const char *path) {
  SHB_TRY(check_script(path));
  GMSH_TRY(path, gmshOpen(path, &ierr));
  return check_log(path);
}

shb_status mesh_reading_solid(const char *path) {
  const mesh_format format = mesh_format_of(path);
  int              *tags   = NULL;
  size_t            n      = 0;
  if (format == MESH_FORMAT_GEO) return read_script(path);
  GMSH_TRY(path, gmshModelAdd(path, &ierr));
  GMSH_TRY(path, gmshModelOccImportShapes(path, &tags, &n, 0,
                                          format == MESH_FORMAT_BREP ? "brep" : "step", &ierr));
  gmshFree(tags);
  GMSH_TRY(path, gmshModelOccSynchronize(&ierr));
  return SHB_OK;
}

/* Nothing can lie beside an open file. */
shb_status mesh_reading_msh(const char *path) {
  char      name[64];
  int       ierr = 0;
  const int fd   = open(path, O_RDONLY | O_CLOEXEC);
  SHB_CHECK(fd >= 0, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
  gmshMerge(name, &ierr);
  close(fd);
  return ierr ? mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, path) : SHB_OK;
}
