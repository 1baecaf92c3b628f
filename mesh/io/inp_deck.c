#define _GNU_SOURCE /* getdelim */
#include "mesh/io/inp_deck.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

const char *mesh_place_file(const mesh_deck *deck, mesh_place place) {
  return deck->files.path[place >> 32];
}

long mesh_place_line(mesh_place place) {
  return (long)(place & UINT32_MAX);
}

shb_status mesh_deck_fail(const mesh_deck *deck, mesh_place line, const char *source, int at,
                          const char *format, ...) {
  char    text[512];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  for (char *c = text; *c; c++)
    if (iscntrl((unsigned char)*c)) *c = ' ';
  return shb_fail(SHB_ERR_INPUT, source, at, "%s:%ld: %s", mesh_place_file(deck, line),
                  mesh_place_line(line), text);
}

/* Skip a byte order mark; detect the line ending. */
static void begin(mesh_deck_level *level) {
  FILE *file     = level->file;
  char  start[4] = "";
  int   c        = 0;
  level->end     = '\n';
  if (fread(start, 1, 3, file) != 3 || strcmp(start, "\xEF\xBB\xBF") != 0) rewind(file);
  long from = ftell(file);
  while ((c = getc(file)) != EOF && c != '\n' && c != '\r') continue;
  if (c == '\r' && getc(file) != '\n') level->end = '\r';
  fseek(file, from, SEEK_SET);
}

/* Read on in the file at that place of the list. */
static shb_status push(mesh_deck *deck, int at) {
  mesh_deck_level *level = &deck->level[deck->depth];
  *level                 = (mesh_deck_level){fopen(deck->files.path[at], "rb"), at, 0, 0};
  SHB_CHECK(level->file, SHB_ERR_IO, "%s: cannot be read: %s", deck->files.path[at],
            strerror(errno));
  deck->depth++;
  struct stat about;
  if (fstat(fileno(level->file), &about) == 0) deck->bytes += (long long)about.st_size;
  begin(level);
  return SHB_OK;
}

static void pop(mesh_deck *deck) {
  fclose(deck->level[--deck->depth].file);
}

shb_status mesh_deck_open(const char *path, mesh_deck *deck) {
  *deck = (mesh_deck){.path = path};
  mesh_files_begin(path, &deck->files);
  return push(deck, 0);
}

void mesh_deck_close(mesh_deck *deck) {
  while (deck->depth > 0) pop(deck);
  mesh_files_free(&deck->files);
  free(deck->text);
  *deck = (mesh_deck){0};
}

/* Remove leading and trailing spaces in place. */
static char *trim(char *text) {
  while (isspace((unsigned char)*text)) text++;
  size_t n = strlen(text);
  while (n > 0 && isspace((unsigned char)text[n - 1])) text[--n] = '\0';
  return text;
}

static char capital(char c) {
  return (char)toupper((unsigned char)c);
}

/* Copy a keyword in capitals, runs of spaces as one. */
static void take_word(const char *text, size_t n, char word[MESH_DECK_NAME]) {
  size_t used = 0;
  for (size_t i = 0; i < n && used + 1 < MESH_DECK_NAME; i++) {
    bool space = isspace((unsigned char)text[i]);
    if (space && (used == 0 || word[used - 1] == ' ')) continue;
    word[used++] = space ? ' ' : capital(text[i]);
  }
  while (used > 0 && word[used - 1] == ' ') used--;
  word[used] = '\0';
}

/* Text after the name of a parameter on the card; NULL if it is absent. */
static const char *find_parameter(const mesh_card *card, const char *parameter) {
  size_t n = strlen(parameter);
  for (const char *at = strchr(card->text, ','); at; at = strchr(at, ',')) {
    at += 1 + strspn(at + 1, " \t");
    if (strncasecmp(at, parameter, n) != 0) continue;
    const char *rest = at + n + strspn(at + n, " \t");
    if (*rest == '=' || *rest == ',' || *rest == '\0') return rest;
  }
  return NULL;
}

/* Length of the value of a parameter, which begins at *value; 0: none. */
static size_t find_value(const mesh_card *card, const char *parameter, const char **value) {
  static const char quotes[] = "\"'";
  const char       *at       = find_parameter(card, parameter);
  if (!at || *at != '=') return 0;
  at += 1 + strspn(at + 1, " \t");
  const bool quoted = *at && strchr(quotes, *at);
  const char end[]  = {quoted ? *at : ',', '\0'};
  at += quoted;
  size_t n = strcspn(at, end);
  while (n > 0 && isspace((unsigned char)at[n - 1])) n--;
  *value = at;
  return n;
}

shb_status mesh_deck_include(mesh_deck *deck, const mesh_card *card) {
  enum { MOST = 4096 };
  const char *name = "";
  const int   n    = (int)find_value(card, "INPUT", &name);
  int         at   = -1;
  MESH_DECK_CHECK(n > 0, deck, card->line, "*%s: names no file; give INPUT=FILE", card->word);
  MESH_DECK_CHECK(!deck->pushed_back, deck, card->line, "*%s: ends with a comma; leave it out",
                  card->word);
  SHB_TRY(mesh_files_add(&deck->files, mesh_place_file(deck, card->line), name, (size_t)n, &at));
  if (at < 0) SHB_TRY(mesh_files_add(&deck->files, deck->path, name, (size_t)n, &at));
  MESH_DECK_CHECK(at >= 0, deck, card->line, "*%s: '%.*s' is no file that can be read", card->word,
                  n, name);
  for (int i = 0; i < deck->depth; i++)
    MESH_DECK_CHECK(deck->level[i].at != at, deck, card->line, "*%s: '%.*s' includes itself",
                    card->word, n, name);
  MESH_DECK_CHECK(deck->depth < MESH_DECK_DEPTH && deck->n_included < MOST, deck, card->line,
                  "*%s: files include each other %d deep, %d in all; %d and %d are allowed",
                  card->word, deck->depth, deck->n_included, MESH_DECK_DEPTH - 1, MOST);
  deck->n_included++;
  return push(deck, at);
}

/* Read on in the file of an *INCLUDE line. found: is it one? */
static shb_status include_line(mesh_deck *deck, bool *found) {
  mesh_card    card = {.line = deck->line};
  const size_t n    = strcspn(deck->text, ",");
  take_word(deck->text + 1, n ? n - 1 : 0, card.word);
  *found = deck->text[0] == '*' && strcmp(card.word, "INCLUDE") == 0;
  if (!*found) return SHB_OK;
  snprintf(card.text, sizeof card.text, "%s", deck->text + n);
  return mesh_deck_include(deck, &card);
}

/* Read the next line that is neither empty nor a comment into deck->text. found: false at the
 * end. */
static shb_status next_line(mesh_deck *deck, bool *found) {
  *found = true;
  if (deck->pushed_back) {
    deck->pushed_back = false;
    return SHB_OK;
  }
  while (deck->depth > 0) {
    mesh_deck_level *level = &deck->level[deck->depth - 1];
    const ssize_t    n     = getdelim(&deck->text, &deck->size, level->end, level->file);
    SHB_CHECK(!ferror(level->file), SHB_ERR_IO, "%s: cannot be read: %s",
              deck->files.path[level->at], strerror(errno));
    if (n < 0) {
      pop(deck);
      continue;
    }
    deck->line = ((mesh_place)level->at << 32) + ++level->line;
    MESH_DECK_CHECK(memchr(deck->text, '\0', (size_t)n) == NULL, deck, deck->line,
                    "holds a zero byte; not a text file");
    char *start = trim(deck->text);
    memmove(deck->text, start, strlen(start) + 1);
    bool other = false;
    SHB_TRY(include_line(deck, &other));
    if (!other && deck->text[0] && strncmp(deck->text, "**", 2) != 0) return SHB_OK;
  }
  *found = false;
  return SHB_OK;
}

static shb_status read_card(mesh_deck *deck, mesh_card *card, bool *found) {
  do SHB_TRY(next_line(deck, found));
  while (*found && deck->text[0] != '*');
  if (!*found) return SHB_OK;
  card->line = deck->line;
  size_t n   = strcspn(deck->text, ",");
  take_word(deck->text + 1, n - 1, card->word);
  card->text[0] = '\0';
  for (const char *part = deck->text + n;; part = deck->text) {
    size_t used = strlen(card->text);
    MESH_DECK_CHECK(used + strlen(part) + 1 < sizeof card->text, deck, card->line,
                    "*%s: its keyword line is too long", card->word);
    memcpy(card->text + used, part, strlen(part) + 1);
    used = strlen(card->text);
    if (used == 0 || card->text[used - 1] != ',') return SHB_OK;
    bool more;
    SHB_TRY(next_line(deck, &more));
    if (!more) return SHB_OK;
    deck->pushed_back = deck->text[0] == '*';
    if (deck->pushed_back) return SHB_OK;
  }
}

shb_status mesh_deck_card(mesh_deck *deck, mesh_card *card, bool *found) {
  SHB_TRY(read_card(deck, card, found));
  const bool mesh =
      *found && (strcmp(card->word, "NODE") == 0 || strcmp(card->word, "ELEMENT") == 0);
  return mesh && mesh_card_has(card, "INPUT") ? mesh_deck_include(deck, card) : SHB_OK;
}

shb_status mesh_deck_row(mesh_deck *deck, mesh_row *row, bool *found) {
  row->n = 0;
  SHB_TRY(next_line(deck, found));
  if (!*found) return SHB_OK;
  row->line         = deck->line;
  deck->pushed_back = deck->text[0] == '*';
  *found            = !deck->pushed_back;
  for (char *at = deck->text, *end; *found && at; at = end ? end + 1 : NULL) {
    end = strchr(at, ',');
    if (end) *end = '\0';
    if (!end && !*trim(at)) break;
    MESH_DECK_CHECK(row->n < MESH_DECK_FIELDS, deck, row->line, "more than %d values in a row",
                    MESH_DECK_FIELDS);
    row->field[row->n++] = trim(at);
  }
  return SHB_OK;
}

bool mesh_card_has(const mesh_card *card, const char *parameter) {
  return find_parameter(card, parameter) != NULL;
}

shb_status mesh_card_value(const mesh_deck *deck, const mesh_card *card, const char *parameter,
                           char value[MESH_DECK_NAME]) {
  const char  *at = "";
  const size_t n  = find_value(card, parameter, &at);
  MESH_DECK_CHECK(n < MESH_DECK_NAME, deck, card->line, "*%s: %s: a name of more than %d letters",
                  card->word, parameter, MESH_DECK_NAME - 1);
  memcpy(value, at, n);
  value[n] = '\0';
  return SHB_OK;
}

bool mesh_deck_numeric(const char *field) {
  return *field && (isdigit((unsigned char)*field) || strchr("+-.", *field));
}

shb_status mesh_deck_number(const mesh_deck *deck, const char *field, long *number) {
  enum { MOST = 999999999 }; /* as in Abaqus; instances raise numbers */
  char *end = NULL;
  errno     = 0;
  *number   = strtol(field, &end, 10);
  MESH_DECK_CHECK(*field && !*end && errno == 0 && *number > 0 && *number <= MOST, deck, deck->line,
                  "'%.40s' is not a number of a node or an element (1 to %d)", field, MOST);
  return SHB_OK;
}

shb_status mesh_deck_real(const mesh_deck *deck, const char *field, double *value) {
  char   text[64];
  size_t n    = strlen(field);
  bool   good = n > 0 && n < sizeof text && strspn(field, "0123456789+-.eEdD") == n;
  if (good) {
    char *end = NULL;
    for (size_t i = 0; i <= n; i++) text[i] = strchr("dD", field[i]) && field[i] ? 'e' : field[i];
    *value = strtod(text, &end);
    good   = !*end && isfinite(*value);
  }
  MESH_DECK_CHECK(good, deck, deck->line, "'%.40s' is not a number", field);
  return SHB_OK;
}
