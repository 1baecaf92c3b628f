/* Memory that is left to this process. */
#ifndef FEM_SOLVER_MEMORY_H
#define FEM_SOLVER_MEMORY_H

/* Bytes that this process can still allocate without swapping. It is the least of the machine's
 * available memory, the limits of its control groups and its address-space limit. Infinite if none
 * can be read. */
double fem_memory_available(void);

#endif
