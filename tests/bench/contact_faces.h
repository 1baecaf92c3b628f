/* Contact faces with many pairs: milliseconds a point by the low-rank solver and by the dense one.
 *
 * The files are modal files of cases/z_notch_blade with `points: all` and mesh.blade.shroud_size 9,
 * 4, 2, 1.4 mm: 22, 84, 237, 462 pairs. */
#ifndef BENCH_CONTACT_FACES_H
#define BENCH_CONTACT_FACES_H

#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

/* Contact of cases/z_notch_blade at 100 N, 200 to 262 Hz, with 7 harmonics. */
mhb_settings contact_faces_settings(void);

/* A row a file, each in a process of its own. Goals have verdicts. *failed counts residuals above
 * 1e-8 and dense steps that lead elsewhere, never times. */
shb_status bench_contact_faces(char **files, int n, int *failed);

#endif
