#include "mesh/gmsh/export.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/gmsh/api.h"
#include "mesh/gmsh/provenance.h"
#include "mesh/gmsh/session.h"

/* Copy all lines except the $Periodic section. *whole: the elements are there to their end. gmsh
 * does not say when it could not write them. */
static bool copy_lines(FILE *from, FILE *to, bool *whole) {
  char  *line = NULL;
  size_t size = 0;
  bool   skip = false;
  while (getline(&line, &size, from) > 0) {
    if (strcmp(line, "$Periodic\n") == 0) skip = true;
    if (!skip) fputs(line, to);
    if (strcmp(line, "$EndElements\n") == 0) *whole = true;
    if (strcmp(line, "$EndPeriodic\n") == 0) skip = false;
  }
  free(line);
  return !ferror(from) && !ferror(to);
}

static shb_status copy_file(const char *raw, const char *temporary, const char *path) {
  FILE *from = fopen(raw, "rb"), *to = fopen(temporary, "wb");
  bool  whole = false, good = from && to && copy_lines(from, to, &whole);
  if (to) good = fclose(to) == 0 && good;
  int why = errno;
  if (from) fclose(from);
  SHB_CHECK(good, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(why));
  SHB_CHECK(whole, SHB_ERR_IO,
            "%s: cannot be written: gmsh stopped before the end; is the disk full?", path);
  return SHB_OK;
}

/* Text of the model as gmsh writes it. The file is opened here first, as gmsh gives no reason when
 * it cannot be opened. */
static shb_status write_raw(const char *raw, const char *path) {
  FILE *file = fopen(raw, "wb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
  fclose(file);
  int ierr = 0;
  gmshWrite(raw, &ierr);
  if (ierr) return mesh_session_fail(SHB_ERR_IO, __FILE__, __LINE__, path);
  return SHB_OK;
}

static shb_status write_all(const char *raw, const char *temporary, const char *path,
                            const shb_provenance *provenance) {
  shb_status status = write_raw(raw, path);
  if (status == SHB_OK) status = copy_file(raw, temporary, path);
  unlink(raw); /* before the result is there: no later run would look for it */
  SHB_TRY(status);
  SHB_TRY(mesh_provenance_append(temporary, provenance));
  return shb_publish(temporary, path);
}

shb_status mesh_export(const char *path, const shb_provenance *provenance) {
  char      *temporary = shb_publish_temporary(path), *raw = shb_publish_temporary_msh(path);
  shb_status status = write_all(raw, temporary, path, provenance);
  if (status != SHB_OK) unlink(temporary);
  free(raw);
  free(temporary);
  return status;
}
