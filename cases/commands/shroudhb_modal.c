/* shroudhb-modal: computes the modal file from the mesh of a case, on any number of MPI ranks. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/commands/modal_changes.h"
#include "cases/commands/stage.h"
#include "cases/commands/up_to_date.h"
#include "cases/options/help.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/nodal_diameters.h"
#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "modal/common/session.h"
#include "modal/hdf5/h5.h"
#include "modal/hdf5/stamp.h"
#include "modal/model/revision.h"
#include "modal/stage/stage.h"

/* Words of the command line: own ones up to the case file and any --long option, else PETSc's. */
typedef struct {
  int    n_own, n_petsc;
  char **own, **petsc; /* each begins with the program's name and ends with NULL */
} words;

static void split_words(int argc, char **argv, words *out) {
  bool found = false, ended = false;
  *out        = (words){1, 1, shb_alloc_zeroed((size_t)argc + 1, sizeof(char *)),
                        shb_alloc_zeroed((size_t)argc + 1, sizeof(char *))};
  out->own[0] = out->petsc[0] = argv[0];
  for (int i = 1; i < argc; i++) {
    bool is_long = strncmp(argv[i], "--", 2) == 0;
    if (found && !is_long) {
      out->petsc[out->n_petsc++] = argv[i];
      continue;
    }
    out->own[out->n_own++] = argv[i];
    bool takes = !ended && (strcmp(argv[i], "--set") == 0 || strcmp(argv[i], "--into") == 0 ||
                            strcmp(argv[i], "--text") == 0);
    if (takes && i + 1 < argc) {
      out->own[out->n_own++] = argv[++i];
      continue;
    }
    found = found || ended || argv[i][0] != '-';
    ended = ended || strcmp(argv[i], "--") == 0;
  }
}

/* Rank under mpiexec before MPI is initialised; 0 if the launcher does not tell. */
static int launch_rank(void) {
  const char *rank = getenv("OMPI_COMM_WORLD_RANK");
  if (!rank) rank = getenv("PMI_RANK");
  return rank ? atoi(rank) : 0;
}

/* Parses on every rank, but only rank 0 reports errors of the command line and the case file. */
static int parse(const words *line, command_options *options, case_file *file) {
  int saved = -1, null = launch_rank() == 0 ? -1 : open("/dev/null", O_WRONLY);
  if (null >= 0) {
    saved = dup(STDERR_FILENO);
    dup2(null, STDERR_FILENO);
    close(null);
  }
  int code = options_read(command_row_of(COMMAND_MODAL), line->n_own, line->own, options);
  if (code < 0) {
    shb_status status = command_read(options, CASE_MODAL, file);
    if (status != SHB_OK) code = command_finish(status);
  }
  fflush(stderr);
  if (saved >= 0) {
    dup2(saved, STDERR_FILENO);
    close(saved);
  }
  return code;
}

static modal_settings stage_settings(const case_file *file, modal_probe probe[CASE_MAX_PROBES],
                                     modal_region  region[MESH_MAX_VOLUMES],
                                     fem_load      loads[CASE_MAX_LOADS],
                                     modal_contact contacts[MHB_MAX_INTERFACES],
                                     int           diameters[CASE_MOST_DIAMETERS]) {
  for (int q = 0; q < file->n_probes; q++) {
    probe[q].name = file->probe[q].name;
    memcpy(probe[q].at, file->probe[q].at, sizeof probe[q].at);
  }
  for (int i = 0; i < file->n_materials; i++)
    region[i] = (modal_region){file->has_materials ? file->materials[i].group : NULL,
                               file->materials[i].material};
  for (int i = 0; i < file->n_loads; i++) loads[i] = file->loads[i].load;
  for (int i = 0; i < file->n_interfaces; i++) {
    const case_interface *own = &file->interfaces[i];
    contacts[i]               = (modal_contact){own->mhb.name,
                                                own->right,
                                                own->left,
                                                own->mhb.to_ground,
                                  own->points > 0 ? own->points : 0,
                                  own->mhb.has_psi ? &own->mhb.psi : NULL,
                                  own->mhb.has_phi ? &own->mhb.phi : NULL};
  }
  modal_settings out = {
      .n_regions        = file->n_materials,
      .region           = region,
      .axis             = file->axis,
      .blades           = file->blades,
      .speed            = file->speed[file->n_speeds - 1],
      .n_speeds         = file->n_speeds,
      .speeds           = file->speed,
      .coriolis         = file->coriolis,
      .pressure         = file->pressure,
      .full_integration = file->full_integration,
      .modes            = file->modes,
      .tolerance        = file->tolerance,
      .band             = file->band,
      .damping          = file->damping,
      .check            = file->check,
      .spares_stiffness = true,
      .n_probes         = file->n_probes,
      .probe            = probe,
      .may_be_free      = !file->has_contact,
      .n_loads          = file->has_load ? file->n_loads : 0,
      .loads            = loads,
      .n_contacts       = file->n_interfaces,
      .contact          = contacts,
      .n_groups         = file->source.rules.n_more,
      .n_diameters      = case_nodal_diameters(file, diameters),
      .diameter         = diameters,
  };
  for (int i = 0; i < out.n_groups; i++) out.group[i] = file->source.rules.more[i].name;
  return out;
}

/* What the stage has to do. */
typedef enum { NOTHING, REVISE, SOLVE } task;

/* A modal file of the case but for damping and load is revised. */
static task task_of(const case_file *file, bool force, const char *output, const char *settings,
                    modal_revision *revision) {
  if (force || !up_to_date_diameters(file, output)) return SOLVE;
  if (up_to_date_with(output, settings)) return NOTHING;
  char      *earlier = h5_stamp_check(output) == H5_INTACT ? up_to_date_written(output) : NULL;
  const bool revised = earlier && modal_changes_find(earlier, settings, revision);
  free(earlier);
  revision->damping = file->damping;
  return revised ? REVISE : SOLVE;
}

/* Rank 0 decides. *settings is malloc'ed there and NULL elsewhere. */
static shb_status decide(const case_file *file, bool force, const char *mesh, const char *output,
                         char **settings, modal_revision *revision, task *what) {
  int rank, answer[2] = {SHB_OK, NOTHING};
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  *settings = NULL;
  if (rank == 0) {
    answer[0] = up_to_date_settings(file, CASE_MODAL, mesh, settings);
    if (answer[0] == SHB_OK) answer[1] = (int)task_of(file, force, output, *settings, revision);
    if (answer[0] == SHB_OK && answer[1] != NOTHING) answer[0] = (int)shb_publish_check(output);
  }
  MPI_Bcast(answer, 2, MPI_INT, 0, PETSC_COMM_WORLD);
  *what = (task)answer[1];
  return (shb_status)answer[0];
}

static shb_status revise(const case_file *file, char *settings, const char *output, int rank,
                         const modal_revision *revision, shb_progress *progress) {
  shb_provenance provenance = command_provenance(file, settings, "shroudhb-modal");
  shb_status     status = rank == 0 ? modal_revise(output, output, revision, &provenance) : SHB_OK;
  if (status == SHB_OK)
    shb_progress_note(progress, "%s keeps its modes; damping or load changed", output);
  return modal_agree(PETSC_COMM_WORLD, status);
}

static shb_status solve(const case_file *file, char *settings, const char *mesh, const char *output,
                        shb_progress *progress) {
  modal_probe    probe[CASE_MAX_PROBES];
  modal_region   region[MESH_MAX_VOLUMES];
  fem_load       loads[CASE_MAX_LOADS];
  modal_contact  contacts[MHB_MAX_INTERFACES];
  int            diameters[CASE_MOST_DIAMETERS];
  modal_settings stage      = stage_settings(file, probe, region, loads, contacts, diameters);
  shb_provenance provenance = command_provenance(file, settings, "shroudhb-modal");
  shb_status status = modal_stage(PETSC_COMM_WORLD, mesh, output, &stage, &provenance, progress);
  shb_progress_note(progress, "%.2f s in all", shb_seconds() - progress->started);
  return status;
}

static shb_status run(const case_file *file, const command_options *options, int rank) {
  shb_progress progress =
      shb_progress_start("modal", options->quiet || rank != 0, options->verbose);
  char          *mesh = case_mesh_path(file), *output = case_output(file, ".modal.h5");
  char          *settings = NULL;
  modal_revision revision;
  task           what   = NOTHING;
  shb_status     status = decide(file, options->force, mesh, output, &settings, &revision, &what);
  if (status == SHB_OK && what == NOTHING) shb_progress_note(&progress, "%s is up to date", output);
  if (status == SHB_OK && what == REVISE)
    status = revise(file, settings, output, rank, &revision, &progress);
  if (status == SHB_OK && what == SOLVE) status = solve(file, settings, mesh, output, &progress);
  free(mesh);
  free(output);
  free(settings);
  return status;
}

/* Warns of locking: displacement elements are too stiff in nearly incompressible materials. */
static void warn_locking(const char *key, double nu) {
  if (nu > .49)
    fprintf(stderr,
            "shroudhb: warning: %s: %g is nearly incompressible; elements may lock above .49 "
            "(frequencies too high): compare with a finer mesh\n",
            key, nu);
}

static void warn(const case_file *file) {
  for (int i = 0; i < file->n_materials; i++) {
    char key[64] = "material.nu";
    if (file->has_materials) snprintf(key, sizeof key, "materials[%d].nu", i);
    warn_locking(key, file->materials[i].constants.nu[0]);
  }
}

/* Makes a mesh of the case that is missing or out of date, on rank 0 before MPI starts. The others
 * wait in MPI_Init. Returns the exit code. */
static int make_mesh(const case_file *file, const command_options *options) {
  if (launch_rank() != 0 || (file->mesh_file && !case_mesh_is_made(file))) return SHB_OK;
  command_options plain  = *options;
  shb_child_end   result = {.code = SHB_OK};
  char           *mesh = case_mesh_path(file), *settings = NULL;
  shb_status      status = up_to_date_mesh_settings(file, &settings);
  plain.force            = false; /* the modes are made again, not what they come from */
  if (status == SHB_OK && !up_to_date_mesh(mesh, settings))
    status = stage_run(COMMAND_MESH, &plain, &result);
  free(mesh);
  free(settings);
  return status == SHB_OK ? result.code : command_finish(status);
}

static int work(words *line, const case_file *file, const command_options *options) {
  modal_session session;
  if (file->modal_file) {
    fprintf(stderr, "shroudhb: modal.file is given: nothing to compute\n");
    return SHB_OK;
  }
  int meshed = make_mesh(file, options);
  if (meshed != SHB_OK) return meshed;
  shb_status status = modal_session_start(&line->n_petsc, &line->petsc, &session);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch(); /* after MPI_Init, because the launcher sets handlers of its own */
  shb_interrupt_grace(2);
  if (session.rank == 0 && !options->quiet) warn(file);
  status   = run(file, options, session.rank);
  int code = session.rank == 0 ? command_finish(status) : (int)status;
  modal_session_end(&session, status);
  return code;
}

int main(int argc, char **argv) {
  words           line;
  command_options options;
  case_file       file;
  int             code = help_answer(command_row_of(COMMAND_MODAL), argc, argv);
  if (code >= 0) return code;
  split_words(argc, argv, &line);
  code = parse(&line, &options, &file);
  if (code < 0) {
    code = work(&line, &file, &options);
    case_free(&file);
  }
  free(line.own);
  free(line.petsc);
  return code;
}
