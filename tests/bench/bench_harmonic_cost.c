/* Seconds and error of a curve's points against the number of harmonics, 15 to 127.
 *
 *   bench_harmonic_cost                 the tables
 *   bench_harmonic_cost --quick         up to 31 harmonics, in a second or so
 *   bench_harmonic_cost --against MHB   beside each row that of MHB, a shroudhb-mhb of any version
 *
 * One degree of freedom with friction, and three with friction and separation, 13 points each. The
 * error is that of the first harmonic of the last point against 255 harmonics there. The growth is
 * the exponent of H in the seconds, from 31 and from 63 harmonics on. The exit code depends on
 * errors only, because times depend on the machine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/balance/newton.h"
#include "mhb/response/response.h"
#include "modal/hdf5/h5.h"
#include "tests/support/main_curve.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { POINTS = 13, LADDER = 4, QUICK = 2, FINE = 255, ROOM = 4096 };
static const int ladder[LADDER] = {15, 31, 63, 127};

/* A scene and its case text, but for the harmonics. */
typedef struct {
  const char *name;
  void (*model)(modal_model *model);
  double mu, kv, ku, n0;
} scene;

static void one_degree(modal_model *model) {
  one_degree_model(0.01, 1, 0.05, model);
}

static const scene scenes[] = {{"one degree, friction", one_degree, 0.3, 1, 2, 0.1},
                               {"three degrees", three_degree_model, 0.4, 0.8, 0.5, 0.1}};

/* What the last point of a curve says. */
typedef struct {
  double         seconds, truncation;
  double complex first; /* m, first harmonic along u */
  double         hz;
} row;

static mhb_settings settings_of(const scene *c, int harmonics) {
  mhb_settings s = ground_settings(c->mu, c->kv, c->ku, c->n0, harmonics);
  s.frequency[0] = 1.0 / SHB_TWO_PI;
  s.frequency[1] = 1.8 / SHB_TWO_PI;
  s.max_points   = POINTS;
  return s;
}

static row last_of(const mhb_branch *b, int harmonics, double seconds) {
  const int p = b->n_points - 1, K = harmonics + 1;
  return (row){.seconds    = seconds,
               .truncation = b->error_truncation[p],
               .hz         = b->frequency[p],
               .first      = b->motion[((size_t)p * 3 + 1) * (size_t)K + 1]};
}

static shb_status own_row(const scene *c, int harmonics, row *out) {
  modal_model        model;
  const mhb_settings s        = settings_of(c, harmonics);
  mhb_response      *response = NULL;
  double             seconds  = 0;
  c->model(&model);
  shb_status status = main_curve(&model, &s, harmonics, &seconds, &response);
  if (status == SHB_OK) *out = last_of(&response->branch[0], harmonics, seconds);
  mhb_response_destroy(response);
  modal_model_free(&model);
  return status;
}

/* |error| of a row against many harmonics at its frequency, relative. */
static shb_status error_of(const scene *c, const row *of, double *error) {
  modal_model        model;
  const mhb_settings s      = settings_of(c, FINE);
  mhb_balance       *b      = NULL;
  mhb_newton        *newton = NULL;
  int                iterations;
  c->model(&model);
  shb_status status = mhb_balance_create(&model, &s, &b);
  if (status == SHB_OK) newton = mhb_newton_create(b->n);
  double *x = status == SHB_OK ? calloc((size_t)b->n, sizeof *x) : NULL;
  if (x) {
    x[b->nb + 1] = creal(of->first);
    x[b->nb + 2] = cimag(of->first);
    *error       = NAN;
    if (mhb_newton_solve(newton, b, SHB_TWO_PI * of->hz, 1e-11, x, &iterations) == MHB_CONVERGED)
      *error = cabs(CMPLX(x[b->nb + 1], x[b->nb + 2]) - of->first) / cabs(of->first);
  }
  free(x);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
  return status;
}

/* The same curve by another program: processor seconds of its points. */
static shb_status other_row(const char *program, const scene *c, int harmonics, row *out) {
  char               folder[] = "/tmp/bench_harmonic_cost_XXXXXX", text[ROOM];
  modal_model        model;
  const mhb_settings s = settings_of(c, harmonics);
  shb_provenance own   = {.case_path = "one", .case_text = "", .settings = "", .command = "bench"};
  hid_t          file;
  SHB_CHECK(mkdtemp(folder), SHB_ERR_IO, "no folder %s", folder);
  snprintf(text, sizeof text, "%s/one.modal.h5", folder);
  c->model(&model);
  SHB_TRY(h5_create(text, &file));
  shb_status status = modal_model_write(file, &model, &own);
  modal_model_free(&model);
  if (status != SHB_OK) h5_abandon(file);
  SHB_TRY(status);
  SHB_TRY(h5_close(file));
  snprintf(text, sizeof text, "%s/one.yaml", folder);
  FILE *f = fopen(text, "w");
  SHB_CHECK(f, SHB_ERR_IO, "%s cannot be written", text);
  fprintf(
      f,
      "name: one\nmodal: {file: one.modal.h5}\ncontact: {to: ground, psi: 0 deg, phi: 0 deg, mu: "
      "%g, ku: %g, kv: %g, n0: %g}\nmhb:\n  frequency: [%.17g, %.17g]\n  harmonics: %d\n  "
      "stability: never\n  search: {starts: 0}\n  max_points: %d\n",
      c->mu, c->ku, c->kv, c->n0, s.frequency[0], s.frequency[1], harmonics, POINTS);
  fclose(f);
  snprintf(text, sizeof text, "'%s' --quiet '%s/one.yaml' >/dev/null 2>&1", program, folder);
  if (system(text) < 0) return SHB_ERR_IO;
  snprintf(text, sizeof text, "%s/one.response.h5", folder);
  mhb_response *response = NULL;
  SHB_TRY(mhb_response_read(text, &response));
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b       = &response->branch[i];
    double            seconds = 0;
    if (b->kind != MHB_BRANCH_NONLINEAR || b->n_points == 0) continue;
    for (int p = 0; p < b->n_points; p++) seconds += b->seconds[p];
    *out = last_of(b, b->n_harmonics, seconds);
    break;
  }
  mhb_response_destroy(response);
  snprintf(text, sizeof text, "rm -r '%s'", folder);
  return system(text) < 0 ? SHB_ERR_IO : SHB_OK;
}

static shb_status run(const scene *c, int rows, const char *program, int *failed) {
  double before = 0;
  printf("%s\n%4s %10s %8s %10s %10s%s\n", c->name, "H", "seconds", "growth", "error", "told",
         program ? "   other s    error" : "");
  for (int i = 0; i < rows; i++) {
    row    own, other = {0};
    double error = NAN, other_error = NAN;
    SHB_TRY(own_row(c, ladder[i], &own));
    SHB_TRY(error_of(c, &own, &error));
    if (program) SHB_TRY(other_row(program, c, ladder[i], &other));
    if (program) SHB_TRY(error_of(c, &other, &other_error));
    printf("%4d %10.3f %8.2f %10.1e %10.1e", ladder[i], own.seconds,
           i ? log(own.seconds / before) / log((double)ladder[i] / ladder[i - 1]) : NAN, error,
           own.truncation);
    if (program) printf(" %9.3f %9.1e", other.seconds, other_error);
    printf("\n");
    fflush(stdout);
    *failed += !(error < 3 * fmax(own.truncation, 1e-6));
    before = own.seconds;
  }
  return SHB_OK;
}

int main(int argc, char **argv) {
  const int   quick   = argc > 1 && strcmp(argv[1], "--quick") == 0;
  const char *program = argc > 2 && strcmp(argv[1], "--against") == 0 ? argv[2] : NULL;
  int         failed  = 0;
  for (int i = 0; i < 2; i++)
    if (run(&scenes[i], quick ? QUICK : LADDER, program, &failed) != SHB_OK) {
      fprintf(stderr, "%s\n", shb_message());
      return 2;
    }
  return failed > 0;
}
