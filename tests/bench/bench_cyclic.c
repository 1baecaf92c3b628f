/* Six modes of a sector with a disc at its nodal diameters, beside CalculiX's cyclic symmetry.
 * Processor seconds and peak memory are of the same mesh of ten-node tetrahedra, one thread each.
 *
 *   bench_cyclic CCX 8k 37k    rungs, by nodes; CCX: the program ccx, "" if not installed
 *   bench_cyclic CCX 24        a disc of 24 blades, about 8k nodes, at all its 13 nodal diameters
 *   bench_cyclic CCX --quick   3k: fails if the frequencies differ
 *
 * Every figure is that of a process of its own. shroudhb: from assembly to modes. ccx: the whole
 * program; its eigenvalues come twice each and are compared at the first nodal diameter of a rung.
 * Ours use the rules of CalculiX. ccx is Debian's, with SPOOLES and ARPACK. */
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

#include "fem/body/sector.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/io/inp_write.h"
#include "modal/common/session.h"
#include "modal/cyclic/wave_modes.h"
#include "tests/support/read_mesh.h"
#include "tests/support/z_notch.h"

enum { MODES = 6 };

static const fem_material steel = {.E = 2.1e11, .nu = .3, .rho = 7850};

typedef struct {
  const char   *name;
  z_notch_sizes sizes;
  int           blades;
  bool          each;           /* a process for each nodal diameter, so that all are compared */
  int           first, last;    /* nodal diameters */
  double        faster, memory; /* goals: ccx's seconds to ours at least, our memory to ccx's */
} rung;

static const rung rungs[] = {{"3k", {14, 0, 0}, 40, false, 5, 5, 0, 0},
                             {"8k", {7, 0, 0}, 40, false, 4, 6, 8, 1},
                             {"37k", {3.9, 0, 0}, 40, false, 5, 5, 8, 1},
                             {"24", {8, 0, 0}, 24, true, 0, 12, 0, 0}};

enum { RUNGS = sizeof rungs / sizeof *rungs };

typedef struct {
  double seconds, memory; /* processor s, GB */
  double frequency[MODES];
  int    nodes;
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

/* The clamp without nodes of cyclic_left, which CalculiX ties to the other side. */
static void write_clamp(const mesh_fe *mesh, FILE *deck) {
  const int width = mesh_topology_of(mesh->kind)->face_nodes;
  char     *done  = calloc((size_t)mesh->n_nodes, 1);
  for (int i = 0; done && i < width * mesh->set[MESH_CYCLIC_LEFT].n; i++)
    done[mesh->set[MESH_CYCLIC_LEFT].nodes[i]] = 1;
  fprintf(deck, "*BOUNDARY\n");
  for (int i = 0; done && i < width * mesh->set[MESH_ROOT].n; i++) {
    const int node = mesh->set[MESH_ROOT].nodes[i];
    if (!done[node]) fprintf(deck, "%ld, 1, 3\n", mesh->node_tag[node]);
    done[node] = 1;
  }
  free(done);
}

static bool write_step(const rung *r, const mesh_fe *mesh) {
  FILE *deck = fopen("sector.inp", "a");
  if (!deck) return false;
  write_clamp(mesh, deck);
  fprintf(deck,
          "*MATERIAL, NAME=STEEL\n*ELASTIC\n%.13g, %.13g\n*DENSITY\n%.13g\n"
          "*SOLID SECTION, ELSET=body, MATERIAL=STEEL\n"
          "*SURFACE, NAME=SLAVE, TYPE=NODE\ncyclic_left,\n"
          "*SURFACE, NAME=MASTER, TYPE=NODE\ncyclic_right,\n"
          "*TIE, CYCLIC SYMMETRY, NAME=SIDES\nSLAVE, MASTER\n"
          "*CYCLIC SYMMETRY MODEL, N=%d, NGRAPH=1, TIE=SIDES\n0, 0, 0, 1, 0, 0\n"
          "*STEP\n*FREQUENCY, STORAGE=YES\n%d\n"
          "*SELECT CYCLIC SYMMETRY MODES, NMIN=%d, NMAX=%d\n*END STEP\n",
          steel.E, steel.nu, steel.rho, r->blades, 2 * MODES, r->first, r->last);
  return fclose(deck) == 0;
}

static bool make_mesh(const rung *r, figures *out) {
  mesh_fe mesh = {0};
  if (z_notch_disc_write(r->blades, &r->sizes, "sector.msh") != SHB_OK) return false;
  if (read_mesh("sector.msh", &mesh) != SHB_OK) return false;
  bool good  = mesh_inp_write(&mesh, "sector.inp") == SHB_OK && write_step(r, &mesh);
  out->nodes = mesh.n_nodes;
  mesh_fe_free(&mesh);
  return good;
}

static shb_status find_waves(const rung *r, const fem_sector *sector, const fem_body *body,
                             const fem_hermitian_order *order, figures *out) {
  const wave_settings wanted = {.modes = MODES};
  for (int n = r->first; n <= r->last; n++) {
    wave_operator op;
    wave_modes    modes;
    SHB_TRY(wave_operator_create(sector, order, n, r->blades, &op));
    SHB_TRY(wave_modes_solve(&op, &wanted, body, NULL, &modes));
    for (int i = 0; n == r->first && i < MODES; i++)
      out->frequency[i] = sqrt(modes.lambda[i]) / SHB_TWO_PI;
    wave_modes_free(&modes);
    wave_operator_free(&op);
  }
  return SHB_OK;
}

static shb_status find_modes(const rung *r, mesh_fe *mesh, figures *out) {
  fem_element         *element = malloc(sizeof *element);
  const fem_body       body    = {mesh, &steel, element, {MESH_AXIS_X, 0}, 0};
  const double         began   = processor_time();
  mesh_cyclic_sides    sides;
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
  SHB_CHECK(element, SHB_ERR_IO, "out of memory");
  FEM_PETSC(fem_element_create(mesh->kind, FEM_CALCULIX, element));
  SHB_TRY(mesh_cyclic_pair(mesh, MESH_AXIS_X, r->blades, &sides));
  FEM_PETSC(fem_system_create(PETSC_COMM_SELF, mesh, &steel, FEM_CALCULIX, &system));
  FEM_PETSC(fem_sector_create(&body, NULL, &system, &sector));
  FEM_PETSC(fem_system_destroy(&system));
  SHB_TRY(fem_sector_analyse(&sector, &order));
  SHB_TRY(find_waves(r, &sector, &body, order, out));
  out->seconds = processor_time() - began;
  fem_hermitian_order_free(order);
  fem_sector_free(&sector);
  free(element);
  return SHB_OK;
}

static bool run_own(const rung *r, figures *out) {
  int           count   = 1;
  char         *words[] = {"bench_cyclic", NULL}, **arguments = words;
  modal_session session;
  if (modal_session_start(&count, &arguments, &session) != SHB_OK) return false;
  mesh_fe mesh = {0};
  bool    good = read_mesh("sector.msh", &mesh) == SHB_OK && find_modes(r, &mesh, out) == SHB_OK;
  if (!good) fprintf(stderr, "bench_cyclic: %s\n", shb_message());
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
  out->memory = 1.024e-6 * (double)usage.ru_maxrss;
  return told && state == 0;
}

/* sector.eig: five integers, the last of them the number of eigenvalues of the first nodal
 * diameter, then these. */
static bool read_frequencies(double frequency[MODES]) {
  int32_t head[5];
  double  value[2 * MODES];
  FILE   *file = fopen("sector.eig", "rb");
  bool    good = file && fread(head, sizeof *head, 5, file) == 5 && head[4] == 2 * MODES &&
              fread(value, sizeof *value, 2 * MODES, file) == 2 * MODES;
  if (file) fclose(file);
  for (int i = 0; good && i < MODES; i++) frequency[i] = sqrt(value[2 * i]) / SHB_TWO_PI;
  return good;
}

static bool run_calculix(const char *program, figures *out) {
  int           state;
  struct rusage usage;
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    int log = open("sector.log", O_WRONLY | O_CREAT, 0644);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execl(program, program, "sector", (char *)NULL);
    _exit(127);
  }
  if (child < 0 || wait4(child, &state, 0, &usage) != child || state != 0) return false;
  out->seconds = seconds_of(&usage);
  out->memory  = 1.024e-6 * (double)usage.ru_maxrss;
  return read_frequencies(out->frequency);
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
  printf("%-5s %8d %2d to %2d  shroudhb %9.2f %8.3f\n", r->name, mesh.nodes, r->first, r->last,
         own.seconds, own.memory);
  if (!*program) {
    printf("%-5s %8d %2d to %2d  CalculiX skipped: no ccx\n", r->name, mesh.nodes, r->first,
           r->last);
    return true;
  }
  if (!run_calculix(program, &other)) return false;
  *difference         = worst_difference(&own, &other);
  const double faster = other.seconds / own.seconds, memory = own.memory / other.memory;
  printf("%-5s %8d %2d to %2d  CalculiX %9.2f %8.3f %8.1f %8.2f   %.1e\n", r->name, mesh.nodes,
         r->first, r->last, other.seconds, other.memory, faster, memory, *difference);
  print_verdict(r, faster, memory);
  return true;
}

/* All nodal diameters of a rung; the largest difference. */
static bool measure_all(const rung *r, const char *program, double *difference) {
  bool good = true;
  if (!r->each) return measure(r, program, difference);
  *difference = 0;
  for (int n = r->first; good && n <= r->last; n++) {
    rung   one = *r;
    double own;
    one.first = one.last = n;
    good                 = measure(&one, program, &own);
    *difference          = fmax(*difference, own);
  }
  if (good) printf("%-5s worst of all nodal diameters: %.1e\n", r->name, *difference);
  return good;
}

static const rung *find_rung(const char *name) {
  for (int i = 0; i < RUNGS; i++)
    if (strcmp(name, rungs[i].name) == 0) return &rungs[i];
  return NULL;
}

static void remove_folder(const char *folder) {
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  if (chdir("/") != 0 || system(command) != 0) fprintf(stderr, "bench_cyclic: %s stays\n", folder);
}

int main(int argc, char **argv) {
  char        folder[] = "/tmp/shb_cyclic_XXXXXX";
  const bool  quick    = argc == 3 && strcmp(argv[2], "--quick") == 0;
  const char *own[]    = {"3k"};
  if (argc < 3) {
    fprintf(stderr, "usage: bench_cyclic CCX --quick | RUNG...   (3k 8k 37k 24)\n");
    return 2;
  }
  const int          n    = quick ? 1 : argc - 2;
  const char *const *name = quick ? own : (const char *const *)argv + 2;
  if (!mkdtemp(folder) || chdir(folder) != 0) return 4;
  printf(
      "%d modes  nodes diameters program     CPU s       GB   faster   memory   worst frequency\n",
      MODES);
  bool good = true;
  for (int i = 0; good && i < n; i++) {
    const rung *r = find_rung(name[i]);
    double      difference;
    good = r && measure_all(r, argv[1], &difference) && difference < 1e-8;
  }
  remove_folder(folder);
  return good ? 0 : 1;
}
