#include "cases/schema/checks.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cases/schema/case_paths.h"
#include "cases/schema/interfaces.h"
#include "cases/schema/loads.h"
#include "cases/schema/materials.h"
#include "cases/schema/unused_keys.h"
#include "mesh/base/constants.h"
#include "mesh/core/file_format.h"
#include "mesh/table/text_file.h"
#include "mhb/mistuning/deviation_table.h"
#include "mhb/problem/parameter.h"

static void check_mesh(case_reader *r, int stages) {
  bool file         = case_reader_given(r, "mesh.file") != NULL,
       blade        = case_reader_has_block(r, "mesh.blade");
  r->file->has_mesh = case_reader_has_block(r, "mesh");
  if (file && blade)
    case_reader_issue(r, "mesh.blade", "give either mesh.blade or mesh.file, not both");
  bool needed = stages & (CASE_MESH | CASE_MODAL) && !r->file->modal_file;
  if (needed && !file && !blade)
    case_reader_issue(r, "mesh", "missing; expected {blade: ...} or {file: NAME}");
}

/* Refuses parametric blades that cannot be meshed. */
static void check_blade(case_reader *r, int stages) {
  const mesh_blade *blade  = &r->file->blade;
  double            degree = 180 / SHB_PI;
  if (r->file->modal_file || !(stages & CASE_MESH) || !case_reader_has_block(r, "mesh.blade"))
    return;
  const case_place contact = case_reader_place(r, "contact.interfaces", "contact", 0);
  if (case_place_good(&contact, "psi") && fabs(blade->psi) * degree > MESH_MAX_PSI)
    case_place_issue(&contact, "psi", "a parametric blade needs -%d to %d deg", MESH_MAX_PSI,
                     MESH_MAX_PSI);
  if (case_place_good(&contact, "phi") && fabs(blade->phi) * degree > MESH_MAX_PHI)
    case_place_issue(&contact, "phi", "a parametric blade needs -%d to %d deg", MESH_MAX_PHI,
                     MESH_MAX_PHI);
  if (case_reader_good(r, "rotor.blades") && blade->blades == 2)
    case_reader_issue(r, "rotor.blades", "a parametric blade needs 3 or more");
}

void case_check_alternatives(case_reader *r, int stages) {
  check_mesh(r, stages);
  case_check_load(r);
}

static void check_sections(case_reader *r) {
  static const char   path[] = "mesh.blade.sections";
  static const double degree = 180 / SHB_PI;
  const mesh_blade   *blade  = &r->file->blade;
  const case_node    *node   = case_reader_given(r, path);
  for (int i = 0; node && case_reader_good(r, path) && i < blade->n_sections; i++) {
    const mesh_section *s = &blade->section[i];
    char                full[CASE_PATH];
    case_path(full, "%s[%d]", path, i);
    if (i > 0 && s->radius <= s[-1].radius)
      case_reader_issue(r, full, "radius is %g m, must be above that of the section before, %g m",
                        s->radius, s[-1].radius);
    const double least = .01 * MESH_MIN_THICKNESS * s->chord;
    const double most  = .01 * MESH_MAX_THICKNESS * s->chord;
    const double bend  = .01 * MESH_MAX_CAMBER * s->chord;
    if (s->thickness <= least || s->thickness >= most)
      case_reader_issue(
          r, full, "thickness is %g m, must be between 1 %% and 50 %% of the chord, %g to %g m",
          s->thickness, least, most);
    if (fabs(s->camber) > bend)
      case_reader_issue(r, full,
                        "camber is %g m, must be at most 40 %% of the chord, %g m, either way",
                        s->camber, bend);
    if (fabs(s->twist) > MESH_MAX_TWIST / degree)
      case_reader_issue(r, full, "twist is %g deg, must be -80 to 80 deg", s->twist * degree);
  }
  double height = blade->root_height;
  if (node && case_reader_good(r, path) && case_reader_good(r, "mesh.blade.root.height") &&
      height >= blade->section[0].radius)
    case_reader_issue(r, "mesh.blade.root.height",
                      "is %g m, must be below the radius of the first section, %g m", height,
                      blade->section[0].radius);
}

static void check_sizes(case_reader *r) {
  const mesh_blade *blade = &r->file->blade;
  if (case_reader_good(r, "mesh.blade.size") && case_reader_good(r, "mesh.blade.shroud_size") &&
      blade->shroud_size > blade->size)
    case_reader_issue(r, "mesh.blade.shroud_size", "is %g m, must not be above size, %g m",
                      blade->shroud_size, blade->size);
}

/* mhb.tolerance is the tolerance of mhb.harmonics: auto, and has no meaning otherwise. */
static void check_tolerance(case_reader *r) {
  if (!case_reader_good(r, "mhb.harmonics") || r->file->mhb.harmonics == 0) return;
  r->file->mhb.motion_tolerance = 0;
  if (case_reader_given(r, "mhb.tolerance"))
    case_reader_issue(r, "mhb.tolerance",
                      "only says something with mhb.harmonics: auto; the accuracy of the contact "
                      "law is contact.accuracy");
}

/* Folds and points of multipliers are those of all outputs. */
static void check_output_quantity(case_reader *r) {
  static const char path[] = "mhb.output_quantity";
  if (!case_reader_given(r, path) || !case_reader_good(r, path)) return;
  if (r->file->mhb.track != MHB_TRACK_PEAKS)
    case_reader_issue(r, path, "only says something with mhb.track: peak");
}

/* The motion must have the harmonic whose peaks are followed. */
static void check_output_harmonic(case_reader *r) {
  static const char   path[] = "mhb.output_harmonic";
  const mhb_settings *mhb    = &r->file->mhb;
  const int           most   = mhb->harmonics / mhb->subharmonics;
  if (!case_reader_given(r, path) || !case_reader_good(r, path)) return;
  if (mhb->track != MHB_TRACK_PEAKS) {
    case_reader_issue(r, path, "only says something with mhb.track: peak");
    return;
  }
  if (mhb->output_quantity == MHB_OUTPUT_PEAK_TO_PEAK) {
    case_reader_issue(r, path,
                      "only says something with mhb.output_quantity: harmonic; the peak to peak is "
                      "of all harmonics");
    return;
  }
  if (!case_reader_good(r, "mhb.harmonics") || mhb->harmonics == 0 || mhb->output_harmonic <= most)
    return;
  case_reader_issue(r, path,
                    "is %d, but the balance has %d harmonics of the excitation; raise "
                    "mhb.harmonics, best to twice that and one, or give auto",
                    mhb->output_harmonic, most);
}

/* Only one parameter can be the continuation parameter. */
static void check_followed(case_reader *r) {
  const mhb_settings *mhb    = &r->file->mhb;
  int                 single = mhb->frequency[0] == mhb->frequency[1], given = 0;
  for (int i = MHB_IN_FREQUENCY + 1; i < MHB_N_PARAMETERS; i++) {
    char path[CASE_PATH];
    case_path(path, "mhb.vary.%s", mhb_parameter_name((mhb_parameter)i));
    if (!case_reader_given(r, path)) continue;
    if (given++ > 0) case_reader_issue(r, path, "only one parameter can be followed");
  }
  if (!case_reader_given(r, "mhb.frequency") || !case_reader_good(r, "mhb.frequency")) return;
  if (given == 0 && single)
    case_reader_issue(r, "mhb.frequency",
                      "is one number; give [from, to], or say with mhb.vary what is to be followed "
                      "at this frequency");
  bool tracked = mhb->track != MHB_TRACK_NOTHING;
  if (tracked && given == 0)
    case_reader_issue(r, "mhb.track",
                      "needs a parameter; give mhb.vary, such as {n0: [5 N, 50 N]}");
  if (tracked && given > 0 && single)
    case_reader_issue(r, "mhb.frequency",
                      "is one number; with mhb.track give [from, to], where peaks are looked for");
  if (mhb_track_by_multiplier(mhb_track_word(mhb->track)) && mhb->stability == MHB_STABILITY_NEVER)
    case_reader_issue(
        r, "mhb.stability",
        "is never, but mhb.track: %s needs the multipliers of sweeps; leave it out, or "
        "give always",
        mhb_track_word(mhb->track));
  if (tracked && r->file->run_up) case_reader_issue(r, "mhb.track", "does not go with mhb.run_up");
  if (tracked && case_points_are_auto(r->file))
    case_reader_issue(r, "mhb.track",
                      "does not go with contact.points: auto; give the number of points");
  if (given > 0 && !single && !tracked)
    case_reader_issue(r, "mhb.frequency",
                      "must be one number, because curves follow mhb.vary.%s instead",
                      mhb_parameter_name(mhb->parameter));
  if (mhb->parameter == MHB_IN_N0 && case_reader_good(r, "contact.n0") && mhb->n_preloads > 1)
    case_reader_issue(r, "contact.n0", "must be one number, because curves follow mhb.vary.n0");
}

/* The default band of modes: auto ends at the highest harmonic of the sweep. */
static void check_band(case_reader *r) {
  case_file          *file = r->file;
  const mhb_settings *mhb  = &file->mhb;
  if (file->modal_file || !case_reader_good(r, "modal.modes")) return;
  if (file->modes > 0 && case_reader_given(r, "modal.tolerance"))
    case_reader_issue(r, "modal.tolerance", "only says something with modal.modes: auto");
  if (file->modes > 0 && case_reader_given(r, "modal.band"))
    case_reader_issue(r, "modal.band", "only says something with modal.modes: auto");
  if (file->modes > 0) return;
  if (file->band > 0 || !case_reader_good(r, "modal.band")) return;
  if (case_reader_given(r, "mhb.frequency") && case_reader_good(r, "mhb.frequency"))
    file->band = mhb->frequency[1] * (mhb->harmonics > 0 ? mhb->harmonics : 5) /
                 (mhb->subharmonics > 0 ? mhb->subharmonics : 1);
  else if (!case_reader_given(r, "mhb.frequency"))
    case_reader_issue(r, "modal.band", "missing; modes: auto needs it, or mhb.frequency");
}

/* Relative difference below which two speeds count as equal: interpolation would amplify
 * round-off. */
static const double ALIKE = 1e-5;

static void check_speeds(case_reader *r) {
  const case_file *file = r->file;
  if (!case_reader_good(r, "rotor.speed")) return;
  for (int i = 0; i < file->n_speeds; i++)
    for (int j = 0; j < i; j++)
      if (fabs(file->speed[i] - file->speed[j]) <= ALIKE * file->speed[i]) {
        case_reader_issue(r, "rotor.speed", "holds %g rad/s twice", file->speed[i]);
        return;
      }
}

/* Coriolis terms need a rotor that turns. */
static void check_coriolis(case_reader *r, int stages) {
  static const char path[] = "rotor.coriolis";
  const case_file  *file   = r->file;
  if (file->coriolis == FEM_TURNS_UNSAID || !case_reader_good(r, path)) return;
  bool turns = file->n_speeds > 0;
  for (int i = 0; i < file->n_speeds; i++) turns = turns && file->speed[i] > 0;
  if (case_reader_good(r, "rotor.speed") && !turns)
    case_reader_issue(r, path, "needs rotor.speed above 0; at rest there are no Coriolis forces");
  if (case_reader_given(r, "rotor.turns") && case_reader_good(r, "rotor.turns") &&
      file->mhb.turns_right != (file->coriolis == FEM_TURNS_RIGHT))
    case_reader_issue(r, path, "is of the other sense than rotor.turns; write coriolis: yes");
  if (stages & CASE_MHB && file->mistuning.kind != CASE_TUNED)
    case_reader_issue(r, path, "does not go with rotor.mistuning; leave one of them out");
}

/* In a run-up the range of the sweep must lie within the listed speeds, along the engine order. */
static void check_run_up_speeds(case_reader *r) {
  static const double hair = 1e-9;
  const case_file    *file = r->file;
  const double       *f = file->mhb.frequency, E = file->engine_order;
  double              low = file->speed[0], high = file->speed[0];
  if (!case_reader_good(r, "rotor.speed")) return;
  for (int i = 1; i < file->n_speeds; i++) {
    low  = fmin(low, file->speed[i]);
    high = fmax(high, file->speed[i]);
  }
  if (file->n_speeds < 2) {
    case_reader_issue(r, "mhb.run_up", "needs rotor.speed as a list, or {from, to, points}");
    return;
  }
  if (!case_reader_good(r, "mhb.frequency") || !case_reader_good(r, "excitation.engine_order"))
    return;
  if (SHB_TWO_PI * f[0] / E < low * (1 - hair) || SHB_TWO_PI * f[1] / E > high * (1 + hair))
    case_reader_issue(
        r, "mhb.frequency",
        "must be within %.6g to %.6g Hz, which engine order %g meets at the speeds of "
        "rotor.speed, %.6g to %.6g rpm (mhb.run_up)",
        E * low / SHB_TWO_PI, E * high / SHB_TWO_PI, E, low * 60 / SHB_TWO_PI,
        high * 60 / SHB_TWO_PI);
}

static void check_run_up(case_reader *r) {
  const case_file *file = r->file;
  if (!file->run_up) return;
  if (case_points_are_auto(file))
    case_reader_issue(r, "contact.points",
                      "is auto, which does not go with mhb.run_up; give the number of points");
  if (case_reader_good(r, "excitation.engine_order") && file->engine_order < 1) {
    case_reader_issue(r, "mhb.run_up", "needs excitation.engine_order of 1 or more");
    return;
  }
  if (case_reader_given(r, "integrate.start") && file->integrate.start == MHB_START_FROM_STATE)
    case_reader_issue(r, "integrate.start",
                      "must be balance or rest in a run-up (mhb.run_up): the structure is another "
                      "one at each frequency");
  if (!file->modal_file) check_run_up_speeds(r);
}

/* Refuses frequencies of a list outside the range of the sweep, where no curve is traced.
 *   instead  in  what the key does otherwise, for the message */
static void check_places(case_reader *r, const char *key, int n, const double *frequency,
                         const char *instead) {
  const mhb_settings *mhb  = &r->file->mhb;
  const case_node    *node = case_reader_given(r, key);
  if (!node || !case_reader_good(r, key) || !case_reader_good(r, "mhb.frequency")) return;
  if (mhb->parameter != MHB_IN_FREQUENCY) {
    case_reader_issue(r, key, "are frequencies, but curves follow mhb.vary; %s", instead);
    return;
  }
  for (int i = 0; i < n; i++) {
    char path[CASE_PATH];
    case_path(path, "%s[%d]", key, i);
    if (frequency[i] < mhb->frequency[0] || frequency[i] > mhb->frequency[1])
      case_reader_issue(r, path, "is %g Hz, must be within mhb.frequency, %g to %g Hz",
                        frequency[i], mhb->frequency[0], mhb->frequency[1]);
  }
}

/* Refuses integration at frequencies at which the balance has no solution to start from. */
static void check_integrate(case_reader *r) {
  static const char               path[] = "integrate.frequencies";
  const mhb_settings             *mhb    = &r->file->mhb;
  const mhb_integration_settings *asked  = &r->file->integrate;
  const case_node                *node   = case_reader_given(r, path);
  if (!node || !case_reader_good(r, path) || !case_reader_good(r, "mhb.frequency")) return;
  if (!asked->listed || asked->start != MHB_START_FROM_BALANCE ||
      mhb->parameter != MHB_IN_FREQUENCY)
    return;
  for (int i = 0; i < asked->n_frequencies; i++) {
    char full[CASE_PATH];
    case_path(full, "%s[%d]", path, i);
    if (asked->frequency[i] < mhb->frequency[0] || asked->frequency[i] > mhb->frequency[1])
      case_reader_issue(r, full,
                        "is %g Hz, must be within mhb.frequency, %g to %g Hz, where there are "
                        "solutions to start on; or set integrate.start to rest or state",
                        asked->frequency[i], mhb->frequency[0], mhb->frequency[1]);
  }
}

/* Reports an input file that cannot be read. True if so. */
static bool check_file(case_reader *r, const char *key, const char *path) {
  if (!path || !case_reader_good(r, key)) return false;
  if (mesh_file_kind(path) != SHB_OK) {
    case_reader_issue(r, key, "%s", shb_message());
    return true;
  }
  struct stat info;
  int         fd  = open(path, O_RDONLY | O_NONBLOCK);
  int         why = fd < 0 ? errno : 0;
  if (fd >= 0 && fstat(fd, &info) == 0 && S_ISDIR(info.st_mode)) why = EISDIR;
  if (fd >= 0) close(fd);
  if (why) case_reader_issue(r, key, "%s: cannot be read: %s", path, strerror(why));
  return why != 0;
}

static void check_extension(case_reader *r) {
  const case_file *file = r->file;
  if (!file->mesh_file || !case_reader_good(r, "mesh.file")) return;
  mesh_format format = mesh_format_of(file->mesh_file);
  bool        solid  = MESH_FORMAT_IS_SOLID(format);
  bool        sized  = case_reader_good(r, "mesh.size") && file->source.size > 0;
  if (format == MESH_FORMAT_UNKNOWN)
    case_reader_issue(r, "mesh.file",
                      "'%s' is neither a mesh (.msh, .inp) nor a solid (.step, .stp, .brep, .geo)",
                      file->mesh_file);
  if (format == MESH_FORMAT_STEP && case_reader_given(r, "mesh.unit"))
    case_reader_issue(r, "mesh.unit", "leave it out: a STEP file has its own unit");
  if (solid && format != MESH_FORMAT_GEO && !sized && case_reader_good(r, "mesh.size"))
    case_reader_issue(r, "mesh.size", "missing; the element size of a solid, in m");
  if (format != MESH_FORMAT_UNKNOWN && !solid && case_reader_given(r, "mesh.size"))
    case_reader_issue(r, "mesh.size", "leave it out: '%s' is a mesh already", file->mesh_file);
  if (format != MESH_FORMAT_UNKNOWN && !solid && case_reader_given(r, "mesh.curvature"))
    case_reader_issue(r, "mesh.curvature", "leave it out: '%s' is a mesh already", file->mesh_file);
  if (solid && !sized && file->source.curvature > 0 && case_reader_good(r, "mesh.size"))
    case_reader_issue(r, "mesh.curvature", "needs mesh.size, the largest size");
  char *own = case_output(file, ".msh");
  if (own && case_mesh_is_made(file) && strcmp(own, file->mesh_file) == 0)
    case_reader_issue(r, "mesh.file",
                      "'%s' would be overwritten by the mesh made from it; rename it or the case",
                      file->mesh_file);
  free(own);
}

/* A ring of different blades is one operating range of one wave: what it does not go with. */
static void check_mistuning(case_reader *r, int stages) {
  static const char     path[] = "rotor.mistuning";
  const case_file      *file   = r->file;
  const case_mistuning *m      = &file->mistuning;
  if (m->kind == CASE_TUNED || !case_reader_good(r, path)) return;
  if (file->mhb.to_ground)
    case_reader_issue(r, path, "needs contact.to: neighbour; blades do not meet");
  if (m->kind == CASE_MISTUNED_LIST && case_reader_good(r, "rotor.blades") &&
      case_reader_given(r, "rotor.blades") && m->n != file->blades)
    case_reader_issue(r, path, "has %d deviations, must have %d, one a blade (rotor.blades)", m->n,
                      file->blades);
  if (stages & CASE_CONVERGE) case_reader_issue(r, path, "does not go with shroudhb converge");
  if (file->run_up) case_reader_issue(r, path, "does not go with mhb.run_up");
  if (file->mhb.track != MHB_TRACK_NOTHING)
    case_reader_issue(r, path, "does not go with mhb.track");
  if (case_points_are_auto(file))
    case_reader_issue(r, path, "does not go with contact.points: auto; give the number of points");
}

/* The table of deviations, as far as the number of modes does not matter. */
static void check_deviations(case_reader *r) {
  const case_mistuning     *m     = &r->file->mistuning;
  const mhb_deviation_table table = {m->file, m->hz, m->mean, r->file->blades, 0};
  double                   *value = NULL;
  int                       columns;
  if (!m->file || !case_reader_good(r, "rotor.mistuning") || !case_reader_good(r, "rotor.blades") ||
      !case_reader_given(r, "rotor.blades"))
    return;
  if (mhb_deviation_table_read(&table, &columns, &value) != SHB_OK)
    case_reader_issue(r, "rotor.mistuning", "%s", shb_message());
  free(value);
}

/* What a disc in the mesh does not go with, as far as the case file shows that there is one. Groups
 * that come by their names from a mesh file are seen by the modal stage. */
static void check_disc(case_reader *r, int stages) {
  const case_file *file = r->file;
  const bool       disc =
      file->has_disc || file->source.rules.usual[MESH_CYCLIC_RIGHT].kind != MESH_RULE_NONE;
  if (!disc || file->modal_file) return;
  if (stages & CASE_MHB && file->mistuning.kind != CASE_TUNED)
    case_reader_issue(
        r, "rotor.mistuning",
        "does not go with a disc, whose sectors are alike; leave it out, or clamp the "
        "blade at its root");
}

bool case_check_values(case_reader *r, int stages) {
  case_file *file = r->file;
  bool       own = !file->modal_file, lost = false;
  if (own && !file->mesh_file) {
    check_sections(r);
    check_sizes(r);
  }
  case_check_unused(r);
  case_check_load_values(r, stages);
  check_blade(r, stages);
  check_tolerance(r);
  case_check_materials(r);
  check_speeds(r);
  check_coriolis(r, stages);
  check_band(r);
  if (stages & CASE_MHB) check_followed(r);
  if (stages & CASE_MHB) check_output_quantity(r);
  if (stages & CASE_MHB) check_output_harmonic(r);
  if (stages & CASE_MHB) check_run_up(r);
  if (stages & CASE_MHB) check_mistuning(r, stages);
  check_disc(r, stages);
  case_check_interfaces(r, stages);
  check_places(r, "mhb.search.at", file->mhb.search.n_at, file->mhb.search.at,
               "without it places are chosen");
  if (file->mhb.save.what == MHB_SAVE_LISTED)
    check_places(r, "mhb.save", file->mhb.save.n, file->mhb.save.frequency, "give peaks or all");
  if (stages & CASE_MHB) check_integrate(r);
  if (own) check_extension(r);
  if (own && stages & (CASE_MESH | CASE_MODAL)) lost = check_file(r, "mesh.file", file->mesh_file);
  for (int i = 0; i < file->n_loads && own && stages & CASE_MODAL && !lost; i++) {
    const case_place p = case_reader_place(r, "excitation.loads", "excitation", i);
    char             path[CASE_PATH];
    case_path(path, "%s.field", p.path);
    if (file->loads[i].load.kind == FEM_LOAD_FIELD)
      lost = check_file(r, path, file->loads[i].field);
  }
  if (!own && stages & CASE_MHB) lost = check_file(r, "modal.file", file->modal_file);
  if (stages & CASE_MHB && !lost && file->mistuning.file)
    lost = check_file(r, "rotor.mistuning", file->mistuning.file);
  if (stages & CASE_MHB && !lost) check_deviations(r);
  return lost;
}
