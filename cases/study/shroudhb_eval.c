/* shroudhb-eval: one design for a driver such as Dakota: parameters file in, results file out. */
#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/peaks/design_run.h"
#include "cases/schema/case.h"
#include "cases/study/dakota_files.h"
#include "cases/study/modal_store.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "postproc/draw/text_buffer.h"

static const char usage[] =
    "usage: shroudhb-eval [--set KEY=NUMBER]... [--into FOLDER] CASE.yaml --params IN --results "
    "OUT\n"
    "\n"
    "Computes one design of a case for another program's driver. IN and OUT are the parameters "
    "and\n"
    "results files of Dakota, in its standard format or that of aprepro. Variables are named by "
    "keys\n"
    "of the case (contact.n0, or contact__n0), responses by outputs of studies (peak, frequency,\n"
    "modes__1__frequency). The active set is heeded: 1 value, 2 gradient of the peak.\n"
    "If the design has no result, OUT begins with FAIL.\n"
    "--set gives a number of the case another value; modal files go to FOLDER, else beside the "
    "case.\n"
    "\n"
    "Exit codes: 0 done, 2 bad input, 3 no result, 4 input/output.\n";

typedef struct {
  const char       *case_path, *params, *results, *into;
  int               n_set;
  const char       *set[STUDY_MAX_KEYS];
  dakota_parameters p;
  study_spec        spec;
  char              text_path[PATH_MAX]; /* the design as a study, for the messages about it */
  double            value[DAKOTA_MOST];
  double            gradient[DAKOTA_MOST * DAKOTA_MOST];
} evaluation;

static bool parse_words(int argc, char **argv, evaluation *e) {
  for (int i = 1; i < argc; i++) {
    bool more = i + 1 < argc;
    if (strcmp(argv[i], "--params") == 0 && more)
      e->params = argv[++i];
    else if (strcmp(argv[i], "--results") == 0 && more)
      e->results = argv[++i];
    else if (strcmp(argv[i], "--into") == 0 && more)
      e->into = argv[++i];
    else if (strcmp(argv[i], "--set") == 0 && more && strchr(argv[i + 1], '=') &&
             e->n_set < STUDY_MAX_KEYS)
      e->set[e->n_set++] = argv[++i];
    else if (argv[i][0] != '-' && !e->case_path)
      e->case_path = argv[i];
    else
      return false;
  }
  return e->case_path && e->params && e->results;
}

/* The design as the text of a study with one value a key. */
static shb_status write_study(evaluation *e) {
  char        path[2 * DAKOTA_TAG], real[PATH_MAX];
  post_buffer text = {0};
  SHB_CHECK(realpath(e->case_path, real), SHB_ERR_IO, "%s: cannot be found", e->case_path);
  post_put(&text, "case: '%s'\nvary:\n", real);
  for (int i = 0; i < e->p.n_variables; i++) {
    dakota_path(e->p.variable[i], path);
    post_put(&text, "  %s: [%.17g]\n", path, e->p.value[i]);
  }
  for (int i = 0; i < e->n_set; i++) {
    const int n = (int)strcspn(e->set[i], "=");
    post_put(&text, "  %.*s: [%s]\n", n, e->set[i], e->set[i] + n + 1);
  }
  post_put(&text, "outputs:\n");
  for (int i = 0; i < e->p.n_responses; i++) {
    dakota_path(e->p.response[i], path);
    post_put(&text, "  - '%s'\n", path);
  }
  snprintf(e->text_path, sizeof e->text_path, "%s.study.yaml", e->results);
  shb_status status = post_buffer_publish(&text, e->text_path);
  post_buffer_free(&text);
  return status;
}

/* The number of the derivative by a variable; -1: the program has none. */
static int derivative_by(const evaluation *e, int variable) {
  bool any = study_derivatives(e->spec.n_outputs, e->spec.output) > 0;
  return any ? study_key_derivative(&e->spec.base, &e->spec.keys.key[variable]) : -1;
}

/* Values and gradients from the design; false with a reason. */
static bool take_results(evaluation *e, const study_design *d, char *why, size_t size) {
  const dakota_parameters *p = &e->p;
  if (d->state != STUDY_DONE) {
    snprintf(why, size, "%s", d->reason && d->reason[0] ? d->reason : "the design has no result");
    return false;
  }
  for (int i = 0; i < p->n_responses; i++) {
    e->value[i] = d->value[i];
    if ((p->active[i] & 1) && !isfinite(d->value[i])) {
      snprintf(why, size, "%s is not known", p->response[i]);
      return false;
    }
    for (int k = 0; (p->active[i] & 2) && k < p->n_derivatives; k++) {
      int by = derivative_by(e, p->derivative[k]);
      e->gradient[i * p->n_derivatives + k] =
          by >= 0 && e->spec.output[i].quantity == STUDY_PEAK ? d->derivative[by] : NAN;
      if (isfinite(e->gradient[i * p->n_derivatives + k])) continue;
      snprintf(why, size, "there is no derivative of %s by %s", p->response[i],
               p->variable[p->derivative[k]]);
      return false;
    }
    if (p->active[i] & 4) {
      snprintf(why, size, "there is no Hessian of %s", p->response[i]);
      return false;
    }
  }
  return true;
}

static shb_status compute(evaluation *e, design_study *one, study_design **design) {
  const study_spec *s  = &e->spec;
  int               by = study_derivatives(s->n_outputs, s->output);
  modal_store       store;
  case_file         file;
  case_model        model;
  peak_field       *field;
  SHB_TRY(design_study_create(s->keys.n, s->n_outputs, by, one));
  *design = design_study_add(one, s->design);
  SHB_CHECK(*design, SHB_ERR_IO, "out of memory");
  SHB_TRY(modal_store_open(s, &store));
  shb_status status = study_spec_design(s, s->design, NULL, NULL, stderr, &file);
  if (status == SHB_OK) {
    status = modal_store_get(&store, s->design, &file, &model, &field);
    if (status == SHB_OK)
      status = design_run(&file, &model, field, s->n_outputs, s->output, *design);
    case_free(&file);
  }
  modal_store_close(&store);
  return status;
}

/* Modal files stay beside the case, or in the folder of --into, for all evaluations. */
static shb_status beside_case(evaluation *e) {
  char  folder[PATH_MAX], leaf[PATH_MAX];
  char *name = NULL;
  snprintf(folder, sizeof folder, "%s", e->spec.case_path);
  snprintf(leaf, sizeof leaf, "%s", e->spec.case_path);
  free(e->spec.folder);
  free(e->spec.name);
  name           = basename(leaf);
  e->spec.name   = strndup(name, strcspn(name, "."));
  e->spec.folder = strdup(e->into ? e->into : dirname(folder));
  SHB_CHECK(e->spec.name && e->spec.folder, SHB_ERR_IO, "out of memory");
  return e->into ? shb_make_folder(e->into) : SHB_OK;
}

static shb_status evaluate(evaluation *e) {
  design_study  one      = {0};
  study_design *design   = NULL;
  char          why[512] = "";
  SHB_CHECK(dakota_read(e->params, &e->p, why, sizeof why), SHB_ERR_INPUT, "%s: %s", e->params,
            why);
  SHB_TRY(write_study(e));
  SHB_TRY(study_spec_read(e->text_path, true, stderr, &e->spec));
  unlink(e->text_path);
  SHB_TRY(beside_case(e));
  shb_status status = compute(e, &one, &design);
  bool       good   = status == SHB_OK && take_results(e, design, why, sizeof why);
  design_study_free(&one);
  SHB_TRY(status);
  SHB_CHECK(good, SHB_NOT_CONVERGED, "%s", why);
  SHB_CHECK(dakota_write(e->results, &e->p, e->value, e->gradient), SHB_ERR_IO,
            "%s: cannot be written", e->results);
  return SHB_OK;
}

int main(int argc, char **argv) {
  static evaluation e;
  if (argc == 2 && strcmp(argv[1], "--help") == 0) {
    fputs(usage, stdout);
    return SHB_OK;
  }
  if (!parse_words(argc, argv, &e)) {
    fputs(
        "shroudhb: error: expected [--set KEY=NUMBER] [--into FOLDER] CASE.yaml --params IN "
        "--results OUT\n",
        stderr);
    return SHB_ERR_INPUT;
  }
  /* A crash leaves this behind, and the driver learns of it. */
  if (!dakota_fail(e.results, "the program ended before it had a result")) {
    fprintf(stderr, "shroudhb: error: %s: cannot be written\n", e.results);
    return SHB_ERR_IO;
  }
  shb_interrupt_catch();
  shb_status status = evaluate(&e);
  if (status != SHB_OK)
    dakota_fail(e.results, shb_message()[0] ? shb_message() : "the input is wrong; see its errors");
  study_spec_free(&e.spec);
  return command_finish(status);
}
