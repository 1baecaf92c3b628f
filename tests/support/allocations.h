/* Allocations by a test program, counted by the linker's --wrap of malloc, calloc, realloc and aligned_alloc. */
#ifndef TESTS_SUPPORT_ALLOCATIONS_H
#define TESTS_SUPPORT_ALLOCATIONS_H

#include <stddef.h>

extern long allocations;

#endif
