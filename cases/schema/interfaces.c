#include "cases/schema/interfaces.h"

#include <string.h>

#include "mesh/core/fe_mesh.h"
#include "mhb/problem/parameter.h"

static const char list_path[] = "contact.interfaces", vary_path[] = "mhb.vary.interface";

static case_place place_of(case_reader *r, int i) {
  return case_reader_place(r, list_path, "contact", i);
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

void case_lead(mhb_settings *mhb, int lead) {
  const mhb_interface *own = &mhb->interface[lead];
  mhb->lead                = lead;
  mhb->mu                  = own->mu;
  mhb->kv                  = own->kv;
  mhb->n_preloads          = own->n_preloads;
  memcpy(mhb->ku, own->ku, sizeof mhb->ku);
  memcpy(mhb->n0, own->n0, sizeof mhb->n0);
  mhb->has_psi = own->has_psi;
  mhb->has_phi = own->has_phi;
  mhb->psi     = own->psi;
  mhb->phi     = own->phi;
}

void case_share_interfaces(case_reader *r) {
  case_file    *file = r->file;
  mhb_settings *mhb  = &file->mhb;
  for (int i = 0; i < file->n_interfaces; i++) {
    const case_place p   = place_of(r, i);
    mhb_interface   *own = &file->interfaces[i].mhb;
    own->has_psi         = case_place_given(&p, "psi") != NULL;
    own->has_phi         = case_place_given(&p, "phi") != NULL;
    if (!file->has_interfaces || !case_place_given(&p, "to")) own->to_ground = mhb->to_ground;
    mhb->interface[i] = *own;
  }
  mhb->n_interfaces = file->n_interfaces;
  mhb->to_ground    = mhb->interface[0].to_ground;
  mhb->together     = strcmp(file->vary_interface, "all") == 0;
  case_lead(mhb, leading(file));
}

static void check_names(case_reader *r, int i) {
  static const char           taken[] = "its group is one of another interface; give each its own";
  const case_interface *const all = r->file->interfaces, *own = &all[i];
  const bool                  left = !own->mhb.to_ground;
  const case_place            p    = place_of(r, i);
  if (strcmp(own->mhb.name, "all") == 0)
    case_place_issue(&p, "name", "'all' stands for all interfaces");
  if (left && strcmp(own->right, own->left) == 0)
    case_place_issue(&p, "left", "is the group of its right face");
  for (const case_interface *other = all; other < own; other++) {
    const bool both = !other->mhb.to_ground;
    if (strcmp(own->mhb.name, other->mhb.name) == 0)
      case_place_issue(&p, "name", "there is another one of that name");
    if (r->file->modal_file) continue;
    if (strcmp(own->right, other->right) == 0 || (both && strcmp(own->right, other->left) == 0))
      case_place_issue(&p, "right", "%s", taken);
    if (left &&
        ((both && strcmp(own->left, other->left) == 0) || strcmp(own->left, other->right) == 0))
      case_place_issue(&p, "left", "%s", taken);
  }
}

/* What all interfaces of a case must have in common. */
static void check_alike(case_reader *r, int i) {
  const case_interface *first = &r->file->interfaces[0], *own = &r->file->interfaces[i];
  const case_place      p = place_of(r, i);
  if (own->mhb.to_ground != first->mhb.to_ground)
    case_place_issue(&p, "to",
                     "is %s, that of %s is %s; interfaces of both kinds do not go "
                     "together",
                     own->mhb.to_ground ? "ground" : "neighbour", first->mhb.name,
                     own->mhb.to_ground ? "neighbour" : "ground");
  if (!r->file->modal_file && (own->points < 0) != (first->points < 0))
    case_place_issue(&p, "points", "is %s, that of %s is %s; auto chooses those of all interfaces",
                     own->points < 0 ? "auto" : "a number", first->mhb.name,
                     own->points < 0 ? "a number" : "auto");
}

/* The lists of preloads go together: entry k of one with entry k of the others. */
static void check_preloads(case_reader *r, int i) {
  const mhb_settings  *mhb = &r->file->mhb;
  const mhb_interface *own = &mhb->interface[i];
  const case_place     p   = place_of(r, i);
  if (own->n_preloads > 1 && own->n_preloads != mhb->n_preloads)
    case_place_issue(&p, "n0", "has %d preloads, %s has %d; lists must be of one length",
                     own->n_preloads, mhb->interface[mhb->lead].name, mhb->n_preloads);
  if (own->n_preloads > 1 && mhb->parameter == MHB_IN_N0)
    case_place_issue(&p, "n0", "must be one number, because curves follow mhb.vary.n0");
  for (int a = 1; i == mhb->lead && a < mhb->n_preloads; a++)
    for (int b = 0; b < a; b++)
      if (mhb->n0[a] == mhb->n0[b])
        case_place_issue(
            &p, "n0",
            "has %g N twice; the preloads of the interface that leads tell the curves apart",
            mhb->n0[a]);
}

/* Checks mhb.vary.interface. A parameter that is 0 at the leading interface has no proportions. */
static void check_varied(case_reader *r) {
  const mhb_settings *mhb = &r->file->mhb;
  if (!case_reader_given(r, vary_path) || !case_reader_good(r, vary_path)) return;
  if (mhb->n_interfaces < 2) {
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

/* Refuses the keys of the only interface beside the list: those that an element has too. */
static void check_single_keys(case_reader *r) {
  for (int i = 0; i < r->keys.n; i++) {
    const char *leaf = case_key_in_list(r->keys.key[i].path, list_path);
    char        path[CASE_PATH];
    case_path(path, "contact.%s", leaf ? leaf : "");
    if (leaf && strcmp(leaf, "to") != 0 && case_reader_given(r, path))
      case_reader_issue(r, path, "put it into contact.interfaces, which stands for all interfaces");
  }
}

void case_check_interfaces(case_reader *r, int stages) {
  const case_file *file = r->file;
  check_varied(r);
  if (!file->has_interfaces) return;
  check_single_keys(r);
  if (!case_reader_good(r, list_path)) return;
  const case_interface *first = &file->interfaces[0];
  const bool            usual = strcmp(first->right, mesh_set_name(MESH_CONTACT_RIGHT)) == 0 &&
                     strcmp(first->left, mesh_set_name(MESH_CONTACT_LEFT)) == 0;
  if (!file->modal_file && !file->mesh_file && (file->n_interfaces > 1 || !usual))
    case_reader_issue(r, list_path, "mesh.blade has one interface: give a mesh.file for several");
  for (int i = 0; i < file->n_interfaces; i++) {
    check_names(r, i);
    check_alike(r, i);
    if (stages & CASE_MHB) check_preloads(r, i);
  }
}
