#include "cases/front/claim.h"

#include <errno.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "cases/schema/case_paths.h"

/* The address: folder and name. Its first byte is 0, so it is no file. Returns its length. */
static socklen_t address_of(char *path, struct sockaddr_un *address) {
  char       *slash = strrchr(path, '/');
  struct stat about = {0};
  if (slash) *slash = '\0';
  (void)stat(slash ? (*path ? path : "/") : ".",
             &about); /* a folder that is missing is told later */
  *address = (struct sockaddr_un){.sun_family = AF_UNIX};
  const int n =
      snprintf(address->sun_path + 1, sizeof address->sun_path - 1, "shroudhb %jx %jx %s",
               (uintmax_t)about.st_dev, (uintmax_t)about.st_ino, slash ? slash + 1 : path);
  const int all = (int)sizeof address->sun_path - 2, kept = n < all ? n : all;
  return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)kept);
}

shb_status claim_results(const case_file *file, int *claim) {
  struct sockaddr_un address;
  char              *path = case_output(file, "");
  *claim                  = -1;
  const socklen_t length  = address_of(path, &address);
  free(path);
  *claim = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (*claim < 0 || bind(*claim, (struct sockaddr *)&address, length) == 0) return SHB_OK;
  const int why = errno;
  close(*claim);
  *claim = -1;
  SHB_CHECK(why != EADDRINUSE, SHB_ERR_IO,
            "%s: another run works on the results of '%s'; wait for its end, or give --into FOLDER",
            file->path, file->name);
  return SHB_OK;
}
