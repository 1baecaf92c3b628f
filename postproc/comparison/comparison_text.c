#include "postproc/comparison/comparison_text.h"

#include <math.h>

#include "mhb/problem/parameter.h"
#include "postproc/draw/number_format.h"
#include "postproc/summary/json.h"

/* ---------------------------------------------------------------- terminal */

/* "+1.2 %", "–" where it is not known. */
static const char *signed_percent(double change, char out[POST_NUMBER]) {
  if (!isfinite(change)) return "–";
  snprintf(out, POST_NUMBER, "%+.3g %%", 100 * change);
  return out;
}

void post_comparison_text(const post_comparison *c, post_buffer *out) {
  post_put(out, "%s against %s, highest peaks\n", c->run[1].name, c->run[0].name);
  for (int i = 0; i < c->n_pairs; i++) {
    const post_pair *p = &c->pair[i];
    char             name[64], a[POST_NUMBER], b[POST_NUMBER], da[POST_NUMBER], df[POST_NUMBER];
    if (!(p->peak[0].amplitude > 0) && !(p->peak[1].amplitude > 0)) continue;
    post_pair_name(p, name);
    double most = fmax(p->peak[0].amplitude, p->peak[1].amplitude);
    post_put(
        out, "  %-14s %12s  %12s  amplitude %-9s at %-9s\n", name,
        p->peak[0].amplitude > 0 ? post_measure(a, p->peak[0].amplitude, post_unit_length(most), 4)
                                 : "–",
        p->peak[1].amplitude > 0 ? post_measure(b, p->peak[1].amplitude, post_unit_length(most), 4)
                                 : "–",
        signed_percent(post_change(p, false), da), signed_percent(post_change(p, true), df));
  }
  post_put(out, "%d settings differ%s\n", c->n_differences, c->n_differences ? ":" : "");
  for (int i = 0; i < c->n_differences; i++) {
    const post_difference *d = &c->difference[i];
    post_put(out, "  %s: %s, %s\n", d->key, d->value[0] ? d->value[0] : "–",
             d->value[1] ? d->value[1] : "–");
  }
}

/* ---------------------------------------------------------------- JSON */

static void put_peak(post_json *json, const char *key, const post_track_point *p) {
  if (!(p->amplitude > 0)) {
    post_json_null(json, key);
    return;
  }
  post_json_object(json, key);
  post_json_number(json, "amplitude", p->amplitude);
  post_json_number(json, "at", p->at);
  post_json_bool(json, "at_end", p->edge);
  post_json_bool(json, "complete", p->complete);
  post_json_end(json);
}

void post_comparison_json(const post_comparison *c, post_buffer *out) {
  post_json json = {.out = out};
  post_json_object(&json, NULL);
  post_json_text(&json, "format", "shroudhb comparison");
  post_json_integer(&json, "version", 1);
  post_json_text(&json, "first", c->run[0].name);
  post_json_text(&json, "second", c->run[1].name);
  post_json_text(&json, "parameter", mhb_parameter_name(c->run[0].response->parameter));
  post_json_list(&json, "curves");
  for (int i = 0; i < c->n_pairs; i++) {
    const post_pair *p = &c->pair[i];
    post_json_object(&json, NULL);
    post_json_text(&json, "kind", mhb_branch_kind_name(p->kind));
    post_json_number(&json, "n0", p->n0);
    put_peak(&json, "first", &p->peak[0]);
    put_peak(&json, "second", &p->peak[1]);
    post_json_number(&json, "amplitude_change", post_change(p, false));
    post_json_number(&json, "place_change", post_change(p, true));
    post_json_end(&json);
  }
  post_json_end(&json);
  post_json_list(&json, "settings");
  for (int i = 0; i < c->n_differences; i++) {
    post_json_object(&json, NULL);
    post_json_text(&json, "key", c->difference[i].key);
    post_json_text(&json, "first", c->difference[i].value[0]);
    post_json_text(&json, "second", c->difference[i].value[1]);
    post_json_end(&json);
  }
  post_json_end(&json);
  post_json_end(&json);
}
