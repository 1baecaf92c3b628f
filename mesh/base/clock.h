/* Time by the clock and time of the processor. */
#ifndef MESH_BASE_CLOCK_H
#define MESH_BASE_CLOCK_H

/* Seconds of a clock that never goes back; its zero is arbitrary. */
double shb_seconds(void);

/* Processor seconds of this process so far, all threads. */
double shb_processor_seconds(void);

#endif
