/* Twenty modes of the z-notch blade, beside CalculiX: processor seconds and peak memory on the same
 * mesh of ten-node tetrahedra, one thread each.
 *
 *   bench_modal CCX 10k 43k 170k   rungs, by nodes; CCX: the program ccx, "" if not installed;
 *                                  at 170k ccx takes ten minutes
 *   bench_modal CCX --quick        2k: fails if the frequencies differ
 *
 * Every figure is that of a process of its own. shroudhb: from assembly to modes; its peak memory
 * includes reading the mesh file. ccx: the whole program. Frequencies are those of ccx's .eig,
 * which has all digits (its .dat has seven). Ours use the rules of CalculiX (its 4 points in the
 * mass matrix). ccx is Debian's, with SPOOLES and ARPACK. */
#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/constants.h"
#include "mesh/io/inp_write.h"
#include "modal/common/session.h"
#include "modal/eigen/eigen.h"
#include "tests/support/read_mesh.h"
#include "tests/support/z_notch.h"

enum { MODES = 20 };

typedef struct {
  const char   *name;
  z_notch_sizes sizes;
  double        faster,
      memory; /* goals: ccx's seconds to ours at least, our memory to ccx's at most; 0: none */
} rung;

static const rung rungs[] = {{"2k", {14, 9, 0}, 0, 0},
                             {"10k", {6.5, 4, 0}, 0, 0},
                             {"43k", {3.34, 2.25, 0}, 8, 1},
                             {"170k", {1.93, 1.35, 0}, 8, 1},
                             {"350k", {1.45, 1, 0}, 0, 0}};

enum { RUNGS = sizeof rungs / sizeof *rungs };

/* What a child did. */
typedef struct {
  double seconds, memory; /* processor s, GB */
  double frequency[MODES];
  int    nodes;
  bool   done;
} figures;

static double seconds_of(const struct rusage *usage) {
  return (double)usage->ru_utime.tv_sec + 1e-6 * (double)usage->ru_utime.tv_usec +
         (double)usage->ru_stime.tv_sec + 1e-6 * (double)usage->ru_stime.tv_usec;
}

static double processor_time(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(&usage);
}

/* ---------------------------------------------------------------- the work, a process each */

static void write_step(const char *path) {
  FILE *deck = fopen(path, "a");
  if (!deck) return;
  fprintf(deck,
          "*BOUNDARY\nroot, 1, 3\n*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
          "*SOLID SECTION, ELSET=body, MATERIAL=STEEL\n*STEP\n*FREQUENCY, STORAGE=YES\n%d\n*NODE "
          "FILE\nU\n*END "
          "STEP\n",
          MODES);
  fclose(deck);
}

static bool make_mesh(const rung *r, figures *out) {
  mesh_fe mesh = {0};
  if (z_notch_write(MESH_TET10, &r->sizes, "blade.msh") != SHB_OK) return false;
  if (read_mesh("blade.msh", &mesh) != SHB_OK) return false;
  if (mesh_inp_write(&mesh, "blade.inp") != SHB_OK) return false;
  write_step("blade.inp");
  out->nodes = mesh.n_nodes;
  mesh_fe_free(&mesh);
  return true;
}

static PetscErrorCode find_modes(const mesh_fe *mesh, figures *out) {
  const fem_material          steel = {.E = 2.1e11, .nu = .3, .rho = 7850};
  fem_system                  system;
  const modal_spare_stiffness spare  = {&system, {mesh, &steel, FEM_CALCULIX}};
  const modal_eigen_settings  wanted = {.modes = MODES, .spare = &spare};
  const double                began  = processor_time();
  modal_eigen                 eigen;

  PetscFunctionBeginUser;
  PetscCall(fem_system_create(PETSC_COMM_SELF, mesh, &steel, FEM_CALCULIX, &system));
  PetscCall(modal_eigen_solve(&system, &wanted, &eigen));
  out->seconds = processor_time() - began;
  for (int i = 0; i < MODES; i++) out->frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  PetscCall(modal_eigen_destroy(&eigen));
  PetscCall(fem_system_destroy(&system));
  PetscFunctionReturn(0);
}

static bool run_own(const rung *r, figures *out) {
  int           count   = 1;
  char         *words[] = {"bench_modal", NULL}, **arguments = words;
  modal_session session;
  mesh_fe       mesh = {0};
  (void)r;
  if (modal_session_start(&count, &arguments, &session) != SHB_OK) return false;
  bool good = read_mesh("blade.msh", &mesh) == SHB_OK && find_modes(&mesh, out) == 0;
  if (!good) fprintf(stderr, "bench_modal: %s\n", shb_message());
  mesh_fe_free(&mesh);
  modal_session_end(&session, good ? SHB_OK : SHB_ERR_IO);
  return good;
}

/* Run in a child of its own, which tells what it found through a pipe. */
static bool run_apart(bool (*work)(const rung *, figures *), const rung *r, figures *out) {
  int           ends[2], state = 1;
  struct rusage usage;
  fflush(stdout);
  if (pipe(ends) != 0) return false;
  pid_t child = fork();
  if (child == 0) {
    bool done = work(r, out);
    if (write(ends[1], out, sizeof *out) != (ssize_t)sizeof *out) done = false;
    _exit(done ? 0 : 1);
  }
  close(ends[1]);
  bool told = read(ends[0], out, sizeof *out) == (ssize_t)sizeof *out;
  close(ends[0]);
  if (child < 0 || wait4(child, &state, 0, &usage) != child) return false;
  out->memory      = 1.024e-6 * (double)usage.ru_maxrss;
  return out->done = told && state == 0;
}

/* blade.eig: four integers, the last of them the number of modes, then their eigenvalues. The deck
 * has no earlier step. */
static int read_frequencies(double frequency[MODES]) {
  int32_t head[4];
  int     found = 0;
  FILE   *file  = fopen("blade.eig", "rb");
  if (file && fread(head, sizeof *head, 4, file) == 4 && head[3] == MODES)
    found = (int)fread(frequency, sizeof *frequency, MODES, file);
  if (file) fclose(file);
  for (int i = 0; i < found; i++) frequency[i] = sqrt(frequency[i]) / SHB_TWO_PI;
  return found;
}

static bool run_calculix(const char *program, figures *out) {
  int           state;
  struct rusage usage;
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    int log = open("blade.log", O_WRONLY | O_CREAT, 0644);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execl(program, program, "blade", (char *)NULL);
    _exit(127);
  }
  if (child < 0 || wait4(child, &state, 0, &usage) != child || state != 0) return false;
  out->seconds     = seconds_of(&usage);
  out->memory      = 1.024e-6 * (double)usage.ru_maxrss;
  return out->done = read_frequencies(out->frequency) == MODES;
}

/* ------------------------------------------------------------------ rows */

static double worst_difference(const figures *a, const figures *b) {
  double worst = 0;
  for (int i = 0; i < MODES; i++) worst = fmax(worst, fabs(a->frequency[i] / b->frequency[i] - 1));
  return worst;
}

static void print_verdict(const rung *r, double faster, double memory) {
  if (r->faster == 0) return;
  printf("%-5s goal: %g times faster in CPU: %s; memory at most %g: %s\n", r->name, r->faster,
         faster >= r->faster ? "met" : "missed", r->memory, memory <= r->memory ? "met" : "missed");
}

/* Both rows of one rung, in the current folder. */
static bool measure(const rung *r, const char *program, double *difference) {
  figures mesh = {0}, own = {0}, other = {0};
  *difference = 0;
  if (!run_apart(make_mesh, r, &mesh) || !run_apart(run_own, r, &own)) return false;
  printf("%-5s %8d  shroudhb %9.2f %8.3f\n", r->name, mesh.nodes, own.seconds, own.memory);
  if (!*program) {
    printf("%-5s %8d  CalculiX skipped: no ccx\n", r->name, mesh.nodes);
    return true;
  }
  if (!run_calculix(program, &other)) return false;
  *difference   = worst_difference(&own, &other);
  double faster = other.seconds / own.seconds, memory = own.memory / other.memory;
  printf("%-5s %8d  CalculiX %9.2f %8.3f %8.1f %8.2f   %.1e\n", r->name, mesh.nodes, other.seconds,
         other.memory, faster, memory, *difference);
  print_verdict(r, faster, memory);
  return true;
}

static const rung *find_rung(const char *name) {
  for (int i = 0; i < RUNGS; i++)
    if (strcmp(name, rungs[i].name) == 0) return &rungs[i];
  return NULL;
}

static void remove_folder(const char *folder) {
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  if (chdir("/") != 0 || system(command) != 0) fprintf(stderr, "bench_modal: %s stays\n", folder);
}

int main(int argc, char **argv) {
  char        folder[] = "/tmp/shb_modal_XXXXXX";
  const bool  quick    = argc == 3 && strcmp(argv[2], "--quick") == 0;
  const char *own[]    = {"2k"};
  if (argc < 3) {
    fprintf(stderr, "usage: bench_modal CCX --quick | RUNG...   (2k 10k 43k 170k 350k)\n");
    return 2;
  }
  const int          n    = quick ? 1 : argc - 2;
  const char *const *name = quick ? own : (const char *const *)argv + 2;
  if (!mkdtemp(folder) || chdir(folder) != 0) return 4;
  printf("%d modes  nodes  program      CPU s       GB   faster   memory   worst frequency\n",
         MODES);
  bool good = true;
  for (int i = 0; good && i < n; i++) {
    const rung *r = find_rung(name[i]);
    double      difference;
    good = r && measure(r, argv[1], &difference) && difference < 1e-8;
  }
  remove_folder(folder);
  return good ? 0 : 1;
}
