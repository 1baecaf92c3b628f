#define _GNU_SOURCE /* memmem */
#include "mesh/io/msh_check.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Check the head: $MeshFormat, possibly after comments, then version 2.2 or 4.1. gmsh judges by the
 * first line, also where that is blank. */
static shb_status check_head(FILE *file, const char *path) {
  char line[256] = "";
  bool comment   = false;
  for (bool first = true; fgets(line, sizeof line, file); first = false) {
    if (strncmp(line, "$Comments", 9) == 0) comment = true;
    if (!comment && (first || strspn(line, " \t\r\n") != strlen(line))) break;
    if (strncmp(line, "$EndComments", 12) == 0) comment = false;
  }
  double version = 0;
  SHB_CHECK(strncmp(line, "$MeshFormat", 11) == 0 && fgets(line, sizeof line, file) &&
                sscanf(line, "%lf", &version) == 1,
            SHB_ERR_INPUT, "%s: not a gmsh mesh file (it does not begin with $MeshFormat)", path);
  SHB_CHECK(version == 2.2 || version == 4.1, SHB_ERR_INPUT,
            "%s: mesh format %g; 2.2 or 4.1 is needed (gmsh -format msh41)", path, version);
  return SHB_OK;
}

/* Does the file contain mark? Blocks overlap by the length of mark. */
static bool holds(FILE *file, const char *mark) {
  enum { BLOCK = 1 << 18 };
  size_t length = strlen(mark), kept = 0;
  char  *buffer = shb_alloc(BLOCK + 64, 1);
  bool   found  = false;
  rewind(file);
  for (size_t n; !found && (n = fread(buffer + kept, 1, BLOCK, file)) > 0;) {
    n += kept;
    found = memmem(buffer, n, mark, length) != NULL;
    kept  = n < length ? n : length;
    memmove(buffer, buffer + n - kept, kept);
  }
  free(buffer);
  return found;
}

shb_status mesh_msh_check(const char *path) {
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  shb_status status = check_head(file, path);
  if (status == SHB_OK && !holds(file, "$EndNodes"))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "%s: cut short or without nodes (no $EndNodes)", path);
  if (status == SHB_OK && !holds(file, "$EndElements"))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "%s: cut short or without elements (no $EndElements)", path);
  fclose(file);
  return status;
}
