/* Keyword files of Abaqus and CalculiX (.inp) as cards: a keyword line and the rows of values below it. */
#ifndef MESH_IO_INP_DECK_H
#define MESH_IO_INP_DECK_H

#include <stdbool.h>
#include <stdio.h>

#include "mesh/base/status.h"

enum { MESH_DECK_FIELDS = 32, MESH_DECK_NAME = 81, MESH_DECK_CARD = 1024 };

typedef struct {
  const char *path;
  FILE       *file;
  char       *text; /* the line in hand, without its end */
  size_t      size;
  long        line;        /* its number, from 1 */
  bool        pushed_back; /* it was looked at but not taken */
  int         end;         /* what ends a line: LF (also CR LF), or CR */
} mesh_deck;

/* "*NSET, NSET=root, GENERATE" */
typedef struct {
  long line;
  char word[MESH_DECK_NAME]; /* keyword in capitals: "NSET" */
  char text[MESH_DECK_CARD]; /* ", NSET=root, GENERATE" */
} mesh_card;

typedef struct {
  long  line;
  int   n;
  char *field
      [MESH_DECK_FIELDS]; /* in the deck's text, without spaces around them; good until the next row */
} mesh_row;

/* Errors of all of these: "path:line: what is wrong". SHB_ERR_IO unreadable, no memory; SHB_ERR_INPUT the rest. */
shb_status mesh_deck_open(const char *path, mesh_deck *deck);
void       mesh_deck_close(mesh_deck *deck); /* also on a zeroed struct */

/* The next card; what is left of the card before it is passed over. A keyword line that ends with a comma goes on in
 * the next one; lines that begin with two asterisks are comments. *found: false at the end of the file. */
shb_status mesh_deck_card(mesh_deck *deck, mesh_card *card, bool *found);

/* The card's next row; empty lines and a last empty field are passed over. *found: false when it has no more. */
shb_status mesh_deck_row(mesh_deck *deck, mesh_row *row, bool *found);

/* Has the card a parameter (in capitals), with or without a value? */
bool mesh_card_has(const mesh_card *card, const char *parameter);

/* Its value without quotes; "" if it is absent or has none. SHB_ERR_INPUT if too long. */
shb_status mesh_card_value(const mesh_deck *deck, const mesh_card *card, const char *parameter,
                           char value[MESH_DECK_NAME]);

/* A field as a positive number of a node or an element, or as a finite real number (1.5, 2e-3, 1.D+2). */
shb_status mesh_deck_number(const mesh_deck *deck, const char *field, long *number);
shb_status mesh_deck_real(const mesh_deck *deck, const char *field, double *value);

/* Does the field begin like a number (so that it is no name)? */
bool mesh_deck_numeric(const char *field);

/* SHB_FAIL with "path:line: " before the text. */
#define MESH_DECK_FAIL(deck, at, ...) \
  return mesh_deck_fail((deck), (at), __FILE__, __LINE__, __VA_ARGS__)
#define MESH_DECK_CHECK(cond, deck, at, ...)                \
  do {                                                      \
    if (!(cond)) MESH_DECK_FAIL((deck), (at), __VA_ARGS__); \
  } while (0)
shb_status mesh_deck_fail(const mesh_deck *deck, long line, const char *source, int at,
                          const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
