#include "cases/front/json_command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/command.h"
#include "cases/commands/subprocess.h"
#include "postproc/draw/text_buffer.h"

static const char *kind_of(int code) {
  switch (code) {
    case SHB_ERR_INPUT:
      return "bad input";
    case SHB_NOT_CONVERGED:
      return "not converged";
    case SHB_INTERRUPTED:
      return "interrupted";
    default:
      return "input or output failed";
  }
}

/* Copies a file from its start. */
static void copy(FILE *from, FILE *to) {
  char   part[4096];
  size_t n;
  rewind(from);
  while ((n = fread(part, 1, sizeof part, from)) > 0) fwrite(part, 1, n, to);
  fflush(to);
}

/* Puts the lines that hold "error: ", without what the program is called. */
static void put_messages(FILE *errors, post_buffer *out) {
  static const char program[] = "shroudhb: error: ";
  char             *line      = NULL;
  size_t            size      = 0;
  bool              some      = false;
  rewind(errors);
  while (getline(&line, &size, errors) > 0) {
    const char *text = strstr(line, "error: ");
    if (!text) continue;
    const char *shown = strstr(line, program) ? strstr(line, program) + sizeof program - 1 : line;
    line[strcspn(line, "\n")] = '\0';
    post_put(out, some ? ", " : "");
    post_put_json(out, shown);
    some = true;
  }
  free(line);
}

static void put_error(int code, FILE *errors) {
  post_buffer text = {0};
  post_put(&text, "{\"error\": {\"code\": %d, \"kind\": \"%s\", \"messages\": [", code,
           kind_of(code));
  put_messages(errors, &text);
  post_put(&text, "]}}\n");
  if (text.text && !text.failed) fputs(text.text, stdout);
  post_buffer_free(&text);
}

/* Runs a program with its output and errors into files. Returns its exit code. */
static int run(char *const words[], FILE *output, FILE *errors) {
  subprocess_result result;
  shb_status        status = subprocess_run_to(words, fileno(output), fileno(errors), &result);
  if (status == SHB_OK) return result.code;
  fseek(errors, 0, SEEK_END);
  fprintf(errors, "shroudhb: error: %s\n", shb_message());
  return SHB_ERR_IO;
}

static bool is_done(int code) {
  return code == SHB_OK || code == SHB_NOT_CONVERGED;
}

int json_command(char *const words[], char *const then[]) {
  FILE *output = tmpfile(), *errors = tmpfile(), *document = tmpfile();
  int   code = SHB_ERR_IO;
  if (output && errors && document) {
    code       = run(words, output, errors);
    int  after = is_done(code) && then ? run(then, document, errors) : SHB_OK;
    bool done  = is_done(code) && after == SHB_OK;
    if (!done && is_done(code)) code = after;
    copy(errors, stderr);
    if (done)
      copy(then ? document : output, stdout);
    else
      put_error(code, errors);
  } else {
    fputs("shroudhb: error: no temporary file can be made\n", stderr);
  }
  if (output) fclose(output);
  if (errors) fclose(errors);
  if (document) fclose(document);
  int finished = command_finish(SHB_OK);
  return finished == SHB_OK ? code : finished;
}
