#define _GNU_SOURCE /* sched_getaffinity */
/* shroudhb study: a design study on the cores of this machine, or over MPI on several machines; or
 * one design of it in full. */
#include <glob.h>
#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/designs/study_echo.h"
#include "cases/peaks/design_memory.h"
#include "cases/peaks/own_run.h"
#include "cases/study/design_process.h"
#include "cases/study/shroudhb_study.h"
#include "cases/study/study_run.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/process/report.h"
#include "postproc/study/study_file.h"
#include "postproc/summary/summary.h"

/* Cores that this process may use. */
static int n_cores(void) {
  cpu_set_t set;
  CPU_ZERO(&set);
  int n = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  return n > 0 ? n : 1;
}

/* The time that the designs in a file of this case took. */
static void add_cost(const study_spec *spec, const char *path, study_cost *cost, double *seconds) {
  design_study known;
  if (study_file_read(path, &known) != SHB_OK) return;
  const bool ours = known.case_text && strcmp(known.case_text, spec->base.text) == 0;
  for (int i = 0; ours && i < known.n; i++) {
    if (!(known.design[i].seconds > 0)) continue;
    *seconds += known.design[i].seconds;
    cost->n++;
  }
  design_study_free(&known);
}

/* From all studies beside this one. */
static study_cost cost_of(const study_spec *spec) {
  study_cost cost    = {0};
  double     seconds = 0;
  char      *pattern = shb_text_of("%s/*.study.h5", spec->folder);
  glob_t     found   = {0};
  if (glob(pattern, 0, NULL, &found) != 0) found.gl_pathc = 0;
  for (size_t i = 0; i < found.gl_pathc; i++) add_cost(spec, found.gl_pathv[i], &cost, &seconds);
  globfree(&found);
  free(pattern);
  if (cost.n > 0) cost.seconds = seconds / cost.n;
  return cost;
}

static shb_status check(const study_spec *spec, const command_options *options) {
  if (options->json) {
    post_buffer text = {0};
    post_put(&text, "{\"ok\": true, \"name\": ");
    post_put_json(&text, spec->name);
    post_put(&text, ", \"case\": ");
    post_put_json(&text, spec->case_path);
    post_put(&text, ", \"designs\": %d}\n",
             spec->optimise.wanted ? spec->optimise.evaluations : spec->n_designs);
    if (text.text) fputs(text.text, stdout);
    post_buffer_free(&text);
  } else if (!options->quiet) {
    const study_cost cost = cost_of(spec);
    study_echo(spec, &cost, n_cores(), stdout);
  }
  return SHB_OK;
}

static shb_status print_json(const study_spec *spec) {
  post_buffer text   = {0};
  char       *path   = study_path(spec, ".study.h5");
  shb_status  status = post_summary_of_file(path, &text);
  if (status == SHB_OK) fwrite(text.text, 1, text.length, stdout);
  post_buffer_free(&text);
  free(path);
  return status;
}

/* A design, by the child process. */
static shb_status compute(void *process, const double *value, char **bytes, size_t *size) {
  return design_process_run(process, value, bytes, size);
}

/* The study on the manager. */
static shb_status manage(const study_spec *spec, const command_options *options,
                         const crew_staff *workers) {
  shb_progress progress = shb_progress_start("study", options->quiet, options->verbose);
  design_study study    = {0};
  shb_status   status   = study_run(spec, options->force, workers, &progress, &study);
  bool         whole    = status == SHB_OK || status == SHB_NOT_CONVERGED;
  if (whole && options->json) {
    shb_status printed = print_json(spec);
    if (printed != SHB_OK) status = printed;
  } else if (whole && !options->quiet) {
    study_run_summary(spec, &study, stdout);
  }
  shb_progress_note(&progress, "%.2f s in all", shb_seconds() - progress.started);
  design_study_free(&study);
  return status;
}

/* May the results of the study be written? */
static shb_status check_outputs(const study_spec *spec) {
  static const char *const suffix[] = {".study.h5", ".study.csv", ".study.html", ".study.svg"};
  for (size_t i = 0; i < sizeof suffix / sizeof *suffix; i++)
    SHB_TRY(shb_publish_check_freed(study_path(spec, suffix[i])));
  return SHB_OK;
}

static shb_status read_spec(const command_options *o, bool check, study_spec *spec) {
  const case_overrides overrides = {.n = o->n_set, .text = o->set, .into = o->into};
  return study_spec_read_with(o->path, &overrides, check, stderr, spec);
}

/* Read and check on the manager. */
static shb_status read_study(const command_options *options, study_spec *spec) {
  SHB_TRY(read_spec(options, true, spec));
  if (options->into) SHB_TRY(shb_make_folder(options->into));
  return check_outputs(spec);
}

/* The texts of a study for the processes that compute designs, each with its NUL; malloc'ed. */
static shb_status pack_texts(const study_spec *spec, char **texts, size_t *size) {
  *texts    = NULL;
  FILE *out = open_memstream(texts, size);
  SHB_CHECK(out, SHB_ERR_IO, "out of memory");
  fprintf(out, "%s%c%s%c", spec->text, 0, spec->base.text, 0);
  for (int k = 0; spec->plan.kind == STUDY_TABLE && k < spec->keys.n; k++)
    if (!spec->keys.key[k].is_uncertain) fprintf(out, "%s\n", spec->keys.key[k].path);
  fprintf(out, "%c%s%c%s%c%s%c", 0, spec->inputs, 0, spec->sets, 0, spec->into ? spec->into : "",
          0);
  SHB_CHECK(fclose(out) == 0 && *texts, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

static design_job job_of(const study_spec *spec, const char *texts, size_t size, int sharing) {
  return (design_job){.study         = spec->path,
                      .texts         = texts,
                      .size          = size,
                      .n_request     = 2 * spec->keys.n,
                      .n_outputs     = spec->n_outputs,
                      .n_derivatives = study_derivatives(spec->n_outputs, spec->output),
                      .sharing       = sharing};
}

/* Of a core each, no more than there are designs. */
static int n_workers(const study_spec *spec) {
  const int cores = n_cores();
  const int most  = spec->optimise.wanted ? spec->optimise.evaluations : spec->n_designs;
  return cores < most ? cores : most > 1 ? most : 1;
}

/* As many processes as fit into memory beside each other, halved until they do. */
static shb_status fit(const study_spec *spec, int *n) {
  const int asked = *n;
  while (*n > 1 && design_memory_check(spec, *n) == SHB_ERR_INPUT) *n /= 2;
  SHB_TRY(design_memory_check(spec, *n));
  if (*n < asked)
    fprintf(stderr, "shroudhb: warning: %d of %d processes fit into memory beside each other\n", *n,
            asked);
  return SHB_OK;
}

/* A process a core on this machine. */
static shb_status work_here(const command_options *options, study_spec *spec) {
  char  *texts = NULL;
  size_t size  = 0;
  SHB_TRY(read_study(options, spec));
  int         n = n_workers(spec);
  design_pool pool;
  SHB_TRY(fit(spec, &n));
  SHB_TRY(pack_texts(spec, &texts, &size));
  const design_job job    = job_of(spec, texts, size, n);
  shb_status       status = design_pool_create(&job, n, &pool);
  const crew_staff all    = {&pool, n, design_pool_manage};
  if (status == SHB_OK) status = manage(spec, options, &all);
  design_pool_free(&pool);
  free(texts);
  return status;
}

/* ---------------------------------------------------------------- over MPI */

/* The workers on other ranks, or the only rank by itself. */
typedef struct {
  const crew_computer *computer;
  bool                 managed; /* the workers were released */
} ranks;

static shb_status manage_ranks(void *context, const crew_work *work) {
  ranks *r   = context;
  r->managed = true;
  return crew_manage(work, r->computer);
}

/* All ranks: the manager reads and checks, the workers get what it has read. */
static shb_status work_over_mpi(const command_options *options, study_spec *spec) {
  enum { STATUS, KEYS, OUTPUTS, DERIVATIVES, SIZE, N };
  int        rank, go[N] = {SHB_OK};
  char      *texts  = NULL;
  size_t     size   = 0;
  shb_status status = SHB_OK;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int sharing = crew_sharing();
  if (rank == 0) status = read_study(options, spec);
  if (rank == 0 && status == SHB_OK) status = design_memory_check(spec, sharing);
  if (rank == 0 && status == SHB_OK) status = pack_texts(spec, &texts, &size);
  design_job job = job_of(spec, texts, size, sharing);
  memcpy(go, (int[N]){(int)status, job.n_request, job.n_outputs, job.n_derivatives, (int)size},
         sizeof go);
  MPI_Bcast(go, N, MPI_INT, 0, MPI_COMM_WORLD);
  if (go[STATUS] != SHB_OK) return status;
  if (rank > 0) texts = malloc((size_t)go[SIZE]);
  if (!texts) MPI_Abort(MPI_COMM_WORLD, SHB_ERR_IO);
  MPI_Bcast(texts, go[SIZE], MPI_CHAR, 0, MPI_COMM_WORLD);
  job = (design_job){options->path, texts,           (size_t)go[SIZE], go[KEYS],
                     go[OUTPUTS],   go[DERIVATIVES], sharing};
  design_process      process  = {.job = &job};
  const crew_computer computer = {&process, job.n_request, compute};
  ranks               others   = {&computer, false};
  const crew_staff    all      = {&others, crew_workers(), manage_ranks};
  status                       = rank == 0 ? manage(spec, options, &all) : crew_serve(&computer);
  if (rank == 0 && !others.managed) crew_dismiss();
  design_process_stop(&process);
  free(texts);
  return rank == 0 ? status : SHB_OK;
}

/* Whether mpiexec, srun or the like has started this process, perhaps as the only one. */
static bool is_launched(void) {
  static const char *const variable[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  for (size_t i = 0; i < sizeof variable / sizeof *variable; i++)
    if (getenv(variable[i])) return true;
  return false;
}

/* --design=I and --check: without MPI. */
static int work_alone(const command_options *options) {
  const int  design = options->design > 0 ? options->design : 0;
  study_spec spec   = {0};
  shb_status status = SHB_OK;
  if (design > 0 && options->json)
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "--design does not go with --json; the run of a design writes "
                      "NAME_I.summary.json");
  if (status == SHB_OK) status = read_spec(options, design == 0, &spec);
  if (status == SHB_OK && options->into && design > 0) status = shb_make_folder(options->into);
  if (status == SHB_OK)
    status = design > 0 ? own_run(&spec, design, options->quiet) : check(&spec, options);
  study_spec_free(&spec);
  return command_finish(status);
}

int study_command(const command_options *options) {
  if (options->design > 0 || options->mode) return work_alone(options);
  study_spec spec     = {0};
  const bool launched = is_launched();
  int        rank     = 0;
  if (launched && MPI_Init(NULL, NULL) != MPI_SUCCESS) {
    shb_error("MPI cannot be started");
    return SHB_ERR_IO;
  }
  if (launched) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  shb_interrupt_catch(); /* after MPI_Init, because the launcher sets handlers of its own */
  shb_status status = launched ? work_over_mpi(options, &spec) : work_here(options, &spec);
  const int  code   = rank == 0 ? command_finish(status) : SHB_OK;
  study_spec_free(&spec);
  if (launched) MPI_Finalize();
  return code;
}
