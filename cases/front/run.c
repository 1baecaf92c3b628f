#include "cases/front/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/stage.h"
#include "cases/front/claim.h"
#include "cases/parse/damping.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/publish.h"

enum { MESH, MODAL, MHB, POST, N_STAGES };

static const command_id command[N_STAGES] = {COMMAND_MESH, COMMAND_MODAL, COMMAND_MHB,
                                             COMMAND_POST};

/* A case of modes alone ends with them. */
static int last_stage(const case_file *file) {
  return file->only_modes ? MODAL : POST;
}

/* --verbose: prints the time of each stage. */
static void print_times(const shb_child_end result[N_STAGES]) {
  double seconds = 0, cpu = 0, peak = 0;
  fprintf(stderr, "%-8s %10s %10s %10s\n", "stage", "seconds", "cpu s", "peak MB");
  for (int i = 0; i < N_STAGES; i++) {
    if (result[i].seconds == 0) continue;
    fprintf(stderr, "%-8s %10.2f %10.2f %10.0f\n", command_row_of(command[i])->name,
            result[i].seconds, result[i].cpu, result[i].peak / 1e6);
    seconds += result[i].seconds;
    cpu += result[i].cpu;
    peak = fmax(peak, result[i].peak);
  }
  fprintf(stderr, "%-8s %10.2f %10.2f %10.0f\n", "all", seconds, cpu, peak / 1e6);
}

static void print_result(const case_file *file, const char *what, const char *suffix) {
  char *path = case_output(file, suffix);
  if (access(path, R_OK) == 0) printf("%-9s %s\n", what, path);
  free(path);
}

static void print_results(const case_file *file, bool no_report, int code) {
  if (code == SHB_NOT_CONVERGED) puts("not converged everywhere: the report says where and why");
  const bool curves = !file->only_modes;
  if (curves && !no_report) print_result(file, "report", ".html");
  if (curves) print_result(file, "curves", ".csv");
  if (curves) print_result(file, "summary", ".summary.json");
  if (!file->modal_file) print_result(file, "modes", ".modal.h5");
  if (curves) print_result(file, "response", ".response.h5");
  fflush(stdout);
}

/* A response that has not converged everywhere is still reported. Modes that have not converged
 * stop the run. */
static bool goes_on(int stage, int code) {
  return code == SHB_OK || (code == SHB_NOT_CONVERGED && stage == MHB);
}

/* What killed runs left, of stages that may have nothing to do now. */
static void clear_temporaries(const case_file *file) {
  char *stem = case_output(file, "");
  if (stem) shb_publish_clear(stem);
  free(stem);
}

/* The results of post, which comes after hours. Each stage looks at its own. */
static shb_status check_outputs(const case_file *file, bool no_report) {
  static const char *const suffix[] = {".csv", ".summary.json", ".html", ".svg"};
  return case_output_check(file, no_report ? 2 : 4, suffix);
}

/* Runs the stages in turn.
 *   *code  out  exit code of the stage that ended the run; else 3 if the response has not converged
 *               everywhere; else 0 */
static shb_status run_stages(const case_file *file, const command_options *options, int *code,
                             shb_child_end result[N_STAGES]) {
  *code           = SHB_OK;
  const int first = file->modal_file ? MHB : 0, last = last_stage(file);
  for (int i = first; i <= last; i++) {
    SHB_TRY(stage_run(command[i], options, &result[i]));
    if (result[i].code == SHB_OK) continue;
    *code = result[i].code;
    if (!goes_on(i, *code)) return SHB_OK;
  }
  return SHB_OK;
}

shb_status run_case(const command_options *options) {
  case_file file;
  SHB_TRY(command_read(options, RUN_ALL | CASE_OR_MODES, &file));
  int           claim, code = SHB_OK;
  shb_child_end result[N_STAGES] = {{0}};
  shb_status    status           = claim_results(&file, &claim);
  if (status == SHB_OK) clear_temporaries(&file);
  if (status == SHB_OK && !file.only_modes) status = check_outputs(&file, options->no_report);
  if (status == SHB_OK) status = run_stages(&file, options, &code, result);
  if (options->verbose && !options->quiet) print_times(result);
  bool done = status == SHB_OK && result[last_stage(&file)].seconds > 0 &&
              (code == SHB_OK || code == SHB_NOT_CONVERGED);
  if (done && !options->quiet) print_results(&file, options->no_report, code);
  case_free(&file);
  if (claim >= 0) close(claim);
  if (status != SHB_OK) return status;
  return code == SHB_OK ? SHB_OK : shb_fail((shb_status)code, __FILE__, __LINE__, "%s", "");
}

static void describe_source(const case_file *file, FILE *out) {
  const mesh_blade *blade = &file->blade;
  if (file->modal_file) {
    fprintf(out, "  modes     from %s\n", file->modal_file);
    return;
  }
  if (file->mesh_file) {
    fprintf(out, "  mesh      from %s\n", file->mesh_file);
  } else {
    fprintf(out, "  mesh      parametric blade, %d sections, element size %g mm", blade->n_sections,
            1e3 * blade->size);
    if (blade->shroud_size > 0) fprintf(out, ", %g mm in the shroud", 1e3 * blade->shroud_size);
    fputc('\n', out);
  }
  if (file->modes > 0)
    fprintf(out, "  modes     %d, damping ratio ", file->modes);
  else
    fprintf(out, "  modes     as a tolerance of %g up to %g Hz needs, damping ratio ",
            file->tolerance, file->band);
  case_damping_print(out, &file->damping);
  fputc('\n', out);
}

/* The physical input in engineers' units, so that a number in the wrong unit is seen. */
static void describe_body(const case_file *file, FILE *out) {
  if (file->modal_file) return;
  for (int i = 0; i < file->n_materials; i++) {
    const fem_material *m = &file->materials[i].material;
    fprintf(out, "  material  E %.4g GPa, ", m->E / 1e9);
    if (!m->anisotropic) fprintf(out, "nu %.4g, ", m->nu);
    fprintf(out, "%.5g kg/m3", m->rho);
    fprintf(out, file->has_materials ? ", of %s\n" : "\n", file->materials[i].group);
  }
  const double rpm = 30 / M_PI, *speed = file->speed;
  if (file->n_speeds == 1) fprintf(out, "  rotor     %.5g rpm\n", speed[0] * rpm);
  if (file->n_speeds > 1)
    fprintf(out, "  rotor     %d speeds, %.5g to %.5g rpm\n", file->n_speeds, speed[0] * rpm,
            speed[file->n_speeds - 1] * rpm);
}

static void describe_angle(const char *name, bool given, double angle, FILE *out) {
  if (given) fprintf(out, ", %s %.4g deg", name, angle * 180 / M_PI);
}

static void describe_preloads(int n, const double *n0, FILE *out) {
  double low = n0[0], high = n0[0];
  for (int i = 1; i < n; i++) {
    low  = fmin(low, n0[i]);
    high = fmax(high, n0[i]);
  }
  if (n == 1) {
    fprintf(out, "  preload   %g N\n", low);
  } else {
    fprintf(out, "  preloads  %d, from %g to %g N\n", n, low, high);
  }
}

static void describe_interface(const mhb_interface *own, FILE *out) {
  if (own->name[0]) fprintf(out, "  %s", own->name);
  describe_angle("psi", own->has_psi, own->psi, out);
  describe_angle("phi", own->has_phi, own->phi, out);
  fprintf(out, ", mu %g\n", own->mu);
  fprintf(out, "  stiffness ku %.4g kN/m, kv %.4g kN/m\n", own->ku[0] / 1e3, own->kv / 1e3);
  describe_preloads(own->n_preloads, own->n0, out);
}

void run_describe(const case_file *file, FILE *out) {
  const mhb_settings *mhb = &file->mhb;
  fprintf(out, "%s: ok\n", file->path);
  describe_source(file, out);
  describe_body(file, out);
  if (file->only_modes) {
    fputs("  modes alone, by `shroudhb modal`: no contact, no mhb\n", out);
    return;
  }
  if (mhb->to_ground) {
    fputs("  contact   to ground", out);
  } else {
    fprintf(out, "  contact   to the neighbour, %d blades, engine order %d%s", mhb->blades,
            mhb->engine_order, mhb->turns_right ? ", rotor turns right" : "");
  }
  if (file->has_interfaces)
    fprintf(out, ", %d interface%s\n", mhb->n_interfaces, mhb->n_interfaces > 1 ? "s" : "");
  for (int i = 0; i < mhb->n_interfaces; i++) describe_interface(&mhb->interface[i], out);
  fprintf(out, "  sweep     %g to %g Hz, ", mhb->frequency[0], mhb->frequency[1]);
  if (file->run_up)
    fprintf(out, "a run-up of %g to %g rpm, ", 60 * mhb->frequency[0] / mhb->engine_order,
            60 * mhb->frequency[1] / mhb->engine_order);
  if (mhb->harmonics == 0) {
    fprintf(out, "harmonics as a tolerance of %g needs\n", mhb->motion_tolerance);
  } else {
    fprintf(out, "%d harmonic%s\n", mhb->harmonics, mhb->harmonics == 1 ? "" : "s");
  }
  char *path = case_output(file, ".html");
  fprintf(out, "  report    %s\n", path);
  free(path);
}
