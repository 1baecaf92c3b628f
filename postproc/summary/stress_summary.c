#include "postproc/summary/stress_summary.h"

#include <stdlib.h>

/* Place of a kept point at a peak: the point itself, or the peak beside it. -1: none. */
static int kept_at(const mhb_branch *b, int point) {
  int beside = -1;
  for (int a = 0; a < b->modal.n; a++) {
    int p = b->modal.point[a];
    if (p == point) return a;
    if (abs(p - point) == 1 && b->special[p] == MHB_PEAK) beside = a;
  }
  return beside;
}

static void put_place(const post_blade_field *field, const post_worst_place *place,
                      post_json *json) {
  post_json_object(json, "stress");
  post_json_number(json, "amplitude", place->amplitude);
  post_json_number(json, "principal", place->principal);
  post_json_number(json, "mean", place->mean);
  post_json_number(json, "safety", place->safety);
  post_json_numbers(json, "at", 3, field->nodes + 3 * (size_t)place->node);
  post_json_integer(json, "node", place->node);
  post_json_end(json);
}

shb_status post_stress_put(const post_stress_source *source, const mhb_branch *branch, int point,
                           post_json *json) {
  const post_blade_field *field = source->field;
  const post_fatigue      none  = {0};
  const int               kept  = field && field->n_nodes > 0 ? kept_at(branch, point) : -1;
  post_worst_place        place[POST_PLACES];
  int                     n = 0;
  if (kept < 0) {
    post_json_null(json, "stress");
    return SHB_OK;
  }
  SHB_TRY(
      post_worst_places(field, branch, kept, source->fatigue ? source->fatigue : &none, place, &n));
  if (n > 0)
    put_place(field, &place[0], json);
  else
    post_json_null(json, "stress");
  return SHB_OK;
}
