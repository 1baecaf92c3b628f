/* Arrays of this process, the memory that is left to it, and the refusal of what does not fit. */
#ifndef MESH_BASE_MEMORY_H
#define MESH_BASE_MEMORY_H

#include <stddef.h>

#include "mesh/base/status.h"

/* An array of count elements of size bytes, also of none. free gives it back.
 *
 * Without memory the program ends here: one line, no temporary file left, exit code SHB_ERR_IO.
 * Results are atomic and work is resumable, so nothing is lost that an error return would keep.
 * mhb/contact is a library for others: it allocates by the C library and returns errors. */
void *shb_alloc(size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, alloc_size(1, 2)));
void *shb_alloc_zeroed(size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, alloc_size(1, 2)));
/* It begins at a multiple of alignment, a power of two. */
void *shb_alloc_aligned(size_t alignment, size_t count, size_t size)
    __attribute__((malloc, returns_nonnull, alloc_size(2, 3)));
/* The array with another count; NULL: a new one. */
void *shb_realloc(void *array, size_t count, size_t size)
    __attribute__((returns_nonnull, alloc_size(2, 3), warn_unused_result));

/* A copy of a text, and of at most that many bytes of its start; a text made by printf. */
char *shb_text(const char *text) __attribute__((malloc, returns_nonnull));
char *shb_text_start(const char *text, size_t most) __attribute__((malloc, returns_nonnull));
char *shb_text_of(const char *format, ...)
    __attribute__((malloc, returns_nonnull, format(printf, 1, 2)));

/* The end of the program, for memory that a library could not get.
 *   bytes  in  that were asked for; 0: unknown */
_Noreturn void shb_out_of_memory(double bytes);

/* Bytes that this process can still allocate without swapping. It is the least of the machine's
 * available memory, the limits of its control groups and its address-space limit. Infinite if none
 * can be read. */
double shb_memory_available(void);

/* From here on each array of 2 MB or more is mapped by itself, and goes back to the system when it
 * is freed. The heap of glibc keeps arrays of up to 32 MB where anything lies above them. */
void shb_memory_map_large(void);

/* A number that memory grows with, a member of a size. */
typedef struct {
  const char *key; /* of the case */
  int        *number;
  int         least; /* below it the number is not told */
} shb_memory_number;

/* What does not fit. size is the context of bytes, and owner of the numbers. */
typedef struct {
  const char *what;                  /* "the balance with 3 contact points" */
  double (*bytes)(const void *size); /* of all processes together */
  const void              *size;
  int                      n_numbers;
  const shb_memory_number *number;
  double                   left;    /* bytes, for all */
  int                      sharing; /* processes that share the memory; at least 1 */
} shb_memory_need;

/* SHB_ERR_INPUT, in one line: the bytes that each process needs and has left, and the largest of
 * each number with which it fits. */
shb_status shb_memory_refuse(const shb_memory_need *need);

#endif
