#include "cases/options/command_table.h"

#include <limits.h>
#include <string.h>

#include "cases/options/spelling.h"

#define AT(member) offsetof(command_options, member)
#define FLAG(word, member, text) \
  { word, NULL, text, OPTION_FLAG, AT(member), NULL, 0, 0 }
#define MODE(word, text) \
  { word, NULL, text, OPTION_MODE, AT(mode), NULL, 0, 0 }
#define NAMED(word, argument, member, needs, text) \
  { word, argument, text, OPTION_TEXT, AT(member), needs, 0, 0 }
#define COUNT(word, argument, member, low, high, needs, text) \
  { word, argument, text, OPTION_COUNT, AT(member), needs, low, high }

/* Options that many commands have. */
#define QUIET FLAG("--quiet", quiet, "no progress, no summary")
#define VERBOSE FLAG("--verbose", verbose, "time and memory of every step")
#define FORCE FLAG("--force", force, "although it is up to date")
#define JSON FLAG("--json", json, "the result on standard output as JSON: docs/user/summary.md")
#define NO_REPORT \
  FLAG("--no-report", no_report, "no page, no picture; NAME.csv and NAME.summary.json only")
#define INTO                                              \
  NAMED("--into", "FOLDER", into, "the name of a folder", \
        "where the output files go; default: beside the case")
/* --text is for programs that start each other. */
#define OVERRIDES                                                             \
  {"--set",                                                                   \
   "KEY=VALUE",                                                               \
   "instead of what the file says, such as --set contact.mu=0.4; any number", \
   OPTION_SET,                                                                \
   AT(set),                                                                   \
   "KEY=VALUE, such as contact.mu=0.4",                                       \
   0,                                                                         \
   0},                                                                        \
      INTO, NAMED("--text", "COPY", text, "the name of a file", NULL)
#define END \
  { .word = NULL }

static const command_option of_run[]   = {QUIET, VERBOSE, FORCE, JSON, NO_REPORT, OVERRIDES, END};
static const command_option of_stage[] = {QUIET, VERBOSE, FORCE, JSON, OVERRIDES, END};
static const command_option of_check[] = {QUIET, JSON, OVERRIDES, END};

static const command_option of_mesh[] = {
    QUIET, VERBOSE,   FORCE,
    JSON,  OVERRIDES, FLAG("--inp", inp, "write NAME.inp for CalculiX and Abaqus too, in m"),
    END};

static const command_option of_post[] = {QUIET,
                                         VERBOSE,
                                         JSON,
                                         NO_REPORT,
                                         OVERRIDES,
                                         MODE("--summary", NULL),
                                         MODE("--modes", NULL),
                                         MODE("--check", NULL),
                                         MODE("--facts", NULL),
                                         END};

static const command_option of_converge[] = {QUIET,
                                             VERBOSE,
                                             FLAG("--force", force, "compute everything anew"),
                                             JSON,
                                             OVERRIDES,
                                             MODE("--no-mesh", "leave out the mesh ladder"),
                                             MODE("--finer", "add a finer mesh than the case's"),
                                             END};

static const command_option of_study[] = {
    QUIET,
    VERBOSE,
    FLAG("--force", force, "compute all designs anew"),
    JSON,
    OVERRIDES,
    COUNT("--design", "I", design, 1, INT_MAX, "the number of a design, from 1",
          "run design I alone, all stages, with a report of its own"),
    MODE("--check", "check the study and all its designs, run nothing"),
    END};

static const command_option of_eval[] = {
    NAMED("--params", "IN", params, "the name of a file", "the parameters file of the driver"),
    NAMED("--results", "OUT", results, "the name of a file", "the results file that it expects"),
    {"--set", "KEY=NUMBER", "a number of the case gets another value; any number of them",
     OPTION_SET, AT(set), "KEY=NUMBER", 0, 0},
    NAMED("--into", "FOLDER", into, "the name of a folder",
          "where modal files go; default: beside the case"),
    END};

static const command_option of_keys[] = {
    MODE("--markdown", "the page docs/user/case_reference.md"),
    MODE("--schema", "a JSON Schema of a case file; --schema=motion, --schema=study likewise"),
    END};

static const command_option of_inspect[] = {
    FLAG("--verbose", verbose, "unfold everything, case text and settings too"),
    FLAG("--csv", csv, "values with commas and all digits"), JSON, END};

static const command_option of_field[] = {
    QUIET,
    COUNT("--branch", "B", branch, 0, INT_MAX, "a whole number from 0",
          "a curve, as inspect counts them; default: the nonlinear ones"),
    COUNT("--point", "P", point, 0, INT_MAX, "a whole number from 0",
          "a kept point of it; default: the highest peak"),
    {"--peak", "N", "the N-th highest of the kept peaks, from 1", OPTION_RANK, AT(peak),
     "a whole number from 1", 1, INT_MAX},
    FLAG("--ring", ring, "all blades at their phases: NAME.ring.vtkhdf, NAME.ring.glb"),
    FLAG("--face", face, "the contact face at a peak, what friction does there: NAME.face.vtkhdf"),
    COUNT("--mode", "I", rank, 1, INT_MAX, "a whole number from 1",
          "a mode of the modal file, from 1: NAME.field_mode_I.vtkhdf, or of a disc\n"
          "NAME.field_mode_N_I.vtkhdf; the greatest displacement is 1 mm"),
    COUNT("--nodal-diameter", "N", diameter, 0, INT_MAX, "a whole number from 0",
          "of a disc, default 0; with --ring the wave runs around all sectors"),
    COUNT("--steps", "N", steps, 2, 1000, "a number from 2 to 1000",
          "instants of the period, 2 to 1000; default: 24"),
    {"--scale", "S", "of the displacement in the .glb; default: the greatest is 5 % of the blade",
     OPTION_POSITIVE, AT(scale), "a number above 0", 0, 0},
    NAMED("--modal", "FILE", modal, "the name of a file",
          "default: NAME.modal.h5 beside the response"),
    END};

static const command_option of_contact[] = {
    OVERRIDES,
    {"--svg", "OUT.svg", "draw the hysteresis loops, the friction path and the states",
     OPTION_OUTPUT, AT(svg), "the name of a file to write", 0, 0},
    END};

static const char stage_codes[] =
    "Exit codes: 0 done, 2 bad input, 3 not converged everywhere (results kept), 4 input/output,\n"
    "130 interrupted (results so far kept).\n";

static const command_row table[COMMANDS] = {
    [COMMAND_RUN] =
        {"run", "  run CASE.yaml      all stages: mesh, modal, mhb, post\n",
         "[OPTION]... CASE.yaml",
         "All stages of a case in turn: mesh, modal, mhb, post. A stage runs again only "
         "when what it\n"
         "depends on has changed.\n",
         stage_codes, of_run, 1, 1, JSON_SUMMARY, false},
    [COMMAND_MESH] =
        {"mesh", "  mesh CASE.yaml     mesh the blade                    -> NAME.msh\n",
         "[OPTION]... CASE.yaml",
         "Meshes the blade of mesh.blade (tetrahedra or hexahedra) and writes NAME.msh with the\n"
         "groups root, contact_right, contact_left and load; does nothing if that file is up to "
         "date\n"
         "(unless --force). With mesh.file instead: checks that mesh's elements, groups and "
         "contact faces;\n"
         "a solid is meshed, groups by rule and other units are put into NAME.msh.\n",
         NULL, of_mesh, 1, 1, JSON_CHECK, false},
    [COMMAND_MODAL] =
        {"modal", "  modal CASE.yaml    modes and receptances             -> NAME.modal.h5\n",
         "[OPTION]... CASE.yaml [PETSC OPTIONS]\n"
         "mpiexec -n N shroudhb-modal CASE.yaml",
         "Assembles mass and stiffness on the mesh of CASE.yaml, finds the lowest modes, condenses "
         "them to the\n"
         "contact, load and probe points and writes NAME.modal.h5; does nothing if that file is up "
         "to date\n"
         "(unless --force), and keeps its modes if only damping or the amplitude of the load "
         "changed. Needs\n"
         "mesh, material and clamp only: without contact, load and damping the file holds the "
         "modes alone.\n"
         "Meshes first if the mesh is missing or out of date. Options after the case go to PETSc "
         "and SLEPc,\n"
         "such as -eps_view, -eps_block_size 8, -eps_type krylovschur,\n"
         "-st_pc_factor_mat_solver_type mumps, -st_mat_mumps_icntl_14 50.\n",
         NULL, of_stage, 1, 1, JSON_MODES, false},
    [COMMAND_MHB] = {"mhb",
                     "  mhb CASE.yaml      harmonic balance                  -> NAME.response.h5\n",
                     "[OPTION]... CASE.yaml",
                     "Solves the multi-harmonic balance of CASE.yaml on its modal file and writes "
                     "NAME.response.h5;\n"
                     "does nothing if that file is up to date (unless --force).\n",
                     stage_codes, of_stage, 1, 1, JSON_SUMMARY, false},
    [COMMAND_INTEGRATE] =
        {"integrate",
         "  integrate CASE.yaml  points by time integration      -> NAME.integration.h5, drawn by "
         "post\n",
         "[OPTION]... CASE.yaml",
         "Integrates CASE.yaml in time, at the frequencies of its block integrate and every "
         "preload, until\n"
         "the motion repeats itself, and writes NAME.integration.h5, whose points shroudhb post "
         "draws as\n"
         "dots on the curves of NAME.response.h5. Does nothing if that file is up to date (unless "
         "--force).\n",
         stage_codes, of_stage, 1, 1, JSON_SUMMARY, false},
    [COMMAND_POST] =
        {"post",
         "  post CASE.yaml     report, curves                    -> NAME.html, NAME.csv, NAME.svg\n"
         "  post A.yaml B.yaml two runs on one page              -> A.vs.B.html\n",
         "[OPTION]... CASE.yaml\n[OPTION]... CASE.yaml OTHER.yaml\n[OPTION]... NAME.study.h5",
         "Makes NAME.html (report), NAME.csv (every point) and NAME.svg (picture) from "
         "NAME.response.h5;\n"
         "points of NAME.integration.h5 are drawn as dots;\n"
         "NAME.stress.csv has the worst places at every peak if material.fatigue is given;\n"
         "NAME.gauge.csv has the strain at the gauges of the case;\n"
         "the report has the section Speed against error if NAME.converge.h5 belongs to the case.\n"
         "NAME.summary.json has the results for scripts.\n"
         "Of two cases, or two response files: NAME.vs.OTHER.html beside the first, and their "
         "peaks "
         "on\n"
         "standard output.\n"
         "Of a study file: NAME.study.html, NAME.study.csv and NAME.study.svg.\n",
         NULL, of_post, 1, 2, JSON_OWN, false},
    [COMMAND_CONVERGE] =
        {"converge",
         "  converge CASE.yaml error against time, setting by setting; `shroudhb converge "
         "--help`\n",
         "[OPTION]... CASE.yaml",
         "What accuracy costs on CASE.yaml: ladders of harmonics (fixed and auto), contact "
         "accuracy, modes (with\n"
         "and without residual flexibility) and, for a parametric blade, mesh sizes; each rung's "
         "seconds, memory\n"
         "and errors against the finest one; which settings meet converge.tolerance, and the "
         "cheapest. Writes\n"
         "NAME.converge.csv, NAME.converge.svg and NAME.converge.h5, which `shroudhb post` puts "
         "into the report.\n"
         "What was computed stays in the folder NAME.converge and is used again.\n",
         "Exit codes: 0 every rung ran and every ladder has a rung below its finest that meets the "
         "tolerance;\n"
         "3 a ladder has none (whether its finest is fine enough is then not known), a finest "
         "curve has a gap,\n"
         "or a rung failed; 2, 4, 130 as for shroudhb.\n",
         of_converge, 1, 1, JSON_OWN, false},
    [COMMAND_STUDY] =
        {"study",
         "  study STUDY.yaml   many designs of a case on all cores; `shroudhb study --help`\n",
         "[OPTION]... STUDY.yaml\nmpiexec -n N shroudhb-pool study STUDY.yaml",
         "Runs the designs of STUDY.yaml and writes NAME.study.h5 and NAME.study.csv. A process "
         "for\n"
         "every core computes designs. On several machines mpiexec starts N of shroudhb-pool: one\n"
         "manages and the others compute.\n"
         "A study that was stopped goes on where it was. Modal files stay in NAME.study.d.\n",
         "Exit codes: 0 done, 2 bad input, 3 some designs failed or did not converge, 4 "
         "input/output,\n"
         "130 interrupted (results so far kept).\n",
         of_study, 1, 1, JSON_OWN, false},
    [COMMAND_EVAL] =
        {"eval",
         "  eval CASE.yaml --params IN --results OUT  one design for Dakota and other drivers\n",
         "[OPTION]... CASE.yaml --params IN --results OUT",
         "Computes one design of a case for another program's driver. IN and OUT are the "
         "parameters and\n"
         "results files of Dakota, in its standard format or that of aprepro. Variables are named "
         "by keys\n"
         "of the case (contact.n0, or contact__n0), responses by outputs of studies (peak, "
         "frequency,\n"
         "modes__1__frequency). The active set is heeded: 1 value, 2 gradient of the peak.\n"
         "If the design has no result, OUT begins with FAIL.\n",
         "Exit codes: 0 done, 2 bad input, 3 no result, 4 input/output.\n", of_eval, 1, 1,
         JSON_NONE, false},
    [COMMAND_CHECK] = {"check",
                       "  check FILE.yaml    check a case file or a study file, run nothing\n",
                       "[OPTION]... FILE.yaml",
                       "All errors of a case file or a study file at once. Nothing is run, nothing "
                       "is written.\n",
                       NULL, of_check, 1, 1, JSON_OWN, false},
    [COMMAND_KEYS] =
        {"keys",
         "  keys [study]       every key of a case or a study: unit, range, default, meaning; "
         "--markdown\n"
         "                     prints the page docs/user/case_reference.md, --schema a JSON "
         "Schema,\n"
         "                     --schema=motion that of a file for contact, --schema=study of a "
         "study\n",
         "[case | study | motion]\n--markdown | --schema[=FILE]",
         "Every key of a file: unit, range, default, meaning.\n", NULL, of_keys, -1, -1, JSON_NONE,
         false},
    [COMMAND_INSPECT] =
        {"inspect",
         "  inspect FILE.h5    what a modal or response file holds; of two modal files: A.h5 "
         "B.h5;\n"
         "                     FILE.h5 PATH prints values, 'branch_2/motion[peak,0,:,1]'; --csv\n",
         "[--verbose] FILE.h5 [OTHER.h5]\n[--csv | --json] FILE.h5 PATH[SELECTION]",
         "What an HDF5 file holds.\n"
         "Of two modal files: frequencies side by side, and which mode shapes are alike (MAC).\n"
         "With a PATH in the file: its values; 'branch_2/motion[peak,0,:,1]' selects; a branch "
         "gives a\n"
         "table of its points.\n",
         NULL, of_inspect, 1, 2, JSON_OWN, true},
    [COMMAND_FIELD] =
        {"field",
         "  field NAME.response.h5  the moving blade: motion and stress everywhere over a period, "
         "for\n"
         "                     ParaView and viewers of glTF; `shroudhb field --help`\n",
         "[OPTION]... NAME.response.h5\n--mode I [OPTION]... NAME.modal.h5",
         "Writes one period of the motion and stress of the whole blade at a point of the "
         "response:\n"
         "NAME.field.vtkhdf  for ParaView 5.12 and VTK 9.3 or later\n"
         "NAME.field.glb     the surface, moving, coloured by stress, for any viewer of glTF\n"
         "A chosen point is added to the names: NAME.field_B_P. Which points are kept: mhb.save.\n"
         "The whole blade stands in the modal file of shroudhb modal; one from elsewhere may lack "
         "it.\n",
         NULL, of_field, 1, 1, JSON_NONE, false},
    [COMMAND_CONTACT] =
        {"contact",
         "  contact FILE.yaml  contact forces for a prescribed motion; --svg OUT.svg draws the "
         "loops\n",
         "[OPTION]... MOTION.yaml",
         "Prints the force harmonics, transitions and energy for a prescribed relative motion.\n",
         NULL, of_contact, 1, 1, JSON_NONE, false},
    [COMMAND_SAMPLES] =
        {"samples", NULL, "[OPTION]... CASE.yaml\nmpiexec -n N shroudhb-pool samples CASE.yaml",
         "Does what shroudhb mhb does, for a case with rotor.mistuning: {deviation, seed, "
         "samples}. Of N\n"
         "processes one traces the curves and manages, the others compute samples, one at a "
         "time.\n"
         "Alone it computes samples by its threads. The numbers are the same for any N. What was\n"
         "stopped goes on where it was.\n",
         stage_codes, of_stage, 1, 1, JSON_NONE, false},
    [COMMAND_RUNG] =
        {"rung", NULL,
         "CASE.yaml MODAL.h5 STEM HARMONICS TOLERANCE ACCURACY MODES RESIDUALS PATCHES "
         "[REFERENCE|- [POINTS.h5]]",
         "One sweep with other settings than the case has, and its distance from another one, for\n"
         "`shroudhb converge`. Writes STEM.response.h5 and STEM.cost, STEM.REFERENCE.error.\n",
         NULL, of_stage, 9, 11, JSON_NONE, false},
    [COMMAND_DESIGN] = {
        "design", NULL,
        "STUDY.yaml [PROCESSES]",
        "Computes designs for `shroudhb study`, which starts it. What the study has read and "
        "values\n"
        "of the varied keys come from standard input, results go to standard output, in binary.\n"
        "PROCESSES such programs share the memory of this machine, else one.\n",
        NULL, of_check, 1, 2, JSON_NONE, false}};

const command_row *command_row_of(command_id id) {
  return &table[id];
}

command_id command_find(const char *name) {
  int id = 0;
  while (id < COMMANDS && strcmp(table[id].name, name) != 0) id++;
  return (command_id)id;
}

command_id command_called(const char *program) {
  static const char start[] = "shroudhb-";
  const char       *slash = strrchr(program, '/'), *leaf = slash ? slash + 1 : program;
  const bool        named = strncmp(leaf, start, sizeof start - 1) == 0;
  return named ? command_find(leaf + sizeof start - 1) : COMMANDS;
}

const char *command_nearest(const char *word) {
  const char *best  = NULL;
  int         least = 3;
  for (int i = 0; i < COMMANDS; i++) {
    const int distance = case_edit_distance(word, table[i].name);
    if (!table[i].brief || distance >= least) continue;
    least = distance;
    best  = table[i].name;
  }
  return best;
}
