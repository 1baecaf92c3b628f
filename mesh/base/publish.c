#define _GNU_SOURCE /* O_TMPFILE */
#include "mesh/base/publish.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"
#include "mesh/base/memory.h"

static const char MSH[] = ".msh", TEMPORARY[] = ".tmp.";

/* A run over several machines: the processes of the others are not known here. */
static int is_distributed(void) {
  const char *all = getenv("OMPI_COMM_WORLD_SIZE"), *here = getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  const char *nodes = getenv("SLURM_NNODES");
  return (all && here && strcmp(all, here) != 0) || (nodes && strcmp(nodes, "1") != 0);
}

long shb_publish_owner(const char *name, size_t *length) {
  const char *mark = NULL;
  for (const char *at = name; (at = strstr(at, TEMPORARY)) != NULL; at++) mark = at;
  if (!mark) return 0;
  char      *end;
  const long process = strtol(mark + strlen(TEMPORARY), &end, 10);
  *length            = (size_t)(mark - name);
  return process > 0 && process <= INT_MAX && (!*end || strcmp(end, MSH) == 0) ? process : 0;
}

/* Is it the temporary file of a process that is gone, such as a killed one?
 *   stem  0: that of leaf; else that of any name that begins with leaf and a point */
static bool is_orphan(const char *name, const char *leaf, bool stem) {
  const size_t n       = strlen(leaf);
  size_t       length  = 0;
  const long   process = shb_publish_owner(name, &length);
  if (!process || strncmp(name, leaf, n) != 0) return false;
  if (stem ? length <= n || name[n] != '.' : length != n) return false;
  return kill((pid_t)process, 0) != 0 && errno == ESRCH;
}

/* The folder that a file is in; the caller frees it. */
static char *folder_of(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? shb_text_start(path, (size_t)(slash - path) + 1) : shb_text(".");
}

static void remove_orphans(const char *path, bool stem) {
  if (is_distributed()) return;
  const char *slash  = strrchr(path, '/');
  char       *folder = folder_of(path);
  DIR        *list   = opendir(folder);
  for (struct dirent *entry; list && (entry = readdir(list)) != NULL;)
    if (is_orphan(entry->d_name, slash ? slash + 1 : path, stem))
      unlinkat(dirfd(list), entry->d_name, 0);
  if (list) closedir(list);
  free(folder);
}

void shb_publish_clear(const char *stem) {
  remove_orphans(stem, true);
}

static char *temporary_name(const char *path, const char *ending) {
  char *name = shb_text_of("%s%s%ld%s", path, TEMPORARY, (long)getpid(), ending);
  shb_end_removes(name);
  return name;
}

char *shb_publish_temporary(const char *path) {
  signal(SIGXFSZ, SIG_IGN); /* a write beyond the file size limit is then an error */
  remove_orphans(path, false);
  return temporary_name(path, "");
}

char *shb_publish_temporary_msh(const char *path) {
  return temporary_name(path, MSH);
}

static int sync_path(const char *path, int flags) {
  int fd = open(path, flags);
  if (fd < 0) return -1;
  int ret   = fsync(fd);
  int saved = errno;
  close(fd);
  errno = saved;
  return ret;
}

/* Make the rename itself durable. File systems that cannot sync a folder are skipped. */
static void sync_folder(const char *path) {
  char *folder = folder_of(path);
  (void)sync_path(folder, O_RDONLY);
  free(folder);
}

/* A rename would replace a device, a pipe or a link. */
static shb_status check_kind(const char *path) {
  struct stat about;
  const bool  there = lstat(path, &about) == 0;
  SHB_CHECK(!there || S_ISREG(about.st_mode) || S_ISDIR(about.st_mode), SHB_ERR_IO,
            "%s: is a link, a device or a pipe, not a file that can be replaced", path);
  return SHB_OK;
}

/* Writes a block into a file without a name. Returns 0, or what failed. */
static int write_block(const char *folder) {
  static const char block[4096];
  signal(SIGXFSZ, SIG_IGN);
  const int file = open(folder, O_TMPFILE | O_WRONLY, 0600);
  if (file < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) /* no such files */
    return access(folder, W_OK | X_OK) == 0 ? 0 : errno;
  if (file < 0) return errno;
  errno           = ENOSPC; /* of a short write */
  const int wrong = write(file, block, sizeof block) == (ssize_t)sizeof block ? 0 : errno;
  close(file);
  return wrong;
}

shb_status shb_publish_check(const char *path) {
  struct stat about;
  SHB_TRY(check_kind(path));
  SHB_CHECK(stat(path, &about) != 0 || !S_ISDIR(about.st_mode), SHB_ERR_IO,
            "%s: cannot be written: %s", path, strerror(EISDIR));
  char     *folder = folder_of(path);
  const int wrong  = write_block(folder);
  free(folder);
  SHB_CHECK(!wrong, SHB_ERR_IO, "%s: cannot be written: %s", path, strerror(wrong));
  return SHB_OK;
}

shb_status shb_publish_check_freed(char *path) {
  const shb_status status = shb_publish_check(path);
  free(path);
  return status;
}

shb_status shb_publish(const char *temporary, const char *path) {
  const shb_status kind = check_kind(path);
  if (kind != SHB_OK) {
    unlink(temporary);
    return kind;
  }
  if (sync_path(temporary, O_RDWR) != 0 || rename(temporary, path) != 0) {
    int why = errno;
    unlink(temporary);
    SHB_FAIL(SHB_ERR_IO, "%s: cannot be written: %s; the earlier file, if any, is untouched", path,
             strerror(why));
  }
  sync_folder(path);
  return SHB_OK;
}

shb_status shb_make_folder(const char *path) {
  char *part = shb_text(path);
  for (char *at = part + 1; *part && *at; at++) {
    if (*at != '/') continue;
    *at = '\0';
    (void)mkdir(part, 0777); /* the last one tells */
    *at = '/';
  }
  int         made = mkdir(part, 0777) == 0 || errno == EEXIST, why = errno;
  struct stat about;
  if (made && (stat(part, &about) != 0 || !S_ISDIR(about.st_mode))) made = 0, why = ENOTDIR;
  free(part);
  SHB_CHECK(made, SHB_ERR_IO, "%s: this folder cannot be made: %s", path, strerror(why));
  return SHB_OK;
}

bool shb_name_is_plain(const char *text) {
  const char *at = text, *end = text + strlen(text);
  for (size_t n; at < end; at += n)
    if (!shb_is_shown(shb_character(at, end, &n))) return false;
  return text[0] != '\0';
}

shb_status shb_fingerprint(const char *path, char out[17]) {
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  uint64_t      hash = 14695981039346656037u;
  unsigned char buffer[1 << 16];
  for (size_t n; (n = fread(buffer, 1, sizeof buffer, file)) > 0;)
    for (size_t i = 0; i < n; i++) hash = (hash ^ buffer[i]) * 1099511628211u;
  int bad = ferror(file);
  fclose(file);
  SHB_CHECK(!bad, SHB_ERR_IO, "%s: cannot be read", path);
  snprintf(out, 17, "%016" PRIx64, hash);
  return SHB_OK;
}
