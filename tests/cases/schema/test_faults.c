/* Faults of a case file: exact places and words. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "cases/parse/yaml.h"
#include "cases/schema/case.h"
#include "tests/support/scratch.h"

enum { ALL = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST };

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Status of a file of n bytes, and the printed text (malloc'ed) without the folder. */
/* Of 37 blades, Hz: a file that cases may name. */
#define FOUR "117\n118\n119\n118\n"
static const char frequencies[] = "f\n" FOUR FOUR FOUR FOUR FOUR FOUR FOUR FOUR FOUR "120\n";

static shb_status judge(const char *text, size_t n, char **said) {
  char folder[SCRATCH_PATH], old[SCRATCH_PATH];
  scratch_create(folder);
  scratch_write(folder, "c.yaml", text, n);
  scratch_write(folder, "m.csv", frequencies, sizeof frequencies - 1);
  assert_non_null(getcwd(old, sizeof old));
  assert_int_equal(chdir(folder), 0);
  size_t     size   = 0;
  FILE      *errors = open_memstream(said, &size);
  case_file  file;
  shb_status status = case_read("c.yaml", ALL, errors, &file);
  fclose(errors);
  if (status == SHB_OK) case_free(&file);
  assert_int_equal(chdir(old), 0);
  scratch_remove(folder);
  return status;
}

/* One change of the case, the first line printed, and the number of errors. */
typedef struct {
  const char *from, *to, *says;
  int         n;
} fault;

static void check_faults(const fault *rows, size_t n) {
  for (size_t i = 0; i < n; i++) {
    char      *said, ending[32], *text = scratch_case(rows[i].from, rows[i].to);
    shb_status status = judge(text, strlen(text), &said);
    if (status != SHB_ERR_INPUT) fail_msg("'%s': status %d", rows[i].to, status);
    snprintf(ending, sizeof ending, "\n%d error%s\n", rows[i].n, rows[i].n == 1 ? "" : "s");
    size_t length = strlen(rows[i].says);
    if (strncmp(said, rows[i].says, length) != 0 || said[length] != '\n')
      fail_msg("expected %s\nfound %s", rows[i].says, said);
    if (!strstr(said, ending)) fail_msg("expected %sfound %s", ending, said);
    assert_string_equal(shb_message(), ""); /* no text for a second message */
    free(said);
    free(text);
  }
}

static void keys_and_kinds(void **state) {
  (void)state;
  static const fault rows[] = {
      {"  mu:", "  mue:", "c.yaml:24:3: error: contact.mue: unknown key; did you mean 'mu'?", 1},
      {"  kv:", "  Kv:", "c.yaml:26:3: error: contact.Kv: unknown key; did you mean 'kv'?", 1},
      {"  n0: [-20 N, 0, 0.3 kN]\n", "",
       "c.yaml:19:1: error: contact.n0: missing; expected a number, a list "
       "or {from, to, points} in N",
       1},
      {"  scale: 1.3", "  tolerance: 1e-8",
       "c.yaml:34:14: error: mhb.tolerance: only says something with mhb.harmonics: auto; the "
       "accuracy of the contact law is contact.accuracy",
       1},
      {"  scale: 1.3", "  damping: 1.3",
       "c.yaml:34:3: error: mhb.damping: unknown key; did you mean "
       "'modal.damping'?",
       1},
      {"  scale: 1.3", "  track: peak\n  vary: {kv: [1 MN/m, 2 MN/m]}\n  output_harmonic: 9",
       "c.yaml:36:20: error: mhb.output_harmonic: is 9, but the balance has 3 harmonics of the "
       "excitation; raise mhb.harmonics, best to twice that and one, or give auto",
       1},
      {"  stability: always", "  stability: never\n  track: flip\n  vary: {kv: [1 MN/m, 2 MN/m]}",
       "c.yaml:36:14: error: mhb.stability: is never, but mhb.track: flip needs the multipliers of "
       "sweeps; leave it out, or give always",
       1},
      {"  scale: 1.3", "  output_quantity: peak_to_peak",
       "c.yaml:34:20: error: mhb.output_quantity: only says something with mhb.track: peak", 1},
      {"  scale: 1.3", "  track: peak\n  vary: {kv: [1 MN/m, 2 MN/m]}\n  output_quantity: swing",
       "c.yaml:36:20: error: mhb.output_quantity: 'swing' is not known; expected one of harmonic, "
       "peak_to_peak, rss",
       1},
      {"  scale: 1.3",
       "  track: peak\n  vary: {kv: [1 MN/m, 2 MN/m]}\n  output_quantity: peak_to_peak\n"
       "  output_harmonic: 1",
       "c.yaml:37:20: error: mhb.output_harmonic: only says something with mhb.output_quantity: "
       "harmonic; the peak to peak is of all harmonics",
       1},
      {"  scale: 1.3", "  output_harmonic: 2",
       "c.yaml:34:20: error: mhb.output_harmonic: only says something with mhb.track: peak", 1},
      {"  scale: 1.3", "  zzzzzz: 1.3",
       "c.yaml:34:3: error: mhb.zzzzzz: unknown key; known here: frequency, "
       "run_up, vary, track, output, output_quantity, output_harmonic, harmonics, tolerance, "
       "subharmonics, scale, "
       "max_points, stability, "
       "lasting, save, flips, search",
       1},
      {"  scale: 1.3", "  mhb.scale: 1.3",
       "c.yaml:34:3: error: mhb.mhb.scale: unknown key; known here: "
       "frequency, run_up, vary, track, output, output_quantity, output_harmonic, harmonics, "
       "tolerance, "
       "subharmonics, scale, max_points, stability, "
       "lasting, save, flips, search",
       1},
      {"  scale: 1.3", "  [a, b]: 1.3",
       "c.yaml:34:3: error: mhb.?: a key must be a word, not a list", 1},
      {"excitation:", "exitation:",
       "c.yaml:14:1: error: exitation: unknown key; did you mean 'excitation'?", 1},
      {"camber", "chamber",
       "c.yaml:6:55: error: mesh.blade.sections[0].chamber: unknown key; did you mean "
       "'camber'?",
       1},
      {", thickness: 2.9 mm", "",
       "c.yaml:7:9: error: mesh.blade.sections[1].thickness: missing; expected a "
       "number in m",
       1},
      {"  subharmonics: 2", "  mu: 2\n  mu: 3",
       "c.yaml:33:3: error: mhb.mu: unknown key; did you mean "
       "'contact.mu'?",
       2},
      {"  scale: 1.3", "  harmonics: 3",
       "c.yaml:34:3: error: mhb.harmonics: given twice; first on line 32", 1},
      {"0.31\n", "\n", "c.yaml:24:6: error: contact.mu: has no value; expected a number", 1},
      {"0.31\n", "~\n", "c.yaml:24:7: error: contact.mu: has no value; expected a number", 1},
      {"0.31\n", "[0.3]\n", "c.yaml:24:7: error: contact.mu: is a list; expected a number", 1},
      {"0.31\n", "{a: 1}\n", "c.yaml:24:7: error: contact.mu: is a mapping; expected a number", 1},
      {"material: {E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}", "material: steel",
       "c.yaml:11:11: error: material: "
       "is a single value; expected a mapping; known here: E, nu, G, axis_1, axis_2, rho, fatigue",
       1},
      {"material: {E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}", "material:",
       "c.yaml:11:10: error: material: "
       "is nothing; expected a mapping; known here: E, nu, G, axis_1, axis_2, rho, fatigue",
       1},
      {"material: {E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}\n", "",
       "c.yaml:1:1: error: material: missing; "
       "expected a mapping with E, nu, rho",
       1},
      {"-y}", "sideways}",
       "c.yaml:12:44: error: rotor.axis: 'sideways' is not known; expected one of x, y, z, "
       "-x, -y, -z",
       1},
      {"neighbour", "nobody",
       "c.yaml:20:7: error: contact.to: 'nobody' is not known; expected one of "
       "neighbour, ground",
       1},
      {"probe: {tip:", "gauge: {g1: {at: [0, 0, 0.47]}}\nprobe: {tip:",
       "c.yaml:18:13: error: gauge.g1.direction: missing; expected "
       "{at: [x, y, z], direction: [x, y, z]}",
       1},
      {"probe: {tip:", "gauge: {g1: {at: [0, 0, 0.47], direction: [0, 0, 0]}}\nprobe: {tip:",
       "c.yaml:18:13: error: gauge.g1: direction is [0, 0, 0]", 1},
      {"probe: {tip:", "gauge: {g1: {at: [0, 0, 0.47], along: [0, 0, 1]}}\nprobe: {tip:",
       "c.yaml:18:32: error: gauge.g1.along: unknown key; a gauge has at and direction", 1},
      {"probe: {tip:", "gauge: {'g 1': {at: [0, 0, 0.47], direction: [0, 0, 1]}}\nprobe: {tip:",
       "c.yaml:18:9: error: gauge: 'g 1' cannot be a gauge's name: 1 to 63 letters, digits, _ - . "
       "+",
       1},
      {"probe: {tip:", "probe: {'tip, 1':",
       "c.yaml:18:9: error: probe: 'tip, 1' cannot be a probe's name: 1 "
       "to 63 letters, digits, _ - . +",
       1},
      {"odd_blade", "../blade",
       "c.yaml:1:7: error: name: '../blade' cannot be a file name: at most 100 "
       "characters, no '/', no '.' or '-' first",
       1}};
  check_faults(rows, COUNT(rows));
}

static void numbers_and_ranges(void **state) {
  (void)state;
  static const fault rows[] = {
      {"nu: 0.29", "nu: 0,3",
       "c.yaml:11:28: error: material.nu: 0,3 has a decimal comma; write 0.3", 1},
      {"nu: 0.29", "nu: 0, 3",
       "c.yaml:11:31: error: material: a number where a key belongs; write decimals with a "
       "point, such as 2.1",
       1},
      {"0.31\n", "0,3\n",
       "c.yaml:24:7: error: contact.mu: '0,3' is not a number; write 0.3 with a decimal "
       "point",
       1},
      {"0.31\n", "nan\n",
       "c.yaml:24:7: error: contact.mu: 'nan' is not a number; expected a number", 1},
      {"0.31\n", "-0.31\n", "c.yaml:24:7: error: contact.mu: is -0.31, must be 0 to 1e+06", 1},
      {"kv: 0.8 MN/m", "kv: 100 Hz",
       "c.yaml:26:7: error: contact.kv: '100 Hz' has unit Hz, expected N/m", 1},
      {"psi: 35 deg", "psi: 35",
       "c.yaml:21:8: error: contact.psi: is 35 rad, must be above -1.5708 and below "
       "1.5708 rad; did you mean 35 deg?",
       1},
      {"nu: 0.29", "nu: 0.5",
       "c.yaml:11:28: error: material.nu: is 0.5, must be above -1 and below 0.5", 1},
      {"damping: 0.23 %", "damping: {loss: 0.1}",
       "c.yaml:13:29: error: modal.damping: expected a ratio, a list of ratios, {loss_factor: eta} "
       "or "
       "{rayleigh: [alpha, beta]}",
       1},
      {"damping: 0.23 %", "damping: [0.1, 1.5]",
       "c.yaml:13:35: error: modal.damping[1]: is 1.5, must be 0 or more and below 1", 1},
      {"damping: 0.23 %", "damping: {rayleigh: 3}",
       "c.yaml:13:40: error: modal.damping.rayleigh: expected [alpha, beta] in 1/s and s", 1},
      {"damping: 0.23 %", "damping: -0.1",
       "c.yaml:13:29: error: modal.damping: is -0.1, must be 0 or more and below 1", 1},
      {"E: 207 GPa", "E: [207 GPa, 180 GPa, 207 GPa]",
       "c.yaml:11:1: error: material.G: missing; E or nu differ along the axes, expected [G12, "
       "G13, G23]",
       1},
      {"E: 207 GPa", "E: 207 GPa, G: [80 GPa, 80 GPa, -1 GPa]",
       "c.yaml:11:27: error: material.G: E, nu and G are those of no stable material (the "
       "stiffness is "
       "not positive definite); nu12 is the contraction along 2 under tension along 1, nu12/E1 = "
       "nu21/E2",
       1},
      {"E: 207 GPa", "E: 207 GPa, G: 80 GPa, axis_2: [1, 0, 0]",
       "c.yaml:11:27: error: material.G: axis_1 and axis_2 must be two directions, not along one "
       "line",
       1},
      {"E: 207 GPa", "E: 207 GPa, axis_1: [1, 1, 0]",
       "c.yaml:11:1: error: material.G: missing; without it the material is isotropic and has no "
       "axes",
       1},
      {"E: 207 GPa", "E: 207",
       "c.yaml:11:15: error: material.E: is 207 Pa, must be 1e+06 to 1e+14 Pa; did you mean 207 "
       "GPa?",
       1},
      {"blades: 37", "blades: 37.5",
       "c.yaml:12:17: error: rotor.blades: '37.5' is not a whole number", 1},
      {"blades: 37", "blades: 1", "c.yaml:12:17: error: rotor.blades: is 1, must be 2 to 1000", 1},
      {"modes: 17", "modes: few", "c.yaml:13:16: error: modal.modes: 'few' is not a whole number",
       1},
      {"modes: 17", "modes: auto, tolerance: 0",
       "c.yaml:13:33: error: modal.tolerance: is 0, must be above 0 to 1", 1},
      {"2900 rpm", "[0 rpm, 30 rpm, 0 rpm]",
       "c.yaml:12:28: error: rotor.speed: holds 0 rad/s twice", 1},
      {"2900 rpm", "[0 rpm, 90 rpm], coriolis: left",
       "c.yaml:12:55: error: rotor.coriolis: needs rotor.speed above 0; at rest there are no "
       "Coriolis forces",
       1},
      {"2900 rpm", "0 rpm, coriolis: right",
       "c.yaml:12:45: error: rotor.coriolis: needs rotor.speed above 0; at rest there are no "
       "Coriolis forces",
       1},
      {"2900 rpm", "2900 rpm, turns: right, coriolis: left",
       "c.yaml:12:62: error: rotor.coriolis: is of the other sense than rotor.turns; write "
       "coriolis: yes",
       1},
      {"2900 rpm", "2900 rpm, turns: round",
       "c.yaml:12:45: error: rotor.turns: 'round' is not known; expected one of left, "
       "right",
       1},
      {"2900 rpm", "[]", "c.yaml:12:28: error: rotor.speed: 0 speeds; there may be 1 to 256", 1},
      {"2900 rpm", "[1 rpm, -3 rpm]",
       "c.yaml:12:36: error: rotor.speed[1]: is -0.314159 rad/s, must be 0 to 100000 rad/s", 1},
      {"harmonics: 7", "harmonics: all",
       "c.yaml:32:14: error: mhb.harmonics: 'all' is not a whole number", 1},
      {"  harmonics: 7", "  harmonics: auto\n  tolerance: 1e-9",
       "c.yaml:33:14: error: mhb.tolerance: is 1e-09, must be 1e-08 to 0.1", 1},
      {"points: 4", "points: 0", "c.yaml:23:11: error: contact.points: is 0, must be 1 to 100000",
       1},
      {"points: 4", "points: some",
       "c.yaml:23:11: error: contact.points: 'some' is not a whole number", 1},
      {"[90 Hz, 0.12 kHz]", "[90 Hz]",
       "c.yaml:31:14: error: mhb.frequency: has 1 numbers, expected 2", 1},
      {"[90 Hz, 0.12 kHz]", "90 Hz",
       "c.yaml:31:14: error: mhb.frequency: is one number; give [from, to], or say with mhb.vary "
       "what is to be followed at this frequency",
       1},
      {"[90 Hz, 0.12 kHz]", "[90 Hz, 120 Hz]\n  vary: {mu: [0, 1]}",
       "c.yaml:31:14: error: mhb.frequency: must be one number, because curves follow mhb.vary.mu "
       "instead",
       1},
      {"[90 Hz, 0.12 kHz]", "90 Hz\n  vary: {mu: [0, 1], scale: [1, 2]}",
       "c.yaml:32:14: error: mhb.vary.mu: only one parameter can be followed", 1},
      {"[90 Hz, 0.12 kHz]", "90 Hz\n  vary: {n0: [0 N, 10 N]}",
       "c.yaml:27:7: error: contact.n0: must be one number, because curves follow mhb.vary.n0", 1},
      {"[90 Hz, 0.12 kHz]", "[90 Hz, 0.08 kHz]",
       "c.yaml:31:14: error: mhb.frequency: goes from 90 to 80 Hz; "
       "the second must be above the first",
       1},
      {"[90 Hz, 0.12 kHz]", "[0, 0.08 kHz]",
       "c.yaml:31:15: error: mhb.frequency[0]: is 0 Hz, must be above 0 "
       "to 1e+09 Hz",
       1},
      {"-70 kN/m", "0.6 MN/m",
       "c.yaml:25:7: error: contact.ku: [500000, 600000, 600000] N/m is not positive "
       "definite: kuu and kww must be above 0 and kuu kww above kuw^2",
       1},
      {"[0.5 MN/m, -70 kN/m, 0.6 MN/m]", "[1 MN/m, 999999.9999, 1 MN/m]",
       "c.yaml:25:7: error: contact.ku: [1000000, 999999.9999, 1000000] N/m is 2e+10 times "
       "stiffer in one direction than in the other; at most 1e+07 times are allowed",
       1},
      {"[0.5 MN/m, -70 kN/m, 0.6 MN/m]", "0",
       "c.yaml:25:7: error: contact.ku: is 0 N/m, must be above 0 to "
       "1e+15 N/m",
       1},
      {"[0.5 MN/m, -70 kN/m, 0.6 MN/m]", "[1, 2]",
       "c.yaml:25:7: error: contact.ku: has 2 numbers, expected 3", 1},
      {"[-20 N, 0, 0.3 kN]", "[-20 N, 0, 3 m]",
       "c.yaml:27:18: error: contact.n0[2]: '3 m' has unit m, "
       "expected N",
       1},
      {"2e-9", "exakt",
       "c.yaml:29:13: error: contact.accuracy: 'exakt' is not known; expected a number or one of "
       "fast, balanced, exact",
       1},
      {"2e-9", "1e-8 N",
       "c.yaml:29:13: error: contact.accuracy: '1e-8 N' has unit N, expected a number without a "
       "unit",
       1},
      {"2e-9", "0.011", "c.yaml:29:13: error: contact.accuracy: is 0.011, must be 1e-14 to 0.01",
       1},
      {"2e-9", "-1e-9", "c.yaml:29:13: error: contact.accuracy: is -1e-09, must be 1e-14 to 0.01",
       1},
      {"2e-9", "1e-15", "c.yaml:29:13: error: contact.accuracy: is 1e-15, must be 1e-14 to 0.01",
       1},
      {"2e-9", "nan",
       "c.yaml:29:13: error: contact.accuracy: 'nan' is not known; expected a number or one of "
       "fast, balanced, exact",
       1},
      {"2e-9", "",
       "c.yaml:29:12: error: contact.accuracy: has no value; expected a number or one of fast, "
       "balanced, exact",
       1},
      {"2e-9", "[fast, exact]",
       "c.yaml:29:13: error: contact.accuracy: is a list; expected a number or one of fast, "
       "balanced, exact",
       1},
      {"[-20 N, 0, 0.3 kN]", "[]",
       "c.yaml:27:7: error: contact.n0: 0 preloads; there may be 1 to 256", 1},
      {"[-20 N, 0, 0.3 kN]", "{from: 1 N, to: 2 N}",
       "c.yaml:27:7: error: contact.n0.points: missing; "
       "expected {from, to, points}",
       1},
      {"[-20 N, 0, 0.3 kN]", "{from: 1 N, to: 2 N, points: 1}",
       "c.yaml:27:36: error: contact.n0.points: is 1, "
       "must be 2 to 256",
       1},
      {"[-20 N, 0, 0.3 kN]", "{from: 1 N, to: 2 N, points: 3, step: 1}",
       "c.yaml:27:39: error: "
       "contact.n0.step: unknown key; known here: from, to, points",
       1},
      {"{1: [1, 0 deg], 3:", "{1: [1, 0 deg], three:",
       "c.yaml:17:30: error: excitation.harmonics: 'three' is "
       "not a harmonic; expected a whole number, 0 to 64",
       1},
      {"{1: [1, 0 deg], 3:", "{1: [1, 0 deg], 01:",
       "c.yaml:17:30: error: excitation.harmonics: harmonic '01' "
       "is given twice",
       1},
      {"[0.21, 90 deg]", "[0.21]",
       "c.yaml:17:33: error: excitation.harmonics.3: has 1 value; expected "
       "[amplitude, phase]",
       1},
      {"[0.21, 90 deg]", "[0.21, 90 Hz]",
       "c.yaml:17:40: error: excitation.harmonics.3[1]: '90 Hz' has unit "
       "Hz, expected rad",
       1},
      {"[0.21, 90 deg]", "[-1e300, 90 deg]",
       "c.yaml:17:34: error: excitation.harmonics.3[0]: is -1e+300, must be -1e+12 to 1e+12", 1},
      {"tip: [1 mm, 2 mm, 0.47 m]", "tip: 3",
       "c.yaml:18:14: error: probe.tip: is a single value; expected 3 "
       "numbers in m",
       1}};
  check_faults(rows, COUNT(rows));
}

static void keys_among_each_other(void **state) {
  (void)state;
  static const fault rows[] = {
      {"  scale: 1.3", "  run_up: yes",
       "c.yaml:34:11: error: mhb.run_up: needs rotor.speed as a list, or {from, to, points}", 1},
      {"  scale: 1.3", "  run_up: true",
       "c.yaml:34:11: error: mhb.run_up: 'true' is not known; expected one of no, yes", 1},
      {"radius: 0.47 m", "radius: 0.3 m",
       "c.yaml:7:9: error: mesh.blade.sections[1]: radius is 0.3 m, must be "
       "above that of the section before, 0.31 m",
       1},
      {"thickness: 2.9 mm", "thickness: 41 mm",
       "c.yaml:7:9: error: mesh.blade.sections[1]: thickness is "
       "0.041 m, must be between 1 % and 50 % of the chord, 0.00041 to 0.0205 m",
       1},
      {"camber: 3 mm", "camber: 30 mm",
       "c.yaml:6:9: error: mesh.blade.sections[0]: camber is 0.03 m, must be "
       "at most 40 % of the chord, 0.0212 m, either way",
       1},
      {"thickness: 2.9 mm", "thickness: 2.9 mm, twist: 81 deg",
       "c.yaml:7:9: error: mesh.blade.sections[1]: twist is 81 deg, must be -80 to 80 deg", 1},
      {"      - {radius: 0.47 m, chord: 41 mm, thickness: 2.9 mm}\n", "",
       "c.yaml:6:7: error: "
       "mesh.blade.sections: has 1 section, must have 2 to 16",
       1},
      {"height: 19 mm", "height: 310 mm",
       "c.yaml:4:49: error: mesh.blade.root.height: is 0.31 m, must be below "
       "the radius of the first section, 0.31 m",
       1},
      {"shroud_size: 4 mm", "shroud_size: 9 mm",
       "c.yaml:10:18: error: mesh.blade.shroud_size: is 0.009 m, must "
       "not be above size, 0.008 m",
       1},
      {"harmonics: 7", "harmonics: 5",
       "c.yaml:17:14: error: excitation.harmonics: harmonic 3 would be left "
       "out: mhb.harmonics is 5, must be 6 at least (times mhb.subharmonics)",
       1},
      {"  scale: 1.3", "  search: {starts: 40, at: [100, 119, 121]}",
       "c.yaml:34:39: error: mhb.search.at[2]: is 121 Hz, must be within mhb.frequency, 90 to "
       "120 Hz",
       1},
      {"  scale: 1.3", "  search: {starts: 40, at: 100}",
       "c.yaml:34:28: error: mhb.search.at: is a single value; expected a list of numbers in Hz",
       1},
      {"  scale: 1.3", "  search: {starts: 40, orders: [1, 3, 2]}",
       "c.yaml:34:39: error: mhb.search.orders[2]: is 2 after 3; they must increase", 1},
      {"  scale: 1.3", "  search: {starts: 40, orders: []}",
       "c.yaml:34:32: error: mhb.search.orders: has 0 numbers, expected 1 to 8", 1},
      {"  scale: 1.3", "  search: {starts: 40, orders: [17]}",
       "c.yaml:34:33: error: mhb.search.orders[0]: is 17, must be 1 to 16", 1},
      {"  scale: 1.3", "  search: 40",
       "c.yaml:34:11: error: mhb.search: is a single value; expected a mapping; known here: "
       "starts, at, orders",
       1},
      {"  pressure: 210 Pa\n", "",
       "c.yaml:14:1: error: excitation.pressure: missing; expected a number in Pa, "
       "or traction, force, field or loads",
       1},
      {"pressure: 210 Pa", "pressure: 0",
       "c.yaml:16:13: error: excitation.pressure: is 0; nothing would move", 1},
      {"{1: [1, 0 deg], 3: [0.21, 90 deg]}", "{1: 0}",
       "c.yaml:17:14: error: excitation.harmonics: every factor "
       "is 0; nothing would move",
       1},
      {"pressure: 210 Pa", "pressure: 210 Pa\n  traction: [1, 1, 1]",
       "c.yaml:17:13: error: "
       "excitation.traction: give only one of pressure, traction, force and field",
       1},
      {"pressure: 210 Pa", "field: none.h5",
       "c.yaml:16:10: error: excitation.field: none.h5: cannot be read: No such file or directory",
       2},
      {"pressure: 210 Pa", "force: {at: [0, 0, 0.4]}",
       "c.yaml:16:3: error: excitation.force.vector: missing; "
       "expected [x, y, z] in N",
       1},
      {"  blade:\n", "  file: x.msh\n  blade:\n",
       "c.yaml:3:9: error: mesh.file: x.msh: cannot be read: No such "
       "file or directory",
       2}};
  check_faults(rows, COUNT(rows));
  /* a missing file is no fault of the case file */
  const char text[] =
      "modal: {file: no.h5}\n"
      "contact: {to: ground, mu: 0.3, ku: 1, kv: 1, n0: 1}\n"
      "mhb: {frequency: [1, 2]}\n";
  char *said;
  assert_int_equal(judge(text, strlen(text), &said), SHB_ERR_IO);
  assert_non_null(strstr(said,
                         "c.yaml:1:15: error: modal.file: no.h5: cannot be read: No such file or "
                         "directory"));
  free(said);
}

/* Keys that would not be read, each with its place. */
/* text with from replaced by to; frees text. */
static char *change(char *text, const char *from, const char *to) {
  char  *at   = strstr(text, from);
  size_t size = strlen(text) + strlen(to) + 1;
  char  *out  = malloc(size);
  assert_non_null(at);
  snprintf(out, size, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
  free(text);
  return out;
}

/* A run-up needs the speeds that belong to its frequencies. */
static void run_ups(void **state) {
  (void)state;
  static const struct {
    const char *from, *to, *says; /* "": no fault */
  } rows[] = {
      {"  scale: 1.3", "  scale: 1.3", ""},
      {"frequency: [90 Hz, 0.12 kHz]", "frequency: [60 Hz, 0.12 kHz]",
       "c.yaml:31:14: error: mhb.frequency: must be within 70 to 128.333 Hz, which engine order 7 "
       "meets at the speeds of rotor.speed, 600 to 1100 rpm (mhb.run_up)"},
      {"frequency: [90 Hz, 0.12 kHz]", "frequency: [90 Hz, 0.13 kHz]",
       "c.yaml:31:14: error: mhb.frequency: must be within 70 to 128.333 Hz, which"},
      {"engine_order: 7", "engine_order: 0",
       "c.yaml:35:11: error: mhb.run_up: needs excitation.engine_order of 1 or more"},
      {"to: neighbour", "to: ground", ""},
      {"  stability: always\n", "  stability: always\nintegrate: {start: state}\n",
       "c.yaml:37:20: error: integrate.start: must be balance or rest in a run-up (mhb.run_up): "
       "the structure is another one at each frequency"},
      {"  stability: always\n", "  stability: always\nintegrate: {start: rest}\n", ""},
  };
  for (size_t i = 0; i < COUNT(rows); i++) {
    char *said, *text = scratch_case("speed: 2900 rpm", "speed: [900 rpm, 600 rpm, 1100 rpm]");
    text              = change(text, rows[i].from, rows[i].to);
    text              = change(text, "  max_points: 777", "  run_up: yes");
    shb_status status = judge(text, strlen(text), &said);
    assert_int_equal(status, *rows[i].says ? SHB_ERR_INPUT : SHB_OK);
    if (strncmp(said, rows[i].says, strlen(rows[i].says)) != 0)
      fail_msg("expected %s\nfound %s", rows[i].says, said);
    free(said);
    free(text);
  }
  char *said, *text = scratch_case("speed: 2900 rpm", "speed: [900 rpm, 600 rpm, 1100 rpm]");
  text = change(text, "points: 4", "points: auto");
  text = change(text, "  max_points: 777", "  run_up: yes");
  assert_int_equal(judge(text, strlen(text), &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said,
                         "c.yaml:23:11: error: contact.points: is auto, which does not go "
                         "with mhb.run_up; give the number of points\n"));
  free(said);
  free(text);
}

static void nothing_is_ignored(void **state) {
  (void)state;
  static const fault rows[] = {
      {"mesh:\n", "mesh:\n  unit: mm\n",
       "c.yaml:3:9: error: mesh.unit: only says something with mesh.file", 1},
      {"mesh:\n", "mesh:\n  size: 3 mm\n",
       "c.yaml:3:9: error: mesh.size: only says something with mesh.file", 1},
      {"mesh:\n", "mesh:\n  groups: {root: {radius: 1}}\n",
       "c.yaml:3:11: error: mesh.groups: only says something with mesh.file", 1},
      {"  points: 4", "  points: 4\n  tolerance: 1e-2",
       "c.yaml:24:14: error: contact.tolerance: only says something with contact.points: auto", 1},
      {"  scale: 1.3", "  search: {at: [100]}",
       "c.yaml:34:16: error: mhb.search.at: only says something with mhb.search.starts above 0", 1},
      {"  scale: 1.3", "  search: {orders: [2]}",
       "c.yaml:34:20: error: mhb.search.orders: only says something with mhb.search.starts above 0",
       1},
      {"  stability: always", "  stability: never\n  flips: mark",
       "c.yaml:37:10: error: mhb.flips: only says something with mhb.stability: auto or always", 1},
      {"[-20 N, 0, 0.3 kN]", "[-20 N, 300 N, 0.3 kN]",
       "c.yaml:27:22: error: contact.n0[2]: is 300 N, which [1] is already; every preload once", 1},
      {"mhb:\n", "integrate: {frequencies: [100, 130 Hz, 0.14 kHz]}\nmhb:\n",
       "c.yaml:30:32: error: integrate.frequencies[1]: is 130 Hz, must be within mhb.frequency, 90 "
       "to 120 Hz, where there are solutions to start on; or set integrate.start to rest or state",
       2},
      {"mhb:\n", "integrate: {direction: up}\nmhb:\n",
       "c.yaml:30:24: error: integrate.direction: only says something with integrate.start: state",
       1},
      {"mhb:\n", "integrate: {direction: up, start: rest}\nmhb:\n",
       "c.yaml:30:24: error: integrate.direction: only says something with integrate.start: state",
       1},
      {"modal: {modes: 17,", "modal: {file: no.h5, modes: 17,",
       "c.yaml:2:1: error: mesh: leave it out: modal.file is given, which holds what it made", 11}};
  check_faults(rows, COUNT(rows));
  static const char both[] =
      "modal: {file: c.yaml}\n"
      "rotor: {blades: 4, speed: 3}\n"
      "excitation: {engine_order: 1}\n"
      "contact: {mu: 0.3, ku: 1, kv: 1, n0: 1}\n"
      "mhb: {frequency: 1, scale: 2, vary: {scale: [0, 1]}, search: {starts: 0, orders: [2]}}\n";
  char *said;
  assert_int_equal(judge(both, strlen(both), &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "c.yaml:2:27: error: rotor.speed: leave it out: modal.file"));
  assert_non_null(strstr(said, "c.yaml:5:28: error: mhb.scale: leave it out: curves follow"));
  assert_non_null(strstr(said, "\n2 errors\n"));
  free(said);
}

/* What a sector with a disc does not go with, by its groups or as a parametric blade. */
static void a_disc_and_other_keys(void **state) {
  (void)state;
  static const char head[] =
      "mesh: {file: c.yaml.msh, groups: {cyclic_right: {radius: 1}}}\n"
      "material: {E: 1, nu: 0.3, rho: 1}\n"
      "excitation: {engine_order: 1, pressure: 1}\n";
  static const struct {
    const char *rest, *says;
  } rows[] = {
      {"modal: {modes: 3}\nrotor: {blades: 4, mistuning: {deviation: 1 %, seed: 7}}\ncontact: "
       "{points: 1, mu: 1, ku: 1, kv: 1, n0: 1}\n",
       "error: rotor.mistuning: does not go with a disc, whose sectors are alike; leave it out, or "
       "clamp the blade at its root"}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    char text[1024], *said;
    snprintf(text, sizeof text, "%s%smhb: {frequency: [1, 2]}\n", head, rows[i].rest);
    assert_int_equal(judge(text, strlen(text), &said), SHB_ERR_INPUT);
    if (!strstr(said, rows[i].says)) fail_msg("expected %s\nfound %s", rows[i].says, said);
    free(said);
  }
}

static void a_force_needs_a_place(void **state) {
  (void)state;
  char *said, *text = scratch_case("pressure: 210 Pa", "force: {vector: [1 N, 0, 0]}");
  char *probe = strstr(text, "probe:");
  memmove(probe, strchr(probe, '\n') + 1, strlen(strchr(probe, '\n')));
  assert_int_equal(judge(text, strlen(text), &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said,
                         "c.yaml:16:19: error: excitation.force.vector: has no place to act: give "
                         "excitation.force.at, or a probe\n"));
  free(said);
  free(text);
}

static void not_yaml(void **state) {
  (void)state;
  static const fault rows[] = {
      {"  mu: 0.31", "\tmu: 0.31", "c.yaml:24:1: error: a tab; YAML indents with spaces", 1},
      {"[90 Hz, 0.12 kHz]", "[90 Hz, 0.12 kHz",
       "c.yaml:32:12: error: not valid YAML: the list has no ']', or an entry no ',' (begun on "
       "line 31)",
       1},
      {"mu: 0.31", "mu: @2",
       "c.yaml:24:7: error: not valid YAML: no value begins with this sign; put it "
       "in quotation marks",
       1},
      {"mu: 0.31", "mu: 0.31: 2",
       "c.yaml:24:11: error: not valid YAML: no ':' can stand here; a text with ': ' "
       "needs quotation marks, and the keys of a block begin in one column",
       1},
      {"mu: 0.31", "mu: '0.31",
       "c.yaml:37:1: error: not valid YAML: the quotation mark is not closed (begun on line 24)",
       1},
      {"mu: 0.31", "mu: \x01",
       "c.yaml:24:7: error: not UTF-8 text: control characters are not allowed", 1},
      {"mu: 0.31", "mu: \xE4", "c.yaml:24:8: error: not UTF-8 text: invalid trailing UTF-8 octet",
       1},
      {"mu: 0.31", "mu: *friction",
       "c.yaml:24:7: error: contact.mu: aliases (*name) are not supported; write "
       "the value out",
       1},
      {"mu: 0.31", "mu: !!float 0.31",
       "c.yaml:24:7: error: contact.mu: tags (!...) are not supported", 1},
      {"mu: 0.31", "mu: \"0.31\\0abc\"",
       "c.yaml:24:7: error: contact.mu: holds the character \\0, which ends text", 1},
      {"mu: 0.31", "mu: 0.31\n  \"kv\\0x\": 2",
       "c.yaml:25:3: error: contact: holds the character \\0, which ends text", 1},
      {"mu: 0.31", "mu: \"\\e[31m\\N\\x9b0.31\"",
       "c.yaml:24:7: error: contact.mu: '?[31m??0.31' is not a number; expected a number", 1},
      {"  scale: 1.3", "---",
       "c.yaml:34:1: error: a second document begins here; one file holds one case", 1}};
  check_faults(rows, COUNT(rows));
}

static void strange_files(void **state) {
  (void)state;
  static const struct {
    const char *text, *says;
  } rows[] = {
      {"", "c.yaml:1:1: error: the file is empty\n1 error\n"},
      {"# nothing\n\n", "c.yaml:1:1: error: the file is empty\n    # nothing\n    ^\n1 error\n"},
      {"---\n...\n", "c.yaml:1:1: error: the file is empty\n    ---\n    ^\n1 error\n"},
      {"3\n",
       "c.yaml:1:1: error: the file holds a single value, not a mapping of keys\n    3\n    ^\n1 "
       "error\n"},
      {"[1]\n",
       "c.yaml:1:1: error: the file holds a list, not a mapping of keys\n    [1]\n    ^\n1 "
       "error\n"},
      {"\x1b[31mred",
       "c.yaml:1:1: error: not UTF-8 text: control characters are not allowed\n    ?[31mred\n"
       "    ^\n1 error\n"}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    char *said;
    assert_int_equal(judge(rows[i].text, strlen(rows[i].text), &said), SHB_ERR_INPUT);
    assert_string_equal(said, rows[i].says);
    free(said);
  }
  char *said, *large = malloc((2u << 20) + 1);
  memset(large, '#', 2u << 20);
  large[2u << 20] = '\0';
  assert_int_equal(judge(large, 2u << 20, &said), SHB_ERR_INPUT);
  assert_string_equal(shb_message(),
                      "c.yaml: larger than 1 MiB; a case file is a page of YAML text");
  free(said);
  assert_int_equal(judge("\x89HDF\r\n\x1a\n\0\0", 10, &said), SHB_ERR_INPUT);
  assert_string_equal(shb_message(),
                      "c.yaml: holds binary data; a case file is a page of YAML text in UTF-8");
  free(said);
  memset(large, '[', 100000); /* deep */
  assert_int_equal(judge(large, 100000, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "nested more than 16 deep"));
  free(said);
  for (size_t i = 0; i < 1u << 20; i++) large[i] = i % 2 ? '1' : ','; /* wide */
  large[0] = '[';
  assert_int_equal(judge(large, 1u << 20, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "more than 4096 entries"));
  free(said);
  size_t at = 0; /* unknown keys, each compared with all that are known */
  for (int i = 0; i < 4000; i++) at += (size_t)sprintf(large + at, "harmonixs%d: 1\n", i);
  assert_int_equal(judge(large, at, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "harmonixs0"));
  free(said);
  free(large);
}

static void a_missing_file_is_told(void **state) {
  (void)state;
  case_file file;
  assert_int_equal(case_read("/nonexistent/c.yaml", ALL, stderr, &file), SHB_ERR_IO);
  assert_string_equal(shb_message(),
                      "/nonexistent/c.yaml: cannot be opened: No such file or directory");
  assert_false(file.no_memory);
  assert_int_equal(case_read("/", ALL, stderr, &file), SHB_ERR_IO);
  assert_string_equal(shb_message(), "/: cannot be read: Is a directory");
  assert_false(file.no_memory);
}

/* Of a process whose address space cannot grow. */
static void short_memory_is_no_fault_of_the_file(void **state) {
  char  folder[SCRATCH_PATH], path[SCRATCH_PATH + 8], *remark = malloc(CASE_MAX_BYTES);
  int   status;
  pid_t child;
  (void)state;
  memset(remark, '#', CASE_MAX_BYTES);
  scratch_create(folder);
  scratch_write(folder, "c.yaml", remark, CASE_MAX_BYTES);
  snprintf(path, sizeof path, "%s/c.yaml", folder);
  free(remark);
  child = fork();
  if (child == 0) {
    const struct rlimit limit = {1, 1};
    case_file           file;
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(1);
    _exit(case_read(path, ALL, stderr, &file) != SHB_ERR_IO || !file.no_memory);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
  scratch_remove(folder);
}

/* Every error of the file, sorted, each with its line and a caret under the place. */
static void all_at_once(void **state) {
  (void)state;
  char *said, *text = scratch_case("0.31\n", "0,3\n");
  memcpy(strstr(text, "Hz]"), "Hx]", 3);                    /* line 30 */
  memcpy(strstr(text, "blades"), "bladez", 6);              /* line 12 */
  memcpy(strstr(text, "radius: 0.31"), "radius: x.31", 12); /* line 6 */
  assert_int_equal(judge(text, strlen(text), &said), SHB_ERR_INPUT);
  assert_string_equal(
      said,
      "c.yaml:6:18: error: mesh.blade.sections[0].radius: 'x.31' is not a number; expected a "
      "number in m\n"
      "          - {radius: x.31, chord: 53 mm, thickness: 5 mm, camber: 3 mm, twist: 20 deg}\n"
      "                     ^\n"
      "c.yaml:12:9: error: rotor.bladez: unknown key; did you mean 'blades'?\n"
      "    rotor: {bladez: 37, speed: 2900 rpm, axis: -y}\n"
      "            ^\n"
      "c.yaml:24:7: error: contact.mu: '0,3' is not a number; write 0.3 with a decimal point\n"
      "      mu: 0,3\n"
      "          ^\n"
      "c.yaml:31:22: error: mhb.frequency[1]: '0.12 kHx': unknown unit 'kHx'; expected Hz\n"
      "      frequency: [90 Hz, 0.12 kHx]\n"
      "                         ^\n"
      "4 errors\n");
  free(said);
  free(text);
}

/* Columns count characters, not bytes; a long line is cut around the place. */
static void carets_stay_below(void **state) {
  (void)state;
  char *said;
  judge("{\"gr\u00F6\u00DFe\": 1, mhb: 2}", strlen("{\"gr\u00F6\u00DFe\": 1, mhb: 2}"), &said);
  assert_non_null(strstr(said, "c.yaml:1:19: error: mhb: is a single value"));
  assert_non_null(strstr(said, "    {\"gr\u00F6\u00DFe\": 1, mhb: 2}\n                      ^\n"));
  free(said);
  char text[2000];
  memset(text, ' ', sizeof text);
  memcpy(text, "mhb:", 4);
  memcpy(text + 1990, "2\n", 3);
  judge(text, strlen(text), &said);
  assert_non_null(strstr(said, "c.yaml:1:1991: error: mhb: is a single value"));
  for (char *line = said; line; line = strchr(line, '\n')) {
    line += *line == '\n';
    if (strncmp(line, "    ", 4) == 0) assert_true(strcspn(line, "\n") < 130);
  }
  free(said);
}

/* Blades that differ. */
static void mistuning(void **state) {
  (void)state;
  static const fault rows[] = {
      {"axis: -y", "axis: -y, mistuning: [0.01, 0.02]",
       "c.yaml:12:59: error: rotor.mistuning: has 2 deviations, must have 37, one a blade "
       "(rotor.blades)",
       1},
      {"axis: -y", "axis: -y, mistuning: {deviation: 1 %}",
       "c.yaml:12:59: error: rotor.mistuning.seed: missing; expected {deviation: 1 %, seed: 7}", 1},
      {"axis: -y", "axis: -y, mistuning: {deviation: 1 %, seed: 7, samples: 1}",
       "c.yaml:12:94: error: rotor.mistuning.samples: '1' is not a number of samples; expected a "
       "whole number, 2 to 100000",
       1},
      {"axis: -y", "axis: -y, mistuning: {samples: 3, deviation: 1 %}",
       "c.yaml:12:59: error: rotor.mistuning.seed: missing; expected {deviation: 1 %, seed: 7}", 1},
      {"axis: -y", "axis: -y, mistuning: {deviation: 1 %, seed: 7, sample: 3}",
       "c.yaml:12:85: error: rotor.mistuning.sample: unknown key; give a list, {file: NAME} or "
       "{deviation: 1 %, seed: 7}",
       1},
      {"axis: -y", "axis: -y, mistuning: {file: nope.csv}, axes: 3",
       "c.yaml:12:59: error: rotor.mistuning: nope.csv: cannot be read: No such file or directory",
       2},
      {"axis: -y", "axis: -y, mistuning: {deviation: 30 %, seed: 1}",
       "c.yaml:12:71: error: rotor.mistuning.deviation: is 0.3, must be 0 to 0.1", 1},
      {"axis: -y", "axis: -y, mistuning: [-0.5]",
       "c.yaml:12:60: error: rotor.mistuning[0]: is -0.5, must be above -0.5 to 1", 1},
      {"axis: -y", "axis: -y, mistuning: {file: a.csv, seed: 1}",
       "c.yaml:12:73: error: rotor.mistuning.seed: does not go with a file; expected {file: NAME} "
       "or {file: NAME, unit: Hz, mean: 117 Hz}",
       1},
      {"axis: -y", "axis: -y, mistuning: {file: a.csv, unit: rpm}",
       "c.yaml:12:79: error: rotor.mistuning.unit: is not Hz; of deviations such as 0.01 or 1 % "
       "leave it out",
       1},
      {"axis: -y", "axis: -y, mistuning: {file: a.csv, mean: 3 Hz}",
       "c.yaml:12:79: error: rotor.mistuning.mean: goes with unit: Hz alone", 1},
      {"axis: -y", "axis: -y, mistuning: {file: a.csv, unit: Hz, mean: 0 Hz}",
       "c.yaml:12:89: error: rotor.mistuning.mean: is 0 Hz, must be above 0 to 1e+06 Hz", 1},
      {"axis: -y", "axis: -y, mistuning: {file: m.csv}",
       "c.yaml:12:59: error: rotor.mistuning: m.csv:2:1: a deviation of 117 (11700 %) must be "
       "above "
       "-50 % and at most 100 %; frequencies in Hz: rotor.mistuning: {file: NAME, unit: Hz}",
       1},
      {"axis: -y", "axis: -y, mistuning: {file: m.csv, unit: Hz, mean: 30 Hz}",
       "c.yaml:12:59: error: rotor.mistuning: m.csv:2:1: a deviation of 2.9 (290 %) must be above "
       "-50 % and at most 100 %",
       1},
      {"axis: -y", "axis: -y, mistuning: {file: m.csv, unit: Hz}, axes: 3",
       "c.yaml:12:84: error: rotor.axes: unknown key; did you mean 'axis'?", 1},
  };
  check_faults(rows, COUNT(rows));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(keys_and_kinds),
                                     cmocka_unit_test(mistuning),
                                     cmocka_unit_test(numbers_and_ranges),
                                     cmocka_unit_test(keys_among_each_other),
                                     cmocka_unit_test(run_ups),
                                     cmocka_unit_test(nothing_is_ignored),
                                     cmocka_unit_test(a_force_needs_a_place),
                                     cmocka_unit_test(a_disc_and_other_keys),
                                     cmocka_unit_test(not_yaml),
                                     cmocka_unit_test(strange_files),
                                     cmocka_unit_test(a_missing_file_is_told),
                                     cmocka_unit_test(short_memory_is_no_fault_of_the_file),
                                     cmocka_unit_test(all_at_once),
                                     cmocka_unit_test(carets_stay_below)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
