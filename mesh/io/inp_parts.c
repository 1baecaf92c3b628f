#include "mesh/io/inp_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"

static const mesh_inp_map identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

static void make_unit(double v[3]) {
  const double length = vec3_norm(v);
  for (int i = 0; i < 3; i++) v[i] /= length;
}

/* Read a row of at most `most` numbers; value[most] <- 0 beyond them. n: 0 without a row. */
static shb_status read_numbers(mesh_deck *deck, int most, double *value, int *n) {
  mesh_row row;
  bool     found;
  for (int i = 0; i < most; i++) value[i] = 0;
  SHB_TRY(mesh_deck_row(deck, &row, &found));
  *n = found ? row.n : 0;
  MESH_DECK_CHECK(*n <= most, deck, row.line, "%d values; at most %d are expected", *n, most);
  for (int i = 0; i < *n; i++)
    if (*row.field[i]) SHB_TRY(mesh_deck_real(deck, row.field[i], &value[i]));
  return SHB_OK;
}

static shb_status begin_part(mesh_inp_model *m, const mesh_card *card) {
  mesh_inp_part *part   = shb_alloc_zeroed(1, sizeof *part);
  m->part               = shb_realloc(m->part, (size_t)m->n_parts + 1, sizeof(mesh_inp_part *));
  m->part[m->n_parts++] = part;
  m->inp                = &part->table;
  m->has_system         = false;
  SHB_TRY(mesh_card_value(m->deck, card, "NAME", part->name));
  for (int i = 0; i + 1 < m->n_parts; i++)
    MESH_DECK_CHECK(strcasecmp(m->part[i]->name, part->name) != 0, m->deck, card->line,
                    "*PART: there are two of the name '%s'", part->name);
  return SHB_OK;
}

/* Turn by an angle, rad, about the axis from a to b: x' = a + R (x - a). */
static mesh_inp_map turn_about(const double a[3], const double b[3], double angle) {
  mesh_inp_map map = identity;
  double       e[3];
  vec3_minus(b, a, e);
  make_unit(e);
  const double c = cos(angle), s = sin(angle);
  const double cross[3][3] = {{0, -e[2], e[1]}, {e[2], 0, -e[0]}, {-e[1], e[0], 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      map.axes[i][j] = (i == j ? c : 0) + s * cross[i][j] + (1 - c) * e[i] * e[j];
  for (int i = 0; i < 3; i++) {
    map.origin[i] = a[i];
    for (int j = 0; j < 3; j++) map.origin[i] -= map.axes[i][j] * a[j];
  }
  return map;
}

/* A row of a translation, and one of a rotation after it: two points of its axis, angle in
 * degrees. */
static shb_status read_placement(mesh_inp_model *m, const mesh_card *card, mesh_inp_map *map) {
  double move[3], turn[7];
  int    n;
  *map = identity;
  SHB_TRY(read_numbers(m->deck, 3, move, &n));
  if (n == 0) return SHB_OK;
  SHB_TRY(read_numbers(m->deck, 7, turn, &n));
  MESH_DECK_CHECK(n == 0 || n == 7, m->deck, card->line,
                  "*INSTANCE: its rotation has %d values; expected two points and an angle", n);
  if (n == 7) {
    MESH_DECK_CHECK(vec3_distance(turn, turn + 3) > 0, m->deck, card->line,
                    "*INSTANCE: the two points of its axis of rotation are one");
    *map = turn_about(turn, turn + 3, turn[6] * SHB_PI / 180);
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) map->origin[i] += map->axes[i][j] * move[j];
  return SHB_OK;
}

/* Numbers of an instance go on after those that are there. */
static void raise_numbers(const mesh_inp *whole, mesh_inp_instance *instance) {
  instance->node    = whole->top_node;
  instance->element = whole->top_element;
}

static shb_status begin_instance(mesh_inp_model *m, const mesh_card *card) {
  mesh_inp_instance *instance;
  char               name[MESH_DECK_NAME];
  const mesh_inp    *table = NULL;
  m->instance = shb_realloc(m->instance, (size_t)m->n_instances + 1, sizeof *m->instance);
  instance    = &m->instance[m->n_instances++];
  *instance   = (mesh_inp_instance){0};
  SHB_TRY(mesh_card_value(m->deck, card, "NAME", instance->name));
  SHB_TRY(mesh_card_value(m->deck, card, "PART", name));
  for (int i = 0; i < m->n_parts; i++)
    if (strcasecmp(m->part[i]->name, name) == 0) table = &m->part[i]->table;
  MESH_DECK_CHECK(table, m->deck, card->line, "*INSTANCE: there is no *PART '%s' before it", name);
  raise_numbers(m->whole, instance);
  for (int i = 0; i + 1 < m->n_instances; i++)
    MESH_DECK_CHECK(strcasecmp(m->instance[i].name, instance->name) != 0, m->deck, card->line,
                    "*INSTANCE: there are two of the name '%s'", instance->name);
  SHB_TRY(read_placement(m, card, &instance->map));
  mesh_inp_append(m->whole, table, instance);
  m->inside = m->n_instances - 1;
  return SHB_OK;
}

/* Origin and a point on the x axis; then a point in the xy plane. Without it the system turns about
 * z alone. Without any row the system is off. */
static shb_status read_system(mesh_inp_model *m, const mesh_card *card) {
  double row[6], third[3], x[3], y[3], z[3] = {0, 0, 1};
  int    n, more = 0;
  SHB_TRY(read_numbers(m->deck, 6, row, &n));
  if (n > 0) SHB_TRY(read_numbers(m->deck, 3, third, &more));
  m->has_system = n > 0;
  m->system     = identity;
  memcpy(m->system.origin, row, sizeof m->system.origin);
  if (n <= 3) return SHB_OK;
  vec3_minus(row + 3, row, x);
  vec3_minus(third, row, y);
  if (more > 0) vec3_cross(x, y, z);
  vec3_cross(z, x, y);
  MESH_DECK_CHECK(vec3_norm(x) > 0 && vec3_norm(z) > 0 && vec3_norm(y) > 0, m->deck, card->line,
                  "*SYSTEM: its points lie on a line");
  make_unit(x);
  make_unit(y);
  vec3_cross(x, y, z);
  for (int i = 0; i < 3; i++) {
    m->system.axes[i][0] = x[i];
    m->system.axes[i][1] = y[i];
    m->system.axes[i][2] = z[i];
  }
  return SHB_OK;
}

shb_status mesh_inp_parts_card(mesh_inp_model *m, const mesh_card *card, bool *known) {
  *known = true;
  if (strcmp(card->word, "PART") == 0) return begin_part(m, card);
  if (strcmp(card->word, "INSTANCE") == 0) return begin_instance(m, card);
  if (strcmp(card->word, "SYSTEM") == 0) return read_system(m, card);
  if (strcmp(card->word, "END INSTANCE") == 0) {
    m->inside     = -1;
    m->has_system = false;
  } else if (strcmp(card->word, "END PART") == 0) {
    m->inp        = m->whole;
    m->has_system = false;
  } else {
    *known = false;
  }
  return SHB_OK;
}

shb_status mesh_inp_parts_of(mesh_inp_model *m, const mesh_card *card,
                             const mesh_inp_instance **instance) {
  const bool defines = strcmp(card->word, "NODE") == 0 || strcmp(card->word, "ELEMENT") == 0;
  char       name[MESH_DECK_NAME];
  if (defines && m->inp == m->whole && m->inside < 0 && m->n_raised < m->n_instances) {
    raise_numbers(m->whole, &m->own);
    m->n_raised = m->n_instances;
  }
  static const mesh_inp_instance none = {0};
  const mesh_inp_instance       *own  = m->inp == m->whole ? &m->own : &none;
  *instance                           = m->inside >= 0 ? &m->instance[m->inside] : own;
  SHB_TRY(mesh_card_value(m->deck, card, "INSTANCE", name));
  if (!name[0]) return SHB_OK;
  for (int i = 0; i < m->n_instances; i++)
    if (strcasecmp(m->instance[i].name, name) == 0) *instance = &m->instance[i];
  MESH_DECK_CHECK((*instance)->name[0], m->deck, card->line,
                  "*%s: there is no *INSTANCE '%s' before it", card->word, name);
  return SHB_OK;
}

shb_status mesh_inp_parts_end(mesh_inp_model *m) {
  SHB_CHECK(m->n_parts < 2 || m->n_instances > 0, SHB_ERR_INPUT,
            "%s: has %d parts, but no *INSTANCE that places them", m->deck->path, m->n_parts);
  if (m->n_parts == 1 && m->n_instances == 0)
    mesh_inp_append(m->whole, &m->part[0]->table, &(mesh_inp_instance){.map = identity});
  mesh_inp_share_names(m->whole);
  return SHB_OK;
}

void mesh_inp_parts_free(mesh_inp_model *m) {
  for (int i = 0; i < m->n_parts; i++) {
    mesh_inp_free(&m->part[i]->table);
    free(m->part[i]);
  }
  free(m->part);
  free(m->instance);
}
