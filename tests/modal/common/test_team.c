/* Ranks of one machine as threads of the first. Run under mpiexec -n 1, 2, 3. */
#define _GNU_SOURCE /* sched_getaffinity */
#include <omp.h>
#include <petscsys.h>
#include <sched.h>
#include <string.h>
#include <time.h>

#include "modal/common/session.h"
#include "modal/common/team.h"
#include "tests/support/check.h"

enum { NODES = 41, MANY_NODES = 1000001 };

static int rank, n_ranks;

static double processor_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Bind this process to one of the processors: neighbouring ranks to different ones.
 *   returns how many processors all ranks have then */
static int bind_apart(const cpu_set_t *all) {
  const int n = CPU_COUNT(all), used = n_ranks < n ? n_ranks : n;
  cpu_set_t own;
  CPU_ZERO(&own);
  for (int cpu = 0, k = 0; cpu < CPU_SETSIZE; cpu++)
    if (CPU_ISSET(cpu, all) && k++ == rank % n) CPU_SET(cpu, &own);
  assert_int_equal(sched_setaffinity(0, sizeof own, &own), 0);
  return used;
}

static void only_the_first_rank_works_on_the_processors_of_all(void **state) {
  (void)state;
  cpu_set_t  before, all, now;
  modal_team team;
  int        started = 0;
  assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
  MPI_Allreduce(&before, &all, (int)sizeof all, MPI_BYTE, MPI_BOR, PETSC_COMM_WORLD);
  omp_set_num_threads(1);
  const int processors = bind_apart(&all);
  assert_int_equal(modal_team_gather(PETSC_COMM_WORLD, rank == 0 ? NODES : 0, &team), SHB_OK);
  assert_true(team.gathered == (n_ranks > 1));
  assert_true(team.works == (rank == 0));
  if (team.works) {
    int of_team;
    MPI_Comm_size(team.comm, &of_team);
    assert_int_equal(of_team, 1);
#pragma omp parallel reduction(+ : started)
    {
      started = 1;
      cpu_set_t of_thread;
      sched_getaffinity(0, sizeof of_thread, &of_thread);
      if (CPU_COUNT(&of_thread) != processors) started = MANY_NODES;
    }
    assert_int_equal(started, processors);
    assert_int_equal(team.threads, processors);
  }
  assert_int_equal(modal_team_end(&team, SHB_OK), SHB_OK);
  assert_int_equal(sched_getaffinity(0, sizeof now, &now), 0);
  assert_int_equal(CPU_COUNT(&now), rank == 0 ? processors : 1);
  sched_setaffinity(0, sizeof before, &before);
  omp_set_num_threads(1);
}

static void the_others_sleep_until_the_first_ends(void **state) {
  (void)state;
  const double work = 0.5;
  modal_team   team;
  assert_int_equal(modal_team_gather(PETSC_COMM_WORLD, NODES, &team), SHB_OK);
  const double cpu = processor_seconds();
  while (team.works && processor_seconds() < cpu + work)
    ;
  const shb_status own = team.works ? SHB_NOT_CONVERGED : SHB_OK;
  assert_int_equal(modal_team_end(&team, own), SHB_NOT_CONVERGED);
  if (!team.works) assert_below(processor_seconds() - cpu, 0.1 * work);
}

static void large_meshes_and_mumps_stay_distributed(void **state) {
  (void)state;
  modal_team team;
  assert_int_equal(modal_team_gather(PETSC_COMM_WORLD, rank == 0 ? MANY_NODES : 0, &team), SHB_OK);
  assert_true(team.works && !team.gathered && team.comm == PETSC_COMM_WORLD);
  assert_int_equal(modal_team_end(&team, SHB_INTERRUPTED), SHB_INTERRUPTED);
  assert_int_equal(PetscOptionsSetValue(NULL, "-st_pc_factor_mat_solver_type", "mumps"), 0);
  assert_int_equal(modal_team_gather(PETSC_COMM_WORLD, NODES, &team), SHB_OK);
  assert_true(team.works && !team.gathered && team.comm == PETSC_COMM_WORLD);
  assert_int_equal(modal_team_end(&team, SHB_OK), SHB_OK);
  assert_int_equal(PetscOptionsClearValue(NULL, "-st_pc_factor_mat_solver_type"), 0);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(only_the_first_rank_works_on_the_processors_of_all),
      cmocka_unit_test(the_others_sleep_until_the_first_ends),
      cmocka_unit_test(large_meshes_and_mumps_stay_distributed)};
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  rank         = session.rank;
  n_ranks      = session.n_ranks;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  MPI_Allreduce(MPI_IN_PLACE, &failures, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  modal_session_end(&session, SHB_OK);
  return failures;
}
