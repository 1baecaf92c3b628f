/* Picture of a contact over one period: hysteresis loops, friction path and its limit, states in
 * time. */
#ifndef CASES_CONTACT_HYSTERESIS_PICTURE_H
#define CASES_CONTACT_HYSTERESIS_PICTURE_H

#include "cases/contact/sampled_period.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const char             *name; /* of the motion file */
  const mhb_law          *law;
  const mhb_contact_info *info; /* transitions ascending */
  const sampled_period   *period;
} hysteresis_view;

/* Draw a complete SVG file; its colours follow the light or dark page of the reader. Stick, slip
 * and open differ in colour and in line style, so the picture is legible in grey. */
void hysteresis_draw(const hysteresis_view *view, post_buffer *out);

#endif
