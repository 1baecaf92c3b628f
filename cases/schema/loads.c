#include "cases/schema/loads.h"

#include <string.h>

enum { KINDS = 4 };

static const char *const kind_name[KINDS] = {"pressure", "traction", "force", "field"};

/* The value of a load; a field has none. */
static const double *value_of(const fem_load *load, double one[3]) {
  one[0] = load->pressure;
  one[1] = one[2] = 0;
  return load->kind == FEM_LOAD_TRACTION ? load->traction
         : load->kind == FEM_LOAD_FORCE  ? load->force
                                         : one;
}

/* ---- one load ---- */

static void check_single(case_reader *r) {
  fem_load *load  = &r->file->load;
  int       given = 0;
  for (int i = 0; i < KINDS; i++) {
    char path[CASE_PATH];
    case_path(path, "excitation.%s", kind_name[i]);
    if (!case_reader_given(r, path) && !case_reader_has_block(r, path)) continue;
    if (r->file->has_loads) {
      case_reader_issue(r, path, "put it into excitation.loads, which stands for all loads");
    } else if (given++ == 0) {
      load->kind = (fem_load_kind)i;
    } else {
      case_reader_issue(r, path, "give only one of pressure, traction, force and field");
    }
  }
  r->file->has_load = given > 0 || r->file->has_loads;
  bool own          = !r->file->modal_file && !r->file->has_loads;
  bool vector       = case_reader_given(r, "excitation.force.vector") != NULL;
  load->has_at      = case_reader_given(r, "excitation.force.at") != NULL;
  bool lost         = own && load->kind == FEM_LOAD_FORCE && vector && !load->has_at;
  if (lost && r->file->n_probes == 0 && case_reader_good(r, "probe"))
    case_reader_issue(r, "excitation.force.vector",
                      "has no place to act: give excitation.force.at, or a probe");
}

/* Refuses a load of zero. */
static void check_single_size(case_reader *r) {
  static const char *const names[] = {"excitation.pressure", "excitation.traction",
                                      "excitation.force.vector"};
  const fem_load          *load    = &r->file->load;
  double                   one[3];
  if (load->kind == FEM_LOAD_FIELD) return; /* a fault is reported when the file is read */
  const char   *name = names[load->kind];
  const double *v    = value_of(load, one);
  if (!r->file->modal_file && case_reader_given(r, name) && case_reader_good(r, name) &&
      v[0] == 0 && v[1] == 0 && v[2] == 0)
    case_reader_issue(r, name, "is 0; nothing would move");
}

/* Number of harmonics that the balance needs for the load; 0 if it has enough. Harmonic k of the
 * load drives harmonic k nu of the balance, whose fundamental frequency is omega / nu. */
static int harmonics_needed(const case_reader *r, const fem_load *load, int stages) {
  const mhb_settings *mhb = &r->file->mhb;
  bool good = case_reader_good(r, "mhb.harmonics") && case_reader_good(r, "mhb.subharmonics");
  if (r->file->modal_file || !good || !(stages & CASE_MHB)) return 0;
  int needed = load->n_harmonics * mhb->subharmonics;
  return mhb->harmonics > 0 && needed > mhb->harmonics ? needed : 0;
}

static const char room[] =
    "harmonic %d would be left out: mhb.harmonics is %d, must be %d at least (times "
    "mhb.subharmonics)";
static const char own_harmonics[] = "leave it out: the field has its own harmonics";

static void check_single_harmonics(case_reader *r, int stages) {
  static const char path[] = "excitation.harmonics";
  const fem_load   *load   = &r->file->load;
  bool given = case_reader_given(r, path) != NULL, field = load->kind == FEM_LOAD_FIELD;
  if (r->file->modal_file || !case_reader_good(r, path) || !(stages & CASE_MHB)) return;
  if (given && r->file->has_loads)
    case_reader_issue(r, path, "leave it out: each of excitation.loads has its own harmonics");
  if (given && field) case_reader_issue(r, path, "%s", own_harmonics);
  int needed = field || r->file->has_loads ? 0 : harmonics_needed(r, load, stages);
  if (needed) case_reader_issue(r, path, room, load->n_harmonics, r->file->mhb.harmonics, needed);
}

/* ---- several ---- */

static void tell(const case_reader *r, int i, const case_node *at, const char *leaf,
                 const char *text) {
  char path[CASE_PATH];
  case_path(path, "excitation.loads[%d]%s%s", i, leaf[0] ? "." : "", leaf);
  case_issue_add(r->issues, at->line, at->column, path, "%s", text);
}

static void check_force(const case_reader *r, int i, const case_node *force, fem_load *load) {
  bool vector  = force->kind == CASE_MAPPING && case_node_find(force, "vector");
  load->has_at = force->kind == CASE_MAPPING && case_node_find(force, "at");
  if (force->kind == CASE_MAPPING && !vector)
    tell(r, i, force, "force.vector", "missing; expected [x, y, z] in N");
  if (vector && !load->has_at && r->file->n_probes == 0 && case_reader_good(r, "probe"))
    tell(r, i, force, "force.vector", "has no place to act: give force.at, or a probe");
}

static void check_kind(const case_reader *r, int i, const case_node *node) {
  fem_load *load  = &r->file->loads[i].load;
  int       given = 0;
  for (int k = 0; k < KINDS; k++) {
    const case_node *one = case_node_find(node, kind_name[k]);
    if (!one) continue;
    if (given++ == 0) {
      load->kind = (fem_load_kind)k;
    } else {
      tell(r, i, one, kind_name[k], "give only one of pressure, traction, force and field");
    }
    if (k == FEM_LOAD_FORCE) check_force(r, i, one, load);
  }
  if (given == 0)
    tell(r, i, node, "", "missing; expected one of pressure, traction, force and field");
  const case_node *group = case_node_find(node, "group");
  if (group && load->kind == FEM_LOAD_FORCE)
    tell(r, i, group, "group", "leave it out: a force acts at a node");
}

static void check_values(const case_reader *r, int i, const case_node *node, int stages) {
  const fem_load  *load      = &r->file->loads[i].load;
  const case_node *harmonics = case_node_find(node, "harmonics");
  double           one[3];
  const double    *v = value_of(load, one);
  if (load->kind == FEM_LOAD_FIELD) {
    if (harmonics) tell(r, i, harmonics, "harmonics", own_harmonics);
    return;
  }
  const case_node *given = case_node_find(node, kind_name[load->kind]);
  if (given && load->kind == FEM_LOAD_FORCE) given = case_node_find(given, "vector");
  if (given && v[0] == 0 && v[1] == 0 && v[2] == 0)
    tell(r, i, node, "", "is 0; nothing would move");
  int  needed = harmonics_needed(r, load, stages);
  char text[256];
  snprintf(text, sizeof text, room, load->n_harmonics, r->file->mhb.harmonics, needed);
  if (needed) tell(r, i, harmonics ? harmonics : node, "harmonics", text);
}

/* The list of loads, if it was read without an issue. */
static const case_node *list_of(const case_reader *r) {
  static const char path[] = "excitation.loads";
  return case_reader_good(r, path) ? case_reader_given(r, path) : NULL;
}

void case_check_load(case_reader *r) {
  const case_node *list = list_of(r);
  check_single(r);
  for (int i = 0; list && i < r->file->n_loads; i++) check_kind(r, i, &list->child[i]);
}

void case_check_load_values(case_reader *r, int stages) {
  const case_node *list = list_of(r);
  if (!r->file->has_loads) check_single_size(r);
  check_single_harmonics(r, stages);
  for (int i = 0; list && i < r->file->n_loads && !r->file->modal_file; i++)
    check_values(r, i, &list->child[i], stages);
}
