#include "mesh/table/text_file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "mesh/base/memory.h"

/* Reads all bytes, at most `most` + 1, and a NUL behind them. Returns 0, or an errno. Small files
 * take little memory: thousands are read in a study. */
static int read_bytes(FILE *file, size_t most, char **bytes, size_t *n) {
  size_t room = 0;
  for (bool more = true; more;) {
    room       = room ? 4 * room : 4096;
    *bytes     = shb_realloc(*bytes, room, 1);
    size_t end = room - 1 <= most ? room - 1 : most + 1;
    *n += fread(*bytes + *n, 1, end - *n, file);
    more = *n == end && *n <= most;
  }
  if (ferror(file)) return errno;
  (*bytes)[*n] = '\0';
  return 0;
}

shb_status mesh_file_kind(const char *path) {
  struct stat about;
  SHB_CHECK(stat(path, &about) != 0 || S_ISREG(about.st_mode) || S_ISDIR(about.st_mode), SHB_ERR_IO,
            "%s: is a pipe or a device, not a file", path);
  return SHB_OK;
}

static shb_status check(const char *path, size_t most, const char *what, const char *bytes,
                        size_t n) {
  SHB_CHECK(n <= most << 20, SHB_ERR_INPUT, "%s: larger than %zu MiB; %s", path, most, what);
  SHB_CHECK(!memchr(bytes, '\0', n), SHB_ERR_INPUT, "%s: holds binary data; %s in UTF-8", path,
            what);
  return SHB_OK;
}

shb_status mesh_text_read(const char *path, size_t most, const char *what, char **text,
                          size_t *length) {
  *text = NULL;
  errno = 0;
  SHB_TRY(mesh_file_kind(path));
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be opened: %s", path, strerror(errno));
  char  *bytes = NULL;
  size_t n     = 0;
  int    why   = read_bytes(file, most << 20, &bytes, &n);
  fclose(file);
  shb_status status =
      why ? shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: cannot be read: %s", path, strerror(why))
          : check(path, most, what, bytes, n);
  if (status != SHB_OK) {
    free(bytes);
    errno = why;
    return status;
  }
  *text   = bytes;
  *length = n;
  return SHB_OK;
}
