/* Whole curves of contact faces with many pairs and stiff contact, where each pair begins to slip
 * by itself.
 *
 * The files are modal files of cases/z_notch_blade with `points: all`. Contact to the neighbour,
 * 10 N, 600 to 1200 Hz, 7 harmonics, 100 and 300 times the stiffness of the case. */
#ifndef BENCH_STIFF_FACES_H
#define BENCH_STIFF_FACES_H

#include "mesh/base/status.h"

/* A row a file and stiffness, each in a process of its own. *failed counts curves that do not reach
 * the end of the range, and residuals above 1e-8, never times. */
shb_status bench_stiff_faces(char **files, int n, int *failed);

#endif
