#include "postproc/field/kept_point.h"

#include <math.h>

void post_put_cell(post_buffer *out, double value) {
  post_put(out, isfinite(value) ? ",%.12g" : ",", value);
}

void post_put_kept_point(const mhb_branch *b, int branch, int point, post_buffer *out) {
  post_put(out, "%d,%s", branch, mhb_branch_kind_name(b->kind));
  post_put_cell(out, b->kind == MHB_BRANCH_NONLINEAR ? b->n0[point] : NAN);
  post_put_cell(out, b->frequency[point]);
  post_put(out, ",%d,%s,", point, mhb_special_name(b->special[point]));
  if (b->stable[point] >= 0) post_put(out, "%d", b->stable[point]);
}

int post_highest_kept(const mhb_response *response, const mhb_branch *b) {
  int at = 0;
  for (int i = 1; i < b->modal.n; i++)
    if (mhb_response_output(response, b, b->modal.point[i]) >
        mhb_response_output(response, b, b->modal.point[at]))
      at = i;
  return at;
}
