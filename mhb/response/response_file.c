/* Writing and reading of response files: the root. Each branch has a group (branch_file.h). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/parameter.h"
#include "mhb/response/branch_file.h"
#include "mhb/response/face_wear.h"
#include "mhb/response/response.h"
#include "mhb/response/response_fields.h"
#include "modal/hdf5/h5.h"

static const char response_format[] = "shroudhb response";
enum { RESPONSE_VERSION = 1 };

/* ---- writing ---- */

static shb_status write_probe_names(hid_t file, const mhb_response *response) {
  if (response->n_probes == 0) return SHB_OK;
  const char **name = shb_alloc_zeroed((size_t)response->n_probes, sizeof *name);
  for (int i = 0; i < response->n_probes; i++)
    name[i] = response->probe_name[i] ? response->probe_name[i] : "";
  shb_status status =
      h5_write_strings(file, "/probe/name", response->n_probes, name, "name of the probe");
  free(name);
  return status;
}

static shb_status write_interfaces(hid_t file, const mhb_response *response) {
  if (response->n_interfaces < 2) return SHB_OK;
  SHB_TRY(h5_write_strings(file, "/interface_name", response->n_interfaces,
                           (const char *const *)response->interface_name, "contact interface"));
  SHB_TRY(h5_write_int(file, "/interface", H5_SHAPE((hsize_t)response->n_pairs),
                       response->interface, "-", "contact interface of each pair, from 0"));
  return h5_write_attribute_text(file, "/", "followed_interface",
                                 response->interface_name[response->lead]);
}

static shb_status write_scales(hid_t file, const mhb_response *response) {
  static const char *const shroud[] = {"v", "u", "w"}, *const state[] = {"stuck", "slip", "open"},
                           *const axis[] = {"tangential", "axial", "radial"};
  SHB_TRY(h5_write_strings(file, "/shroud_axis", 3, shroud, "shroud axes: normal v, sliding u, w"));
  SHB_TRY(h5_write_strings(file, "/axis", 3, axis, "cylindrical axes about the engine axis"));
  SHB_TRY(h5_write_strings(file, "/contact_state", 3, state, "contact state"));
  SHB_TRY(h5_write_counter(file, "/pair", (hsize_t)response->n_pairs, "contact pair, from 0"));
  SHB_TRY(
      h5_write_counter(file, "/harmonic", (hsize_t)response->n_harmonics + 1,
                       "harmonic k of omega / subharmonics; x(t) = Re sum_k A_k exp(j k omega t / "
                       "subharmonics)"));
  if (response->n_multipliers > 0)
    SHB_TRY(h5_write_counter(file, "/multiplier", (hsize_t)response->n_multipliers,
                             "Floquet multiplier, by falling modulus"));
  if (response->n_lines > 0)
    SHB_TRY(h5_write_counter(file, "/line", (hsize_t)response->n_lines,
                             "spectral line, largest first"));
  SHB_TRY(write_interfaces(file, response));
  return write_probe_names(file, response);
}

static const char *const optimum_name[MHB_OPTIMUM_KINDS] = {[MHB_OPTIMUM_NONE]     = "none",
                                                            [MHB_OPTIMUM_SMOOTH]   = "smooth",
                                                            [MHB_OPTIMUM_EXCHANGE] = "exchange",
                                                            [MHB_OPTIMUM_END]      = "end of range",
                                                            [MHB_OPTIMUM_JUMP]     = "jump"};

/* What mhb.track followed, and where the highest peak is least. */
static shb_status write_tracking(hid_t file, const mhb_response *response) {
  const mhb_optimum *o = &response->optimum;
  if (!response->track) return SHB_OK;
  SHB_TRY(h5_write_attribute_text(file, "/", "track", response->track));
  SHB_TRY(h5_write_attribute_text(file, "/", "output", response->output));
  if (response->output_harmonic > 1)
    SHB_TRY(h5_write_attribute_int(file, "/", "output_harmonic", response->output_harmonic));
  SHB_TRY(h5_write_attribute_text(file, "/", "output_quantity",
                                  mhb_output_quantity_word(response->quantity)));
  if (o->kind == MHB_OPTIMUM_NONE) return SHB_OK;
  const h5_shape one  = {.rank = 0};
  const char    *unit = mhb_parameter_unit(response->parameter);
  SHB_TRY(h5_write_double(file, "/optimum/parameter", one, &o->value, unit,
                          "parameter at which the highest tracked peak is least"));
  SHB_TRY(h5_write_double(file, "/optimum/error", one, &o->error, unit,
                          "length of the bracket that the optimum was located in"));
  SHB_TRY(h5_write_double(file, "/optimum/amplitude", one, &o->amplitude, "m",
                          "amplitude of the output there"));
  SHB_TRY(h5_write_double(file, "/optimum/frequency", H5_SHAPE(2), o->frequency, "Hz",
                          "frequency of the peak; of both peaks of an exchange, else 0"));
  SHB_TRY(h5_write_attribute_int(file, "/optimum", "verified", o->verified));
  return h5_write_attribute_text(file, "/optimum", "kind", optimum_name[o->kind]);
}

/* The quantity of a file. Until version 0.2 tracked files without one had the rss. */
static mhb_output_quantity quantity_of(const char *word, bool tracked) {
  int q = MHB_OUTPUT_RSS;
  if (!word) return tracked ? MHB_OUTPUT_RSS : MHB_OUTPUT_HARMONIC;
  while (q > 0 && strcmp(word, mhb_output_quantity_word((mhb_output_quantity)q)) != 0) q--;
  return (mhb_output_quantity)q;
}

/* Files without mhb.track have none of it. */
static shb_status read_tracking(hid_t file, const char *path, mhb_response *response) {
  mhb_optimum *o    = &response->optimum;
  char        *kind = NULL, *quantity = NULL;
  SHB_TRY(h5_read_attribute_text(file, "/", "track", &response->track));
  response->tracks_multiplier = mhb_track_by_multiplier(response->track);
  SHB_TRY(h5_read_attribute_text(file, "/", "output", &response->output));
  SHB_TRY(h5_read_attribute_int(file, "/", "output_harmonic", 1, &response->output_harmonic));
  SHB_TRY(h5_read_attribute_text(file, "/", "output_quantity", &quantity));
  response->quantity = quantity_of(quantity, response->track != NULL);
  free(quantity);
  if (!response->track || !h5_exists(file, "/optimum")) return SHB_OK;
  SHB_TRY(h5_read_attribute_text(file, "/optimum", "kind", &kind));
  int at = 0;
  while (kind && at < MHB_OPTIMUM_KINDS && strcmp(kind, optimum_name[at]) != 0) at++;
  bool known = kind && at < MHB_OPTIMUM_KINDS;
  free(kind);
  SHB_CHECK(known, SHB_ERR_INPUT,
            "%s: /optimum: attribute kind is not one of none, smooth, "
            "exchange, end of range, jump",
            path);
  const struct {
    const char *name;
    double     *to;
    int         n;
  } part[] = {{"/optimum/parameter", &o->value, 1},
              {"/optimum/error", &o->error, 1},
              {"/optimum/amplitude", &o->amplitude, 1},
              {"/optimum/frequency", o->frequency, 2}};
  for (int i = 0; i < 4; i++) {
    h5_shape shape = part[i].n == 1 ? (h5_shape){.rank = 0} : H5_SHAPE(2);
    double  *values;
    SHB_TRY(h5_read_double(file, part[i].name, &shape, &values));
    memcpy(part[i].to, values, sizeof(double) * (size_t)part[i].n);
    free(values);
  }
  int verified;
  SHB_TRY(h5_read_attribute_int(file, "/optimum", "verified", 0, &verified));
  o->kind     = (mhb_optimum_kind)at;
  o->verified = verified != 0;
  return SHB_OK;
}

static shb_status write_root(hid_t file, const mhb_response *response) {
  SHB_TRY(h5_write_attribute_int(file, "/", "branches", response->n_branches));
  SHB_TRY(h5_write_attribute_int(file, "/", "engine_order", response->engine_order));
  SHB_TRY(h5_write_attribute_int(file, "/", "blades", response->blades));
  if (response->turns_right) SHB_TRY(h5_write_attribute_text(file, "/", "rotor_turns", "right"));
  SHB_TRY(h5_write_attribute_int(file, "/", "subharmonics", response->subharmonics));
  if (response->run_up) SHB_TRY(h5_write_attribute_int(file, "/", "run_up", 1));
  if (response->ring) {
    SHB_TRY(h5_write_attribute_int(file, "/", "ring", response->ring));
    SHB_TRY(h5_write_counter(file, "/blade", (hsize_t)response->ring,
                             "blade of a ring, from 0; of ring/wave: nodal diameters j"));
  }
  if (response->lacks_diameters)
    SHB_TRY(h5_write_attribute_int(file, "/", "lacks_nodal_diameters", 1));
  if (response->unfinished) SHB_TRY(h5_write_attribute_int(file, "/", "finished", 0));
  SHB_TRY(h5_write_attribute_text(file, "/", "parameter", mhb_parameter_name(response->parameter)));
  SHB_TRY(write_tracking(file, response));
  if (response->samples) SHB_TRY(mhb_samples_write(file, response->samples));
  SHB_TRY(h5_write_attribute_double(file, "/", "psi", response->psi));
  SHB_TRY(h5_write_attribute_double(file, "/", "phi", response->phi));
  SHB_TRY(h5_write_attribute_text(file, "/", "angle_units", "rad"));
  SHB_TRY(write_scales(file, response));
  if (response->n_modes == 0) return SHB_OK;
  const h5_shape modes = H5_SHAPE((hsize_t)response->n_modes);
  SHB_TRY(h5_write_double(file, "/modes/frequency", modes, response->mode_frequency, "Hz",
                          "undamped natural frequency of the free blade"));
  SHB_TRY(h5_write_double(file, "/modes/damping_ratio", modes, response->mode_damping, "-",
                          "modal damping ratio"));
  SHB_TRY(h5_attach_scale(file, "/modes/damping_ratio", 0, "/modes/frequency"));
  if (!response->eigen_residual) return SHB_OK;
  SHB_TRY(h5_write_double(file, "/modes/residual", modes, response->eigen_residual, "-",
                          "relative residual of the eigenpair"));
  return h5_attach_scale(file, "/modes/residual", 0, "/modes/frequency");
}

typedef struct {
  const mhb_response   *response;
  const shb_provenance *provenance;
} contents;

static shb_status write_parts(hid_t file, const void *context) {
  const contents     *c        = context;
  const mhb_response *response = c->response;
  SHB_TRY(h5_write_provenance(file, response_format, RESPONSE_VERSION, c->provenance));
  SHB_TRY(write_root(file, response));
  if (response->face) SHB_TRY(mhb_contact_face_write(file, response->face));
  for (int i = 0; i < response->n_branches; i++) SHB_TRY(mhb_branch_write(file, response, i));
  return SHB_OK;
}

shb_status mhb_response_write(const mhb_response *response, const char *path,
                              const shb_provenance *provenance) {
  return h5_publish(path, write_parts, &(contents){response, provenance});
}

/* ---- reading ---- */

static shb_status read_sizes(hid_t file, const char *path, int *n_pairs, int *n_harmonics) {
  h5_shape pair, harmonic;
  SHB_TRY(h5_shape_of(file, "/pair", &pair));
  SHB_TRY(h5_shape_of(file, "/harmonic", &harmonic));
  SHB_CHECK(pair.rank == 1 && pair.dim[0] <= MHB_MOST_ENTRIES && harmonic.rank == 1 &&
                harmonic.dim[0] >= 1 && harmonic.dim[0] <= MHB_MOST_ENTRIES,
            SHB_ERR_INPUT, "%s: /pair and /harmonic must be lists of at most %d", path,
            MHB_MOST_ENTRIES);
  *n_pairs     = (int)pair.dim[0];
  *n_harmonics = (int)harmonic.dim[0] - 1;
  return SHB_OK;
}

static shb_status read_modes(hid_t file, mhb_response *response) {
  if (!h5_exists(file, "/modes")) return SHB_OK;
  h5_shape modes = H5_SHAPE(0);
  SHB_TRY(h5_read_double(file, "/modes/frequency", &modes, &response->mode_frequency));
  SHB_TRY(h5_read_double(file, "/modes/damping_ratio", &modes, &response->mode_damping));
  if (h5_exists(file, "/modes/residual"))
    SHB_TRY(h5_read_double(file, "/modes/residual", &modes, &response->eigen_residual));
  response->n_modes = (int)modes.dim[0];
  return SHB_OK;
}

/* *count <- length of a list; as it is if the file, of an earlier version, has none. */
static shb_status read_count(hid_t file, const char *path, const char *name, int *count) {
  h5_shape shape;
  if (!h5_exists(file, name)) return SHB_OK;
  SHB_TRY(h5_shape_of(file, name, &shape));
  SHB_CHECK(shape.rank == 1 && shape.dim[0] <= MHB_MOST_ENTRIES, SHB_ERR_INPUT,
            "%s: %s must be a list of at most %d", path, name, MHB_MOST_ENTRIES);
  *count = (int)shape.dim[0];
  return SHB_OK;
}

static shb_status read_parameter(hid_t file, const char *path, mhb_parameter *parameter) {
  char *text = NULL;
  SHB_TRY(h5_read_attribute_text(file, "/", "parameter", &text));
  int found = 0;
  while (text && found < MHB_N_PARAMETERS && strcmp(text, mhb_parameter_name(found)) != 0) found++;
  free(text);
  SHB_CHECK(found < MHB_N_PARAMETERS, SHB_ERR_INPUT,
            "%s: the root attribute parameter must be frequency, n0, scale, mu, ku or kv", path);
  *parameter = (mhb_parameter)found;
  return SHB_OK;
}

/* Files of one interface have none of these. */
static shb_status read_interfaces(hid_t file, const char *path, mhb_response *response) {
  h5_shape pairs = H5_SHAPE((hsize_t)response->n_pairs);
  char    *lead  = NULL;
  if (!h5_exists(file, "/interface_name")) return SHB_OK;
  SHB_TRY(
      h5_read_strings(file, "/interface_name", &response->n_interfaces, &response->interface_name));
  SHB_TRY(h5_read_int(file, "/interface", &pairs, &response->interface));
  for (int i = 0; i < response->n_pairs; i++)
    SHB_CHECK(response->interface[i] >= 0 && response->interface[i] < response->n_interfaces,
              SHB_ERR_INPUT, "%s: /interface: value %d (from 0) is %d; 0 to %d are wanted", path, i,
              response->interface[i], response->n_interfaces - 1);
  SHB_TRY(h5_read_attribute_text(file, "/", "followed_interface", &lead));
  for (int i = 0; i < response->n_interfaces; i++)
    if (lead && strcmp(lead, response->interface_name[i]) == 0) response->lead = i;
  free(lead);
  return SHB_OK;
}

/* Files say nothing of a rotor that turns to the left. */
static shb_status read_turning(hid_t file, const char *path, mhb_response *response) {
  char *side = NULL;
  SHB_TRY(h5_read_attribute_text(file, "/", "rotor_turns", &side));
  response->turns_right = side && strcmp(side, "right") == 0;
  const bool known      = !side || response->turns_right || strcmp(side, "left") == 0;
  free(side);
  SHB_CHECK(known, SHB_ERR_INPUT, "%s: rotor_turns must be left or right", path);
  return SHB_OK;
}

/* Sizes, probe names and root attributes. */
static shb_status read_root(hid_t file, const char *path, mhb_response **out) {
  int    n_pairs = 0, n_harmonics = 0, n_probes = 0;
  char **name = NULL;
  SHB_TRY(read_sizes(file, path, &n_pairs, &n_harmonics));
  if (h5_exists(file, "/probe")) SHB_TRY(h5_read_strings(file, "/probe/name", &n_probes, &name));
  mhb_response *response = *out = mhb_response_create(n_pairs, n_probes, n_harmonics);
  for (int i = 0; i < n_probes; i++) response->probe_name[i] = name[i];
  free(name);
  SHB_TRY(h5_read_attribute_int(file, "/", "engine_order", 0, &response->engine_order));
  SHB_TRY(h5_read_attribute_int(file, "/", "blades", 0, &response->blades));
  SHB_TRY(read_turning(file, path, response));
  SHB_TRY(h5_read_attribute_int(file, "/", "subharmonics", 1, &response->subharmonics));
  SHB_TRY(h5_read_attribute_int(file, "/", "ring", 0, &response->ring));
  SHB_CHECK(
      response->ring >= 0 && (response->ring == 0 || (response->n_pairs % response->ring == 0 &&
                                                      response->n_probes % response->ring == 0)),
      SHB_ERR_INPUT, "%s: ring is %d, but there are %d pairs and %d probes", path, response->ring,
      response->n_pairs, response->n_probes);
  int run_up = 0, finished = 1, lacks = 0;
  SHB_TRY(h5_read_attribute_int(file, "/", "lacks_nodal_diameters", 0, &lacks));
  SHB_TRY(h5_read_attribute_int(file, "/", "run_up", 0, &run_up));
  SHB_TRY(h5_read_attribute_int(file, "/", "finished", 1, &finished));
  response->unfinished      = finished == 0;
  response->lacks_diameters = lacks != 0;
  response->run_up          = run_up != 0 && response->engine_order >= 1;
  SHB_TRY(read_tracking(file, path, response));
  SHB_TRY(mhb_samples_read(file, &response->samples));
  SHB_TRY(h5_read_attribute_double(file, "/", "psi", 0, &response->psi));
  SHB_TRY(h5_read_attribute_double(file, "/", "phi", 0, &response->phi));
  SHB_CHECK(response->subharmonics >= 1, SHB_ERR_INPUT,
            "%s: subharmonics is %d; 1 or more is wanted", path, response->subharmonics);
  SHB_TRY(read_parameter(file, path, &response->parameter));
  SHB_TRY(read_count(file, path, "/multiplier", &response->n_multipliers));
  SHB_TRY(read_count(file, path, "/line", &response->n_lines));
  SHB_TRY(read_interfaces(file, path, response));
  return read_modes(file, response);
}

static shb_status read_parts(hid_t file, const char *path, mhb_response **response) {
  int n_branches = -1;
  SHB_TRY(h5_check_format(file, response_format, RESPONSE_VERSION));
  SHB_TRY(read_root(file, path, response));
  SHB_TRY(h5_read_attribute_int(file, "/", "branches", -1, &n_branches));
  SHB_CHECK(n_branches >= 0, SHB_ERR_INPUT, "%s: the root attribute branches is missing", path);
  for (int i = 0; i < n_branches; i++) SHB_TRY(mhb_branch_read(file, path, *response));
  return SHB_OK;
}

shb_status mhb_response_read(const char *path, mhb_response **response) {
  *response = NULL;
  hid_t file;
  SHB_TRY(h5_open(path, &file));
  shb_status status = read_parts(file, path, response);
  h5_close(file);
  if (status == SHB_OK) return SHB_OK;
  mhb_response_destroy(*response);
  *response = NULL;
  return status;
}
