#include "postproc/draw/colour.h"

#include <math.h>
#include <stdio.h>

#include "mesh/base/constants.h"

/* OKLCH colour. The hue, degrees, is unwrapped so that the ramp runs one way. */
typedef struct {
  double lightness, chroma, hue;
} oklch;

static const oklch LIGHT[] = {
    {0.77, 0.155, 72}, {0.65, 0.185, 38}, {0.53, 0.195, 5}, {0.43, 0.180, -40}, {0.31, 0.150, -80}};
static const oklch DARK[] = {{0.90, 0.120, 95},
                             {0.80, 0.145, 62},
                             {0.70, 0.180, 20},
                             {0.62, 0.190, -30},
                             {0.56, 0.175, -75}};

/* Linear sRGB of an OKLCH colour (Ottosson, A perceptual color space for image processing,
 * 2020). */
static void linear_rgb(const oklch *c, double rgb[3]) {
  double h = c->hue * SHB_PI / 180, a = c->chroma * cos(h), b = c->chroma * sin(h);
  double l = pow(c->lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  double m = pow(c->lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  double s = pow(c->lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  rgb[0]   = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
  rgb[1]   = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
  rgb[2]   = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
}

static bool inside(const double rgb[3]) {
  for (int i = 0; i < 3; i++)
    if (rgb[i] < 0 || rgb[i] > 1) return false;
  return true;
}

static int encode(double linear) {
  double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
  return (int)lround(255 * fmin(fmax(v, 0), 1));
}

void post_colour(double t, bool dark, char out[8]) {
  const oklch *ramp = dark ? DARK : LIGHT;
  double       at   = fmin(fmax(t, 0), 1) * 4;
  int          i    = at >= 4 ? 3 : (int)at;
  double       w    = at - i, rgb[3];
  oklch        c    = {ramp[i].lightness + w * (ramp[i + 1].lightness - ramp[i].lightness),
                       ramp[i].chroma + w * (ramp[i + 1].chroma - ramp[i].chroma),
                       ramp[i].hue + w * (ramp[i + 1].hue - ramp[i].hue)};
  linear_rgb(&c, rgb);
  for (; !inside(rgb) && c.chroma > 0.001; linear_rgb(&c, rgb)) c.chroma *= 0.97;
  snprintf(out, 8, "#%02x%02x%02x", encode(rgb[0]), encode(rgb[1]), encode(rgb[2]));
}

void post_put_ramp(int n, bool dark, post_buffer *out) {
  for (int i = 0; i < n; i++) {
    char colour[8];
    post_colour(n > 1 ? i / (n - 1.0) : 0.5, dark, colour);
    post_put(out, ".c%d{color:%s}", i, colour);
  }
}
