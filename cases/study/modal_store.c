#include "cases/study/modal_store.h"

#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cases/commands/command.h"
#include "cases/commands/modal_changes.h"
#include "cases/commands/stage.h"
#include "cases/commands/up_to_date.h"
#include "cases/designs/digest.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/memory.h"
#include "mesh/process/report.h"

enum { MORE_WORDS = 12 };

static const char modal_suffix[] = ".modal.h5";

shb_status modal_store_open(const study_spec *spec, modal_store *s) {
  *s        = (modal_store){.spec = spec, .copy = -1};
  s->folder = shb_text_of("%s/%s.study.d", spec->folder, spec->name);
  SHB_CHECK(mkdir(s->folder, 0777) == 0 || errno == EEXIST, SHB_ERR_IO, "%s: cannot be made: %s",
            s->folder, strerror(errno));
  return shb_child_text(spec->base.text, &s->copy, s->copy_path);
}

static void clear(modal_store *s, int at) {
  if (s->entry[at].digest[0]) case_model_free(&s->entry[at].model);
  peak_field_destroy(s->entry[at].field);
  s->entry[at].field     = NULL;
  s->entry[at].digest[0] = '\0';
}

void modal_store_close(modal_store *s) {
  for (int i = 0; i < STORE_MODELS; i++) clear(s, i);
  if (s->folder && s->copy >= 0) close(s->copy);
  free(s->folder);
  *s = (modal_store){0};
}

/* ---------------------------------------------------------------- making a file */

/* The last message that a stage has reported. */
static void last_message(int report, char *out, size_t size) {
  char *text = shb_report_read(report), *line = NULL, *rest = text;
  for (char *next; (next = strtok_r(rest, "\n", &rest)) != NULL;) line = next;
  const char *error = line ? strstr(line, ": error: ") : NULL; /* behind a place in a file */
  snprintf(out, size, "%s", error ? error + strlen(": error: ") : line ? line : "");
  free(text);
}

/* Run a stage whose messages are reported and not printed. */
static shb_status run_unheard(char *const words[], shb_child_end *end, char *reason, size_t size) {
  shb_child child         = shb_child_of(words);
  child.report            = shb_report_open();
  child.err               = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const shb_status status = shb_child_run(&child, end);
  last_message(child.report, reason, size);
  if (child.report >= 0) close(child.report);
  if (child.err >= 0) close(child.err);
  return status;
}

/* Run "mesh" or "modal" for a design; the output is FOLDER/DIGEST. */
static shb_status run_stage(const modal_store *s, command_id stage, const double *value,
                            const char *digest) {
  char       *words[2 * STUDY_MAX_KEYS + MORE_WORDS] = {NULL};
  char        name[64], quiet[] = "--quiet", into[] = "--into", set[] = "--set", text[] = "--text";
  char        copy[SHB_CHILD_TEXT], reason[512];
  const char *what = command_row_of(stage)->name;
  int         n    = stage_program(stage, (const char **)words);
  memcpy(copy, s->copy_path, sizeof copy);
  snprintf(name, sizeof name, "name=%s", digest);
  char *const first[] = {quiet, into, s->folder, text, copy, set, name};
  memcpy(words + n, first, sizeof first);
  n += (int)(sizeof first / sizeof *first);
  const int     sets   = study_spec_words(s->spec, value, words + n);
  shb_child_end result = {0};
  if (sets >= 0) words[n + sets] = s->spec->case_path;
  shb_status status = sets >= 0 ? run_unheard(words, &result, reason, sizeof reason)
                                : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  for (int i = 0; i < sets; i++) free(words[n + i]);
  free(words[0]);
  if (status != SHB_OK)
    return shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s: %s", what, shb_message());
  SHB_CHECK(result.code != SHB_INTERRUPTED, SHB_INTERRUPTED, "interrupted");
  SHB_CHECK(result.code == SHB_OK, SHB_ERR_INPUT, "%s: %s", what,
            reason[0] ? reason : "failed without a message");
  return SHB_OK;
}

/* A modal file of this digest, of this study or of one beside it; malloc'ed, else NULL. */
static char *find_file(const modal_store *s, const char *digest) {
  glob_t found   = {0};
  char  *pattern = shb_text_of("%s/*.study.d/%s%s", s->spec->folder, digest, modal_suffix);
  char  *path    = NULL;
  if (glob(pattern, 0, NULL, &found) == 0 && found.gl_pathc > 0) path = shb_text(found.gl_pathv[0]);
  globfree(&found);
  free(pattern);
  return path;
}

/* Keys on which the modes do not depend (modal/model/revision.h). */
static bool keeps_modes(const char *key) {
  return strcmp(key, "modal.damping") == 0 || strcmp(key, "excitation.pressure") == 0;
}

/* Values of the design of the same modes that has damping and load of the case. The modal file of a
 * design depends on this one alone, not on the order of designs. */
static void common_design(const study_spec *spec, const double *value, double *common) {
  const study_keys *keys = &spec->keys;
  for (int k = 0; k < keys->n; k++) {
    const study_key *key = &keys->key[k];
    common[k]            = value[k];
    if (key->is_ratio && keeps_modes(keys->key[key->nominal].path)) common[k] = 1;
    if (key->is_ratio || !keeps_modes(key->path)) continue;
    common[k] = strcmp(key->path, "modal.damping") == 0 ? spec->base.damping.ratio
                                                        : spec->base.loads[0].load.pressure;
  }
}

/* Read the case of a design; false, and nothing is printed, if it is no valid one. */
static bool read_quietly(const modal_store *s, const double *value, case_file *file) {
  FILE      *messages = fopen("/dev/null", "w");
  const bool good =
      messages && study_spec_design(s->spec, value, NULL, NULL, messages, file) == SHB_OK;
  if (messages) fclose(messages);
  return good;
}

/* The text that the modal file at path would have as settings; malloc'ed. The mesh lies beside. */
static shb_status settings_beside(const case_file *file, const char *path, char **settings) {
  const int        length = (int)(strlen(path) - strlen(modal_suffix));
  char            *made   = shb_text_of("%.*s.msh", length, path);
  const bool       given  = file->mesh_file && !case_mesh_is_made(file);
  const shb_status status =
      up_to_date_settings(file, CASE_MODAL, given ? file->mesh_file : made, settings);
  free(made);
  return status;
}

/* Write the modal file of a case from that of the common design. False if it cannot be. */
static bool revise(const case_file *file, const char *common, const char *path) {
  modal_revision revision;
  char          *settings = NULL, *earlier = up_to_date_written(common);
  bool           good = earlier && settings_beside(file, common, &settings) == SHB_OK &&
              modal_changes_find(earlier, settings, &revision);
  revision.damping = file->damping;
  if (good) {
    const shb_provenance from = command_provenance(file, settings, "shroudhb-design");
    good                      = modal_revise(common, path, &revision, &from) == SHB_OK;
  }
  free(earlier);
  free(settings);
  return good;
}

static shb_status make_file(const modal_store *s, const double *value, const case_file *file,
                            const char *digest, char **path);

/* Make FOLDER/DIGEST.modal.h5 from the file of the common design, which is made if it is not there.
 * *made stays false where that is the design itself, or the loads are not proportional. */
static shb_status make_from_common(const modal_store *s, const double *value, const case_file *file,
                                   const char *digest, bool *made) {
  double    value_of_common[STUDY_MAX_KEYS];
  char      modes[DIGEST_TEXT], *common = NULL;
  case_file of_common;
  *made = false;
  common_design(s->spec, value, value_of_common);
  if (!read_quietly(s, value_of_common, &of_common)) return SHB_OK;
  digest_modes(&of_common, s->spec->inputs, modes);
  shb_status status = SHB_OK;
  if (strcmp(modes, digest) != 0)
    status = make_file(s, value_of_common, &of_common, modes, &common);
  case_free(&of_common);
  if (status == SHB_OK && common) {
    char *path = shb_text_of("%s/%s%s", s->folder, digest, modal_suffix);
    *made      = revise(file, common, path);
    free(path);
  }
  free(common);
  return status;
}

static shb_status run_stages(const modal_store *s, const double *value, const char *digest) {
  SHB_TRY(run_stage(s, COMMAND_MESH, value, digest));
  return run_stage(s, COMMAND_MODAL, value, digest);
}

/* The modal file of a design, made if it is not there, under the lock of its digest. */
static shb_status make_file(const modal_store *s, const double *value, const case_file *file,
                            const char *digest, char **path) {
  char *lock = shb_text_of("%s/%s.lock", s->folder, digest);
  int   held = open(lock, O_RDWR | O_CREAT, 0666);
  if (held >= 0) flock(held, LOCK_EX); /* a dead process holds none */
  bool       made   = false;
  shb_status status = SHB_OK;
  *path             = find_file(s, digest);
  if (!*path) {
    status = make_from_common(s, value, file, digest, &made);
    if (status == SHB_OK && !made) status = run_stages(s, value, digest);
    if (status == SHB_OK) *path = find_file(s, digest);
    if (status == SHB_OK && !*path)
      status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "modal: left no file");
  }
  unlink(lock);
  if (held >= 0) close(held);
  free(lock);
  return status;
}

/* ---------------------------------------------------------------- models in memory */

static int entry_of(const modal_store *s, const char *digest) {
  for (int i = 0; i < STORE_MODELS; i++)
    if (strcmp(s->entry[i].digest, digest) == 0) return i;
  return -1;
}

static int oldest(const modal_store *s) {
  int at = 0;
  for (int i = 1; i < STORE_MODELS; i++)
    if (s->entry[i].used < s->entry[at].used) at = i;
  return at;
}

static shb_status load(modal_store *s, const double *value, const case_file *file,
                       const char *digest, int at) {
  char      *path   = NULL;
  shb_status status = SHB_OK;
  clear(s, at);
  SHB_CHECK(!case_points_are_auto(file), SHB_ERR_INPUT,
            "contact.points: auto chooses the points of one case; a study compares designs with "
            "the same ones: give their number, or all");
  if (file->modal_file) path = case_modal_path(file);
  if (!file->modal_file) path = find_file(s, digest);
  if (!path) status = make_file(s, value, file, digest, &path);
  if (status == SHB_OK) {
    status = case_model_read(file, path, 0, true, &s->entry[at].model);
    if (status == SHB_OK) status = study_spec_check_inputs(s->spec, file);
    if (status == SHB_OK && peak_field_wanted(s->spec->n_outputs, s->spec->output))
      status = peak_field_create(path, s->spec->n_outputs, s->spec->output, &s->entry[at].field);
    if (status != SHB_OK) case_model_free(&s->entry[at].model);
  }
  if (status == SHB_OK) snprintf(s->entry[at].digest, DIGEST_TEXT, "%s", digest);
  free(path);
  return status;
}

shb_status modal_store_get(modal_store *s, const double *value, const case_file *file,
                           case_model *model, peak_field **field) {
  char digest[DIGEST_TEXT];
  digest_modes(file, s->spec->inputs, digest);
  int        at   = entry_of(s, digest);
  const bool ring = file->mistuning.kind != CASE_TUNED;
  if (at < 0 || file->run_up || ring) { /* they depend on the sweep, and on the deviations */
    if (at < 0) at = oldest(s);
    SHB_TRY(load(s, value, file, digest, at));
  }
  s->entry[at].used               = ++s->clock;
  *model                          = s->entry[at].model;
  *field                          = s->entry[at].field;
  model->settings                 = file->mhb;
  model->settings.run_up          = s->entry[at].model.run_up;
  model->settings.disc_run_up     = s->entry[at].model.disc_run_up;
  model->settings.nodal_diameters = s->entry[at].model.disc;
  if (ring) model->settings = s->entry[at].model.settings;
  return SHB_OK;
}
