/* The arrays of one object: each is taken from the object's arena, all are freed by one call.
 *
 * An arena of zeros is empty. Arrays are zeroed and 64-byte aligned. */
#ifndef MESH_BASE_ARENA_H
#define MESH_BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
  void *newest; /* block, linked to the one taken before */
  bool  failed; /* shb_arena_try could not get some array */
} shb_arena;

/* An array of count elements of size bytes, also of none. Without memory the program ends
 * (mesh/base/memory). */
void *shb_arena_take(shb_arena *arena, size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, alloc_size(2, 3)));

/* The same for a library that must return: NULL without memory. The arena remembers it, so that an
 * object takes all its arrays and then checks `failed` once. */
void *shb_arena_try(shb_arena *arena, size_t count, size_t size);

/* Frees every array and leaves the arena empty. */
void shb_arena_free(shb_arena *arena);

#endif
