/* Time and memory of the phases of a stage, one after the other. */
#ifndef MESH_BASE_PHASES_H
#define MESH_BASE_PHASES_H

enum { SHB_MAX_PHASES = 16 };

/* On several ranks: the slowest rank's seconds, the sum of processor seconds and of memory. */
typedef struct {
  const char *name;
  double      seconds, cpu; /* s by the clock; s of the processor, all threads */
  double
      memory; /* bytes in main memory at the most, from the start of the process to the phase's end */
  double greatest; /* bytes, of the rank that took most */
} shb_phase;

typedef struct {
  int       n;
  shb_phase phase[SHB_MAX_PHASES];
  double    seconds, cpu; /* at the end of the last one */
} shb_phases;

/* Begin the first phase now. */
void shb_phases_start(shb_phases *phases);

/* What this process took since the last call, or the start; the next phase begins. */
shb_phase shb_phases_lap(shb_phases *phases, const char *name);

/* Keep it; times add up with an earlier phase of that name, of memory the greater counts. name: a string that lasts. */
void shb_phases_add(shb_phases *phases, const shb_phase *phase);

/* Most bytes of this process in main memory at once, so far. */
double shb_memory_peak(void);

#endif
