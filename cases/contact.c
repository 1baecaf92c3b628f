#include "cases/contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/motion.h"
#include "mhb/contact.h"
#include "mhb/fourier.h"

enum { HARMONICS = 15 };

static const double DEGREE = 180 / 3.14159265358979323846;

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

static shb_status evaluate(const case_motion *given, FILE *out) {
  int    m = given->n_harmonics > 0 ? given->n_harmonics : 1, H = m > HARMONICS ? m : HARMONICS;
  size_t nb = (size_t)mhb_real_size(m), nf = (size_t)mhb_real_size(H);
  mhb_contact *contact = NULL;
  SHB_TRY(mhb_contact_create(m, H, given->contact.tolerance, &contact));
  double *motion = calloc(3 * nb, sizeof(double)), *force = calloc(3 * nf, sizeof(double));
  mhb_contact_info *info   = calloc(1, sizeof *info);
  shb_status        status = SHB_OK;
  if (motion && force && info) {
    const mhb_settings *s   = &given->contact;
    mhb_law             law = {.mu = s->mu, .kv = s->kv, .n0 = s->n0[0]};
    memcpy(law.ku, s->ku, sizeof law.ku);
    for (size_t i = 0; i < 3; i++)
      mhb_to_real(given->n_harmonics, given->motion + i * (size_t)(given->n_harmonics + 1),
                  motion + i * nb);
    mhb_contact_force(contact, &law, motion, force, NULL, info);
    qsort(info->transition, (size_t)info->n_transitions, sizeof info->transition[0], by_phase);
    print(out, H, force, info);
    if (info->lost)
      status =
          shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__,
                   "the periodic slider was not reached to tolerance (error %.1e)", info->error);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  free(motion);
  free(force);
  free(info);
  mhb_contact_destroy(contact);
  return status;
}

shb_status contact_command(const char *path, FILE *out) {
  case_motion given;
  SHB_TRY(case_motion_read(path, stderr, &given));
  shb_status status = evaluate(&given, out);
  case_motion_free(&given);
  if (status == SHB_OK && (fflush(out) != 0 || ferror(out)))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "the result cannot be written");
  return status;
}
