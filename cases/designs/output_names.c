#include "cases/designs/output_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/keys.h"
#include "mesh/base/publish.h"
#include "mhb/tracking/peak_system.h"
#include "modal/hdf5/h5.h"

static const struct {
  const char *name, *unit;
} words[] = {{"peak", "m"},        {"frequency", "Hz"}, {"peak_to_peak", "m"}, {"stable", "-"},
             {"dissipation", "J"}, {"stress", "Pa"},    {"safety", "-"},       {"rss", "m"}};
enum { N_WORDS = sizeof words / sizeof *words };

static void set(study_output *out, study_quantity quantity, int index, const char *name,
                const char *unit) {
  *out = (study_output){.quantity = quantity, .index = index};
  snprintf(out->name, sizeof out->name, "%s", name);
  snprintf(out->unit, sizeof out->unit, "%s", unit);
}

/* What a case offers: the probes of the case, or of its modal file. */
typedef struct {
  int    n_modes; /* 0: not known before the modes are computed */
  int    n_probes;
  char **probe; /* [n_probes] of a modal file, else NULL */
  bool   has_no_stress;
} offer;

static void read_modal_file(const char *path, offer *o) {
  hid_t    file;
  h5_shape shape;
  if (h5_open(path, &file) != SHB_OK) return; /* the run says why */
  const bool disc = h5_exists(file, "/nodal_diameter_0");
  hid_t      at   = disc ? H5Gopen2(file, "/nodal_diameter_0", H5P_DEFAULT) : file;
  if (h5_exists(at, "probe") && h5_exists(at, "probe/name") &&
      h5_read_strings(at, "probe/name", &o->n_probes, &o->probe) != SHB_OK)
    o->n_probes = 0;
  const bool modes = h5_exists(at, "modes");
  if (modes && h5_exists(at, "modes/frequency") &&
      h5_shape_of(at, "modes/frequency", &shape) == SHB_OK && shape.rank == 1)
    o->n_modes = (int)shape.dim[0];
  o->has_no_stress = !h5_exists(file, "/mesh") || !modes || !h5_exists(at, "modes/stress");
  if (disc) H5Gclose(at);
  h5_close(file);
}

static offer offer_of(const case_file *file) {
  offer o = {.n_modes = file->modes, .n_probes = file->n_probes};
  if (file->modal_file) {
    o = (offer){0};
    read_modal_file(file->modal_file, &o);
  }
  return o;
}

static void free_offer(offer *o) {
  for (int i = 0; o->probe && i < o->n_probes; i++) free(o->probe[i]);
  free(o->probe);
}

static const char *probe_of(const offer *o, const case_file *file, int i) {
  return o->probe ? o->probe[i] : file->probe[i].name;
}

/* Read "modes[I].frequency". Returns 1 if it is one, 0 if not, -1 with a reason if it is wrong. */
static int parse_mode(const char *name, const offer *o, study_output *out, char *why, size_t size) {
  char *end;
  if (strncmp(name, "modes[", 6) != 0) return 0;
  long i = strtol(name + 6, &end, 10);
  if (end == name + 6 || strcmp(end, "].frequency") != 0) {
    snprintf(why, size, "'%s': expected modes[I].frequency, I from 1", name);
    return -1;
  }
  if (i < 1 || (o->n_modes > 0 && i > o->n_modes)) {
    snprintf(why, size, "'%s': the modes of the case are 1 to %d", name, o->n_modes);
    return -1;
  }
  set(out, STUDY_MODE_FREQUENCY, (int)i - 1, name, "Hz");
  return 1;
}

/* Whether any material of the case has Goodman's line. */
static bool has_fatigue(const case_file *file) {
  for (int i = 0; i < file->n_materials; i++)
    if (file->materials[i].endurance > 0) return true;
  return false;
}

/* Whether the case gives what stress, safety and strain need; else a reason. */
static bool check_field(const char *name, study_quantity quantity, const case_file *file,
                        const offer *o, char *why, size_t size) {
  why[0] = '\0';
  if (o->has_no_stress)
    snprintf(why, size, "'%s' needs the stress of the modes, which modal.file has not", name);
  else if (file->run_up)
    snprintf(why, size, "'%s' is not known in a run-up: its modes change with the speed", name);
  else if (quantity == STUDY_SAFETY && !has_fatigue(file))
    snprintf(why, size, "'safety' needs material.fatigue: {endurance, ultimate}");
  return !why[0];
}

static int parse_gauge(const char *name, const case_file *file, const offer *o, study_output *out,
                       char *why, size_t size) {
  for (int i = 0; i < file->n_gauges; i++) {
    if (strcmp(name, file->gauge[i].name) != 0) continue;
    set(out, STUDY_GAUGE, i, name, "-");
    return check_field(name, STUDY_GAUGE, file, o, why, size) ? 1 : -1;
  }
  return 0;
}

/* Returns 1 if the name is an output, -1 with a reason if it is a wrong one, 0 if it is none. */
static int parse(const char *name, const case_file *file, const offer *o, study_output *out,
                 char *why, size_t size) {
  for (int i = 0; i < N_WORDS; i++)
    if (strcmp(name, words[i].name) == 0) {
      bool field = i == STUDY_STRESS || i == STUDY_SAFETY;
      set(out, (study_quantity)i, 0, name, words[i].unit);
      return !field || check_field(name, (study_quantity)i, file, o, why, size) ? 1 : -1;
    }
  for (int i = 0; i < o->n_probes; i++)
    if (strcmp(name, probe_of(o, file, i)) == 0) {
      if (!shb_name_is_plain(name)) {
        snprintf(why, size, "the name of a probe is empty or holds control characters");
        return -1;
      }
      set(out, STUDY_PROBE, i, name, "m");
      return 1;
    }
  int gauge = parse_gauge(name, file, o, out, why, size);
  return gauge != 0 ? gauge : parse_mode(name, o, out, why, size);
}

bool study_output_parse(const char *name, const case_file *file, study_output *out, char *why,
                        size_t size) {
  offer o    = offer_of(file);
  int   what = parse(name, file, &o, out, why, size);
  if (what == 0) {
    why[0] = '\0';
    case_append(why, size, "'%s' is no output of this case; known: ", name);
    for (int i = 0; i < N_WORDS; i++) case_append(why, size, "%s, ", words[i].name);
    for (int i = 0; i < o.n_probes; i++) case_append(why, size, "%s, ", probe_of(&o, file, i));
    for (int i = 0; i < file->n_gauges; i++) case_append(why, size, "%s, ", file->gauge[i].name);
    case_append(why, size, "modes[I].frequency");
  }
  free_offer(&o);
  return what > 0;
}

int study_derivatives(int n_outputs, const study_output *output) {
  for (int i = 0; i < n_outputs; i++)
    if (output[i].quantity == STUDY_PEAK) return MHB_PEAK_PARAMETERS;
  return 0;
}

static bool is_one_number(const case_file *file) {
  return !file->modal_file &&
         (file->damping.kind == MODAL_DAMPING_ALL || file->damping.kind == MODAL_DAMPING_LOSS);
}

double study_damping(const case_file *file) {
  if (!file || !is_one_number(file)) return 1;
  return file->damping.kind == MODAL_DAMPING_ALL ? file->damping.ratio : file->damping.loss;
}

void study_derivative(const case_file *file, int i, char name[STUDY_UNIT_TEXT],
                      char unit[STUDY_UNIT_TEXT], double *value) {
  static const char *const  units[] = {"m/N", "m", "m", "m^2/N", "m^2/N", "m"};
  const mhb_operating_point at      = mhb_operating_point_of(&file->mhb);
  snprintf(unit, STUDY_UNIT_TEXT, "%s", units[i]);
  if (i < MHB_PEAK_BY_DAMPING) {
    snprintf(name, STUDY_UNIT_TEXT, "%s", mhb_parameter_name(mhb_peak_parameter(i)));
    *value = mhb_parameter_get(&at, mhb_peak_parameter(i));
    return;
  }
  snprintf(name, STUDY_UNIT_TEXT, "%s", is_one_number(file) ? "damping" : "damping_factor");
  *value = study_damping(file);
}
