/* The front command: checks the case, runs the stages as programs of their own. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/commands/subprocess.h"
#include "cases/designs/study_schema.h"
#include "cases/designs/study_table.h"
#include "cases/front/json_command.h"
#include "cases/front/run.h"
#include "cases/parse/key_listing.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/key_schema.h"
#include "cases/schema/motion.h"

static const char usage[] =
    "usage: shroudhb COMMAND [OPTION]... [FILE]\n"
    "\n"
    "Forced response of shrouded blades whose shrouds rub, stick and separate.\n"
    "\n"
    "  run CASE.yaml      all stages: mesh, modal, mhb, post\n"
    "  mesh CASE.yaml     mesh the blade                    -> NAME.msh\n"
    "  modal CASE.yaml    modes and receptances             -> NAME.modal.h5\n"
    "  mhb CASE.yaml      harmonic balance                  -> NAME.response.h5\n"
    "  integrate CASE.yaml  points by time integration      -> NAME.integration.h5, drawn by post\n"
    "  post CASE.yaml     report, curves                    -> NAME.html, NAME.csv, NAME.svg\n"
    "  post A.yaml B.yaml two runs on one page              -> A.vs.B.html\n"
    "  converge CASE.yaml error against time, setting by setting; `shroudhb converge --help`\n"
    "  study STUDY.yaml   many designs of a case on all cores; `shroudhb study --help`\n"
    "  eval CASE.yaml --params IN --results OUT  one design for Dakota and other drivers\n"
    "  check FILE.yaml    check a case file or a study file, run nothing\n"
    "  keys [study]       every key of a case or a study: unit, range, default, meaning; "
    "--markdown\n"
    "                     prints the page docs/user/case_reference.md, --schema a JSON Schema,\n"
    "                     --schema=motion that of a file for contact, --schema=study of a study\n"
    "  inspect FILE.h5    what a modal or response file holds; of two modal files: A.h5 B.h5;\n"
    "                     FILE.h5 PATH prints values, 'branch_2/motion[peak,0,:,1]'; --csv\n"
    "  field NAME.response.h5  the moving blade: motion and stress everywhere over a period, for\n"
    "                     ParaView and viewers of glTF; `shroudhb field --help`\n"
    "  contact FILE.yaml  contact forces for a prescribed motion; --svg OUT.svg draws the loops\n"
    "  help [COMMAND]     this text, or what COMMAND does, as COMMAND --help\n"
    "\n"
    "  --quiet    no progress, no summary       --verbose  time and memory of every stage\n"
    "  --force    run though up to date         --help, --version\n"
    "  --json     the result on standard output as JSON: docs/user/summary.md\n"
    "  --no-report  with run and post: no page, no picture; NAME.csv and NAME.summary.json only\n"
    "  --set KEY=VALUE  instead of what the case says, such as --set contact.mu=0.4; any number\n"
    "  --into FOLDER    where the output files go; default: beside the case\n"
    "\n"
    "A stage runs again only when what it depends on has changed. The heavy stage on several "
    "processes:\n"
    "mpiexec -n 4 shroudhb-modal CASE.yaml\n"
    "\n"
    "Exit codes: 0 done, 2 bad input, 3 not converged everywhere (results kept), 4 input/output,\n"
    "130 interrupted (results so far kept).\n";

/* A way of running a program: words[0] is its path, a NULL ends them. Returns the exit code. */
typedef int (*run_words)(char **words);

typedef int (*command_main)(const char *name, int argc, char **argv, run_words end);

static int replace_by(char **argv) {
  execvp(argv[0], argv);
  fprintf(stderr, "shroudhb: error: %s: cannot be started: %s\n", argv[0], strerror(errno));
  return SHB_ERR_IO;
}

/* HDF5 can crash on a damaged file: inspect runs as a child process, and a crash is reported. */
static int watch(char **argv) {
  subprocess_result result;
  if (subprocess_run(argv, &result) == SHB_OK) return result.code;
  fprintf(stderr, "shroudhb: error: %s; the file may be damaged\n", shb_message());
  return SHB_ERR_IO;
}

/* Runs the program "shroudhb-STAGE [mode]" with the rest of argv. argv[0] is the command; end is
 * the way of running it. */
static int become(const char *stage, char *mode, int argc, char **argv, run_words end) {
  char name[64];
  snprintf(name, sizeof name, "shroudhb-%s", stage);
  char **words = calloc((size_t)argc + 2, sizeof *words);
  int    n = 0, code = SHB_ERR_IO;
  char  *path = subprocess_program(name);
  if (words && path) {
    words[n++] = path;
    if (mode) words[n++] = mode;
    for (int i = 1; i < argc; i++) words[n++] = argv[i];
    code = end(words);
  } else {
    fputs("shroudhb: error: out of memory\n", stderr);
  }
  free(path);
  free(words);
  return code;
}

static int stage_main(const char *name, int argc, char **argv, run_words end) {
  return become(name, NULL, argc, argv, end);
}

static int inspect_main(const char *name, int argc, char **argv, run_words end) {
  (void)name;
  char mode[] = "--inspect";
  return become("post", mode, argc, argv, end == replace_by ? watch : end);
}

static int contact_main(const char *name, int argc, char **argv, run_words end) {
  (void)name;
  char mode[] = "--contact";
  if (argc > 1 && strcmp(argv[1], "--help") == 0) {
    fputs(usage, stdout);
    return command_finish(SHB_OK);
  }
  return become("mhb", mode, argc, argv, end);
}

static int keys_main(const char *name, int argc, char **argv, run_words end) {
  (void)name;
  (void)end;
  if (argc > 1 && strcmp(argv[1], "--help") == 0) {
    fputs(usage, stdout);
    return command_finish(SHB_OK);
  }
  static const struct {
    const char *word;
    void (*print)(FILE *);
  } forms[]             = {{"case", case_print_keys},
                           {"study", study_print_keys},
                           {"motion", case_print_motion_keys},
                           {"--markdown", case_print_reference},
                           {"--schema", case_print_schema},
                           {"--schema=case", case_print_schema},
                           {"--schema=motion", case_print_motion_schema},
                           {"--schema=study", study_print_schema}};
  void (*print)(FILE *) = argc > 1 ? NULL : case_print_keys;
  for (size_t i = 0; argc == 2 && i < sizeof forms / sizeof *forms; i++)
    if (strcmp(argv[1], forms[i].word) == 0) print = forms[i].print;
  if (!print) {
    fprintf(stderr,
            "shroudhb: error: keys takes case, study, motion, --markdown or --schema; unexpected "
            "'%s'\n",
            argv[argc - 1]);
    return SHB_ERR_INPUT;
  }
  print(stdout);
  return command_finish(SHB_OK);
}

/* Options of commands without --svg. */
static int parse(int argc, char **argv, command_options *options) {
  int code = command_parse(argc, argv, usage, options);
  if (code >= 0 || !options->svg) return code;
  fprintf(stderr, "shroudhb: error: --svg goes with contact, not with %s; see --help\n", argv[0]);
  return SHB_ERR_INPUT;
}

/* A study file has the keys case and vary, plan or uncertain. */
static bool is_study(const char *path) {
  char  *text;
  size_t length;
  if (case_text_read(path, &text, &length) != SHB_OK) return false;
  case_issues issues = case_issues_start(path, text, length);
  case_node  *root   = case_document_parse(&issues);
  bool        study  = case_node_find(root, "case") &&
               (case_node_find(root, "vary") || case_node_find(root, "plan") ||
                case_node_find(root, "uncertain"));
  case_document_free(root);
  case_issues_free(&issues);
  free(text);
  return study;
}

/* With a modal file there is more to tell; the program that reads it does. */
static void add_facts(const case_file *file, int argc, char **argv) {
  char  *modal = case_modal_path(file), facts[] = "--facts";
  bool   there   = modal && access(modal, R_OK) == 0;
  char  *program = subprocess_program("shroudhb-post");
  char **words   = calloc((size_t)argc + 3, sizeof *words);
  if (there && words && program) {
    subprocess_result result;
    words[0] = program;
    words[1] = facts;
    for (int i = 1; i < argc; i++) words[i + 1] = argv[i];
    fflush(stdout);
    (void)subprocess_run(words, &result); /* its own message, if any, is on standard error */
  }
  free(modal);
  free(program);
  free(words);
}

static int check_main(const char *name, int argc, char **argv, run_words end) {
  (void)name;
  command_options options;
  int             code = parse(argc, argv, &options);
  if (code >= 0) return code;
  char study[] = "--check";
  if (is_study(options.path)) return become("study", study, argc, argv, end);
  options.into = NULL; /* nothing is written: no folder is made */
  case_file  file;
  shb_status status = command_read(&options, RUN_ALL | CASE_OR_MODES, &file);
  if (status == SHB_OK && !options.quiet) {
    run_describe(&file, stdout);
    add_facts(&file, argc, argv);
  }
  if (status == SHB_OK) case_free(&file);
  return command_finish(status);
}

static int run_main(const char *name, int argc, char **argv, run_words end) {
  (void)name;
  (void)end;
  command_options options;
  int             code = parse(argc, argv, &options);
  if (code >= 0) return code;
  return command_finish(run_case(&options));
}

/* Where the document of --json comes from. */
typedef enum {
  JSON_NONE,    /* the command has none */
  JSON_OWN,     /* the program of the command prints it */
  JSON_MODES,   /* shroudhb-post makes it of the modal file */
  JSON_SUMMARY, /* shroudhb-post makes it of all results of the case */
  JSON_CHECK    /* it says that the file is in order */
} json_source;

static const struct {
  const char  *name;
  command_main main;
  json_source  json;
} commands[] = {{"run", run_main, JSON_SUMMARY},     {"mesh", stage_main, JSON_CHECK},
                {"modal", stage_main, JSON_MODES},   {"mhb", stage_main, JSON_SUMMARY},
                {"post", stage_main, JSON_OWN},      {"converge", stage_main, JSON_OWN},
                {"check", check_main, JSON_CHECK},   {"keys", keys_main, JSON_NONE},
                {"inspect", inspect_main, JSON_OWN}, {"contact", contact_main, JSON_NONE},
                {"study", stage_main, JSON_OWN},     {"integrate", stage_main, JSON_SUMMARY},
                {"field", stage_main, JSON_NONE},    {"eval", stage_main, JSON_NONE}};

enum { N_COMMANDS = sizeof commands / sizeof *commands };

static int unknown_command(const char *word) {
  int best = -1, least = 3;
  for (int i = 0; i < N_COMMANDS; i++) {
    int distance = case_edit_distance(word, commands[i].name);
    if (distance >= least) continue;
    least = distance;
    best  = i;
  }
  fprintf(stderr, "shroudhb: error: unknown command '%s'", word);
  if (best >= 0) fprintf(stderr, "; did you mean '%s'?", commands[best].name);
  fputs(best >= 0 ? "\n" : "; see shroudhb --help\n", stderr);
  return SHB_ERR_INPUT;
}

/* ---------------------------------------------------------------- --json */

/* For commands whose program prints the document. */
static int capture(char **words) {
  return json_command(words, NULL);
}

/* Takes --json out of the words. */
static void take_json(int *argc, char **argv) {
  int n = 1;
  for (int i = 1; i < *argc; i++)
    if (strcmp(argv[i], "--json") != 0) argv[n++] = argv[i];
  argv[n] = NULL;
  *argc   = n;
}

/* Runs this program without --json, then what makes the document. argv: the command and its
 * words. */
static int run_json(json_source source, int argc, char **argv) {
  static const char *const mode[] = {
      [JSON_MODES] = "--modes", [JSON_SUMMARY] = "--summary", [JSON_CHECK] = "--check"};
  char **first = calloc((size_t)argc + 2, sizeof *first),
       **then  = calloc((size_t)argc + 3, sizeof *then);
  char *self = subprocess_program("shroudhb"), *post = subprocess_program("shroudhb-post");
  char  kind[16], quiet[]                            = "--quiet";
  int   code = SHB_ERR_IO;
  snprintf(kind, sizeof kind, "%s", mode[source]);
  if (first && then && self && post) {
    int n    = 0;
    first[0] = self;
    for (int i = 0; i < argc; i++) first[i + 1] = argv[i];
    then[n++] = post;
    then[n++] = kind;
    then[n++] = quiet;
    for (int i = 1; i < argc; i++) {
      bool ours = strcmp(argv[i], "--force") == 0 || strcmp(argv[i], "--no-report") == 0 ||
                  strcmp(argv[i], "--inp") == 0 || strcmp(argv[i], "--verbose") == 0;
      if (!ours) then[n++] = argv[i];
    }
    code = json_command(first, then);
  } else {
    fputs("shroudhb: error: out of memory\n", stderr);
  }
  free(first);
  free(then);
  free(self);
  free(post);
  return code;
}

/* A study is checked by the program of studies, which prints its own document. */
static bool prints_its_own(json_source source, int argc, char **argv) {
  bool own = source == JSON_OWN;
  for (int i = 1; i < argc && source == JSON_CHECK; i++)
    own = own || (argv[i][0] != '-' && access(argv[i], R_OK) == 0 && is_study(argv[i]));
  return own;
}

static int run_command(int index, int argc, char **argv) {
  const json_source json  = commands[index].json;
  const char       *name  = commands[index].name;
  bool              asked = false;
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    asked = asked || strcmp(argv[i], "--json") == 0;
  if (!asked || json == JSON_NONE) return commands[index].main(name, argc, argv, replace_by);
  if (prints_its_own(json, argc, argv)) return commands[index].main(name, argc, argv, capture);
  take_json(&argc, argv);
  return run_json(json, argc, argv);
}

static int front(int argc, char **argv) {
  const char *word = argv[1];
  for (int i = 0; i < N_COMMANDS; i++)
    if (strcmp(word, commands[i].name) == 0) return run_command(i, argc - 1, argv + 1);
  command_options options;
  if (word[0] == '-') return command_parse(2, argv, usage, &options);
  return unknown_command(word);
}

/* help: as --help. help COMMAND: as COMMAND --help. */
static int help(int argc, char **argv) {
  char  asked[] = "--help";
  char *words[] = {argv[0], argc > 2 ? argv[2] : asked, argc > 2 ? asked : NULL, NULL};
  if (argc <= 3) return front(argc > 2 ? 3 : 2, words);
  fprintf(stderr, "shroudhb: error: help takes one command; unexpected '%s'\n", argv[3]);
  return SHB_ERR_INPUT;
}

int main(int argc, char **argv) {
  if (argc < 2) {
    fputs(usage, stderr);
    return SHB_ERR_INPUT;
  }
  return strcmp(argv[1], "help") == 0 ? help(argc, argv) : front(argc, argv);
}
