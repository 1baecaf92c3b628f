#include "cases/schema/named_groups.h"

#include <string.h>

#include "cases/parse/groups.h"

/* The rules as read, and whether a group uses each. */
typedef struct {
  case_reader      *reader;
  const mesh_rules *read;
  bool              taken[MESH_MAX_MORE];
} rules;

/* Records an issue at the place of a group in mesh.groups. */
static void tell(const rules *g, const char *name, const char *text) {
  const case_node *groups = case_reader_given(g->reader, "mesh.groups");
  const case_node *node   = groups ? case_node_find(groups, name) : NULL;
  char             path[CASE_PATH];
  case_path(path, "mesh.groups.%s", name);
  if (node) case_issue_add(g->reader->issues, node->key_line, node->key_column, path, "%s", text);
}

static mesh_named_rule take(rules *g, const char *name) {
  mesh_named_rule out = {.rule = {.kind = MESH_RULE_NONE}};
  strcpy(out.name, name);
  for (int i = 0; i < g->read->n_more; i++) {
    if (strcmp(g->read->more[i].name, name) != 0) continue;
    g->taken[i] = true;
    out.rule    = g->read->more[i].rule;
  }
  return out;
}

static void assign_volumes(rules *g, mesh_rules *to) {
  const case_file *file = g->reader->file;
  to->n_volumes         = file->has_materials ? file->n_materials : 0;
  for (int i = 0; i < to->n_volumes; i++) {
    mesh_named_rule *volume = &to->volume[i];
    *volume                 = take(g, file->materials[i].group);
    if (volume->rule.kind == MESH_RULE_PLANE || volume->rule.kind == MESH_RULE_RADIUS)
      tell(g, volume->name,
           "is a volume (materials names it); expected {nearest: [x, y, z]}, a point in it, or "
           "{name: WORD}");
  }
}

/* Assigns its rule to a group of faces that a key names. */
static void assign_faces(rules *g, const char *name, mesh_rules *to) {
  if (!name[0] || case_group_is_usual(name) || to->n_more == MESH_MAX_MORE) return;
  for (int i = 0; i < to->n_more; i++)
    if (strcmp(to->more[i].name, name) == 0) return;
  to->more[to->n_more++] = take(g, name);
}

static bool is_good(const case_reader *r, const char *path) {
  return !case_reader_given(r, path) || case_reader_good(r, path);
}

void case_assign_groups(case_reader *reader) {
  mesh_rules *to = &reader->file->source.rules, read = *to;
  rules       g = {.reader = reader, .read = &read};
  to->n_more    = 0;
  assign_volumes(&g, to);
  for (int i = 0; i < reader->file->n_loads; i++)
    assign_faces(&g, reader->file->loads[i].group, to);
  const case_file *file = reader->file;
  for (int i = 0; i < file->n_interfaces && !file->modal_file; i++) {
    assign_faces(&g, file->interfaces[i].right, to);
    if (!file->interfaces[i].mhb.to_ground) assign_faces(&g, file->interfaces[i].left, to);
  }
  bool known = is_good(reader, "contact.interfaces") && is_good(reader, "materials") &&
               is_good(reader, "excitation.loads");
  for (int i = 0; i < read.n_more && known; i++)
    if (!g.taken[i])
      tell(&g, read.more[i].name,
           "unknown group; known are root, contact_right, contact_left, load, and those that "
           "materials, excitation.loads or contact.interfaces name");
}
