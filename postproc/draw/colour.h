/* Sequential colour ramp of the preloads: amber (loose) through magenta to indigo (tight).
 * Lightness falls steadily, so the ramp also reads in grey and with impaired colour vision. */
#ifndef POSTPROC_DRAW_COLOUR_H
#define POSTPROC_DRAW_COLOUR_H

#include <stdbool.h>

#include "postproc/draw/text_buffer.h"

/* Colour "#rrggbb" of t in 0 .. 1, for a light or a dark page. Interpolated in OKLCH, kept inside
 * sRGB. */
void post_colour(double t, bool dark, char out[8]);

/* Style rules of the classes c0 .. c(n-1), n colours evenly spaced on the ramp. */
void post_put_ramp(int n, bool dark, post_buffer *out);

#endif
