#include "tests/support/scene.h"

#include <stdlib.h>
#include <sys/wait.h>

#include "postproc/analysis/curves.h"
#include "postproc/analysis/outputs.h"

void scene_run(const char *folder, const char *source, const char *case_file, const char *name,
               mhb_response **response) {
  char line[6 * SCRATCH_PATH];
  snprintf(line, sizeof line, "cp '%s/%s' '%s/' && '%s' run --quiet '%s/%s'", source, case_file,
           folder, SHROUDHB, folder, case_file);
  const int code = system(line);
  /* 3: some points are above the tolerance, which the response marks */
  if (!WIFEXITED(code) || (WEXITSTATUS(code) != 0 && WEXITSTATUS(code) != 3))
    fail_msg("failed: %s", line);
  snprintf(line, sizeof line, "%s/%s.response.h5", folder, name);
  if (mhb_response_read(line, response) != SHB_OK) fail_msg("%s", shb_message());
}

int scene_run_study(const char *folder, const char *source, const char *name) {
  char line[8 * SCRATCH_PATH];
  snprintf(line, sizeof line,
           "mkdir '%s/z_notch_blade' '%s/%s' && cp '%s/../z_notch_blade/case.yaml' "
           "'%s/z_notch_blade' && cp '%s/study.yaml' '%s/%s' && cd '%s/%s' && "
           "'%s' study --quiet study.yaml",
           folder, folder, name, source, folder, source, folder, name, folder, name, SHROUDHB);
  return system(line);
}

int scene_remove(const char *folder) {
  char line[SCRATCH_PATH + 16];
  snprintf(line, sizeof line, "rm -rf '%s'", folder);
  return system(line);
}

const mhb_branch *scene_branch(const mhb_response *response, mhb_branch_kind kind, double n0) {
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->kind == kind && (kind != MHB_BRANCH_NONLINEAR || fabs(b->n0[0] - n0) < 1e-9)) return b;
  }
  fail_msg("no branch of kind %d at %g N", (int)kind, n0);
  return NULL;
}

double scene_amplitude(const mhb_response *response, const mhb_branch *b, int point, int k) {
  return post_amplitude(response, b, point, post_output_primary(response), k);
}

scene_peak scene_highest(const mhb_response *response, const mhb_branch *b, double from,
                         double to) {
  double    *amplitude = malloc((size_t)b->n_points * sizeof *amplitude);
  post_peak *peak      = NULL;
  int        n;
  scene_peak best = {.point = -1};
  for (int i = 0; i < b->n_points; i++) amplitude[i] = scene_amplitude(response, b, i, 1);
  assert_int_equal(post_find_peaks(b->n_points, b->frequency, amplitude, &peak, &n), SHB_OK);
  for (int i = 0; i < n; i++) {
    if (peak[i].edge || peak[i].at < from || peak[i].at > to) continue;
    if (best.point >= 0 && peak[i].amplitude <= best.amplitude) continue;
    best = (scene_peak){peak[i].at, peak[i].amplitude, peak[i].point};
  }
  free(peak);
  free(amplitude);
  if (best.point < 0) fail_msg("no peak between %g and %g Hz", from, to);
  return best;
}

int scene_folds(const mhb_branch *b, int most, int *point) {
  int n = 0;
  for (int i = 0; i < b->n_points && n < most; i++) {
    if (b->special[i] != MHB_FOLD) continue;
    double here = b->frequency[i];
    point[n++]  = i;
    if (n > 1 && fabs(here - b->frequency[point[n - 2]]) < 2e-5 * here) n -= 2;
  }
  return n;
}

void scene_is_sound(const mhb_response *response) {
  double modal = 0;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    assert_true(b->complete);
    for (int p = 0; p < b->n_points; p++) {
      assert_true(b->error_newton[p] < 1e-8);
      modal = fmax(modal, b->error_modal[p]);
      for (int a = 0; b->kind == MHB_BRANCH_NONLINEAR && a < response->n_pairs; a++)
        assert_true(b->dissipation[p * response->n_pairs + a] > -1e-12);
    }
  }
  /* mostly the damping of modes left out, which a modal file does not tell */
  printf("modes left out: %.1e\n", modal);
  assert_true(modal < 5e-3);
}
