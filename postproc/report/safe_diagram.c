#include "postproc/report/safe_diagram.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "modal/model/nodal_diameters.h"
#include "postproc/draw/number_format.h"

enum { SHOWN = 3 }; /* families at least */

/* Families up to half above the range, at least three. */
static int count_families(const modal_model *model, int stored, double high) {
  int n = 0;
  while (n < model->n_modes && n < stored && (n < SHOWN || model->frequency[n] < 1.5 * high)) n++;
  return n;
}

void post_safe_create(const mhb_diagrams *d, const modal_model *model, const mhb_response *response,
                      const double range[2], double speed, post_safe *s) {
  *s          = (post_safe){.blades       = response->blades,
                            .engine_order = response->engine_order,
                            .known        = d->known,
                            .n_families   = count_families(model, d->n_families, range[1]),
                            .n_driven     = d->n_driven,
                            .range        = {range[0], range[1]},
                            .speed        = speed,
                            .disc         = d->disc};
  const int n = s->n_families, all = response->blades / 2 + 1;
  memcpy(s->driven, d->driven, sizeof s->driven);
  s->open  = shb_alloc((size_t)(n * all) + 1, sizeof *s->open);
  s->stuck = shb_alloc((size_t)(n * all) + 1, sizeof *s->stuck);
  for (int i = 0; i < n * all; i++) s->open[i] = s->stuck[i] = NAN;
  for (int i = 0; i < d->n_diameters; i++) {
    const int at = d->diameter[i];
    if (at < 0 || at >= all) continue;
    memcpy(s->open + at * n, d->open + i * d->n_families, (size_t)n * sizeof *s->open);
    memcpy(s->stuck + at * n, d->stuck + i * d->n_families, (size_t)n * sizeof *s->stuck);
  }
}

void post_safe_free(post_safe *s) {
  free(s->open);
  free(s->stuck);
  *s = (post_safe){0};
}

/* ---------------------------------------------------------------- page */

static void put_frequencies(const post_safe *s, const char *name, const double *f,
                            post_buffer *out) {
  post_put(out, ",\"%s\":[", name);
  for (int i = 0; i < (s->blades / 2 + 1) * s->n_families; i++) {
    const int family = i % s->n_families;
    post_put(out, "%s%s", family ? "," : i ? ",[" : "[", "");
    post_put(out, isfinite(f[i]) ? "%.9g" : "null", f[i]);
    if (family == s->n_families - 1) post_put(out, "]");
  }
  post_put(out, "]");
}

void post_safe_data(const post_safe *s, post_buffer *out) {
  if (s->n_families == 0) return;
  post_put(out,
           ",\n\"safe\":{\"blades\":%d,\"engineOrder\":%d,\"range\":[%.9g,%.9g],\"speed\":%.9g,"
           "\"driven\":[",
           s->blades, s->engine_order, s->range[0], s->range[1], s->speed);
  for (int i = 0; i < s->n_driven; i++) post_put(out, "%s%d", i ? "," : "", s->driven[i]);
  post_put(out, "]");
  put_frequencies(s, "open", s->open, out);
  put_frequencies(s, "stuck", s->stuck, out);
  post_put(out, "}");
}

void post_safe_table(const post_safe *s, post_buffer *out) {
  char number[POST_NUMBER];
  if (s->n_families == 0) return;
  post_put(out,
           "<div class=\"scroll\"><table><caption>Frequencies at the nodal diameter of each "
           "excited order, Hz.</caption>\n<thead><tr><th scope=\"col\">Order</th>"
           "<th scope=\"col\">Nodal diameter</th><th scope=\"col\">Contacts</th>");
  for (int i = 0; i < s->n_families; i++) post_put(out, "<th scope=\"col\">%d</th>", i + 1);
  post_put(out, "</tr></thead>\n<tbody>\n");
  for (int h = 0; h < s->n_driven; h++) {
    const int order = s->driven[h] * s->engine_order, d = modal_nodal_diameter(order, s->blades);
    for (int stuck = 0; stuck < 2; stuck++) {
      post_put(out, "<tr><th scope=\"row\">%d</th><td>%d</td><td>%s</td>", order, d,
               stuck ? "stuck" : "open");
      for (int i = 0; i < s->n_families; i++)
        post_put(out, "<td>%s</td>",
                 post_number(number, (stuck ? s->stuck : s->open)[d * s->n_families + i], 5));
      post_put(out, "</tr>\n");
    }
  }
  post_put(out, "</tbody></table></div>\n");
}
