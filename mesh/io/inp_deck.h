/* Keyword files of Abaqus and CalculiX (.inp) as cards: a keyword line and the rows below it. */
#ifndef MESH_IO_INP_DECK_H
#define MESH_IO_INP_DECK_H

#include <stdbool.h>
#include <stdio.h>

#include "mesh/base/status.h"
#include "mesh/gmsh/script_files.h"

enum { MESH_DECK_FIELDS = 32, MESH_DECK_NAME = 81, MESH_DECK_CARD = 1024, MESH_DECK_DEPTH = 32 };

/* A line of one of the files of a deck: 2^32 times the file's place in the list, plus the line's
 * number, from 1. */
typedef int64_t mesh_place;

/* A file that is being read; those above it include it. */
typedef struct {
  FILE *file;
  int   at;   /* in the list of files */
  long  line; /* its number, from 1 */
  int   end;  /* line ending: LF (also CR LF), or CR */
} mesh_deck_level;

typedef struct {
  const char     *path;
  mesh_file_list  files; /* this one, and those that it includes */
  int             depth, n_included;
  mesh_deck_level level[MESH_DECK_DEPTH]; /* [depth] */
  char           *text;                   /* current line without its ending */
  size_t          size;
  long long       bytes;       /* of all files */
  mesh_place      line;        /* the current one */
  bool            pushed_back; /* it is to be read again */
} mesh_deck;

/* "*NSET, NSET=root, GENERATE" */
typedef struct {
  mesh_place line;
  char       word[MESH_DECK_NAME]; /* keyword in capitals: "NSET" */
  char       text[MESH_DECK_CARD]; /* ", NSET=root, GENERATE" */
} mesh_card;

typedef struct {
  mesh_place line;
  int        n;
  char      *field
      [MESH_DECK_FIELDS]; /* [n] in deck->text, without spaces around; valid until the next row */
} mesh_row;

/* All functions below report errors as "path:line: text", with the path of the file that has the
 * line. SHB_ERR_IO unreadable; SHB_ERR_INPUT otherwise. */
shb_status mesh_deck_open(const char *path, mesh_deck *deck);
void       mesh_deck_close(mesh_deck *deck); /* also on a zeroed struct */

/* Read the next card; the remaining rows of the current card are skipped. A keyword line that ends
 * with a comma continues on the next line. Lines that begin with two asterisks are comments. The
 * text of a file that is included stands in place of its *INCLUDE. The INPUT of *NODE and *ELEMENT
 * stands in place of their rows.
 *   found  out  false at the end of the file */
shb_status mesh_deck_card(mesh_deck *deck, mesh_card *card, bool *found);

/* Go on with the file that the parameter INPUT of the card names, and with this one after it. The
 * file is taken from the folder of the file that names it, or else from that of the deck. */
shb_status mesh_deck_include(mesh_deck *deck, const mesh_card *card);

/* Read the next row of the card. Empty lines and an empty last field are skipped.
 *   found  out  false if the card has no more rows */
shb_status mesh_deck_row(mesh_deck *deck, mesh_row *row, bool *found);

/* Does the card have a parameter (in capitals), with or without a value? */
bool mesh_card_has(const mesh_card *card, const char *parameter);

/* Value of a parameter without quotes; "" if it is absent or has none. SHB_ERR_INPUT if too
 * long. */
shb_status mesh_card_value(const mesh_deck *deck, const mesh_card *card, const char *parameter,
                           char value[MESH_DECK_NAME]);

/* A field as the positive number of a node or element, or as a finite real number (1.5, 2e-3,
 * 1.D+2). */
shb_status mesh_deck_number(const mesh_deck *deck, const char *field, long *number);
shb_status mesh_deck_real(const mesh_deck *deck, const char *field, double *value);

/* Does the field begin like a number rather than a name? */
bool mesh_deck_numeric(const char *field);

const char *mesh_place_file(const mesh_deck *deck, mesh_place place);
long        mesh_place_line(mesh_place place);

/* SHB_FAIL with "path:line: " before the text. */
#define MESH_DECK_FAIL(deck, at, ...) \
  return mesh_deck_fail((deck), (at), __FILE__, __LINE__, __VA_ARGS__)
#define MESH_DECK_CHECK(cond, deck, at, ...)                \
  do {                                                      \
    if (!(cond)) MESH_DECK_FAIL((deck), (at), __VA_ARGS__); \
  } while (0)
shb_status mesh_deck_fail(const mesh_deck *deck, mesh_place line, const char *source, int at,
                          const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
