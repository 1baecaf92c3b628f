#include "cases/converge/rung.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "postproc/draw/text_buffer.h"

void rung_words(const rung_setting *s, char words[RUNG_SETTING_WORDS][RUNG_WORD]) {
  snprintf(words[0], RUNG_WORD, "%d", s->harmonics);
  snprintf(words[1], RUNG_WORD, "%.17g", s->tolerance);
  snprintf(words[2], RUNG_WORD, "%.17g", s->accuracy);
  snprintf(words[3], RUNG_WORD, "%d", s->modes);
  snprintf(words[4], RUNG_WORD, "%d", s->residuals);
  snprintf(words[5], RUNG_WORD, "%d", s->patches);
}

bool rung_from_words(const char *const words[RUNG_SETTING_WORDS], rung_setting *s) {
  double value[RUNG_SETTING_WORDS];
  for (int i = 0; i < RUNG_SETTING_WORDS; i++) {
    char *end;
    value[i] = strtod(words[i], &end);
    if (end == words[i] || *end || !(value[i] >= 0 && value[i] < 1e6)) return false;
  }
  *s = (rung_setting){(int)value[0], value[1],      value[2],
                      (int)value[3], value[4] != 0, (int)value[5]};
  return s->accuracy > 0 && s->modes > 0 && (s->harmonics > 0) != (s->tolerance > 0);
}

void rung_name(const rung_setting *s, char name[RUNG_WORD]) {
  char harmonics[24];
  snprintf(harmonics, sizeof harmonics, s->harmonics > 0 ? "%g" : "auto%g",
           s->harmonics > 0 ? s->harmonics : s->tolerance);
  int n = snprintf(name, RUNG_WORD, "h%s_a%g_m%d%s", harmonics, s->accuracy, s->modes,
                   s->residuals ? "" : "_bare");
  if (s->patches > 0) snprintf(name + n, (size_t)(RUNG_WORD - n), "_p%d", s->patches);
}

/* Moves a preload, and those of the other interfaces that belong to it, to another index. */
static void keep_preload(mhb_settings *mhb, int to, int from) {
  mhb->n0[to] = mhb->n0[from];
  for (int k = 0; k < mhb->n_interfaces; k++)
    if (mhb->interface[k].n_preloads > 1) mhb->interface[k].n0[to] = mhb->interface[k].n0[from];
}

shb_status rung_apply(const rung_setting *s, case_file *file) {
  mhb_settings *mhb     = &file->mhb;
  mhb->harmonics        = s->harmonics;
  mhb->motion_tolerance = s->tolerance;
  mhb->tolerance        = s->accuracy;
  for (int i = 0; i < file->n_interfaces; i++) /* the setting says how many */
    if (file->interfaces[i].points < 0) file->interfaces[i].points = 0;
  mhb->stability     = MHB_STABILITY_NEVER;
  mhb->search.starts = 0;
  mhb->resume        = false;
  mhb->flips         = false;
  mhb->search.starts = 0;
  int kept           = 0;
  for (int i = 0; i < mhb->n_preloads; i++)
    if (mhb->n0[i] >= file->converge_n0[0] && mhb->n0[i] <= file->converge_n0[1])
      keep_preload(mhb, kept++, i);
  SHB_CHECK(kept > 0, SHB_ERR_INPUT,
            "%s: converge.n0: no preload of contact.n0 lies between %g and %g N", file->path,
            file->converge_n0[0], file->converge_n0[1]);
  for (int k = 0; k < mhb->n_interfaces; k++)
    if (mhb->interface[k].n_preloads > 1) mhb->interface[k].n_preloads = kept;
  mhb->n_preloads = kept;
  return SHB_OK;
}

shb_status rung_output(const case_file *file, int n_probes, char *const *names,
                       post_output *output) {
  const char *wanted = file->converge_output;
  *output = (post_output){n_probes > 0 ? POST_PLACE_PROBE : POST_PLACE_CONTACT, 0, POST_WHOLE};
  if (!wanted) return SHB_OK;
  char known[512] = "";
  for (int i = 0; i < n_probes; i++) {
    output->index = i;
    if (strcmp(names[i], wanted) == 0) return SHB_OK;
    if (strlen(known) + strlen(names[i]) + 8 < sizeof known) strcat(strcat(known, names[i]), ", ");
  }
  *output = (post_output){POST_PLACE_CONTACT, 0, POST_WHOLE};
  SHB_CHECK(strcmp(wanted, "contact") == 0, SHB_ERR_INPUT,
            "%s: converge.output: '%s' is not known; expected one of %scontact", file->path, wanted,
            known);
  return SHB_OK;
}

static char *join(const char *stem, const char *ending) {
  return shb_text_of("%s%s", stem, ending);
}

char *rung_response(const char *stem) {
  return join(stem, ".response.h5");
}

/* ---------------------------------------------------------------- the small files */

/* No path: a file could not be read, which has been recorded. */
static shb_status publish(post_buffer *text, char *path) {
  shb_status status = path ? post_buffer_publish(text, path) : SHB_ERR_IO;
  post_buffer_free(text);
  free(path);
  return status;
}

shb_status rung_cost_write(const rung_cost *c, const char *stem) {
  post_buffer out = {0};
  post_put(&out, "%.9g %.9g %.9g %d %d %d %d %d %d\n", c->seconds, c->setup, c->memory, c->runs,
           c->points, c->harmonics, c->unknowns, c->complete, c->n_peaks);
  for (int i = 0; i < c->n_peaks; i++)
    post_put(&out, "%.17g %.17g %.17g\n", c->peak[i].n0, c->peak[i].frequency,
             c->peak[i].amplitude);
  post_put(&out, "end\n");
  return publish(&out, join(stem, ".cost"));
}

static bool scan_cost(FILE *in, rung_cost *c) {
  int  complete;
  char end[4];
  if (fscanf(in, "%lf %lf %lf %d %d %d %d %d %d", &c->seconds, &c->setup, &c->memory, &c->runs,
             &c->points, &c->harmonics, &c->unknowns, &complete, &c->n_peaks) != 9)
    return false;
  c->complete = complete != 0;
  if (c->n_peaks < 0 || c->n_peaks > MHB_MAX_PRELOADS) return false;
  for (int i = 0; i < c->n_peaks; i++)
    if (fscanf(in, "%lf %lf %lf", &c->peak[i].n0, &c->peak[i].frequency, &c->peak[i].amplitude) !=
        3)
      return false;
  return fscanf(in, "%3s", end) == 1 && strcmp(end, "end") == 0;
}

shb_status rung_cost_read(const char *stem, rung_cost *cost) {
  char *path = join(stem, ".cost");
  FILE *in   = fopen(path, "r");
  *cost      = (rung_cost){0};
  bool good  = in && scan_cost(in, cost);
  if (in) fclose(in);
  free(path);
  SHB_CHECK(good, SHB_ERR_IO, "%s.cost: not there, or damaged", stem);
  return SHB_OK;
}

/* Path of STEM.NAME.error. The file names the contents of both response files and is void if one of
 * them has changed. */
static char *error_path(const char *stem, const char *name, const char *file, char prints[64]) {
  char *mine  = rung_response(stem);
  char  a[17] = "", b[17] = "";
  bool  good = mine && shb_fingerprint(mine, a) == SHB_OK && shb_fingerprint(file, b) == SHB_OK;
  snprintf(prints, 64, "%s-%s", a, b);
  free(mine);
  size_t size = strlen(stem) + strlen(name) + 16;
  char  *path = good ? malloc(size) : NULL;
  if (path) snprintf(path, size, "%s.%s.error", stem, name);
  return path;
}

shb_status rung_error_write(const rung_error *e, const char *stem, const char *name,
                            const char *file) {
  char        prints[64], *path = error_path(stem, name, file, prints);
  post_buffer out = {0};
  post_put(&out, "%s %.9g %d %d end\n", prints, e->curve, e->n, e->lost);
  return publish(&out, path);
}

shb_status rung_error_read(const char *stem, const char *name, const char *file, rung_error *e) {
  char  prints[64], found[64] = "", end[4] = "", *path = error_path(stem, name, file, prints);
  FILE *in   = path ? fopen(path, "r") : NULL;
  bool  good = in && fscanf(in, "%63s %lf %d %d %3s", found, &e->curve, &e->n, &e->lost, end) == 5;
  if (in) fclose(in);
  free(path);
  SHB_CHECK(good && strcmp(found, prints) == 0 && strcmp(end, "end") == 0, SHB_ERR_IO,
            "%s: not compared with %s yet", stem, name);
  return SHB_OK;
}

const char *rung_leaf(const char *stem) {
  const char *slash = strrchr(stem, '/');
  return slash ? slash + 1 : stem;
}

void rung_peak_errors(const rung_cost *cost, const rung_cost *reference, double *amplitude,
                      double *frequency) {
  *amplitude = *frequency = cost->n_peaks == reference->n_peaks && cost->n_peaks > 0 ? 0 : NAN;
  for (int i = 0; i < cost->n_peaks && i < reference->n_peaks; i++) {
    const rung_peak *p = &cost->peak[i], *q = &reference->peak[i];
    double a = fabs(p->amplitude / q->amplitude - 1), f = fabs(p->frequency / q->frequency - 1);
    *amplitude = isnan(a) || isnan(*amplitude) ? NAN : fmax(*amplitude, a);
    *frequency = isnan(f) || isnan(*frequency) ? NAN : fmax(*frequency, f);
  }
}
