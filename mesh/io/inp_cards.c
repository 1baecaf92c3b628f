#include "mesh/io/inp_cards.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

typedef struct {
  const char *name;
  int         n;    /* nodes; 0: marks a line only, skipped */
  bool        face; /* marks a face; no membrane or shell is computed */
} element_type;

static const element_type types[] = {
    {"C3D10", 10, false},  {"C3D10M", 10, false}, {"C3D10T", 10, false}, {"C3D20", 20, false},
    {"C3D20R", 20, false}, {"S6", 6, true},       {"STRI65", 6, true},   {"M3D6", 6, true},
    {"SFM3D6", 6, true},   {"CPS6", 6, true},     {"CPE6", 6, true},     {"S8", 8, true},
    {"S8R", 8, true},      {"M3D8", 8, true},     {"M3D8R", 8, true},    {"SFM3D8", 8, true},
    {"CPS8", 8, true},     {"CPS8R", 8, true},    {"CPE8", 8, true},     {"T3D2", 0, false},
    {"T3D3", 0, false}};

static shb_status read_nodes(mesh_deck *deck, const mesh_card *card, mesh_inp *inp) {
  char name[MESH_DECK_NAME];
  int  set = -1;
  MESH_DECK_CHECK(!mesh_card_has(card, "INPUT") && !mesh_card_has(card, "SYSTEM"), deck, card->line,
                  "*NODE with %s is not supported; write rectangular coordinates into the file",
                  mesh_card_has(card, "INPUT") ? "INPUT" : "SYSTEM");
  SHB_TRY(mesh_card_value(deck, card, "NSET", name));
  if (name[0]) set = mesh_inp_open_set(inp, MESH_INP_NSET, name, true, card->line);
  mesh_row row;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_row(deck, &row, &more));
    if (!more) return SHB_OK;
    MESH_DECK_CHECK(row.n == 4, deck, row.line,
                    "*NODE: %d values; a node is its number and three coordinates", row.n);
    mesh_inp_node node = {.line = row.line};
    SHB_TRY(mesh_deck_number(deck, row.field[0], &node.id));
    for (int d = 0; d < 3; d++) SHB_TRY(mesh_deck_real(deck, row.field[1 + d], &node.at[d]));
    mesh_inp_add_node(inp, &node);
    if (set >= 0) mesh_inp_add_member(&inp->set[set], &(mesh_inp_member){node.id, row.line, 0});
  }
}

static shb_status find_type(const mesh_deck *deck, const mesh_card *card,
                            const element_type **type) {
  char name[MESH_DECK_NAME];
  SHB_TRY(mesh_card_value(deck, card, "TYPE", name));
  for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
    *type = &types[i];
    if (strcasecmp(name, types[i].name) == 0) return SHB_OK;
  }
  bool linear = strcasecmp(name, "C3D4") == 0 || strncasecmp(name, "C3D8", 4) == 0;
  MESH_DECK_FAIL(deck, card->line,
                 "*ELEMENT: type %s is not supported; C3D10 and C3D20(R) are%s (S6 and S8 may mark "
                 "faces)",
                 name[0] ? name : "(none)", linear ? ": second order is needed" : "");
}

/* Read one element, which may continue over several rows. found: false at the end of the card. */
static shb_status read_element(mesh_deck *deck, const element_type *type, mesh_inp_element *element,
                               bool *found) {
  mesh_row row;
  int      have = -1; /* -1: the element's number comes first */
  do {
    SHB_TRY(mesh_deck_row(deck, &row, found));
    if (!*found && have < 0) return SHB_OK;
    MESH_DECK_CHECK(*found, deck, element->line, "*ELEMENT: element %ld has %d nodes, %s needs %d",
                    element->id, have, type->name, type->n);
    for (int i = 0; i < row.n; i++, have++) {
      long number;
      SHB_TRY(mesh_deck_number(deck, row.field[i], &number));
      MESH_DECK_CHECK(have < type->n, deck, row.line, "*ELEMENT: more than the %d nodes of a %s",
                      type->n, type->name);
      if (have < 0) *element = (mesh_inp_element){number, row.line, type->n, type->face, {0}};
      if (have >= 0) element->node[have] = number;
    }
  } while (have < type->n);
  return SHB_OK;
}

static shb_status read_elements(mesh_deck *deck, const mesh_card *card, mesh_inp *inp) {
  const element_type *type;
  char                name[MESH_DECK_NAME];
  int                 set = -1;
  MESH_DECK_CHECK(!mesh_card_has(card, "INPUT"), deck, card->line,
                  "*ELEMENT with INPUT is not supported; write the elements into the file");
  SHB_TRY(find_type(deck, card, &type));
  if (type->n == 0) return SHB_OK;
  SHB_TRY(mesh_card_value(deck, card, "ELSET", name));
  if (name[0]) set = mesh_inp_open_set(inp, MESH_INP_ELSET, name, false, card->line);
  for (bool more = true;;) {
    mesh_inp_element element = {0};
    SHB_TRY(read_element(deck, type, &element, &more));
    if (!more) return SHB_OK;
    mesh_inp_add_element(inp, &element);
    if (set >= 0)
      mesh_inp_add_member(&inp->set[set], &(mesh_inp_member){element.id, element.line, 0});
  }
}

/* Before n members join a set by a range or the name of a set. A set that names itself doubles each
 * time. Every node, element and name takes bytes of the file. */
static shb_status admit(const mesh_deck *deck, mesh_inp *inp, int into, const char *what, long n) {
  enum { MOST_IN_ALL = 16 }; /* a byte */
  MESH_DECK_CHECK(n <= deck->bytes - inp->set[into].n, deck, deck->line,
                  "%s: %ld more members are too many for a file of %lld bytes", what, n,
                  deck->bytes);
  inp->referred += n;
  MESH_DECK_CHECK(inp->referred <= MOST_IN_ALL * deck->bytes, deck, deck->line,
                  "%s: now sets have %lld members in all, too many for a file of %lld bytes", what,
                  inp->referred, deck->bytes);
  return SHB_OK;
}

static shb_status generate(mesh_deck *deck, const mesh_row *row, mesh_inp *inp, int into) {
  long range[3] = {0, 0, 1};
  MESH_DECK_CHECK(row->n == 2 || row->n == 3, deck, row->line,
                  "GENERATE: %d values; expected first, last, step", row->n);
  for (int i = 0; i < row->n; i++) SHB_TRY(mesh_deck_number(deck, row->field[i], &range[i]));
  MESH_DECK_CHECK(range[1] >= range[0], deck, row->line, "GENERATE: %ld to %ld counts down",
                  range[0], range[1]);
  long last = (range[1] - range[0]) / range[2];
  SHB_TRY(admit(deck, inp, into, "GENERATE", last + 1));
  for (long i = 0; i <= last; i++)
    mesh_inp_add_member(&inp->set[into], &(mesh_inp_member){range[0] + i * range[2], row->line, 0});
  return SHB_OK;
}

/* Add a member given by number, or all members of a set given by name; face as in
 * mesh_inp_member. */
static shb_status add_named(mesh_deck *deck, mesh_inp *inp, int into, const char *field, int face) {
  mesh_inp_kind   kind   = inp->set[into].of_nodes ? MESH_INP_NSET : MESH_INP_ELSET;
  mesh_inp_member member = {.line = deck->line, .face = face};
  if (mesh_deck_numeric(field)) {
    SHB_TRY(mesh_deck_number(deck, field, &member.id));
    mesh_inp_add_member(&inp->set[into], &member);
    return SHB_OK;
  }
  const mesh_inp_set *from = mesh_inp_find(inp, kind, field);
  MESH_DECK_CHECK(from, deck, deck->line, "%s '%.40s' is not defined before this line",
                  kind == MESH_INP_NSET ? "node set" : "element set", field);
  SHB_TRY(admit(deck, inp, into, inp->set[into].name, from->n));
  for (int i = 0, n = from->n; i < n; i++) {
    member.id = from->member[i].id;
    mesh_inp_add_member(&inp->set[into], &member);
  }
  return SHB_OK;
}

static shb_status read_set(mesh_deck *deck, const mesh_card *card, mesh_inp_kind kind,
                           mesh_inp *inp) {
  const char *word = kind == MESH_INP_NSET ? "NSET" : "ELSET";
  char        name[MESH_DECK_NAME];
  SHB_TRY(mesh_card_value(deck, card, word, name));
  MESH_DECK_CHECK(name[0], deck, card->line, "*%s without a name (%s=...)", word, word);
  const int set = mesh_inp_open_set(inp, kind, name, kind == MESH_INP_NSET, card->line);
  mesh_row  row;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_row(deck, &row, &more));
    if (!more) return SHB_OK;
    if (mesh_card_has(card, "GENERATE")) {
      SHB_TRY(generate(deck, &row, inp, set));
      continue;
    }
    for (int i = 0; i < row.n; i++) SHB_TRY(add_named(deck, inp, set, row.field[i], 0));
  }
}

/* Label of a face: "S3", or "SPOS" and "SNEG" for the sides of a triangle. */
static shb_status face_number(const mesh_deck *deck, const mesh_row *row, int *face) {
  const char *label = row->n > 1 ? row->field[1] : "";
  *face             = 0;
  if (strcasecmp(label, "SPOS") == 0 || strcasecmp(label, "SNEG") == 0) return SHB_OK;
  bool good = toupper((unsigned char)label[0]) == 'S' && label[1] >= '1' && label[1] <= '6' &&
              label[2] == '\0';
  MESH_DECK_CHECK(good && row->n == 2, deck, row->line,
                  "*SURFACE: '%s%.20s'; expected an element or element set and one of S1 to S6",
                  row->field[0], row->n > 1 ? "" : " alone");
  *face = label[1] - '0';
  return SHB_OK;
}

static shb_status read_surface(mesh_deck *deck, const mesh_card *card, mesh_inp *inp) {
  char name[MESH_DECK_NAME], type[MESH_DECK_NAME];
  SHB_TRY(mesh_card_value(deck, card, "NAME", name));
  SHB_TRY(mesh_card_value(deck, card, "TYPE", type));
  MESH_DECK_CHECK(name[0], deck, card->line, "*SURFACE without a name (NAME=...)");
  bool nodes = strcasecmp(type, "NODE") == 0;
  if (!nodes && type[0] && strcasecmp(type, "ELEMENT") != 0)
    return SHB_OK; /* other types of surface define no group */
  const int set = mesh_inp_open_set(inp, MESH_INP_SURFACE, name, nodes, card->line);
  mesh_row  row;
  for (bool more = true;;) {
    int face = 0;
    SHB_TRY(mesh_deck_row(deck, &row, &more));
    if (!more) return SHB_OK;
    if (!nodes) SHB_TRY(face_number(deck, &row, &face));
    SHB_TRY(add_named(deck, inp, set, row.field[0], face));
  }
}

/* Refuse the cards that generate or move nodes and elements. */
static shb_status refuse_others(const mesh_deck *deck, const mesh_card *card, int *parts) {
  static const char *const makers[]             = {"NGEN",  "NFILL",  "NCOPY", "NMAP",
                                                   "ELGEN", "ELCOPY", "SYSTEM"};
  char                     file[MESH_DECK_NAME] = "";
  if (strcmp(card->word, "INCLUDE") == 0) {
    SHB_TRY(mesh_card_value(deck, card, "INPUT", file));
    MESH_DECK_FAIL(deck, card->line, "*INCLUDE of '%s': put that file's text here", file);
  }
  for (size_t i = 0; i < sizeof makers / sizeof *makers; i++)
    MESH_DECK_CHECK(strcmp(card->word, makers[i]) != 0, deck, card->line,
                    "*%s is not supported; write the nodes and elements out", card->word);
  if (strcmp(card->word, "PART") == 0)
    MESH_DECK_CHECK((*parts)++ == 0, deck, card->line,
                    "a second *PART; write the model without parts and assemblies");
  return SHB_OK;
}

/* An instance must not move its part. */
static shb_status read_instance(mesh_deck *deck, const mesh_card *card) {
  mesh_row row;
  bool     more;
  SHB_TRY(mesh_deck_row(deck, &row, &more));
  MESH_DECK_CHECK(!more, deck, card->line,
                  "*INSTANCE is moved; write the model without parts and assemblies");
  return SHB_OK;
}

shb_status mesh_inp_cards(mesh_deck *deck, mesh_inp *inp) {
  mesh_card card;
  int       parts = 0;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_card(deck, &card, &more));
    if (!more) return SHB_OK;
    SHB_TRY(refuse_others(deck, &card, &parts));
    if (strcmp(card.word, "NODE") == 0) SHB_TRY(read_nodes(deck, &card, inp));
    if (strcmp(card.word, "ELEMENT") == 0) SHB_TRY(read_elements(deck, &card, inp));
    if (strcmp(card.word, "NSET") == 0) SHB_TRY(read_set(deck, &card, MESH_INP_NSET, inp));
    if (strcmp(card.word, "ELSET") == 0) SHB_TRY(read_set(deck, &card, MESH_INP_ELSET, inp));
    if (strcmp(card.word, "SURFACE") == 0) SHB_TRY(read_surface(deck, &card, inp));
    if (strcmp(card.word, "INSTANCE") == 0) SHB_TRY(read_instance(deck, &card));
  }
}
