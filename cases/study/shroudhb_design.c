/* shroudhb-pool design: computes designs of a study, one after another, for its manager. */
#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>

#include "cases/commands/command.h"
#include "cases/parse/units.h"
#include "cases/peaks/design_run.h"
#include "cases/schema/case.h"
#include "cases/study/design_message.h"
#include "cases/study/design_process.h"
#include "cases/study/modal_store.h"
#include "cases/study/shroudhb_study.h"
#include "mesh/base/clock.h"
#include "mesh/base/progress.h"
#include "mesh/process/report.h"

typedef struct {
  study_spec  spec;
  modal_store store;
  int         sharing; /* processes that share the memory */
} server;

/* The outputs of a design, from and to peaks of others (design_run_from). */
static shb_status run(server *s, const double *value, const solved_peak *from, solved_peak *found,
                      study_design *design) {
  case_file   file;
  case_model  model;
  peak_field *field;
  SHB_TRY(study_spec_design(&s->spec, value, NULL, NULL, stderr, &file));
  file.mhb.sharing  = s->sharing;
  shb_status status = modal_store_get(&s->store, value, &file, &model, &field);
  if (status == SHB_OK)
    status = design_run_from(&file, &model, field, s->spec.n_outputs, s->spec.output, from, found,
                             design);
  case_free(&file);
  return status;
}

/* The highest peak of a neighbour, computed again. Faults of it leave the peak without a
 * solution. */
static shb_status find_peak(server *s, const double *value, int by, solved_peak *peak) {
  design_study  one;
  shb_status    status = design_study_create(s->spec.keys.n, s->spec.n_outputs, by, &one);
  study_design *design = status == SHB_OK ? design_study_add(&one, value) : NULL;
  if (status == SHB_OK) status = design ? run(s, value, NULL, peak, design) : SHB_ERR_IO;
  design_study_free(&one);
  return status == SHB_INTERRUPTED ? status : SHB_OK;
}

/* The outputs of a design. What is wrong with a design becomes its reason. */
static shb_status evaluate(server *s, const double *request, int by, study_design *design) {
  const double *beside = request + s->spec.keys.n;
  const bool    again  = s->spec.keys.n > 0 && !isnan(beside[0]);
  solved_peak   from   = {0};
  shb_status    status = again ? find_peak(s, beside, by, &from) : SHB_OK;
  if (status == SHB_OK) status = run(s, request, again ? &from : NULL, NULL, design);
  solved_peak_free(&from);
  if (status == SHB_OK || status == SHB_INTERRUPTED) return status;
  design->state = STUDY_FAILED;
  study_design_set_reason(design, shb_message()[0] ? shb_message() : "the case is refused");
  return SHB_OK;
}

static shb_status compute(void *context, const double *value, char **bytes, size_t *size) {
  server       *s = context;
  design_study  one;
  double        began  = shb_processor_seconds();
  int           by     = study_derivatives(s->spec.n_outputs, s->spec.output);
  shb_status    status = design_study_create(s->spec.keys.n, s->spec.n_outputs, by, &one);
  study_design *design = status == SHB_OK ? design_study_add(&one, value) : NULL;
  if (status == SHB_OK && !design)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = evaluate(s, value, by, design);
  if (status == SHB_OK) {
    design->seconds = shb_processor_seconds() - began;
    status          = design_message_pack(design, s->spec.n_outputs, by, bytes, size);
  }
  design_study_free(&one);
  return status;
}

/* Mesh and modes of a design have this process's share of the cores, unless the user has said how
 * many threads. With more than there are cores, threads wait for each other. */
static void share_cores(int sharing) {
  char      threads[16];
  const int own = omp_get_num_procs() / sharing;
  snprintf(threads, sizeof threads, "%d", own > 1 ? own : 1);
  setenv("OMP_NUM_THREADS", threads, 0);
}

/* The manager tells this process when to stop, and it goes with the manager. What it leaves undone
 * is not its to tell: a second signal, or the end of the grace, ends it without a word. Ctrl-C and
 * the end of a terminal go to all its processes, and are left to the manager. */
static void follow_manager(void) {
  enum { GRACE = 5 }; /* s */
  struct sigaction action;
  shb_interrupt_catch();
  shb_interrupt_grace(GRACE);
  sigaction(SIGTERM, NULL, &action);
  action.sa_flags |= (int)SA_RESETHAND;
  sigaction(SIGTERM, &action, NULL);
  signal(SIGALRM, SIG_DFL);
  signal(SIGINT, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
}

static shb_status serve(server *s, const char *path) {
  char       *texts;
  study_texts read;
  shb_status  status = design_process_texts(&texts, &read);
  if (status == SHB_OK) status = study_spec_read_texts(path, &read, stderr, &s->spec);
  if (status == SHB_OK) status = modal_store_open(&s->spec, &s->store);
  if (status == SHB_OK) status = design_process_serve(2 * s->spec.keys.n, compute, s);
  modal_store_close(&s->store);
  study_spec_free(&s->spec);
  free(texts);
  return status;
}

int design_command(const command_options *options) {
  char   why[CASE_WHY];
  server s = {.sharing = 1};
  if (options->other && (!case_integer(options->other, &s.sharing, why) || s.sharing < 1)) {
    shb_error("PROCESSES takes a number, from 1");
    return SHB_ERR_INPUT;
  }
  follow_manager();
  share_cores(s.sharing);
  openblas_set_num_threads(1);
  omp_set_num_threads(1); /* the designs run side by side */
  const shb_status status = serve(&s, options->path);
  return status == SHB_INTERRUPTED ? SHB_INTERRUPTED : command_finish(status);
}
