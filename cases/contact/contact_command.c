#include "cases/contact/contact_command.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cases/contact/hysteresis_picture.h"
#include "cases/contact/sampled_period.h"
#include "cases/schema/motion.h"
#include "mesh/base/constants.h"
#include "mhb/contact/contact.h"
#include "mhb/numerics/fourier.h"

enum { HARMONICS = 15 };

static const double DEGREE = 180 / SHB_PI;

static void print_signal(FILE *out, const char *name, const double *force, const char *end) {
  fprintf(out, "  %s: [", name);
  for (int k = 0; k <= HARMONICS; k++) {
    double a = k ? hypot(force[2 * k - 1], force[2 * k]) : force[0];
    double p = k && a > 0 ? atan2(force[2 * k], force[2 * k - 1]) * DEGREE : 0;
    fprintf(out, "%s[%.15g, %.15g]", k ? ", " : "", a, p);
  }
  fprintf(out, "]%s\n", end);
}

static void print(FILE *out, int H, const double *force, const mhb_contact_info *info) {
  static const char *const name[] = {"n", "u", "w"}, *const state[] = {"stick", "slip", "open"};
  size_t stride = (size_t)mhb_real_size(H);
  fputs("force:  # [amplitude N, phase deg] of harmonics 0..15\n", out);
  for (int i = 0; i < 3; i++) print_signal(out, name[i], force + (size_t)i * stride, "");
  fputs("transitions: [", out);
  for (int i = 0; i < info->n_transitions; i++)
    fprintf(out, "%s[%.15g, %s]", i ? ", " : "", info->transition[i].phase,
            state[info->transition[i].state]);
  fprintf(out, "]\ndissipation: %.15g  # J a cycle\n", info->dissipation);
  fprintf(out, "states: {stick: %.12g, slip: %.12g, open: %.12g}  # shares of the period\n",
          info->share[0], info->share[1], info->share[2]);
  fprintf(out, "error: %.2g  # estimate, relative to the largest force\n", info->error);
  fprintf(out, "mean_friction: %s\n", info->undetermined ? "undetermined" : "determined");
}

static int by_phase(const void *a, const void *b) {
  double x = ((const mhb_transition *)a)->phase, y = ((const mhb_transition *)b)->phase;
  return (x > y) - (x < y);
}

/* A motion and the contact forces that follow from it. */
typedef struct {
  int                    m, H;
  mhb_law                law;
  mhb_contact_evaluator *contact;
  double                *motion, *force; /* [3][2m+1], [3][2H+1] */
  mhb_contact_info      *info;
} evaluation;

static void evaluation_free(evaluation *e) {
  free(e->motion);
  free(e->force);
  free(e->info);
  mhb_contact_evaluator_destroy(e->contact);
}

static shb_status evaluate(const case_motion *given, evaluation *e) {
  const mhb_settings *s = &given->contact;
  *e                    = (evaluation){.m   = given->n_harmonics > 0 ? given->n_harmonics : 1,
                                       .law = {.mu = s->mu, .kv = s->kv, .n0 = s->n0[0]}};
  e->H                  = e->m > HARMONICS ? e->m : HARMONICS;
  size_t nb = (size_t)mhb_real_size(e->m), nf = (size_t)mhb_real_size(e->H);
  SHB_TRY(mhb_contact_evaluator_create(e->m, e->H, s->tolerance, &e->contact));
  e->motion = calloc(3 * nb, sizeof(double));
  e->force  = calloc(3 * nf, sizeof(double));
  e->info   = calloc(1, sizeof *e->info);
  SHB_CHECK(e->motion && e->force && e->info, SHB_ERR_IO, "out of memory");
  memcpy(e->law.ku, s->ku, sizeof e->law.ku);
  for (size_t i = 0; i < 3; i++)
    mhb_to_real(given->n_harmonics, given->motion + i * (size_t)(given->n_harmonics + 1),
                e->motion + i * nb);
  mhb_contact_force(e->contact, &e->law, e->motion, e->force, NULL, e->info);
  qsort(e->info->transition, (size_t)e->info->n_transitions, sizeof e->info->transition[0],
        by_phase);
  return SHB_OK;
}

/* The file's name without folder and .yaml; malloc'ed, NULL if memory is short. */
static char *title(const char *path) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path,
             *dot = strrchr(name, '.');
  return dot && dot > name ? strndup(name, (size_t)(dot - name)) : strdup(name);
}

static shb_status draw(const char *path, const char *svg, const evaluation *e) {
  sampled_period period;
  SHB_TRY(sampled_period_create(e->contact, &e->law, e->m, e->motion, e->info, &period));
  char       *name = title(path);
  post_buffer out  = {0};
  hysteresis_draw(
      &(hysteresis_view){
          .name = name ? name : "", .law = &e->law, .info = e->info, .period = &period},
      &out);
  shb_status status = post_buffer_publish(&out, svg);
  post_buffer_free(&out);
  free(name);
  sampled_period_free(&period);
  return status;
}

static shb_status answer(const char *path, const char *svg, const evaluation *e, FILE *out) {
  print(out, e->H, e->force, e->info);
  SHB_CHECK(fflush(out) == 0 && !ferror(out), SHB_ERR_IO, "the result cannot be written");
  if (svg) SHB_TRY(draw(path, svg, e));
  SHB_CHECK(!e->info->lost, SHB_NOT_CONVERGED,
            "the periodic slider was not reached to tolerance (error %.1e)", e->info->error);
  return SHB_OK;
}

static bool same_file(const char *a, const char *b) {
  struct stat x, y;
  return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

shb_status contact_run(const char *path, const case_overrides *overrides, const char *svg,
                       FILE *out) {
  SHB_CHECK(!svg || !same_file(path, svg), SHB_ERR_INPUT,
            "--svg %s would overwrite the motion file; name another file", svg);
  case_motion given;
  SHB_TRY(case_motion_read(path, overrides, stderr, &given));
  evaluation e;
  shb_status status = evaluate(&given, &e);
  if (status == SHB_OK) status = answer(path, svg, &e, out);
  evaluation_free(&e);
  case_motion_free(&given);
  return status;
}
