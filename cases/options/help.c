#include "cases/options/help.h"

#include <string.h>

#include "cases/options/finish.h"
#include "mesh/base/status.h"

static const char before[] =
    "usage: shroudhb COMMAND [OPTION]... [FILE]\n"
    "\n"
    "Forced response of shrouded blades whose shrouds rub, stick and separate.\n"
    "\n";

static const char after[] =
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

void help_print_all(FILE *out) {
  fputs(before, out);
  for (int i = 0; i < COMMANDS; i++) {
    const char *brief = command_row_of((command_id)i)->brief;
    if (brief) fputs(brief, out);
  }
  fputs(after, out);
}

enum { COLUMN = 18 }; /* of the explanation of an option */

static void print_option(const command_option *o, FILE *out) {
  char word[64];
  snprintf(word, sizeof word, "%s%s%s", o->word, o->argument ? " " : "",
           o->argument ? o->argument : "");
  fprintf(out, "  %-*s  ", COLUMN, word);
  for (const char *line = o->text; line;) {
    const char *end = strchr(line, '\n');
    fprintf(out, "%.*s\n", end ? (int)(end - line) : (int)strlen(line), line);
    line = end ? end + 1 : NULL;
    if (line) fprintf(out, "  %-*s  ", COLUMN, "");
  }
}

/* A line that begins with mpiexec names its program itself. */
static void print_forms(const command_row *row, FILE *out) {
  const char *start = "usage: ";
  for (const char *line = row->synopsis; line;) {
    const char *end    = strchr(line, '\n');
    const int   length = end ? (int)(end - line) : (int)strlen(line);
    const bool  whole  = strncmp(line, "mpiexec", 7) == 0;
    fprintf(out, "%s%s%s%s%.*s\n", start, whole ? "" : "shroudhb ", whole ? "" : row->name,
            whole ? "" : " ", length, line);
    start = "       ";
    line  = end ? end + 1 : NULL;
  }
}

void help_print(const command_row *row, FILE *out) {
  print_forms(row, out);
  fprintf(out, "\n%s\n", row->text);
  for (const command_option *o = row->option; o && o->word; o++)
    if (o->text) print_option(o, out);
  if (row->codes) fprintf(out, "\n%s", row->codes);
}

int help_answer(const command_row *row, int argc, char **argv) {
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++) {
    const bool version = strcmp(argv[i], "--version") == 0;
    if (!version && strcmp(argv[i], "--help") != 0) continue;
    if (version)
      printf("shroudhb %s\n", shb_revision());
    else if (row)
      help_print(row, stdout);
    else
      help_print_all(stdout);
    return command_finish(SHB_OK);
  }
  return -1;
}
