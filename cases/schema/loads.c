#include "cases/schema/loads.h"

#include <string.h>

enum { KINDS = 4 };

static const char *const kind_name[KINDS] = {"pressure", "traction", "force", "field"};

static case_place place_of(case_reader *r, int i) {
  return case_reader_place(r, "excitation.loads", "excitation", i);
}

/* The kind of a load, and whether a force has what it needs. */
static void check_kind(const case_place *p, case_load *own) {
  const case_reader *r     = p->reader;
  const case_file   *file  = r->file;
  fem_load          *load  = &own->load;
  int                given = 0;
  for (int i = 0; i < KINDS; i++) {
    if (!case_place_given(p, kind_name[i])) continue;
    if (given++ == 0)
      load->kind = (fem_load_kind)i;
    else
      case_place_issue(p, kind_name[i], "give only one of pressure, traction, force and field");
  }
  load->has_at     = case_place_given(p, "force.at") != NULL;
  const bool force = load->kind == FEM_LOAD_FORCE, vector = case_place_given(p, "force.vector");
  if (given == 0 && file->has_loads)
    case_place_issue(p, "", "missing; expected one of pressure, traction, force and field");
  if (force && vector && !load->has_at && !file->modal_file && file->n_probes == 0 &&
      case_reader_good(r, "probe"))
    case_place_issue(p, "force.vector", "has no place to act: give %sforce.at, or a probe",
                     file->has_loads ? "" : "excitation.");
  if (force && file->has_loads && case_place_given(p, "group"))
    case_place_issue(p, "group", "leave it out: a force acts at a node");
}

/* The keys of one load beside the list. */
static void check_single_keys(case_reader *r) {
  for (int i = 0; i < KINDS; i++) {
    char path[CASE_PATH];
    case_path(path, "excitation.%s", kind_name[i]);
    if (case_reader_given(r, path) || case_reader_has_block(r, path))
      case_reader_issue(r, path, "put it into excitation.loads, which stands for all loads");
  }
  if (!r->file->modal_file && case_reader_good(r, "excitation.harmonics") &&
      case_reader_given(r, "excitation.harmonics"))
    case_reader_issue(r, "excitation.harmonics",
                      "leave it out: each of excitation.loads has its own harmonics");
}

void case_check_load(case_reader *r) {
  case_file *file = r->file;
  file->has_load  = file->has_loads;
  for (int i = 0; i < KINDS && !file->has_loads; i++) {
    const case_place p = place_of(r, 0);
    file->has_load     = file->has_load || case_place_given(&p, kind_name[i]);
  }
  if (file->has_loads) check_single_keys(r);
  if (file->has_loads && !case_reader_good(r, "excitation.loads")) return;
  for (int i = 0; i < file->n_loads; i++) {
    const case_place p = place_of(r, i);
    check_kind(&p, &file->loads[i]);
  }
}

/* Refuses a load of zero. A fault of a field is reported when its file is read. */
static void check_size(const case_place *p, const fem_load *load) {
  static const char *const name[KINDS] = {"pressure", "traction", "force.vector", NULL};
  const double             pressure[3] = {load->pressure};
  const double            *v           = load->kind == FEM_LOAD_TRACTION ? load->traction
                                         : load->kind == FEM_LOAD_FORCE  ? load->force
                                                                         : pressure;
  const char              *leaf        = name[load->kind];
  if (leaf && case_place_given(p, leaf) && case_place_good(p, leaf) && v[0] == 0 && v[1] == 0 &&
      v[2] == 0)
    case_place_issue(p, leaf, "is 0; nothing would move");
}

/* Harmonic k of the load drives harmonic k nu of the balance, whose fundamental frequency is
 * omega / nu. */
static void check_harmonics(const case_place *p, const fem_load *load) {
  const case_reader  *r   = p->reader;
  const mhb_settings *mhb = &r->file->mhb;
  if (!case_place_good(p, "harmonics")) return;
  if (load->kind == FEM_LOAD_FIELD) {
    if (case_place_given(p, "harmonics"))
      case_place_issue(p, "harmonics", "leave it out: the field has its own harmonics");
    return;
  }
  const int needed = load->n_harmonics * mhb->subharmonics;
  if (case_reader_good(r, "mhb.harmonics") && case_reader_good(r, "mhb.subharmonics") &&
      mhb->harmonics > 0 && needed > mhb->harmonics)
    case_place_issue(p, "harmonics",
                     "harmonic %d would be left out: mhb.harmonics is %d, must be %d at least "
                     "(times mhb.subharmonics)",
                     load->n_harmonics, mhb->harmonics, needed);
}

void case_check_load_values(case_reader *r, int stages) {
  const case_file *file = r->file;
  if (file->modal_file || (file->has_loads && !case_reader_good(r, "excitation.loads"))) return;
  for (int i = 0; i < file->n_loads; i++) {
    const case_place p = place_of(r, i);
    check_size(&p, &file->loads[i].load);
    if (stages & CASE_MHB) check_harmonics(&p, &file->loads[i].load);
  }
}
