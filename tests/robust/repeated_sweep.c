/* The same sweep again and again in one process. After the last one as many blocks of the heap are
 * live as after the third, and memory has not grown. The end of a process would hide it.
 *
 * usage: repeated_sweep SWEEPS CASE [LOST]   in the folder of the case
 *
 * LOST: bytes that the program loses on purpose after each sweep.
 *
 * Every block is counted, those of the libraries too. mallinfo2 would not do. It takes the free
 * blocks that each thread keeps in its cache for live ones. The caches fill over 100 sweeps. */
#include <errno.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cases/commands/stages.h"

/* glibc's own functions, which the definitions below hide */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void  __libc_free(void *block);

static atomic_long live_blocks, live_bytes;

static void *counted(void *block) {
  if (block) {
    atomic_fetch_add(&live_blocks, 1);
    atomic_fetch_add(&live_bytes, (long)malloc_usable_size(block));
  }
  return block;
}

static void discount(size_t size) {
  atomic_fetch_sub(&live_blocks, 1);
  atomic_fetch_sub(&live_bytes, (long)size);
}

void *malloc(size_t size) {
  return counted(__libc_malloc(size));
}

void *calloc(size_t n, size_t size) {
  return counted(__libc_calloc(n, size));
}

void free(void *block) {
  if (block) discount(malloc_usable_size(block));
  __libc_free(block);
}

void *realloc(void *block, size_t size) {
  const size_t before = block ? malloc_usable_size(block) : 0;
  void        *after  = __libc_realloc(block, size);
  if (block && (after || size == 0)) discount(before);
  return counted(after);
}

void *memalign(size_t alignment, size_t size) {
  return counted(__libc_memalign(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
  *block = memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}

typedef struct {
  long   blocks, bytes;
  double resident; /* bytes */
} memory;

static memory measure(void) {
  const memory heap  = {atomic_load(&live_blocks), atomic_load(&live_bytes), 0};
  FILE        *file  = fopen("/proc/self/statm", "r");
  long         pages = 0;
  if (!file || fscanf(file, "%*d %ld", &pages) != 1) exit(2);
  fclose(file);
  return (memory){heap.blocks, heap.bytes, (double)pages * (double)sysconf(_SC_PAGESIZE)};
}

int main(int argc, char **argv) {
  const int    sweeps = argc >= 3 ? (int)strtol(argv[1], NULL, 10) : 0;
  const size_t lost   = argc >= 4 ? strtoul(argv[3], NULL, 10) : 0;
  if (sweeps < 10) return 2;
  const int settled = sweeps / 10 > 3 ? sweeps / 10 : 3; /* threads and libraries have begun */
  const command_options options = {.quiet = true, .force = true, .path = argv[2]};
  memory                early   = {0}, late;
  for (int i = 1; i <= sweeps; i++) {
    if (mhb_command(&options) != 0) {
      fprintf(stderr, "sweep %d failed\n", i);
      return 1;
    }
    if (i == settled) early = measure();
    void *volatile forgotten = lost ? malloc(lost) : NULL;
    (void)forgotten;
  }
  late              = measure();
  const long   more = late.blocks - early.blocks, bytes = late.bytes - early.bytes;
  const double grown = late.resident - early.resident;
  printf("%d sweeps: %ld live blocks, %+ld; %ld bytes, %+ld; resident %.1f MB, %+.2f MB\n", sweeps,
         late.blocks, more, late.bytes, bytes, 1e-6 * late.resident, 1e-6 * grown);
  /* A block may be some bytes larger than asked for. Threads return freed memory late: a sweep uses
   * some MB. */
  return more <= 2 && bytes < 4096 && grown < 4e6 ? 0 : 1;
}
