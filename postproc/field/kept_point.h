/* Kept points of a response: the highest of a branch, and cells of a table with a row about one. */
#ifndef POSTPROC_FIELD_KEPT_POINT_H
#define POSTPROC_FIELD_KEPT_POINT_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* The kept point of a branch with the largest amplitude of the output; the branch has some. */
int post_highest_kept(const mhb_response *response, const mhb_branch *branch);

/* The first cells: branch, kind, n0_N, frequency_Hz, point, special, stable. Nothing stands
 * behind. */
void post_put_kept_point(const mhb_branch *branch, int index, int point, post_buffer *out);

/* A comma and a number; nothing behind the comma if it is not finite. */
void post_put_cell(post_buffer *out, double value);

#endif
