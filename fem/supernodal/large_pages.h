/* Memory in pages of 2 MB. A page fault costs as much as filling 4 kB, and large arrays have many;
 * where the system has no large pages nothing changes. Free of PETSc. */
#ifndef FEM_SUPERNODAL_LARGE_PAGES_H
#define FEM_SUPERNODAL_LARGE_PAGES_H

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "mesh/base/memory.h"

enum { FEM_LARGE_PAGE = 1 << 21 };

/* Ask for them in memory that is there and not yet touched. */
static inline void fem_prefer_large_pages(void *memory, size_t bytes) {
  const uintptr_t page = FEM_LARGE_PAGE, begin = ((uintptr_t)memory + page - 1) / page * page;
  const uintptr_t end = ((uintptr_t)memory + bytes) / page * page;
  if (memory && end > begin)
    madvise((char *)memory + (begin - (uintptr_t)memory), end - begin, MADV_HUGEPAGE);
}

/* As shb_alloc. It begins at a cache line. Greater alignments leave gaps in glibc's heap. */
static inline void *fem_large_alloc(size_t count, size_t size) {
  const size_t line   = 64;
  void        *memory = shb_alloc_aligned(line, count, size);
  fem_prefer_large_pages(memory, count * size);
  return memory;
}

#endif
