#include "mesh/base/memory.h"

#include <malloc.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"

/* ---- arrays ---- */

/* Nothing here allocates memory. A progress line on a terminal is cleared. */
void shb_out_of_memory(double bytes) {
  char        line[240], block[64] = "a block";
  const char *clear = isatty(STDERR_FILENO) ? "\r\033[K" : "";
  if (bytes > 0) snprintf(block, sizeof block, "a block of %.3g MB", 1e-6 * bytes);
  snprintf(line, sizeof line,
           "%sshroudhb: error: out of memory: %s cannot be had; fewer nodes, harmonics, points or "
           "threads need less\n",
           clear, block);
  shb_end_at_once(line, SHB_ERR_IO);
}

/* Bytes of an array; at least 1. The product must be that of an object of C. */
static size_t bytes_of(size_t count, size_t size) {
  if (size > 0 && count > PTRDIFF_MAX / size) shb_out_of_memory((double)count * (double)size);
  return count * size > 0 ? count * size : 1;
}

static void *given(void *array, size_t bytes) {
  if (!array) shb_out_of_memory((double)bytes);
  return array;
}

void *shb_alloc(size_t count, size_t size) {
  const size_t bytes = bytes_of(count, size);
  return given(malloc(bytes), bytes);
}

void *shb_alloc_zeroed(size_t count, size_t size) {
  const size_t bytes = bytes_of(count, size);
  return given(calloc(1, bytes), bytes);
}

void *shb_alloc_aligned(size_t alignment, size_t count, size_t size) {
  const size_t bytes = bytes_of(count, size);
  const size_t whole = bytes_of((bytes + alignment - 1) / alignment, alignment);
  return given(aligned_alloc(alignment, whole), whole);
}

void *shb_realloc(void *array, size_t count, size_t size) {
  const size_t bytes = bytes_of(count, size);
  return given(realloc(array, bytes), bytes);
}

char *shb_text(const char *text) {
  return shb_text_start(text, PTRDIFF_MAX);
}

char *shb_text_start(const char *text, size_t most) {
  const size_t length = strnlen(text, most);
  char        *copy   = shb_alloc(length + 1, 1);
  memcpy(copy, text, length);
  copy[length] = '\0';
  return copy;
}

char *shb_text_of(const char *format, ...) {
  va_list args, again;
  va_start(args, format);
  va_copy(again, args);
  const int length = vsnprintf(NULL, 0, format, args);
  va_end(args);
  char *text = shb_alloc((size_t)(length > 0 ? length : 0) + 1, 1);
  text[0]    = '\0';
  vsnprintf(text, (size_t)(length > 0 ? length : 0) + 1, format, again);
  va_end(again);
  return text;
}

/* ---- what is left ---- */

enum { LARGE = 1 << 21 };

void shb_memory_map_large(void) {
  mallopt(M_MMAP_THRESHOLD, LARGE);
  mallopt(M_TRIM_THRESHOLD, 2 * LARGE); /* as glibc sets it beside the other */
}

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

/* Memory that malloc holds and that nothing uses, about. It is counted as used elsewhere. */
static double held_by_malloc(void) {
  const double           slack = 64e6; /* stacks, and buffers that are mapped */
  const struct mallinfo2 all   = mallinfo2();
  const double           own   = kilobytes_of("/proc/self/status", "RssAnon:");
  if (all.uordblks == 0 || !isfinite(own)) return 0; /* another malloc is in its place */
  return fmax(own - (double)all.uordblks - (double)all.hblkhd - slack, 0);
}

double shb_memory_available(void) {
  const double left = fmin(kilobytes_of("/proc/meminfo", "MemAvailable:"), left_in_groups());
  return fmin(left + held_by_malloc(), left_to_address());
}

/* ---- what fits ---- */

static const double GIGA = 1e9;

/* The largest number up to the present one with which the size fits; 0: none. */
static int fits(const shb_memory_need *need, int *number) {
  const int all = *number;
  int       low = 0, high = all; /* low fits, or is 0; bytes grow with the number */
  while (low < high) {
    *number = low + (high - low + 1) / 2;
    if (need->bytes(need->size) <= need->left)
      low = *number;
    else
      high = *number - 1;
  }
  *number = all;
  return low;
}

shb_status shb_memory_refuse(const shb_memory_need *need) {
  const double needed   = need->bytes(need->size) / need->sharing;
  const double left     = need->left / need->sharing;
  char         fit[200] = "", sharing[64] = "";
  size_t       length = 0;
  for (int i = 0; i < need->n_numbers && length < sizeof fit; i++) {
    const shb_memory_number *n       = &need->number[i];
    const int                largest = fits(need, n->number);
    if (largest >= n->least)
      length += (size_t)snprintf(fit + length, sizeof fit - length, "%s %s: %d fits",
                                 length ? ", or" : ";", n->key, largest);
  }
  if (need->sharing > 1)
    snprintf(sharing, sizeof sharing, " for each of %d processes", need->sharing);
  SHB_FAIL(SHB_ERR_INPUT, "%s needs about %.3g GB more memory, and %.3g GB are left%s%s",
           need->what, needed / GIGA, left / GIGA, sharing, fit);
}
