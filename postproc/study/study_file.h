/* NAME.study.h5: a design study as a file (format "shroudhb study", version 1).
 *
 *   attributes of /   kind "study", name, plan, study_path, case_path, finished; the texts are in
 *                     study_text and case_text
 *   /design           key [k], unit [k], value [n,k], status [n] (0 not run, 1 done, 2 failed,
 *                     3 not converged), reason [n], digest [n], seconds [n]
 *   /output           name [m], unit [m], value [n,m], error [n,m]
 *   /derivative       key [p], unit [p], case_value [p] (of the parameter), value [n,p]; only with
 *                     p > 0
 *   /curve            start [n+1], branch, frequency, amplitude, stable: the points of design i are
 *                     start[i] to start[i+1] - 1
 *   /optimum          attributes method, objective, note, best (design, -1: none); history [h],
 *                     on_bound [k]; only after an optimisation
 *   /uncertainty      attributes samples, failed, confidence; level [q], mean [m], deviation [m],
 *                     percentile, percentile_low, percentile_high [m,q]; sobol_first, sobol_total
 *                     and their _low, _high [m,k]; only with uncertain keys
 *   /robust           attributes confidence; key [g,v], samples, failed [g]; level [q], mean,
 *                     deviation [g,m], percentile, percentile_low, percentile_high [g,m,q]: at each
 *                     design of the first v keys, over the samples of the others; only with both
 *
 * Our HDF5 files hold finite numbers only: an unknown number is STUDY_UNKNOWN. Designs are counted
 * from 0 here, and from 1 for users (NAME.study.csv, --design). */
#ifndef POSTPROC_STUDY_STUDY_FILE_H
#define POSTPROC_STUDY_STUDY_FILE_H

#include <float.h>

#include "postproc/study/design_study.h"

#define STUDY_UNKNOWN (-DBL_MAX)

/* Publish a study at path. Errors: SHB_ERR_IO. */
shb_status study_file_write(const design_study *study, const char *path);

/* Read a study; unknown numbers become NAN. Free it with design_study_free after success. Errors:
 * SHB_ERR_IO; SHB_ERR_INPUT foreign format, lists of different length, codes out of range. */
shb_status study_file_read(const char *path, design_study *study);

#endif
