#include "cases/schema/case.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/key_table.h"
#include "cases/parse/reader.h"
#include "cases/parse/yaml.h"
#include "cases/schema/checks.h"
#include "cases/schema/interfaces.h"
#include "cases/schema/named_groups.h"
#include "mesh/base/publish.h"
#include "mesh/core/file_format.h"
#include "mhb/problem/parameter.h"

static char *folder_of(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

/* Name of the case: the file's name without its ending, or for case.yaml the name of its folder. */
static char *default_name(const char *path, const char *folder) {
  const char *leaf = strrchr(path, '/');
  leaf             = leaf ? leaf + 1 : path;
  const char *dot  = strrchr(leaf, '.');
  size_t      n    = dot && dot != leaf ? (size_t)(dot - leaf) : strlen(leaf);
  if (n != 4 || strncmp(leaf, "case", 4) != 0) return strndup(leaf, n);
  char       *full = realpath(folder, NULL);
  const char *last = full ? strrchr(full, '/') : NULL;
  char       *name = last && last[1] ? strdup(last + 1) : strndup(leaf, n);
  free(full);
  return name;
}

/* The continuation parameter: the frequency, unless mhb.vary names another one. */
static void share_parameter(case_reader *r) {
  mhb_settings *mhb = &r->file->mhb;
  for (int i = MHB_IN_FREQUENCY + 1; i < MHB_N_PARAMETERS; i++) {
    char path[CASE_PATH];
    case_path(path, "mhb.vary.%s", mhb_parameter_name((mhb_parameter)i));
    if (!case_reader_given(r, path)) continue;
    mhb->parameter = (mhb_parameter)i;
    memcpy(mhb->range, r->file->vary[i], sizeof mhb->range);
  }
}

/* The block of the only element stands for a list of one. */
static void count_elements(case_reader *r) {
  case_file *file      = r->file;
  file->has_materials  = case_reader_given(r, "materials") != NULL;
  file->has_loads      = case_reader_given(r, "excitation.loads") != NULL;
  file->has_interfaces = case_reader_given(r, "contact.interfaces") != NULL;
  if (file->n_materials == 0) file->n_materials = 1;
  if (file->n_loads == 0) file->n_loads = 1;
  if (file->n_interfaces == 0) file->n_interfaces = 1;
  for (int i = 0; i < file->n_materials; i++) {
    case_material *one = &file->materials[i];
    one->material.E    = one->constants.E[0];
    one->material.nu   = one->constants.nu[0];
  }
  for (int i = 0; i < file->n_loads; i++) {
    case_load *one  = &file->loads[i];
    one->load.field = one->field;
    one->load.group = one->group[0] ? one->group : NULL;
  }
  if (file->has_interfaces) return;
  strcpy(file->interfaces[0].right, mesh_set_name(MESH_CONTACT_RIGHT));
  strcpy(file->interfaces[0].left, mesh_set_name(MESH_CONTACT_LEFT));
}

/* coriolis: yes is the word after those of fem_turning. */
static void share_turning(case_file *file) {
  if (file->coriolis <= FEM_TURNS_RIGHT) return;
  file->coriolis = file->mhb.turns_right ? FEM_TURNS_RIGHT : FEM_TURNS_LEFT;
}

/* Copies values that several structs hold. */
static void share(case_reader *r) {
  case_file *file = r->file;
  share_turning(file);
  file->mhb.engine_order  = file->engine_order;
  file->mhb.blades        = file->blades;
  file->blade.blades      = file->blades;
  file->blade.axis        = file->axis;
  file->source.path       = file->mesh_file;
  bool step               = file->mesh_file && mesh_format_of(file->mesh_file) == MESH_FORMAT_STEP;
  file->source.unit       = step ? 1e-3 : (const double[]){1, 1e-2, 1e-3, 0.0254}[file->mesh_unit];
  file->source.axis       = file->axis;
  file->source.blades     = file->mhb.to_ground ? 0 : file->blades;
  file->source.n_contacts = file->n_interfaces;
  for (int i = 0; i < file->n_interfaces; i++) {
    strcpy(file->source.contact[i].right, file->interfaces[i].right);
    strcpy(file->source.contact[i].left, file->interfaces[i].left);
  }
  /* no message asks for it then */
  file->source.unit_given = step || case_reader_given(r, "mesh.unit");
  file->has_disc          = case_reader_has_block(r, "mesh.blade.disc");
  file->has_contact       = case_reader_has_block(r, "contact");
  file->only_modes = !file->modal_file && !file->has_contact && !case_reader_has_block(r, "mhb");
  file->blade.psi  = file->mhb.has_psi ? file->mhb.psi : 0;
  file->blade.phi  = file->mhb.has_phi ? file->mhb.phi : 0;
}

/* The stages for which the file is checked. A file of modes alone has one issue if the balance is
 * to run. */
static int stages_of(case_reader *r, int stages) {
  if (!r->file->only_modes || !(stages & CASE_MHB)) return stages;
  if (!(stages & CASE_OR_MODES))
    case_issue_add(r->issues, 1, 1, NULL,
                   "describes modes alone, for `shroudhb modal`; the balance needs contact {mu, "
                   "ku, kv, n0}, excitation {engine_order, and a load} and mhb {frequency} too");
  return CASE_MESH | CASE_MODAL;
}

/* Returns true if an input file named in the case cannot be read. */
static bool read_document(case_issues *issues, const case_overrides *overrides, int stages,
                          case_file *out) {
  case_node *root = case_document_parse(issues);
  if (!root && issues->n > 0) return false; /* not YAML, so there is nothing to check */
  case_overrides_apply(issues, overrides, &root);
  case_reader reader = {.issues = issues, .keys = case_key_table(), .file = out};
  case_reader_walk(&reader, root);
  bool lost = false;
  if (root && root->kind == CASE_MAPPING) {
    count_elements(&reader);
    share_parameter(&reader);
    case_share_interfaces(&reader);
    share(&reader);
    case_assign_groups(&reader);
    stages = stages_of(&reader, stages);
    case_check_alternatives(&reader, stages);
    case_reader_require(&reader, stages);
    lost = case_check_values(&reader, stages);
  }
  case_document_free(root);
  return lost;
}

/* The case is freed. */
static shb_status no_memory(const char *path, case_file *out) {
  const shb_status status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: out of memory", path);
  case_free(out);
  out->no_memory = true;
  return status;
}

/* The overrides as comments in the text; the folder of the outputs. */
static shb_status note_overrides(const case_overrides *overrides, case_file *out) {
  char *text  = case_overrides_text(overrides, out->text);
  out->output = overrides->into ? strdup(overrides->into) : NULL;
  if (!text || (overrides->into && !out->output)) {
    free(text);
    return no_memory(out->path, out);
  }
  free(out->text);
  out->text = text;
  return SHB_OK;
}

/* The text of the file at path, or a copy of what was read before. */
static shb_status take_text(const char *path, const char *document, char **text, size_t *length) {
  if (!document) return case_text_read(path, text, length);
  *length = strlen(document);
  *text   = strdup(document);
  SHB_CHECK(*text, SHB_ERR_IO, "%s: out of memory", path);
  return SHB_OK;
}

shb_status case_read(const char *path, int stages, FILE *errors, case_file *out) {
  return case_read_with(path, NULL, stages, errors, out);
}

shb_status case_read_with(const char *path, const case_overrides *overrides, int stages,
                          FILE *errors, case_file *out) {
  static const case_overrides none = {0};
  if (!overrides) overrides = &none;
  *out                    = (case_file){0};
  size_t           length = 0;
  const shb_status found  = take_text(path, overrides->document, &out->text, &length);
  out->no_memory          = found != SHB_OK && errno == ENOMEM;
  SHB_TRY(found);
  out->path   = strdup(path);
  out->folder = folder_of(path);
  out->name   = out->path && out->folder ? default_name(path, out->folder) : NULL;
  if (!out->name) return no_memory(path, out);
  case_issues issues = case_issues_start(path, out->text, length);
  bool        lost   = read_document(&issues, overrides, stages, out);
  if (out->name && !shb_name_is_plain(out->name))
    case_issue_add(&issues, 1, 1, "name",
                   "missing; the name of the file or folder, which it would be, holds control "
                   "characters");
  int n             = issues.n;
  out->no_memory    = issues.no_memory;
  shb_status status = case_issues_finish(&issues, errors);
  if (status == SHB_OK) return note_overrides(overrides, out);
  case_free(out);
  /* where the only error is an input file that cannot be read, the case file itself is in order */
  return lost && n == 1 ? SHB_ERR_IO : status;
}

static void drop(char **text) {
  free(*text);
  *text = NULL;
}

void case_free(case_file *file) {
  char **const texts[] = {&file->path,       &file->folder,         &file->output,
                          &file->text,       &file->name,           &file->mesh_file,
                          &file->modal_file, &file->mistuning.file, &file->converge_output};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) drop(texts[i]);
  for (int i = 0; i < CASE_MAX_LOADS; i++) drop(&file->loads[i].field);
}
