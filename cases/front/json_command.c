#include "cases/front/json_command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/options/finish.h"
#include "mesh/base/memory.h"
#include "mesh/process/child.h"
#include "mesh/process/report.h"
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

/* A message a line. */
static void put_messages(char *lines, post_buffer *out) {
  char *rest = lines, *line;
  for (const char *comma = ""; (line = strtok_r(rest, "\n", &rest)) != NULL; comma = ", ") {
    post_put(out, "%s", comma);
    post_put_json(out, line);
  }
}

static void print_error(int code, int report) {
  post_buffer text  = {0};
  char       *lines = shb_report_read(report);
  post_put(&text, "{\"error\": {\"code\": %d, \"kind\": \"%s\", \"messages\": [", code,
           kind_of(code));
  put_messages(lines, &text);
  post_put(&text, "]}}\n");
  if (text.text && !text.failed) fputs(text.text, stdout);
  post_buffer_free(&text);
  free(lines);
}

/* Runs a program with its output into a file and its errors reported. Returns its exit code. */
static int run(const char *name, char *const words[], FILE *output, int report) {
  shb_child     child = shb_child_of(words);
  shb_child_end end;
  child.name   = name;
  child.out    = fileno(output);
  child.report = report;
  if (shb_child_run(&child, &end) == SHB_OK) return end.code;
  shb_error("%s", shb_message());
  shb_report_to(report, shb_message());
  return SHB_ERR_IO;
}

static bool is_done(int code) {
  return code == SHB_OK || code == SHB_NOT_CONVERGED;
}

/* Words of the document: post with what the command was told about its case. */
static char **words_of_document(command_json json, char *const words[], bool named) {
  static const char *const mode[] = {
      [JSON_MODES] = "--modes", [JSON_SUMMARY] = "--summary", [JSON_CHECK] = "--check"};
  static const char *const ours[] = {"--force", "--no-report", "--inp", "--verbose", "--quiet"};
  int                      n = 0, m = 0;
  while (words[n]) n++;
  char **out = shb_alloc((size_t)n + 5, sizeof *out);
  out[m++]   = shb_child_program("shroudhb-pool");
  out[m++]   = (char *)"post";
  out[m++]   = (char *)mode[json];
  out[m++]   = (char *)"--quiet";
  for (int i = named ? 2 : 1; i < n; i++) {
    bool left = false;
    for (size_t k = 0; k < sizeof ours / sizeof *ours; k++) left |= strcmp(words[i], ours[k]) == 0;
    if (!left) out[m++] = words[i];
  }
  out[m] = NULL;
  return out;
}

/* Takes --json out of the words. */
static void take_json(char **words) {
  char **to = words;
  for (char **from = words; *from; from++)
    if (strcmp(*from, "--json") != 0) *to++ = *from;
  *to = NULL;
}

static int document(const command_row *row, char **words, FILE *output, int report) {
  char  name[32];
  FILE *printed = row->json == JSON_OWN ? output : tmpfile();
  if (!printed) {
    shb_error("no temporary file can be made");
    return SHB_ERR_IO;
  }
  snprintf(name, sizeof name, "shroudhb-%s", row->name);
  if (printed != output) take_json(words);
  int code = run(name, words, printed, report);
  if (printed == output) return code;
  fclose(printed);
  if (!is_done(code)) return code;
  char    **then  = words_of_document(row->json, words, strcmp(row->name, "modal") != 0);
  const int after = run("shroudhb-post", then, output, report);
  free(then[0]);
  free(then);
  return after == SHB_OK ? code : after;
}

int json_command(const command_row *row, char **words) {
  FILE     *output = tmpfile();
  const int report = shb_report_open();
  int       code   = SHB_ERR_IO;
  if (output) {
    code = document(row, words, output, report);
    if (is_done(code))
      copy(output, stdout);
    else
      print_error(code, report);
    fclose(output);
  } else {
    shb_error("no temporary file can be made");
  }
  if (report >= 0) close(report);
  const int finished = command_finish(SHB_OK);
  return finished == SHB_OK ? code : finished;
}
