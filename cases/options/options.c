#include "cases/options/options.h"

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/options/command_table.h"
#include "mesh/base/status.h"
#include "mesh/process/report.h"

enum { MOST_OPTIONS = 32, CODE = 256 /* above all characters */ };

/* Every command knows them. */
static const command_option common[] = {
    {"--quiet", NULL, NULL, OPTION_FLAG, offsetof(command_options, quiet), NULL, 0, 0},
    {"--verbose", NULL, NULL, OPTION_FLAG, offsetof(command_options, verbose), NULL, 0, 0},
    {"--force", NULL, NULL, OPTION_FLAG, offsetof(command_options, force), NULL, 0, 0},
    {.word = NULL}};

/* The options of a row and the common ones. */
static int gather(const command_row *row, const command_option *out[MOST_OPTIONS]) {
  const command_option *list[] = {row->option, common};
  int                   n      = 0;
  for (int i = 0; i < 2; i++) {
    for (const command_option *o = list[i]; o && o->word && n < MOST_OPTIONS; o++) {
      int same = 0;
      while (same < n && strcmp(out[same]->word, o->word) != 0) same++;
      if (same == n) out[n++] = o;
    }
  }
  return n;
}

static int refuse(const char *what, const char *word) {
  shb_error("%s%s%s%s; see --help", what, word ? " '" : "", word ? word : "", word ? "'" : "");
  return SHB_ERR_INPUT;
}

static int needs(const command_option *o) {
  shb_error("%s needs %s; see --help", o->word, o->needs);
  return SHB_ERR_INPUT;
}

static int take_count(const command_option *o, const char *word, int *to) {
  char *end = NULL;
  errno     = 0;
  long read = word ? strtol(word, &end, 10) : 0;
  if (!end || end == word || *end || errno || read < o->low || read > o->high) return needs(o);
  *to = (int)read;
  return -1;
}

static int take_positive(const command_option *o, const char *word, double *to) {
  char *end = NULL;
  *to       = strtod(word, &end);
  return end != word && *end == '\0' && *to > 0 && *to < 1e12 ? -1 : needs(o);
}

static int take_text(const command_option *o, const char *word, const char **to) {
  if (word[0] == '\0' || (o->kind == OPTION_OUTPUT && word[0] == '-')) return needs(o);
  if (o->kind == OPTION_OUTPUT && *to) {
    char what[64];
    snprintf(what, sizeof what, "one %s is enough; unexpected", o->word);
    return refuse(what, word);
  }
  *to = word;
  return -1;
}

static int take_set(const command_option *o, const char *word, command_options *out) {
  if (word[0] == '\0') return needs(o);
  if (out->n_set == COMMAND_SETS) return refuse("more than 64 times --set", NULL);
  out->set[out->n_set++] = word;
  return -1;
}

static int take_mode(const command_option *o, command_options *out) {
  if (out->mode) return refuse("one mode at a time; unexpected", o->word);
  out->mode = o->word + 2;
  return -1;
}

/* A number behind --peak is its argument, another word is not. */
static const char *number_behind(int argc, char **argv, const char *joined) {
  const char *next = !joined && optind < argc ? argv[optind] : NULL;
  if (!next || !*next || strspn(next, "0123456789") != strlen(next)) return joined;
  optind++;
  return next;
}

/* Take an option; returns a value below 0 to go on. */
static int take(const command_option *o, const char *word, command_options *out) {
  void *to = (char *)out + o->at;
  switch (o->kind) {
    case OPTION_FLAG:
      *(bool *)to = true;
      return -1;
    case OPTION_MODE:
      return take_mode(o, out);
    case OPTION_SET:
      return take_set(o, word, out);
    case OPTION_COUNT:
      return take_count(o, word, to);
    case OPTION_RANK:
      return word ? take_count(o, word, to) : -1;
    case OPTION_POSITIVE:
      return take_positive(o, word, to);
    default:
      return take_text(o, word, to);
  }
}

/* An option that other commands have is told with them. */
static int unknown(const command_row *row, const char *word) {
  char         where[256] = "";
  const size_t n          = word[0] == '-' && word[1] == '-' ? strcspn(word + 2, "=") : 0;
  for (int i = 0; n > 0 && i < COMMANDS; i++) {
    const command_row *other = command_row_of((command_id)i);
    for (const command_option *o = other->brief ? other->option : NULL; o && o->word; o++) {
      if (!o->text || strlen(o->word) != n + 2 || strncmp(o->word, word, n + 2) != 0) continue;
      const size_t used = strlen(where);
      snprintf(where + used, sizeof where - used, "%s%s", used ? ", " : "", other->name);
    }
  }
  if (!where[0]) return refuse("unknown option", word);
  shb_error("%.*s goes with %s, not with %s; see --help", (int)n + 2, word, where, row->name);
  return SHB_ERR_INPUT;
}

/* What getopt_long refuses. optind is behind the word, but within several letters. */
static int wrong(const command_row *row, int code, char **argv, const command_option *const *list) {
  char        what[96];
  const char *word = argv[optind - 1];
  if (code == ':' && optopt >= CODE) return needs(list[optopt - CODE]);
  if (optopt < CODE) {
    const bool letters = optopt > 0 && (word[0] != '-' || !strchr(word, optopt));
    return unknown(row, letters ? argv[optind] : word);
  }
  snprintf(what, sizeof what, "%s takes no argument; unexpected", list[optopt - CODE]->word);
  return refuse(what, strchr(word, '=') + 1);
}

static int take_files(const command_row *row, int argc, char **argv, command_options *out) {
  static const char *const number[] = {"", "one file is", "two files are", "three files are"};
  char                     what[96];
  for (int i = optind; i < argc; i++) {
    snprintf(what, sizeof what, "%s enough; unexpected", number[row->most < 3 ? row->most : 3]);
    if (out->n_files == row->most || out->n_files == COMMAND_FILES) return refuse(what, argv[i]);
    out->file[out->n_files++] = argv[i];
  }
  out->path  = out->file[0];
  out->other = out->file[1];
  return out->n_files < row->least ? refuse("no file given", NULL) : -1;
}

int options_read(const command_row *row, int argc, char **argv, command_options *out) {
  const command_option *list[MOST_OPTIONS];
  struct option         known[MOST_OPTIONS + 1] = {{0}};
  const int             n                       = gather(row, list);
  *out                                          = (command_options){.design   = -1,
                                                                    .branch   = -1,
                                                                    .point    = -1,
                                                                    .peak     = -1,
                                                                    .rank     = -1,
                                                                    .diameter = -1,
                                                                    .steps    = -1,
                                                                    .scale    = -1};
  for (int i = 0; i < n; i++)
    known[i] = (struct option){list[i]->word + 2,
                               list[i]->kind == OPTION_RANK ? optional_argument
                               : list[i]->argument          ? required_argument
                                                            : no_argument,
                               NULL, CODE + i};
  opterr = 0;
  optind = 0; /* anew */
  for (int code; (code = getopt_long(argc, argv, ":", known, NULL)) >= 0;) {
    if (code < CODE) return wrong(row, code, argv, list);
    const command_option *o = list[code - CODE];
    const int             taken =
        take(o, o->kind == OPTION_RANK ? number_behind(argc, argv, optarg) : optarg, out);
    if (taken >= 0) return taken;
  }
  return take_files(row, argc, argv, out);
}

/* The words of an option that is given. */
static int words_of(const command_option *o, const command_options *options, const char **words,
                    int n) {
  static const char set[] = "--set";
  const void       *at    = (const char *)options + o->at;
  if (o->kind == OPTION_SET) {
    for (int i = 0; i < options->n_set; i++) {
      words[n++] = set;
      words[n++] = options->set[i];
    }
    return n;
  }
  const bool text = o->kind == OPTION_TEXT && *(const char *const *)at;
  const bool flag =
      (o->kind == OPTION_FLAG && *(const bool *)at) ||
      (o->kind == OPTION_MODE && options->mode && strcmp(options->mode, o->word + 2) == 0);
  if (text || flag) words[n++] = o->word;
  if (text) words[n++] = *(const char *const *)at;
  return n;
}

int options_words(const command_row *row, const command_options *options, const char **words,
                  int n) {
  const command_option *list[MOST_OPTIONS];
  const int             known = gather(row, list);
  for (int i = 0; i < known && n < COMMAND_WORDS - 2 * COMMAND_FILES; i++)
    n = words_of(list[i], options, words, n);
  if (options->path && options->path[0] == '-') words[n++] = "--";
  if (options->path) words[n++] = options->path;
  if (options->other && row->most > 1) words[n++] = options->other;
  words[n] = NULL;
  return n;
}
