/* shroudhb converge on a model of three degrees of freedom, against results of the library. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mhb/branches/forced_response.h"
#include "postproc/analysis/convergence.h"
#include "postproc/analysis/curve_distance.h"
#include "postproc/analysis/curves.h"
#include "postproc/analysis/outputs.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/scratch.h"
#include "tests/support/three_degree.h"

static const double N0[2] = {.3, -.2};

static char             folder[SCRATCH_PATH];
static post_convergence result;
static char             said[1 << 15];

static const char *const template =
    "name: three\n"
    "modal: {file: three.h5}\n"
    "contact: {to: ground, psi: 0, phi: 0, mu: 0.4, ku: 0.5, kv: 0.8, n0: [%s]}\n"
    "mhb: {frequency: [0.19 Hz, 0.239 Hz], harmonics: 5, max_points: 5000%s}\n"
    "%s";

static void write_case(const char *name, const char *n0, const char *more, const char *converge) {
  char text[1024];
  snprintf(text, sizeof text, template, n0, more, converge);
  scratch_write(folder, name, text, strlen(text));
}

static void read_said(void) {
  char path[2 * SCRATCH_PATH];
  snprintf(path, sizeof path, "%s/said", folder);
  FILE  *file = fopen(path, "r");
  size_t n    = fread(said, 1, sizeof said - 1, file);
  said[n]     = '\0';
  fclose(file);
}

/* Exit code; said holds the text of both channels. */
static int converge(const char *words) {
  char command[8 * SCRATCH_PATH];
  snprintf(command, sizeof command, "cd '%s' && '%s' converge %s >said 2>&1", folder, SHROUDHB,
           words);
  int code = system(command);
  read_said();
  return WEXITSTATUS(code);
}

static int other_command(const char *words) {
  char command[8 * SCRATCH_PATH];
  snprintf(command, sizeof command, "cd '%s' && '%s' %s >said 2>&1", folder, SHROUDHB, words);
  int code = system(command);
  read_said();
  return WEXITSTATUS(code);
}

static void read_result(void) {
  char path[2 * SCRATCH_PATH];
  snprintf(path, sizeof path, "%s/three.converge.h5", folder);
  post_convergence_free(&result);
  if (post_convergence_read(path, &result) != SHB_OK) fail_msg("%s", shb_message());
}

static int start(void **state) {
  (void)state;
  char           path[2 * SCRATCH_PATH];
  hid_t          file;
  modal_model    model;
  shb_provenance provenance = {"", "", "", ""};
  scratch_create(folder);
  snprintf(path, sizeof path, "%s/three.h5", folder);
  three_degree_model(&model);
  bool made = h5_create(path, &file) == SHB_OK &&
              modal_model_write(file, &model, &provenance) == SHB_OK && h5_close(file) == SHB_OK;
  modal_model_free(&model);
  write_case("three.yaml", ".3, -.2", "",
             "integrate: {frequencies: [0.2, 0.212, 0.225], start: rest, tolerance: 1e-8}\n");
  made     = made && other_command("integrate --quiet three.yaml") == 0;
  int code = converge("three.yaml");
  if (!made || code != 3) { /* all three modes are needed */
    print_error("exit code %d: %s\n", code, said);
    return 1;
  }
  read_result();
  return 0;
}

static int clean(void **state) {
  (void)state;
  char command[2 * SCRATCH_PATH];
  post_convergence_free(&result);
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static const post_rung *rung_of(post_ladder ladder, const char *name) {
  for (int i = 0; i < result.n; i++)
    if (result.rung[i].ladder == ladder && strcmp(result.rung[i].name, name) == 0)
      return &result.rung[i];
  fail_msg("no rung %s of %s", name, post_ladder_name(ladder));
  return NULL;
}

/* Errors fall from coarse to fine, up to noise between similar rungs. The last one is 0 because it
 * is the reference. */
static void errors_fall(void **state) {
  (void)state;
  static const post_ladder falling[] = {POST_LADDER_HARMONICS, POST_LADDER_ACCURACY,
                                        POST_LADDER_MODES, POST_LADDER_AUTO};
  for (int l = 0; l < 4; l++) {
    double last = INFINITY;
    int    n = 0, references = 0;
    for (int i = 0; i < result.n; i++) {
      const post_rung *r = &result.rung[i];
      if (r->ladder != falling[l]) continue;
      double error = post_rung_error(r);
      if (!(error <= 1.2 * last))
        fail_msg("%s %s: %g after %g", post_ladder_name(r->ladder), r->name, error, last);
      assert_int_equal(r->state, POST_RUNG_DONE);
      assert_true(r->seconds > 0 && r->total > r->seconds && r->memory > 1e6 && r->memory < 1e9);
      references += r->reference;
      last = error;
      n++;
    }
    assert_true(n >= 3);
    assert_int_equal(references, falling[l] != POST_LADDER_AUTO);
    if (references) assert_true(last == 0);
  }
  assert_true(post_rung_error(rung_of(POST_LADDER_HARMONICS, "1")) > .01);
  assert_true(post_rung_error(rung_of(POST_LADDER_HARMONICS, "21")) < 1e-3);
  assert_true(post_rung_error(rung_of(POST_LADDER_ACCURACY, "fast")) < 1e-3);
  assert_true(rung_of(POST_LADDER_HARMONICS, "5")->of_case);
  assert_true(rung_of(POST_LADDER_HARMONICS, "5")->unknowns == 33);
}

/* The errors of the ladder agree with those against time integration, which uses no harmonics. */
static void time_integration_agrees(void **state) {
  (void)state;
  static const char *const name[] = {"1", "3", "5", "7"};
  assert_int_equal(result.n_points, 6);
  for (int i = 0; i < 4; i++) {
    const post_rung *r = rung_of(POST_LADDER_HARMONICS, name[i]);
    print_message("H %s: curve %.2e, time integration %.2e\n", name[i], r->curve, r->integration);
    assert_true(r->integration < 2.5 * r->curve && r->integration > .2 * r->curve);
  }
  assert_true(rung_of(POST_LADDER_HARMONICS, "31")->integration < 5e-7);
  assert_true(isnan(rung_of(POST_LADDER_ACCURACY, "fast")->integration));
}

/* Curves computed by the library. */
typedef struct {
  mhb_response *response;
  double       *amplitude[2];
} curves;

static curves sweep(int harmonics, double tolerance) {
  curves       c;
  modal_model  model;
  post_output  output = {POST_PLACE_PROBE, 0, POST_WHOLE};
  mhb_settings s      = {.to_ground    = true,
                         .blades       = 1,
                         .mu           = .4,
                         .kv           = .8,
                         .ku           = {.5, 0, .5},
                         .n_preloads   = 2,
                         .n0           = {N0[0], N0[1]},
                         .frequency    = {.19, .239},
                         .harmonics    = harmonics,
                         .subharmonics = 1,
                         .scale        = 1,
                         .tolerance    = tolerance,
                         .max_points   = 5000,
                         .stability    = MHB_STABILITY_NEVER};
  three_degree_model(&model);
  if (mhb_forced_response(&model, &s, NULL, NULL, NULL, &c.response) != SHB_OK)
    fail_msg("%s", shb_message());
  for (int i = 0; i < 2; i++)
    assert_int_equal(post_series(c.response, &c.response->branch[2 + i], output,
                                 POST_QUANTITY_FIRST_HARMONIC, &c.amplitude[i]),
                     SHB_OK);
  modal_model_free(&model);
  return c;
}

static void free_curves(curves *c) {
  for (int i = 0; i < 2; i++) free(c->amplitude[i]);
  mhb_response_destroy(c->response);
}

static post_peak highest(const curves *c, int i) {
  const mhb_branch *b = &c->response->branch[2 + i];
  post_peak        *peaks;
  int               n;
  assert_int_equal(post_find_peaks(b->n_points, b->frequency, c->amplitude[i], &peaks, &n), SHB_OK);
  assert_true(n > 0);
  post_peak top = peaks[post_highest_peak(n, peaks)];
  free(peaks);
  return top;
}

/* Largest distance of the points of one curve from the polyline of the other. */
static double one_way(const curves *from, const curves *to, int i, double unit) {
  const mhb_branch *b = &from->response->branch[2 + i], *o = &to->response->branch[2 + i];
  post_polyline     line = {o->n_points, o->frequency, to->amplitude[i]};
  double            most = 0;
  for (int p = 0; p < b->n_points; p++)
    most = fmax(most, post_curve_distance((double[2]){b->frequency[p], from->amplitude[i][p]},
                                          &line, unit, NULL));
  return most;
}

/* Peaks by a parabola, to 1e-3 at worst; curves by their polylines, to the sag. */
static void errors_are_those_of_the_curves(void **state) {
  (void)state;
  static const int   m[]    = {1, 3};
  static const char *name[] = {"1", "3"};
  curves             fine   = sweep(31, 1e-8);
  for (int h = 0; h < 2; h++) {
    curves           coarse = sweep(m[h], 1e-8);
    double           peak = 0, frequency = 0, curve = 0;
    const post_rung *r = rung_of(POST_LADDER_HARMONICS, name[h]);
    for (int i = 0; i < 2; i++) {
      post_peak a = highest(&coarse, i), b = highest(&fine, i);
      peak      = fmax(peak, fabs(a.amplitude / b.amplitude - 1));
      frequency = fmax(frequency, fabs(a.at / b.at - 1));
      curve     = fmax(curve, fmax(one_way(&coarse, &fine, i, b.amplitude),
                                   one_way(&fine, &coarse, i, b.amplitude)));
    }
    print_message("H %d: peak %.3e (%.3e), frequency %.3e (%.3e), curve %.3e (%.3e)\n", m[h],
                  r->peak, peak, r->frequency, frequency, r->curve, curve);
    assert_true(fabs(r->peak - peak) < 1e-3);
    assert_true(fabs(r->frequency - frequency) < 1e-3);
    assert_true(fabs(r->curve - curve) < .02 * curve + 4e-3);
    free_curves(&coarse);
  }
  free_curves(&fine);
}

static int count(const char *text, const char *word) {
  int n = 0;
  for (const char *at = text; (at = strstr(at, word)) != NULL; at += strlen(word)) n++;
  return n;
}

/* The named rung is the one of the least seconds within the tolerance. */
static void the_cheapest_is_named(void **state) {
  (void)state;
  int best = -1;
  for (int i = 0; i < result.n; i++) {
    const post_rung *r = &result.rung[i];
    bool meets         = !r->reference && r->peak <= .01 && r->frequency <= .01 && r->curve <= .01;
    if (r->ladder == POST_LADDER_HARMONICS && meets &&
        (best < 0 || r->seconds < result.rung[best].seconds))
      best = i;
  }
  assert_true(best >= 0);
  char sentence[128];
  snprintf(sentence, sizeof sentence, "harmonics: %s meets 1 %%", result.rung[best].name);
  if (!strstr(said, sentence)) fail_msg("'%s' is not in: %s", sentence, said);
  assert_int_equal(count(said, "Cheapest that meets 1 %"), 1);
  assert_int_equal(count(said, "three.converge.svg"), 1);
  assert_non_null(strstr(said, "modes: none below the finest meets 1 %; the finest, 3, takes"));
  assert_non_null(
      strstr(said, "warning: a ladder has no rung below its finest that meets the tolerance"));
}

/* A second run prints the same rows to the last digit without computing; --force computes. */
static void results_are_kept(void **state) {
  (void)state;
  post_convergence before = result;
  result                  = (post_convergence){0};
  assert_int_equal(converge("three.yaml"), 3);
  read_result();
  assert_int_equal(result.n, before.n);
  for (int i = 0; i < result.n; i++) {
    assert_true(result.rung[i].seconds == before.rung[i].seconds);
    assert_true(result.rung[i].curve == before.rung[i].curve);
  }
  post_convergence_free(&before);
  /* a rung without its file is computed and compared again */
  char path[2 * SCRATCH_PATH];
  snprintf(path, sizeof path, "%s/three.converge/h1_a1e-08_m3.response.h5", folder);
  double error = rung_of(POST_LADDER_HARMONICS, "1")->curve;
  assert_int_equal(remove(path), 0);
  assert_int_equal(converge("--quiet three.yaml"), 3);
  assert_int_equal(count(said, "\n"), 1);
  read_result();
  assert_true(fabs(rung_of(POST_LADDER_HARMONICS, "1")->curve / error - 1) < 1e-6);
}

/* The report has the section while the case is the one that was studied. */
static void the_report_shows_it(void **state) {
  (void)state;
  assert_int_equal(other_command("run --quiet three.yaml"), 0);
  assert_int_equal(
      other_command("post --quiet three.yaml; grep -c 'Speed against error</h2>' three.html"), 0);
  assert_string_equal(said, "1\n");
  write_case("three.yaml", ".3, -.2", "", "converge: {tolerance: 2 %}\n");
  assert_int_equal(
      other_command("post --quiet three.yaml; grep -c 'Speed against error</h2>' three.html"), 1);
  assert_string_equal(said, "0\n");
  write_case("three.yaml", ".3, -.2", "", "");
}

/* Exit codes by the tolerance; output and preloads from the case file. */
static void keys_are_heeded(void **state) {
  (void)state;
  write_case("three.yaml", ".3, -.2", "", "converge: {tolerance: 90 %}\n");
  assert_int_equal(converge("three.yaml"), 0);
  assert_non_null(strstr(said, "meets 90 %"));
  write_case("three.yaml", ".3, -.2", "",
             "converge: {tolerance: 1e-12, n0: [0, 1], output: contact, seconds: 1 us}\n");
  assert_int_equal(converge("three.yaml"), 3);
  assert_non_null(strstr(said, "the worst of 1 preload;"));
  assert_non_null(strstr(said, "contact motion")); /* the probe's name */
  assert_non_null(strstr(said, "accuracy: none below the finest meets 1e-10 %"));
  assert_non_null(strstr(said, "The ladder of harmonics ends at 5: 7 would take about"));
  assert_non_null(strstr(said, "(converge.seconds is 1e-06)"));
  /* a study that fails leaves no folder */
  write_case("hollow.yaml", ".3, -.2", "", "converge: {output: nobody}\n");
  char path[2 * SCRATCH_PATH];
  snprintf(path, sizeof path, "sed -i 's/name: three/name: hollow/' '%s/hollow.yaml'", folder);
  assert_int_equal(system(path), 0);
  assert_int_equal(converge("hollow.yaml"), 2);
  snprintf(path, sizeof path, "%s/hollow.converge", folder);
  assert_true(access(path, F_OK) != 0);
}

/* Finished rungs are reported; running and later ones are not. */
static void interrupted(void **state) {
  (void)state;
  char command[8 * SCRATCH_PATH];
  write_case("other.yaml", ".3, -.2", "", "");
  snprintf(command, sizeof command, "sed -i 's/name: three/name: other/' '%s/other.yaml'", folder);
  assert_int_equal(system(command), 0);
  /* a shell's background jobs ignore SIGINT: SIGTERM */
  snprintf(command, sizeof command,
           "cd '%s' && { '%s' converge other.yaml >said 2>&1 & pid=$!; n=0; "
           "until [ -e other.converge/h3_a1e-08_m3.cost ] || [ $n -gt 1200 ]; do sleep 0.05; "
           "n=$((n+1)); done; kill -TERM $pid; wait $pid; }",
           folder, SHROUDHB);
  int code = system(command);
  read_said();
  assert_int_equal(WEXITSTATUS(code), 130);
  assert_non_null(strstr(said, "interrupted; the rungs so far are kept and used again"));
  assert_non_null(strstr(said, "harmonics           1 "));
  assert_int_equal(count(said, "not run"), 1);
  snprintf(command, sizeof command, "%s/other.converge.h5", folder);
  assert_true(access(command, F_OK) != 0);
}

static void refuse(const char *words, int code, const char *why) {
  int found = converge(words);
  if (found != code || !strstr(said, why))
    fail_msg("%s: exit code %d, not %d; or no '%s' in: %s", words, found, code, why, said);
}

static void broken_input(void **state) {
  (void)state;
  refuse("", 2, "no file given");
  refuse("none.yaml", 4, "none.yaml: cannot be opened");
  refuse("--finer --no-mesh three.yaml", 2, "one mode at a time");
  write_case("bad.yaml", ".3", "", "converge: {tolerance: 0}\n");
  refuse("bad.yaml", 2, "converge.tolerance: is 0, must be above 0 to 1");
  write_case("bad.yaml", ".3", "", "converge: {toleranse: 1}\n");
  refuse("bad.yaml", 2, "did you mean 'tolerance'?");
  write_case("bad.yaml", ".3", "", "converge: {n0: [5 N, 6 N]}\n");
  refuse("bad.yaml", 2, "converge.n0: no preload of contact.n0 lies between 5 and 6 N");
  write_case("bad.yaml", ".3", "", "converge: {output: tip}\n");
  refuse("bad.yaml", 2, "converge.output: 'tip' is not known; expected one of contact, contact");
  assert_int_equal(count(said, "\n"), 1);
  static const char varied[] =
      "modal: {file: three.h5}\n"
      "contact: {to: ground, psi: 0, phi: 0, mu: 0.4, ku: 0.5, kv: 0.8, n0: 0.3}\n"
      "mhb: {frequency: 0.2 Hz, vary: {mu: [0, 1]}}\n";
  scratch_write(folder, "bad.yaml", varied, strlen(varied));
  refuse("bad.yaml", 2, "mhb.vary: converge compares curves over the frequency; leave it out");
  scratch_write(folder, "broken.h5", "nothing", 7);
  write_case("bad.yaml", ".3", "", "");
  char command[4 * SCRATCH_PATH];
  snprintf(command, sizeof command, "sed -i 's/three.h5/broken.h5/' '%s/bad.yaml'", folder);
  assert_int_equal(system(command), 0);
  refuse("bad.yaml", 4, "broken.h5");
  assert_int_equal(count(said, "\n"), 1);
}

/* ------------------------------------------------------------------ a disc */

/* A case of the lumped disc with a file of its nodal diameters up to last. */
static void write_disc(const lumped_disc *d, int last, double range[2]) {
  static const shb_provenance provenance = {"", "", "", ""};
  modal_nodal_diameters       waves;
  char                        path[2 * SCRATCH_PATH], text[512];
  hid_t                       file;
  lumped_disc_waves(d, DISC_DOFS, &waves);
  range[0]      = .85 * waves.model[3].frequency[0];
  range[1]      = 1.3 * waves.model[3].frequency[0];
  const int all = waves.n;
  waves.n       = last + 1;
  snprintf(path, sizeof path, "%s/disc.h5", folder);
  assert_int_equal(h5_create(path, &file), SHB_OK);
  assert_int_equal(h5_write_provenance(file, "shroudhb modal model", 3, &provenance), SHB_OK);
  assert_int_equal(modal_nodal_diameters_write(file, &waves), SHB_OK);
  assert_int_equal(h5_close(file), SHB_OK);
  waves.n = all;
  modal_nodal_diameters_free(&waves);
  snprintf(text, sizeof text,
           "name: disc\n"
           "modal: {file: disc.h5}\n"
           "rotor: {blades: %d}\n"
           "excitation: {engine_order: 3}\n"
           "contact: {to: neighbour, mu: 0.4, ku: 0.5, kv: 0.8, n0: 0.3}\n"
           "mhb: {frequency: [%.15g, %.15g], harmonics: 3, max_points: 5000}\n",
           DISC_SECTORS, range[0], range[1]);
  scratch_write(folder, "disc.yaml", text, strlen(text));
}

/* The ladder of modes keeps as many at each nodal diameter, and its errors fall. A file that lacks
 * a nodal diameter is told before any rung. */
static void a_disc(void **state) {
  (void)state;
  const lumped_disc d = lumped_disc_of(0.8, 1.7);
  double            range[2];
  char              path[2 * SCRATCH_PATH];
  write_disc(&d, 2, range);
  assert_int_equal(converge("disc.yaml"), 2);
  assert_non_null(strstr(said, "meets the disc at nodal diameter"));
  assert_non_null(strstr(said, "modal.nodal_diameters=all"));
  write_disc(&d, DISC_SECTORS / 2, range);
  const int code = converge("disc.yaml");
  if (code != 0 && code != 3) fail_msg("exit code %d: %s", code, said);
  snprintf(path, sizeof path, "%s/disc.converge.h5", folder);
  post_convergence_free(&result);
  assert_int_equal(post_convergence_read(path, &result), SHB_OK);
  for (int i = 0; i < result.n; i++) assert_int_equal(result.rung[i].state, POST_RUNG_DONE);
  assert_true(rung_of(POST_LADDER_MODES, "12")->reference);
  const double few  = rung_of(POST_LADDER_MODES, "2")->peak;
  const double more = rung_of(POST_LADDER_MODES, "8")->peak;
  print_message("peak with 2 and 8 of 12 modes: off by %.1e and %.1e\n", few, more);
  assert_true(few > 1e-3 && more < .1 * few);
  assert_true(rung_of(POST_LADDER_BARE, "8")->peak > more); /* the residual terms count */
  read_result();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(errors_fall),
                                     cmocka_unit_test(time_integration_agrees),
                                     cmocka_unit_test(errors_are_those_of_the_curves),
                                     cmocka_unit_test(the_cheapest_is_named),
                                     cmocka_unit_test(results_are_kept),
                                     cmocka_unit_test(the_report_shows_it),
                                     cmocka_unit_test(keys_are_heeded),
                                     cmocka_unit_test(interrupted),
                                     cmocka_unit_test(a_disc),
                                     cmocka_unit_test(broken_input)};
  return cmocka_run_group_tests(tests, start, clean);
}
