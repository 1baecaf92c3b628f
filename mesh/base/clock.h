/* Wall-clock time and processor time. */
#ifndef MESH_BASE_CLOCK_H
#define MESH_BASE_CLOCK_H

/* Seconds of a monotonic clock; its zero is arbitrary. */
double shb_seconds(void);

/* Processor seconds of this process so far, sum of all threads. */
double shb_processor_seconds(void);

#endif
