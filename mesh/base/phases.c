#include "mesh/base/phases.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "mesh/base/clock.h"

/* VmHWM counts this program alone. The peak of getrusage includes the process that started it. */
double shb_memory_peak(void) {
  char          line[256];
  double        kilobytes = -1;
  struct rusage usage;
  FILE         *file = fopen("/proc/self/status", "r");
  while (file && kilobytes < 0 && fgets(line, sizeof line, file))
    if (sscanf(line, "VmHWM: %lf", &kilobytes) != 1) kilobytes = -1;
  if (file) fclose(file);
  if (kilobytes >= 0) return 1024 * kilobytes;
  getrusage(RUSAGE_SELF, &usage);
  return 1024. * (double)usage.ru_maxrss;
}

void shb_phases_start(shb_phases *phases) {
  *phases = (shb_phases){.seconds = shb_seconds(), .cpu = shb_processor_seconds()};
}

shb_phase shb_phases_lap(shb_phases *phases, const char *name) {
  const double seconds = shb_seconds(), cpu = shb_processor_seconds(), memory = shb_memory_peak();
  shb_phase    lap = {name, seconds - phases->seconds, cpu - phases->cpu, memory, memory};
  phases->seconds  = seconds;
  phases->cpu      = cpu;
  return lap;
}

static shb_phase *find(shb_phases *phases, const char *name) {
  for (int i = 0; i < phases->n; i++)
    if (strcmp(phases->phase[i].name, name) == 0) return &phases->phase[i];
  return NULL;
}

void shb_phases_add(shb_phases *phases, const shb_phase *phase) {
  shb_phase *same = find(phases, phase->name);
  if (!same && phases->n < SHB_MAX_PHASES) {
    phases->phase[phases->n++] = *phase;
  } else if (same) {
    same->seconds += phase->seconds;
    same->cpu += phase->cpu;
    if (phase->memory > same->memory) same->memory = phase->memory;
    if (phase->greatest > same->greatest) same->greatest = phase->greatest;
  }
}
