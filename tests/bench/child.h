/* A row of a bench in a process of its own, so that its memory can be measured. */
#ifndef BENCH_CHILD_H
#define BENCH_CHILD_H

#include <stddef.h>

#include "mesh/base/status.h"

typedef shb_status (*bench_run)(const void *input, void *row);

/* Run in a child and copy row[size], which begins as the caller's. *megabytes is the largest memory
 * of the child. SHB_NOT_CONVERGED: the named row came to no result; the child has said why. */
shb_status bench_in_child(const char *name, bench_run run, const void *input, void *row,
                          size_t size, double *megabytes);

#endif
