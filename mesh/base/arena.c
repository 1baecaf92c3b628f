#include "mesh/base/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

static const size_t ALIGNMENT = 64; /* a cache line, and the widest vector */

/* A block: one alignment that holds the link to the block before, then the array. */
void *shb_arena_try(shb_arena *arena, size_t count, size_t size) {
  const size_t most  = PTRDIFF_MAX - 2 * ALIGNMENT;
  void       **block = NULL;
  if (size == 0 || count <= most / size) {
    size_t bytes = (count * size + 2 * ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    block        = aligned_alloc(ALIGNMENT, bytes);
    if (block) memset(block, 0, bytes);
  }
  if (!block) {
    arena->failed = true;
    return NULL;
  }
  *block        = arena->newest;
  arena->newest = block;
  return (char *)block + ALIGNMENT;
}

void *shb_arena_take(shb_arena *arena, size_t count, size_t size) {
  void *array = shb_arena_try(arena, count, size);
  if (!array) shb_out_of_memory((double)count * (double)size);
  return array;
}

void shb_arena_free(shb_arena *arena) {
  while (arena->newest) {
    void *block   = arena->newest;
    arena->newest = *(void **)block;
    free(block);
  }
  arena->failed = false;
}
