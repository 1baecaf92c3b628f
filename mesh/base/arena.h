/* The arrays of one object: each is taken from the object's arena, all are freed by one call.
 *
 * An arena of zeros is empty. Arrays are zeroed and 64-byte aligned. The arena remembers a failure:
 * an object takes all its arrays and then checks `failed` once. */
#ifndef MESH_BASE_ARENA_H
#define MESH_BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
  void *newest; /* block, linked to the one taken before */
  bool  failed; /* some array could not be had */
} shb_arena;

/* An array of count elements of size bytes; never NULL for count or size 0. NULL without memory. */
void *shb_arena_take(shb_arena *arena, size_t count, size_t size);

/* Frees every array and leaves the arena empty. */
void shb_arena_free(shb_arena *arena);

#endif
