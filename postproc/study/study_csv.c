#include "postproc/study/study_csv.h"

#include <math.h>
#include <stdio.h>

static void put_number(double value, post_buffer *out) {
  if (isfinite(value)) post_put(out, ",%.12g", value);
  if (!isfinite(value)) post_put(out, ",");
}

static void put_text(const char *text, post_buffer *out) {
  post_put(out, ",");
  post_put_csv(out, text);
}

static bool has_error(const design_study *s, int output) {
  for (int i = 0; i < s->n; i++)
    if (isfinite(s->design[i].error[output])) return true;
  return false;
}

static void put_header(const design_study *s, post_buffer *out) {
  char name[STUDY_NAME + 16];
  post_put(out, "design");
  for (int i = 0; i < s->n_keys; i++) put_text(s->key[i].name, out);
  for (int i = 0; i < s->n_outputs; i++) put_text(s->output[i].name, out);
  for (int i = 0; i < s->n_outputs; i++) {
    snprintf(name, sizeof name, "%s_error", s->output[i].name);
    if (has_error(s, i)) put_text(name, out);
  }
  for (int i = 0; i < s->n_derivatives; i++) {
    snprintf(name, sizeof name, "dpeak_d%s", s->derivative[i].name);
    put_text(name, out);
  }
  post_put(out, ",status,reason\r\n");
}

void study_csv(const design_study *s, post_buffer *out) {
  put_header(s, out);
  for (int d = 0; d < s->n; d++) {
    const study_design *design = &s->design[d];
    post_put(out, "%d", d + 1);
    for (int i = 0; i < s->n_keys; i++) put_number(design->key[i], out);
    for (int i = 0; i < s->n_outputs; i++) put_number(design->value[i], out);
    for (int i = 0; i < s->n_outputs; i++)
      if (has_error(s, i)) put_number(design->error[i], out);
    for (int i = 0; i < s->n_derivatives; i++) put_number(design->derivative[i], out);
    put_text(study_state_name(design->state), out);
    put_text(design->reason ? design->reason : "", out);
    post_put(out, "\r\n");
  }
}
