/* Memory that is left to this process, and the refusal of what does not fit. */
#ifndef MESH_BASE_MEMORY_H
#define MESH_BASE_MEMORY_H

#include "mesh/base/status.h"

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
