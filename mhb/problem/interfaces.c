#include "mhb/problem/interfaces.h"

#include <math.h>
#include <string.h>

int mhb_interfaces(const mhb_settings *s) {
  return s->n_interfaces > 1 ? s->n_interfaces : 1;
}

/* Index of the preload n0 of the leading interface in its list. */
static int preload_at(const mhb_settings *s, double n0) {
  int nearest = 0;
  for (int i = 1; i < s->n_preloads; i++)
    if (fabs(s->n0[i] - n0) < fabs(s->n0[nearest] - n0)) nearest = i;
  return nearest;
}

/* The interface's value in the case, scaled as the leading one has changed from its own. */
static double in_proportion(double own, double now, double lead) {
  return lead != 0 ? own * (now / lead) : own;
}

static double preload_of(const mhb_operating_point *c, const mhb_settings *s,
                         const mhb_interface *own) {
  double lead  = c->preloads_tied ? c->tied_n0 : c->n0,
         moved = c->preloads_tied ? c->n0 - c->tied_n0 : 0;
  if (s->parameter == MHB_IN_N0)
    return moved + (s->together ? in_proportion(own->n0[0], lead, s->n0[0]) : own->n0[0]);
  return moved + own->n0[own->n_preloads > 1 ? preload_at(s, lead) : 0];
}

mhb_operating_point mhb_interface_operating_point(const mhb_operating_point *c,
                                                  const mhb_settings *s, int interface) {
  if (interface == s->lead) return *c;
  const mhb_interface *own   = &s->interface[interface];
  mhb_parameter        moves = s->together ? s->parameter : MHB_IN_FREQUENCY;
  mhb_operating_point  out   = *c;
  out.n0                     = preload_of(c, s, own);
  out.mu                     = moves == MHB_IN_MU ? in_proportion(own->mu, c->mu, s->mu) : own->mu;
  out.kv                     = moves == MHB_IN_KV ? in_proportion(own->kv, c->kv, s->kv) : own->kv;
  for (int i = 0; i < 3; i++)
    out.ku[i] = moves == MHB_IN_KU ? in_proportion(own->ku[i], c->ku[0], s->ku[0]) : own->ku[i];
  return out;
}

double mhb_interface_rate(const mhb_operating_point *c, const mhb_settings *s, int interface,
                          mhb_parameter parameter) {
  if (interface == s->lead) return 1;
  if (parameter == MHB_IN_N0 && c->preloads_tied) return 1;
  if (parameter != s->parameter || !s->together) return 0;
  const mhb_interface *own = &s->interface[interface];
  switch (parameter) {
    case MHB_IN_N0:
      return s->n0[0] != 0 ? own->n0[0] / s->n0[0] : 0;
    case MHB_IN_MU:
      return s->mu != 0 ? own->mu / s->mu : 0;
    case MHB_IN_KU:
      return own->ku[0] / s->ku[0];
    case MHB_IN_KV:
      return s->kv != 0 ? own->kv / s->kv : 0;
    default:
      return 0;
  }
}

/* Index of a name in the settings; -1: not there. */
static int named(const mhb_settings *s, const char *name) {
  for (int i = 0; i < s->n_interfaces; i++)
    if (strcmp(s->interface[i].name, name) == 0) return i;
  return -1;
}

static shb_status check_names(const modal_model *model, const mhb_settings *s) {
  for (int i = 0; i < model->n_interfaces; i++)
    SHB_CHECK(named(s, model->interface_name[i]) >= 0, SHB_ERR_INPUT,
              "the modal file has the contact interface '%s', which contact.interfaces does not "
              "give",
              model->interface_name[i]);
  for (int i = 0; i < s->n_interfaces; i++) {
    bool there = false;
    for (int j = 0; j < model->n_interfaces; j++)
      there = there || strcmp(model->interface_name[j], s->interface[i].name) == 0;
    SHB_CHECK(
        there, SHB_ERR_INPUT,
        "contact.interfaces has '%s', which the modal file does not (/contact/interface_name)",
        s->interface[i].name);
  }
  return SHB_OK;
}

shb_status mhb_interfaces_match(const modal_model *model, const mhb_settings *s, int *interface) {
  for (int a = 0; a < model->n_pairs; a++) interface[a] = 0;
  if (model->n_interfaces < 2 && s->n_interfaces < 2) return SHB_OK;
  SHB_TRY(check_names(model, s));
  for (int a = 0; a < model->n_pairs; a++)
    interface[a] = named(s, model->interface_name[model->interface[a]]);
  return SHB_OK;
}

void mhb_pair_shares(int n_pairs, int n, const int *interface, const double *area, int contacts,
                     double *share) {
  for (int i = 0; i < n; i++) {
    double total = 0;
    for (int a = 0; a < n_pairs; a++)
      if (!interface || interface[a] == i) total += area ? area[a] : 1;
    total /= contacts;
    for (int a = 0; a < n_pairs; a++)
      if (!interface || interface[a] == i) share[a] = (area ? area[a] : 1) / total;
  }
}
