#include "modal/common/phases.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "modal/hdf5/h5.h"

static void reduce_over_ranks(MPI_Comm comm, shb_phase *phase) {
  double sum[2] = {phase->cpu, phase->memory}, greatest[2] = {phase->seconds, phase->greatest};
  MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, greatest, 2, MPI_DOUBLE, MPI_MAX, comm);
  phase->cpu      = sum[0];
  phase->memory   = sum[1];
  phase->seconds  = greatest[0];
  phase->greatest = greatest[1];
}

static void report(shb_progress *progress, int ranks, const shb_phase *phase, const char *text) {
  char apart[64] = "";
  if (ranks > 1)
    snprintf(apart, sizeof apart, " on %d ranks, at most %.0f MB a rank", ranks,
             1e-6 * phase->greatest);
  shb_progress_note(progress, "%s: %s: %.2f s, CPU %.2f s, peak %.0f MB%s", phase->name, text,
                    phase->seconds, phase->cpu, 1e-6 * phase->memory, apart);
}

void modal_phase(MPI_Comm comm, shb_progress *progress, const char *name, const char *format, ...) {
  char    text[240];
  int     ranks;
  va_list args;
  if (!progress) return;
  shb_phase phase = shb_phases_lap(&progress->phases, name);
  MPI_Comm_size(comm, &ranks);
  reduce_over_ranks(comm, &phase);
  shb_phases_add(&progress->phases, &phase);
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  report(progress, ranks, &phase, text);
}

static shb_status write_column(hid_t file, const char *path, int n, const double *value,
                               const char *units, const char *long_name) {
  SHB_TRY(h5_write_double(file, path, H5_SHAPE((hsize_t)n), value, units, long_name));
  return h5_attach_scale(file, path, 0, "/phases/name");
}

shb_status modal_phases_write(hid_t file, int ranks, const shb_progress *progress,
                              const char *name) {
  const char *names[SHB_MAX_PHASES];
  double      seconds[SHB_MAX_PHASES], cpu[SHB_MAX_PHASES], memory[SHB_MAX_PHASES];
  double      greatest[SHB_MAX_PHASES];
  if (!progress) return SHB_OK;
  shb_phases phases = progress->phases; /* a copy: the current phase continues */
  shb_phase  last   = shb_phases_lap(&phases, name);
  if (phases.n > 0) { /* other ranks still hold their memory */
    const shb_phase *before = &phases.phase[phases.n - 1];
    last.memory             = fmax(last.memory, before->memory);
    last.greatest           = fmax(last.greatest, before->greatest);
  }
  shb_phases_add(&phases, &last);
  for (int i = 0; i < phases.n; i++) {
    names[i]    = phases.phase[i].name;
    seconds[i]  = phases.phase[i].seconds;
    cpu[i]      = phases.phase[i].cpu;
    memory[i]   = phases.phase[i].memory;
    greatest[i] = phases.phase[i].greatest;
  }
  SHB_TRY(h5_write_strings(file, "/phases/name", phases.n, names, "phase of the modal stage"));
  SHB_TRY(write_column(file, "/phases/seconds", phases.n, seconds, "s", "time by the clock"));
  SHB_TRY(write_column(file, "/phases/cpu", phases.n, cpu, "s", "processor time, all ranks"));
  SHB_TRY(write_column(file, "/phases/memory", phases.n, memory, "B",
                       "most main memory up to the end of the phase, all ranks"));
  SHB_TRY(write_column(file, "/phases/greatest_memory", phases.n, greatest, "B",
                       "the same of the rank that took most"));
  return h5_write_attribute_int(file, "/phases", "ranks", ranks);
}
