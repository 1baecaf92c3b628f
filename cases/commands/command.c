#include "cases/commands/command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/yaml.h"
#include "cases/schema/case.h"
#include "mesh/base/crash_guard.h"

/* Does usage mention option as a whole word? */
static bool mentions(const char *usage, const char *option) {
  size_t n = strlen(option);
  for (const char *at = usage; (at = strstr(at, option)) != NULL; at += n)
    if (!strchr("abcdefghijklmnopqrstuvwxyz-", at[n]) || at[n] == '\0') return true;
  return false;
}

static bool set_flag(const char *word, command_options *out) {
  if (strcmp(word, "--quiet") == 0) {
    out->quiet = true;
  } else if (strcmp(word, "--verbose") == 0) {
    out->verbose = true;
  } else if (strcmp(word, "--force") == 0) {
    out->force = true;
  } else {
    return false;
  }
  return true;
}

/* Flags that are known where the usage mentions them. */
static bool set_own_flag(const char *word, const char *usage, command_options *out) {
  const struct {
    const char *word;
    bool       *flag;
  } own[] = {{"--csv", &out->csv}, {"--json", &out->json}, {"--no-report", &out->no_report}};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
    if (strcmp(word, own[i].word) != 0 || !mentions(usage, word)) continue;
    *own[i].flag = true;
    return true;
  }
  return false;
}

static int refuse(const char *what, const char *word) {
  fprintf(stderr, "shroudhb: error: %s%s%s%s; see --help\n", what, word ? " '" : "",
          word ? word : "", word ? "'" : "");
  return SHB_ERR_INPUT;
}

/* The argument of an option, or NULL after a message. */
static const char *argument(int argc, char **argv, int *i, const char *what) {
  if (*i + 1 < argc && argv[*i + 1][0] != '\0') return argv[++*i];
  refuse(what, NULL);
  return NULL;
}

/* --set, --into and --text. Returns 0 if the word is none of them, -1 after a message, else 1. */
static int set_override(int argc, char **argv, int *i, command_options *out) {
  static const char *const        word[] = {"--set", "--into", "--text"},
                           *const lack[] = {"--set needs KEY=VALUE, such as contact.mu=0.4",
                                            "--into needs the name of a folder",
                                            "--text needs the name of a file"};
  enum { SET, INTO, TEXT, N };
  int which = 0;
  while (which < N && strcmp(argv[*i], word[which]) != 0) which++;
  if (which == N) return 0;
  const char *text = argument(argc, argv, i, lack[which]);
  if (!text) return -1;
  if (which == SET && out->n_set == COMMAND_SETS) {
    refuse("more than 64 times --set", NULL);
    return -1;
  }
  *(which == SET ? &out->set[out->n_set++] : which == INTO ? &out->into : &out->text) = text;
  return 1;
}

shb_status command_read(const command_options *o, int stages, case_file *out) {
  case_overrides overrides = {.n = o->n_set, .text = o->set, .into = o->into};
  char          *document  = NULL;
  size_t         length;
  if (o->text) SHB_TRY(case_text_read(o->text, &document, &length));
  overrides.document = document;
  shb_status status  = case_read_with(o->path, &overrides, stages, stderr, out);
  free(document);
  SHB_TRY(status);
  status = o->into ? shb_make_folder(o->into) : SHB_OK;
  if (status != SHB_OK) case_free(out);
  return status;
}

shb_status command_keep_text(command_options *o, int *copy, char path[SUBPROCESS_COPY]) {
  char  *text;
  size_t length;
  SHB_TRY(case_text_read(o->text ? o->text : o->path, &text, &length));
  const shb_status status = subprocess_copy(text, copy, path);
  free(text);
  if (status == SHB_OK) o->text = path;
  return status;
}

int command_forward(const command_options *o, const char **words, int n) {
  if (o->quiet) words[n++] = "--quiet";
  if (o->verbose) words[n++] = "--verbose";
  if (o->force) words[n++] = "--force";
  for (int i = 0; i < o->n_set; i++) {
    words[n++] = "--set";
    words[n++] = o->set[i];
  }
  if (o->into) {
    words[n++] = "--into";
    words[n++] = o->into;
  }
  if (o->text) {
    words[n++] = "--text";
    words[n++] = o->text;
  }
  if (o->path[0] == '-') words[n++] = "--";
  words[n++] = o->path;
  words[n]   = NULL;
  return n;
}

int command_parse(int argc, char **argv, const char *usage, command_options *out) {
  *out         = (command_options){0};
  bool options = true;
  for (int i = 1; i < argc; i++) {
    const char *word  = argv[i];
    int         taken = options && mentions(usage, "--set") ? set_override(argc, argv, &i, out) : 0;
    if (taken < 0) return SHB_ERR_INPUT;
    if (taken > 0) continue;
    if (options && strcmp(word, "--") == 0) {
      options = false;
    } else if (options && strcmp(word, "--help") == 0) {
      fputs(usage, stdout);
      return command_finish(SHB_OK);
    } else if (options && strcmp(word, "--version") == 0) {
      printf("shroudhb %s\n", shb_revision());
      return command_finish(SHB_OK);
    } else if (options && (set_flag(word, out) || set_own_flag(word, usage, out))) {
      continue;
    } else if (options && strcmp(word, "--svg") == 0 && mentions(usage, word)) {
      if (i + 1 == argc || argv[i + 1][0] == '-' || argv[i + 1][0] == '\0')
        return refuse("--svg needs the name of a file to write", NULL);
      if (out->svg) return refuse("one --svg is enough; unexpected", argv[i + 1]);
      out->svg = argv[++i];
    } else if (options && strncmp(word, "--", 2) == 0 && mentions(usage, word)) {
      if (out->mode) return refuse("one mode at a time; unexpected", word);
      out->mode = word + 2;
    } else if (options && word[0] == '-' && word[1] != '\0') {
      return refuse("unknown option", word);
    } else {
      if (out->path && (out->other || !mentions(usage, "OTHER")))
        return refuse(
            out->other ? "two files are enough; unexpected" : "one file is enough; unexpected",
            word);
      *(out->path ? &out->other : &out->path) = word;
    }
  }
  if (!out->path) return refuse("no file given", NULL);
  return -1;
}

/* A reader of standard output that has closed it is no fault; a full disk is one. */
static shb_status finish_output(void) {
  errno     = 0;
  bool good = fflush(stdout) == 0;
  if ((good && !ferror(stdout)) || errno == EPIPE) return SHB_OK;
  SHB_FAIL(SHB_ERR_IO, "standard output cannot be written%s%s", errno ? ": " : "",
           errno ? strerror(errno) : "");
}

int command_finish(shb_status status) {
  if (status == SHB_OK || status == SHB_NOT_CONVERGED) {
    shb_status output = finish_output();
    if (output != SHB_OK) status = output;
  }
  if (status != SHB_OK && shb_message()[0] != '\0')
    fprintf(stderr, "shroudhb: %s: %s\n", status == SHB_NOT_CONVERGED ? "warning" : "error",
            shb_message());
  shb_guard_told((int)status);
  return (int)status;
}

shb_provenance command_provenance(const case_file *file, char *settings, const char *name) {
  return (shb_provenance){
      .case_path = file->path, .case_text = file->text, .settings = settings, .command = name};
}
