#define _GNU_SOURCE /* sched_getaffinity */

#include "modal/common/team.h"

#include <omp.h>
#include <sched.h>
#include <time.h>

#include "fem/solver/factor.h"
#include "fem/solver/petsc_error.h"

/* CHOLMOD counts at most 2^31 entries of a factor, by nodes. A blade would have them at about 2.5
 * million nodes (extrapolated as nodes^1.38); a compact body has more a node. */
enum { MOST_NODES = 1000000 };

/* Do all ranks share a machine? */
static bool on_one_machine(MPI_Comm all, int n_ranks) {
  MPI_Comm machine;
  int      n_here;
  MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &n_here);
  MPI_Comm_free(&machine);
  return n_here == n_ranks;
}

static PetscErrorCode may_gather(MPI_Comm all, int nodes, bool *yes) {
  int  n_ranks, may;
  bool mumps;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(all, &n_ranks));
  PetscCallMPI(MPI_Bcast(&nodes, 1, MPI_INT, 0, all));
  PetscCall(fem_factor_mumps_asked(&mumps));
  may = n_ranks > 1 && on_one_machine(all, n_ranks) && nodes <= MOST_NODES && !mumps &&
        omp_get_proc_bind() == omp_proc_bind_false;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &may, 1, MPI_INT, MPI_MIN, all));
  *yes = may;
  PetscFunctionReturn(0);
}

/* The first rank may use the processors of all, and as many threads as all have. mpiexec binds each
 * rank to processors of its own; without that all have the same, which are not counted twice. */
static void gather_processors(MPI_Comm all, bool first) {
  const int own     = omp_get_max_threads();
  int       threads = 0;
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  MPI_Allreduce(MPI_IN_PLACE, &set, (int)sizeof set, MPI_BYTE, MPI_BOR, all);
  MPI_Allreduce(&own, &threads, 1, MPI_INT, MPI_SUM, all);
  if (!first) return;
  sched_setaffinity(0, sizeof set, &set); /* threads that are started from now on have it too */
  if (threads > CPU_COUNT(&set)) threads = CPU_COUNT(&set);
  if (threads > own) omp_set_num_threads(threads);
}

shb_status modal_team_gather(MPI_Comm all, int nodes, modal_team *team) {
  int rank;
  *team = (modal_team){.all = all, .comm = all, .works = true};
  FEM_PETSC(may_gather(all, nodes, &team->gathered));
  if (team->gathered) {
    MPI_Comm_rank(all, &rank);
    gather_processors(all, rank == 0);
    team->comm  = MPI_COMM_SELF;
    team->works = rank == 0;
  }
  team->threads = omp_get_max_threads();
  return SHB_OK;
}

/* Looks now and then: MPI's own waiting takes a processor, which the first rank needs. */
static void sleep_until(MPI_Request *request) {
  const long      longest = 5000000; /* ns */
  struct timespec pause   = {0, 10000};
  for (int done = 0; !done;) {
    MPI_Test(request, &done, MPI_STATUS_IGNORE);
    if (done) return;
    nanosleep(&pause, NULL);
    if (2 * pause.tv_nsec <= longest) pause.tv_nsec *= 2;
  }
}

shb_status modal_team_end(const modal_team *team, shb_status status) {
  int         answer = (int)status;
  MPI_Request told;
  if (!team->gathered) return status;
  MPI_Ibcast(&answer, 1, MPI_INT, 0, team->all, &told);
  sleep_until(&told);
  if (!team->works && answer != SHB_OK) SHB_FAIL((shb_status)answer, "the first rank failed");
  return (shb_status)answer;
}
