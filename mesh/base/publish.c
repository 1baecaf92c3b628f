#include "mesh/base/publish.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_TEMPORARY = 8 };

static const char MSH[] = ".msh";

/* Names of temporary files that may exist. Names of published or removed files do no harm. Longer
 * names are not registered. */
static struct {
  volatile sig_atomic_t used;
  char                  name[1024];
} temporaries[MAX_TEMPORARY];

static void register_temporary(const char *name) {
  static atomic_int next;
  int               at = atomic_fetch_add(&next, 1) % MAX_TEMPORARY;
  temporaries[at].used = 0;
  if (strlen(name) >= sizeof temporaries[at].name) return;
  strcpy(temporaries[at].name, name);
  temporaries[at].used = 1;
}

void shb_publish_abandon(void) {
  for (int i = 0; i < MAX_TEMPORARY; i++)
    if (temporaries[i].used) unlink(temporaries[i].name);
}

/* A run over several machines: the processes of the others are not known here. */
static int is_distributed(void) {
  const char *all = getenv("OMPI_COMM_WORLD_SIZE"), *here = getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  const char *nodes = getenv("SLURM_NNODES");
  return (all && here && strcmp(all, here) != 0) || (nodes && strcmp(nodes, "1") != 0);
}

/* Remove PATH.tmp.PID and PATH.tmp.PID.msh of processes that are gone, such as killed ones. */
static void remove_orphans(const char *path) {
  if (is_distributed()) return;
  const char  *slash  = strrchr(path, '/');
  const char  *leaf   = slash ? slash + 1 : path;
  const size_t n      = strlen(leaf);
  char        *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
  DIR         *list   = folder ? opendir(folder) : NULL;
  for (struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
    if (strncmp(entry->d_name, leaf, n) != 0 || strncmp(entry->d_name + n, ".tmp.", 5) != 0)
      continue;
    char      *end;
    const long process = strtol(entry->d_name + n + 5, &end, 10);
    const bool ours    = process > 0 && process <= INT_MAX && (!*end || strcmp(end, MSH) == 0);
    if (!ours || kill((pid_t)process, 0) == 0 || errno != ESRCH) continue;
    unlinkat(dirfd(list), entry->d_name, 0);
  }
  if (list) closedir(list);
  free(folder);
}

static char *temporary_name(const char *path, const char *ending) {
  size_t size = strlen(path) + 36;
  char  *name = malloc(size);
  if (name) snprintf(name, size, "%s.tmp.%ld%s", path, (long)getpid(), ending);
  if (name) register_temporary(name);
  return name;
}

char *shb_publish_temporary(const char *path) {
  signal(SIGXFSZ, SIG_IGN); /* a write beyond the file size limit is then an error */
  remove_orphans(path);
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
  const char *slash = strrchr(path, '/');
  if (!slash) {
    (void)sync_path(".", O_RDONLY);
    return;
  }
  char *folder = strndup(path, slash == path ? 1 : (size_t)(slash - path));
  if (!folder) return;
  (void)sync_path(folder, O_RDONLY);
  free(folder);
}

/* A rename would replace a device, a pipe or a link. */
static int can_be_replaced(const char *path) {
  struct stat about;
  return lstat(path, &about) != 0 || S_ISREG(about.st_mode) || S_ISDIR(about.st_mode);
}

shb_status shb_publish(const char *temporary, const char *path) {
  if (!can_be_replaced(path)) {
    unlink(temporary);
    SHB_FAIL(SHB_ERR_IO, "%s: is a link, a device or a pipe, not a file that can be replaced",
             path);
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
  char *part = strdup(path);
  SHB_CHECK(part, SHB_ERR_IO, "%s: out of memory", path);
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
