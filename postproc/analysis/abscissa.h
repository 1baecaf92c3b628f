/* Abscissa of the curves: the frequency, or the parameter that was followed at one frequency. */
#ifndef POSTPROC_ANALYSIS_ABSCISSA_H
#define POSTPROC_ANALYSIS_ABSCISSA_H

#include <stdbool.h>

#include "mhb/response/response.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { POST_PLACE = POST_NUMBER + 16, POST_LABEL = 96 }; /* bytes */

typedef struct {
  mhb_parameter parameter;
  /* "frequency", "preload n₀", "excitation level", "friction coefficient μ", ... */
  const char *name;
  const char *symbol;   /* in a sentence: "frequency", "n₀", "level", "μ", "kuu", "kv" */
  post_unit   unit;     /* unit that suits the range; name "" for a pure number */
  double      range[2]; /* of all points, SI */
  bool        log;      /* positive and over decades; never for the frequency */
} post_abscissa;

/* Abscissa of a response; without points it has the usual unit. */
post_abscissa post_abscissa_of(const mhb_response *response);
/* [n_points of the branch] SI units, the frequency in Hz. */
const double *post_abscissa_values(const mhb_response *response, const mhb_branch *branch);

/* Value in the unit, without and with the unit's name. digits: as in post_number for the frequency,
 * as in post_plain for other parameters ("2.5"). Return out. */
char *post_abscissa_number(const post_abscissa *abscissa, double value, int digits,
                           char out[POST_NUMBER]);
char *post_abscissa_value(const post_abscissa *abscissa, double value, int digits,
                          char out[POST_NUMBER]);
/* "103.80 Hz", "n₀ = 50 N", "level 2.5". Returns out. */
char *post_abscissa_place(const post_abscissa *abscissa, double value, int digits,
                          char out[POST_PLACE]);
/* Label of an axis, with the text before in front: "frequency, Hz", "excitation level". Returns
 * out. */
char *post_abscissa_label(const post_abscissa *abscissa, const char *before, char out[POST_LABEL]);
/* Axis over the whole range. */
plot_axis post_abscissa_axis(const post_abscissa *abscissa, const char *label);

#endif
