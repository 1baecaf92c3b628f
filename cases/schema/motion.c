#include "cases/schema/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/key_listing.h"
#include "cases/parse/key_table.h"
#include "cases/parse/reader.h"
#include "cases/parse/value.h"
#include "cases/parse/value_context.h"
#include "cases/schema/interfaces.h"

static const case_key signal_rows[] = {
    {"motion.v", CASE_SIGNAL, "m", .required = true, .stages = CASE_MHB,
     .help = "normal motion: [[amplitude, phase], ...] of harmonics 0, 1, ..."},
    {"motion.u", CASE_SIGNAL, "m", .required = true, .stages = CASE_MHB,
     .help = "tangential motion, as v"},
    {"motion.w", CASE_SIGNAL, "m", .required = true, .stages = CASE_MHB,
     .help = "the other tangential motion, as v"},
};

/* The rows of the contact block and those of the motion. The accuracy is the highest, since a
 * single evaluation is cheap. */
case_keys case_motion_keys(case_key row[CASE_MAX_KEYS]) {
  case_keys all = case_key_table();
  int       n   = 0;
  for (int i = 0; i < all.n && n < CASE_MAX_KEYS - 3; i++)
    if (strncmp(all.key[i].path, "contact.", strlen("contact.")) == 0 &&
        strncmp(all.key[i].path, "contact.interfaces", strlen("contact.interfaces")) != 0)
      row[n++] = all.key[i];
  for (int i = 0; i < n; i++)
    if (row[i].type == CASE_ACCURACY) row[i].fallback = "1e-13";
  for (int i = 0; i < 3; i++) row[n++] = signal_rows[i];
  return (case_keys){n, row};
}

void case_print_motion_keys(FILE *out) {
  case_key row[CASE_MAX_KEYS];
  case_print_key_table(case_motion_keys(row), out);
}

/* m; above any motion of a blade, and far from overflow */
static const double LARGEST = 1e6;

static void read_signal(case_reader *r, const char *path, double complex *signal) {
  const case_node *list = case_reader_given(r, path);
  if (!list || list->kind != CASE_SEQUENCE) return;
  if (list->n > CASE_MAX_MOTION + 1) {
    case_reader_issue(r, path, "has harmonics to %d; at most %d", list->n - 1, CASE_MAX_MOTION);
    return;
  }
  for (int k = 0; k < list->n; k++) {
    char   inner[CASE_PATH];
    double polar[2];
    case_path(inner, "%s[%d]", path, k);
    if (case_value_polar(r->issues, inner, &list->child[k], "m", LARGEST, polar))
      signal[k] = polar[0] * cexp(I * polar[1]);
  }
}

static int longest(const case_reader *r) {
  int n = 1;
  for (int i = 0; i < 3; i++) {
    const case_node *list = case_reader_given(r, signal_rows[i].path);
    if (list && list->n - 1 > n) n = list->n - 1;
  }
  return n < CASE_MAX_MOTION ? n : CASE_MAX_MOTION;
}

/* False if memory is short. */
static bool read_document(case_issues *issues, const case_overrides *overrides, case_motion *out) {
  case_node *root = case_document_parse(issues);
  if (!root && issues->n > 0) return true;
  case_overrides_apply(issues, overrides, &root);
  case_key    row[CASE_MAX_KEYS];
  case_file   file   = {.folder = "."};
  case_reader reader = {.issues = issues, .keys = case_motion_keys(row), .file = &file};
  case_reader_walk(&reader, root);
  if (root && root->kind == CASE_MAPPING) case_reader_require(&reader, CASE_MHB);
  file.mhb.interface[0] = file.interfaces[0].mhb;
  case_lead(&file.mhb, 0);
  if (file.mhb.n_preloads > 1 && case_reader_good(&reader, "contact.n0"))
    case_reader_issue(&reader, "contact.n0", "is a list; a prescribed motion takes one number");
  int m            = longest(&reader);
  out->n_harmonics = m;
  out->motion      = calloc(3 * ((size_t)CASE_MAX_MOTION + 1), sizeof *out->motion);
  for (int i = 0; out->motion && i < 3; i++)
    read_signal(&reader, signal_rows[i].path, out->motion + (size_t)i * (size_t)(m + 1));
  out->contact = file.mhb;
  case_document_free(root);
  return out->motion != NULL;
}

shb_status case_motion_read(const char *path, const case_overrides *overrides, FILE *errors,
                            case_motion *out) {
  static const case_overrides none = {0};
  *out                             = (case_motion){0};
  char  *text                      = NULL;
  size_t length                    = 0;
  SHB_TRY(case_text_read(path, &text, &length));
  case_issues issues = case_issues_start(path, text, length);
  bool        memory = read_document(&issues, overrides ? overrides : &none, out);
  if (!memory) case_issues_no_memory(&issues);
  shb_status status = case_issues_finish(&issues, errors);
  free(text);
  if (status != SHB_OK) case_motion_free(out);
  return status;
}

void case_motion_free(case_motion *motion) {
  free(motion->motion);
  *motion = (case_motion){0};
}
