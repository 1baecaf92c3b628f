/* Runs a target without libFuzzer: over files, and over random changes of them.
 * usage: fuzz_TARGET [-runs=N] FILE|FOLDER...   N changes of every file, 0 by default */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "tests/fuzz/fuzz_file.h"

enum { PATH_ROOM = 1024, MOST_CHANGES = 6 };

static uint64_t state = 88172645463325252u;

/* Xorshift of Marsaglia (2003): below n. */
static size_t below(size_t n) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (size_t)(state % n);
}

/* Replace, insert, delete or repeat at random places. Returns the new size. */
static size_t change(uint8_t *data, size_t size) {
  for (size_t times = 1 + below(MOST_CHANGES); times > 0 && size > 2; times--) {
    size_t at = below(size), n = 1 + below(size - at < 16 ? size - at : 16);
    switch (below(4)) {
      case 0:
        data[at] = (uint8_t)below(256);
        break;
      case 1:
        memmove(data + at, data + at + n, size - at - n);
        size -= n;
        break;
      case 2:
        if (size + n > FUZZ_MOST) break;
        memmove(data + at + n, data + at, size - at);
        size += n;
        break;
      default:
        data[at] = (uint8_t) "0123456789-+.eE:[]{},# \n*%"[below(26)];
    }
  }
  return size;
}

static int run_file(const char *path, int runs) {
  static uint8_t whole[FUZZ_MOST], changed[FUZZ_MOST];
  FILE          *file = fopen(path, "rb");
  fuzz_assert(file != NULL, path);
  size_t size = fread(whole, 1, sizeof whole, file);
  fclose(file);
  LLVMFuzzerTestOneInput(whole, size);
  for (int i = 0; i < runs; i++) {
    memcpy(changed, whole, size);
    LLVMFuzzerTestOneInput(changed, change(changed, size));
  }
  return 1 + runs;
}

static int run(const char *path, int runs) {
  struct stat about;
  int         n = 0;
  fuzz_assert(stat(path, &about) == 0, path);
  if (!S_ISDIR(about.st_mode)) return run_file(path, runs);
  struct dirent **entry;
  int             entries = scandir(path, &entry, NULL, alphasort);
  for (int i = 0; i < entries; i++) {
    char below_it[PATH_ROOM];
    snprintf(below_it, sizeof below_it, "%s/%s", path, entry[i]->d_name);
    if (entry[i]->d_name[0] != '.') n += run(below_it, runs);
    free(entry[i]);
  }
  if (entries >= 0) free(entry);
  return n;
}

int main(int argc, char **argv) {
  int runs = 0, n = 0;
  for (int i = 1; i < argc; i++)
    if (strncmp(argv[i], "-runs=", 6) == 0) runs = (int)strtol(argv[i] + 6, NULL, 10);
  for (int i = 1; i < argc; i++)
    if (argv[i][0] != '-') n += run(argv[i], runs);
  fuzz_assert(n > 0, "no inputs");
  printf("%d inputs\n", n);
  return 0;
}
