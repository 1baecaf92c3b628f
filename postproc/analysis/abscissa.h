/* What curves are drawn against: the frequency, or the parameter that was followed at one frequency. */
#ifndef POSTPROC_ANALYSIS_ABSCISSA_H
#define POSTPROC_ANALYSIS_ABSCISSA_H

#include <stdbool.h>

#include "mhb/response/response.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { POST_PLACE = POST_NUMBER + 16, POST_LABEL = 96 }; /* bytes */

typedef struct {
  mhb_parameter parameter;
  const char
      *name; /* "frequency", "preload n₀", "excitation level", "friction coefficient μ", ... */
  const char *symbol;   /* in a sentence: "frequency", "n₀", "level", "μ", "kuu", "kv" */
  post_unit   unit;     /* that reads best over the range; name "" for a mere number */
  double      range[2]; /* of all points, SI */
  bool        log;      /* positive over decades, not the frequency */
} post_abscissa;

/* lo > hi (no point) gives the usual unit. */
post_abscissa post_abscissa_of(const mhb_response *response);
/* [n_points of the branch] in SI, the frequency in Hz. */
const double *post_abscissa_values(const mhb_response *response, const mhb_branch *branch);

/* In the unit, without and with its name; digits as of post_number for the frequency, of post_plain for the others ("2.5"). Return out. */
char *post_abscissa_number(const post_abscissa *abscissa, double value, int digits,
                           char out[POST_NUMBER]);
char *post_abscissa_value(const post_abscissa *abscissa, double value, int digits,
                          char out[POST_NUMBER]);
/* "103.80 Hz", "n₀ = 50 N", "level 2.5". Returns out. */
char *post_abscissa_place(const post_abscissa *abscissa, double value, int digits,
                          char out[POST_PLACE]);
/* Of an axis, after before: "frequency, Hz", "excitation level". Returns out. */
char *post_abscissa_label(const post_abscissa *abscissa, const char *before, char out[POST_LABEL]);
/* Over the whole range. */
plot_axis post_abscissa_axis(const post_abscissa *abscissa, const char *label);

#endif
