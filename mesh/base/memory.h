/* Memory that is left to this process. */
#ifndef MESH_BASE_MEMORY_H
#define MESH_BASE_MEMORY_H

/* Bytes that this process can still allocate without swapping. It is the least of the machine's
 * available memory, the limits of its control groups and its address-space limit. Infinite if none
 * can be read. */
double shb_memory_available(void);

#endif
