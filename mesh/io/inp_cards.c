#include "mesh/io/inp_cards.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/constants.h"
#include "mesh/io/inp_parts.h"

typedef struct {
  const char *name;
  int         n;    /* nodes; 0: marks a line only, skipped */
  bool        face; /* marks a face; no membrane or shell is computed */
} element_type;

/* By the beginning of their names; what follows (C3D20RH, S8R5) changes nothing of the mesh. */
static const element_type types[] = {
    {"C3D10", 10, false}, {"C3D20", 20, false}, {"S6", 6, true},     {"STRI65", 6, true},
    {"M3D6", 6, true},    {"SFM3D6", 6, true},  {"CPS6", 6, true},   {"CPE6", 6, true},
    {"S8", 8, true},      {"M3D8", 8, true},    {"SFM3D8", 8, true}, {"CPS8", 8, true},
    {"CPE8", 8, true},    {"T3D2", 0, false},   {"T3D3", 0, false}};

/* What a card of the mesh goes into. */
typedef struct {
  mesh_inp_model          *model;
  mesh_deck               *deck;
  const mesh_card         *card;
  mesh_inp                *inp;
  const mesh_inp_instance *of; /* raises its numbers */
} reader;

/* The set that the card names by a parameter, made if absent; -1: it names none. In the block of an
 * instance the set is its own. */
static shb_status open_set(const reader *r, const char *parameter, mesh_inp_kind kind,
                           bool of_nodes, int *set) {
  const mesh_inp_model *m = r->model;
  char                  name[MESH_DECK_NAME], whole[MESH_INP_NAME];
  SHB_TRY(mesh_card_value(r->deck, r->card, parameter, name));
  snprintf(whole, sizeof whole, "%s%s%s", m->inside >= 0 ? m->instance[m->inside].name : "",
           m->inside >= 0 ? "." : "", name);
  *set = name[0] ? mesh_inp_open_set(r->inp, kind, whole, of_nodes, r->card->line) : -1;
  return SHB_OK;
}

/* A set that an earlier card has named, that of the card's own instance before others. */
static const mesh_inp_set *find_set(const reader *r, mesh_inp_kind kind, const char *name) {
  char whole[MESH_INP_NAME];
  snprintf(whole, sizeof whole, "%s.%s", r->of->name, name);
  const mesh_inp_set *own = *r->of->name ? mesh_inp_find_whole(r->inp, kind, whole) : NULL;
  if (own) return own;
  /* one of several instances does not take the set of another one */
  return r->model->n_instances > 1 && (*r->of->name || strchr(name, '.'))
             ? mesh_inp_find_whole(r->inp, kind, name)
             : mesh_inp_find(r->inp, kind, name);
}

/* A row (number, R, theta in degrees, z) in rectangular coordinates; spherical: theta, phi. */
static void from_polar(const char *system, double at[3]) {
  const double radius = at[0], theta = at[1] * SHB_PI / 180, phi = at[2] * SHB_PI / 180;
  const bool   sphere = toupper((unsigned char)system[0]) == 'S';
  const double flat   = sphere ? radius * cos(phi) : radius;
  at[0]               = flat * cos(theta);
  at[1]               = flat * sin(theta);
  if (sphere) at[2] = radius * sin(phi);
}

static shb_status read_nodes(const reader *r) {
  mesh_deck *deck = r->deck;
  char       system[MESH_DECK_NAME];
  int        set;
  SHB_TRY(mesh_card_value(deck, r->card, "SYSTEM", system));
  SHB_TRY(open_set(r, "NSET", MESH_INP_NSET, true, &set));
  MESH_DECK_CHECK(!system[0] || (!system[1] && strchr("RrCcSs", system[0])), deck, r->card->line,
                  "*NODE: SYSTEM=%s; expected R, C or S", system);
  mesh_row row;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_row(deck, &row, &more));
    if (!more) return SHB_OK;
    MESH_DECK_CHECK(row.n == 4, deck, row.line,
                    "*NODE: %d values; a node is its number and three coordinates", row.n);
    mesh_inp_node node = {.line = row.line};
    SHB_TRY(mesh_deck_number(deck, row.field[0], &node.id));
    for (int d = 0; d < 3; d++) SHB_TRY(mesh_deck_real(deck, row.field[1 + d], &node.at[d]));
    if (system[0] && !strchr("Rr", system[0])) from_polar(system, node.at);
    if (r->model->has_system) mesh_inp_map_point(&r->model->system, node.at);
    if (r->model->inside >= 0)
      mesh_inp_map_point(&r->model->instance[r->model->inside].map, node.at);
    node.id += r->of->node;
    mesh_inp_add_node(r->inp, &node);
    if (set >= 0)
      mesh_inp_add_member(&r->inp->set[set], &(mesh_inp_member){node.id, row.line, 0, false});
  }
}

static shb_status find_type(const mesh_deck *deck, const mesh_card *card,
                            const element_type **type) {
  char name[MESH_DECK_NAME];
  SHB_TRY(mesh_card_value(deck, card, "TYPE", name));
  for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
    const size_t n = strlen(types[i].name);
    *type          = &types[i];
    if (strncasecmp(name, types[i].name, n) == 0 && !isdigit((unsigned char)name[n])) return SHB_OK;
  }
  bool linear = strcasecmp(name, "C3D4") == 0 || strncasecmp(name, "C3D8", 4) == 0;
  MESH_DECK_FAIL(deck, card->line,
                 "*ELEMENT: type %s is not supported; C3D10 and C3D20 are%s (S6 and S8 may mark "
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

static shb_status read_elements(const reader *r) {
  mesh_deck          *deck = r->deck;
  const element_type *type;
  int                 set;
  SHB_TRY(find_type(deck, r->card, &type));
  if (type->n == 0) return SHB_OK;
  SHB_TRY(open_set(r, "ELSET", MESH_INP_ELSET, false, &set));
  for (bool more = true;;) {
    mesh_inp_element element = {0};
    SHB_TRY(read_element(deck, type, &element, &more));
    if (!more) return SHB_OK;
    element.id += r->of->element;
    for (int i = 0; i < element.n; i++) element.node[i] += r->of->node;
    mesh_inp_add_element(r->inp, &element);
    if (set >= 0)
      mesh_inp_add_member(&r->inp->set[set],
                          &(mesh_inp_member){element.id, element.line, 0, false});
  }
}

/* Before n members join a set by a range or the name of a set. A set that names itself doubles each
 * time. Every node, element and name takes bytes of the file. */
static shb_status admit(const mesh_deck *deck, mesh_inp *inp, int into, const char *what, long n) {
  enum { MOST_IN_ALL = 16 };                                           /* a byte */
  const long long room = deck->bytes + inp->n_nodes + inp->n_elements; /* instances take no bytes */
  MESH_DECK_CHECK(n <= room - inp->set[into].n, deck, deck->line,
                  "%s: %ld more members are too many for a file of %lld bytes", what, n,
                  deck->bytes);
  inp->referred += n;
  MESH_DECK_CHECK(inp->referred <= MOST_IN_ALL * room, deck, deck->line,
                  "%s: now sets have %lld members in all, too many for a file of %lld bytes", what,
                  inp->referred, deck->bytes);
  return SHB_OK;
}

static long raised_by(const reader *r, int set) {
  return r->inp->set[set].of_nodes ? r->of->node : r->of->element;
}

/* Numbers that the file does not have are skipped, as CalculiX skips them. */
static shb_status generate(const reader *r, const mesh_row *row, int into) {
  mesh_deck *deck     = r->deck;
  long       range[3] = {0, 0, 1};
  MESH_DECK_CHECK(row->n == 2 || row->n == 3, deck, row->line,
                  "GENERATE: %d values; expected first, last, step", row->n);
  for (int i = 0; i < row->n; i++) SHB_TRY(mesh_deck_number(deck, row->field[i], &range[i]));
  MESH_DECK_CHECK(range[1] >= range[0], deck, row->line, "GENERATE: %ld to %ld counts down",
                  range[0], range[1]);
  const long last = (range[1] - range[0]) / range[2], first = range[0] + raised_by(r, into);
  SHB_TRY(admit(deck, r->inp, into, "GENERATE", last + 1));
  for (long i = 0; i <= last; i++)
    mesh_inp_add_member(&r->inp->set[into],
                        &(mesh_inp_member){first + i * range[2], row->line, 0, true});
  return SHB_OK;
}

/* Add all members of a set; face as in mesh_inp_member, -1: those that they have. */
static shb_status add_set(const reader *r, int into, mesh_inp_kind kind, const char *name,
                          int face) {
  static const char *const what[] = {"node set", "element set", "surface"};
  const mesh_inp_set      *from   = find_set(r, kind, name);
  MESH_DECK_CHECK(from, r->deck, r->deck->line, "%s '%.40s' is not defined before this line",
                  what[kind], name);
  MESH_DECK_CHECK(from->of_nodes == r->inp->set[into].of_nodes, r->deck, r->deck->line,
                  "'%.40s' is made of nodes, or the other of faces", name);
  SHB_TRY(admit(r->deck, r->inp, into, r->inp->set[into].name, from->n));
  for (int i = 0, n = from->n; i < n; i++) {
    mesh_inp_member member = from->member[i];
    member.line            = r->deck->line;
    if (face >= 0) member.face = face;
    mesh_inp_add_member(&r->inp->set[into], &member);
  }
  return SHB_OK;
}

/* Add a member given by number, or all members of a set given by name. */
static shb_status add_named(const reader *r, int into, const char *field, int face) {
  mesh_inp_member member = {.line = r->deck->line, .face = face};
  if (!mesh_deck_numeric(field))
    return add_set(r, into, r->inp->set[into].of_nodes ? MESH_INP_NSET : MESH_INP_ELSET, field,
                   face);
  SHB_TRY(mesh_deck_number(r->deck, field, &member.id));
  member.id += raised_by(r, into);
  mesh_inp_add_member(&r->inp->set[into], &member);
  return SHB_OK;
}

/* *NSET, ELSET=: the nodes of an element set. */
static shb_status add_nodes_of(const reader *r, int into) {
  char name[MESH_DECK_NAME];
  SHB_TRY(mesh_card_value(r->deck, r->card, "ELSET", name));
  const mesh_inp_set *of = find_set(r, MESH_INP_ELSET, name);
  MESH_DECK_CHECK(of, r->deck, r->card->line, "*NSET: element set '%.40s' is not defined before",
                  name);
  mesh_inp_add_nodes_of(r->inp, into, of);
  return SHB_OK;
}

static shb_status read_set(const reader *r, mesh_inp_kind kind) {
  const char *word = kind == MESH_INP_NSET ? "NSET" : "ELSET";
  int         set;
  SHB_TRY(open_set(r, word, kind, kind == MESH_INP_NSET, &set));
  MESH_DECK_CHECK(set >= 0, r->deck, r->card->line, "*%s without a name (%s=...)", word, word);
  if (kind == MESH_INP_NSET && mesh_card_has(r->card, "ELSET")) return add_nodes_of(r, set);
  mesh_row row;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_row(r->deck, &row, &more));
    if (!more) return SHB_OK;
    if (mesh_card_has(r->card, "GENERATE")) {
      SHB_TRY(generate(r, &row, set));
      continue;
    }
    for (int i = 0; i < row.n; i++) SHB_TRY(add_named(r, set, row.field[i], 0));
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

/* *SURFACE, COMBINE=UNION: rows of surfaces. */
static shb_status read_union(const reader *r, int set) {
  mesh_row row;
  for (bool more = true;;) {
    SHB_TRY(mesh_deck_row(r->deck, &row, &more));
    if (!more) return SHB_OK;
    for (int i = 0; i < row.n; i++) SHB_TRY(add_set(r, set, MESH_INP_SURFACE, row.field[i], -1));
  }
}

static shb_status read_surface(const reader *r) {
  char type[MESH_DECK_NAME], combine[MESH_DECK_NAME];
  int  set;
  SHB_TRY(mesh_card_value(r->deck, r->card, "TYPE", type));
  SHB_TRY(mesh_card_value(r->deck, r->card, "COMBINE", combine));
  const bool nodes = strcasecmp(type, "NODE") == 0;
  if (!nodes && type[0] && strcasecmp(type, "ELEMENT") != 0)
    return SHB_OK; /* other types of surface define no group */
  SHB_TRY(open_set(r, "NAME", MESH_INP_SURFACE, nodes, &set));
  MESH_DECK_CHECK(set >= 0, r->deck, r->card->line, "*SURFACE without a name (NAME=...)");
  if (strcasecmp(combine, "UNION") == 0) return read_union(r, set);
  MESH_DECK_CHECK(!combine[0], r->deck, r->card->line,
                  "*SURFACE: COMBINE=%s is not supported; UNION is, or list the faces", combine);
  mesh_row row;
  for (bool more = true;;) {
    int face = 0;
    SHB_TRY(mesh_deck_row(r->deck, &row, &more));
    if (!more) return SHB_OK;
    if (!nodes) SHB_TRY(face_number(r->deck, &row, &face));
    SHB_TRY(add_named(r, set, row.field[0], face));
  }
}

/* Refuse the cards that generate or move nodes and elements. */
static shb_status refuse_others(const mesh_deck *deck, const mesh_card *card) {
  static const char *const makers[] = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY"};
  for (size_t i = 0; i < sizeof makers / sizeof *makers; i++)
    MESH_DECK_CHECK(strcmp(card->word, makers[i]) != 0, deck, card->line,
                    "*%s is not supported; write the nodes and elements out", card->word);
  return SHB_OK;
}

static shb_status read_card(mesh_inp_model *model, const mesh_card *card) {
  reader r = {.model = model, .deck = model->deck, .card = card};
  bool   known;
  SHB_TRY(mesh_inp_parts_card(model, card, &known));
  if (known) return SHB_OK;
  SHB_TRY(refuse_others(r.deck, card));
  SHB_TRY(mesh_inp_parts_of(model, card, &r.of));
  r.inp = model->inp;
  if (strcmp(card->word, "NODE") == 0) return read_nodes(&r);
  if (strcmp(card->word, "ELEMENT") == 0) return read_elements(&r);
  if (strcmp(card->word, "NSET") == 0) return read_set(&r, MESH_INP_NSET);
  if (strcmp(card->word, "ELSET") == 0) return read_set(&r, MESH_INP_ELSET);
  return strcmp(card->word, "SURFACE") == 0 ? read_surface(&r) : SHB_OK;
}

shb_status mesh_inp_cards(mesh_deck *deck, mesh_inp *inp) {
  mesh_inp_model model = {.deck = deck, .whole = inp, .inp = inp, .inside = -1};
  mesh_card      card;
  bool           more   = true;
  shb_status     status = mesh_deck_card(deck, &card, &more);
  while (status == SHB_OK && more) {
    status = read_card(&model, &card);
    if (status == SHB_OK) status = mesh_deck_card(deck, &card, &more);
  }
  if (status == SHB_OK) status = mesh_inp_parts_end(&model);
  mesh_inp_parts_free(&model);
  return status;
}
