#include "postproc/report/safe_diagram.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/linear_resonances.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/model/nodal_diameters.h"
#include "postproc/draw/number_format.h"

enum { MOST_FAMILIES = 8, SHOWN = 3 };

/* ---------------------------------------------------------------- frequencies */

/* Families up to half above the range, at least three. */
static int count_families(const modal_model *model, double high) {
  int n = 0;
  while (n < model->n_modes && n < MOST_FAMILIES && (n < SHOWN || model->frequency[n] < 1.5 * high))
    n++;
  return n;
}

static void find_driven(const modal_model *model, post_safe *s) {
  for (int k = 1; k <= model->n_load && s->n_driven < 16; k++)
    if (modal_model_is_driven(model, k)) s->driven[s->n_driven++] = k;
}

/* The model at a nodal diameter; NULL: the file of a disc lacks it. */
static const modal_model *model_at(const modal_model *model, const mhb_settings *settings,
                                   int diameter) {
  const modal_nodal_diameters *disc = settings->nodal_diameters;
  if (!disc) return model;
  const int at = modal_nodal_diameters_find(disc, diameter);
  return at < 0 ? NULL : &disc->model[at];
}

/* Frequencies of the open families at a nodal diameter, Hz. With Coriolis terms they are those of
 * the wave that runs to the right, as an excitation of that order does. */
static shb_status find_open(const modal_model *own, const mhb_settings *settings, int diameter,
                            int n, double *open) {
  modal_wave     wave;
  mhb_gyroscopic g;
  int            missing;
  for (int i = 0; i < n; i++) open[i] = own ? own->frequency[i] : NAN;
  if (!own || !own->coriolis) return SHB_OK;
  if (!settings->nodal_diameters ||
      !modal_nodal_diameters_wave(settings->nodal_diameters, diameter, &wave, &missing))
    wave = modal_wave_real(own);
  shb_status status = mhb_gyroscopic_of_wave(&wave, &g);
  for (int i = 0; i < n && status == SHB_OK; i++) open[i] = g.omega[g.n + i] / SHB_TWO_PI;
  mhb_gyroscopic_free(&g);
  return status;
}

shb_status post_safe_compute(const modal_model *model, const mhb_settings *settings,
                             const double range[2], double speed, post_safe *s) {
  *s = (post_safe){.blades       = settings->blades,
                   .engine_order = settings->engine_order,
                   .range        = {range[0], range[1]},
                   .speed        = speed,
                   .disc         = settings->nodal_diameters != NULL};
  if (settings->to_ground || !model->has_left || model->n_pairs == 0 || settings->blades < 3)
    return SHB_OK;
  const int n = count_families(model, range[1]), diameters = settings->blades / 2 + 1;
  s->open           = calloc((size_t)n * (size_t)diameters, sizeof *s->open);
  s->stuck          = calloc((size_t)n * (size_t)diameters, sizeof *s->stuck);
  shb_status status = s->open && s->stuck ? SHB_OK : SHB_ERR_IO;
  SHB_CHECK(status == SHB_OK, SHB_ERR_IO, "not enough memory for the SAFE diagram");
  for (int d = 0; d < diameters && status == SHB_OK; d++) {
    const modal_model *own = model_at(model, settings, d);
    status                 = find_open(own, settings, d, n, s->open + d * n);
    for (int i = 0; i < n; i++) s->stuck[d * n + i] = NAN;
    if (own && status == SHB_OK)
      status = mhb_stuck_frequencies(own, settings, d, n, s->stuck + d * n);
  }
  find_driven(model, s);
  s->n_families = n;
  return status;
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
