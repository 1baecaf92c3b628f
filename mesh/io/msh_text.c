#include "mesh/io/msh_text.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* gmsh's types that are read or passed over. */
static const struct {
  int    type, dim;
  size_t nodes; /* 0: passed over */
} types[] = {{15, 0, 0}, {1, 1, 0}, {8, 1, 0}, {9, 2, 6}, {16, 2, 8}, {11, 3, 10}, {17, 3, 20}};

/* MOST_MEMBERS: with more members of groups the file goes to gmsh; each is looked at for each block
 * of elements. */
enum { TYPES = sizeof types / sizeof *types, MOST_MEMBERS = 5000 };

static int dim_of(int type) {
  for (int i = 0; i < TYPES; i++)
    if (types[i].type == type) return types[i].dim;
  return -1;
}

size_t mesh_msh_nodes_of(int type) {
  for (int i = 0; i < TYPES; i++)
    if (types[i].type == type) return types[i].nodes;
  return 0;
}

/* ------------------------------------------------------------------ words */

/* Where the reader is. Nothing is read after a fault. */
typedef struct {
  const char *at;
  bool        good;
} cursor;

static void skip_blanks(cursor *c) {
  while (*c->at == ' ' || *c->at == '\t' || *c->at == '\r') c->at++;
}

static void end_line(cursor *c) {
  skip_blanks(c);
  c->good = c->good && *c->at == '\n';
  if (c->good) c->at++;
}

static void skip_line(cursor *c) {
  const char *end = strchr(c->at, '\n');
  c->good         = c->good && end;
  if (c->good) c->at = end + 1;
}

static size_t whole(cursor *c) {
  size_t value = 0;
  skip_blanks(c);
  c->good = c->good && *c->at >= '0' && *c->at <= '9';
  for (; c->good && *c->at >= '0' && *c->at <= '9'; c->at++) {
    value   = 10 * value + (size_t)(*c->at - '0');
    c->good = value < INT_MAX;
  }
  return value;
}

static double real(cursor *c) {
  char *end = NULL;
  skip_blanks(c);
  c->good = c->good && *c->at != '\n';
  if (!c->good) return 0;
  const double value = strtod(c->at, &end);
  c->good            = end != c->at && isfinite(value);
  c->at              = end;
  return value;
}

/* Is the line this word? It is passed over then. */
static bool take_line(cursor *c, const char *word) {
  const size_t length = strlen(word);
  cursor       next   = {c->at + length, true};
  if (strncmp(c->at, word, length) != 0) return false;
  end_line(&next);
  if (!next.good) return false;
  c->at = next.at;
  return true;
}

static void expect_line(cursor *c, const char *word) {
  c->good = c->good && take_line(c, word);
}

/* ------------------------------------------------------------------ lists */

/* Room for count more items beside the n that are there. Doubles, so that a false count in the file
 * does not take memory. */
static void grow(void **list, size_t n, size_t count, size_t size) {
  const size_t least = 64, all = n + count;
  size_t       room = least;
  while (room < n) room *= 2;
  if (*list && all <= room) return;
  while (room < all) room *= 2;
  *list = shb_realloc(*list, room, size);
}

static void add_member(cursor *c, mesh_msh_text *t, int dim, size_t entity, size_t group) {
  c->good = c->good && t->n_members < MOST_MEMBERS;
  if (!c->good) return;
  grow((void **)&t->member, t->n_members, 1, sizeof *t->member);
  t->member[t->n_members++] = (mesh_msh_member){dim, entity, group};
}

/* The block of an element; the last one goes on where it is of the same kind. */
static mesh_msh_block *block_of(cursor *c, mesh_msh_text *t, int type, size_t entity) {
  mesh_msh_block *last = t->n_blocks ? &t->block[t->n_blocks - 1] : NULL;
  if (last && last->type == type && last->entity == entity) return last;
  if (!c->good) return NULL;
  grow((void **)&t->block, t->n_blocks, 1, sizeof *t->block);
  t->block[t->n_blocks] =
      (mesh_msh_block){dim_of(type), type, entity, 0, t->n_tags, t->n_element_nodes};
  return &t->block[t->n_blocks++];
}

/* Nodes of an element to the end of its line. */
static void add_element(cursor *c, mesh_msh_text *t, int type, size_t entity, size_t tag) {
  const size_t each = mesh_msh_nodes_of(type);
  if (each == 0) {
    skip_line(c);
    return;
  }
  mesh_msh_block *block = block_of(c, t, type, entity);
  if (!c->good) return;
  grow((void **)&t->tag, t->n_tags, 1, sizeof *t->tag);
  grow((void **)&t->node, t->n_element_nodes, each, sizeof *t->node);
  t->tag[t->n_tags++] = tag;
  for (size_t i = 0; i < each; i++) t->node[t->n_element_nodes++] = whole(c);
  block->n++;
  end_line(c);
}

static void add_node(cursor *c, mesh_msh_text *t, size_t tag) {
  if (!c->good) return;
  grow((void **)&t->node_tag, t->n_nodes, 1, sizeof *t->node_tag);
  grow((void **)&t->xyz, 3 * t->n_nodes, 3, sizeof *t->xyz);
  t->node_tag[t->n_nodes++] = tag;
}

static void place_node(cursor *c, mesh_msh_text *t, size_t i) {
  for (size_t d = 0; d < 3; d++) {
    const double x = real(c);
    if (c->good) t->xyz[3 * i + d] = x;
  }
  end_line(c);
}

/* ------------------------------------------------------------------ sections */

static void read_format(cursor *c, mesh_msh_text *t) {
  t->version = real(c);
  c->good    = c->good && (t->version == 2.2 || t->version == 4.1) && whole(c) == 0; /* text */
  c->good    = c->good && whole(c) == 8; /* bytes of a number */
  end_line(c);
  expect_line(c, "$EndMeshFormat");
}

static void read_names(cursor *c, mesh_msh_text *t) {
  const size_t n = whole(c);
  end_line(c);
  for (size_t i = 0; i < n && c->good; i++) {
    mesh_msh_name name = {.dim = (int)whole(c)};
    name.group         = whole(c);
    skip_blanks(c);
    c->good             = c->good && *c->at++ == '"';
    const size_t length = c->good ? strcspn(c->at, "\"\n") : 0;
    c->good             = c->good && c->at[length] == '"' && length < MESH_MSH_NAME;
    if (!c->good) return;
    memcpy(name.text, c->at, length);
    c->at += length + 1;
    end_line(c);
    if (!c->good) return;
    grow((void **)&t->name, t->n_names, 1, sizeof name);
    t->name[t->n_names++] = name;
  }
  expect_line(c, "$EndPhysicalNames");
}

static void read_entities(cursor *c, mesh_msh_text *t) {
  size_t n[4];
  for (int dim = 0; dim < 4; dim++) n[dim] = whole(c);
  end_line(c);
  for (int dim = 0; dim < 4; dim++)
    for (size_t i = 0; i < n[dim] && c->good; i++) {
      const size_t entity = whole(c);
      for (int k = 0; k < (dim ? 6 : 3); k++) real(c); /* its box */
      const size_t groups = whole(c);
      add_member(c, t, dim, entity, 0);
      for (size_t k = 0; k < groups && c->good; k++) add_member(c, t, dim, entity, whole(c));
      skip_line(c); /* its boundary */
    }
  expect_line(c, "$EndEntities");
}

static bool is_member(const mesh_msh_text *t, int dim, size_t entity, size_t group) {
  for (size_t i = t->n_members; i-- > 0;) {
    const mesh_msh_member *m = &t->member[i];
    if (m->entity == entity && m->dim == dim && m->group == group) return true;
  }
  return false;
}

static void read_nodes_2(cursor *c, mesh_msh_text *t) {
  const size_t n = whole(c);
  end_line(c);
  for (size_t i = 0; i < n && c->good; i++) {
    add_node(c, t, whole(c));
    place_node(c, t, i);
  }
}

static void read_nodes_4(cursor *c, mesh_msh_text *t) {
  const size_t blocks = whole(c), all = whole(c);
  skip_line(c);
  for (size_t b = 0; b < blocks && c->good; b++) {
    const size_t dim = whole(c), entity = whole(c), parametric = whole(c), n = whole(c);
    const size_t first = t->n_nodes;
    end_line(c);
    c->good = c->good && parametric == 0 && is_member(t, (int)dim, entity, 0);
    for (size_t i = 0; i < n && c->good; i++) {
      add_node(c, t, whole(c));
      end_line(c);
    }
    for (size_t i = first; i < first + n && c->good; i++) place_node(c, t, i);
  }
  c->good = c->good && t->n_nodes == all;
}

/* Lines "tag type 2 group entity nodes". */
static void read_elements_2(cursor *c, mesh_msh_text *t) {
  const size_t n = whole(c);
  end_line(c);
  for (size_t i = 0; i < n && c->good; i++) {
    const size_t tag = whole(c), type = whole(c), tags = whole(c), group = whole(c);
    const size_t entity = whole(c);
    const int    dim    = dim_of((int)type);
    c->good             = c->good && tags == 2 && entity > 0 && dim >= 0;
    add_element(c, t, (int)type, entity, tag);
    if (c->good && !is_member(t, dim, entity, group)) add_member(c, t, dim, entity, group);
  }
}

static void read_elements_4(cursor *c, mesh_msh_text *t) {
  const size_t blocks = whole(c), all = whole(c);
  size_t       read = 0;
  skip_line(c);
  for (size_t b = 0; b < blocks && c->good; b++) {
    const size_t dim = whole(c), entity = whole(c), type = whole(c), n = whole(c);
    end_line(c);
    c->good = c->good && dim_of((int)type) == (int)dim && is_member(t, (int)dim, entity, 0);
    for (size_t i = 0; i < n && c->good; i++, read++)
      add_element(c, t, (int)type, entity, whole(c));
  }
  c->good = c->good && read == all;
}

static void skip_comments(cursor *c) {
  while (c->good && !take_line(c, "$EndComments")) skip_line(c);
}

/* The sections stand once each, in the order in which gmsh writes them. */
static void read_sections(cursor *c, mesh_msh_text *t) {
  enum { FORMAT = 1, NAMES, ENTITIES, NODES, ELEMENTS };
  for (int done = 0; c->good && *c->at;) {
    skip_blanks(c);
    if (*c->at == '\n') {
      end_line(c);
    } else if (take_line(c, "$Comments")) {
      skip_comments(c);
    } else if (done < FORMAT && take_line(c, "$MeshFormat")) {
      read_format(c, t);
      done = FORMAT;
    } else if (done == FORMAT && take_line(c, "$PhysicalNames")) {
      read_names(c, t);
      done = NAMES;
    } else if (done >= FORMAT && done < ENTITIES && t->version > 4 && take_line(c, "$Entities")) {
      read_entities(c, t);
      done = ENTITIES;
    } else if (done >= FORMAT && done < NODES && take_line(c, "$Nodes")) {
      (t->version > 4 ? read_nodes_4 : read_nodes_2)(c, t);
      expect_line(c, "$EndNodes");
      done = NODES;
    } else if (done == NODES && take_line(c, "$Elements")) {
      (t->version > 4 ? read_elements_4 : read_elements_2)(c, t);
      expect_line(c, "$EndElements");
      done = ELEMENTS;
    } else {
      c->good = false;
    }
  }
}

/* The whole file, ended by a zero. NULL: unreadable. */
static char *read_file(const char *path) {
  FILE  *file = fopen(path, "rb");
  char  *text = NULL;
  size_t n    = 0, got;
  bool   good = file != NULL;
  while (good) {
    const size_t block = 1 << 20;
    text               = shb_realloc(text, n + block + 1, 1);
    got                = fread(text + n, 1, block, file);
    n += got;
    if (got < block) break;
  }
  good = good && !ferror(file);
  if (file) fclose(file);
  if (good) text[n] = 0;
  if (good && strlen(text) == n) return text;
  free(text);
  return NULL;
}

bool mesh_msh_text_read(const char *path, mesh_msh_text *out) {
  memset(out, 0, sizeof *out);
  char  *text = read_file(path);
  cursor c    = {text, text != NULL};
  if (c.good) read_sections(&c, out);
  free(text);
  return c.good && out->n_nodes > 0 && out->n_blocks > 0;
}

void mesh_msh_text_free(mesh_msh_text *text) {
  free(text->name);
  free(text->member);
  free(text->block);
  free(text->node_tag);
  free(text->xyz);
  free(text->tag);
  free(text->node);
  memset(text, 0, sizeof *text);
}
