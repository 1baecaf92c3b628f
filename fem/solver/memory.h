/* Memory of this machine and of this process. */
#ifndef FEM_SOLVER_MEMORY_H
#define FEM_SOLVER_MEMORY_H

/* Bytes that this process can still take: the least of what the machine has available without swapping, of what its
 * control groups leave and of its own address-space limit. Infinite where none of these can be read. */
double fem_memory_available(void);

#endif
