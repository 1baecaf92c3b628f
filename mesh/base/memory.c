#include "mesh/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* Value of a line "name number kB" of a file, bytes; infinite if there is none. */
static double kilobytes_of(const char *path, const char *name) {
  char   line[256];
  double value = INFINITY, read;
  FILE  *file  = fopen(path, "r");
  while (file && fgets(line, sizeof line, file))
    if (strncmp(line, name, strlen(name)) == 0 && sscanf(line + strlen(name), "%lf", &read) == 1)
      value = 1024 * read;
  if (file) fclose(file);
  return value;
}

/* The number in a file; infinite if there is none ("max"). */
static double number_of(const char *folder, const char *name) {
  char   path[1100];
  double value = INFINITY;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "r");
  if (!file) return INFINITY;
  if (fscanf(file, "%lf", &value) != 1) value = INFINITY;
  fclose(file);
  return value;
}

/* Bytes of file pages that the kernel can drop, from memory.stat. */
static double reclaimable(const char *folder) {
  char   path[1100], line[256];
  double value = 0, read;
  snprintf(path, sizeof path, "%s/memory.stat", folder);
  FILE *file = fopen(path, "r");
  while (file && fgets(line, sizeof line, file))
    if (sscanf(line, "inactive_file %lf", &read) == 1) value = read;
  if (file) fclose(file);
  return value;
}

static double left_in_group(const char *folder, const char *limit, const char *usage) {
  const double most = number_of(folder, limit), used = number_of(folder, usage);
  return isfinite(most) && isfinite(used) ? fmax(most - used + reclaimable(folder), 0) : INFINITY;
}

/* Least memory left in the group at root + path and the groups around it. */
static double left_in_tree(const char *root, const char *path, const char *limit,
                           const char *usage) {
  char   folder[1024];
  double least = INFINITY;
  snprintf(folder, sizeof folder, "%s%s", root, strcmp(path, "/") == 0 ? "" : path);
  for (;;) {
    least       = fmin(least, left_in_group(folder, limit, usage));
    char *slash = strrchr(folder, '/');
    if (!slash || strlen(folder) <= strlen(root)) return least;
    *slash = 0;
  }
}

/* Memory left in the control groups of this process. Lines of /proc/self/cgroup are
 * "number:controllers:path", in version 2 "0::path". */
static double left_in_groups(void) {
  char   line[600];
  double least = INFINITY;
  FILE  *file  = fopen("/proc/self/cgroup", "r");
  while (file && fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = 0;
    const char *path          = strchr(line, '/');
    if (path && strncmp(line, "0::", 3) == 0)
      least = fmin(least, left_in_tree("/sys/fs/cgroup", path, "memory.max", "memory.current"));
    else if (path && strstr(line, ":memory:"))
      least = fmin(least, left_in_tree("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes",
                                       "memory.usage_in_bytes"));
  }
  if (file) fclose(file);
  return least;
}

/* Address space left by ulimit -v. */
static double left_to_address(void) {
  struct rlimit limit;
  double        used = kilobytes_of("/proc/self/status", "VmSize:");
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !isfinite(used))
    return INFINITY;
  return fmax((double)limit.rlim_cur - used, 0);
}

double shb_memory_available(void) {
  return fmin(fmin(kilobytes_of("/proc/meminfo", "MemAvailable:"), left_in_groups()),
              left_to_address());
}
