/* How far the curves of one rung are from those of a finer one. */
#ifndef CASES_CONVERGE_COMPARE_H
#define CASES_CONVERGE_COMPARE_H

#include "cases/converge/rung.h"
#include "modal/model/model.h"

/* The distance (postproc/analysis/curve_distance.h; unit: the largest amplitude of the preload's reference curve) of the curves STEM.response.h5 and
 * REFERENCE.response.h5, preload by preload, the greatest.
 *
 * From each point of the reference the rung's own balance is solved in the plane across the reference's curve: the distance of the two
 * points bounds that of the curves, without interpolation, on folded curves too. Where that has no solution, or it is far, the rung's
 * polyline is looked at as well and the lesser distance taken. Conversely, points of the rung that lie off the reference's polyline by
 * more than that can be off the curve (four times its sag) count as they are: a loop that the reference does not have.
 *
 *   model, settings  in  of the rung
 * Errors: SHB_ERR_INPUT the files do not hold the same preloads; SHB_ERR_IO; SHB_INTERRUPTED. */
shb_status compare_rungs(const modal_model *model, const mhb_settings *settings, post_output output,
                         const char *stem, const char *reference, rung_error *error);

/* The same against points of time integration, the file at path: from each motion that repeats every period the rung's balance is solved at
 * that frequency and preload; error->curve is the greatest |a - a'| relative to the largest amplitude of the rung's curve, error->n the number
 * of points. Those of other preloads do not count. */
shb_status compare_integration(const modal_model *model, const mhb_settings *settings,
                               post_output output, const char *stem, const char *path,
                               rung_error *error);

#endif
