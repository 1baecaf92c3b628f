/* Memory that the curve of one preload takes, foreseen from sizes; how many preloads fit at a time.
 *
 * Counted are the large arrays of the first level of harmonics and of stability, and a curve of a
 * thousand points. The motion that lasts follows the sweep, and counts where it takes more.
 * Only as many contact points slip at a time as the estimate takes for moving, so it lies above
 * what most runs take. docs/user/limits.md compares it with measured runs. */
#ifndef MHB_BRANCHES_SWEEP_MEMORY_H
#define MHB_BRANCHES_SWEEP_MEMORY_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

typedef struct {
  int  pairs;     /* contact points; of one contact in a ring of different blades */
  int  harmonics; /* kept in the balance */
  int  blades;    /* of a ring of different blades; 0: one blade, or a wave */
  int  wave;      /* blades that a wave goes round; 1: on the ground */
  int  modes;     /* of a blade */
  bool disc;      /* residual terms of each harmonic */
  bool run_up;    /* the model changes with the frequency: no GMRES with many pairs */
  bool stability; /* multipliers are computed */
  bool lasting;   /* the motion that lasts is integrated */
  int  points;    /* of the curve; 1000 */
  int  sharing;   /* processes that share the memory, each with a curve; at least 1 */
} mhb_sweep_size;

/* model: the whole ring where the blades differ. */
mhb_sweep_size mhb_sweep_size_of(const modal_model *model, const mhb_settings *settings);

/* Bytes for one preload. */
double mhb_sweep_bytes(const mhb_sweep_size *size);

/* SHB_ERR_INPUT: the memory left is too little for one preload in each process. The message has the
 * bytes needed and left, and the most harmonics, contact points, blades and processes that fit. */
shb_status mhb_sweep_fits(const mhb_sweep_size *size);

/* Preloads that memory allows at a time, as many as there are threads at most. Errors: as
 * mhb_sweep_fits. */
shb_status mhb_sweep_threads(const modal_model *model, const mhb_settings *settings, int *threads);

#endif
