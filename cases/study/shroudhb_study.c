/* shroudhb-study: a design study over MPI, one manager and workers; or one design of it in full. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/commands/subprocess.h"
#include "cases/parse/units.h"
#include "cases/peaks/design_memory.h"
#include "cases/peaks/own_run.h"
#include "cases/study/design_process.h"
#include "cases/study/study_run.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "postproc/study/study_file.h"
#include "postproc/summary/summary.h"

static const char usage[] =
    "usage: shroudhb-study [--quiet] [--verbose] [--force] [--json] STUDY.yaml\n"
    "       mpiexec -n N shroudhb-study STUDY.yaml\n"
    "       shroudhb-study --design=I STUDY.yaml\n"
    "       shroudhb-study --check [--json] STUDY.yaml\n"
    "\n"
    "Runs the designs of STUDY.yaml and writes NAME.study.h5 and NAME.study.csv. Of N processes\n"
    "one manages and the others compute; `shroudhb study` starts one for every core.\n"
    "A study that was stopped goes on where it was. Modal files stay in NAME.study.d.\n"
    "\n"
    "  --design=I  run design I alone, all stages, with a report of its own\n"
    "  --check     check the study and all its designs, run nothing\n"
    "  --force     compute all designs anew\n"
    "\n"
    "Exit codes: 0 done, 2 bad input, 3 some designs failed or did not converge, 4 input/output,\n"
    "130 interrupted (results so far kept).\n";

static void print_key(const study_key *key) {
  char name[STUDY_KEY_TEXT];
  bool pure = key->unit[0] == '-';
  study_key_name(key, name);
  printf("  %-9s %s%s%s", key->is_uncertain ? "uncertain" : "vary", name, pure ? "" : ", ",
         pure ? "" : key->unit);
  if (key->is_uncertain) printf(", %s", plan_distribution_name(key->distribution.kind));
  printf("\n");
}

static shb_status check(const study_spec *spec, const command_options *options) {
  char plan[STUDY_NAME];
  int  group = study_plan_group(&spec->plan, &spec->keys);
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
    return SHB_OK;
  }
  if (options->quiet) return SHB_OK;
  if (spec->optimise.wanted) {
    const study_optimise *o = &spec->optimise;
    printf("%s: ok\n  case      %s\n  optimise  %s by %s, %d starts of %d evaluations\n",
           spec->path, spec->case_path, spec->output[o->objective].name,
           study_algorithm_name(o->algorithm), o->starts, o->evaluations / o->starts);
    for (int k = 0; k < spec->keys.n; k++) print_key(&spec->keys.key[k]);
    return SHB_OK;
  }
  study_plan_text(&spec->plan, &spec->keys, plan, sizeof plan);
  printf("%s: ok\n  case      %s\n  plan      %s\n  designs   %d\n", spec->path, spec->case_path,
         plan, spec->n_designs);
  if (study_plan_has_blocks(&spec->plan, &spec->keys))
    printf("  samples   %d; the other designs are for the Sobol' indices\n",
           2 * group / (spec->keys.n + 2));
  for (int k = 0; k < spec->keys.n; k++) print_key(&spec->keys.key[k]);
  return SHB_OK;
}

static shb_status print_json(const study_spec *spec) {
  post_buffer text   = {0};
  char       *path   = study_path(spec, ".study.h5");
  shb_status  status = path ? post_summary_of_file(path, &text)
                            : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) fwrite(text.text, 1, text.length, stdout);
  post_buffer_free(&text);
  free(path);
  return status;
}

/* `shroudhb study` starts a worker a core; where mpiexec refuses, one process does everything. */
static void tell_one_core(void) {
  if (getenv("OMPI_COMM_WORLD_SIZE") || !subprocess_mpiexec_refuses_root()) return;
  fputs(
      "shroudhb: warning: mpiexec refuses to run as root, so one core computes; set "
      "OMPI_ALLOW_RUN_AS_ROOT=1\nand OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 to use all\n",
      stderr);
}

/* A design, by the child process. */
static shb_status compute(void *process, const double *value, char **bytes, size_t *size) {
  return design_process_run(process, value, bytes, size);
}

/* The study on the manager. */
static shb_status manage(const study_spec *spec, const command_options *options,
                         const crew_computer *computer) {
  shb_progress progress = shb_progress_start("study", options->quiet, options->verbose);
  design_study study    = {0};
  if (getenv("SHROUDHB_TERMINAL")) progress.terminal = true; /* `shroudhb study` says so */
  tell_one_core();
  shb_status status = study_run(spec, options->force, computer, &progress, &study);
  bool       whole  = status == SHB_OK || status == SHB_NOT_CONVERGED;
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

/* All ranks: the manager reads and checks, the workers need the numbers of keys and outputs. */
static int work(const command_options *options) {
  study_spec spec = {0};
  int        rank, go[4] = {SHB_OK, 0, 0, 0};
  const int  sharing = crew_sharing();
  shb_status status  = SHB_OK;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) status = study_spec_read(options->path, true, stderr, &spec);
  if (rank == 0 && status == SHB_OK) status = check_outputs(&spec);
  if (rank == 0 && status == SHB_OK) status = design_memory_check(&spec, sharing);
  go[0] = (int)status;
  go[1] = spec.keys.n;
  go[2] = spec.n_outputs;
  go[3] = study_derivatives(spec.n_outputs, spec.output);
  MPI_Bcast(go, 4, MPI_INT, 0, MPI_COMM_WORLD);
  design_process      process  = {.study         = options->path,
                                  .n_request     = 2 * go[1],
                                  .n_outputs     = go[2],
                                  .n_derivatives = go[3],
                                  .sharing       = sharing};
  const crew_computer computer = {&process, process.n_request, compute};
  if (go[0] == SHB_OK)
    status = rank == 0 ? manage(&spec, options, &computer) : crew_serve(&computer);
  design_process_stop(&process);
  int code = rank == 0 ? command_finish(status) : SHB_OK;
  study_spec_free(&spec);
  return code;
}

/* --design=I and --check: without MPI. */
static int work_alone(const command_options *options, int design) {
  study_spec spec;
  shb_status status = study_spec_read(options->path, design == 0, stderr, &spec);
  if (status == SHB_OK)
    status = design > 0 ? own_run(&spec, design, options->quiet) : check(&spec, options);
  study_spec_free(&spec);
  return command_finish(status);
}

/* Take --design=I or "--design I" out of the words. Returns the design, 0 without one, -1 if it is
 * wrong. */
static int take_design(int *argc, char **argv) {
  static const char option[] = "--design";
  size_t            length   = strlen(option);
  int               design   = 0;
  for (int i = 1; i < *argc; i++) {
    char why[CASE_WHY];
    if (strncmp(argv[i], option, length) != 0) continue;
    bool        joined = argv[i][length] == '=';
    const char *text   = joined ? argv[i] + length + 1 : i + 1 < *argc ? argv[i + 1] : "";
    if (!case_integer(text, &design, why) || design < 1) return -1;
    int taken = joined ? 1 : 2;
    for (int k = i; k + taken <= *argc; k++) argv[k] = argv[k + taken];
    *argc -= taken;
    i--;
  }
  return design;
}

int main(int argc, char **argv) {
  command_options options;
  int             design = take_design(&argc, argv);
  if (design < 0) {
    fputs("shroudhb: error: --design takes the number of a design, from 1\n", stderr);
    return SHB_ERR_INPUT;
  }
  int code = command_parse(argc, argv, usage, &options);
  if (code >= 0) return code;
  if (design > 0 || options.mode) return work_alone(&options, design);
  if (MPI_Init(&argc, &argv) != MPI_SUCCESS) {
    fputs("shroudhb: error: MPI cannot be started\n", stderr);
    return SHB_ERR_IO;
  }
  shb_interrupt_catch(); /* after MPI_Init, because the launcher sets handlers of its own */
  code = work(&options);
  MPI_Finalize();
  return code;
}
