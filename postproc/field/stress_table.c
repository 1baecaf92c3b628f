#include "postproc/field/stress_table.h"

#include "postproc/field/kept_point.h"

static void put_place(const mhb_branch *b, int branch, int point, const post_blade_field *field,
                      int index, const post_worst_place *place, post_buffer *out) {
  const double *x = field->nodes + 3 * (size_t)place->node;
  post_put_kept_point(b, branch, point, out);
  post_put(out, ",%d,%d", index + 1, place->node);
  for (int d = 0; d < 3; d++) post_put_cell(out, x[d]);
  post_put_cell(out, place->amplitude);
  post_put_cell(out, place->principal);
  post_put_cell(out, place->mean);
  post_put_cell(out, place->safety);
  post_put(out, "\r\n");
}

static shb_status put_point(const post_blade_field *field, const mhb_branch *b, int branch,
                            int kept, const post_fatigue *fatigue, post_buffer *out) {
  const int        point = b->modal.point[kept];
  post_worst_place place[POST_PLACES];
  int              n;
  SHB_TRY(post_worst_places(field, b, kept, fatigue, place, &n));
  for (int i = 0; i < n; i++) put_place(b, branch, point, field, i, &place[i], out);
  return SHB_OK;
}

static int highest_point(const mhb_response *response, const mhb_branch *b) {
  int at = 0;
  for (int i = 1; i < b->n_points; i++)
    if (mhb_response_output(response, b, i) > mhb_response_output(response, b, at)) at = i;
  return at;
}

shb_status post_stress_table(const post_blade_field *field, const mhb_response *response,
                             const post_fatigue *fatigue, post_buffer *out) {
  shb_status status = SHB_OK;
  post_put(out,
           "branch,kind,n0_N,frequency_Hz,point,special,stable,place,node,x_m,y_m,z_m,"
           "amplitude_Pa,principal_Pa,mean_Pa,safety\r\n");
  for (int i = 0; i < response->n_branches && status == SHB_OK; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->modal.n == 0) continue;
    const int highest = highest_point(response, b);
    for (int a = 0; a < b->modal.n && status == SHB_OK; a++) {
      int point = b->modal.point[a];
      if (b->modal.n < b->n_points || b->special[point] == MHB_PEAK || point == highest)
        status = put_point(field, b, i, a, fatigue, out);
    }
  }
  return status;
}
