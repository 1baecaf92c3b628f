/* Stages as children of one process: what a program costs to start is paid once.
 * Each line of standard input is STAGE, a tab, and the arguments with tabs between. The stage runs
 * in a child, its standard error goes to the file "said". Answer: a line with the exit code, or the
 * signal, negative. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cases/commands/stages.h"
#include "cases/options/command_table.h"

/* The main of the program, renamed where it is compiled for this one. */
int modal_main(int argc, char **argv);

enum { MOST_WORDS = 16, LINE = 4096, SECONDS = 60 };
static const rlim_t MOST_MEMORY = (rlim_t)4 << 30; /* bytes of address space; damaged sizes */

static const struct {
  command_id id;
  int (*work)(const command_options *options);
} stage[] = {{COMMAND_MESH, mesh_command},
             {COMMAND_MHB, mhb_command},
             {COMMAND_POST, post_command},
             {COMMAND_INSPECT, inspect_command},
             {COMMAND_INTEGRATE, integrate_command}};

static void redirect(int target, const char *path) {
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || dup2(file, target) < 0) _exit(99);
  close(file);
}

static int run(int argc, char **argv) {
  redirect(STDOUT_FILENO, "/dev/null");
  redirect(STDERR_FILENO, "said");
#if !defined(__SANITIZE_ADDRESS__)
  const struct rlimit memory = {MOST_MEMORY, MOST_MEMORY};
  setrlimit(RLIMIT_AS, &memory);
#endif
  alarm(SECONDS); /* a stage that hangs ends by a signal, which is a fault */
  const command_id id = command_find(argv[0]);
  command_options  options;
  if (id == COMMAND_MODAL) return modal_main(argc, argv);
  for (size_t i = 0; i < sizeof stage / sizeof *stage; i++) {
    if (stage[i].id != id) continue;
    const int code = options_read(command_row_of(id), argc, argv, &options);
    return code >= 0 ? code : stage[i].work(&options);
  }
  return 98;
}

int main(void) {
  static char line[LINE];
  while (fgets(line, sizeof line, stdin)) {
    char *word[MOST_WORDS + 1] = {NULL}, *rest = line;
    int   n                   = 0, status;
    line[strcspn(line, "\n")] = '\0';
    while (n < MOST_WORDS && (word[n] = strtok_r(rest, "\t", &rest))) n++;
    word[n]           = NULL;
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      fclose(stdin);
      exit(run(n, word));
    }
    if (waitpid(child, &status, 0) != child) return 1;
    printf("%d\n", WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status));
    fflush(stdout);
  }
  return 0;
}
