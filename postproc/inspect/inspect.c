#include "postproc/inspect/inspect.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "mhb/problem/parameter.h"
#include "mhb/response/response.h"
#include "modal/hdf5/h5.h"
#include "modal/model/model.h"
#include "modal/model/sector_speeds.h"
#include "postproc/analysis/campbell.h"
#include "postproc/analysis/file_origin.h"
#include "postproc/analysis/findings.h"
#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/number_format.h"
#include "postproc/inspect/diameter_table.h"
#include "postproc/inspect/mode_table.h"
#include "postproc/inspect/phase_table.h"

/* ---------------------------------------------------------------- summary */

static void put_names(post_buffer *out, int n, char *const *name) {
  if (n == 0) {
    post_put(out, "no probes");
    return;
  }
  post_put(out, n == 1 ? "probe " : "probes ");
  for (int i = 0; i < n && i < 8; i++) {
    post_put(out, i ? ", " : "");
    post_put_printable(out, name[i]);
  }
  if (n > 8) post_put(out, " and %d more", n - 8);
}

static void put_count(post_buffer *out, int n, const char *noun) {
  post_put(out, "%d %s%s", n, noun, n == 1 ? "" : "s");
}

/* " (2 shroud, 1 snubber)"; nothing for a single interface. */
static void put_interfaces(post_buffer *out, int n_pairs, const int *which, int n,
                           char *const *name) {
  for (int i = 0; i < n; i++) {
    int pairs = 0;
    for (int p = 0; p < n_pairs; p++) pairs += which[p] == i;
    post_put(out, "%s%d %s%s", i ? ", " : " (", pairs, name[i], i == n - 1 ? ")" : "");
  }
}

/* "lo … hi unit", or a single value. */
static void put_span(post_buffer *out, double lo, double hi, const char *unit) {
  char a[POST_NUMBER], b[POST_NUMBER];
  if (lo == hi)
    post_put(out, "%s %s", post_plain(a, lo, 6), unit);
  else
    post_put(out, "%s … %s %s", post_plain(a, lo, 6), post_plain(b, hi, 6), unit);
}

/* Earlier versions wrote the inertia of the contact only. */
static const char *inertia_of(const modal_model *m) {
  bool load   = m->load_inertia || !m->load_residual;
  bool probes = m->n_probes == 0 || !m->probe_contact_residual ||
                (m->probe_contact_inertia && m->probe_load_inertia);
  if (!m->residual_inertia) return "no";
  return load && probes ? "yes" : "of the contact alone: not of load and probes";
}

/* Frequencies over the speed at every nodal diameter of a disc. */
static shb_status put_sector_speeds(const char *path, bool verbose, post_buffer *out) {
  modal_sector_speeds all;
  SHB_TRY(modal_sector_speeds_read(path, &all));
  for (int i = 0; i < all.n; i++) {
    post_put(out, "  nodal diameter %d:\n", all.diameter[i]);
    post_campbell_table(&all.at[i], verbose, out);
  }
  modal_sector_speeds_free(&all);
  return SHB_OK;
}

static shb_status sum_up_modal(hid_t file, const char *path, bool verbose, post_buffer *out) {
  modal_model m;
  SHB_TRY(modal_model_read(path, &m));
  put_count(out, m.n_modes, "mode");
  if (m.n_modes > 0) {
    post_put(out, " ");
    put_span(out, m.frequency[0], m.frequency[m.n_modes - 1], "Hz");
  }
  post_put(out, "; ");
  if (m.n_pairs > 0) {
    put_count(out, m.n_pairs, "pair");
    put_interfaces(out, m.n_pairs, m.interface, m.n_interfaces, m.interface_name);
    post_put(out, ", %s", m.has_left ? "neighbour" : "ground");
  } else {
    post_put(out, "no contact");
  }
  post_put(out, "; load harmonics 0..%d; ", m.n_load);
  put_names(out, m.n_probes, m.probe_name);
  post_put(out, "; residual flexibility %s, inertia %s", m.residual_flexibility ? "yes" : "no",
           inertia_of(&m));
  if (m.n_residual > 0) post_put(out, ", ");
  if (m.n_residual > 0) put_count(out, m.n_residual, "residual mode");
  post_put(out, "\n");
  modal_nodal_diameters diameters;
  modal_speeds          speeds = {0};
  shb_status            status = modal_nodal_diameters_read(path, &diameters);
  if (status == SHB_OK && diameters.n == 0) status = post_mode_table(file, &m, verbose, out);
  if (diameters.n > 0) status = post_diameter_table(file, &diameters, verbose, out);
  modal_nodal_diameters_free(&diameters);
  if (status == SHB_OK) status = modal_speeds_read(path, &speeds);
  if (speeds.n > 0) post_campbell_table(&speeds, verbose, out);
  modal_speeds_free(&speeds);
  if (status == SHB_OK) status = put_sector_speeds(path, verbose, out);
  if (status == SHB_OK) status = post_phase_table(file, out);
  modal_model_free(&m);
  return status;
}

/* "90 … 270 Hz", "scale 0.05 … 10 at 240 Hz" */
static void put_range(const post_analysis *analysis, post_buffer *out) {
  const post_abscissa *x = &analysis->abscissa;
  if (post_at_one_frequency(analysis)) {
    const char *unit = mhb_parameter_unit(x->parameter);
    post_put(out, "%s ", mhb_parameter_name(x->parameter));
    put_span(out, x->range[0], x->range[1], unit);
    post_put(out, *unit ? " at " : "at ");
  }
  put_span(out, analysis->frequency[0], analysis->frequency[1], "Hz");
}

static void sum_up_branches(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r = analysis->response;
  int nonlinear = 0, linear = 0, tracked = 0, cut = 0, folds = 0, last = analysis->n_ranks - 1;
  for (int b = 0; b < r->n_branches; b++) {
    mhb_branch_kind kind = r->branch[b].kind;
    nonlinear += kind == MHB_BRANCH_NONLINEAR;
    linear += kind == MHB_BRANCH_OPEN || kind == MHB_BRANCH_STUCK;
    tracked += kind == MHB_BRANCH_TRACKED;
    cut += !r->branch[b].complete;
    folds += analysis->curve[b].n_folds;
  }
  if (tracked > 0) {
    put_count(out, tracked, "curve");
    post_put(out, " of tracked %s points", r->track ? r->track : "");
  } else {
    put_count(out, nonlinear, "nonlinear curve");
  }
  if (last >= 0) {
    post_put(out, ", n0 ");
    put_span(out, analysis->group[0].n0, analysis->group[last].n0, "N");
  }
  if (tracked == 0) {
    post_put(out, "; ");
    put_count(out, linear, "linear limit");
  }
  if (r->n_branches > nonlinear + linear + tracked) {
    post_put(out, "; ");
    put_count(out, r->n_branches - nonlinear - linear - tracked, "curve");
    post_put(out, " by time integration");
  }
  post_put(out, "; ");
  put_count(out, analysis->n_points, "point");
  post_put(out, ", ");
  put_range(analysis, out);
  post_put(out, "; ");
  put_count(out, folds, "fold");
  if (cut) post_put(out, "; %d not complete", cut);
  if (r->run_up) post_put(out, "\n  ");
  post_put_run_up(analysis, out);
  post_put(out, "\n  ");
}

static shb_status sum_up_response(const char *path, post_buffer *out) {
  mhb_response  *r;
  post_analysis *analysis;
  SHB_TRY(mhb_response_read(path, &r));
  shb_status status = post_analysis_create(r, &analysis);
  if (status == SHB_OK) {
    post_buffer peaks = {0};
    sum_up_branches(analysis, out);
    post_put_harmonics(r, out);
    post_put(out, "; ");
    put_count(out, r->n_pairs, "pair");
    put_interfaces(out, r->n_pairs, r->interface, r->n_interfaces, r->interface_name);
    post_put(out, "; ");
    put_names(out, r->n_probes, r->probe_name);
    post_summary(analysis, &peaks);
    if (peaks.text) post_put(out, "\n  %s", peaks.text);
    post_put(out, "\n");
    post_buffer_free(&peaks);
    post_analysis_destroy(analysis);
  }
  mhb_response_destroy(r);
  return status;
}

/* ---------------------------------------------------------------- provenance */

static void put_field(const char *label, const char *text, bool colour, post_buffer *out) {
  if (!*text) return;
  post_put(out, "  %s%-9s%s ", colour ? "\033[2m" : "", label, colour ? "\033[0m" : "");
  post_put_printable(out, text);
  post_put(out, "\n");
}

static int count_lines(const char *text) {
  int n = 0;
  for (; *text; text++) n += *text == '\n' || text[1] == '\0';
  return n;
}

/* Write the text indented. */
static void put_quoted(const char *text, post_buffer *out) {
  while (*text) {
    char   line[1024];
    size_t n = strcspn(text, "\n");
    snprintf(line, sizeof line, "%.*s", (int)(n < 1000 ? n : 1000), text);
    post_put(out, "    ");
    post_put_printable(out, line);
    post_put(out, "\n");
    text += n + (text[n] == '\n');
  }
}

static void put_block(const char *label, const char *text, post_tree_style style,
                      post_buffer *out) {
  char line[64];
  int  n = count_lines(text);
  if (!*text) return;
  snprintf(line, sizeof line, "%d line%s%s", n, n == 1 ? "" : "s",
           style.verbose ? ":" : " (--verbose shows them)");
  put_field(label, line, style.colour, out);
  if (style.verbose) put_quoted(text, out);
}

static void put_source(const post_origin *s, post_tree_style style, post_buffer *out) {
  put_field("created", s->created, style.colour, out);
  put_field("revision", s->revision, style.colour, out);
  put_field("command", s->command, style.colour, out);
  put_field("case", s->case_path, style.colour, out);
  put_block("case text", s->case_text, style, out);
  put_block("settings", s->settings, style, out);
}

/* ---------------------------------------------------------------- together */

static void put_title(const char *path, const post_origin *s, bool colour, post_buffer *out) {
  struct stat info;
  const char *bold = colour ? "\033[1m" : "", *off = colour ? "\033[0m" : "";
  post_put(out, "%s%s%s  ", bold, path, off);
  if (*s->format) {
    post_put_printable(out, s->format);
    post_put(out, ", version %d", s->version);
  }
  if (!*s->format) post_put(out, "foreign HDF5 file (no attribute format)");
  if (stat(path, &info) == 0) {
    char size[POST_NUMBER];
    bool mega = info.st_size >= 1000000;
    post_put(out, ", %s %s", post_plain(size, (double)info.st_size / (mega ? 1e6 : 1e3), 3),
             mega ? "MB" : "kB");
  }
  post_put(out, "\n  ");
}

static shb_status sum_up(hid_t file, const char *path, const post_origin *s, bool verbose,
                         post_buffer *out) {
  if (strcmp(s->format, "shroudhb modal model") == 0) return sum_up_modal(file, path, verbose, out);
  if (strcmp(s->format, "shroudhb response") == 0) return sum_up_response(path, out);
  post_put(out, "not one of shroudhb's files: only its tree can be shown\n");
  return SHB_OK;
}

static shb_status inspect_open(hid_t file, const char *path, post_tree_style style,
                               post_buffer *out) {
  post_origin source;
  SHB_TRY(post_origin_read(file, &source));
  put_title(path, &source, style.colour, out);
  shb_status verdict = sum_up(file, path, &source, style.verbose, out);
  if (verdict != SHB_OK) post_put(out, "not usable: %s\n", shb_message());
  post_put(out, "\n");
  put_source(&source, style, out);
  post_origin_free(&source);
  post_put(out, "\n");
  char *message =
      verdict != SHB_OK ? strdup(shb_message()) : NULL; /* the tree may record another message */
  shb_status status = post_tree(file, style, out);
  if (status == SHB_OK && verdict != SHB_OK)
    status = shb_fail(verdict, __FILE__, __LINE__, "%s", message ? message : "not usable");
  free(message);
  return status;
}

shb_status post_inspect(const char *path, post_tree_style style, post_buffer *out) {
  hid_t file;
  SHB_TRY(h5_open(path, &file));
  shb_status status = inspect_open(file, path, style, out);
  H5Fclose(file);
  if (out->failed) SHB_FAIL(SHB_ERR_IO, "%s: not enough memory to list it", path);
  return status;
}
