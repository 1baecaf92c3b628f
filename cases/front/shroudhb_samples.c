#include <cblas.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/front/shroudhb_samples.h"

#include "cases/commands/balance_run.h"
#include "cases/commands/load_model.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/study/crew.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/process/report.h"

enum { REQUEST = 2 }; /* sample, preload */

/* The answer to a request. */
typedef struct {
  shb_status    status;
  mhb_ring_peak peak;
  char          text[256]; /* of an error */
} answer;

/* ---- a worker ---- */

typedef struct {
  const case_model *model;
  mhb_sampling      sampling;
} worker;

static shb_status compute(void *context, const double *value, char **bytes, size_t *size) {
  const worker *w  = context;
  answer       *to = shb_alloc_zeroed(1, sizeof *to);
  to->status = mhb_ring_sample(&w->model->tuned, &w->model->settings, &w->sampling, (int)value[0],
                               (int)value[1], &to->peak);
  if (to->status != SHB_OK) snprintf(to->text, sizeof to->text, "%s", shb_message());
  *bytes = (char *)to;
  *size  = sizeof *to;
  return SHB_OK;
}

/* Every worker reads the case. The manager has read it too and said what is wrong. */
static shb_status serve(const command_options *options) {
  case_file  file;
  case_model model;
  SHB_TRY(command_read(options, CASE_MHB, &file));
  char               *modal    = case_modal_path(&file);
  shb_status          status   = case_model_read(&file, modal, 0, true, &model);
  worker              w        = {&model, balance_sampling(&file)};
  const crew_computer computer = {&w, REQUEST, compute};
  if (status == SHB_OK) status = crew_serve(&computer);
  case_model_free(&model);
  free(modal);
  case_free(&file);
  return status;
}

/* ---- the manager ---- */

typedef struct {
  const mhb_sample_work *work;
  double                 request[REQUEST];
  int                    shared; /* 1: the workers were released */
  int                    n;      /* samples */
} manager;

static int next(void *context, const double **value) {
  manager *m = context;
  int      sample, preload;
  if (!m->work->next(m->work->context, &sample, &preload)) return -1;
  m->request[0] = sample;
  m->request[1] = preload;
  *value        = m->request;
  return preload * m->n + sample;
}

static shb_status done(void *context, int job, const char *bytes, size_t size) {
  manager *m = context;
  answer   of;
  SHB_CHECK(size == sizeof of, SHB_ERR_IO, "a worker's answer has %zu bytes", size);
  memcpy(&of, bytes, sizeof of);
  SHB_CHECK(of.status == SHB_OK, of.status, "%s", of.text);
  return m->work->done(m->work->context, job % m->n, job / m->n, &of.peak);
}

static shb_status tick(void *context) {
  manager *m = context;
  return m->work->tick(m->work->context);
}

static shb_status share(void *context, const mhb_sample_work *work) {
  manager            *m        = context;
  const crew_work     jobs     = {m, next, done, tick};
  const crew_computer computer = {NULL, REQUEST, NULL}; /* the workers' */
  m->work                      = work;
  m->shared                    = 1;
  return crew_manage(&jobs, &computer);
}

static shb_status manage(const case_file *file, const command_options *options, int sharing) {
  manager               m    = {.n = file->mistuning.samples};
  const mhb_sample_crew crew = {&m, share, sharing};
  int                   ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const shb_status status = balance_run(file, options, ranks > 1 ? &crew : NULL);
  if (!m.shared) crew_dismiss();
  return status;
}

static shb_status read_case(const command_options *options, case_file *file) {
  SHB_TRY(command_read(options, CASE_MHB, file));
  file->mhb.resume = !options->force;
  if (file->mistuning.samples > 0) return SHB_OK;
  case_free(file);
  SHB_FAIL(SHB_ERR_INPUT,
           "%s has no samples; give rotor.mistuning: {deviation: 1 %%, seed: 7, samples: 100}, or "
           "use shroudhb mhb",
           options->path);
}

/* Rank 0 reads the case first, so that its errors are told once. */
static int work(const command_options *options) {
  case_file  file = {0};
  int        rank, go;
  shb_status status = SHB_OK;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) status = read_case(options, &file);
  go = (int)status;
  MPI_Bcast(&go, 1, MPI_INT, 0, MPI_COMM_WORLD);
  const int sharing = crew_sharing();
  if (go == SHB_OK) status = rank == 0 ? manage(&file, options, sharing) : serve(options);
  if (rank == 0 && go == SHB_OK) case_free(&file);
  if (rank == 0) return command_finish(status);
  /* the manager would wait for ever */
  if (status != SHB_OK) MPI_Abort(MPI_COMM_WORLD, command_finish(status));
  return SHB_OK;
}

int samples_command(const command_options *options) {
  if (MPI_Init(NULL, NULL) != MPI_SUCCESS) {
    shb_error("MPI cannot be started");
    return SHB_ERR_IO;
  }
  shb_interrupt_catch(); /* after MPI_Init, because the launcher sets handlers of its own */
  openblas_set_num_threads(1);
  const int code = work(options);
  MPI_Finalize();
  return code;
}
