/* Cells of a table with a row about a kept point of a response. */
#ifndef POSTPROC_FIELD_KEPT_POINT_H
#define POSTPROC_FIELD_KEPT_POINT_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* The first cells: branch, kind, n0_N, frequency_Hz, point, special, stable. Nothing stands
 * behind. */
void post_put_kept_point(const mhb_branch *branch, int index, int point, post_buffer *out);

/* A comma and a number; nothing behind the comma if it is not finite. */
void post_put_cell(post_buffer *out, double value);

#endif
