/* shroudhb eval: one design for a driver such as Dakota: parameters file in, results file out. */
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
#include "cases/study/shroudhb_study.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/process/report.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const command_options *given;
  dakota_parameters      p;
  study_spec             spec;
  char                   text_path[PATH_MAX]; /* the design as a study, for the messages about it */
  double                 value[DAKOTA_MOST];
  double                 gradient[DAKOTA_MOST * DAKOTA_MOST];
} evaluation;

/* The design as the text of a study with one value a key. */
static shb_status write_study(evaluation *e) {
  char        path[2 * DAKOTA_TAG], real[PATH_MAX];
  post_buffer text = {0};
  SHB_CHECK(realpath(e->given->path, real), SHB_ERR_IO, "%s: cannot be found", e->given->path);
  post_put(&text, "case: '%s'\nvary:\n", real);
  for (int i = 0; i < e->p.n_variables; i++) {
    dakota_path(e->p.variable[i], path);
    post_put(&text, "  %s: [%.17g]\n", path, e->p.value[i]);
  }
  for (int i = 0; i < e->given->n_set; i++) {
    const int n = (int)strcspn(e->given->set[i], "=");
    post_put(&text, "  %.*s: [%s]\n", n, e->given->set[i], e->given->set[i] + n + 1);
  }
  post_put(&text, "outputs:\n");
  for (int i = 0; i < e->p.n_responses; i++) {
    dakota_path(e->p.response[i], path);
    post_put(&text, "  - '%s'\n", path);
  }
  snprintf(e->text_path, sizeof e->text_path, "%s.study.yaml", e->given->results);
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
  e->spec.folder = strdup(e->given->into ? e->given->into : dirname(folder));
  SHB_CHECK(e->spec.name && e->spec.folder, SHB_ERR_IO, "out of memory");
  return e->given->into ? shb_make_folder(e->given->into) : SHB_OK;
}

static shb_status evaluate(evaluation *e) {
  design_study  one      = {0};
  study_design *design   = NULL;
  char          why[512] = "";
  SHB_CHECK(dakota_read(e->given->params, &e->p, why, sizeof why), SHB_ERR_INPUT, "%s: %s",
            e->given->params, why);
  SHB_TRY(write_study(e));
  SHB_TRY(study_spec_read(e->text_path, true, stderr, &e->spec));
  unlink(e->text_path);
  SHB_TRY(beside_case(e));
  shb_status status = compute(e, &one, &design);
  bool       good   = status == SHB_OK && take_results(e, design, why, sizeof why);
  design_study_free(&one);
  SHB_TRY(status);
  SHB_CHECK(good, SHB_NOT_CONVERGED, "%s", why);
  SHB_CHECK(dakota_write(e->given->results, &e->p, e->value, e->gradient), SHB_ERR_IO,
            "%s: cannot be written", e->given->results);
  return SHB_OK;
}

/* What is missing or wrong; NULL: nothing. */
static const char *fault(const command_options *o) {
  if (!o->params || !o->results) return "--params IN and --results OUT are needed";
  for (int i = 0; i < o->n_set; i++)
    if (!strchr(o->set[i], '=')) return "--set needs KEY=NUMBER";
  return o->n_set > STUDY_MAX_KEYS ? "more --set than a study has keys" : NULL;
}

int eval_command(const command_options *options) {
  const char *wrong = fault(options);
  if (wrong) {
    shb_error("%s; see --help", wrong);
    return SHB_ERR_INPUT;
  }
  static evaluation e;
  e.given = options;
  /* A crash leaves this behind, and the driver learns of it. */
  if (!dakota_fail(options->results, "the program ended before it had a result")) {
    shb_error("%s: cannot be written", options->results);
    return SHB_ERR_IO;
  }
  shb_interrupt_catch();
  shb_status status = evaluate(&e);
  if (status != SHB_OK)
    dakota_fail(options->results,
                shb_message()[0] ? shb_message() : "the input is wrong; see its errors");
  study_spec_free(&e.spec);
  return command_finish(status);
}
