/* Picture of a contact over one period: hysteresis loops, the friction path within its limit, the states in time. */
#ifndef CASES_COMMANDS_HYSTERESIS_PICTURE_H
#define CASES_COMMANDS_HYSTERESIS_PICTURE_H

#include "cases/commands/sampled_period.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const char             *name; /* of the motion file */
  const mhb_law          *law;
  const mhb_contact_info *info; /* transitions ascending */
  const sampled_period   *period;
} hysteresis_view;

/* A whole SVG file that needs nothing else; light or dark as the reader's page is. Stick, slip and open differ in
 * colour and in line style, so that it reads in grey too. */
void hysteresis_draw(const hysteresis_view *view, post_buffer *out);

#endif
