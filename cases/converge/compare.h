/* Distance of the curves of one rung from those of a finer rung. */
#ifndef CASES_CONVERGE_COMPARE_H
#define CASES_CONVERGE_COMPARE_H

#include "cases/commands/load_model.h"
#include "cases/converge/rung.h"
#include "modal/model/model.h"

/* Distance of the curves in STEM.response.h5 from those in REFERENCE.response.h5: the largest over
 * the preloads, relative to the largest amplitude of the preload's reference curve. The measure is
 * that of postproc/analysis/curve_distance.h.
 *
 * From each point of the reference the rung's own balance is solved in the plane across the
 * reference curve. The distance of the two points bounds that of the curves. It needs no
 * interpolation, and holds on folded curves too. If the balance has no solution there, or only a
 * distant one, the rung's polyline is compared as well and the smaller distance counts.
 *
 * Conversely, a point of the rung counts with its distance from the reference polyline, if that
 * exceeds four times the polyline's sag. Loops that the reference lacks are found in this way.
 *
 * A secondary branch that only one of them has counts with its distance from the nearest branch of
 * the same preload in the other file.
 *
 *   source  in  model and settings of the rung. Where the rung's pairs are those of the reference
 *               joined to patches, the motion of the reference becomes the mean over each patch.
 *
 * Errors: SHB_ERR_INPUT the files do not hold the same preloads; SHB_ERR_IO; SHB_INTERRUPTED. */
shb_status compare_rungs(const case_model *source, post_output output, const char *stem,
                         const char *reference, rung_error *error);

/* The same against points of time integration in the file at path. For each periodic point the
 * rung's balance is solved at its frequency and preload, starting from its motion. Points of other
 * preloads are left out.
 *
 *   error->curve  out  largest |a - a'| relative to the largest amplitude of the rung's curve
 *   error->n      out  number of points */
shb_status compare_integration(const modal_model *model, const mhb_settings *settings,
                               post_output output, const char *stem, const char *path,
                               rung_error *error);

#endif
