#include "mesh/base/arena.h"

#include <stdint.h>
#include <stdlib.h>

static const size_t ALIGNMENT = 64; /* a cache line, and the widest vector */

/* What is before an array. */
typedef struct {
  void *before; /* the block before */
  void *memory; /* of this block */
} header;

/* A block: up to one alignment unused, one alignment with its header, then the array. calloc leaves
 * large blocks to the system, which gives zeroed pages when they are first touched. */
void *shb_arena_take(shb_arena *arena, size_t count, size_t size) {
  const size_t most   = PTRDIFF_MAX - 2 * ALIGNMENT;
  char        *memory = NULL;
  if (size == 0 || count <= most / size) memory = calloc(count * size + 2 * ALIGNMENT, 1);
  if (!memory) {
    arena->failed = true;
    return NULL;
  }
  char   *at    = memory + (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT;
  header *block = (header *)(void *)at;
  *block        = (header){.before = arena->newest, .memory = memory};
  arena->newest = block;
  return at + ALIGNMENT;
}

void shb_arena_free(shb_arena *arena) {
  while (arena->newest) {
    const header block = *(header *)arena->newest;
    arena->newest      = block.before;
    free(block.memory);
  }
  arena->failed = false;
}
