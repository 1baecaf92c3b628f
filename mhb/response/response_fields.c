#include "mhb/response/response_fields.h"

#include <string.h>

#define AT(member) offsetof(mhb_branch, member)
const mhb_field mhb_fields[] = {
    {"frequency", "", MHB_DOUBLE, AT(frequency), "Hz",
     "frequency of the excitation's first harmonic"},
    {"n0", "", MHB_DOUBLE, AT(n0), "N", "normal preload, total of the interface; negative: a gap"},
    {"interface_n0", "i", MHB_DOUBLE, AT(interface_n0), "N",
     "normal preload of each contact interface; n0 is that of the one that leads"},
    {"parameter", "", MHB_DOUBLE, AT(value), NULL, "value of the parameter that is followed"},
    {"motion", "p3k", MHB_COMPLEX, AT(motion), "m",
     "relative motion at the contact along v, u, w; harmonics"},
    {"force", "p3k", MHB_COMPLEX, AT(force), "N",
     "contact force on the right neighbour, or on the ground, along +v, +u, +w; harmonics. Where "
     "the contact neither slips nor opens the mean friction is not determined by the physics: by "
     "convention the smallest admissible"},
    {"probe", "qxk", MHB_COMPLEX, AT(probe), "m",
     "displacement of the probes, tangential, axial, radial; harmonics"},
    {"stable", "", MHB_INT, AT(stable), "-", "stability: 1 stable, 0 unstable, -1 not judged"},
    {"special", "", MHB_INT, AT(special), "-",
     "0 ordinary point, 1 fold, 2 peak of the first harmonic of a probe or contact motion, 3 flip "
     "(period doubling), 4 Neimark-Sacker point, 5 extremum along a tracked branch"},
    {"state", "ps", MHB_DOUBLE, AT(state), "-", "share of the period stuck, slipping, open"},
    {"dissipation", "p", MHB_DOUBLE, AT(dissipation), "J", "energy lost by friction in a period"},
    {"iterations", "", MHB_INT, AT(iterations), "-", "Newton iterations"},
    {"seconds", "", MHB_DOUBLE, AT(seconds), "s", "time spent on the point"},
    {"error/newton", "", MHB_DOUBLE, AT(error_newton), "-",
     "estimated error from the Newton residual, relative to the motion"},
    {"error/truncation", "", MHB_DOUBLE, AT(error_truncation), "-",
     "estimated error from the harmonics left out, relative to the vibration: the "
     "root-mean-square over the period of the error over that of the motion; beside a fold "
     "(error/truncation_kind 3) that of the distance from the curve of more harmonics"},
    {"error/sampling", "", MHB_DOUBLE, AT(error_sampling), "-",
     "estimated error of the contact force's harmonics, relative to the motion"},
    {"error/modal", "", MHB_DOUBLE, AT(error_modal), "-",
     "estimated error from the modes left out, their damping with them, relative to the "
     "vibration: the root-mean-square over the period of the error over that of the motion"},
    {"mark", "", MHB_INT, AT(mark), "-",
     "what the point is not worth, a sum: 1 error/truncation is above the tolerance asked for; 2 a "
     "contact sticks all the time: nothing determines its mean friction, which loads others; 4 the "
     "error is not judged"},
    /* N_TRACKED: of tracked flips and Neimark-Sacker points */
    {"multiplier", "", MHB_COMPLEX, AT(multiplier), "-",
     "the Floquet multiplier on the unit circle, of a period of the fundamental; its angle is the "
     "advance of the modulation in a period"},
    /* N_LATER: of nonlinear branches only; files of earlier versions lack them */
    {"harmonics", "", MHB_INT, AT(harmonics), "-",
     "harmonics of the balance at the point; higher ones of motion, force and probe are 0"},
    {"error/truncation_kind", "", MHB_INT, AT(truncation_kind), "-",
     "how error/truncation was estimated: 0 nothing is left out (open or stuck throughout), 1 "
     "first order, told threefold: can be several times too small, 2 a Newton step of twice the "
     "harmonics at the same frequency, 3 one across the curve: the motion, or the shift of the "
     "frequency over the least damping ratio"},
    {"error/truncation_max", "", MHB_DOUBLE, AT(error_truncation_max), "-",
     "estimated error from the harmonics left out: the largest within the period, over the "
     "amplitude that error/truncation is relative to; -1: not known"},
    {"error/spatial", "", MHB_DOUBLE, AT(error_spatial), "-",
     "estimated error from the number of contact pairs, at the same frequency, relative to the "
     "vibration; -1: not judged"},
    {"judged", "", MHB_INT, AT(judged), "-",
     "what stable rests on: 0 nothing, not judged; 1 the Floquet multipliers; 2 the same, the "
     "largest at 1 within its error; 3 they could not be computed, or the largest is within "
     "error/multiplier of the border; 4 judged points on both sides; 5 an odd number of folds "
     "since a judged point"},
    {"loss", "", MHB_INT, AT(loss), "-",
     "how stability was lost: 0 it was not; 1 fold (a multiplier beyond +1): never seen; else "
     "modulated: 2 flip (beyond -1), 3 Neimark-Sacker (a pair)"},
    {"multipliers", "f", MHB_COMPLEX, AT(multipliers), "-",
     "largest Floquet multipliers by falling modulus; 0: not computed, or there are no more"},
    {"error/multiplier", "", MHB_DOUBLE, AT(error_multiplier), "-",
     "estimated error of the largest multiplier's modulus from the harmonics left out; a point "
     "within it is not judged; -1: not known"},
    {"at_limit", "", MHB_INT, AT(at_limit), "-",
     "contact pairs that stick all the time and reach the friction limit; the multipliers hold for "
     "disturbances that do not make them slip"},
    {"lasting/mean", "", MHB_DOUBLE, AT(lasting_mean), "-",
     "motion that lasts: a period's peak of the output, mean over blades and time, over that of "
     "the wave; 0: not computed"},
    {"lasting/worst", "", MHB_DOUBLE, AT(lasting_worst), "-",
     "the same, 99.9 percentile over blades and periods; 0: not computed"},
    {"lasting/error", "", MHB_DOUBLE, AT(lasting_error), "-",
     "standard error of lasting/mean; above 0.01: the motion did not settle"},
    {"lasting/side", "", MHB_INT, AT(lasting_side), "-",
     "nodal diameter of the strongest side wave: the next blade lags by 2 pi/N times it; -1: none"},
    {"lasting/offset", "", MHB_DOUBLE, AT(lasting_offset), "-",
     "frequency of the strongest side wave over that of the excitation, less 1"},
    {"lasting/periods", "", MHB_INT, AT(lasting_periods), "-",
     "periods of the fundamental that were integrated, all starts"},
    {"lasting/starts", "", MHB_INT, AT(lasting_starts), "-",
     "disturbed starts that were told apart; all of them miss a motion that one in six reaches "
     "with the chance (5/6)^starts; 0: not computed, or not known"},
    {"lasting/reached", "", MHB_INT, AT(lasting_reached), "-",
     "of these starts, those that reached the motion of lasting/mean; 0: the state of a neighbour "
     "alone led to it"},
    {"lasting/least", "", MHB_DOUBLE, AT(lasting_least), "-",
     "where there are several motions: lasting/mean of the smallest; else 0"},
    {"lasting/least_worst", "", MHB_DOUBLE, AT(lasting_least_worst), "-",
     "where there are several motions: lasting/worst of the smallest; else 0"},
    {"lasting/kind", "", MHB_INT, AT(lasting_kind), "-",
     "0 not computed, 1 the wave, 2 mildly modulated, 3 modulated, 4 irregular, 5 several motions"},
    {"ring/energy", "b", MHB_DOUBLE, AT(ring_energy), "J", "mean kinetic energy of each blade"},
    {"ring/wave", "b", MHB_DOUBLE, AT(ring_wave), "-",
     "share of the kinetic energy in waves of j = 0, 1, .. nodal diameters more than the load's; "
     "of "
     "harmonic k of the excitation the load drives k times the engine order"},
    {"ring/standing", "", MHB_DOUBLE, AT(ring_standing), "-",
     "share of the kinetic energy in waves that meet an equal one running backwards"},
    {"ring/participation", "", MHB_DOUBLE, AT(ring_participation), "-",
     "share of the blades that take part: (sum e)^2/(N sum e^2) of their kinetic energies e; 1/N: "
     "one blade alone"},
    {"ring/kind", "", MHB_INT, AT(ring_kind), "-",
     "0 at rest, 1 the wave that the load drives, 2 other waves beside it, 3 a standing wave, 4 "
     "localised: participation below 1/2"},
    /* the last N_INTEGRATION: of integration branches only */
    {"multiple", "", MHB_INT, AT(multiple), "-",
     "the motion repeats after so many periods of the fundamental; 0: it does not"},
    {"periods", "", MHB_INT, AT(periods), "-", "periods of the fundamental that were integrated"},
    {"distance", "", MHB_DOUBLE, AT(distance), "-", "of the return map, relative to the motion"},
    {"spectrum/frequency", "l", MHB_DOUBLE, AT(line_frequency), "Hz",
     "lines of the contact motion where it does not repeat, largest first; 0: none"},
    {"spectrum/amplitude", "l", MHB_DOUBLE, AT(line_amplitude), "m", "amplitude of the line"},
};
enum { N_TRACKED = 1, N_LATER = 25, N_INTEGRATION = 5 };
_Static_assert(sizeof mhb_fields / sizeof *mhb_fields == MHB_N_FIELDS, "MHB_N_FIELDS counts them");

size_t mhb_field_bytes(mhb_number kind) {
  return kind == MHB_COMPLEX  ? sizeof(double complex)
         : kind == MHB_DOUBLE ? sizeof(double)
                              : sizeof(int);
}

static hsize_t size_of(const mhb_response *response, const mhb_branch *branch, char letter) {
  switch (letter) {
    case 'p':
      return (hsize_t)response->n_pairs;
    case 'q':
      return (hsize_t)response->n_probes;
    case 'k':
      return (hsize_t)branch->n_harmonics + 1;
    case 'f':
      return (hsize_t)response->n_multipliers;
    case 'l':
      return (hsize_t)response->n_lines;
    case 'b':
      return (hsize_t)response->ring;
    case 'i':
      return (hsize_t)response->n_interfaces;
    default:
      return 3;
  }
}

h5_shape mhb_field_shape(const mhb_response *response, const mhb_branch *branch, const mhb_field *f,
                         int n_points) {
  h5_shape shape = {.rank = 1 + (int)strlen(f->dims), .dim = {(hsize_t)n_points}};
  for (int i = 1; i < shape.rank; i++) shape.dim[i] = size_of(response, branch, f->dims[i - 1]);
  return shape;
}

/* Numbers a point. */
static size_t width_of(const mhb_response *response, const mhb_branch *branch, const mhb_field *f) {
  return h5_count(mhb_field_shape(response, branch, f, 1));
}

size_t mhb_field_row(const mhb_response *response, const mhb_branch *branch, const mhb_field *f) {
  return width_of(response, branch, f) * mhb_field_bytes(f->kind);
}

mhb_branch_kind mhb_field_owner(const mhb_field *f) {
  long from_end = mhb_fields + MHB_N_FIELDS - f;
  return from_end <= N_INTEGRATION                         ? MHB_BRANCH_INTEGRATION
         : from_end <= N_INTEGRATION + N_LATER             ? MHB_BRANCH_NONLINEAR
         : from_end <= N_INTEGRATION + N_LATER + N_TRACKED ? MHB_BRANCH_TRACKED
                                                           : MHB_N_BRANCH_KINDS;
}

bool mhb_field_is_later(const mhb_field *f) {
  return mhb_field_owner(f) == MHB_BRANCH_NONLINEAR || f->offset == AT(mark);
}

bool mhb_field_kept(const mhb_response *response, const mhb_branch *branch, const mhb_field *f) {
  mhb_branch_kind owner = mhb_field_owner(f);
  if (owner == MHB_BRANCH_TRACKED && !response->tracks_multiplier) return false;
  if (strncmp(f->name, "ring/", 5) == 0 && !response->ring) return false;
  return width_of(response, branch, f) > 0 &&
         (owner == MHB_N_BRANCH_KINDS || owner == branch->kind);
}

bool mhb_field_is_frequency(const mhb_response *response, const mhb_field *f) {
  return f->offset == AT(value) && response->parameter == MHB_IN_FREQUENCY;
}

void *mhb_field_get(const mhb_branch *branch, const mhb_field *f) {
  void *data;
  memcpy(&data, (const char *)branch + f->offset, sizeof data);
  return data;
}

void mhb_field_set(mhb_branch *branch, const mhb_field *f, void *data) {
  memcpy((char *)branch + f->offset, &data, sizeof data);
}
