/* Time and memory of the phases of a stage. */
#ifndef MESH_BASE_PHASES_H
#define MESH_BASE_PHASES_H

enum { SHB_MAX_PHASES = 16 };

/* On several ranks: seconds of the slowest rank, sums of processor seconds and of memory. */
typedef struct {
  const char *name;
  double      seconds, cpu; /* s by the clock; s of the processor, all threads */
  double      memory;       /* bytes: peak resident memory of the process, up to the phase's end */
  double      greatest;     /* bytes of the rank with the largest peak */
} shb_phase;

typedef struct {
  int       n;
  shb_phase phase[SHB_MAX_PHASES];
  double    seconds, cpu; /* at the end of the last phase */
} shb_phases;

/* Begin the first phase now. */
void shb_phases_start(shb_phases *phases);

/* Resources since the last call, or since the start. The next phase begins. */
shb_phase shb_phases_lap(shb_phases *phases, const char *name);

/* Record a phase. Times add up with an earlier phase of that name; of memory the larger value
 * counts.
 *   phase->name  in  a string that outlives phases */
void shb_phases_add(shb_phases *phases, const shb_phase *phase);

/* Peak resident memory of this process so far, bytes. */
double shb_memory_peak(void);

#endif
