/* Allocations of a test program, counted by the linker's --wrap of malloc and its relatives. */
#ifndef TESTS_SUPPORT_ALLOCATIONS_H
#define TESTS_SUPPORT_ALLOCATIONS_H

#include <stddef.h>

extern long allocations;

#endif
