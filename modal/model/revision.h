/* A modal file with other damping or another amplitude of the load, made from an earlier one.
 * Modes, receptance without damping and equilibrium depend on neither. The response to the load is
 * proportional to it. */
#ifndef MODAL_MODEL_REVISION_H
#define MODAL_MODEL_REVISION_H

#include <complex.h>

#include "mesh/base/publish.h"
#include "modal/model/damping.h"

enum { MODAL_REVISED_HARMONICS = 64 };

typedef struct {
  modal_damping  damping;
  double complex ratio[MODAL_REVISED_HARMONICS + 1]; /* of harmonic k, new over earlier, not 0 */
} modal_revision;

/* Write path from the earlier file, of one speed or several, of a blade or a sector; both may be
 * one. The result is that of a new solution but for rounding. After an error path stays as it was.
 * Errors: SHB_ERR_INPUT the earlier file was changed since it was written, or a damping ratio is 1
 * or more; SHB_ERR_IO. */
shb_status modal_revise(const char *earlier, const char *path, const modal_revision *revision,
                        const shb_provenance *provenance);

#endif
