#include "mesh/base/arena.h"

#include <stdint.h>
#include <stdlib.h>

static const size_t ALIGNMENT = 64; /* a cache line, and the widest vector */

/* A block: one alignment that holds the link to the block before and the start of the memory, then
 * the array. Memory comes cleared, so that pages which nobody writes are not touched. */
typedef struct block {
  struct block *before;
  void         *memory;
} block;

void *shb_arena_take(shb_arena *arena, size_t count, size_t size) {
  const size_t most   = PTRDIFF_MAX - 3 * ALIGNMENT;
  char        *memory = NULL;
  if (size == 0 || count <= most / size) /* the array ends with a whole alignment */
    memory = calloc((count * size + 3 * ALIGNMENT - 1) / ALIGNMENT, ALIGNMENT);
  if (!memory) {
    arena->failed = true;
    return NULL;
  }
  const size_t beyond = (uintptr_t)memory % ALIGNMENT;
  block       *newest = (block *)(void *)(memory + (beyond ? ALIGNMENT - beyond : 0));
  *newest             = (block){arena->newest, memory};
  arena->newest       = newest;
  return (char *)newest + ALIGNMENT;
}

void shb_arena_free(shb_arena *arena) {
  while (arena->newest) {
    block *newest = arena->newest;
    arena->newest = newest->before;
    free(newest->memory);
  }
  arena->failed = false;
}
