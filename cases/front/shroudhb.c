/* shroudhb: the command of the user. It knows the table of commands, and starts the program that
 * does the work. It loads no library but that of C, so help and version come at once. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/front/json_command.h"
#include "cases/options/help.h"
#include "mesh/base/memory.h"
#include "mesh/process/child.h"
#include "mesh/process/report.h"

/* The words that start a command: the program, the command's name unless the program is its own,
 * and the user's words behind argv[0]. malloc'ed, words[0] too. */
static char **words_of(command_id id, int argc, char **argv) {
  const bool own   = id == COMMAND_MODAL;
  char     **words = shb_alloc_zeroed((size_t)argc + 2, sizeof *words);
  int        n     = 0;
  words[n++]       = shb_child_program(own ? "shroudhb-modal" : "shroudhb-pool");
  if (!own) words[n++] = (char *)command_row_of(id)->name;
  for (int i = 1; i < argc; i++) words[n++] = argv[i];
  return words;
}

/* Over a damaged file HDF5 can crash: the child's end is told in one line. */
static int watch(const command_row *row, char *const words[]) {
  char          name[32];
  shb_child_end end;
  shb_child     child = shb_child_of(words);
  snprintf(name, sizeof name, "shroudhb-%s", row->name);
  child.name = name;
  if (shb_child_run(&child, &end) == SHB_OK) return end.code;
  shb_error("%s; the file may be damaged", shb_message());
  return SHB_ERR_IO;
}

static int become(char *const words[]) {
  execvp(words[0], words);
  shb_error("%s: cannot be started: %s", words[0], strerror(errno));
  return SHB_ERR_IO;
}

static bool asks_json(int argc, char **argv) {
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    if (strcmp(argv[i], "--json") == 0) return true;
  return false;
}

/* argv[0] stands for the command. */
static int run_command(command_id id, int argc, char **argv) {
  const command_row *row  = command_row_of(id);
  int                code = help_answer(row, argc, argv);
  if (code >= 0) return code;
  char **words = words_of(id, argc, argv);
  if (row->json != JSON_NONE && asks_json(argc, argv))
    code = json_command(row, words);
  else
    code = row->may_crash ? watch(row, words) : become(words);
  free(words[0]);
  free(words);
  return code;
}

static int unknown_command(const char *word) {
  const char *best = command_nearest(word);
  if (best)
    shb_error("unknown command '%s'; did you mean '%s'?", word, best);
  else
    shb_error("unknown command '%s'; see shroudhb --help", word);
  return SHB_ERR_INPUT;
}

/* help: as --help. help COMMAND: as COMMAND --help. */
static int help(int argc, char **argv) {
  char             asked[] = "--help", *words[] = {argv[0], asked, NULL};
  const command_id id = argc > 2 ? command_find(argv[2]) : COMMANDS;
  if (argc > 3) {
    shb_error("help takes one command; unexpected '%s'", argv[3]);
    return SHB_ERR_INPUT;
  }
  const bool of_all = argc < 3 || strcmp(argv[2], asked) == 0;
  if (!of_all && id == COMMANDS) return unknown_command(argv[2]);
  return help_answer(of_all ? NULL : command_row_of(id), 2, words);
}

/* Modes of former programs that are commands now. */
static command_id former(command_id id, int argc, char **argv) {
  static const struct {
    command_id  of, now;
    const char *word;
  } moved[] = {{COMMAND_MHB, COMMAND_CONTACT, "--contact"},
               {COMMAND_POST, COMMAND_INSPECT, "--inspect"}};
  for (size_t i = 0; argc > 1 && i < sizeof moved / sizeof *moved; i++)
    if (id == moved[i].of && strcmp(argv[1], moved[i].word) == 0) return moved[i].now;
  return id;
}

int main(int argc, char **argv) {
  const command_id called = command_called(argv[0]), now = former(called, argc, argv);
  if (called < COMMANDS && now != called) return run_command(now, argc - 1, argv + 1);
  if (called < COMMANDS) return run_command(called, argc, argv);
  if (argc < 2) {
    help_print_all(stderr);
    return SHB_ERR_INPUT;
  }
  if (strcmp(argv[1], "help") == 0) return help(argc, argv);
  const command_id id = command_find(argv[1]);
  if (id < COMMANDS) return run_command(id, argc - 1, argv + 1);
  const int code = help_answer(NULL, 2, argv);
  if (code >= 0) return code;
  if (argv[1][0] != '-') return unknown_command(argv[1]);
  shb_error("unknown option '%s'; see --help", argv[1]);
  return SHB_ERR_INPUT;
}
