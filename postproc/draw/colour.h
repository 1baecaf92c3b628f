/* The sequential ramp that tells preloads apart: amber (loose) through magenta to indigo (tight), with steadily falling
 * lightness so that it also reads in grey and with impaired colour vision. */
#ifndef POSTPROC_DRAW_COLOUR_H
#define POSTPROC_DRAW_COLOUR_H

#include <stdbool.h>

/* "#rrggbb" of t in 0..1, for a light or a dark page; interpolated in OKLCH and kept inside sRGB. */
void post_colour(double t, bool dark, char out[8]);

#endif
