#include "cases/schema/interfaces.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cases/parse/value.h"
#include "cases/parse/value_context.h"
#include "mhb/problem/parameter.h"

static const char list_path[] = "contact.interfaces", vary_path[] = "mhb.vary.interface";

/* Keys of a single interface, which the list replaces. */
static const char *const single[] = {"psi", "phi", "points", "mu", "ku", "kv", "n0"};
enum { N_SINGLE = sizeof single / sizeof *single };

static const case_node *element(const case_reader *r, int i) {
  const case_node *list = case_reader_given(r, list_path);
  return list && list->kind == CASE_SEQUENCE && i < list->n ? &list->child[i] : NULL;
}

static bool has(const case_node *node, const char *leaf) {
  return node && node->kind == CASE_MAPPING && case_node_find(node, leaf);
}

/* Index of the leading interface: the one of mhb.vary.interface, else the first with a list of
 * preloads, else the first. */
static int leading(const case_file *file) {
  for (int i = 0; i < file->n_interfaces; i++)
    if (strcmp(file->interfaces[i].mhb.name, file->vary_interface) == 0) return i;
  for (int i = 0; i < file->n_interfaces; i++)
    if (file->interfaces[i].mhb.n_preloads > 1) return i;
  return 0;
}

static void take_parameters(mhb_settings *mhb, const mhb_interface *own) {
  mhb->mu         = own->mu;
  mhb->kv         = own->kv;
  mhb->n_preloads = own->n_preloads;
  memcpy(mhb->ku, own->ku, sizeof mhb->ku);
  memcpy(mhb->n0, own->n0, sizeof mhb->n0);
  mhb->has_psi = own->has_psi;
  mhb->has_phi = own->has_phi;
  mhb->psi     = own->psi;
  mhb->phi     = own->phi;
}

void case_share_interfaces(case_reader *r) {
  case_file    *file   = r->file;
  mhb_settings *mhb    = &file->mhb;
  mesh_source  *source = &file->source;
  file->has_interfaces = case_reader_given(r, list_path) != NULL;
  if (file->n_interfaces == 0) return;
  for (int i = 0; i < file->n_interfaces; i++) {
    case_interface *own = &file->interfaces[i];
    own->mhb.has_psi    = has(element(r, i), "psi");
    own->mhb.has_phi    = has(element(r, i), "phi");
    mhb->interface[i]   = own->mhb;
    strcpy(source->contact[i].right, own->right);
    strcpy(source->contact[i].left, own->left);
  }
  source->n_contacts = file->n_interfaces;
  mhb->n_interfaces  = file->n_interfaces;
  mhb->lead          = leading(file);
  mhb->together      = strcmp(file->vary_interface, "all") == 0;
  take_parameters(mhb, &mhb->interface[mhb->lead]);
}

static void tell(const case_reader *r, int i, const char *leaf, const char *text) {
  const case_node *node = element(r, i), *at = case_node_find(node, leaf);
  char             path[CASE_PATH];
  if (!at) at = node;
  case_path(path, "%s[%d].%s", list_path, i, leaf);
  case_issue_add(r->issues, at->line, at->column, path, "%s", text);
}

/* Reports keys of interface i that the balance requires. */
static void check_missing(const case_reader *r, int i) {
  for (int k = 0; k < N_SINGLE; k++) {
    char path[CASE_PATH], expected[256], text[300];
    case_path(path, "contact.%s", single[k]);
    const case_key *key = case_key_find(r->keys, path);
    if (!key->required || has(element(r, i), single[k])) continue;
    case_value_expected(key, expected, sizeof expected);
    snprintf(text, sizeof text, "missing; expected %s", expected);
    tell(r, i, single[k], text);
  }
}

static void check_names(const case_reader *r, int i) {
  const case_interface *own  = &r->file->interfaces[i];
  bool                  left = !r->file->mhb.to_ground;
  if (strcmp(own->mhb.name, "all") == 0) tell(r, i, "name", "'all' stands for all interfaces");
  if (left && strcmp(own->right, own->left) == 0)
    tell(r, i, "left", "is the group of its right face");
  for (int j = 0; j < i; j++) {
    const case_interface *other = &r->file->interfaces[j];
    if (strcmp(own->mhb.name, other->mhb.name) == 0)
      tell(r, i, "name", "there is another one of that name");
    if (r->file->modal_file) continue;
    if (strcmp(own->right, other->right) == 0 || (left && strcmp(own->right, other->left) == 0))
      tell(r, i, "right", "its group is one of another interface; give each its own");
    if (left && (strcmp(own->left, other->left) == 0 || strcmp(own->left, other->right) == 0))
      tell(r, i, "left", "its group is one of another interface; give each its own");
  }
}

/* The lists of preloads go together: entry k of one with entry k of the others. */
static void check_preloads(const case_reader *r, int i) {
  const mhb_settings  *mhb = &r->file->mhb;
  const mhb_interface *own = &r->file->interfaces[i].mhb;
  char                 text[256];
  if (own->n_preloads > 1 && own->n_preloads != mhb->n_preloads) {
    snprintf(text, sizeof text, "has %d preloads, %s has %d; lists must be of one length",
             own->n_preloads, mhb->interface[mhb->lead].name, mhb->n_preloads);
    tell(r, i, "n0", text);
  }
  if (own->n_preloads > 1 && mhb->parameter == MHB_IN_N0)
    tell(r, i, "n0", "must be one number, because curves follow mhb.vary.n0");
  for (int a = 1; i == mhb->lead && a < mhb->n_preloads; a++)
    for (int b = 0; b < a; b++) {
      if (mhb->n0[a] != mhb->n0[b]) continue;
      snprintf(text, sizeof text,
               "has %g N twice; the preloads of the interface that leads tell the curves apart",
               mhb->n0[a]);
      tell(r, i, "n0", text);
    }
}

/* Checks mhb.vary.interface. A parameter that is 0 at the leading interface has no proportions. */
static void check_varied(case_reader *r) {
  const mhb_settings *mhb = &r->file->mhb;
  if (!case_reader_given(r, vary_path) || !case_reader_good(r, vary_path)) return;
  if (r->file->n_interfaces < 2) {
    case_reader_issue(r, vary_path, "leave it out: there is one contact interface");
    return;
  }
  if (mhb->parameter == MHB_IN_FREQUENCY || mhb->parameter == MHB_IN_SCALE) {
    case_reader_issue(r, vary_path, "only says something with mhb.vary.n0, mu, ku or kv");
    return;
  }
  bool known = mhb->together;
  for (int i = 0; i < mhb->n_interfaces; i++)
    known = known || strcmp(mhb->interface[i].name, r->file->vary_interface) == 0;
  if (!known) case_reader_issue(r, vary_path, "is none of contact.interfaces, nor all");
  mhb_operating_point at = mhb_operating_point_of(mhb);
  if (mhb->together && mhb_parameter_get(&at, mhb->parameter) == 0)
    case_reader_issue(r, vary_path, "all keeps the proportions to %s of %s, which is 0",
                      mhb_parameter_name(mhb->parameter), mhb->interface[mhb->lead].name);
}

void case_check_interfaces(case_reader *r, int stages) {
  const case_file *file = r->file;
  check_varied(r);
  if (!case_reader_given(r, list_path)) return;
  for (int k = 0; k < N_SINGLE; k++) {
    char path[CASE_PATH];
    case_path(path, "contact.%s", single[k]);
    if (case_reader_given(r, path))
      case_reader_issue(r, path, "put it into contact.interfaces, which stands for all interfaces");
  }
  if (!case_reader_good(r, list_path)) return;
  if (!file->modal_file && !file->mesh_file && file->n_interfaces > 0)
    case_reader_issue(r, list_path, "mesh.blade has one interface: give a mesh.file for several");
  for (int i = 0; i < file->n_interfaces; i++) {
    if (stages & CASE_MHB) check_missing(r, i);
    check_names(r, i);
    if (stages & CASE_MHB) check_preloads(r, i);
  }
}
